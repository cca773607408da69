"""The bond subtotals of a share of atoms, compiled; knows how bonds are laid out, not why.

fb = (c_k − c_i) · (1 − r²/d²) (paper section 2.3), over partners in increasing order, starting from +0.0.
"""

from __future__ import annotations

from atomsim.core.model import Floats
from atomsim.core.numba_backend.jit import inner
from atomsim.core.plans.records import LANES, Bonds


@inner
def bond_weight(dx: float, dy: float, dz: float, rest_squared: float) -> float:
    """Return 1 − r² · (1/d²), and 0 where nothing is bound."""
    inverse = 1.0 / ((dx * dx + dy * dy) + dz * dz)
    weight = 1.0 - rest_squared * inverse
    return weight if rest_squared >= 0.0 else 0.0


@inner
def add_tiles(table: int, bonds: Bonds, position: Floats, impulse: Floats, workspace: Floats, stop: int) -> None:
    """Add the subtotals of a table's tiles to the slots before `stop`; `workspace` is (2, 3, LANES)."""
    own, subtotal = workspace[0], workspace[1]
    for tile in range(bonds.table_first_tile[table], bonds.table_first_tile[table + 1]):
        start = bonds.tile_slot[tile]
        for component in range(3):
            here = position[component, start : start + LANES]
            for lane in range(LANES):
                own[component, lane] = here[lane]
                subtotal[component, lane] = 0.0
        if bonds.tile_is_banded[tile]:
            _add_banded_passes(tile, bonds, position, own, subtotal)
        else:
            _add_passes(tile, bonds, position, own, subtotal)
        for component in range(3):
            total = impulse[component, start:stop]
            for lane in range(min(LANES, stop - start)):
                total[lane] += subtotal[component, lane]


@inner
def _add_passes(tile: int, bonds: Bonds, position: Floats, own: Floats, subtotal: Floats) -> None:
    """Add one partner after the other, each to all lanes."""
    own_x, own_y, own_z = own[0], own[1], own[2]
    total_x, total_y, total_z = subtotal[0], subtotal[1], subtotal[2]
    for number in range(bonds.tile_first_pass[tile], bonds.tile_first_pass[tile + 1]):
        partner = bonds.pass_partner[number]
        x, y, z = position[0, partner], position[1, partner], position[2, partner]
        rest_squared = bonds.pass_rest_squared[number]
        for lane in range(LANES):
            dx, dy, dz = x - own_x[lane], y - own_y[lane], z - own_z[lane]
            weight = bond_weight(dx, dy, dz, rest_squared[lane])
            total_x[lane] += weight * dx
            total_y[lane] += weight * dy
            total_z[lane] += weight * dz


@inner
def _add_banded_passes(tile: int, bonds: Bonds, position: Floats, own: Floats, subtotal: Floats) -> None:
    """Add one offset after the other: to each lane the atom that far from it."""
    own_x, own_y, own_z = own[0], own[1], own[2]
    total_x, total_y, total_z = subtotal[0], subtotal[1], subtotal[2]
    for number in range(bonds.tile_first_pass[tile], bonds.tile_first_pass[tile + 1]):
        start = bonds.tile_slot[tile] + bonds.pass_partner[number]
        x = position[0, start : start + LANES]
        y = position[1, start : start + LANES]
        z = position[2, start : start + LANES]
        rest_squared = bonds.pass_rest_squared[number]
        for lane in range(LANES):
            dx, dy, dz = x[lane] - own_x[lane], y[lane] - own_y[lane], z[lane] - own_z[lane]
            weight = bond_weight(dx, dy, dz, rest_squared[lane])
            total_x[lane] += weight * dx
            total_y[lane] += weight * dy
            total_z[lane] += weight * dz


@inner
def add_rows(table: int, bonds: Bonds, position: Floats, impulse: Floats) -> None:
    """Add the subtotals of a table's rows."""
    x, y, z = position[0], position[1], position[2]
    for row in range(bonds.table_first_row[table], bonds.table_first_row[table + 1]):
        atom = bonds.row_slot[row]
        total_x, total_y, total_z = 0.0, 0.0, 0.0
        for entry in range(bonds.row_first_entry[row], bonds.row_first_entry[row + 1]):
            partner = bonds.entry_partner[entry]
            dx, dy, dz = x[partner] - x[atom], y[partner] - y[atom], z[partner] - z[atom]
            weight = bond_weight(dx, dy, dz, bonds.entry_rest_squared[entry])
            total_x += weight * dx
            total_y += weight * dy
            total_z += weight * dz
        impulse[0, atom] += total_x
        impulse[1, atom] += total_y
        impulse[2, atom] += total_z
