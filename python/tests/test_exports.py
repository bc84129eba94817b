"""What `pseudopod export` writes for others, read by others, is what the result says."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy as np
import pytest
import pyvista
import tifffile

import pseudopod

from .conftest import told

OME = "{http://www.openmicroscopy.org/Schemas/OME/2016-06}"


def test_a_series_plays_with_every_quantity(any_result: Path, tmp_path: Path) -> None:
    told("export", any_result, "-o", tmp_path / "cells.pvd")
    reader = pyvista.get_reader(str(tmp_path / "cells.pvd"))
    result = pseudopod.open(any_result)
    assert np.array_equal(reader.time_values, result.times)
    for frame in (0, len(result) // 2, len(result) - 1):
        reader.set_active_time_value(reader.time_values[frame])
        found, wanted = reader.read()[0], result.mesh(frame)
        assert np.array_equal(found.points, wanted.points)
        assert np.array_equal(found.cells_dict[pyvista.CellType.TRIANGLE], wanted.regular_faces)
        for name in ("cell", "type"):
            assert np.array_equal(found.cell_data[name], wanted.cell_data[name])
        with h5py.File(any_result) as file:
            for name in file["VTKHDF/PointData"]:
                np.testing.assert_array_equal(found.point_data[name], wanted.point_data[name], err_msg=name)
        table = result.cells(frame).loc[found.cell_data["cell"]]
        vectors = [name[:-2] for name in table.columns if name.endswith("_x") and "." not in name]
        assert {"velocity", "size"} <= set(vectors)
        assert np.array_equal(found.cell_data["position"], table[["x", "y", "z"]])
        for name in vectors:
            of_table = table[[f"{name}_{axis}" for axis in "xyz"]]
            np.testing.assert_array_equal(found.cell_data[name], of_table, err_msg=name)
        numbers = [name for name in table.columns if name in found.cell_data and name not in ("type", "parent")]
        assert {"volume", "area", "speed", "aggregate", *(n for n in table.columns if "." in n)} <= set(numbers)
        for name in numbers:
            np.testing.assert_array_equal(found.cell_data[name], table[name], err_msg=name)


def test_a_series_of_one_cell_or_of_some_frames(made, tmp_path: Path) -> None:
    result = pseudopod.open(made("heap"))
    told("export", made("heap"), "-o", tmp_path / "one.pvd", "--cell", "3", "--every", "2")
    reader = pyvista.get_reader(str(tmp_path / "one.pvd"))
    assert np.array_equal(reader.time_values, result.times[::2])
    mesh = reader.read()[0]
    assert set(mesh.cell_data["cell"]) == set(mesh.point_data["cell"]) == {3}
    assert np.array_equal(mesh.points, result.mesh(0, cell=3).points)


def test_fields_play_as_images(made, tmp_path: Path) -> None:
    told("export", made("amoebae"), "-o", tmp_path / "field.pvd", "--field", "attractant")
    reader = pyvista.get_reader(str(tmp_path / "field.pvd"))
    with h5py.File(made("amoebae")) as file:
        values = file["fields/attractant/CellData/attractant"][:]
    for frame, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        assert np.array_equal(reader.read()[0].cell_data["attractant"], values[frame].ravel())


@pytest.mark.parametrize("chosen", [(), ("--every", "3"), ("--time", "last")])
def test_fields_are_pictures_for_microscopists(made, tmp_path: Path, chosen: tuple[str, ...]) -> None:
    told("export", made("amoebae"), "-o", tmp_path / "field.ome.tiff", *chosen)
    with h5py.File(made("amoebae")) as file:
        values, time = file["fields/attractant/CellData/attractant"][:], file["time"][:]
        unit = file["fields/attractant/CellData/attractant"].attrs["unit"]
    frames = {(): slice(None), ("--every", "3"): slice(None, None, 3), ("--time", "last"): slice(-1, None)}[chosen]
    with tifffile.TiffFile(tmp_path / "field.ome.tiff") as tiff:
        assert tiff.is_ome
        assert not tiff.is_bigtiff
        series = tiff.series[0]
        assert series.axes == ("YX" if len(time[frames]) == 1 else "TYX")
        assert series.dtype == np.float32
        assert np.array_equal(series.asarray().reshape(values[frames].shape), values[frames])
        root = ElementTree.fromstring(tiff.ome_metadata)
    pixels = root.find(f"{OME}Image/{OME}Pixels")
    assert (pixels.get("PhysicalSizeX"), pixels.get("PhysicalSizeXUnit")) == ("2.5", "\u00b5m")
    assert [channel.get("Name") for channel in pixels.iter(f"{OME}Channel")] == ["attractant"]
    assert [float(plane.get("DeltaT")) for plane in pixels.iter(f"{OME}Plane")] == list(time[frames])
    assert [value.text for value in root.iter(f"{OME}M")] == [unit]
