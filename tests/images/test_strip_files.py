"""Strips and single frames as files: their pixels, their bytes, their words, and what is refused."""

import base64
import gc
import io
import re
import weakref
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image
from support.process import finish, python

from atomsim.core.model import Frame, Observables, State
from atomsim.drawing.camera import View
from atomsim.drawing.files import is_our_picture
from atomsim.drawing.layout import Layout
from atomsim.drawing.page import BLACK, WHITE
from atomsim.drawing.strip import Row, compose, frames_to
from atomsim.errors import InputError

SIZE = (96, 72)
BROWN = np.tile([0.7, 0.2, 0.1], (12, 1))
NOTHING_MEASURED = Observables(0.0, 0.0, 0.0, np.zeros(3), np.zeros(3), 0)


def frame(round_index, shift=0.0):
    ring = np.arange(12) * (np.pi / 6)
    position = np.stack([3 * np.cos(ring) + shift, 3 * np.sin(ring), 0.1 * ring], axis=1)
    state = State(round_index, position, np.zeros_like(position))
    return Frame(state, 0.1 * round_index, "", NOTHING_MEASURED)


def row(title="A ring", n_frames=3, **options):
    frames = tuple(frame(50 * index, index) for index in range(n_frames))
    asked = tuple(50 * index for index in range(n_frames))
    return Row(
        title, **{"frames": frames, "rounds": asked, "paint": lambda frame: BROWN, "view": View(10, 40), **options}
    )


def pictures(row, size=SIZE):
    return [panel.picture for panel in row.panels(size)]


def pixels_of(path):
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def test_frames_are_pasted_pixel_by_pixel(tmp_path):
    rows = [row(), row("", n_frames=9), row("Third", n_frames=2, background=(1.0, 1.0, 0.875))]
    out = tmp_path / "strip.png"
    compose(rows, out, SIZE)
    layout = Layout(SIZE, (3, 9, 2), (True, False, True), False)
    strip = pixels_of(out)
    assert strip.shape == (layout.height, layout.width, 3)
    for number, shown in enumerate(rows):
        for index, picture in enumerate(pictures(shown)):
            left, top = layout.corner(number, index)
            assert (strip[top : top + 72, left : left + 96] == picture).all()


def test_titles_and_captions_stand_where_no_frame_is(tmp_path):
    out = tmp_path / "strip.png"
    compose([row()], out, SIZE)
    layout = Layout(SIZE, (3,), (True,), False)
    is_ink = (pixels_of(out) < 128).all(axis=2)
    left, top = layout.corner(0, 0)
    assert is_ink[:top].any()
    for index in range(3):
        left = layout.corner(0, index)[0]
        assert is_ink[top + 72 :, left : left + 96].any()
        assert not is_ink[top + 72 :, left - 8 : left].any()


def test_the_same_rows_give_the_same_bytes_whatever_the_users_settings(tmp_path):
    for extension in ("png", "jpg", "webp", "pdf", "svg"):
        one, other = tmp_path / f"one.{extension}", tmp_path / f"other.{extension}"
        compose([row()], one, SIZE)
        with mpl.rc_context(
            {"font.size": 30, "text.color": "red", "savefig.facecolor": "black", "savefig.pad_inches": 3}
        ):
            compose([row()], other, SIZE)
        assert one.read_bytes() == other.read_bytes()


def test_pictures_of_ours_are_known_in_every_format(tmp_path):
    out = [tmp_path / f"strip.{extension}" for extension in ("png", "jpg", "jpeg", "webp", "pdf", "svg")]
    for path in out:
        compose([row()], path, SIZE)
    assert all(is_our_picture(path) for path in [*out, *frames_to([row()], tmp_path, SIZE)])
    Image.new("RGB", (20, 20)).save(tmp_path / "foreign.png")
    assert not is_our_picture(tmp_path / "foreign.png")
    assert not is_our_picture(tmp_path / "missing.png")
    assert not is_our_picture(tmp_path)


