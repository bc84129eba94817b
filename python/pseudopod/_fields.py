"""Fields as xarray has them: read from the file only where somebody looks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import missing
from ._file import ResultFile
from ._frames import Frames

if TYPE_CHECKING:
    import xarray


class Fields(Mapping[str, "xarray.Dataset"]):
    """The fields of a result by name, each a data set with one variable a species.

    Coordinates are ``time`` (s) and the centres of the boxes ``z``, ``y``, ``x`` (um).
    """

    def __init__(self, frames: Frames) -> None:
        self._frames = frames
        self._file = frames.file
        self._names = self._file.names("/fields")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __getitem__(self, name: str) -> xarray.Dataset:
        if name not in self._names:
            raise self._none(name)
        return self._dataset(name)

    def __repr__(self) -> str:
        told = [
            f"{name}: {', '.join(f'{species} [{unit}]' for species, unit in self.species(name).items())}"
            for name in self
        ]
        return f"<fields {'; '.join(told)}>" if told else "<no fields>"

    def species(self, name: str) -> dict[str, str]:
        """Species of a field and their units."""
        path = f"/fields/{name}/CellData"
        return {species: self._file.unit(f"{path}/{species}") for species in self._file.names(path)}

    def array(self, name: str) -> xarray.DataArray:
        """What ``FIELD.SPECIES``, a field (its first species) or a species (of the first field with it) names."""
        for field in self:
            prefix = f"{field}."
            if name.startswith(prefix) and name.removeprefix(prefix) in self.species(field):
                return self._dataset(field)[name.removeprefix(prefix)]
        if name in self and (species := self.species(name)):
            return self._dataset(name)[name if name in species else next(iter(species))]
        for field in self:
            if name in self.species(field):
                return self._dataset(field)[name]
        raise self._none(name)

    def _none(self, name: str) -> Exception:
        known = [
            field if species == field else f"{field}.{species}" for field in self for species in self.species(field)
        ]
        help = f"it has {', '.join(known)}" if known else "give the experiment a field, and run it again"
        return self._file.lacks(f"field {name!r}", help)

    def _dataset(self, name: str) -> xarray.Dataset:
        try:
            import xarray
        except ImportError as error:
            raise missing("xarray", "fields", "fields") from error
        path = f"/fields/{name}"
        extent, origin, spacing = (
            np.asarray(self._file.attribute(path, key)) for key in ("WholeExtent", "Origin", "Spacing")
        )
        if extent.shape != (6,) or origin.shape != (3,) or spacing.shape != (3,):
            raise self._file.damaged(path, "its extent, origin or spacing is missing")
        boxes = (extent[1::2] - extent[::2]).astype(int)
        unit = str(self._file.attribute(path, "length_unit", "um"))
        axes = {
            axis: (
                axis,
                origin[i] + (np.arange(boxes[i]) + 0.5) * spacing[i],
                {"units": unit, "long_name": f"{axis}, centres of the boxes"},
            )
            for i, axis in ((2, "z"), (1, "y"), (0, "x"))
        }
        coordinates = {"time": ("time", self._frames.times, {"units": "s", "long_name": "simulated time"}), **axes}
        shape = (len(self._frames), *boxes[::-1].tolist())
        variables = {
            species: _variable(self._file, f"{path}/CellData/{species}", shape) for species in self.species(name)
        }
        attributes = {"origin": origin.tolist(), "spacing": spacing.tolist(), "length_unit": unit}
        return xarray.Dataset(variables, coordinates, attributes)


def _variable(file: ResultFile, path: str, shape: tuple[int, ...]) -> xarray.Variable:
    import xarray
    from xarray.backends import BackendArray
    from xarray.core import indexing

    dataset = file.dataset(path)
    if dataset.shape != shape:
        raise file.damaged(path, f"its shape is {dataset.shape}, and that of its field {shape}")

    class Lazy(BackendArray):
        """Reads what is asked for when it is asked for."""

        def __init__(self) -> None:
            self.shape = shape
            self.dtype = dataset.dtype

        def __getitem__(self, key: Any) -> Any:
            support = indexing.IndexingSupport.OUTER_1VECTOR
            return indexing.explicit_indexing_adapter(key, self.shape, support, lambda raw: file.read(path, raw))

    attributes = {"units": file.unit(path), "long_name": path.rsplit("/", 1)[-1], "description": file.description(path)}
    return xarray.Variable(("time", "z", "y", "x"), indexing.LazilyIndexedArray(Lazy()), attributes)
