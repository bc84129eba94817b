//! STL, ASCII or binary: facets with three corners each and no atoms, which are found by merging the corners.

use super::super::Surface;
use super::super::weld::{diagonal, first_at_same_position};
use super::text::{Text, Word};
use crate::Vec3;
use crate::error::Fault;

/// Corners closer than this times the diagonal of the mesh are one atom. STL stores single precision, whose last digit
/// is 6e-8 of a coordinate.
const SAME_POSITION: f64 = 1e-6;

/// Header and facet count of a binary file, bytes.
const HEADER: usize = 84;
/// One facet of a binary file, bytes: a normal, three corners, two spare bytes.
const FACET: usize = 50;

/// Reads an STL file.
///
/// # Errors
/// The first fault; in an ASCII file with its location.
pub(super) fn parse(name: &str, bytes: &[u8]) -> Result<Surface, Vec<Fault>> {
    let corners = if is_ascii(bytes) { parse_ascii(name, bytes) } else { parse_binary(name, bytes) };
    corners.map(|corners| merge_corners(&corners)).map_err(|fault| vec![fault])
}

/// Whether the file is ASCII. Binary files may begin with `solid` as well, but then their length fits their count.
fn is_ascii(bytes: &[u8]) -> bool {
    let is_binary_length = declared_length(bytes).is_some_and(|length| length == bytes.len() as u64);
    let text = bytes.trim_ascii_start();
    let begins = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    begins && !is_binary_length && !text[..text.len().min(1024)].contains(&0)
}

/// The length that a binary file must have by its facet count.
fn declared_length(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    let count = u32::from_le_bytes(count.try_into().ok()?);
    Some(HEADER as u64 + FACET as u64 * u64::from(count))
}

fn parse_binary(name: &str, bytes: &[u8]) -> Result<Vec<Vec3>, Fault> {
    let Some(declared) = declared_length(bytes) else {
        return Err(Fault::new(format!("mesh file `{name}` is {} bytes long, too short for STL", bytes.len()))
            .help("an STL file begins with `solid` (ASCII) or with 84 bytes of header (binary)"));
    };
    if (bytes.len() as u64) < declared {
        let facets = (bytes.len() - HEADER) / FACET;
        let promised = (declared - HEADER as u64) / FACET as u64;
        return Err(Fault::new(format!(
            "mesh file `{name}` ends after {facets} whole facets of the {promised} that its header promises"
        ))
        .help("the file is truncated or is not STL: copy or export it again"));
    }
    let mut corners = Vec::new();
    for (number, facet) in bytes[HEADER..declared as usize].chunks_exact(FACET).enumerate() {
        for corner in facet[12..48].chunks_exact(12) {
            let at = |byte: usize| f64::from(f32::from_le_bytes([0, 1, 2, 3].map(|k| corner[byte + k])));
            let point = Vec3::new(at(0), at(4), at(8));
            if !point.iter().all(|value| value.is_finite()) {
                return Err(Fault::new(format!(
                    "mesh file `{name}`: a corner of facet {number} is not a number: ({}, {}, {})",
                    point.x, point.y, point.z
                ))
                .help("give finite coordinates"));
            }
            corners.push(point);
        }
    }
    Ok(corners)
}

fn parse_ascii(name: &str, bytes: &[u8]) -> Result<Vec<Vec3>, Fault> {
    let text = Text::new(name, bytes);
    let mut corners = Vec::new();
    let mut in_facet: Option<usize> = None; // number of corners when the facet began
    let mut ended = false;
    for line in text.lines() {
        let keyword = line[0];
        match keyword.text.to_ascii_lowercase().as_str() {
            "facet" if in_facet.is_none() => in_facet = Some(corners.len()),
            "vertex" if in_facet.is_some() => corners.push(text.point(&line)?),
            "endfacet" if in_facet.is_some_and(|before| corners.len() == before + 3) => in_facet = None,
            "endfacet" => return Err(wrong_corners(&text, keyword, corners.len() - in_facet.unwrap_or(corners.len()))),
            "outer" | "endloop" => {}
            "solid" => ended = false,
            "endsolid" if in_facet.is_none() => ended = true,
            _ => {
                return Err(text.fault(
                    keyword,
                    format!("`{}` does not belong here", keyword.text),
                    if in_facet.is_some() { "inside a facet" } else { "outside a facet" },
                    "ASCII STL is `facet`, `outer loop`, three `vertex x y z`, `endloop`, `endfacet`, again and again",
                ));
            }
        }
    }
    if in_facet.is_some() || !ended {
        let facets = corners.len() / 3;
        return Err(text.fault_at_end(
            format!("the file ends after {facets} whole facets, without `endsolid`"),
            "the file is truncated: copy or export it again",
        ));
    }
    Ok(corners)
}

fn wrong_corners(text: &Text, keyword: Word, count: usize) -> Fault {
    text.fault(
        keyword,
        format!("a facet has {count} corners"),
        "ends here",
        "STL facets are triangles: 3 `vertex` lines",
    )
}

/// Makes atoms of the corners, three per facet, that stand at the same point; numbered in the order of the file.
fn merge_corners(corners: &[Vec3]) -> Surface {
    let firsts = first_at_same_position(corners, SAME_POSITION * diagonal(corners));
    let mut surface = Surface::default();
    let mut atoms = vec![0; corners.len()];
    for (corner, &first) in firsts.iter().enumerate() {
        if first as usize == corner {
            atoms[corner] = surface.positions.len() as u32;
            surface.positions.push(corners[corner]);
        } else {
            atoms[corner] = atoms[first as usize];
        }
    }
    surface.facets = atoms.chunks_exact(3).map(|facet| [facet[0], facet[1], facet[2]]).collect();
    surface
}
