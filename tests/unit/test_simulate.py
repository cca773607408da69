"""Which rounds become frames, what is in them, and how a blow-up ends a run."""

from __future__ import annotations

import numpy as np
import pytest
from support.running import after, atoms_at, compiled, digest_of

from atomsim.core.model import Frame, Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.simulate import simulate
from atomsim.errors import BlowUpError


def falling() -> tuple[Model, State]:
    return compiled({"a": atoms_at((0, 0, 9))}, 0.1, forces={"g": {"kind": "gravity", "impulse": [0, 0, -0.5]}})


def rounds_of(rounds: int, record_every: int, start: int = 0) -> list[int]:
    model, state = falling()
    begin = State(start, state.position, state.velocity)
    return [frame.round_index for frame in simulate(model, begin, rounds, record_every)]


def test_frames_are_the_first_the_multiples_and_the_last() -> None:
    assert rounds_of(10, 5) == [0, 5, 10]
    assert rounds_of(11, 5) == [0, 5, 10, 11]
    assert rounds_of(3, 5) == [0, 3]
    assert rounds_of(0, 5) == [0]
    assert rounds_of(12, 5, start=7) == [7, 10, 12]
    assert rounds_of(5, 5, start=7) == [7]


def test_reports_do_not_cut_short_stretches_ever_shorter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames end a stretch; the next one begins as long as stretches have proved to be quick."""
    monkeypatch.setattr("atomsim.core.pace.REPORT_SECONDS", 1e9)
    model, state = falling()
    heard: list[int] = []
    for _ in simulate(model, state, 40, 10, report=heard.append):
        pass
    assert heard == [0, 1, 3, 7, 10, 18, 20, 30, 40]


def test_a_slow_stretch_makes_the_next_ones_shorter(monkeypatch: pytest.MonkeyPatch) -> None:
    """A round takes 0.03 s by this clock: four are too many for a tenth of a second."""
    clock = [0.0]
    monkeypatch.setattr("atomsim.core.pace.time.perf_counter", lambda: clock[0])

    class Slow(NumpyStepper):
        def advance(self, n_rounds: int) -> None:
            super().advance(n_rounds)
            clock[0] += 0.03 * n_rounds

    model, state = falling()
    heard: list[int] = []
    for _ in simulate(model, state, 15, 100, Slow, report=heard.append):
        pass
    assert heard == [0, 1, 3, 7, 9, 13, 15]


def test_a_frame_is_what_was_computed() -> None:
    model, state = falling()
    *_, frame = simulate(model, state, 20)
    expected = after(model, state, 20)
    assert (frame.round_index, frame.time) == (20, 20 * 0.1)
    assert frame.digest == digest_of(expected)
    assert np.array_equal(frame.state.position, expected.position)
    assert frame.observables.momentum.tolist() == [0, 0, -10]


@pytest.mark.parametrize("n_atoms", [1, 2])
def test_frames_are_safe_to_keep(n_atoms: int) -> None:
    """Memory is shared by no two frames, and not with the run; a single atom's arrays are easily taken for copies."""
    places = [(0.0, 0.0, 5.0 * number) for number in range(n_atoms)]
    model, state = compiled({"a": atoms_at(*places)}, forces={"g": {"kind": "gravity", "impulse": [1, 0, 0]}})
    frames = list(simulate(model, state, 3, 1))
    assert [frame.velocity[0, 0] for frame in frames] == [0, 1, 2, 3]
    assert [frame.digest for frame in frames] == [digest_of(frame.state) for frame in frames]
    assert state.velocity[0, 0] == 0


def test_the_states_of_a_stepper_are_copies() -> None:
    model, state = falling()
    stepper = NumpyStepper(model, state)
    before = stepper.state()
    stepper.advance(1)
    assert before.velocity[0, 2] == 0.0
    assert stepper.state().velocity[0, 2] == -0.5
    assert (before.round_index, stepper.state().round_index) == (0, 1)


def blow_up(record_every: int) -> tuple[list[Frame], str]:
    """Run a chain whose step is far too large; return its frames and how it ends."""
    model, state = compiled(
        {
            "calm": atoms_at((0, 0, 0)),
            "chain": {"shape": "string", "count": 3, "step": [1.1, 0, 0], "centre": [9, 0, 0]},
        },
        time_step=3.0,
        bonds={"b": {"within": "chain", "rule": "all-pairs"}},
        jitter={"amplitude": 1e-3},
    )
    frames: list[Frame] = []
    with pytest.raises(BlowUpError) as error:
        frames.extend(simulate(model, state, 5000, record_every))
    return frames, str(error.value)


def test_a_blow_up_ends_the_run_with_its_round_after_all_sound_frames() -> None:
    frames, message = blow_up(record_every=1)
    assert [frame.round_index for frame in frames] == list(range(len(frames)))
    assert message.startswith(f"the simulation blew up in round {len(frames)}: chain[")
    assert all(np.isfinite(frame.position).all() for frame in frames)


@pytest.mark.parametrize("record_every", [7, 100, 5000])
def test_a_blow_up_is_found_to_the_round_however_seldom_frames_are(record_every: int) -> None:
    frames, message = blow_up(record_every)
    assert message == blow_up(1)[1]
    assert frames[-1].round_index % record_every == 0
