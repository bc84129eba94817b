//! Where a new pseudopod goes: off the last one at an angle, to one side or the other, or anywhere.

use super::motility::Space;
use crate::Vec3;
use crate::random::Stream;

/// Where a new pseudopod goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// Share of pseudopods that split off from the last.
    pub split: f64,
    /// Angle between such a one and the last, rad.
    pub angle: f64,
    /// Standard deviation of that angle, rad.
    pub spread: f64,
    /// Share of those that go to the other side than the last did.
    pub alternation: f64,
    /// Where directions may point.
    pub space: Space,
}

impl Turning {
    /// One direction that a new pseudopod may take, and to which side of the last that is.
    pub fn draw(&self, last: &Vec3, side: i8, stream: &mut Stream) -> (Vec3, i8) {
        let [[splits, turns], [angle, height], [radius, phase]] = [(); 3].map(|()| stream.uniform_pair());
        if splits >= self.split {
            return (anywhere(self.space, angle, height), 0);
        }
        let other = if side == 0 { if angle < 0.5 { 1 } else { -1 } } else { -side };
        let side = if turns < self.alternation { other } else { -other };
        let normal = (-2.0 * (1.0 - radius).ln()).sqrt() * (std::f64::consts::TAU * phase).cos();
        let (sine, cosine) = (self.angle + self.spread * normal).sin_cos();
        let across = match self.space {
            Space::Plane => f64::from(side) * Vec3::new(-last.y, last.x, 0.0),
            Space::Volume => {
                let any = if last.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
                let one = last.cross(&any).normalize();
                let (sine, cosine) = (std::f64::consts::TAU * height).sin_cos();
                cosine * one + sine * last.cross(&one)
            }
        };
        ((cosine * last + sine * across).normalize(), side)
    }
}

/// A direction by two numbers uniform in [0, 1).
pub fn anywhere(space: Space, angle: f64, height: f64) -> Vec3 {
    let (sine, cosine) = (std::f64::consts::TAU * angle).sin_cos();
    match space {
        Space::Plane => Vec3::new(cosine, sine, 0.0),
        Space::Volume => {
            let z = 2.0 * height - 1.0;
            let across = (1.0 - z * z).sqrt();
            Vec3::new(across * cosine, across * sine, z)
        }
    }
}
