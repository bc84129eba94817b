//! Cells so far from the origin that the numbers of their positions no longer tell their shape.

use super::super::{CellType, Document, Mesh, Placement};
use super::model::written_unit;
use super::notices::unit_advice;
use super::positions::default_grid;
use crate::error::{Fault, short};
use crate::geometry::{Surface, area, bounding_box, mean_edge_length, volume};
use crate::sim::VOLUME_TOLERANCE;
use crate::units::{Dimension, pretty};

/// Tells of cells of a type that start, or come, too far away.
///
/// A position at a distance x from the origin is rounded by u x, u = 2⁻⁵³, along each axis. The volume of a cell with the surface A is then
/// known to √3 u x A at worst, and the run holds it to 10⁻¹⁰ of itself. An open surface has no volume; its edges are asked to be known as well.
pub fn check(document: &Document, key: &str, cell: &CellType, rest: &Surface, closed: bool, faults: &mut Vec<Fault>) {
    let thickness = if closed { volume(rest).abs() / area(rest) } else { mean_edge_length(rest) };
    let most = VOLUME_TOLERANCE * thickness / (3_f64.sqrt() * 0.5 * f64::EPSILON);
    let starts = (cell.count() > 0).then(|| (format!("{key}.placement"), cell.placement.as_ref(), cell.count()));
    let come = cell.added.iter().enumerate();
    let come = come.map(|(i, added)| (format!("{key}.added[{i}].placement"), Some(&added.placement), added.count()));
    for (key, placement, number) in starts.into_iter().chain(come) {
        let (at, distance) = farthest(placement, number, rest);
        if distance <= most {
            continue;
        }
        let what = if closed { "volumes" } else { "edges" };
        let message = format!(
            "`{key}` puts cells {} um from the origin, where positions are too coarse to know {what} better than to {:.1e}",
            short(distance),
            VOLUME_TOLERANCE * distance / most
        );
        let help = format!(
            "place them within {} um of the origin, where {what} are known to {VOLUME_TOLERANCE:e} at least, as a run needs",
            short(most.floor())
        );
        let location = document.location(&format!("{key}{at}"), "too far from the origin");
        faults.push(location.into_iter().fold(Fault::new(message).help(help), Fault::at));
    }
}

/// The key within a placement that puts a cell the farthest from the origin, and how far along an axis, µm.
fn farthest(placement: Option<&Placement>, number: usize, rest: &Surface) -> (String, f64) {
    let largest = |components: [f64; 3]| components.into_iter().map(f64::abs).fold(0.0, f64::max);
    match placement {
        Some(Placement::At { at }) => {
            let distances = at.iter().enumerate().map(|(i, at)| (format!(".at[{i}]"), largest(at.map(|x| x.value()))));
            distances.max_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or_default()
        }
        Some(Placement::Grid { grid, spacing, origin }) => {
            let half = grid.map(|n| 0.5 * (f64::from(n) - 1.0) * spacing.value());
            let at = if largest(half) > largest(origin.map(|x| x.value())) { ".spacing" } else { ".origin" };
            (at.to_owned(), largest([0, 1, 2].map(|axis| origin[axis].value().abs() + half[axis])))
        }
        Some(Placement::Random { random_from, random_to }) => {
            let [from, to] = [random_from, random_to].map(|corner| largest(corner.map(|x| x.value())));
            if from > to { (".random_from".to_owned(), from) } else { (".random_to".to_owned(), to) }
        }
        None => {
            let (side, spacing) = default_grid(number, rest);
            (String::new(), 0.5 * (f64::from(side) - 1.0) * spacing)
        }
    }
}

/// The widest that cells are, µm: a metre. And the least: a nanometre, below which there are no membranes. Between them areas, volumes and what
/// the laws of mechanics make of them stay within what numbers of eight bytes, and boxes of four, can bear.
pub const WIDTHS: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// Tells of a mesh from a file that is wider or narrower than any cell; the schema bounds the others.
pub fn check_width(document: &Document, key: &str, mesh: &Mesh, rest: &Surface, faults: &mut Vec<Fault>) {
    let Mesh::File { path, unit, .. } = mesh else { return };
    let width = bounding_box(&rest.positions).map_or(0.0, |(low, high)| (high - low).max());
    if WIDTHS.contains(&width) {
        return;
    }
    let told = |length: f64| pretty(length, Dimension::LENGTH);
    let message = format!(
        "the mesh of `{key}` is {} wide; {} to {} were expected",
        told(width),
        told(*WIDTHS.start()),
        told(*WIDTHS.end())
    );
    let help = unit_advice(written_unit(document, &format!("{key}.mesh"), path, *unit), width);
    let location = document.location(&format!("{key}.mesh.path"), "this file");
    faults.push(location.into_iter().fold(Fault::new(message).help(help), Fault::at));
}
