//! Others read the file without us: h5py, VTK and PyVista; the cells from the result itself, each field from the small
//! file that leads to it.

use std::process::Command;

use crate::result_example::{cells, frame, frame_with_fields, header, layout_with_fields, lineage, write};
use crate::turns::take_turn;
use pseudopod::output::{Overwrite, ResultWriter, field_view_path};

/// Steps through time with VTK's reader, as ParaView does, and compares with the numbers that h5py reads.
const SCRIPT: &str = r#"
import sys, h5py, numpy as np
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
from vtkmodules.util.numpy_support import vtk_to_numpy
import pyvista
path, counts = sys.argv[1], [int(count) for count in sys.argv[2].split(",")]
frames = len(counts)
def block(data, start, length):
    return data[int(start):int(start) + int(length)]
class Expected:
    def __init__(self, f, step):
        vtk, steps = f["VTKHDF"], f["VTKHDF/Steps"]
        part = steps["PartOffsets"][step]
        atoms, facets, self.links = (int(vtk[name][part]) for name in
            ["NumberOfPoints", "Polygons/NumberOfCells", "Lines/NumberOfCells"])
        self.points = block(vtk["Points"], steps["PointOffsets"][step], atoms)
        self.force = block(vtk["PointData/force"], steps["PointDataOffsets/force"][step], atoms)
        starts = steps["ConnectivityIdOffsets"][step]
        self.facets = block(vtk["Polygons/Connectivity"], starts[2], 3 * facets).reshape(-1, 3)
        self.lines = block(vtk["Lines/Connectivity"], starts[1], 2 * self.links).reshape(-1, 2)
        self.cell = block(vtk["PointData/cell"], steps["PointDataOffsets/cell"][step], atoms)
        self.owner = block(vtk["CellData/cell"], steps["CellDataOffsets/cell"][step], self.links + facets)
        self.kind = block(vtk["CellData/type"], steps["CellDataOffsets/type"][step], self.links + facets)
        rows = slice(f["cells/first"][step], f["cells/first"][step] + f["cells/count"][step])
        self.ids, self.centre = f["cells/id"][rows], f["cells/position"][rows]
        assert len(self.ids) == counts[step] == atoms / 6 == facets / 8, step
        assert np.array_equal(self.cell, np.repeat(self.ids, 6))
        # An octahedron around the centre of every cell.
        assert np.allclose(self.points.reshape(-1, 6, 3).mean(1), self.centre)
        assert np.array_equal(self.cell[self.facets], np.repeat(self.ids, 8)[:, None].repeat(3, 1))
with h5py.File(path) as f:
    time = f["time"][:]
    expected = [Expected(f, step) for step in range(frames)]
    assert f["time"].attrs["unit"] == "s" and f["cells/volume"].attrs["unit"] == "um^3"
    assert f["provenance/experiment"].asstr()[()].startswith('title = "A walk"')
    assert list(f["cells/type_names"].asstr()) == ["round", "lone"]
    if len(set(counts)) == 1:
        assert f["cells/position"].shape == (frames * counts[0], 3)
        assert f["VTKHDF/NumberOfPoints"].shape == (1,) and f["VTKHDF/Points"].shape == (frames * 6 * counts[0], 3)
    def check_described(name, item):
        if isinstance(item, h5py.Dataset):
            assert "unit" in item.attrs and "description" in item.attrs, name
    f.visititems(check_described)
