"""What a simulation shows of itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ._errors import SimulationError
from ._native import Block

#: Numbers that are shown and cannot be written.
Numbers = npt.NDArray[np.float64]


def shown(block: Block) -> Numbers:
    """An array over numbers of the library, without a copy; it is read-only, and keeps them alive."""
    array: Numbers = np.asarray(block)
    return array


class Step(NamedTuple):
    """What a step did.

    Attributes
    ----------
    dt
        Its size, s.
    refused
        Attempts that were refused before it.
    error
        Error estimate over the mean edge; 0 for schemes without one and steps of a fixed size.
    limited
        Whether contacts made this step or the one planned after it shorter than the error estimate would have.
    """

    dt: float
    refused: int
    error: float
    limited: bool


class Series(NamedTuple):
    """What there is to know about a series.

    Attributes
    ----------
    unit
        Its unit, empty where it has none.
    of_cells
        Whether it has a number for each cell; else it has a single one of the scene.
    """

    unit: str
    of_cells: bool


@dataclass(frozen=True, eq=False)
class CellType:
    """A type of cells, as it is at this instant.

    Attributes
    ----------
    name
        Its name in the document.
    atom_count
        Atoms (vertices of the mesh) of one cell.
    facets
        Three atoms each, numbered from 0 within the cell, outward.
    is_closed
        Whether the surface encloses a volume.
    loads, fibres
        Names of its loads and of its fibres.
    cells
        Ids of its cells, in order.
    """

    name: str
    atom_count: int
    facets: npt.NDArray[np.uint32]
    is_closed: bool
    loads: tuple[str, ...]
    fibres: tuple[str, ...]
    cells: tuple[int, ...]

    @classmethod
    def of(cls, facts: tuple[str, int, bytes, bool, list[str], list[str], list[int]]) -> CellType:
        """The type that the library tells of."""
        name, atoms, facets, closed, loads, fibres, cells = facts
        numbers = np.frombuffer(facets, dtype=np.uint32).reshape(-1, 3)
        return cls(name, atoms, numbers, closed, tuple(loads), tuple(fibres), tuple(cells))


@dataclass(frozen=True, eq=False)
class Field:
    """The fields of one document of equations at one instant. It stays what it is while the simulation goes on.

    Attributes
    ----------
    name
        The name of the document in the experiment's ``[chemistry]``.
    time
        The instant, s.
    species
        Names of its species.
    units
        The unit of each species as its document writes it, empty where it has none.
    spacing
        Size of a box along x, y and z, um.
    origin
        The corner of the first box, um.
    values
        Read-only, without a copy: species, then boxes along z (one where the field lies on the substrate), y and x.
    """

    name: str
    time: float
    species: tuple[str, ...]
    units: dict[str, str]
    spacing: tuple[float, float, float]
    origin: tuple[float, float, float]
    values: Numbers

    def __getitem__(self, species: str) -> Numbers:
        """The values of a species: boxes along z, y and x."""
        if species not in self.species:
            known = ", ".join(f"`{name}`" for name in self.species)
            raise SimulationError("unknown", f"there is no species `{species}`", f"there is {known}")
        values: Numbers = self.values[self.species.index(species)]
        return values
