//! Looks a surface over before a cell is made of it: is it whole, does it face outwards, are its facets sound?

mod fault;
#[cfg(test)]
mod tests;

pub use fault::MeshFault;

use super::measure::{area, facet_qualities, volume};
use super::topology::{HalfEdge, half_edges};
use super::weld::{diagonal, first_at_same_position};
use super::{Surface, Topology};

/// Whether a surface may have an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Boundary {
    /// The surface must be closed, as every cell is.
    Closed,
    /// The surface may be open, like a sheet.
    Allowed,
}

/// What is asked of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceRules {
    /// Whether it must be closed.
    pub boundary: Boundary,
    /// The least quality of a facet, see [`facet_qualities`]; [`LEAST_FACET_QUALITY`] unless there is a reason.
    pub least_quality: f64,
}

/// The least facet quality accepted by default: a needle 35 times as long as it is wide, or a cap 46 times as wide as
/// it is high. In a rest mesh such a facet is an accident, not a choice. The spheres and red cells made here stay above 0.75.
pub const LEAST_FACET_QUALITY: f64 = 0.05;

/// A closed surface with less volume than this times its area to the power 3/2 encloses nothing. A sphere has 0.094,
/// a red cell 0.061, and a pancake whose thickness is 1/1000 of its width still 4e-4.
const LEAST_VOLUME_RATIO: f64 = 1e-6;

/// Atoms closer than this times the diagonal of the mesh stand at the same point.
const SAME_POSITION: f64 = 1e-9;

/// So many faults of one kind are named in the one that stands for all of them.
const NAMED: usize = 3;

/// So many facets are named of a mesh in pieces.
const PIECES: usize = 10;

impl SurfaceRules {
    /// The rules for a cell: closed, without slivers.
    pub const CELL: Self = Self { boundary: Boundary::Closed, least_quality: LEAST_FACET_QUALITY };
    /// The rules for a sheet: it may be open.
    pub const SHEET: Self = Self { boundary: Boundary::Allowed, least_quality: LEAST_FACET_QUALITY };
}