reader = vtkHDFReader()
reader.SetFileName(path)
reader.UpdateInformation()
steps = reader.GetOutputInformation(0).Get(pipeline.TIME_STEPS())
assert np.array_equal(steps, time) and len(steps) == frames, steps
def connectivity(cells, corners):
    if cells.GetNumberOfCells() == 0:
        return np.zeros((0, corners), int)
    assert np.array_equal(vtk_to_numpy(cells.GetOffsetsArray()), corners * np.arange(cells.GetNumberOfCells() + 1))
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, corners)
for step in [*range(frames), 1, frames - 1, 0]:
    reader.UpdateTimeStep(time[step])
    surface, wanted = reader.GetOutputDataObject(0), expected[step]
    atoms = len(wanted.points)
    assert surface.GetNumberOfPoints() == atoms, step
    if atoms == 0:
        continue
    bounds = np.array(surface.GetBounds()).reshape(3, 2)
    low, high = wanted.points.min(0), wanted.points.max(0)
    assert np.allclose(bounds[:, 0], low) and np.allclose(bounds[:, 1], high), (step, bounds)
    assert np.array_equal(vtk_to_numpy(surface.GetPoints().GetData()), wanted.points)
    assert np.array_equal(vtk_to_numpy(surface.GetPointData().GetArray("force")), wanted.force)
    assert np.array_equal(vtk_to_numpy(surface.GetPointData().GetArray("cell")), wanted.cell)
    assert np.array_equal(connectivity(surface.GetPolys(), 3), wanted.facets), step
    assert np.array_equal(connectivity(surface.GetLines(), 2), wanted.lines), step
    assert np.array_equal(vtk_to_numpy(surface.GetCellData().GetArray("cell")), wanted.owner)
    assert np.array_equal(vtk_to_numpy(surface.GetCellData().GetArray("type")), wanted.kind)
    mesh = pyvista.wrap(surface)
    assert mesh.n_faces_strict == len(wanted.facets) and mesh.n_lines == wanted.links
# PyVista takes VTK's reader for the endings .vtkhdf and .hdf, and reads the first step.
mesh = pyvista.read(path)
assert np.array_equal(mesh.points, expected[0].points)
assert mesh.n_faces_strict == len(expected[0].facets), mesh
print("h5py, VTK and PyVista agree on", frames, "frames")
"#;

/// Steps through a field with VTK's reader and compares with the numbers that h5py reads.
const FIELD_SCRIPT: &str = r#"
import sys, os, h5py, numpy as np
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
from vtkmodules.util.numpy_support import vtk_to_numpy
path, view, name, frames = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
with h5py.File(path) as f:
    group, time = f["fields"][name], f["time"][:]
    values = {species: data[:] for species, data in group["CellData"].items()}
    assert all(data.attrs["unit"] == "uM" for data in group["CellData"].values())
    extent, origin, spacing = group.attrs["WholeExtent"], group.attrs["Origin"], group.attrs["Spacing"]
    assert np.array_equal(group["Steps/Values"][:], time) and group["Steps"].attrs["NSteps"] == frames
    brain = f["chemistry/brain/U"][:].reshape(frames, 3)
    assert np.array_equal(np.isnan(brain), np.tile([False, True, False], (frames, 1)))
    assert f["chemistry/clock/tick"].shape == (frames,)
reader = vtkHDFReader()
assert reader.CanReadFile(view)
reader.SetFileName(view)
reader.UpdateInformation()
steps = reader.GetOutputInformation(0).Get(pipeline.TIME_STEPS())
assert np.array_equal(steps, time) and len(steps) == frames, steps
for step in [*range(frames), 1, frames - 1, 0]:
    reader.UpdateTimeStep(time[step])
    image = reader.GetOutputDataObject(0)
    assert image.GetClassName() == "vtkImageData", image.GetClassName()
    assert tuple(image.GetExtent()) == tuple(extent) and np.allclose(image.GetOrigin(), origin)
    assert np.allclose(image.GetSpacing(), spacing)
    assert image.GetCellData().GetNumberOfArrays() == len(values)
    for species, data in values.items():
        assert np.array_equal(vtk_to_numpy(image.GetCellData().GetArray(species)), data[step].ravel()), (step, species)
import pyvista
# The first step; then the same picture as XML, written by our export.
mesh = pyvista.read(view)
first = next(iter(values))
assert np.array_equal(mesh.cell_data[first], values[first][0].ravel())
exported = pyvista.read(sys.argv[5])
for species, data in values.items():
    assert np.array_equal(exported.cell_data[species], data[-1].ravel())
assert tuple(exported.extent) == tuple(extent) and np.allclose(exported.bounds, mesh.bounds)
print("h5py, VTK and PyVista agree on", frames, "frames of", name)
"#;

