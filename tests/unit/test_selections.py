"""Which atoms a selection names, and what is said when it names none."""

from __future__ import annotations

import pytest

from atomsim.compiler import selections
from atomsim.compiler.selections import GroupLayout, SelectionError, Selections

SELECTIONS = Selections(
    {
        "ring": GroupLayout(0, 10, (10,), True, 1),
        "floor": GroupLayout(10, 22, (4, 3), False, 1),
        "brick": GroupLayout(22, 34, (2, 3, 2), False, 1),
    },
    34,
)


@pytest.mark.parametrize(
    ("selection", "expected"),
    [
        (("ring",), list(range(10))),
        (("ring[0]",), [0]),
        (("ring[-1]",), [9]),
        (("ring[2:4]",), [2, 3]),
        (("ring[:2]",), [0, 1]),
        (("ring[::4]",), [0, 4, 8]),
        (("ring[-3:]",), [7, 8, 9]),
        (("ring[8:99]",), [8, 9]),
        (("floor[0, :]",), [10, 14, 18]),
        (("floor[:, 0]",), [10, 11, 12, 13]),
        (("floor[-1, -1]",), [21]),
        (("floor[1:3, ::2]",), [11, 12, 19, 20]),
        (("floor[5]",), [15]),
        (("brick[1, 2, 0]",), [27]),
        (("brick[:, 1, :]",), [24, 25, 30, 31]),
        (("all",), list(range(34))),
        (("ring[4:6]", "ring[5]", "floor[0, 0]"), [4, 5, 10]),
        (("floor[0, 0]", "ring[1]"), [1, 10]),
    ],
)
def test_atoms_ascend_without_duplicates(selection: tuple[str, ...], expected: list[int]) -> None:
    assert SELECTIONS.atoms(selection).tolist() == expected


def test_the_expression_of_an_atom_selects_it_alone() -> None:
    written = [SELECTIONS.expression(atom) for atom in range(34)]
    assert (written[9], written[10], written[33]) == ("ring[9]", "floor[0]", "brick[11]")
    assert [SELECTIONS.atoms((expression,)).tolist() for expression in written] == [[atom] for atom in range(34)]


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("rong", "there is no group `rong`; did you mean `ring`?"),
        ("water", "there is no group `water`; the groups are ring, floor, brick"),
        ("ring[10]", "`ring[10]` is out of range: ring has 10 there, 0 to 9"),
        ("ring[-11]", "`ring[-11]` is out of range: ring has 10 there, 0 to 9"),
        ("ring[10:]", "`ring[10:]` selects no atoms: ring has 10 there, 0 to 9"),
        ("floor[4, 0]", "`floor[4, 0]` is out of range: floor has 4 there, 0 to 3"),
        ("floor[0, 3:]", "`floor[0, 3:]` selects no atoms: floor has 3 there, 0 to 2"),
        ("floor[0, 0, 0]", "`floor[0, 0, 0]` has 3 indices, but floor is 4 × 3 atoms (one or 2 indices)"),
        ("ring[0, 0]", "`ring[0, 0]` has 2 indices, but ring is 10 atoms (one index)"),
    ],
)
def test_what_names_no_atoms_is_told(expression: str, message: str) -> None:
    with pytest.raises(SelectionError) as error:
        SELECTIONS.atoms((expression,))
    assert str(error.value) == message


def test_grid_places_are_x_first() -> None:
    places = SELECTIONS.grid_places("floor[2:, 1]")
    assert places is not None
    assert places.tolist() == [[2, 1], [3, 1]]
    places = SELECTIONS.grid_places("brick[1, 2, 0]")
    assert places is not None
    assert places.tolist() == [[1, 2, 0]]


@pytest.mark.parametrize("expression", ["ring", "ring[3]", "all"])
def test_only_planes_and_blocks_have_a_grid(expression: str) -> None:
    assert SELECTIONS.grid_places(expression) is None


def test_only_a_name_alone_is_a_whole_group() -> None:
    assert SELECTIONS.whole_group("ring") == GroupLayout(0, 10, (10,), True, 1)
    assert SELECTIONS.whole_group("ring[:]") is None
    assert SELECTIONS.whole_group("all") is None


COPIED = Selections(
    {
        "palm": GroupLayout(0, 4, (4,), True, 1),
        "finger": GroupLayout(4, 13, (3,), True, 3),
        "nail": GroupLayout(13, 25, (2, 2), False, 3),
        "toe": GroupLayout(25, 29, (2,), False, 2),
    },
    29,
)


