"""Meshes, membranes and fields hold what the file says."""

from __future__ import annotations

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import pyvista
from vtkmodules.vtkIOHDF import vtkHDFReader

import pseudopod


def test_a_mesh_is_what_the_reader_of_vtk_reads(any_result: Path) -> None:
    reader = vtkHDFReader()
    reader.SetFileName(str(any_result))
    result = pseudopod.open(any_result)
    for frame in (0, len(result) // 2, len(result) - 1):
        reader.UpdateTimeStep(result.times[frame])
        wanted = pyvista.wrap(reader.GetOutputDataObject(0))
        found = result.mesh(frame, links=True)
        assert np.array_equal(found.points, wanted.points)
        assert np.array_equal(found.regular_faces, wanted.regular_faces)
        assert np.array_equal(found.lines, wanted.lines)
        for name in wanted.point_data:
            np.testing.assert_array_equal(found.point_data[name], wanted.point_data[name], err_msg=name)
        for name in ("cell", "type"):
            assert np.array_equal(found.cell_data[name], wanted.cell_data[name])
        without = result.mesh(time=float(result.times[frame]))
        assert without.n_lines == 0
        assert np.array_equal(without.cell_data["cell"], found.cell_data["cell"][found.n_lines :])
        assert np.array_equal(without.regular_faces, found.regular_faces)


def test_points_carry_what_is_known_of_their_cell(amoebae: pseudopod.Result) -> None:
    mesh, cells = amoebae.mesh(3), amoebae.cells(3)
    owner = mesh.point_data["cell"]
    for name in ("volume", "compass.c", "compass.cue_x", "contact_share"):
        assert np.array_equal(mesh.point_data[name], cells.loc[owner, name])
    velocity = cells.loc[owner, [f"velocity_{axis}" for axis in "xyz"]]
    assert np.array_equal(mesh.point_data["velocity"], velocity)
    # Of what is known of atoms and of cells, both are there.
    assert mesh.point_data["traction"].shape == mesh.point_data["cell_traction"].shape == mesh.points.shape
    assert np.allclose(mesh.point_data["traction"].sum(0), amoebae.cells(3)[[f"traction_{a}" for a in "xyz"]].sum())
    assert mesh.field_data["time"][0] == amoebae.times[3]


def test_one_cell_has_its_volume(amoebae: pseudopod.Result) -> None:
    for cell in (0, 1):
        mesh = amoebae.mesh(-1, cell=cell, links=True)
        assert set(mesh.point_data["cell"]) == set(mesh.cell_data["cell"]) == {cell}
        assert mesh.extract_surface(algorithm=None).volume == pytest.approx(
            amoebae.cells().loc[cell, "volume"], rel=1e-5
        )
        every = amoebae.mesh()
        assert np.array_equal(mesh.points, every.points[every.point_data["cell"] == cell])
    with pytest.raises(pseudopod.ResultError, match="holds no cell 9 in frame 6"):
        amoebae.mesh(cell=9)


def test_links_of_one_cell_stay_its_own(made) -> None:
    result = pseudopod.open(made("walk"))
    for cell in (1, 6):
        mesh = result.mesh(cell=cell, links=True)
        assert mesh.n_points == result.types.loc[str(result.cells().loc[cell, "type"]), "atoms"]
        assert mesh.n_cells == len(mesh.cell_data["cell"])


def test_membranes(made) -> None:
    result = pseudopod.open(made("membrane"))
    assert "gtpase.a" in result.membranes
    frame = result.membrane("gtpase.a", 2)
    assert len(frame) == result.types.loc["polar", "atoms"]
    assert set(frame["cell"]) == {1}
    mesh = result.mesh(2)
    values = mesh.point_data["gtpase.a"]
    assert np.array_equal(frame["gtpase.a"], values[~np.isnan(values)])
    assert frame.attrs["units"]["gtpase.a"] == result.membranes["gtpase.a"] != "1"
    with pytest.raises(pseudopod.ResultError, match=r"'gtpase.z' on membranes\nhelp: it has gtpase"):
        result.membrane("gtpase.z")


def test_fields_have_coordinates_and_units(made) -> None:
    path = made("amoebae")
    result = pseudopod.open(path)
    field = result.field("attractant")
    with h5py.File(path) as file:
        values = file["fields/attractant/CellData/attractant"][:]
    assert field.dims == ("time", "z", "y", "x")
    assert field.attrs["units"] == "nM"
    assert field["x"].attrs["units"] == "um"
    assert field["time"].attrs["units"] == "s"
    assert np.array_equal(field["time"], result.times)
    assert field["x"][0] == -98.75
    assert float(field["y"].diff("y").min()) == 2.5
    assert np.array_equal(field, values)
    # The same read piece by piece.
    assert np.array_equal(field.isel(time=3, z=0), values[3, 0])
    assert np.array_equal(field.isel(x=[3, 5, 9], y=slice(None, None, -7)), values[:, :, ::-7, [3, 5, 9]])
    assert np.array_equal(field.sel(x=0.0, y=0.0, method="nearest").isel(z=0), values[:, 0, 39, 39])
    assert field.isel(time=-1).max() == pytest.approx(values[-1].max())
    assert np.array_equal(result.field("attractant.attractant"), values)
    assert list(result.fields) == ["attractant"]
    assert list(result.fields["attractant"].data_vars) == ["attractant"]
    with pytest.raises(pseudopod.ResultError, match="'red'\nhelp: it has attractant"):
        result.field("red")
    with pytest.raises(pseudopod.ResultError, match="it has attractant"):
        result.fields["red"]


def test_a_field_reads_only_what_is_asked_for(made, monkeypatch: pytest.MonkeyPatch) -> None:
    result = pseudopod.open(made("amoebae"))
    asked = []
    read = type(result._file).read
    monkeypatch.setattr(
        type(result._file), "read", lambda self, path, key=(): asked.append((path, key)) or read(self, path, key)
    )
    field = result.field("attractant").isel(time=2, x=slice(0, 3))
    assert not [path for path, _ in asked if path.startswith("/fields")]
    assert field.load().shape == (1, 80, 3)
    assert [key[0] for path, key in asked if path.startswith("/fields")] == [2]


def test_extras_that_lack_are_named(walk: pseudopod.Result, amoebae, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match=r'pip install "pseudopod\[meshes\]"'):
        walk.mesh()
    with pytest.raises(ImportError, match=r'pip install "pseudopod\[fields\]"'):
        amoebae.field("attractant")
