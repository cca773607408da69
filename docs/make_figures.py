"""Draws the pictures of the docs by running the pages that show them; knows no scene.

Run it with `make figures`.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from pages import PAGES, ROOT, pictures, run_page
from PIL import Image

FIGURES = ROOT / "docs" / "figures"


def main() -> None:
    """Run every page with pictures and keep what it draws."""
    for page in PAGES:
        if names := pictures(page):
            with tempfile.TemporaryDirectory() as folder:
                run_page(page, Path(folder))
                for name in names:
                    keep(Path(folder) / name, FIGURES / name)


def keep(drawn: Path, kept: Path) -> None:
    """Save a picture in 256 colours of its own: nobody sees the difference, and the file is a third as large."""
    with Image.open(drawn) as picture:
        few = picture.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=2, dither=Image.Dither.NONE)
        few.save(kept, optimize=True)


if __name__ == "__main__":
    main()
