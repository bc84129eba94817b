//! How far apart the cells of two types are.

use super::declared::Declared;
use super::reduction::Reduction;
use crate::analysis::over::Over;
use crate::analysis::recording::{POSITION, Recording};
use crate::error::words;
use crate::error::{Error, Fault, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far the centres of volume of the cells of two types are apart, whatever way they turn round each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Distance {
    /// The types; the same one twice for its cells among themselves.
    pub between: [String; 2],
    /// How the distances of several pairs of cells become one.
    #[serde(default)]
    pub over: Over,
    /// The instant, or how the values at several instants become one.
    #[serde(default)]
    pub time: Reduction,
}

impl Distance {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        self.time.check(at);
        for (side, name) in self.between.iter().enumerate() {
            let types = at.types();
            if types.contains(&name.as_str()) {
                continue;
            }
            let path = at.path().to_owned();
            let message = format!("`{path}.between[{side}]`: there is no type of cells \"{name}\"");
            let help = format!("types of cells here are {}", words::all_of(types.into_iter()));
            at.fault(&format!("between[{side}]"), "unknown type", message, &help);
        }
    }

    /// The distance, µm.
    ///
    /// # Errors
    /// When there is no such type or time, or no pair of cells.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let [one, other] = &self.between;
        let (ones, others) = (recording.cells_of(Some(one))?, recording.cells_of(Some(other))?);
        let pairs: Vec<(usize, usize)> = ones
            .iter()
            .flat_map(|&a| others.iter().map(move |&b| (a, b)))
            // Each pair of one type once.
            .filter(|(a, b)| if one == other { a < b } else { true })
            .collect();
        if pairs.is_empty() {
            let fault =
                Fault::new(format!("there is one cell of the type \"{one}\", which is at no distance from itself"));
            return Err(Error::input(fault.help("name another type, or one that has more cells")));
        }
        let all: Vec<usize> = (0..recording.cell_types.len()).collect();
        let x = recording.positions(&all)?;
        let of_frame = |frame: usize| {
            let there = pairs.iter().filter(|(a, b)| recording.is_there(frame, *a) && recording.is_there(frame, *b));
            let apart = |&(a, b): &(usize, usize)| {
                (0..3).map(|k| (x[[frame, a, k]] - x[[frame, b, k]]).powi(2)).sum::<f64>().sqrt()
            };
            self.over.reduce(&there.map(apart).collect::<Vec<_>>())
        };
        let distances: Vec<f64> = (0..recording.times.len()).map(of_frame).collect();
        self.time.reduce(&recording.times, &distances)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::evaluate;
    use ndarray::Array2;
    use std::collections::BTreeMap;

    fn measure(between: [&str; 2], over: Over, time: Reduction) -> MeasureKind {
        MeasureKind::Distance(Distance { between: between.map(str::to_owned), over, time })
    }

    #[test]
    fn distances_of_pairs_are_made_one() {
        // A red cell and two white ones, which then come nearer.
        let along = |numbers: [f64; 6]| Array2::from_shape_vec((2, 3), numbers.to_vec()).unwrap();
        let recording = Recording {
            times: vec![0.0, 1.0],
            types: vec!["red".to_owned(), "white".to_owned()],
            cell_types: vec![0, 1, 1],
            cells: BTreeMap::from([
                ("position_x".to_owned(), along([0.0, 3.0, 0.0, 1.0, 1.0, 1.0])),
                ("position_y".to_owned(), along([0.0, 4.0, 0.0, 0.0, 2.0, 0.0])),
                ("position_z".to_owned(), along([0.0, 0.0, 12.0, 0.0, 0.0, 4.0])),
            ]),
            ..Recording::default()
        };
        let found = |between, over, time| evaluate(&measure(between, over, time), &recording).unwrap();
        assert_eq!(found(["red", "white"], Over::Min, Reduction::First), 5.0);
        assert_eq!(found(["white", "red"], Over::Mean, Reduction::First), 8.5);
        assert_eq!(found(["white", "white"], Over::Mean, Reduction::First), 13.0);
        assert_eq!(found(["red", "white"], Over::Max, Reduction::Last), 4.0);
        assert_eq!(found(["red", "white"], Over::Min, Reduction::Mean), 3.5);
        let alone = evaluate(&measure(["red", "red"], Over::Mean, Reduction::Last), &recording).unwrap_err();
        assert_eq!(alone.to_string(), "there is one cell of the type \"red\", which is at no distance from itself");
    }
}