@pytest.mark.parametrize(
    ("selection", "by_copy"),
    [
        (("palm",), [[0, 1, 2, 3]]),
        (("finger",), [[4, 5, 6], [7, 8, 9], [10, 11, 12]]),
        (("finger[-1]",), [[6], [9], [12]]),
        (("finger.1",), [[7, 8, 9]]),
        (("finger.2[:2]",), [[10, 11]]),
        (("nail[0, :]",), [[13, 15], [17, 19], [21, 23]]),
        (("nail.1[:, 1]",), [[19, 20]]),
        (("finger[0]", "nail[3]"), [[4, 16], [7, 20], [10, 24]]),
        (("finger[0]", "palm[1]"), [[1, 4], [1, 7], [1, 10]]),
        (("finger", "finger.1"), [[4, 5, 6, 7, 8, 9], [7, 8, 9], [7, 8, 9, 10, 11, 12]]),
        (("finger.0", "nail.2[0]"), [[4, 5, 6, 21]]),
        (("finger.0", "toe"), [[4, 5, 6, 25, 26], [4, 5, 6, 27, 28]]),
    ],
)
def test_an_index_counts_in_each_copy(selection: tuple[str, ...], by_copy: list[list[int]]) -> None:
    assert [atoms.tolist() for atoms in COPIED.by_copy(selection)] == by_copy
    assert COPIED.atoms(selection).tolist() == sorted({atom for atoms in by_copy for atom in atoms})


def test_the_expression_of_an_atom_of_a_copy_selects_it_alone() -> None:
    written = [COPIED.expression(atom) for atom in range(29)]
    assert (written[3], written[4], written[12], written[21]) == ("palm[3]", "finger.0[0]", "finger.2[2]", "nail.2[0]")
    assert [COPIED.atoms((expression,)).tolist() for expression in written] == [[atom] for atom in range(29)]


def test_copies_of_one_number_meet() -> None:
    def matched(*between: tuple[str, ...]) -> list[tuple[list[int], list[int]]]:
        left, right = COPIED.matched((between[0], between[1]))
        return [(one.tolist(), other.tolist()) for one, other in zip(left, right, strict=True)]

    assert matched(("finger[-1]",), ("nail[0]",)) == [([6], [13]), ([9], [17]), ([12], [21])]
    assert matched(("palm[0]",), ("toe[0]",)) == [([0], [25]), ([0], [27])]
    assert matched(("finger.0[0]",), ("finger.1[0]",)) == [([4], [7])]


def test_the_grid_of_a_copy_is_that_of_the_group() -> None:
    for expression in ("nail[0, :]", "nail.1[0, :]"):
        places = COPIED.grid_places(expression)
        assert places is not None
        assert places.tolist() == [[0, 0], [0, 1]]


@pytest.mark.parametrize(
    ("selection", "message", "blamed"),
    [
        (("finger.3",), "`finger.3` is out of range: finger has 3 copies, 0 to 2", "finger.3"),
        (("palm.0",), "`palm.0` is no copy: palm has no copies", "palm.0"),
        (("finger[3]",), "`finger[3]` is out of range: finger has 3 there, 0 to 2", "finger[3]"),
        (
            ("finger", "palm", "toe[1]"),
            "`finger` has 3 copies and `toe[1]` has 2: copies of one number go together; name the ones that are meant, "
            "such as `toe.0[1]`",
            "toe[1]",
        ),
    ],
)
def test_what_is_said_of_copies_that_are_not_there(selection: tuple[str, ...], message: str, blamed: str) -> None:
    with pytest.raises(SelectionError) as error:
        COPIED.by_copy(selection)
    assert (str(error.value), error.value.expression) == (message, blamed)


def test_selections_are_counted_together_and_each_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 12 atoms each, 96 bytes: two fit into memory, however often they are used, the third does not."""
    monkeypatch.setattr(selections, "LARGE", 100)
    monkeypatch.setattr(selections, "free_memory", lambda: 200)
    chosen = Selections({"a": GroupLayout(0, 13, (13,), False, 1)}, 13)
    for _ in range(3):
        assert chosen.atoms(("a[1:]",)).size == chosen.atoms(("a[:-1]",)).size == 12
    with pytest.raises(SelectionError) as error:
        chosen.atoms(("a[2:]", "a[1]"))
    assert str(error.value) == "the selections up to here name more atoms than fit into memory"
    assert error.value.expression == "a[2:]"


def test_small_selections_ask_for_no_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(selections, "LARGE", 96)
    monkeypatch.setattr(selections, "free_memory", lambda: 0)
    assert Selections({"a": GroupLayout(0, 12, (12,), False, 1)}, 12).atoms(("a",)).size == 12