def test_progress_is_told_at_the_start_and_after_every_picture(tmp_path):
    heard = []
    compose([row(), row(n_frames=1)], tmp_path / "strip.png", SIZE, lambda *count: heard.append(count))
    assert heard == [(number, 4) for number in range(5)]
    heard.clear()

    def hear(n_drawn, n_frames):
        assert len(list((tmp_path / "film").iterdir())) == n_drawn
        heard.append((n_drawn, n_frames))

    frames_to([row()], tmp_path / "film", SIZE, hear)
    assert heard == [(number, 3) for number in range(4)]


def test_one_frame_at_a_time_is_in_memory(tmp_path):
    """However long a trajectory is: frames are made when they are asked for, and let go."""
    made = []

    class Film(Sequence):
        def __len__(self):
            return 12

        def __getitem__(self, index):
            new = frame(range(12)[index], index)
            made.append(weakref.ref(new.position))
            return new

    def hear(n_drawn, n_frames):
        gc.collect()
        alive.append(sum(reference() is not None for reference in made))

    alive = []
    frames_to([row(frames=Film(), rounds=tuple(range(12)))], tmp_path, SIZE, hear)
    assert len(made) > 24
    assert max(alive) <= 2


def test_a_png_holds_no_version_of_any_program(tmp_path):
    compose([row()], tmp_path / "strip.png", SIZE)
    assert b"atplotlib" not in (tmp_path / "strip.png").read_bytes()


def test_lossless_formats_hold_the_exact_frames(tmp_path):
    shown = row(n_frames=1)
    left, top = Layout(SIZE, (1,), (True,), False).corner(0, 0)
    compose([shown], tmp_path / "strip.webp", SIZE)
    compose([shown], tmp_path / "strip.svg", SIZE)
    [picture] = pictures(shown)
    assert (pixels_of(tmp_path / "strip.webp")[top : top + 72, left : left + 96] == picture).all()
    [encoded] = re.findall(r'"data:image/png;base64,([^"]+)"', (tmp_path / "strip.svg").read_text())
    assert (pixels_of(io.BytesIO(base64.b64decode(encoded)))[::-1] == picture).all()  # SVG's y points up here


def test_other_formats_are_what_they_say(tmp_path):
    for extension, magic in {"jpg": b"\xff\xd8", "jpeg": b"\xff\xd8", "pdf": b"%PDF", "svg": b"<?xml"}.items():
        compose([row()], tmp_path / f"strip.{extension}", SIZE)
        assert (tmp_path / f"strip.{extension}").read_bytes().startswith(magic)


def test_captions_tell_the_round_and_what_was_asked():
    captions = [panel.caption for panel in row(rounds=(0, 52, 100)).panels(SIZE)]
    assert captions == ["round 0", "round 50 (nearest to 52)", "round 100"]


def test_atoms_that_cannot_be_drawn_are_counted(tmp_path):
    lost = frame(7)
    lost.position[0, 0], lost.position[1, 2], lost.position[5, 1] = np.nan, np.inf, 1e12
    shown = Row("", (frame(0), lost), (0, 7), lambda frame: BROWN)
    assert [panel.notice for panel in shown.panels(SIZE)] == ["", "3 atoms not drawable"]
    compose([shown], tmp_path / "strip.png", SIZE)
    assert len(pixels_of(tmp_path / "strip.png")) == Layout(SIZE, (2,), (False,), True).height


def test_what_is_followed_stays_in_the_middle():
    """Twelve atoms move by a radius from frame to frame; followed, they are drawn at the same place each time."""
    resting, followed = pictures(row()), pictures(row(followed=np.arange(12)))
    assert not (resting[0] == resting[2]).all()
    assert (followed[0] == followed[1]).all()
    assert (followed[0] == followed[2]).all()


