"""Tables of a result: cells, tracks, series, contacts, events, fibres."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from ._frames import Frames, Integers

#: How components of vectors end.
XYZ = ("x", "y", "z")

#: Vectors whose components are numbered, for they lie along principal axes.
NUMBERED = ("principal", "traction_moment")

#: Quantities of ``/cells`` that are no quantities of a cell in a frame, or stand in columns of their own.
_OWN = ("count", "first", "id", "type", "parent", "type_names")

#: What comes first in tables of cells, in the order of `pseudopod export`; what a file has besides follows.
_SOUGHT = (
    "position",
    "velocity",
    "volume",
    "volume_error",
    "area",
    "energy",
    "size",
    "principal",
    "smallest_facet",
    "smallest_cosine",
    "contact_share",
    "aggregate",
)

#: The component of a vector that is its length, and the one that is its first component over its second.
LENGTH = -1
RATIO = -2


@dataclass(frozen=True)
class Column:
    """A column of a table of cells: where its numbers lie, and what they mean."""

    name: str
    path: str
    #: Which component of a vector it is, or its LENGTH or RATIO.
    component: int | None
    unit: str
    description: str

    def of(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Its numbers, from the rows of its dataset."""
        if self.component == LENGTH:
            return np.asarray(np.linalg.norm(values, axis=1))
        if self.component == RATIO:
            # Of what has no width there is none.
            with np.errstate(divide="ignore", invalid="ignore"):
                return np.asarray(values[:, 0] / values[:, 1])
        return values if self.component is None else values[:, self.component]


def describe(table: pd.DataFrame, units: Mapping[str, str], descriptions: Mapping[str, str]) -> pd.DataFrame:
    """Writes units and meanings of the columns into the attributes of a table."""
    table.attrs["units"] = {str(name): units[str(name)] for name in table.columns if str(name) in units}
    table.attrs["descriptions"] = {
        str(name): descriptions[str(name)] for name in table.columns if str(name) in descriptions
    }
    return table


