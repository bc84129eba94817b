//! What cells cannot pass, as an exact surface: planes, and bodies of revolution whose profile has straight sides and arcs.

use std::sync::Arc;

use super::turned::{Beside, Turned};
use crate::Vec3;

/// A rigid surface that no atom passes.
#[derive(Debug, Clone, PartialEq)]
pub enum Obstacle {
    /// The half space that the normal of a plane points into is free.
    Plane {
        /// A point of the plane, µm.
        point: Vec3,
        /// Unit normal towards the free side.
        normal: Vec3,
    },
    /// All that is outside of a body of revolution is free.
    Turned(Arc<Turned>),
}

impl Obstacle {
    /// Where a point (µm) is beside it.
    #[inline]
    pub fn beside(&self, x: &Vec3) -> Beside {
        match self {
            Self::Plane { point, normal } => Beside { gap: (x - point).dot(normal), normal: *normal },
            Self::Turned(body) => body.beside(x),
        }
    }

    /// Distance of a point from its surface, µm; negative within.
    #[inline]
    pub fn gap(&self, x: &Vec3) -> f64 {
        self.beside(x).gap
    }

    /// Its normal where a point is nearest to it.
    #[inline]
    pub fn normal(&self, x: &Vec3) -> Vec3 {
        self.beside(x).normal
    }

    /// How far something that is displaced (µm) from a point comes nearer to it.
    #[inline]
    pub fn approach(&self, start: &Vec3, displacement: &Vec3) -> f64 {
        match self {
            Self::Plane { normal, .. } => -displacement.dot(normal),
            Self::Turned(body) => body.beside(start).gap - body.beside(&(start + displacement)).gap,
        }
    }

    /// The unit normal of a plane; none of what is curved.
    pub fn as_plane(&self) -> Option<Vec3> {
        match self {
            Self::Plane { normal, .. } => Some(*normal),
            Self::Turned(_) => None,
        }
    }
}
