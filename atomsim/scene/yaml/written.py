"""Plain data to YAML that the strict reader reads back unchanged; knows no scene and no marks."""

from __future__ import annotations

from typing import Any

import yaml

from atomsim.scene.yaml.prepared import NO_BREAKS
from atomsim.scene.yaml.scalars import NUMBER, NUMBER_STARTS


class _Writer(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]  # the base is chosen at run time
    """A dumper that quotes whatever YAML 1.1 or the strict reader would not take as text, and repeats no aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True

    def represent_text(self, text: str) -> yaml.ScalarNode:
        """Escape what YAML 1.1, which this dumper writes, would break a line at."""
        style = '"' if any(sign in text for sign in NO_BREAKS) else None
        node: yaml.ScalarNode = self.represent_scalar("tag:yaml.org,2002:str", text, style=style)
        return node


_Writer.add_representer(str, _Writer.represent_text)
_Writer.add_implicit_resolver("tag:yaml.org,2002:float", NUMBER, list(NUMBER_STARTS))


def to_yaml(data: Any) -> str:
    """Write plain data as YAML: keys in order, leaves on one line, every float exactly.

    >>> print(to_yaml({"ring": {"step": [1, -0.0, 1e-9]}}), end="")
    ring:
      step: [1, -0.0, 1.0e-09]
    """
    text: str = yaml.dump(data, Dumper=_Writer, sort_keys=False, allow_unicode=True, width=120, default_flow_style=None)
    return text


def to_line(data: Any) -> str:
    """Write plain data as YAML on one line, as the inside of a scene usually is.

    >>> to_line({"between": ["post", "cloth"]}), to_line(1e-9), to_line(None)
    ('{between: [post, cloth]}', '1.0e-09', 'null')
    """
    text: str = yaml.dump(
        data, Dumper=_Writer, sort_keys=False, allow_unicode=True, width=1 << 30, default_flow_style=True
    )
    return text.removesuffix("...\n").rstrip("\n")
