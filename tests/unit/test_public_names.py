"""What `import atomsim` offers is listed before it is loaded."""

from __future__ import annotations

import atomsim


def test_the_public_names_are_listed_and_lead_somewhere() -> None:
    assert dir(atomsim) == sorted([*atomsim.__all__, "__version__"])
    for name in atomsim.__all__:
        assert getattr(atomsim, name).__doc__
