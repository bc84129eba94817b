//! What may be wrong with a body of cells.

use super::super::check::root;
use super::{SolidCell, count_faces, tetrahedron_volume};
use crate::Vec3;
use std::fmt;

/// Least quality of a tetrahedron, 6√2 times its volume over the third power of its root-mean-square edge: 1 for a regular one. In a rest
/// mesh a flatter one is an accident; those that a cube is cut into have 0.77 and 1.
pub const LEAST_TETRAHEDRON_QUALITY: f64 = 0.02;

/// So many faults of one kind are told.
const TOLD: usize = 3;

/// A fault of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum SolidFault {
    /// There are no cells.
    Empty,
    /// A cell names an atom that does not exist.
    AtomOutOfRange {
        /// Number of the cell.
        cell: usize,
        /// The atom.
        atom: u32,
        /// How many there are.
        count: usize,
    },
    /// A cell names an atom twice.
    RepeatedAtom {
        /// Number of the cell.
        cell: usize,
        /// The atom.
        atom: u32,
    },
    /// Some tetrahedra of a cell are turned inside out and others are not.
    Inverted {
        /// Number of the cell.
        cell: usize,
        /// Atoms of a tetrahedron that is turned against most.
        atoms: [u32; 4],
    },
    /// A tetrahedron is flat.
    Flat {
        /// Number of the cell that it belongs to.
        cell: usize,
        /// Its atoms.
        atoms: [u32; 4],
        /// Its quality.
        quality: f64,
    },
    /// A face that more than two tetrahedra have.
    CrowdedFace {
        /// Its atoms.
        face: [u32; 3],
        /// How many have it.
        count: u32,
    },
    /// The body falls into pieces that share no atom.
    Pieces {
        /// How many.
        count: usize,
        /// An atom of each, of the first few.
        atoms: Vec<u32>,
    },
}

impl fmt::Display for SolidFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the body has no cells that fill it"),
            Self::AtomOutOfRange { cell, atom, count } => {
                write!(f, "cell {cell} names atom {atom}, and there are {count}")
            }
            Self::RepeatedAtom { cell, atom } => write!(f, "cell {cell} names atom {atom} twice"),
            Self::Inverted { cell, atoms } => {
                write!(f, "cell {cell} is turned inside out at the tetrahedron of atoms {atoms:?}")
            }
            Self::Flat { cell, atoms, quality } => write!(
                f,
                "the tetrahedron of atoms {atoms:?} in cell {cell} is flat: its quality is {quality:.2e}, and {LEAST_TETRAHEDRON_QUALITY} is the least"
            ),
            Self::CrowdedFace { face, count } => write!(f, "{count} tetrahedra share the face of atoms {face:?}"),
            Self::Pieces { count, atoms } => {
                let named: Vec<String> = atoms.iter().map(u32::to_string).collect();
                let more = if *count > atoms.len() { ", …" } else { "" };
                write!(f, "the body is in {count} pieces: atoms {}{more} belong to different ones", named.join(", "))
            }
        }
    }
}

impl SolidFault {
    /// The same of atoms that have other numbers where the body comes from.
    pub fn renumbered(self, number: impl Fn(u32) -> u32) -> Self {
        match self {
            Self::Empty => Self::Empty,
            Self::AtomOutOfRange { cell, atom, count } => Self::AtomOutOfRange { cell, atom, count },
            Self::RepeatedAtom { cell, atom } => Self::RepeatedAtom { cell, atom: number(atom) },
            Self::Inverted { cell, atoms } => Self::Inverted { cell, atoms: atoms.map(number) },
            Self::Flat { cell, atoms, quality } => Self::Flat { cell, atoms: atoms.map(number), quality },
            Self::CrowdedFace { face, count } => Self::CrowdedFace { face: face.map(number), count },
            Self::Pieces { count, atoms } => Self::Pieces { count, atoms: atoms.into_iter().map(number).collect() },
        }
    }

    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Empty => "give tetrahedra, pyramids, wedges or hexahedra",
            Self::AtomOutOfRange { .. } | Self::RepeatedAtom { .. } => "mend the cell, or leave it out",
            Self::Inverted { .. } => "order its atoms as VTK does: around the base, then those above in the same order",
            Self::Flat { .. } => "move its atoms apart, or mesh the body again",
            Self::CrowdedFace { .. } => "cells overlap there: leave the ones out that are there twice",
            Self::Pieces { .. } => "make each piece a type of its own, or join them",
        }
    }
}