/// Checks a surface against the rules and changes nothing.
///
/// # Errors
/// All faults found, kind after kind, one for each kind. Where a fault would only cause others (an atom that does not exist, a position
/// that is not finite, a hole that leaves no volume to measure), these are not looked for.
pub fn check_surface(surface: &Surface, rules: &SurfaceRules) -> Result<(), Vec<MeshFault>> {
    let mut faults = Vec::new();
    if surface.facets.is_empty() {
        return Err(vec![MeshFault::Empty]);
    }
    add_as_one(&mut faults, atoms_out_of_range(surface), "facets with atoms that do not exist");
    if !faults.is_empty() {
        return Err(faults);
    }
    add_as_one(&mut faults, repeated_atoms(surface), "facets that name an atom twice");
    if faults.is_empty() {
        check_connections(surface, rules, &mut faults);
    }
    let connected_well = faults.is_empty();
    add_as_one(&mut faults, unused_atoms(surface), "atoms without facets");

    let positions = faults.len();
    add_as_one(&mut faults, positions_not_finite(surface), "atoms whose position is not a number");
    if faults.len() == positions {
        add_as_one(&mut faults, duplicate_atoms(surface), "atoms at the place of another");
        add_as_one(&mut faults, slivers(surface, rules.least_quality), "slivers");
        if connected_well {
            faults.extend(bad_volume(surface));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Adds the faults of a kind as one: they mostly have one cause.
fn add_as_one(faults: &mut Vec<MeshFault>, mut found: Vec<MeshFault>, what: &'static str) {
    let count = found.len();
    if count < 2 {
        return faults.append(&mut found);
    }
    found.truncate(NAMED);
    faults.push(MeshFault::Several { count, what, first: found });
}

/// Edges, orientation, holes, pinched atoms and separate pieces of a surface whose facets name three atoms each.
fn check_connections(surface: &Surface, rules: &SurfaceRules, faults: &mut Vec<MeshFault>) {
    let sides = half_edges(&surface.facets);
    let (mut crowded, mut opposed, mut open) = (Vec::new(), Vec::new(), Vec::new());
    for of_edge in sides.chunk_by(|left, right| left.edge() == right.edge()) {
        match of_edge {
            [only] => open.push(MeshFault::BoundaryEdge { edge: [only.from, only.to], facet: only.facet }),
            [left, right] if left.from == right.from => {
                opposed.push(MeshFault::OpposedFacets { edge: [left.from, left.to], facets: [left.facet, right.facet] })
            }
            [_, _] => {}
            many => crowded.push(MeshFault::CrowdedEdge {
                edge: many[0].edge(),
                facets: many.iter().map(|side| side.facet).collect(),
            }),
        }
    }
    let edges_are_sound = crowded.is_empty() && opposed.is_empty();
    add_as_one(faults, crowded, "edges shared by more than 2 facets");
    add_as_one(faults, opposed, "pairs of facets that face to opposite sides");
    if rules.boundary == Boundary::Closed {
        add_as_one(faults, open, "edges with one facet only");
    }
    if edges_are_sound {
        add_as_one(faults, pinched_atoms(surface, &sides), "atoms where separate fans meet");
    }
    faults.extend(separate_surfaces(surface, &sides));
}

fn atoms_out_of_range(surface: &Surface) -> Vec<MeshFault> {
    let count = surface.positions.len();
    numbered(&surface.facets)
        .filter(|(_, atoms)| atoms.iter().any(|&atom| atom as usize >= count))
        .map(|(facet, &atoms)| MeshFault::AtomOutOfRange { facet, atoms, count })
        .collect()
}

fn repeated_atoms(surface: &Surface) -> Vec<MeshFault> {
    numbered(&surface.facets)
        .filter(|(_, [a, b, c])| a == b || b == c || c == a)
        .map(|(facet, &atoms)| MeshFault::RepeatedAtom { facet, atoms })
        .collect()
}

fn unused_atoms(surface: &Surface) -> Vec<MeshFault> {
    let mut used = vec![false; surface.positions.len()];
    surface.facets.iter().flatten().for_each(|&atom| used[atom as usize] = true);
    numbered(&used).filter(|(_, used)| !**used).map(|(atom, _)| MeshFault::UnusedAtom { atom }).collect()
}

fn positions_not_finite(surface: &Surface) -> Vec<MeshFault> {
    numbered(&surface.positions)
        .filter(|(_, position)| !position.iter().all(|value| value.is_finite()))
        .map(|(atom, position)| MeshFault::NotFinite { atom, position: (*position).into() })
        .collect()
}

fn duplicate_atoms(surface: &Surface) -> Vec<MeshFault> {
    let firsts = first_at_same_position(&surface.positions, SAME_POSITION * diagonal(&surface.positions));
    numbered(&firsts)
        .filter(|(atom, first)| atom != *first)
        .map(|(atom, &first)| MeshFault::DuplicateAtoms {
            atoms: [first, atom],
            position: surface.positions[atom as usize].into(),
        })
        .collect()
}

fn slivers(surface: &Surface, least: f64) -> Vec<MeshFault> {
    let qualities = facet_qualities(surface);
    numbered(&qualities)
        .filter(|(_, quality)| **quality < least)
        .map(|(facet, &quality)| {
            let atoms = surface.facets[facet as usize];
            MeshFault::Sliver { facet, atoms, quality, least }
        })
        .collect()
}

/// Atoms around which the facets form several fans. Every edge must have at most two facets that agree.
fn pinched_atoms(surface: &Surface, sides: &[HalfEdge]) -> Vec<MeshFault> {
    let mut links = vec![Vec::new(); surface.positions.len()];
    for side in sides {
        links[side.across as usize].push([side.from, side.to]);
    }
    let mut faults = Vec::new();
    for (atom, around) in links.iter_mut().enumerate() {
        let fans = count_fans(around);
        if fans > 1 {
            faults.push(MeshFault::PinchedAtom { atom: atom as u32, fans });
        }
    }
    faults
}

/// The number of fans that the facets around one atom form, given as links from neighbour to next neighbour.
fn count_fans(links: &mut [[u32; 2]]) -> usize {
    links.sort_unstable();
    let mut entered: Vec<u32> = links.iter().map(|link| link[1]).collect();
    entered.sort_unstable();
    // Open fans begin at a neighbour that no facet leads to; whatever they do not reach is closed.
    let begins = |link: &[u32; 2]| entered.binary_search(&link[0]).is_err();
    let starts = (0..links.len()).filter(|&k| begins(&links[k])).chain(0..links.len());
    let mut walked = vec![false; links.len()];
    let mut fans = 0;
    for start in starts {
        if walked[start] {
            continue;
        }
        fans += 1;
        let mut here = start;
        while !std::mem::replace(&mut walked[here], true) {
            match links.binary_search_by_key(&links[here][1], |link| link[0]) {
                Ok(next) => here = next,
                Err(_) => break,
            }
        }
    }
    fans
}

/// Whether the facets fall into surfaces that share no edge and no atom.
fn separate_surfaces(surface: &Surface, sides: &[HalfEdge]) -> Option<MeshFault> {
    let mut parents: Vec<u32> = (0..surface.positions.len() as u32).collect();
    for side in sides {
        let (one, other) = (root(&mut parents, side.from), root(&mut parents, side.to));
        parents[one.max(other) as usize] = one.min(other);
    }
    let mut seen = vec![false; surface.positions.len()];
    let mut first_facets = Vec::new();
    for (facet, atoms) in numbered(&surface.facets) {
        let surface_of = root(&mut parents, atoms[0]) as usize;
        if !std::mem::replace(&mut seen[surface_of], true) {
            first_facets.push(facet);
        }
    }
    let count = first_facets.len();
    first_facets.truncate(PIECES);
    (count > 1).then_some(MeshFault::SeparateSurfaces { count, facets: first_facets })
}

/// The representative of an atom's surface; halves the path to it on the path.
pub(super) fn root(parents: &mut [u32], mut atom: u32) -> u32 {
    while parents[atom as usize] != atom {
        parents[atom as usize] = parents[parents[atom as usize] as usize];
        atom = parents[atom as usize];
    }
    atom
}

/// Volume faults of a surface; none for one that is open or whose facets do not all face to the same side, because it
/// has no volume to speak of.
pub(super) fn bad_volume(surface: &Surface) -> Option<MeshFault> {
    let topology = Topology::of(surface);
    if topology.flaps.len() != topology.edges.len() {
        return None;
    }
    let (volume, area) = (volume(surface), area(surface));
    if volume.abs() <= LEAST_VOLUME_RATIO * area.powf(1.5) {
        Some(MeshFault::ZeroVolume { volume, area })
    } else if volume < 0.0 {
        Some(MeshFault::Inverted { volume })
    } else {
        None
    }
}

/// The items of a list with their numbers.
fn numbered<T>(items: &[T]) -> impl Iterator<Item = (u32, &T)> {
    items.iter().enumerate().map(|(number, item)| (number as u32, item))
}
