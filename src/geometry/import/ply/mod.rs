//! PLY, ASCII or binary of either byte order, with any further elements and properties, which are passed over.

mod header;
mod values;

use super::super::Surface;
use super::fan;
use super::text::Text;
use crate::Vec3;
use crate::error::Fault;
use header::{Element, Encoding, Header};
use values::{Trouble, Values};

/// Reads a PLY file. Nothing is allocated on the word of the header: the lists grow with what the file holds.
///
/// # Errors
/// The first fault; in a header and in an ASCII file with its location.
pub(super) fn parse(name: &str, bytes: &[u8]) -> Result<Surface, Vec<Fault>> {
    read(name, bytes).map_err(|fault| vec![fault])
}

fn read(name: &str, bytes: &[u8]) -> Result<Surface, Fault> {
    let Some(length) = header_length(bytes) else {
        return Err(Fault::new(format!("mesh file `{name}` has no PLY header"))
            .help("a PLY file begins with the line `ply` and its header ends with the line `end_header`"));
    };
    let text = Text::new(name, &bytes[..length]);
    let header = header::parse(&text)?;
    let vertices = check_header(name, &header)?;
    match header.encoding {
        Encoding::Ascii => {
            let whole = Text::new(name, bytes);
            // A header that is not UTF-8 is longer as text than as bytes.
            let start = String::from_utf8_lossy(&bytes[..length]).len();
            read_elements(name, &header, vertices, Values::of_text(&whole, start))
        }
        encoding => read_elements(name, &header, vertices, Values::Bytes { bytes: &bytes[length..], encoding }),
    }
}

/// The number of bytes of the header, its last line break included.
fn header_length(bytes: &[u8]) -> Option<usize> {
    let mut start = 0;
    for line in bytes.split_inclusive(|&byte| byte == b'\n') {
        start += line.len();
        if line.trim_ascii() == b"end_header" {
            return Some(start);
        }
    }
    None
}

/// Checks that the header promises vertices with coordinates and faces with a list; returns the number of vertices.
fn check_header(name: &str, header: &Header) -> Result<u64, Fault> {
    let lacks =
        |what: &str, help: &str| Fault::new(format!("mesh file `{name}`: its PLY header has no {what}")).help(help);
    let element = |name: &str| header.elements.iter().find(|element| element.name == name);
    let vertex = element("vertex").ok_or_else(|| lacks("element `vertex`", "give the positions of the atoms"))?;
    for axis in ["x", "y", "z"] {
        if !vertex.properties.iter().any(|property| property.name == axis && property.list.is_none()) {
            return Err(lacks(&format!("property `{axis}` of its vertices"), "give x, y and z of every vertex"));
        }
    }
    let face =
        element("face").ok_or_else(|| lacks("element `face`", "give facets: a cloud of points has no surface"))?;
    if !face.properties.iter().any(is_corner_list) {
        return Err(lacks("list `vertex_indices` of its faces", "write `property list uchar int vertex_indices`"));
    }
    Ok(vertex.count)
}

fn is_corner_list(property: &header::Property) -> bool {
    property.list.is_some() && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
}

fn read_elements(name: &str, header: &Header, vertices: u64, mut values: Values) -> Result<Surface, Fault> {
    let mut surface = Surface::default();
    let mut corners = Vec::new();
    for element in &header.elements {
        if element.properties.is_empty() {
            continue; // whatever its count, it takes no space in the file
        }
        for item in 0..element.count {
            let outcome = match element.name.as_str() {
                "vertex" => read_vertex(element, &mut values).map(|point| surface.positions.push(point)),
                "face" => read_face(element, &mut values, &mut corners),
                _ => read_other(element, &mut values),
            };
            if let Err(trouble) = outcome {
                return Err(explain(trouble, name, element, item));
            }
            if element.name == "vertex" {
                let point = surface.positions[surface.positions.len() - 1];
                if !point.iter().all(|value| value.is_finite()) {
                    let message = format!(
                        "the position of vertex {item} is not a number: ({}, {}, {})",
                        point.x, point.y, point.z
                    );
                    return Err(values.fault(name, message, "give finite coordinates"));
                }
            } else if element.name == "face" {
                let atoms = check_corners(&corners, vertices).map_err(|found| {
                    values.fault(name, format!("face {item} {found}"), "vertices are counted from 0")
                })?;
                surface.facets.extend(fan(&atoms));
            }
        }
    }
    Ok(surface)
}

fn read_vertex(element: &Element, values: &mut Values) -> Result<Vec3, Trouble> {
    let mut point = Vec3::zeros();
    for property in &element.properties {
        if let Some(length) = property.list {
            let length = values.next(length)?;
            skip(length, property.kind, values)?;
            continue;
        }
        let value = values.next(property.kind)?;
        match property.name.as_str() {
            "x" => point.x = value,
            "y" => point.y = value,
            "z" => point.z = value,
            _ => {}
        }
    }
    Ok(point)
}

/// Reads a face and leaves its corners, as they are written, in `corners`.
fn read_face(element: &Element, values: &mut Values, corners: &mut Vec<f64>) -> Result<(), Trouble> {
    for property in &element.properties {
        let Some(length) = property.list else {
            values.next(property.kind)?;
            continue;
        };
        let length = values.next(length)?;
        if !is_corner_list(property) {
            skip(length, property.kind, values)?;
            continue;
        }
        corners.clear();
        let mut left = length;
        while left >= 1.0 {
            corners.push(values.next(property.kind)?);
            left -= 1.0;
        }
    }
    Ok(())
}

fn read_other(element: &Element, values: &mut Values) -> Result<(), Trouble> {
    for property in &element.properties {
        let length = property.list.map_or(Ok(1.0), |length| values.next(length))?;
        skip(length, property.kind, values)?;
    }
    Ok(())
}

/// Passes over values; the end of the file stops it, however long the list claims to be.
fn skip(length: f64, kind: header::Kind, values: &mut Values) -> Result<(), Trouble> {
    let mut left = length;
    while left >= 1.0 {
        values.next(kind)?;
        left -= 1.0;
    }
    Ok(())
}

/// The corners as atom numbers, or what is wrong with them.
fn check_corners(corners: &[f64], vertices: u64) -> Result<Vec<u32>, String> {
    if corners.len() < 3 {
        return Err(format!("has {} corners, expected at least 3", corners.len()));
    }
    let limit = vertices.min(u64::from(u32::MAX)) as f64;
    match corners.iter().find(|&&corner| !(corner >= 0.0 && corner < limit && corner.fract() == 0.0)) {
        Some(bad) => Err(format!("names vertex {bad}, but the file has {vertices} vertices")),
        None => Ok(corners.iter().map(|&corner| corner as u32).collect()),
    }
}

fn explain(trouble: Trouble, name: &str, element: &Element, item: u64) -> Fault {
    match trouble {
        Trouble::Word(fault) => *fault,
        Trouble::End => Fault::new(format!(
            "mesh file `{name}` ends in {} {item} of the {} that its header promises",
            element.name, element.count
        ))
        .help("the file is truncated, or its header is wrong: copy or export it again"),
    }
}
