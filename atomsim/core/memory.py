"""The memory of a run: what it has to remember besides positions and velocities, as named arrays of fixed form.

A model says which arrays (its *layout*), so a row of a trajectory has a constant length. Where nothing is remembered
the layout and the memory are empty, and then neither digests nor files know of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

Number: TypeAlias = Literal["float64", "int64", "bool"]
"""What an array of a memory is made of: a controller's state, a random stream, whether each bond is broken."""


@dataclass(frozen=True, slots=True)
class MemoryArray:
    """The form of one array that a run remembers.

    Attributes:
        name: whose it is and what, `controllers.gait.phase`; unique in its layout.
        number: the type of its numbers.
        shape: its shape; it never changes.
    """

    name: str
    number: Number
    shape: tuple[int, ...]

    @property
    def dtype(self) -> np.dtype[Any]:
        """The type of its numbers in files and digests: little-endian."""
        return np.dtype(self.number).newbyteorder("<")

    @property
    def n_bytes(self) -> int:
        """How much it takes in a frame."""
        return math.prod(self.shape) * self.dtype.itemsize


Layout: TypeAlias = tuple[MemoryArray, ...]
"""The arrays of a memory, in their order."""


class Memory(Mapping[str, NDArray[Any]]):
    """What a run remembers at one round: read-only copies of arrays, by name, in the order of the layout.

    Args:
        arrays: the values; they are copied.
    """

    __slots__ = ("_arrays",)

    def __init__(self, arrays: Mapping[str, NDArray[Any]] | None = None) -> None:
        self._arrays = {name: np.array(array) for name, array in (arrays or {}).items()}
        for array in self._arrays.values():
            array.setflags(write=False)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __eq__(self, other: object) -> bool:
        return self is other  # as for all records that hold arrays

    def __hash__(self) -> int:
        return id(self)

    @property
    def layout(self) -> Layout:
        """The form of its arrays."""
        return tuple(MemoryArray(name, array.dtype.name, array.shape) for name, array in self._arrays.items())  # type: ignore[arg-type]


EMPTY = Memory()
"""The memory of a model that remembers nothing."""
