"""A result as Python has it."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Iterable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import pandas as pd

from . import _meshes
from ._csv import contact_series
from ._fields import Fields
from ._file import ResultFile
from ._frames import Frames
from ._provenance import Measures, Provenance, provenance
from ._tables import NO_CONTACTS, Tables

if TYPE_CHECKING:
    import pyvista
    import xarray


class Result:
    """A result of pseudopod: opened at once, read where somebody looks.

    Lengths are in um, times in s, forces in pN. Tables carry the units of their columns in ``attrs["units"]`` and their
    meanings in ``attrs["descriptions"]``; ``1`` is the unit of pure numbers. Where a frame is asked for, it is its
    number, from 0, or from the end if it is negative; or ``time`` (s) takes the one nearest to it.

    While its run goes on a result shows the version that there was when it was opened; :meth:`refresh` shows the
    present one. It is a context manager, and can be pickled: what is sent is its path.

    Parameters
    ----------
    path
        The result file.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ResultError
        If it is no result, is damaged, or does not hold what is asked for.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._file = ResultFile(path)

    def __enter__(self) -> Result:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file. What was read from it stays."""
        self._file.close()

    def refresh(self) -> Result:
        """Shows the version of the file that there is now: of a run that goes on, the frames until a moment ago.

        Returns
        -------
        Result
            This result.
        """
        self._file.reopen()
        for name in [name for name, kind in vars(type(self)).items() if isinstance(kind, cached_property)]:
            self.__dict__.pop(name, None)
        return self

    def __reduce__(self) -> tuple[type[Result], tuple[str]]:
        return type(self), (self._file.path,)

    @property
    def path(self) -> str:
        """The file, from the root of the file system."""
        return self._file.path

    # What it is.

    @cached_property
    def provenance(self) -> Provenance:
        """Where it comes from: document, settings, seed, version, equations."""
        return provenance(self._file)

    @property
    def title(self) -> str:
        """Title of the experiment."""
        return self.provenance.title

    @property
    def is_complete(self) -> bool:
        """Whether the run has reached its end."""
        return self.provenance.finished

    @cached_property
    def measures(self) -> Measures:
        """The measures that the experiment declares: value, unit and description by name. Empty until the run ends."""
        return Measures.of(self._file)

    @cached_property
    def _frames(self) -> Frames:
        return Frames(self._file)

    @cached_property
    def _tables(self) -> Tables:
        return Tables(self._frames)

    @cached_property
    def _read(self) -> dict[str, pd.DataFrame]:
        """Tables that were read."""
        return {}

    def _table(self, name: str, make: Callable[[], pd.DataFrame]) -> pd.DataFrame:
        """A table, read once. What is done to the one that is returned leaves it as it is."""
        if name not in self._read:
            self._read[name] = make()
        table: pd.DataFrame = self._read[name].copy(deep=False)
        return table

    def __len__(self) -> int:
        return len(self._frames)

    def __bool__(self) -> bool:
        return True

    @property
    def times(self) -> npt.NDArray[np.float64]:
        """Simulated time of each frame, s."""
        return self._frames.times

    @property
    def steps(self) -> npt.NDArray[np.int64]:
        """Steps made up to each frame."""
        return self._frames.steps

    @property
    def interpolated(self) -> npt.NDArray[np.bool_]:
        """Whether each frame lies within a step, between the states at its ends."""
        return self._frames.interpolated

    # Cells.

    @property
    def types(self) -> pd.DataFrame:
        """Types of cells, with the number of atoms, facets and links of a cell of each."""
        return self._table("types", lambda: self._tables.types())

    @property
    def columns(self) -> dict[str, str]:
        """What is recorded of every cell in every frame, and the units."""
        return {name: column.unit for name, column in self._tables.columns.items()}

    @property
    def tracks(self) -> pd.DataFrame:
        """All cells in all frames, cell after cell in the order of time.

        Columns are ``cell`` (id), ``type``, ``frame``, ``time`` (s), ``x``, ``y``, ``z`` (um), then whatever the file
        has: ``velocity_x`` (um/s), ``volume`` (um^3), ``area`` (um^2), quantities of chemistry ``SYSTEM.QUANTITY`` …;
        at last ``parent``, the id of the cell that it was born from, or -1.
        """
        return self._table("tracks", lambda: self.read_tracks())

    def read_tracks(self, columns: Iterable[str] | None = None, frames: slice | None = None) -> pd.DataFrame:
        """The same of some columns and frames: only they are read.

        Parameters
        ----------
        columns
            Those wanted besides ``cell``, ``type``, ``frame`` and ``time``, by the names of :attr:`columns`.
        frames
            Which frames, as in ``slice(0, None, 10)``.
        """
        return self._tables.tracks(self._frames.numbers(frames), columns)

    def cells(self, frame: int = -1, *, time: float | None = None) -> pd.DataFrame:
        """The cells of a frame, the last by default: the columns of :attr:`tracks`, with the id as index."""
        table = self._tables.cells(np.array([self._frames.number(frame, time)]), None)
        attributes = table.attrs
        table = table.set_index("cell")
        table.attrs.update(attributes)
        return table

    # The scene.

    @property
    def series(self) -> pd.DataFrame:
        """Series of the scene by time (s): loads, contacts, energies, chemistry of the scene."""
        return self._table("series", lambda: self._tables.series())

    @property
    def contact_series(self) -> pd.DataFrame:
        """What follows from who touches whom, by time (s): ``contact.segregation``, ``contact.area.TYPE.TYPE``, more.

        The page *Analysis* of the book says what they are. They are not stored: the program works them out, here by
        ``pseudopod export``.

        Raises
        ------
        RunError
            If the program cannot read the result.
        """
        self._tables.need_contacts()
        return self._table("contact_series", lambda: contact_series(self.path, self.times))

    @property
    def contacts(self) -> pd.DataFrame:
        """Pairs of cells that touch: ``frame``, ``time`` (s), ``first`` and ``second`` (ids), ``area`` (um^2)."""
        return self._table(
            "contacts", lambda: self._tables.listed("/contacts/pair_count", "/contacts/pairs", NO_CONTACTS)
        )

    @property
    def plane_contacts(self) -> pd.DataFrame:
        """Cells that touch planes: ``frame``, ``time`` (s), ``cell``, ``plane``, ``area`` (um^2)."""
        return self._table("plane_contacts", lambda: self._tables.on_planes())

    @property
    def planes(self) -> pd.DataFrame:
        """Rigid planes by name: a point (um) and the unit normal towards the free side."""
        return self._table("planes", lambda: self._tables.planes())

    @property
    def runs(self) -> pd.DataFrame:
        """Motility runs that ended: ``cell``, ``end_time`` and ``duration`` (s).

        ``frame`` is the first one that knows of it, ``time`` its time.
        """
        return self._table(
            "runs",
            lambda: self._tables.listed("/events/run_count", "/events/runs", "it was written by another program"),
        )

    @property
    def pseudopods(self) -> pd.DataFrame:
        """Pseudopods whose protrusion ended: ``cell``, ``end_time``, ``lifetime`` (s), direction, ``turn`` (deg), more.

        ``frame`` is the first one that knows of it, ``time`` its time.
        """
        return self._table(
            "pseudopods",
            lambda: self._tables.listed(
                "/events/pseudopod_count", "/events/pseudopods", "it was written by another program"
            ),
        )

    @property
    def fibres(self) -> pd.DataFrame:
        """Fibres that come and go, of every frame.

        Columns are ``cell``, ``number`` among those of the cell, atoms ``from`` and ``to``, ``length`` (um) and
        ``tension`` (pN).
        """
        help = "give a type of its cells fibres that are made at run time, and run it again"
        return self._table("fibres", lambda: self._tables.listed("/fibres/count", "/fibres", help))

    # Surfaces and fields.

    def mesh(
        self, frame: int = -1, *, time: float | None = None, cell: int | None = None, links: bool = False
    ) -> pyvista.PolyData:
        """The surface of the cells in a frame, the last by default. Needs the extra ``meshes``.

        Parameters
        ----------
        frame, time
            Which frame.
        cell
            The id of one cell; all by default.
        links
            Whether internal links are there, as lines.

        Returns
        -------
        pyvista.PolyData
            Points in um. Its point data are ``cell`` (id) and ``type`` (row of :attr:`types`), forces, tractions and
            substances on membranes where they were recorded, and what is recorded of the cell (``velocity``,
            ``volume``, ``SYSTEM.QUANTITY`` …; ``cell_NAME`` where atoms have something of that name).
            Its cell data are ``cell`` and ``type``, its field data ``time`` (s).
        """
        return _meshes.mesh(self._tables, self._frames.number(frame, time), cell, links)

    @property
    def membranes(self) -> dict[str, str]:
        """Substances on membranes, ``SYSTEM.VARIABLE``, and the units of their densities."""
        return _meshes.membranes(self._frames)

    def membrane(self, name: str, frame: int = -1, *, time: float | None = None) -> pd.DataFrame:
        """The density of a substance on membranes at every atom that has it.

        Columns are ``cell``, ``x``, ``y``, ``z`` (um) and the name of the substance.
        """
        return _meshes.membrane(self._tables, name, self._frames.number(frame, time))

    @cached_property
    def fields(self) -> Fields:
        """Fields by name, each an :class:`xarray.Dataset` with one variable a species. Needs the extra ``fields``."""
        return Fields(self._frames)

    def field(self, name: str) -> xarray.DataArray:
        """One species of a field, over ``time`` (s), ``z``, ``y`` and ``x`` (um). Needs the extra ``fields``.

        Parameters
        ----------
        name
            ``FIELD.SPECIES``, a field (its first species), or a species (of the first field that has it).
        """
        return self.fields.array(name)

    # What it looks like.

    def _facts(self) -> list[tuple[str, str]]:
        frames, file = self._frames, self._file
        facts = [
            ("title", self.title),
            ("state", "complete" if self.is_complete else "not complete: its run goes on or was stopped"),
        ]
        times = frames.times
        if len(times) > 0:
            facts.append(("frames", f"{len(times)}, {times[0]:.6g} to {times[-1]:.6g} s"))
            kinds, counts = np.unique(
                frames.take("/cells/type", frames.of_cells(np.array([len(times) - 1]))[0]), return_counts=True
            )
            names = list(self.types.index)
            facts.append(
                ("cells at the end", ", ".join(f"{n} {names[k]}" for k, n in zip(kinds, counts, strict=True)) or "none")
            )
        told = [
            f"{name} ({', '.join(f'{s} [{unit}]' for s, unit in self.fields.species(name).items())})"
            for name in self.fields
        ]
        chemistry = [f"{name} ({', '.join(file.names(f'/chemistry/{name}'))})" for name in self._tables.systems()]
        lists = [
            ("fields", told),
            ("chemistry", chemistry),
            ("membranes", [f"{n} [{u}]" for n, u in self.membranes.items()]),
        ]
        lists.append(("measures", [f"{name} = {measure}" for name, measure in self.measures.items()]))
        return facts + [(title, ", ".join(entries)) for title, entries in lists if entries]

    def __repr__(self) -> str:
        if not self._file.is_open:
            return f"<pseudopod.Result {self.path!r}, closed>"
        facts = self._facts()
        width = max(len(name) for name, _ in facts)
        return "\n".join([f"<pseudopod.Result {self.path!r}>", *(f"  {name:<{width}}  {text}" for name, text in facts)])

    def _repr_html_(self) -> str:
        if not self._file.is_open:
            return html.escape(repr(self))
        left = "style='text-align:left'"
        rows = [
            f"<tr><th {left}>{html.escape(name)}</th><td {left}>{html.escape(text)}</td></tr>"
            for name, text in self._facts()
        ]
        return f"<div><code>{html.escape(self.path)}</code><table>{''.join(rows)}</table></div>"
