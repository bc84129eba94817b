//! Atoms that are moved on a course, whatever acts on them: a grip, or all of a tool, eq. (moved.1).

use super::course::Course;
use crate::Vec3;

/// Atoms of every cell of a kind that go along a direction on a course. Along the axes along which they are held nothing else moves them; the
/// direction is one of these.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Its name; the series are `displacement.<name>` and `force.<name>`.
    pub name: String,
    /// The atoms, rising.
    pub atoms: Vec<u32>,
    /// Unit direction.
    pub direction: Vec3,
    /// How far they are from where they began, µm; 0 at 0 s.
    pub displacement: Course,
}

impl Moved {
    /// How far atoms go from one time (s) to another, µm. A course is straight between its bends, over which no step runs.
    pub fn displaced(&self, [start, end]: [f64; 2]) -> Vec3 {
        (self.displacement.at(end) - self.displacement.at(start)) * self.direction
    }

    /// Whether they rest from this instant to where the course bends next, s.
    pub fn rests_from(&self, time: f64) -> bool {
        let next = self.displacement.points().iter().find(|point| point.0 > time);
        next.is_none_or(|next| next.1 == self.displacement.at(time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn atoms_go_as_far_as_the_course_and_rest_where_it_is_level() {
        let displacement = Course::through(vec![(1.0, 0.0), (3.0, 4.0), (5.0, 4.0), (6.0, 1.0)]);
        let displacement = displacement.expect("times rise");
        let moved = Moved { name: "grip".into(), atoms: vec![0], direction: -Vec3::y(), displacement };
        assert_eq!(moved.displaced([0.0, 2.0]), Vec3::new(0.0, -2.0, 0.0));
        assert_eq!(moved.displaced([5.0, 6.0]), Vec3::new(0.0, 3.0, 0.0));
        let rests = [0.0, 0.5, 1.0, 2.0, 3.0, 4.9, 5.0, 6.0, 9.0].map(|time| moved.rests_from(time));
        assert_eq!(rests, [true, true, false, false, true, true, false, true, true]);
    }
}