def test_what_is_followed_is_seen_with_what_is_around_it():
    """The camera is the same however far the rest of the scene reaches, and shows twice what is followed."""
    part = row(n_frames=1, followed=np.arange(3), view=View(10, 40, width=None))
    alone = row(n_frames=1, followed=np.arange(12), view=View(10, 40))
    assert part._camera(SIZE).width < alone._camera(SIZE).width
    assert alone._camera(SIZE).width == pytest.approx(2 * row(n_frames=1)._camera(SIZE).width, rel=0.1)
    assert row(n_frames=1, followed=np.arange(3), view=View(width=17.0))._camera(SIZE).width == 17.0


def test_every_frame_has_the_colors_of_its_round():
    """As a measure that changes would have them."""
    shown = row(paint=lambda frame: BROWN if frame.round_index else BROWN[:, ::-1])
    first, second, _ = pictures(shown)
    assert first[:, :, 2].min() > first[:, :, 0].min()
    assert second[:, :, 0].min() > second[:, :, 2].min()


def test_all_frames_of_a_row_have_the_same_framing():
    shown = row()
    first, _, last = pictures(shown)
    alone = [pictures(Row("", (one,), (0,), shown.paint, shown.view))[0] for one in shown.frames]
    assert (alone[0] == alone[2]).all()
    assert (first != last).any()


@pytest.mark.parametrize("title", ["$x^2$ \\frac{", "環 🎈", "two\nlines\tand a \0", "x" * 10_000, "wide " * 70])
def test_any_title_can_be_written(tmp_path, title):
    compose([row(title)], tmp_path / "strip.png", SIZE)
    right = Layout(SIZE, (3,), (True,), False).width - 14
    assert (pixels_of(tmp_path / "strip.png")[:30, right:] == 255).all()


@pytest.mark.parametrize(
    ("size", "captions"), [((160, 64), 2), ((40, 64), 2), ((24, 480), 0), ((16, 4096), 0), ((4096, 16), 2)]
)
def test_a_caption_that_does_not_fit_is_shortened_or_left_out(tmp_path, size, captions):
    whole = ["round 0 (nearest to 1)", "round 50 (nearest to 51)"]
    compose([row("", n_frames=2, rounds=(1, 51))], tmp_path / "strip.svg", size)
    words = re.findall(r"<!-- (.+?) -->", (tmp_path / "strip.svg").read_text(encoding="utf-8"))
    assert len(words) == captions
    assert words == whole[:captions] or all(
        word.endswith("…") and caption.startswith(word[:-1]) for word, caption in zip(words, whole, strict=True)
    )


@pytest.mark.parametrize("dpi", [20, 72, 96, 150, 299, 300, 600, 2400])
def test_no_pixel_is_lost_at_any_density(tmp_path, dpi):
    for size in ((96, 72), (97, 71), (101, 63)):
        compose([row(n_frames=2)], tmp_path / "strip.png", size, dpi=dpi)
        layout = Layout(size, (2,), (True,), False)
        assert pixels_of(tmp_path / "strip.png").shape == (layout.height, layout.width, 3)
        with Image.open(tmp_path / "strip.png") as image:
            assert image.info["dpi"] == pytest.approx((dpi, dpi), rel=1e-3)


def test_a_strip_is_as_large_on_paper_as_its_density_says(tmp_path):
    compose([row(n_frames=1)], tmp_path / "strip.pdf", (272, 172), dpi=100)
    layout = Layout((272, 172), (1,), (True,), False)
    box = re.search(rb"/MediaBox \[ ([0-9. ]+) \]", (tmp_path / "strip.pdf").read_bytes())
    assert [float(side) for side in box[1].split()] == pytest.approx(
        [0, 0, layout.width * 0.72, layout.height * 0.72], abs=0.1
    )