class Tables:
    """Makes the tables of one version of a result."""

    def __init__(self, frames: Frames) -> None:
        self.frames = frames
        self.file = frames.file

    # Cells.

    def type_names(self) -> list[str]:
        return self.file.texts("/cells/type_names")

    def types(self) -> pd.DataFrame:
        columns = {name: self.file.read(f"/types/{name}") for name in ("atoms", "facets", "links")}
        table = pd.DataFrame(columns, index=pd.Index(self.type_names(), name="type"))
        return describe(
            table, dict.fromkeys(columns, "1"), {name: self.file.description(f"/types/{name}") for name in columns}
        )

    @cached_property
    def columns(self) -> dict[str, Column]:
        """What is recorded of every cell: positions first, then quantities by their names, then chemistry."""
        found: dict[str, Column] = {}
        names = [name for name in self.file.names("/cells") if name not in _OWN]
        names.sort(key=lambda name: _SOUGHT.index(name) if name in _SOUGHT else len(_SOUGHT))
        for name in names:
            path = f"/cells/{name}"
            if self.file.dataset(path).ndim == 1:
                self._add(found, name, path, None)
                continue
            endings = ("1", "2", "3") if name in NUMBERED else XYZ
            for component, ending in enumerate(endings):
                self._add(found, ending if name == "position" else f"{name}_{ending}", path, component)
            if name == "velocity":
                found["speed"] = Column("speed", path, LENGTH, self.file.unit(path), "length of the velocity")
            if name == "principal":
                words = "longest over middle extent along the principal axes"
                found["aspect_ratio"] = Column("aspect_ratio", path, RATIO, "1", words)
        for system in self.systems("cells"):
            for quantity in self.file.names(f"/chemistry/{system}"):
                self._add(found, f"{system}.{quantity}", f"/chemistry/{system}/{quantity}", None)
        return found

    def _add(self, found: dict[str, Column], name: str, path: str, component: int | None) -> None:
        found[name] = Column(name, path, component, self.file.unit(path), self.file.description(path))

    def systems(self, *scopes: str) -> list[str]:
        """Systems of chemistry, of all scopes or some."""
        names = self.file.names("/chemistry")
        return [name for name in names if not scopes or self.file.attribute(f"/chemistry/{name}", "in") in scopes]

    def chosen(self, names: Iterable[str] | None) -> list[Column]:
        known = self.columns
        if names is None:
            return list(known.values())
        names = [names] if isinstance(names, str) else list(names)
        for name in names:
            if name not in known:
                raise self.file.lacks(f"column {name!r} of cells", f"it has {', '.join(known)}")
        return [known[name] for name in names]

    def cells(self, numbers: Integers, names: Iterable[str] | None) -> pd.DataFrame:
        """A row for each cell of each of some frames, in the order of the file."""
        self.frames.need()
        rows, frame = self.frames.of_cells(numbers)
        kinds = self.frames.take("/cells/type", rows)
        type_names = self.type_names()
        if len(kinds) > 0 and not 0 <= int(kinds.min()) <= int(kinds.max()) < len(type_names):
            raise self.file.damaged("/cells/type", f"a type that is none of the {len(type_names)}")
        data: dict[str, Any] = {
            "cell": self.frames.take("/cells/id", rows),
            "type": pd.Categorical.from_codes(kinds, categories=pd.Index(type_names)),
            "frame": frame,
            "time": self.frames.times[frame],
        }
        units, descriptions = (
            {"time": "s"},
            {
                "cell": "id of the cell: no other cell of the run ever has it",
                "type": "type of the cell",
                "frame": "number of the frame, from 0",
                "time": "simulated time",
                "parent": "id of the cell that it was born from, -1 for none",
            },
        )
        # Vectors are read once for their three components.
        read: dict[str, npt.NDArray[Any]] = {}
        for column in self.chosen(names):
            if column.path not in read:
                read[column.path] = self.frames.take(column.path, rows)
            data[column.name] = column.of(read[column.path])
            units[column.name], descriptions[column.name] = column.unit, column.description
        if names is None:
            data["parent"] = self.frames.take("/cells/parent", rows)
        return describe(pd.DataFrame(data), units, descriptions)

    def tracks(self, numbers: Integers, names: Iterable[str] | None) -> pd.DataFrame:
        """The same cell after cell."""
        table = self.cells(numbers, names)
        attributes = table.attrs
        table = table.sort_values(["cell", "frame"], kind="stable", ignore_index=True)
        table.attrs.update(attributes)
        return table

    # The scene.

    def series(self) -> pd.DataFrame:
        paths = {name: f"/scene/{name}" for name in self.file.names("/scene")}
        for system in self.systems("scene"):
            paths |= {
                f"{system}.{name}": f"/chemistry/{system}/{name}" for name in self.file.names(f"/chemistry/{system}")
            }
        index = pd.Index(self.frames.times, name="time")
        table = pd.DataFrame({name: self.file.read(path) for name, path in paths.items()}, index=index)
        units = {name: self.file.unit(path) for name, path in paths.items()}
        table = describe(table, units, {name: self.file.description(path) for name, path in paths.items()})
        table.attrs["units"]["time"] = "s"
        return table

    # Lists: any number of rows in a frame.

    def listed(self, counter: str, group: str, help: str, rename: Mapping[str, str] | None = None) -> pd.DataFrame:
        """A list of the file, with the frame and the time of each row."""
        self.frames.need()
        if not self.file.has(counter):
            raise self.file.lacks(group.strip("/").replace("/", " "), help)
        rows, frame = self.frames.of_list(counter, np.arange(len(self.frames)))
        data: dict[str, Any] = {"frame": frame, "time": self.frames.times[frame]}
        units, descriptions = (
            {"time": "s"},
            {"frame": "number of the frame, from 0", "time": "simulated time of the frame"},
        )
        for name in self.file.names(group):
            path = f"{group}/{name}"
            if path == counter:
                continue
            title = (rename or {}).get(name, name)
            data[title] = self.frames.take(path, rows)
            units[title], descriptions[title] = self.file.unit(path), self.file.description(path)
        return describe(_in_order(pd.DataFrame(data)), units, descriptions)

    def need_contacts(self) -> None:
        """Complains about a result that does not say who touches whom."""
        if not self.file.has("/contacts/pair_count"):
            raise self.file.lacks("contacts", NO_CONTACTS)

    def on_planes(self) -> pd.DataFrame:
        table = self.listed("/contacts/plane_count", "/contacts/planes", NO_CONTACTS)
        names = self.file.texts("/planes/names") if self.file.length("/planes/names") > 0 else []
        if len(table) > 0 and not 0 <= table["plane"].min() <= table["plane"].max() < len(names):
            raise self.file.damaged("/contacts/planes/plane", f"a plane that is none of the {len(names)}")
        attributes = table.attrs
        table["plane"] = pd.Categorical.from_codes(table["plane"], categories=pd.Index(names))
        table.attrs.update(attributes)
        return table

    def planes(self) -> pd.DataFrame:
        data: dict[str, Any] = {}
        for name, values in (("", self.file.read("/planes/point")), ("normal_", self.file.read("/planes/normal"))):
            data |= {f"{name}{ending}": values.reshape(-1, 3)[:, component] for component, ending in enumerate(XYZ)}
        table = pd.DataFrame(data, index=pd.Index(self.file.texts("/planes/names"), name="plane", dtype="object"))
        return describe(table, dict.fromkeys(XYZ, "um"), dict.fromkeys(XYZ, "a point of the plane"))


#: What to do where nothing is said of contacts.
NO_CONTACTS = "its cells pass through each other: add [contact] to the document, and run it again"

#: Columns that come first in lists.
_FIRST = ("frame", "time", "cell", "number", "first", "second", "plane", "end_time")


def _in_order(table: pd.DataFrame) -> pd.DataFrame:
    place: Callable[[str], int] = lambda name: _FIRST.index(name) if name in _FIRST else len(_FIRST)  # noqa: E731
    return table[sorted(table.columns, key=lambda name: place(str(name)))]
