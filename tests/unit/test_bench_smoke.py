"""The benchmark runs, its plain loop computes what atomsim computes, and the page shows the numbers that are kept."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from support.everything import EVERYTHING
from support.running import compiled, digest_of

import atomsim
from atomsim.core.model import Model, State
from atomsim.core.pairs.collisions import table_pairs_near
from benchmarks import fluid, page, pour, rounds
from benchmarks.bench import main
from benchmarks.engines import NUMPY, PLAIN, Engine
from benchmarks.pairs import pair_table
from benchmarks.plain import PlainStepper
from benchmarks.tables import MISSING, Answer, Table, answers_table

NOWHERE = Engine("elsewhere", "no_such_package", "benchmarks.peers.elsewhere", "Stepper")


@pytest.fixture(params=["rods", "balls"])
def scene(request: pytest.FixtureRequest) -> tuple[Model, State]:
    return atomsim.compile(atomsim.load(rounds.SCENES / f"{request.param}.yaml"))


def test_plain_loop_has_our_bits_while_things_touch(scene: tuple[Model, State]) -> None:
    model, state = scene
    frames = list(atomsim.simulate(model, state, rounds.START + rounds.COMPARED))
    assert any(frame.observables.contacts for frame in frames if frame.round_index >= rounds.START)
    plain = PlainStepper(model, state)
    plain.advance(frames[-1].round_index)
    assert digest_of(plain.state()) == frames[-1].digest
    assert plain.state().round_index == frames[-1].round_index


def test_pair_table_holds_every_declared_collision(scene: tuple[Model, State]) -> None:
    model, state = scene
    pairs = pair_table(model)
    is_collision = pairs.ceiling == 0.0
    written_out = np.column_stack((pairs.first, pairs.second))[is_collision]
    found = [np.column_stack(table_pairs_near(table, state.position.T, cutoff=1e6)) for table in model.collisions]
    np.testing.assert_array_equal(written_out, np.concatenate(found))
    assert (pairs.rest_squared[is_collision] == 4.0).all()


def test_pairs_seen_from_every_atom(scene: tuple[Model, State]) -> None:
    pairs = pair_table(scene[0])
    atom, partner, rest_squared, _ = pairs.seen_from_every_atom()
    assert atom.size == 2 * pairs.first.size
    assert (np.diff(atom) >= 0).all()
    both = np.lexsort((rest_squared, partner, atom)), np.lexsort((rest_squared, atom, partner))
    np.testing.assert_array_equal(atom[both[0]], partner[both[1]])
    np.testing.assert_array_equal(rest_squared[both[0]], rest_squared[both[1]])


def test_scenes_that_peers_could_not_compute_are_refused() -> None:
    with pytest.raises(ValueError, match=r"only scenes whose forces are constant pushes"):
        pair_table(compiled(**EVERYTHING)[0])


def test_rounds_are_timed_and_what_is_missing_is_said() -> None:
    results = rounds.measure("rods", quick=True, engines=(NUMPY, PLAIN, NOWHERE))
    assert (results["atoms"], results["bonds"], results["collision_pairs"]) == (140, 4830, 8806)
    assert all(results["engines"][engine.name]["is_same"] for engine in (NUMPY, PLAIN))
    assert results["engines"][NOWHERE.name] is None
    rows = rounds.tables(results)[0].rows
    assert {row[0] for row in rows} == {NUMPY.name, PLAIN.name, NOWHERE.name}
    assert rows[-1][:2] == (NOWHERE.name, MISSING)
    assert {answer.target for answer in rounds.answers(results)} == {"≥ 2.8 times", "< 1e-09"}


def test_command_prints_tables_and_keeps_numbers_for_the_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = tmp_path / "speed.json"
    main(["--quick", "--only", "memory", "--json", str(kept)])
    printed = capsys.readouterr().out
    assert "A body of 480 atoms and 114,960 bonds" in printed
    results = json.loads(kept.read_text())
    assert list(results) == ["machine", "memory"]
    places = "".join(f"<!-- {name} -->\nold\n<!-- /{name} -->\n" for name in ("machine", "answers", "memory"))
    filled = page.filled(places, results)
    assert "old" not in filled
    assert "Quick and rough numbers." in filled
    assert page.filled(filled, results) == filled
    with pytest.raises(ValueError, match="the page has no place for memory"):
        page.filled(places.replace("/memory", "/memories"), results)


def test_pouring_is_a_whole_run_for_every_backend() -> None:
    results = pour.measure(quick=True)
    assert results["title"] == "A fluid of 1,000 atoms falls onto a plane of 784"
    for row in results["runs"].values():
        assert 20 < row["megabytes"] < 2000
        assert 1784 * 48 * 21 < row["file"] * 1e6 < 1.1 * 1784 * 48 * 21
    assert len(pour.tables(results)[0].rows) == len(results["runs"])


def test_unknown_sections_are_named(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--only", "rods,clothes"])
    assert "there is no section clothes; choose from rods,balls,fluid" in capsys.readouterr().err


def test_page_shows_the_numbers_that_are_kept() -> None:
    text = page.PAGE.read_text(encoding="utf-8")
    assert page.filled(text, json.loads(page.NUMBERS.read_text(encoding="utf-8"))) == text
    assert page.PICTURE.exists()


def test_tables_line_up_and_tell_what_was_not_reached() -> None:
    assert Table("Sizes:", ("", "metres"), [("post", "9"), ("cloth", "20")]).markdown() == (
        "Sizes:\n\n|       | metres |\n| ----- | -----: |\n| post  |      9 |\n| cloth |     20 |\n"
    )
    assert answers_table([Answer("fast?", "1", "2", is_reached=False)]).rows == [("fast?", "1", "2", "**no**")]


def test_fluid_is_a_block_of_so_many_atoms_in_motion() -> None:
    model, state = fluid.free_fluid(60)
    assert model.n_atoms == 60
    assert fluid.fluid_scene(60)["groups"]["fluid"]["counts"] == [3, 4, 5]
    assert 0.2 < state.velocity.std() < 0.8
