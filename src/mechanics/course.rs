//! Values that change with time: linear between the points given, constant before the first and after the last.

use serde::{Deserialize, Serialize};

/// A course of a number in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// (time s, value), times rising.
    points: Vec<(f64, f64)>,
}

impl Course {
    /// The same value at all times.
    pub fn constant(value: f64) -> Self {
        Self { points: vec![(0.0, value)] }
    }

    /// Through the given points; `None` unless there is at least one and times rise strictly.
    pub fn through(points: Vec<(f64, f64)>) -> Option<Self> {
        let rising = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
        (rising && !points.is_empty()).then_some(Self { points })
    }

    /// The value at time `t`, s.
    pub fn at(&self, t: f64) -> f64 {
        let after = self.points.partition_point(|point| point.0 <= t);
        match (after.checked_sub(1).map(|i| self.points[i]), self.points.get(after)) {
            (None, Some(next)) => next.1,
            (Some(last), None) => last.1,
            (Some((t0, v0)), Some(&(t1, v1))) => v0 + (v1 - v0) * ((t - t0) / (t1 - t0)),
            (None, None) => 0.0,
        }
    }

    /// The times at which the course bends: a step must not run over them.
    pub fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        self.points.iter().map(|point| point.0).filter(|_| self.points.len() > 1)
    }

    /// Whether it is 0 from this instant to where it bends next, s.
    pub fn is_zero_from(&self, t: f64) -> bool {
        let next = self.points.iter().find(|point| point.0 > t);
        self.at(t) == 0.0 && next.is_none_or(|next| next.1 == 0.0)
    }

    /// The points.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_is_linear_between_its_points_and_constant_outside() {
        let course = Course::through(vec![(1.0, 0.0), (3.0, 8.0)]).unwrap();
        assert_eq!([0.0, 1.0, 1.5, 2.0, 3.0, 9.0].map(|t| course.at(t)), [0.0, 0.0, 2.0, 4.0, 8.0, 8.0]);
        assert!(Course::through(vec![(1.0, 0.0), (1.0, 8.0)]).is_none());
        let pulse = Course::through(vec![(1.0, 0.0), (2.0, 8.0), (3.0, 0.0), (4.0, 0.0), (5.0, 1.0)]).unwrap();
        let zero = [0.0, 0.9, 1.0, 1.5, 2.5, 3.0, 3.9, 4.0, 9.0].map(|t| pulse.is_zero_from(t));
        assert_eq!(zero, [true, true, false, false, false, true, true, false, false]);
    }
}