/// Whether cells name atoms that exist, each once.
pub fn names(positions: &[Vec3], cells: &[SolidCell]) -> Result<(), Vec<SolidFault>> {
    if cells.is_empty() {
        return Err(vec![SolidFault::Empty]);
    }
    let mut faults = Vec::new();
    for (number, cell) in cells.iter().enumerate() {
        let atoms = cell.atoms();
        let unknown = atoms.iter().find(|&&atom| atom as usize >= positions.len());
        let twice = (1..atoms.len()).find(|&k| atoms[..k].contains(&atoms[k]));
        faults.extend(unknown.map(|&atom| SolidFault::AtomOutOfRange { cell: number, atom, count: positions.len() }));
        faults.extend(twice.map(|k| SolidFault::RepeatedAtom { cell: number, atom: atoms[k] }));
        if faults.len() >= TOLD {
            break;
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Tetrahedra, and where those of each cell begin.
type Cut = (Vec<[u32; 4]>, Vec<u32>);

/// Turns the tetrahedra of each cell so that their volume is positive, which is so for all or for none of a sound one. Returns them one
/// after the other, and where those of each cell begin.
pub fn turned(positions: &[Vec3], cells: Vec<Vec<[u32; 4]>>) -> Result<Cut, Vec<SolidFault>> {
    let (mut all, mut starts, mut faults) = (Vec::new(), vec![0], Vec::new());
    for (cell, own) in cells.into_iter().enumerate() {
        let corners = |atoms: [u32; 4]| atoms.map(|atom| positions[atom as usize]);
        let whole: f64 = own.iter().map(|&atoms| tetrahedron_volume(corners(atoms))).sum();
        for mut atoms in own {
            if whole < 0.0 {
                atoms.swap(2, 3);
            }
            let quality = quality(corners(atoms));
            if quality.is_nan() || quality.abs() < LEAST_TETRAHEDRON_QUALITY {
                faults.push(SolidFault::Flat { cell, atoms, quality });
            } else if quality < 0.0 {
                faults.push(SolidFault::Inverted { cell, atoms });
            }
            all.push(atoms);
        }
        starts.push(all.len() as u32);
        if faults.len() >= TOLD {
            break;
        }
    }
    if faults.is_empty() { Ok((all, starts)) } else { Err(faults) }
}

/// See [`LEAST_TETRAHEDRON_QUALITY`].
pub fn quality(corners: [Vec3; 4]) -> f64 {
    let mut squares = 0.0;
    for i in 0..4 {
        for j in 0..i {
            squares += (corners[i] - corners[j]).norm_squared();
        }
    }
    6.0 * std::f64::consts::SQRT_2 * tetrahedron_volume(corners) / (squares / 6.0).powf(1.5)
}

/// The faces that one tetrahedron alone has, seen from outside, in the order of their atoms.
pub fn outside(tetrahedra: &[[u32; 4]]) -> Result<Vec<[u32; 3]>, Vec<SolidFault>> {
    let known = count_faces(tetrahedra);
    let mut sorted: Vec<_> = known.iter().collect();
    sorted.sort_unstable_by_key(|(atoms, _)| **atoms);
    let crowded = sorted.iter().filter(|(_, face)| face.count > 2).take(TOLD);
    let faults: Vec<SolidFault> =
        crowded.map(|(atoms, face)| SolidFault::CrowdedFace { face: **atoms, count: face.count }).collect();
    if faults.is_empty() {
        Ok(sorted.iter().filter(|(_, face)| face.count == 1).map(|(_, face)| face.seen).collect())
    } else {
        Err(faults)
    }
}

/// Whether the body hangs together.
pub fn pieces(atoms: usize, tetrahedra: &[[u32; 4]]) -> Result<(), Vec<SolidFault>> {
    let mut parents: Vec<u32> = (0..atoms as u32).collect();
    for [first, others @ ..] in tetrahedra {
        for other in others {
            let (one, other) = (root(&mut parents, *first), root(&mut parents, *other));
            parents[one.max(other) as usize] = one.min(other);
        }
    }
    let mut roots: Vec<u32> = tetrahedra.iter().map(|atoms| root(&mut parents, atoms[0])).collect();
    roots.sort_unstable();
    roots.dedup();
    let count = roots.len();
    roots.truncate(TOLD);
    if count == 1 { Ok(()) } else { Err(vec![SolidFault::Pieces { count, atoms: roots }]) }
}
