//! What cells cannot pass.

use crate::Vec3;
use crate::geometry::{self, Beside};
use crate::mechanics::course::Course;

/// A rigid surface that no atom passes, with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Name for pictures and messages.
    pub name: String,
    /// The surface, where it is at first.
    pub surface: geometry::Obstacle,
    /// How it goes; none where it stands.
    pub going: Option<Going>,
}

/// An obstacle that goes along a direction on a course.
#[derive(Debug, Clone, PartialEq)]
pub struct Going {
    /// Unit direction.
    pub direction: Vec3,
    /// How far it is, µm.
    pub displacement: Course,
}

impl Obstacle {
    /// A plane through a point (µm), with its unit normal towards the free side.
    pub fn plane(name: &str, point: Vec3, normal: Vec3) -> Self {
        Self { name: name.to_owned(), surface: geometry::Obstacle::Plane { point, normal }, going: None }
    }

    /// Where a point (µm) is beside it at a time, s.
    #[inline]
    pub fn beside(&self, time: f64, x: &Vec3) -> Beside {
        match &self.going {
            None => self.surface.beside(x),
            Some(_) => self.surface.beside(&(x - self.gone(time))),
        }
    }

    /// How far it has gone at a time (s), µm.
    pub fn gone(&self, time: f64) -> Vec3 {
        self.going.as_ref().map_or(Vec3::zeros(), |going| going.displacement.at(time) * going.direction)
    }

    /// Whether only atoms can be deepest in it, and no point between them.
    pub fn is_flat(&self) -> bool {
        self.surface.as_plane().is_some()
    }
}
