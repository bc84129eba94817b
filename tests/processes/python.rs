//! Others read the file without us: h5py, VTK and PyVista; the cells from the result itself, each field from the small
//! file that leads to it.

use std::process::Command;

use crate::result_example::{frame_with_fields, header, layout, layout_with_fields, write};
use crate::turns::take_turn;
use pseudopod::output::{Overwrite, ResultWriter, field_view_path};

/// Steps through time with VTK's reader, as ParaView does, and compares with the numbers that h5py reads.
const SCRIPT: &str = r#"
import sys, h5py, numpy as np
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
from vtkmodules.util.numpy_support import vtk_to_numpy
path, frames = sys.argv[1], int(sys.argv[2])
with h5py.File(path) as f:
    points, force = f["VTKHDF/Points"][:], f["VTKHDF/PointData/force"][:]
    offsets, time = f["VTKHDF/Steps/PointOffsets"][:], f["time"][:]
    atoms, links = int(f["VTKHDF/NumberOfPoints"][0]), int(f["VTKHDF/Lines/NumberOfCells"][0])
    facets = f["VTKHDF/Polygons/Connectivity"][:].reshape(-1, 3)
    owner = f["VTKHDF/CellData/cell"][:]
    assert f["time"].attrs["unit"] == "s" and f["cells/volume"].attrs["unit"] == "um^3"
    assert f["provenance/experiment"].asstr()[()].startswith('title = "A walk"')
    assert f["cells/position"].shape == (frames, 3, 3)
    assert list(f["cells/type_names"].asstr()) == ["round", "lone"]
    def check_described(name, item):
        if isinstance(item, h5py.Dataset):
            assert "unit" in item.attrs and "description" in item.attrs, name
    f.visititems(check_described)
reader = vtkHDFReader()
reader.SetFileName(path)
reader.UpdateInformation()
steps = reader.GetOutputInformation(0).Get(pipeline.TIME_STEPS())
assert np.array_equal(steps, time) and len(steps) == frames, steps
for step in [*range(frames), 1, frames - 1, 0]:
    reader.UpdateTimeStep(time[step])
    surface = reader.GetOutputDataObject(0)
    expected = points[offsets[step]:offsets[step] + atoms]
    bounds = np.array(surface.GetBounds()).reshape(3, 2)
    assert np.allclose(bounds[:, 0], expected.min(0)) and np.allclose(bounds[:, 1], expected.max(0)), (step, bounds)
    assert np.array_equal(vtk_to_numpy(surface.GetPoints().GetData()), expected)
    assert np.array_equal(vtk_to_numpy(surface.GetPointData().GetArray("force")), force[offsets[step]:offsets[step] + atoms])
    assert np.array_equal(vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3), facets)
    assert surface.GetNumberOfLines() == links
    assert np.array_equal(vtk_to_numpy(surface.GetCellData().GetArray("cell")), owner)
    assert surface.GetPointData().GetArray("type").GetNumberOfTuples() == atoms
import pyvista  # takes VTK's reader for the endings .vtkhdf and .hdf, and reads the first step
mesh = pyvista.read(path)
assert np.array_equal(mesh.points, points[offsets[0]:offsets[0] + atoms])
assert mesh.n_points == atoms and mesh.n_faces_strict == len(facets), mesh
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
    assert f["chemistry/brain/U"].shape == (frames, 2) and list(f["chemistry_cells/brain"][:]) == [0, 2]
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
        let layout = layout_with_fields(3);
        let mut writer = ResultWriter::create(&path, &header(), &layout, Overwrite::Refuse).unwrap();
        (0..12).for_each(|number| writer.append(&frame_with_fields(&layout, number)).unwrap());
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
        let writer = write(&path, &layout(3), 20);
        if finish {
            writer.finish(1.0).unwrap()
        } else {
            drop(writer)
        }
        run(SCRIPT, &[path.as_ref(), "20".as_ref()]);
    }
}
