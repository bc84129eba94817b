//! Atoms that are moved on a course, whatever acts on them: a grip, or all of a tool, eq. (moved.1) and (moved.3).

use super::course::Course;
use crate::Vec3;
use nalgebra::{Rotation3, Unit};

/// Atoms of every cell of a kind that go along a direction and turn about an axis on courses. Along the axes along which they are held nothing
/// else moves them; the direction is one of these, and what turns is held along all.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Its name, as in the names of its series.
    pub name: String,
    /// The atoms, rising.
    pub atoms: Vec<u32>,
    /// How they go; none where they only turn.
    pub translation: Option<Translation>,
    /// How they turn; none where they only go.
    pub rotation: Option<Rotation>,
}

/// A motion along a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Translation {
    /// Unit direction.
    pub direction: Vec3,
    /// How far atoms are from where they began, µm; 0 at 0 s.
    pub displacement: Course,
}

/// A turn about an axis, which goes where the atoms go.
#[derive(Debug, Clone, PartialEq)]
pub struct Rotation {
    /// Unit vector along the axis.
    pub axis: Unit<Vec3>,
    /// A point of the axis at 0 s, µm.
    pub through: Vec3,
    /// By how much they have turned, rad; 0 at 0 s.
    pub angle: Course,
}

impl Moved {
    /// How far they have gone at a time (s), µm.
    pub fn gone(&self, time: f64) -> Vec3 {
        self.translation.as_ref().map_or(Vec3::zeros(), |line| line.displacement.at(time) * line.direction)
    }

    /// A point of the axis at a time (s), µm; the origin where nothing turns.
    pub fn centre(&self, time: f64) -> Vec3 {
        self.rotation.as_ref().map_or(Vec3::zeros(), |turn| turn.through + self.gone(time))
    }

    /// How an atom that is at `from` (µm) at one time (s) goes to another time, µm. A course is straight between its bends, over which no step
    /// runs.
    pub fn displaced(&self, [start, end]: [f64; 2]) -> impl Fn(Vec3) -> Vec3 {
        let gone = self.gone(end) - self.gone(start);
        let turned = self.rotation.as_ref().map(|turn| {
            let angle = turn.angle.at(end) - turn.angle.at(start);
            (
                Rotation3::from_axis_angle(&turn.axis, angle).into_inner() - nalgebra::Matrix3::identity(),
                self.centre(start),
            )
        });
        move |from| turned.map_or(gone, |(turn, centre)| gone + turn * (from - centre))
    }

    /// Whether they rest from this instant to where a course bends next, s.
    pub fn rests_from(&self, time: f64) -> bool {
        self.courses().all(|course| {
            let next = course.points().iter().find(|point| point.0 > time);
            next.is_none_or(|next| next.1 == course.at(time))
        })
    }

    /// Their courses.
    pub fn courses(&self) -> impl Iterator<Item = &Course> {
        let translation = self.translation.iter().map(|line| &line.displacement);
        translation.chain(self.rotation.iter().map(|turn| &turn.angle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(points: &[(f64, f64)]) -> Course {
        Course::through(points.to_vec()).expect("times rise")
    }

    #[test]
    fn atoms_go_as_far_as_the_course_and_rest_where_it_is_level() {
        let displacement = course(&[(1.0, 0.0), (3.0, 4.0), (5.0, 4.0), (6.0, 1.0)]);
        let translation = Some(Translation { direction: -Vec3::y(), displacement });
        let moved = Moved { name: "grip".into(), atoms: vec![0], translation, rotation: None };
        assert_eq!(moved.displaced([0.0, 2.0])(Vec3::x()), Vec3::new(0.0, -2.0, 0.0));
        assert_eq!(moved.displaced([5.0, 6.0])(Vec3::x()), Vec3::new(0.0, 3.0, 0.0));
        let rests = [0.0, 0.5, 1.0, 2.0, 3.0, 4.9, 5.0, 6.0, 9.0].map(|time| moved.rests_from(time));
        assert_eq!(rests, [true, true, false, false, true, true, false, true, true]);
    }

    #[test]
    fn atoms_turn_about_an_axis_that_goes_with_them() {
        let translation = Some(Translation { direction: Vec3::x(), displacement: course(&[(0.0, 0.0), (2.0, 6.0)]) });
        let angle = course(&[(0.0, 0.0), (2.0, std::f64::consts::PI)]);
        let rotation = Some(Rotation { axis: Vec3::z_axis(), through: Vec3::y(), angle });
        let moved = Moved { name: "tool".into(), atoms: vec![0], translation, rotation };
        // Half a turn about (0, 1, ·), which goes to (6, 1, ·).
        let start = Vec3::new(2.0, 1.0, 5.0);
        let end = start + moved.displaced([0.0, 2.0])(start);
        assert!((end - Vec3::new(4.0, 1.0, 5.0)).norm() < 1e-14, "{end}");
        let middle = start + moved.displaced([0.0, 1.0])(start);
        assert!((middle - Vec3::new(3.0, 3.0, 5.0)).norm() < 1e-14, "{middle}");
        let back = middle + moved.displaced([1.0, 0.0])(middle);
        assert!((back - start).norm() < 1e-14, "{back}");
        assert!(!moved.rests_from(1.0) && moved.rests_from(2.0));
    }
}
