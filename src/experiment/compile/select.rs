//! Finds the atoms that a selection means.

use super::super::{Cap, CapExtent, Document, Selection};
use super::numbers::unit;
use crate::Vec3;
use crate::error::Fault;
use crate::geometry::{self, Surface};

/// The atoms of a selection, each once, rising; faults for those that do not exist.
pub fn atoms(
    document: &Document,
    key: &str,
    selection: &Selection,
    rest: &Surface,
    faults: &mut Vec<Fault>,
) -> Vec<u32> {
    let count = rest.positions.len();
    let mut chosen: Vec<u32> = match selection {
        Selection::All(_) => (0..count as u32).collect(),
        Selection::Cap(cap) => {
            if let CapExtent::Number(number) = cap.extent
                && number as usize > count
            {
                let fault = Fault::new(format!("a cap of {number} atoms does not exist: the mesh has {count} atoms"))
                    .help(format!("give a number up to {count}, or `{{ all = true }}`"));
                let location = document.location(&format!("{key}.cap.number"), "more than there are");
                faults.push(location.into_iter().fold(fault, Fault::at));
            }
            cap_atoms(cap, rest)
        }
        Selection::Atoms(list) => {
            for (i, &atom) in list.iter().enumerate().filter(|(_, atom)| **atom as usize >= count) {
                let fault = Fault::new(format!("atom {atom} does not exist: the mesh has {count} atoms"))
                    .help(format!("atoms are numbered from 0 to {}", count - 1));
                let location = document.location(&format!("{key}.atoms[{i}]"), "no such atom");
                faults.push(location.into_iter().fold(fault, Fault::at));
            }
            list.iter().copied().filter(|&atom| (atom as usize) < count).collect()
        }
    };
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// The atoms of the rest shape that lie furthest along a direction from its centre.
fn cap_atoms(cap: &Cap, rest: &Surface) -> Vec<u32> {
    let direction = unit(cap.direction);
    let centre = rest.positions.iter().sum::<Vec3>() / rest.positions.len() as f64;
    let height = |atom: &u32| (rest.positions[*atom as usize] - centre).dot(&direction);
    let mut order: Vec<u32> = (0..rest.positions.len() as u32).collect();
    // Heights that differ by round-off count as equal, so that symmetric atoms keep the order of their numbers.
    let size = order.iter().map(|atom| height(atom).abs()).fold(0.0, f64::max);
    order.sort_by_key(|atom| ((-height(atom) / size * 1e9).round() as i64, *atom));
    match cap.extent {
        CapExtent::Number(number) => order.truncate(number as usize),
        CapExtent::Fraction(fraction) => {
            let number = (fraction * rest.positions.len() as f64).round() as usize;
            order.truncate(number.max(1));
        }
        CapExtent::Depth(depth) => {
            let top = order.first().map_or(0.0, height);
            // A side that is told by its exact depth is meant as a whole.
            order.retain(|atom| height(atom) >= top - depth.value() - 1e-9 * size);
        }
        CapExtent::Angle(angle) => order.retain(|atom| {
            let away = rest.positions[*atom as usize] - centre;
            away.dot(&direction) >= (angle.value().cos() - 1e-12) * away.norm()
        }),
    }
    order
}

/// The height of every atom in its cap, 1 at the top of the cell and 0 at the rim or below, eq. (loads.1). The top is the
/// furthest atom along the cap's direction (or the load's, where no cap is selected); the rim of a cap that an angle
/// bounds is where a sphere has it, that of any other selection one mean edge below its lowest atom.
pub fn heights(selection: &Selection, direction: Vec3, rest: &Surface) -> Vec<f64> {
    let up = if let Selection::Cap(cap) = selection { unit(cap.direction) } else { direction };
    let centre = rest.positions.iter().sum::<Vec3>() / rest.positions.len() as f64;
    let along: Vec<f64> = rest.positions.iter().map(|p| (p - centre).dot(&up)).collect();
    let top = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let rim = match selection {
        Selection::Cap(Cap { extent: CapExtent::Angle(angle), .. }) => top * angle.value().cos(),
        Selection::Cap(cap) => lowest(&along, &cap_atoms(cap, rest)) - geometry::mean_edge_length(rest),
        Selection::Atoms(list) => lowest(&along, list) - geometry::mean_edge_length(rest),
        Selection::All(_) => along.iter().copied().fold(f64::INFINITY, f64::min),
    };
    along.iter().map(|along| ((along - rim) / (top - rim)).max(0.0)).collect()
}

fn lowest(along: &[f64], atoms: &[u32]) -> f64 {
    atoms.iter().filter_map(|&atom| along.get(atom as usize)).copied().fold(f64::INFINITY, f64::min)
}

/// Pairs of atoms that are each other's image under a symmetry of the plain mesh, each pair once.
pub fn mirrored(plain: &Surface, image: impl Fn(Vec3) -> Vec3) -> Vec<[u32; 2]> {
    let size = plain.positions.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let find = |position: Vec3| plain.positions.iter().position(|p| (p - position).norm() < 1e-6 * size);
    let mut pairs = Vec::new();
    for (i, position) in plain.positions.iter().enumerate() {
        if let Some(j) = find(image(*position)).filter(|&j| j > i) {
            pairs.push([i as u32, j as u32]);
        }
    }
    pairs
}
