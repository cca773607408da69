"""Places on a strip: nothing overlaps, nothing sticks out."""

import itertools

import pytest

from atomsim.drawing.layout import LARGE, SMALL, Layout, frame_size


@pytest.mark.parametrize(("n_frames", "columns"), [(1, 1), (8, 8), (9, 5), (16, 8), (17, 6), (24, 8), (25, 7)])
def test_long_rows_break_into_even_lines(n_frames, columns):
    assert Layout((100, 75), (n_frames,), (True,), False).columns == columns


@pytest.mark.parametrize("has_notices", [False, True])
@pytest.mark.parametrize("n_frames", [(1,), (3, 8), (20, 5, 9)])
def test_parts_do_not_overlap_and_fit_on_the_strip(n_frames, has_notices):
    layout = Layout((160, 120), n_frames, tuple(row % 2 == 0 for row in range(len(n_frames))), has_notices)
    boxes = []
    for row, count in enumerate(n_frames):
        for frame in range(count):
            left, top = layout.corner(row, frame)
            assert 0 < left <= layout.width - 160
            assert 0 < top <= layout.height - 120 - layout.caption_height
            assert top >= layout.row_top(row) + layout.has_title[row] * layout.title_height
            boxes.append((left, top))
    for (left, top), (other_left, other_top) in itertools.combinations(boxes, 2):
        assert abs(left - other_left) > 160 or abs(top - other_top) >= 120 + layout.caption_height


def test_the_strip_is_about_as_wide_as_a_screen_whatever_it_holds():
    assert frame_size([3]) == LARGE
    assert frame_size([6, 2]) == LARGE
    assert frame_size([8]) == SMALL
    assert frame_size([12]) == LARGE
    for count in range(1, 40):
        assert Layout(frame_size([count]), (count,), (True,), False).width < 2700


def test_letters_are_legible_at_any_size():
    assert [Layout((side, side), (1,), (True,), False).font for side in (16, 240, 300, 4096)] == [11, 16, 20, 28]
