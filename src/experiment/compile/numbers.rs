//! Numbers of a document as the model has them.

use crate::Vec3;
use crate::mechanics::course::Course;

/// Three numbers as a vector.
pub fn vector(components: [f64; 3]) -> Vec3 {
    Vec3::from(components)
}

/// The unit vector along a direction; the document's checks have refused the null vector.
pub fn unit(direction: [f64; 3]) -> Vec3 {
    vector(direction).normalize()
}

/// A course through points; the document's checks have made sure that times rise.
pub fn course(points: Vec<(f64, f64)>) -> Course {
    Course::through(points).unwrap_or_else(|| Course::constant(0.0))
}
