"""Draws the pictures of the docs by running the pages that show them; knows no scene.

Run it with `make figures`.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from pages import PAGES, ROOT, pictures, run_page

FIGURES = ROOT / "docs" / "figures"


def main() -> None:
    """Run every page with pictures and keep what it draws."""
    for page in PAGES:
        if names := pictures(page):
            with tempfile.TemporaryDirectory() as folder:
                run_page(page, Path(folder))
                for name in names:
                    shutil.copy(Path(folder) / name, FIGURES / name)


if __name__ == "__main__":
    main()