def test_a_dark_strip_has_light_words_on_a_dark_page(tmp_path):
    compose([row()], tmp_path / "light.png", SIZE)
    compose([row()], tmp_path / "dark.png", SIZE, paper=BLACK)
    light, dark = pixels_of(tmp_path / "light.png"), pixels_of(tmp_path / "dark.png")
    top = Layout(SIZE, (3,), (True,), False).corner(0, 0)[1]
    assert (light[:top] < 128).any(axis=2).sum() == pytest.approx((dark[:top] > 128).any(axis=2).sum(), rel=0.3)
    assert dark[0, 0].tolist() == [28, 28, 30]


def test_a_transparent_strip_is_opaque_where_atoms_and_letters_are(tmp_path):
    clear = replace(WHITE, page="none")
    for extension in ("png", "webp"):
        compose([row(background=None)], tmp_path / f"strip.{extension}", SIZE, paper=clear)
        with Image.open(tmp_path / f"strip.{extension}") as image:
            opacity = np.asarray(image.convert("RGBA"))[:, :, 3]
        assert 0.02 < (opacity == 255).mean() < 0.5
        assert (opacity == 0).mean() > 0.5
        assert opacity[0, 0] == 0
    [file] = frames_to([row(n_frames=1, background=None)], tmp_path / "film", SIZE)
    with Image.open(file) as image:
        assert (image.mode, image.size) == ("RGBA", SIZE)


def test_a_transparent_jpeg_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"strip.jpg: a JPEG cannot be transparent; use .png, .webp, .pdf or .svg$"):
        compose([row(background=None)], tmp_path / "strip.jpg", SIZE, paper=replace(WHITE, page="none"))


def test_a_close_up_is_filled_by_some_atoms_wherever_they_go():
    """The first three of twelve go 2 to the right between the first frame and the last."""
    camera = row(filling=np.arange(3))._camera(SIZE)
    assert camera.width < row()._camera(SIZE).width
    flown = [frame(0), frame(50, 400.0)]
    far = row(frames=flown, rounds=(0, 50), filling=np.arange(3))._camera(SIZE)
    assert far.width > 300


def test_single_frames(tmp_path):
    files = frames_to([row()], tmp_path / "new" / "folder", SIZE)
    assert [file.name for file in files] == ["round-000.png", "round-050.png", "round-100.png"]
    for file, picture in zip(files, pictures(row()), strict=True):
        assert file.parent == tmp_path / "new" / "folder"
        assert (pixels_of(file) == picture).all()


def test_single_frames_of_several_rows(tmp_path):
    files = frames_to([row(n_frames=1), row(n_frames=2)], tmp_path, SIZE)
    assert [file.name for file in files] == ["row-1-round-00.png", "row-2-round-00.png", "row-2-round-50.png"]


@pytest.mark.parametrize(
    ("name", "size", "message"),
    [
        (
            "a.gif",
            SIZE,
            "a.gif: the extension tells the format; use .png, .jpg, .jpeg, .webp, .pdf or .svg (got `.gif`)",
        ),
        ("a.png", (10, 100), "a frame must be from 16 to 4096 pixels wide and high (got 10x100)"),
        ("a.png", (100, 5000), "a frame must be from 16 to 4096 pixels wide and high (got 100x5000)"),
        (
            "a.png",
            (4096, 100),
            "a.png: a strip of 8 frames would have 32852×141 pixels, more than 16000 along a side; "
            "choose fewer rounds or smaller frames",
        ),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, monkeypatch, name, size, message):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as caught:
        compose([row("", n_frames=8)], Path(name), size)
    assert str(caught.value) == message
    assert not list(tmp_path.iterdir())


def test_frames_do_not_go_into_a_file(tmp_path):
    (tmp_path / "frames").touch()
    with pytest.raises(InputError, match=r"frames: this is a file; give the name of a folder$"):
        frames_to([row()], tmp_path / "frames", SIZE)


def test_matplotlib_waits_until_it_is_needed():
    code = "import sys, atomsim.drawing; print({'matplotlib', 'PIL', 'h5py'} & set(sys.modules))"
    assert finish(program=python(code)).stdout == "set()\n"
