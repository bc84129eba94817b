//! Small recordings made by hand, and walks, on which measures are tested.

use super::{Finished, MeasureKind};
use crate::analysis::noise;
use crate::analysis::recording::Recording;
use crate::error::Result;
use ndarray::Array2;
use std::collections::BTreeMap;
use std::path::Path;

/// Three frames of a red and two white cells under a growing load.
pub fn pulled() -> Recording {
    let sizes = Array2::from_shape_vec((3, 3), vec![8.0, 4.0, 6.0, 9.0, 4.5, 6.5, 10.0, 5.0, 9.0]).unwrap();
    Recording {
        times: vec![0.0, 1.0, 3.0],
        types: vec!["red".to_owned(), "white".to_owned()],
        cell_types: vec![0, 1, 1],
        cells: BTreeMap::from([("size_x".to_owned(), sizes)]),
        scene: BTreeMap::from([("load.pull".to_owned(), vec![0.0, 10.0, 20.0])]),
        ..Recording::default()
    }
}

/// Evaluates with paths that can be opened as they are.
pub fn evaluate(kind: &MeasureKind, recording: &Recording) -> Result<f64> {
    kind.evaluate(&Finished { recording, file: None, resolve: &Path::to_path_buf })
}

/// Persistence of the walkers below, s, and the number of frames, four of which fill it.
pub const PERSISTENCE: f64 = 20.0;
pub const FRAMES: usize = 81;

/// Walkers of speed 1 in the plane; written anew so that measures are tested without the motility they measure.
pub fn walkers(number: u32) -> Recording {
    let times: Vec<f64> = (0..FRAMES).map(|frame| frame as f64 * PERSISTENCE / 4.0).collect();
    let shape = (FRAMES, number as usize);
    let (mut x, mut y, z) = (Array2::zeros(shape), Array2::zeros(shape), Array2::zeros(shape));
    let mut runs = Vec::new();
    for cell in 0..number {
        let mut uniform = noise::uniform(1 + u64::from(cell));
        let (mut begin, mut position, mut frame) = (0.0, [0.0, 0.0], 0);
        while frame < FRAMES {
            let duration = -PERSISTENCE * (-uniform()).ln_1p();
            let (sine, cosine) = (std::f64::consts::TAU * uniform()).sin_cos();
            while frame < FRAMES && times[frame] <= begin + duration {
                x[[frame, cell as usize]] = position[0] + cosine * (times[frame] - begin);
                y[[frame, cell as usize]] = position[1] + sine * (times[frame] - begin);
                frame += 1;
            }
            position = [position[0] + cosine * duration, position[1] + sine * duration];
            begin += duration;
            if begin <= times[FRAMES - 1] {
                runs.push((cell as usize, begin, duration));
            }
        }
    }
    let cells =
        [("position_x", x), ("position_y", y), ("position_z", z)].map(|(name, series)| (name.to_owned(), series));
    Recording {
        times,
        types: vec!["amoeba".to_owned()],
        cell_types: vec![0; number as usize],
        cells: BTreeMap::from(cells),
        runs,
        ..Recording::default()
    }
}
