//! What of the area in contact belongs to each atom, by what it faces: contacts of atoms bear shear by it, and friction acts on it.

use super::closed::PatchBonds;
use super::patch::{Partner, Patch};
use crate::Vec3;
use crate::contact::Scene;
pub use crate::sim::contact::state::Faced;

/// The area in contact around an atom with one of what it faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facing {
    /// The atom.
    pub atom: u32,
    /// What it faces.
    pub other: Faced,
    /// What of the area in contact is nearest to it, µm²; where surfaces have bonds, what of it is bound.
    pub area: f64,
    /// The atoms of a facet of the other body before the part of that area that weighs most, in the order in which its normal points to
    /// the atom; of an obstacle the atom itself.
    pub facet: [u32; 3],
    /// What that part weighs, µm².
    most: f64,
}

impl Facing {
    /// Adds those of the parts of surfaces of a batch of bodies, with their bonds as far as they have some, in the order of atoms.
    pub(super) fn add(
        (patches, bonds): (&[Patch], &[PatchBonds]),
        scene: &Scene,
        positions: &[Vec3],
        to: &mut Vec<Self>,
    ) {
        for (number, patch) in patches.iter().enumerate() {
            let closed = bonds.get(number).map_or(1.0, PatchBonds::closed);
            let area = closed * patch.area_in_contact(scene, positions);
            if area <= 0.0 {
                continue;
            }
            let other = patch.faces(scene);
            // Parts of one facet follow each other: most are added to what stands last.
            let last = to.len().saturating_sub(3);
            if !(to.len() >= 3 && (0..3).all(|i| (to[last + i].atom, to[last + i].other) == (patch.own[i], other))) {
                to.extend(patch.own.map(|atom| Self { atom, other, area: 0.0, facet: [atom; 3], most: 0.0 }));
            }
            let last = to.len() - 3;
            for (this, weight) in to[last..].iter_mut().zip(patch.weights) {
                let part = weight * area;
                this.area += part;
                if part > this.most
                    && let Partner::Facet(facet, _) = patch.other
                {
                    (this.most, this.facet) = (part, facet);
                }
            }
        }
        // All of one atom and what it faces become one, in the order in which they were found.
        to.sort_unstable_by(|one, other| {
            let keys = [one, other].map(|this| (this.atom, this.other, this.facet));
            keys[0].cmp(&keys[1]).then(one.most.total_cmp(&other.most))
        });
        to.dedup_by(|next, kept| {
            let is_same = (next.atom, next.other) == (kept.atom, kept.other);
            if is_same {
                kept.area += next.area;
                if next.most > kept.most {
                    (kept.most, kept.facet) = (next.most, next.facet);
                }
            }
            is_same
        });
    }
}

/// Which of these is that of an atom and what it faces.
pub fn number_of(facing: &[Facing], atom: u32, other: Faced) -> Option<usize> {
    facing.binary_search_by_key(&(atom, other), |known| (known.atom, known.other)).ok()
}

/// The area in contact between an atom and what it faces, µm².
pub fn area_between(facing: &[Facing], atom: u32, other: Faced) -> f64 {
    number_of(facing, atom, other).map_or(0.0, |number| facing[number].area)
}
