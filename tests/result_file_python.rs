//! Others read the file without us: h5py, VTK and PyVista.

use std::process::Command;

#[path = "result_file/example.rs"]
#[allow(dead_code)]
mod example;
use example::{layout, write};

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

/// `python3 -m venv /tmp/venv && /tmp/venv/bin/pip install h5py vtk pyvista`, then
/// `PYTHON=/tmp/venv/bin/python cargo test --release --test result_file_python -- --ignored`.
#[test]
#[ignore = "slow: needs python3 with h5py, vtk and pyvista"]
fn python_reads_the_animated_surface() {
    let folder = tempfile::tempdir().unwrap();
    for (name, finish) in [("finished.vtkhdf", true), ("interrupted.vtkhdf", false)] {
        let path = folder.path().join(name);
        let writer = write(&path, &layout(3), 20);
        if finish {
            writer.finish(1.0).unwrap()
        } else {
            drop(writer)
        }
        let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
        let answer = Command::new(python).args(["-c", SCRIPT]).arg(&path).arg("20").output().unwrap();
        let words = String::from_utf8_lossy(&answer.stderr);
        assert!(answer.status.success(), "{name}: {words}");
    }
}
