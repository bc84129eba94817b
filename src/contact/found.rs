//! What detection finds: atoms on facets, edges on edges, atoms on obstacles.

use super::closest::Feature;
use super::scene::{Reach, Scene};
use crate::Vec3;
use serde::{Deserialize, Serialize};

/// Which side of a surface with two outsides an atom faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Facing {
    /// That to which the normals of the facets point.
    Front,
    /// The other.
    Back,
    /// Not told: the surface has one outside only, or the atom is beyond its rim.
    #[default]
    Any,
}

impl Facing {
    /// Whether this is the other side for sure.
    pub fn is_opposite(self, other: Self) -> bool {
        matches!((self, other), (Self::Front, Self::Back) | (Self::Back, Self::Front))
    }
}

/// A unit vector with four bytes an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal(pub [f32; 3]);

impl Normal {
    /// With eight.
    pub fn wide(self) -> Vec3 {
        Vec3::from(self.0.map(f64::from))
    }
}

impl From<Vec3> for Normal {
    fn from(normal: Vec3) -> Self {
        Self([normal.x as f32, normal.y as f32, normal.z as f32])
    }
}

impl std::ops::Neg for Normal {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|part| -part))
    }
}

/// An atom that touches a facet, or is inside the facet's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtomContact {
    /// The atom, numbered through the scene.
    pub atom: u32,
    /// The facet, numbered through the scene.
    pub facet: u32,
    /// Where on the facet the closest point lies. A point on a side or a corner is told once, for one of its facets.
    pub feature: Feature,
    /// Barycentric weights of the facet's second and third atom, to seven digits; see [`AtomContact::weights`].
    pub second_weights: [f32; 2],
    /// Distance along the normal, µm; negative inside.
    pub gap: f64,
    /// Unit normal from the facet to the outside, to seven digits: atom = closest point + gap × normal.
    pub normal: Normal,
    /// The side to which the normal points, where both are outside.
    pub facing: Facing,
}

impl AtomContact {
    /// The body of the facet; the atom's own in self-contact.
    pub fn body(&self, scene: &Scene) -> u32 {
        scene.body_of_facet(self.facet)
    }

    /// The barycentric weights of the closest point on the three atoms of the facet; their sum is 1.
    pub fn weights(&self) -> [f64; 3] {
        let [second, third] = self.second_weights.map(f64::from);
        [1.0 - second - third, second, third]
    }
}

/// Two edges that touch or have passed each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeContact {
    /// The two edges, numbered through the scene; the first has the smaller number.
    pub edges: [u32; 2],
    /// Where along each edge the closest points lie, from 0 at its first atom to 1, to seven digits.
    pub along: [f32; 2],
    /// Distance along the normal, µm; negative inside.
    pub gap: f64,
    /// Unit normal from the second edge to the first, to seven digits: point on first = point on second + gap × normal.
    pub normal: Normal,
}

impl EdgeContact {
    /// The bodies of the two edges; twice the same in self-contact.
    pub fn bodies(&self, scene: &Scene) -> [u32; 2] {
        self.edges.map(|edge| scene.body_of_edge(edge))
    }
}

/// An atom near a rigid obstacle or behind it, however far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObstacleContact {
    /// The atom, numbered through the scene.
    pub atom: u32,
    /// The obstacle, as numbered in the scene.
    pub obstacle: u32,
    /// Distance, µm; negative behind the obstacle.
    pub gap: f64,
    /// Unit normal of the obstacle there, towards the free side, to seven digits.
    pub normal: Normal,
}

/// All contacts, each list ordered by its first number, then its second.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contacts {
    /// Atoms on facets, ordered by atom, then facet.
    pub atoms: Vec<AtomContact>,
    /// Edges on edges, ordered by first edge, then second.
    pub edges: Vec<EdgeContact>,
    /// Atoms on obstacles, ordered by atom, then obstacle.
    pub obstacles: Vec<ObstacleContact>,
}

impl Contacts {
    /// The smallest gap, µm; infinite without contacts.
    pub fn smallest_gap(&self) -> f64 {
        let of_atoms = self.atoms.iter().map(|contact| contact.gap);
        let of_edges = self.edges.iter().map(|contact| contact.gap);
        let of_obstacles = self.obstacles.iter().map(|contact| contact.gap);
        of_atoms.chain(of_edges).chain(of_obstacles).fold(f64::INFINITY, f64::min)
    }

    /// Keeps those that touch.
    pub fn keep_touching(&mut self, reach: &Reach) {
        self.atoms.retain(|near| reach.touches(near.gap));
        self.edges.retain(|near| reach.touches(near.gap));
        self.obstacles.retain(|near| reach.touches(near.gap));
    }

    /// Forgets all contacts and keeps the memory.
    pub fn clear(&mut self) {
        self.atoms.clear();
        self.edges.clear();
        self.obstacles.clear();
    }

    /// Adds those of other bodies, behind these.
    pub(super) fn append(&mut self, others: &Self) {
        append(&mut self.atoms, &others.atoms);
        append(&mut self.edges, &others.edges);
        append(&mut self.obstacles, &others.obstacles);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of::<AtomContact>() * self.atoms.capacity()
            + size_of::<EdgeContact>() * self.edges.capacity()
            + size_of::<ObstacleContact>() * self.obstacles.capacity()
    }
}

/// Appends to a list that grows by a thirty-second where a `Vec` would double: contacts are most of the memory of a packed
/// population, and they hardly grow once it is packed.
#[inline]
pub(super) fn push<T>(list: &mut Vec<T>, item: T) {
    if list.len() == list.capacity() {
        list.reserve_exact((list.len() / 32).max(32));
    }
    list.push(item);
}

/// Appends a list to another as [`push`] does an item.
fn append<T: Copy>(list: &mut Vec<T>, items: &[T]) {
    if list.capacity() - list.len() < items.len() {
        list.reserve_exact(items.len() + list.len() / 32);
    }
    list.extend_from_slice(items);
}
