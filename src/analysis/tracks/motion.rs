//! What one track is like: how fast, how straight, and how well along a cue.

use super::set::Tracks;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number that each track has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Quantity {
    /// Length of the path over its duration, µm/s.
    MeanSpeed,
    /// Distance from the first position to the last one over the length of the path, from 0 to 1.
    Directness,
    /// Mean angle between steps that follow each other, degrees from 0 to 180.
    TurningAngle,
    /// Length of the path, µm.
    PathLength,
    /// Distance from the first position to the last one, µm.
    NetDisplacement,
}

impl Quantity {
    /// What charts and tables call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::MeanSpeed => "mean speed",
            Self::Directness => "directness",
            Self::TurningAngle => "turning angle",
            Self::PathLength => "path length",
            Self::NetDisplacement => "net displacement",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::MeanSpeed => "um/s",
            Self::Directness => "1",
            Self::TurningAngle => "deg",
            Self::PathLength | Self::NetDisplacement => "um",
        }
    }

    /// Its value for each track; NaN where it is not defined.
    pub fn of(self, tracks: &Tracks) -> Vec<f64> {
        (0..tracks.number())
            .map(|track| match self {
                Self::TurningAngle => {
                    let angles = turning_angles(tracks, track);
                    angles.iter().sum::<f64>() / angles.len() as f64
                }
                _ => Motion::of(tracks, track).map_or(f64::NAN, |motion| match self {
                    Self::MeanSpeed => motion.mean_speed(),
                    Self::Directness => motion.directness(),
                    Self::PathLength => motion.path,
                    _ => norm(motion.net),
                }),
            })
            .collect()
    }

    /// Why no track has it.
    pub fn undefined(self) -> &'static str {
        match self {
            Self::MeanSpeed | Self::PathLength | Self::NetDisplacement => "no track has two positions or more",
            Self::Directness => "no cell moved",
            Self::TurningAngle => "no cell moved twice in a row",
        }
    }
}

/// Where cells are expected to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cue {
    /// Along this direction, of any length.
    Direction([f64; 3]),
    /// To this point, µm.
    Point([f64; 3]),
}

/// A path as a whole. Frames in which the cell was not found are passed over: the path leads straight across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Time from the first position to the last, s.
    pub duration: f64,
    /// Length of the path through all positions, µm.
    pub path: f64,
    /// The first position, µm.
    pub start: [f64; 3],
    /// From the first position to the last, µm.
    pub net: [f64; 3],
}

impl Motion {
    /// The path of a track; none with fewer than two positions.
    pub fn of(tracks: &Tracks, track: usize) -> Option<Self> {
        let mut frames = tracks.frames_of(track);
        let first = frames.next()?;
        let start = tracks.position(first, track);
        let (mut last, mut end, mut path) = (first, start, 0.0);
        for frame in frames {
            let position = tracks.position(frame, track);
            path += norm(minus(position, end));
            (last, end) = (frame, position);
        }
        let duration = tracks.times[last] - tracks.times[first];
        (last > first).then(|| Self { duration, path, start, net: minus(end, start) })
    }

    /// Length of the path over its duration, eq. (analysis.20), µm/s.
    pub fn mean_speed(&self) -> f64 {
        self.path / self.duration
    }

    /// Net displacement over length of the path, eq. (analysis.21); NaN for a cell that never moved.
    pub fn directness(&self) -> f64 {
        // Round-off must not make a straight line more than straight.
        if self.path > 0.0 { (norm(self.net) / self.path).min(1.0) } else { f64::NAN }
    }

    /// Forward migration indices parallel and perpendicular to a cue, eq. (analysis.22). In the plane the perpendicular one is positive to the left of the cue; in
    /// space it is the length across. NaN for a cell that never moved, or that starts at the point of the cue.
    pub fn forward_indices(&self, cue: Cue, axes: usize) -> [f64; 2] {
        let mut along = match cue {
            Cue::Direction(direction) => direction,
            Cue::Point(point) => minus(point, self.start),
        };
        (axes..3).for_each(|axis| along[axis] = 0.0);
        let length = norm(along);
        if self.path == 0.0 || length == 0.0 {
            return [f64::NAN; 2];
        }
        let parallel = dot(self.net, along) / length;
        let across = match axes {
            2 => (along[0] * self.net[1] - along[1] * self.net[0]) / length,
            _ => (dot(self.net, self.net) - parallel * parallel).max(0.0).sqrt(),
        };
        [parallel / self.path, across / self.path]
    }

