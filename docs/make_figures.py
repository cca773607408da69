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
    """Save a picture in 256 colours, which makes the file a fraction as large and cannot be seen."""
    with Image.open(drawn) as picture:
        picture.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
            kept, optimize=True
        )


if __name__ == "__main__":
    main()
