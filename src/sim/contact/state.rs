//! What contacts carry from one step to the next.

use crate::contact::{Facing, Scene};
use serde::{Deserialize, Serialize};

/// An atom that touches a facet of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AtomBond {
    /// The atom, numbered through all cells.
    pub atom: u32,
    /// The facet, numbered through all cells.
    pub facet: u32,
    /// The side of it that the atom is on, where both are outside: it stays there.
    pub facing: Facing,
    /// Force on the atom, pN; the facet's atoms feel the opposite.
    pub force: [f32; 3],
    /// What went into its compliance and has not come back, pN·µm, eq. (adhesion.5).
    pub stored: f32,
}

impl AtomBond {
    /// The body of the facet.
    pub fn body(&self, scene: &Scene) -> u32 {
        scene.body_of_facet(self.facet)
    }
}

/// Two edges that touch and carry a force; they do not stick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EdgeBond {
    /// The edges, numbered through all cells.
    pub edges: [u32; 2],
    /// Unit normal from the second to the first.
    pub normal: [f32; 3],
    /// Force on the first, pN; the second feels the opposite.
    pub force: [f32; 3],
}

/// An atom that touches an obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ObstacleBond {
    /// The atom, numbered through all cells.
    pub atom: u32,
    /// The obstacle.
    pub obstacle: u32,
    /// Force on the atom, pN.
    pub force: [f32; 3],
    /// What went into its compliance and has not come back, pN·µm, eq. (adhesion.5).
    pub stored: f32,
}

/// Two facets of two cells, each atom of the one joined to an atom of the other, eq. (adhesion.11).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Link {
    /// The facets, numbered through all cells, the smaller first.
    pub facets: [u32; 2],
    /// Their bodies.
    pub bodies: [u32; 2],
    /// The pairs of atoms, numbered through all cells; the first of each belongs to the first facet.
    pub pairs: [[u32; 2]; 3],
}

/// What a part of a surface or an atom of it faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Faced {
    /// Another body.
    Body(u32),
    /// An obstacle.
    Obstacle(u32),
}

/// Bonds of a part of a surface to what it faces, eq. (adhesion.22).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SurfaceBonds {
    /// The facet, numbered through all cells.
    pub facet: u32,
    /// Which part of it: the number of its point.
    pub point: u32,
    /// What it faces.
    pub other: Faced,
    /// The share of its bonds that is closed.
    pub closed: f64,
}

/// An atom in an adhesive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AdhesiveAtom {
    /// The adhesive: the number of the least of its atoms.
    pub adhesive: u32,
    /// The atom, numbered through all cells.
    pub atom: u32,
    /// When it was cloned, s.
    pub since: f64,
    /// Force of the adhesive on it, pN; those of an adhesive have neither sum nor torque.
    pub force: [f64; 3],
}

/// All contacts that carry a force, in the order in which they are found, links, virtual adhesives and bonds of surfaces.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ContactState {
    /// Atoms on facets.
    pub atoms: Vec<AtomBond>,
    /// Edges on edges.
    pub edges: Vec<EdgeBond>,
    /// Atoms on obstacles.
    pub obstacles: Vec<ObstacleBond>,
    /// Links between facets, in their order; under other laws none.
    pub links: Vec<Link>,
    /// Atoms of virtual adhesives, adhesive by adhesive; under other laws none.
    pub adhesives: Vec<AdhesiveAtom>,
    /// Atoms that adhesives released and that still touch, in their order.
    pub released: Vec<u32>,
    /// Bonds of surfaces, in the order of facets; none where surfaces have no bonds that close and open.
    pub bonds: Vec<SurfaceBonds>,
}

/// How many there are of all that contacts name by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Numbered {
    /// Bodies.
    pub bodies: usize,
    /// Atoms of all bodies.
    pub atoms: usize,
    /// Facets of all bodies.
    pub facets: usize,
    /// Edges of all bodies.
    pub edges: usize,
    /// Planes.
    pub obstacles: usize,
}

impl ContactState {
    /// Whether all is there that contacts name: a state may come from a file.
    pub fn fits(&self, there: Numbered) -> bool {
        let are = |numbers: &[u32], most: usize| numbers.iter().all(|number| (*number as usize) < most);
        let is_faced = |other: Faced| match other {
            Faced::Body(body) => are(&[body], there.bodies),
            Faced::Obstacle(obstacle) => are(&[obstacle], there.obstacles),
        };
        let is_joined = |link: &Link| {
            are(&link.facets, there.facets)
                && are(&link.bodies, there.bodies)
                && are(link.pairs.as_flattened(), there.atoms)
        };
        self.atoms.iter().all(|bond| are(&[bond.atom], there.atoms) && are(&[bond.facet], there.facets))
            && self.edges.iter().all(|bond| are(&bond.edges, there.edges))
            && self
                .obstacles
                .iter()
                .all(|bond| are(&[bond.atom], there.atoms) && are(&[bond.obstacle], there.obstacles))
            && self.links.iter().all(is_joined)
            && self.adhesives.iter().all(|one| are(&[one.adhesive, one.atom], there.atoms))
            && are(&self.released, there.atoms)
            && self.bonds.iter().all(|bonds| are(&[bonds.facet], there.facets) && is_faced(bonds.other))
    }

    /// What went into the compliance of contacts and has not come back, pN·µm, eq. (adhesion.5): a part of the energy of cells that
    /// stick.
    pub fn stored(&self) -> f64 {
        let of_atoms = self.atoms.iter().map(|bond| f64::from(bond.stored));
        of_atoms.chain(self.obstacles.iter().map(|bond| f64::from(bond.stored))).sum()
    }
}
