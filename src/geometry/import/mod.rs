//! Reads cell shapes from the mesh files of other programs: OBJ, STL and PLY.

mod obj;
mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod text;

use super::check::bad_volume;
use super::{MeshFault, Surface, SurfaceRules, check_surface};
use crate::error::{Error, Fault, Result};
use std::path::Path;

/// The file name extensions of the formats that can be read.
const FORMATS: [&str; 3] = ["obj", "ply", "stl"];

/// Reads a surface from an OBJ, STL (ASCII or binary) or PLY (ASCII or binary) file, told apart by the extension.
///
/// Polygons are cut into triangles, fan-wise from their first corner; normals, textures, colours and groups are passed
/// over. `scale_to_um` is the length of one unit of the file in µm (1000 for a file in millimetres). STL keeps no
/// atoms, so its corners are merged where they are closer than a millionth of the size of the mesh.
///
/// The surface is not checked beyond what reading needs; see [`check_surface`](super::check_surface).
///
/// # Errors
/// [`Error::Input`] when the file does not exist or cannot be read, when its format is not known, when its content
/// breaks the format (with line and column in the text formats), when a facet names an atom that does not exist, and
/// when a closed mesh is inverted, that is its facets face inwards.
pub fn read_surface(path: &Path, scale_to_um: f64) -> Result<Surface> {
    let name = path.display().to_string();
    if !(scale_to_um.is_finite() && scale_to_um > 0.0) {
        let fault = Fault::new(format!("the scale of mesh `{name}` is {scale_to_um}"));
        return Err(Error::input(fault.help("give the length of one unit of the file, a number above 0")));
    }
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    let format = extension.as_deref().unwrap_or("");
    if !FORMATS.contains(&format) {
        let found =
            if format.is_empty() { "has no extension".into() } else { format!("has the extension `.{format}`") };
        let fault = Fault::new(format!("mesh file `{name}` {found}, which names no format that can be read"));
        return Err(Error::input(
            fault.help("mesh files end in .obj, .ply or .stl, or in .pml for a physical model in an experiment"),
        ));
    }
    let bytes = crate::files::read(path).map_err(|failure| Error::input(not_readable(path, &failure)))?;
    let mut surface = match format {
        "obj" => obj::parse(&name, &bytes),
        "ply" => ply::parse(&name, &bytes),
        _ => stl::parse(&name, &bytes),
    }
    .map_err(Error::Input)?;
    surface.positions.iter_mut().for_each(|position| *position *= scale_to_um);
    finish(&name, surface).map_err(Error::input)
}

/// Reads a surface as [`read_surface`] does and checks it against the rules.
///
/// # Errors
/// Those of [`read_surface`], and [`Error::Input`] with every fault that [`check_surface`] finds.
pub fn read_checked_surface(path: &Path, scale_to_um: f64, rules: &SurfaceRules) -> Result<Surface> {
    let surface = read_surface(path, scale_to_um)?;
    let mesh = format!("mesh file `{}`", path.display());
    match check_surface(&surface, rules) {
        Ok(()) => Ok(surface),
        Err(faults) => Err(Error::Input(faults.into_iter().map(|fault| fault.into_fault(&mesh)).collect())),
    }
}

/// What every format must yield: facets, numbers that are still finite after scaling, an inside within.
fn finish(name: &str, surface: Surface) -> std::result::Result<Surface, Fault> {
    let mesh = format!("mesh file `{name}`");
    if surface.facets.is_empty() {
        return Err(MeshFault::Empty.into_fault(&mesh));
    }
    if let Some(atom) = surface.positions.iter().position(|point| !point.iter().all(|value| value.is_finite())) {
        let position = surface.positions[atom].into();
        return Err(MeshFault::NotFinite { atom: atom as u32, position }.into_fault(&mesh));
    }
    if let Some(fault @ MeshFault::Inverted { .. }) = bad_volume(&surface) {
        return Err(fault.into_fault(&mesh));
    }
    Ok(surface)
}

/// The fault of a file that cannot be opened: which folder was looked in, and what is there instead.
fn not_readable(path: &Path, failure: &std::io::Error) -> Fault {
    let name = path.display();
    if failure.kind() != std::io::ErrorKind::NotFound {
        return Fault::new(format!("mesh file `{name}` cannot be read: {failure}"))
            .help("give a file that you may read");
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let looked_in = folder.map_or("the current folder".into(), |folder| format!("folder `{}`", folder.display()));
    let help = match std::fs::read_dir(folder.unwrap_or(Path::new("."))) {
        Err(_) => format!("looked in {looked_in}, which does not exist either"),
        Ok(entries) => {
            let mut meshes: Vec<String> = entries
                .flatten()
                .map(|entry| entry.file_name().to_string_lossy().into_owned())
                .filter(|name| {
                    let extension = Path::new(name).extension().map(|end| end.to_string_lossy().to_ascii_lowercase());
                    extension.is_some_and(|end| FORMATS.contains(&end.as_str()))
                })
                .collect();
            let wanted = path.file_name().unwrap_or_default().to_string_lossy();
            meshes.sort_by(|one, other| {
                let likeness = |name: &str| strsim::jaro_winkler(name, &wanted);
                likeness(other).total_cmp(&likeness(one)).then_with(|| one.cmp(other))
            });
            meshes.truncate(5);
            let there = meshes.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let holds = if meshes.is_empty() { "no mesh file" } else { &there };
            format!("looked in {looked_in}, which holds {holds}")
        }
    };
    Fault::new(format!("mesh file `{name}` does not exist")).help(help)
}

/// Cuts a polygon into triangles from its first corner.
fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    (2..corners.len()).map(|last| [corners[0], corners[last - 1], corners[last]])
}
