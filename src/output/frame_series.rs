//! Frames as files of their own, and the file that says when each is (`.pvd`): so ParaView and PyVista play them.

use std::fs;
use std::path::{Path, PathBuf};

use super::container::machine_error;
use super::field_export::write_field_image;
use super::field_layout::FieldLayout;
use super::mesh_export::write_mesh;
use super::vtk_xml::escaped;
use super::{ResultFile, write_text};
use crate::error::Result;

/// The folder of the frames of a series: the path of its `.pvd` without the ending.
pub fn series_folder(path: &Path) -> PathBuf {
    path.with_extension("")
}

/// The path of a frame in a series whose files have this ending.
pub fn series_file(path: &Path, frame: usize, ending: &str) -> PathBuf {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    series_folder(path).join(format!("{name}_{frame:06}.{ending}"))
}

/// Writes the cells of these frames, in ascending order, or the one with an id, each frame as [`write_mesh`] does into the [`series_folder`], and the
/// `.pvd` that leads to them. Existing files are replaced, and frames that were there and are none of these removed.
///
/// # Errors
/// A damaged result, or files that cannot be written.
///
/// # Panics
/// If there is no such frame.
pub fn write_mesh_series(result: &ResultFile, frames: &[usize], cell: Option<u64>, path: &Path) -> Result<()> {
    write_series(result, frames, path, "vtu", |frame, file| write_mesh(result, frame, cell, file))
}

/// The same of some species of a field, each frame as [`write_field_image`] does.
///
/// # Errors
/// As [`write_mesh_series`].
///
/// # Panics
/// As [`write_mesh_series`], and if there is no such species.
pub fn write_field_series(
    result: &ResultFile,
    field: &FieldLayout,
    species: &[usize],
    frames: &[usize],
    path: &Path,
) -> Result<()> {
    write_series(result, frames, path, "vti", |frame, file| write_field_image(result, field, species, frame, file))
}

/// One frame after the other; the `.pvd` comes last, so that what it names is there.
fn write_series(
    result: &ResultFile,
    frames: &[usize],
    path: &Path,
    ending: &str,
    write: impl Fn(usize, &Path) -> Result<()>,
) -> Result<()> {
    let folder = series_folder(path);
    let trouble = |error: std::io::Error| machine_error(&folder, "cannot be made", &error.to_string());
    fs::create_dir_all(&folder).map_err(trouble)?;
    let times = result.times()?;
    let below = folder.file_name().unwrap_or_default().to_string_lossy();
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for frame in frames {
        let file = series_file(path, *frame, ending);
        write(*frame, &file)?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let (time, file) = (times[*frame], escaped(&format!("{below}/{name}")));
        text.push_str(&format!("<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{file}\"/>\n"));
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    write_text(&text, path)?;
    remove_others(path, frames, ending)
}

/// Removes the frames of a series that was here before, by their names.
fn remove_others(path: &Path, frames: &[usize], ending: &str) -> Result<()> {
    let folder = series_folder(path);
    let trouble = |error: std::io::Error| machine_error(&folder, "cannot be tidied", &error.to_string());
    for entry in fs::read_dir(&folder).map_err(trouble)? {
        let file = entry.map_err(trouble)?.path();
        let number = file.file_stem().and_then(|name| name.to_str()?.rsplit_once('_')?.1.parse::<usize>().ok());
        if let Some(frame) = number
            && frames.binary_search(&frame).is_err()
            && file == series_file(path, frame, ending)
        {
            fs::remove_file(&file).map_err(trouble)?;
        }
    }
    Ok(())
}
