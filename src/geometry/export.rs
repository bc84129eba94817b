//! Writes surfaces for other programs: OBJ, PLY and STL, in µm.

use super::Surface;
use crate::error::{Error, Fault, Result};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A quantity of atoms that a file of a surface may carry: its name, one word, and a number for each atom.
pub type OfAtoms<'a> = (&'a str, Vec<f64>);

/// Writes a surface to a file, as OBJ, PLY or STL by its extension; an existing file is replaced. Quantities are left out where
/// the format has none: only PLY does.
///
/// # Errors
/// [`Error::Input`] for another extension, [`Error::Machine`] when the file cannot be written.
///
/// # Panics
/// If a quantity does not have a number for each atom.
pub fn export_surface(surface: &Surface, quantities: &[OfAtoms], path: &Path) -> Result<()> {
    type Out = BufWriter<File>;
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    let write: fn(&Surface, &[OfAtoms], &mut Out) -> io::Result<()> = match extension.as_deref() {
        Some("obj") => |surface, _, out| write_obj(surface, out),
        Some("ply") => write_ply,
        Some("stl") => |surface, _, out| write_stl(surface, out),
        _ => {
            let fault = Fault::new(format!("mesh file `{}` names no format that can be written", path.display()));
            return Err(Error::input(fault.help("mesh files end in .obj, .ply or .stl")));
        }
    };
    let outcome = File::create(path).and_then(|file| {
        let mut out = BufWriter::new(file);
        write(surface, quantities, &mut out)?;
        out.flush()
    });
    outcome.map_err(|failure| Error::Machine {
        message: format!("mesh file `{}` cannot be written: {failure}", path.display()),
        help: "write to a folder that exists, that is yours and that has room".into(),
    })
}

/// Writes a surface as OBJ text. Every digit is kept.
///
/// # Errors
/// Those of `out`.
pub fn write_obj(surface: &Surface, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "# lengths in um")?;
    for position in &surface.positions {
        writeln!(out, "v {} {} {}", position.x, position.y, position.z)?;
    }
    for facet in &surface.facets {
        let [a, b, c] = facet.map(|atom| u64::from(atom) + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    Ok(())
}

/// Writes a surface as binary little-endian PLY in double precision, with these quantities of its atoms. Every digit is kept.
///
/// # Errors
/// Those of `out`.
///
/// # Panics
/// If a quantity does not have a number for each atom.
pub fn write_ply(surface: &Surface, quantities: &[OfAtoms], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0\ncomment lengths in um")?;
    writeln!(out, "element vertex {}", surface.positions.len())?;
    writeln!(out, "property double x\nproperty double y\nproperty double z")?;
    for (name, _) in quantities {
        writeln!(out, "property double {name}")?;
    }
    writeln!(out, "element face {}\nproperty list uchar uint vertex_indices\nend_header", surface.facets.len())?;
    for (atom, position) in surface.positions.iter().enumerate() {
        for value in position.iter().chain(quantities.iter().map(|(_, values)| &values[atom])) {
            out.write_all(&value.to_le_bytes())?;
        }
    }
    for facet in &surface.facets {
        out.write_all(&[3])?;
        for atom in facet {
            out.write_all(&atom.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Writes a surface as binary STL, in single precision, which is all the format holds.
///
/// # Errors
/// Those of `out`.
pub fn write_stl(surface: &Surface, out: &mut impl Write) -> io::Result<()> {
    let mut header = [b' '; 80];
    let title = b"binary STL, lengths in um"; // must not begin with `solid`, which would pass for ASCII
    header[..title.len()].copy_from_slice(title);
    out.write_all(&header)?;
    out.write_all(&(surface.facets.len() as u32).to_le_bytes())?;
    for &facet in &surface.facets {
        let [a, b, c] = surface.corners(facet);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        for value in [normal, a, b, c].iter().flat_map(|vector| vector.iter()) {
            out.write_all(&(*value as f32).to_le_bytes())?;
        }
        out.write_all(&[0, 0])?;
    }
    Ok(())
}
