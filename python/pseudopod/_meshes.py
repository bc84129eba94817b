"""Surfaces of cells as PyVista has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import missing
from ._frames import Frames, Integers
from ._tables import Tables

if TYPE_CHECKING:
    import pandas as pd
    import pyvista


class Surface:
    """The surface of a frame: atoms, facets and links, and what is known of each."""

    def __init__(self, frames: Frames, frame: int) -> None:
        self.frames, self.file, self.frame = frames, frames.file, frame
        part = int(frames.part[frame])
        count = {name: self._of_part(f"/VTKHDF/{name}", part) for name in _COUNTED}
        self.atoms, self.links, self.facets = (count[name] for name in _COUNTED)
        self.points = self._block("/VTKHDF/Points", "/VTKHDF/Steps/PointOffsets", self.atoms)
        begins = self.file.rows("/VTKHDF/Steps/ConnectivityIdOffsets", frame, frame + 1)[0]
        self.link_atoms = self._corners("Lines", int(begins[1]), self.links, 2)
        self.facet_atoms = self._corners("Polygons", int(begins[2]), self.facets, 3)

    def _of_part(self, path: str, part: int) -> int:
        return int(self.file.rows(path, part, part + 1)[0])

    def _block(self, path: str, begins: str, length: int) -> npt.NDArray[Any]:
        begin = int(self.file.rows(begins, self.frame, self.frame + 1)[0])
        return self.file.rows(path, begin, begin + length)

    def _corners(self, kind: str, begin: int, count: int, corners: int) -> Integers:
        path = f"/VTKHDF/{kind}/Connectivity"
        found = self.file.rows(path, begin, begin + corners * count).astype(np.int64).reshape(-1, corners)
        if found.size > 0 and not 0 <= int(found.min()) <= int(found.max()) < self.atoms:
            raise self.file.damaged(path, f"an atom that is none of the {self.atoms}")
        return found

    def of_atoms(self, name: str) -> npt.NDArray[Any]:
        """A quantity of atoms: one number or vector each."""
        return self._block(f"/VTKHDF/PointData/{name}", f"/VTKHDF/Steps/PointDataOffsets/{name}", self.atoms)

    def of_drawn(self, name: str) -> npt.NDArray[Any]:
        """A quantity of links and then facets."""
        return self._block(
            f"/VTKHDF/CellData/{name}", f"/VTKHDF/Steps/CellDataOffsets/{name}", self.links + self.facets
        )


#: Datasets that count atoms, links and facets.
_COUNTED = ("NumberOfPoints", "Lines/NumberOfCells", "Polygons/NumberOfCells")


def membranes(frames: Frames) -> dict[str, str]:
    """Substances on membranes and the units of their densities."""
    file = frames.file
    found = [name for name in file.names("/VTKHDF/PointData") if "." in name]
    found.sort(key=lambda name: int(file.attribute(f"/VTKHDF/PointData/{name}", "membrane", 0)))
    return {name: file.unit(f"/VTKHDF/PointData/{name}") for name in found}


def mesh(tables: Tables, frame: int, cell: int | None, links: bool) -> pyvista.PolyData:
    """The surface of all cells of a frame, or of one."""
    try:
        import pyvista
    except ImportError as error:
        raise missing("pyvista", "meshes", "meshes") from error
    frames = tables.frames
    surface = Surface(frames, frame)
    point_data = {name: surface.of_atoms(name) for name in frames.file.names("/VTKHDF/PointData")}
    point_data |= _of_cells(tables, frame, point_data["cell"])
    facets = surface.facet_atoms
    lines = surface.link_atoms if links else surface.link_atoms[:0]
    owner, kind = surface.of_drawn("cell"), surface.of_drawn("type")
    drawn = np.arange(surface.links + surface.facets)
    drawn = drawn if links else drawn[surface.links :]
    points = surface.points
    if cell is not None:
        atoms = np.flatnonzero(point_data["cell"] == cell)
        if len(atoms) == 0:
            raise frames.file.lacks(f"cell {cell} in frame {frame}", "see result.cells(frame) for those that are there")
        new = np.full(surface.atoms, -1)
        new[atoms] = np.arange(len(atoms))
        points, point_data = points[atoms], {name: values[atoms] for name, values in point_data.items()}
        facets = new[facets[owner[surface.links :] == cell]]
        lines = new[lines[owner[: len(lines)] == cell]]
        drawn = drawn[owner[drawn] == cell]
    made = pyvista.PolyData(points, faces=_padded(facets), lines=_padded(lines) if len(lines) > 0 else None)
    for name, values in point_data.items():
        made.point_data[name] = values
    made.cell_data["cell"], made.cell_data["type"] = owner[drawn], kind[drawn]
    made.field_data["time"] = [float(frames.times[frame])]
    return made


def _padded(corners: Integers) -> Integers:
    """Each row with the number of its corners before it, as VTK has it."""
    width = np.full((len(corners), 1), corners.shape[1])
    return np.hstack([width, corners]).ravel()


def _of_cells(tables: Tables, frame: int, cell: Integers) -> dict[str, npt.NDArray[Any]]:
    """Quantities of cells, repeated for each of their atoms."""
    rows, _ = tables.frames.of_cells(np.array([frame]))
    ids = tables.frames.take("/cells/id", rows)
    order = np.argsort(ids)
    place = np.searchsorted(ids, cell, sorter=order) if len(ids) > 0 else np.zeros(0, np.int64)
    if len(cell) > 0 and (len(ids) == 0 or place.max() >= len(ids) or (ids[order[place]] != cell).any()):
        raise tables.file.damaged("/VTKHDF/PointData/cell", "an atom of a cell that is not in its frame")
    of_atom = order[place] if len(cell) > 0 else place
    found: dict[str, npt.NDArray[Any]] = {}
    for column in tables.chosen(None):
        # A vector stands where its first component does.
        if column.path == "/cells/position" or column.component not in (None, 0):
            continue
        name = column.name if column.component is None else column.path.rsplit("/", 1)[-1]
        # Forces of cells have the names of those of atoms.
        name = f"cell_{name}" if tables.file.has(f"/VTKHDF/PointData/{name}") else name
        found[name] = tables.frames.take(column.path, rows)[of_atom]
    return found


def membrane(tables: Tables, name: str, frame: int) -> pd.DataFrame:
    """The density of a substance at every atom that has it."""
    import pandas as pd

    known = membranes(tables.frames)
    if name not in known:
        help = (
            f"it has {', '.join(known)}" if known else 'give a system of chemistry of the experiment `on = "membrane"`'
        )
        raise tables.file.lacks(f"substance {name!r} on membranes", help)
    surface = Surface(tables.frames, frame)
    data: dict[str, Any] = {"cell": surface.of_atoms("cell")}
    data |= {ending: surface.points[:, component] for component, ending in enumerate("xyz")}
    data[name] = surface.of_atoms(name)
    table = pd.DataFrame(data).dropna(subset=[name], ignore_index=True)
    table.attrs["units"] = {"x": "um", "y": "um", "z": "um", name: known[name]}
    table.attrs["time"] = float(tables.frames.times[frame])
    return table
