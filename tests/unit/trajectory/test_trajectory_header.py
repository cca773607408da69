"""The header: made from a model, turned into plain values and back, and refused when it makes no sense."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from sample_run import SCENE, header, model

from atomsim.trajectory.guard import DamageError
from atomsim.trajectory.header import PLAIN, REMEMBERING, check_version, document, end_from, fields, header_from
from atomsim.trajectory.rows import count_frames


def test_header_of_a_model_names_every_declaration_and_bond() -> None:
    run = header()
    assert (run.title, run.scene, run.scene_name, run.n_atoms) == ("Two rods · τ", SCENE, "rods.yaml", 7)
    assert [str(origin) for origin in run.origins] == [
        "groups.left (rods.yaml:5)",
        "groups.right (rods.yaml:9)",
        "bonds.left (rods.yaml:13)",
        "bonds.right (rods.yaml:17)",
    ]
    assert run.bond.tolist() == [[0, 1], [4, 5]]
    assert [run.origins[i].name for i in run.bond_table] == ["left", "right"]
    assert run.bond.dtype == run.bond_table.dtype == np.int32


def test_a_scene_without_bonds_has_an_empty_table_of_them() -> None:
    bare = model()
    bare = type(bare)(bare.title, bare.time_step, bare.n_atoms, bare.groups, (), (), ())
    run = type(header()).of(bare, group_color=["#000000"] * 2, scene_text="", scene_name="-", rounds=1, record_every=1)
    assert run.bond.shape == (0, 2)
    assert run.bond_table.shape == (0,)


@pytest.mark.parametrize(("rounds", "recorded"), [(40, [0, 10, 20, 30, 40]), (15, [0, 10, 15]), (5, [0, 5]), (0, [0])])
def test_rounds_that_are_recorded(rounds: int, recorded: list[int]) -> None:
    assert [i for i in range(rounds + 1) if header(rounds).records(i)] == recorded
    assert count_frames(rounds, record_every=10) == len(recorded)


def test_the_document_survives_json_and_gives_the_same_header() -> None:
    run = header()
    again = header_from(json.loads(json.dumps(document(run))), run.bond, run.bond_table)
    assert document(again) == document(run)
    assert again.groups == run.groups
    assert again.origins == run.origins
    assert list(document(run)) == list(fields(PLAIN))


def test_copies_of_a_group_are_told_in_its_name() -> None:
    bare = model()
    left, right = bare.groups
    copied = replace(bare, groups=(replace(left, n_copies=left.stop - left.start), right))
    run = type(header()).of(
        copied, group_color=["#000000"] * 2, scene_text="", scene_name="-", rounds=1, record_every=1
    )
    values = document(run)
    assert values["group_names"] == ["left × 4", "right"]
    assert header_from(values, run.bond, run.bond_table).groups == copied.groups == run.groups
    with pytest.raises(DamageError, match="group_names"):
        header_from({**values, "group_names": ["left × 3", "right"]}, run.bond, run.bond_table)


def test_names_that_utf_8_cannot_write_are_made_writable() -> None:
    run = header()
    odd = replace(run, scene_name="a\udcff\0.yaml")
    assert document(odd)["scene_name"] == "a\\udcff\\0.yaml"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("title", 3),
        ("title", None),
        ("overrides", "rounds=3"),
        ("overrides", ["rounds=3", 3]),
        ("time_step", 1),
        ("time_step", math.nan),
        ("time_step", -0.1),
        ("n_atoms", True),
        ("n_atoms", 0),
        ("n_atoms", 2**31),
        ("rounds", -1),
        ("rounds", 2**63),
        ("record_every", 0),
        ("compress", 1),
        ("group_names", []),
        ("group_names", ["left"]),
        ("group_start", [0, 7]),
        ("group_start", [1, 4]),
        ("group_start", [0, 0]),
        ("group_color", ["#4682b4", "red"]),
        ("rule_names", ["groups.left", "groups.right", "bonds.left", "nowhere"]),
        ("rule_lines", [1]),
        ("schema_version", 0),
        ("schema_version", "1"),
    ],
)
def test_values_that_make_no_sense_are_refused_by_name(name: str, value: object) -> None:
    run = header()
    with pytest.raises(DamageError, match=rf"\(`{name}` makes no sense\)$"):
        header_from({**document(run), name: value}, run.bond, run.bond_table)


@pytest.mark.parametrize("name", fields(PLAIN))
def test_a_missing_value_is_refused_by_name(name: str) -> None:
    run = header()
    values = {key: value for key, value in document(run).items() if key != name}
    with pytest.raises(DamageError, match=f"`{name}`"):
        header_from(values, run.bond, run.bond_table)


@pytest.mark.parametrize("pair", [[-1, 1], [1, 1], [2, 1], [0, 7]])
def test_bonds_between_atoms_that_do_not_exist_are_refused(pair: list[int]) -> None:
    run = header()
    with pytest.raises(DamageError, match="`bonds` makes no sense"):
        header_from(document(run), np.array([[0, 1], pair], "<i4"), run.bond_table)


@pytest.mark.parametrize("table", [[0], [0, 4], [-1, 0]])
def test_bonds_of_a_declaration_that_does_not_exist_are_refused(table: list[int]) -> None:
    run = header()
    with pytest.raises(DamageError, match="`bond_table` makes no sense"):
        header_from(document(run), run.bond, np.array(table, "<i4"))


def test_a_later_version_asks_for_a_newer_program() -> None:
    later = REMEMBERING + 1
    with pytest.raises(DamageError) as caught:
        check_version({"schema_version": later})
    assert str(caught.value) == (
        f"written in version {later} of the trajectory file; this atomsim reads version {REMEMBERING}: "
        "a newer atomsim is needed"
    )


@pytest.mark.parametrize("values", [{}, {"end": "bored", "end_report": ""}, {"end": "finished"}, {"end": []}])
def test_an_unknown_end_is_refused(values: dict[str, object]) -> None:
    with pytest.raises(DamageError, match="`end` makes no sense"):
        end_from(values)
