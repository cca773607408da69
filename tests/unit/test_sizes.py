"""Sizes of pictures: in pixels, or in centimetres on paper."""

import pytest

from atomsim.errors import InputError
from atomsim.tasks.sizes import Size


@pytest.mark.parametrize(
    ("size", "dpi", "pixels", "density"),
    [
        (None, None, None, None),
        (None, 150, None, 150),
        ((640, 480), None, (640, 480), None),
        ("640x480", None, (640, 480), None),
        ("640X480", 72, (640, 480), 72),
        ("8x6cm", None, (945, 709), 300),
        ("8x6cm", 100, (315, 236), 100),
        (" 2.54 x 1.27 CM ", 600, (600, 300), 600),
    ],
)
def test_sizes(size, dpi, pixels, density):
    assert Size.of(size, dpi) == Size(pixels, density)


@pytest.mark.parametrize(
    "size", ["", "640", "640x", "x480", "640x480x2", "6.4x4.8", "8x6in", "8cmx6cm", "-8x6cm", "axb"]
)
def test_what_is_no_size_is_told_how_it_is_written(size):
    with pytest.raises(InputError, match=r"^size is written 640x480, in pixels, or 8x6cm; got "):
        Size.of(size, None)


@pytest.mark.parametrize("dpi", [0, 19, 2401, -300, 72.5, "300", True])
def test_densities_that_will_not_do(dpi):
    with pytest.raises(InputError, match=r"^dpi: needs a whole number from 20 to 2400 \(got "):
        Size.of(None, dpi)