/// Whether python agrees; its words if not.
fn run(script: &str, arguments: &[&std::ffi::OsStr]) {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let answer = Command::new(python).args(["-c", script]).args(arguments).output().unwrap();
    let words = String::from_utf8_lossy(&answer.stderr);
    assert!(answer.status.success(), "{arguments:?}: {words}");
}

#[test]
#[ignore = "slow: needs python3 with h5py, vtk and pyvista"]
fn python_reads_the_fields_as_images() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    for (file, finish) in [("finished.vtkhdf", true), ("interrupted.h5", false)] {
        let path = folder.path().join(file);
        let layout = layout_with_fields();
        let mut writer = ResultWriter::create(&path, &header(), &layout, Overwrite::Refuse).unwrap();
        (0..12).for_each(|number| writer.append(&frame_with_fields(&cells(3), number)).unwrap());
        if finish {
            writer.finish(1.0).unwrap()
        } else {
            drop(writer)
        }
        for field in &layout.fields {
            let image = folder.path().join(format!("{}.vti", field.name));
            let result = pseudopod::output::ResultFile::open(&path).unwrap();
            let all: Vec<usize> = (0..field.species.len()).collect();
            pseudopod::output::write_field_image(&result, field, &all, 11, &image).unwrap();
            drop(result);
            let view = field_view_path(&path, &field.name);
            run(FIELD_SCRIPT, &[path.as_ref(), view.as_ref(), field.name.as_ref(), "12".as_ref(), image.as_ref()]);
        }
    }
}

/// `python3 -m venv /tmp/venv && /tmp/venv/bin/pip install h5py vtk pyvista`, then
/// `PYTHON=/tmp/venv/bin/python cargo test --release --test processes python -- --ignored`.
#[test]
#[ignore = "slow: needs python3 with h5py, vtk and pyvista"]
fn python_reads_the_animated_surface() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    for (name, finish) in [("finished.vtkhdf", true), ("interrupted.vtkhdf", false)] {
        let path = folder.path().join(name);
        let writer = write(&path, 3, 20);
        if finish {
            writer.finish(1.0).unwrap()
        } else {
            drop(writer)
        }
        run(SCRIPT, &[path.as_ref(), ["3"; 20].join(",").as_ref()]);
    }
}

#[test]
#[ignore = "slow: needs python3 with h5py, vtk and pyvista"]
fn python_reads_frames_with_different_cells() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    // By themselves, and after a frame of so many cells that frames begin with pieces of their own.
    for (name, first) in [("few.vtkhdf", 2), ("many.vtkhdf", 1500)] {
        let path = folder.path().join(name);
        let mut writer = write(&path, first, 1);
        let later = &lineage()[1..];
        let counts: Vec<usize> = [first as usize].into_iter().chain(later.iter().map(Vec::len)).collect();
        (1..).zip(later).for_each(|(number, cells)| writer.append(&frame(cells, number)).unwrap());
        writer.finish(1.0).unwrap();
        let counts = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
        run(SCRIPT, &[path.as_ref(), counts.as_ref()]);
    }
}

#[test]
#[ignore = "slow: needs python3 with h5py, vtk and pyvista"]
fn python_reads_a_file_while_it_is_written() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("running.vtkhdf");
    let mut writer = write(&path, 3, 20);
    for frames in [20, 30, 40] {
        (writer.frames()..frames).for_each(|number| writer.append(&frame(&cells(3), number)).unwrap());
        writer.renew().unwrap();
        // Later frames wait in the log while others read.
        (frames..frames + 5).for_each(|number| writer.append(&frame(&cells(3), number)).unwrap());
        run(SCRIPT, &[path.as_ref(), vec!["3"; frames].join(",").as_ref()]);
    }
}

#[test]
#[ignore = "slow: half an hour: builds the program again, with HDF5 in it; needs python3 with venv, and PyPI"]
fn the_python_packages_are_built_installed_and_pass_their_tests() {
    let _turn = take_turn();
    let checked = Command::new(concat!(env!("CARGO_MANIFEST_DIR"), "/python/check")).arg("--stepping").status();
    assert!(checked.expect("bash starts").success(), "python/check failed, see above");
}
