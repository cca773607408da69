"""Silences, by which a scene says which of its findings are meant."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from atomsim.findings.finding import Finding, Symptom, When, finding
from atomsim.scene.language import Scene, Silence
from atomsim.scene.source import KeyPath, Source


def without_silenced(findings: Sequence[Finding], scene: Scene) -> list[Finding]:
    """Leave out what a scene means."""
    silences = list(_silences(scene))
    return [found for found in findings if not any(_covers(code, silence, found) for _, code, silence in silences)]


def needless_silences(
    findings: Sequence[Finding], scene: Scene, source: Source, when: When, codes: Collection[str]
) -> list[Finding]:
    """Return a note for every silence that silences nothing.

    Args:
        findings: all that was found.
        scene: what a person wrote.
        source: where it was written.
        when: whether this is before a run or after it.
        codes: of these everything has been looked for; what silences of others are good for is not known yet.
    """
    return [
        finding(
            "needless-silence", when, Symptom(path, (path,), f"there is no {code} to silence{_of(silence)}"), source
        )
        for path, code, silence in _silences(scene)
        if code in codes and not any(_covers(code, silence, found) for found in findings)
    ]


def _silences(scene: Scene) -> Iterator[tuple[KeyPath, str, Silence]]:
    """Yield every silence with its place and its code."""
    for code, silences in scene.silence.items():
        for index, silence in enumerate(silences):
            yield ("silence", code, index), code, silence


def _covers(code: str, silence: Silence, found: Finding) -> bool:
    return found.code == code and set(silence.names) <= set(found.names)


def _of(silence: Silence) -> str:
    return f" that mentions {', '.join(silence.names)}" if silence.names else ""
