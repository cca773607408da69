"""From where a row is seen: as the user asks, else as the scene says, else as suits the motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from atomsim.arguments import real_pair, refused
from atomsim.drawing import View, direction_of
from atomsim.scene.language import Camera

AskedCamera: TypeAlias = str | tuple[float, float] | Mapping[str, Any]
"""A direction by name, azimuth and elevation [degrees], or keys of a camera as a scene has them."""


def camera_keys(name: str, camera: Any) -> Mapping[str, Any]:
    """Return the keys of a camera that an argument asks for; their values are not looked at.

    Args:
        name: of the argument.
        camera: what was passed; None for nothing.

    Raises:
        InputError: it is no camera.
    """
    if camera is None:
        return {}
    if isinstance(camera, str):
        return {"view": camera}
    needs = "azimuth and elevation, such as (30, 20), or front, side or top, or keys and values as in a scene"
    if isinstance(camera, Mapping):
        if not all(isinstance(key, str) for key in camera):
            raise refused(name, needs, camera)
        return camera
    azimuth, elevation = real_pair(name, camera, needs)
    return {"azimuth": azimuth, "elevation": elevation}


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
    return View(*direction, camera.up, camera.look_at, camera.width)
