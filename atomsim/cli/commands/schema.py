"""`atomsim schema`: the JSON Schema of the scene language."""

from __future__ import annotations

from atomsim.cli.voice import explained


@explained(
    """
    Print the JSON Schema of the scene language.

    Editors complete and check scenes with it.

    Example:

    atomsim schema > scene.schema.json
    """
)
def schema() -> None:
    from atomsim.scene.schema import schema_text

    print(schema_text(), end="")
