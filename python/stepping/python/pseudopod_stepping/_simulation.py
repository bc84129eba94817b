"""The simulation that Python steps."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._native import Core
from ._toml import toml
from ._views import CellType, Field, Numbers, Series, Step, shown


class Simulation:
    """A simulation in memory, made from an experiment in a file. Nothing is written to disk.

    Parameters
    ----------
    path
        The document.
    overrides
        Keys that are to be changed, as in ``{"run.until": "10 s", "cells.walker.number": 20}``: texts with their units,
        numbers, truths, lists of these.
    seed
        Another seed.
    threads
        Threads of its own; without, all cores. Results do not depend on it.

    Raises
    ------
    SimulationError
        If the document is at fault, with all that is wrong in ``faults``.

    Notes
    -----
    Threads of Python may share a simulation: while one steps it the others go on, and whoever asks it something waits
    until the step is made.
    """

    _core: Core

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        overrides: Mapping[str, Any] | None = None,
        seed: int | None = None,
        threads: int | None = None,
    ) -> None:
        self._core = Core.from_file(os.fspath(path), _sets(overrides), seed, threads)

    @classmethod
    def from_text(
        cls,
        text: str,
        *,
        name: str = "experiment",
        equations: Mapping[str, str] | None = None,
        overrides: Mapping[str, Any] | None = None,
        seed: int | None = None,
        threads: int | None = None,
    ) -> Simulation:
        """A simulation of a document in a text.

        Parameters
        ----------
        text
            The document. Paths in it start from the working folder.
        name
            Stands for it in messages.
        equations
            Texts of documents of equations that are in no file, by the paths that the document names them with.
        overrides, seed, threads
            As for a document in a file.
        """
        made = cls.__new__(cls)
        made._core = Core.from_text(name, text, equations or {}, _sets(overrides), seed, threads)
        return made

    def __repr__(self) -> str:
        return f"<Simulation at {self.time:g} s after {self.steps} steps, {len(self.cells)} cells>"

    # Going on

    def step(self) -> Step:
        """Makes one step, whose size the experiment's integrator chooses. Other threads of Python go on meanwhile.

        Raises
        ------
        SimulationError
            If the numbers fail, or cells that are due cannot come; the simulation is then the one before the step.
        """
        return Step(*self._core.step())

    def run_until(self, time: float) -> None:
        """Makes steps until a time, s, at which the last one ends exactly; it may lie beyond the end of the document.

        An interrupt (Ctrl-C) ends it after the step under way, as a ``KeyboardInterrupt``.
        """
        self.run(time)

    def run(
        self,
        until: float | None = None,
        *,
        stop: Callable[[Simulation], object] | None = None,
        every: float | None = None,
    ) -> object:
        """Makes steps until a time, or until a rule of your own ends it.

        Parameters
        ----------
        until
            The time, s; without, the end of the document. The last step ends exactly there.
        stop
            Called with the simulation after every step: to look, to change what cells do, and to stop, by returning
            something that is true. What it raises comes out as it is, after a whole step.
        every
            Calls ``stop`` only after the first step that reaches a multiple of this time, s. No step is shortened for
            it.

        Returns
        -------
        object
            What ``stop`` returned where that ended it; ``None`` where the time was reached.
        """
        if every is not None and not (every > 0 and math.isfinite(every)):
            raise ValueError(f"the time between looks cannot be {every}: a time above 0 s was expected")
        end = self.end if until is None else float(until)
        before = self.time
        while self._core.step_towards(end) is not None:
            if stop is None:
                continue
            now = self.time
            if every is None or _passed(before, now, every):
                answer = stop(self)
                if answer:
                    return answer
            before = self.time  # the rule may have gone back
        return None

    # Looking

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._core.time()

    @property
    def steps(self) -> int:
        """Steps made since the start of the experiment."""
        return self._core.steps()

    @property
    def end(self) -> float:
        """The end of the experiment as the document has it, s."""
        return self._core.end()

    @property
    def notices(self) -> list[str]:
        """What there is to know about the start, in sentences."""
        return self._core.notices()

    @property
    def cells(self) -> list[int]:
        """Ids of all cells, in the order of positions and series: type after type. An id stays a cell's own."""
        return self._core.cells()

    @property
    def types(self) -> list[CellType]:
        """The types of cells, in the order of the document."""
        return [CellType.of(facts) for facts in self._core.types()]

    @property
    def positions(self) -> Numbers:
        """Positions of all atoms, um, cell after cell: an array of shape (n, 3).

        It shows this instant for good, and is read-only. The first look after a step copies the positions, which steps
        keep in another order, into a buffer; more looks at the same instant show the same one.
        """
        return shown(self._core.positions())

    def cell_positions(self, cell: int) -> Numbers:
        """Positions of the atoms of one cell, um: a part of :attr:`positions`, without a copy."""
        block, first, atoms = self._core.positions_of(cell)
        return shown(block)[first : first + atoms]

    @property
    def series_names(self) -> list[str]:
        """The series that there are: those of results, but for changes from frame to frame."""
        return [name for name, _, _ in self._core.series_infos()]

    @property
    def series_infos(self) -> dict[str, Series]:
        """Unit and scope of each series, by its name."""
        return {name: Series(unit, of_cells) for name, unit, of_cells in self._core.series_infos()}

    def series(self, name: str) -> Numbers:
        """A series at this instant: one number for each of :attr:`cells` (NaN where one has none), or a single one."""
        return shown(self._core.series(name))

    @property
    def field_names(self) -> list[str]:
        """The documents of fields, by their names in the experiment."""
        return self._core.fields()

    def field(self, name: str) -> Field:
        """The fields of a document at this instant: grid and values, without a copy. They stay when steps are made."""
        time, species, spacing, origin, values = self._core.field(name)
        names = tuple(name for name, _ in species)
        return Field(name, time, names, dict(species), _triple(spacing), _triple(origin), shown(values))

    # Driving

    def set(self, cell: int, what: str, value: float) -> None:
        """Sets what a link can set of a cell, from the next step on, until it is set again.

        Parameters
        ----------
        cell
            The cell.
        what
            ``fibre[NAME]``, ``load[NAME]``, ``motility.speed``, ``motility.bias.x``, ``stiffness``, ``adhesion``,
            ``rest_volume``, ``rest_volume_ratio``, ``secretion[FIELD]``, ``pseudopods.cue.x`` …
        value
            In um, s and pN.
        """
        self._core.set(cell, what, value)

    def set_force(self, cell: int, force: npt.ArrayLike) -> None:
        """Exerts a force on a cell, pN, spread evenly over its atoms, from the next step on until it is set again.

        Parameters
        ----------
        cell
            The cell.
        force
            Three numbers; zeros end it.
        """
        self._core.set_force(cell, _array(force, "a force", (3,)).tolist())

    def set_atom_forces(self, cell: int, forces: npt.ArrayLike) -> None:
        """Exerts a force on each atom of a cell, pN, in the order of :meth:`cell_positions`, until it is set again.

        Parameters
        ----------
        cell
            The cell.
        forces
            Of shape (n, 3).
        """
        self._core.set_atom_forces(cell, _array(forces, "forces on atoms", (-1, 3)).tobytes())

    def clear_forces(self) -> None:
        """Ends all forces that were set, on all cells."""
        self._core.clear_forces()

    def add_cells(
        self,
        type: str,
        centres: npt.ArrayLike | None = None,
        *,
        positions: Iterable[npt.ArrayLike] | None = None,
        parents: Sequence[int | None] | None = None,
    ) -> list[int]:
        """Adds cells of a type behind those that it has.

        Parameters
        ----------
        type
            The type.
        centres
            For each cell the point around which it is at rest, um: an array of shape (n, 3).
        positions
            In place of that, for each cell the positions of its atoms, um: arrays of shape (atoms, 3).
        parents
            For each cell the one that it was born from, or ``None``, which results tell.

        Returns
        -------
        list of int
            Their ids, which no cell had before.
        """
        if (centres is None) == (positions is None):
            raise TypeError("either the centres of cells or the positions of their atoms were expected")
        if centres is not None:
            new = [[centre] for centre in _array(centres, "centres of cells", (-1, 3)).tolist()]
        else:
            new = [_array(own, "positions of atoms", (-1, 3)).tolist() for own in positions or ()]
        born = [None] * len(new) if parents is None else list(parents)
        if len(born) != len(new):
            raise ValueError(f"{len(born)} parents were given for {len(new)} cells: one for each was expected")
        return self._core.add_cells(type, centres is not None, new, born)

    def remove_cells(self, cells: Iterable[int]) -> None:
        """Removes cells. The others keep their ids and their order."""
        self._core.remove_cells([int(cell) for cell in cells])

    # Saving

    def checkpoint(self) -> bytes:
        """The simulation at this instant: :meth:`restore` goes on from it along the same course, to the last bit."""
        return self._core.checkpoint()

    def restore(self, checkpoint: bytes) -> None:
        """Goes back to, or on from, a checkpoint of the same experiment."""
        self._core.restore(checkpoint)


def _sets(overrides: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    return [(key, toml(value)) for key, value in (overrides or {}).items()]


def _triple(numbers: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = numbers
    return x, y, z


def _array(numbers: npt.ArrayLike, what: str, shape: tuple[int, ...]) -> Numbers:
    """Numbers as an array of a shape, in which -1 stands for any length."""
    array: Numbers = np.asarray(numbers, dtype=np.float64)
    fits = array.ndim == len(shape) and all(
        wanted in (-1, found) for wanted, found in zip(shape, array.shape, strict=True)
    )
    if not fits:
        wanted = "(3,)" if shape == (3,) else "(n, 3)"
        raise ValueError(f"{what} cannot have the shape {array.shape}: {wanted} was expected")
    return array


def _passed(before: float, after: float, interval: float) -> bool:
    """Whether a multiple of an interval lies in (before, after]."""
    # The slack lets a clock that adds many steps reach a multiple that it misses by round-off.
    return math.floor(after / interval * (1 + 1e-12)) > math.floor(before / interval * (1 + 1e-12))
