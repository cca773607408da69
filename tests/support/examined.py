"""From the text of a scene to what a diagnosis before the run finds in it; knows no expectations."""

from __future__ import annotations

from atomsim.compiler import compile_scene
from atomsim.findings.before.diagnose import Examination, examine
from atomsim.findings.finding import Finding
from atomsim.scene.loader import LoadedScene, loads

NAME = "scene.yaml"


def examined(scene: LoadedScene | str) -> Examination:
    """Examine a scene, or the text of one that is called `scene.yaml`."""
    loaded = loads(scene, NAME) if isinstance(scene, str) else scene
    return examine(loaded, *compile_scene(loaded))


def found(scene: LoadedScene | str, code: str | None = None) -> list[Finding]:
    """Return what is found in a scene, or what of one kind is found."""
    return [each for each in examined(scene).findings if code in (None, each.code)]


def warnings(scene: LoadedScene | str) -> list[str]:
    """Return the warnings of a scene as people read them."""
    return [str(each) for each in found(scene) if each.level == "warning"]
