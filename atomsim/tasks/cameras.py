"""From where rows are seen: as the user asks, else as the scene says, else as suits the motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any, TypeAlias

from atomsim.arguments import real_pair, refused, sequence
from atomsim.drawing import View, direction_of
from atomsim.scene.language import Camera

OneCamera: TypeAlias = str | tuple[float, float] | Mapping[str, Any]
"""A direction by name, azimuth and elevation [degrees], or keys of a camera as a scene has them."""

AskedCamera: TypeAlias = OneCamera | Sequence[OneCamera]
"""One camera, or several for as many rows."""

_NEEDS = "azimuth and elevation, such as (30, 20), or front, side or top, or keys and values as in a scene"


@dataclass(frozen=True, slots=True)
class CameraWish:
    """What is asked of the camera of a row.

    Attributes:
        keys: of a camera of a scene, with values that nobody has looked at; they take the place of what it says.
        name: what the row is called beside others of the same run; empty if it is the only one.
    """

    keys: Mapping[str, Any]
    name: str = ""


def camera_wishes(name: str, cameras: Any) -> tuple[CameraWish, ...]:
    """Return what an argument asks for, one for each row of a run.

    Args:
        name: of the argument.
        cameras: one camera or several; None for what the scene says.

    Raises:
        InputError: it is no camera, or a list without any.
    """
    if cameras is None:
        return (CameraWish({}),)
    if _is_one(cameras):
        return (CameraWish(_keys(name, cameras)),)
    several = [_keys(name, camera) for camera in sequence(name, cameras, _NEEDS)]
    if len(several) == 1:
        return (CameraWish(several[0]),)
    return tuple(CameraWish(keys, _called(keys, number)) for number, keys in enumerate(several, 1))


def _is_one(camera: Any) -> bool:
    if isinstance(camera, str | Mapping):
        return True
    try:
        return any(isinstance(part, Real) or part is None for part in camera)
    except TypeError:
        return True  # which will be refused as one


def _keys(name: str, camera: Any) -> Mapping[str, Any]:
    """Return the keys of one camera."""
    if isinstance(camera, str):
        return {"view": camera}
    if isinstance(camera, Mapping):
        if not all(isinstance(key, str) for key in camera):
            raise refused(name, _NEEDS, camera)
        return camera
    azimuth, elevation = real_pair(name, camera, _NEEDS)
    return {"azimuth": azimuth, "elevation": elevation}


def _called(keys: Mapping[str, Any], number: int) -> str:
    """Return what a camera is called beside others."""
    if "view" in keys:
        return f"from the {keys['view']}"
    if "azimuth" in keys and "elevation" in keys:
        return f"from {keys['azimuth']:g}°, {keys['elevation']:g}° up"
    return f"camera {number}"


def view_of(camera: Camera, azimuth: Callable[[str], float]) -> View:
    """Return the view of a camera.

    Args:
        camera: what the user or the scene says.
        azimuth: gives the direction that suits the motion, by the axis that points up; asked where nobody said one.
    """
    is_open = camera.view is None and camera.azimuth is None
    direction = direction_of(
        camera.view, azimuth(camera.up) if is_open else camera.azimuth, camera.elevation, camera.up
    )
    return View(*direction, camera.up, camera.look_at, camera.width, camera.field_of_view)