    /// The direction of the net displacement in the plane x, y, radians from x towards y; NaN for a cell that ends where it began.
    pub fn direction(&self) -> f64 {
        if self.net[0] == 0.0 && self.net[1] == 0.0 { f64::NAN } else { self.net[1].atan2(self.net[0]) }
    }
}

/// The angles between steps that follow each other, degrees from 0 to 180, eq. (analysis.23). Steps of no length and over frames in which the cell was not found have none.
pub fn turning_angles(tracks: &Tracks, track: usize) -> Vec<f64> {
    let step = |frame: usize| minus(tracks.position(frame + 1, track), tracks.position(frame, track));
    let steps: Vec<[f64; 3]> = (0..tracks.times.len().saturating_sub(1)).map(step).collect();
    let angle = |pair: &[[f64; 3]]| {
        let (one, other) = (pair[0], pair[1]);
        let across = [
            one[1] * other[2] - one[2] * other[1],
            one[2] * other[0] - one[0] * other[2],
            one[0] * other[1] - one[1] * other[0],
        ];
        // Exact for small and for straight angles, where the arc cosine is not.
        let angle = norm(across).atan2(dot(one, other)).to_degrees();
        (norm(one) > 0.0 && norm(other) > 0.0).then_some(angle)
    };
    steps.windows(2).filter_map(angle).collect()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array3;

    fn tracks(positions: &[&[[f64; 2]]]) -> Tracks {
        let frames = positions.iter().map(|track| track.len()).max().unwrap();
        let at =
            |(frame, track, axis): (usize, usize, usize)| positions[track].get(frame).map_or(f64::NAN, |p| p[axis]);
        Tracks {
            times: (0..frames).map(|frame| 2.0 * frame as f64).collect(),
            names: (0..positions.len()).map(|track| track.to_string()).collect(),
            types: vec![String::new(); positions.len()],
            positions: Array3::from_shape_fn((frames, positions.len(), 2), at),
        }
    }

    #[test]
    fn an_angle_of_two_steps_has_the_numbers_of_its_triangle() {
        // 3 µm along x, then 4 µm along y: a path of 7, a net displacement of 5.
        let tracks = tracks(&[&[[1.0, 1.0], [4.0, 1.0], [4.0, 5.0]], &[[0.0, 0.0]; 3]]);
        let of = |quantity: Quantity| quantity.of(&tracks);
        assert_eq!(of(Quantity::PathLength), [7.0, 0.0]);
        assert_eq!(of(Quantity::NetDisplacement), [5.0, 0.0]);
        assert_eq!(of(Quantity::MeanSpeed), [7.0 / 4.0, 0.0]);
        assert_eq!(of(Quantity::Directness)[0], 5.0 / 7.0);
        assert_eq!(of(Quantity::TurningAngle)[0], 90.0);
        assert!(of(Quantity::Directness)[1].is_nan() && of(Quantity::TurningAngle)[1].is_nan());
        let motion = Motion::of(&tracks, 0).unwrap();
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() < 1e-15 && (b - d).abs() < 1e-15;
        assert!(near(motion.forward_indices(Cue::Direction([2.0, 0.0, 9.0]), 2), [3.0 / 7.0, 4.0 / 7.0]));
        assert!(near(motion.forward_indices(Cue::Direction([0.0, 1.0, 0.0]), 2), [4.0 / 7.0, -3.0 / 7.0]));
        assert!(near(motion.forward_indices(Cue::Direction([0.0, 1.0, 0.0]), 3), [4.0 / 7.0, 3.0 / 7.0]));
        assert!(near(motion.forward_indices(Cue::Point([1.0, 9.0, 0.0]), 2), [4.0 / 7.0, -3.0 / 7.0]));
        assert!(motion.forward_indices(Cue::Point([1.0, 1.0, 5.0]), 2)[0].is_nan());
        assert!((motion.direction() - (4.0_f64).atan2(3.0)).abs() < 1e-15);
        assert!(Motion::of(&tracks, 1).unwrap().direction().is_nan());
    }

    #[test]
    fn paths_lead_across_frames_without_the_cell_and_turns_do_not() {
        let mut tracks = tracks(&[&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]]]);
        tracks.positions.slice_mut(ndarray::s![2, 0, ..]).fill(f64::NAN);
        let motion = Motion::of(&tracks, 0).unwrap();
        assert!((motion.path - (2.0 + 2.0_f64.sqrt())).abs() < 1e-15 && motion.duration == 8.0);
        assert!(turning_angles(&tracks, 0).is_empty());
        tracks.positions.fill(f64::NAN);
        assert!(Motion::of(&tracks, 0).is_none() && Quantity::MeanSpeed.of(&tracks)[0].is_nan());
    }
}
