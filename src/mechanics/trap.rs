//! A trap: a spring from the centre of a rigid body to a point that may go on a course, eq. (rigid.3).

use super::course::Course;
use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::moved::Translation;
use crate::Vec3;

/// A spring that draws the centre of every body of a kind to a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Trap {
    /// Its name; the series are `trap_x.<name>` and its like.
    pub name: String,
    /// Force over distance, pN/µm.
    pub stiffness: f64,
    /// Where the point is at 0 s, µm.
    pub at: Vec3,
    /// How it goes from there; none where it rests.
    pub translation: Option<Translation>,
}

impl Trap {
    /// How the point goes, if it does.
    pub fn course(&self) -> Option<&Course> {
        self.translation.as_ref().map(|line| &line.displacement)
    }

    /// How far the point has gone at a time (s), µm.
    pub(super) fn gone(&self, time: f64) -> f64 {
        self.course().map_or(0.0, |course| course.at(time))
    }

    /// The force on a body whose centre is at `centre` (µm) at a time (s), pN.
    pub fn force(&self, time: f64, centre: Vec3) -> Vec3 {
        let gone = self.translation.as_ref().map_or(Vec3::zeros(), |line| self.gone(time) * line.direction);
        self.stiffness * (self.at + gone - centre)
    }

    /// Adds the force on every atom where the point has `gone` so far (µm), an equal share for each, and returns the energy of the spring,
    /// pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, gone: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let token = x.token;
        let along = self.translation.as_ref().map_or(Vec3::zeros(), |line| line.direction);
        let atoms = x.atoms();
        let mut centre = V3::zero(token);
        (0..atoms).for_each(|atom| centre += x.get(atom));
        let centre = centre.scaled(1.0 / atoms as f64);
        let point = V3 { x: gone * along.x + self.at.x, y: gone * along.y + self.at.y, z: gone * along.z + self.at.z };
        let apart = point - centre;
        let share = apart.scaled(self.stiffness / atoms as f64);
        (0..atoms).for_each(|atom| f.add(atom, share));
        apart.squared() * (0.5 * self.stiffness)
    }
}
