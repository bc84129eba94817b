//! Whether cells of a type are inside those of others, as the more cohesive ones of a mixture come to be.

use super::declared::Declared;
use super::finished::Finished;
use crate::Vec3;
use crate::analysis::recording::POSITION;
use crate::error::{Error, Fault, Result};
use crate::output::{segregation, touching_cells};
use crate::values::When;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Whether cells of a type are inside those of others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Engulfment {
    /// The type of cells that is to be inside.
    #[schemars(extend("x-text" = "cell type"))]
    pub inner: String,
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// Which number.
    #[serde(default)]
    pub statistic: EngulfmentStatistic,
}

/// Which number of engulfment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum EngulfmentStatistic {
    /// How much nearer to the middle they are than the others, over what it would be if they were the innermost cells: 1 if they are, 0 at
    /// random, below 0 where they are outside.
    #[default]
    Order,
    /// The segregation index that the cells would have if those of the type were the innermost ones.
    Ceiling,
    /// The segregation index over that ceiling, eq. (analysis.42): 0 at random, 1 where cells of different types touch no more than if those of the type were the
    /// innermost ones.
    Relative,
}

impl Engulfment {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        if !at.records_contacts() {
            return;
        }
        if at.types().len() < 2 {
            let message = format!("`{}`: cells of one type have no others around them", at.path());
            at.fault("inner", "the only type", message, "add another type of cells");
        }
        at.when("time", self.time);
    }

    /// The number that is asked for, of the cells that touch another.
    ///
    /// # Errors
    /// When the run has no contacts or no such type, or when at that time no two cells touch or all that do are inner ones or none is.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let recording = run.recording;
        let Some(file) = run.file else {
            let fault = Fault::new("there is no file that says who touches whom");
            return Err(Error::input(fault.help("measure the result of a run")));
        };
        recording.cells_of(Some(&self.inner))?;
        let frame = recording.frame_at(self.time);
        let [x, y, z] = POSITION.map(|name| file.cell_values(name, frame));
        let (x, y, z) = (x?, y?, z?);
        let cells = file.cells(frame);
        let numbers: HashMap<u64, u32> = (0..).zip(&cells).map(|(number, cell)| (cell.id, number)).collect();
        let number = |id: u64| numbers.get(&id).copied();
        let pairs = file.pairs(frame)?;
        let pairs: Vec<[u32; 2]> =
            pairs.iter().filter_map(|pair| Some([number(pair.cell)?, number(pair.other)?])).collect();
        let is_inner = |cell: u32| recording.types[cells[cell as usize].kind as usize] == self.inner;
        let position = |cell: u32| Vec3::new(x[cell as usize], y[cell as usize], z[cell as usize]);
        let layers = Layers::of(&pairs, is_inner, position).ok_or_else(|| {
            let (time, inner) = (recording.times[frame], &self.inner);
            let message =
                format!("at {time} s the cells that touch another are not both of \"{inner}\" and of other types");
            Error::input(
                Fault::new(message).help("give a time at which cells of \"inner\" and of others touch some cell"),
            )
        })?;
        Ok(match self.statistic {
            EngulfmentStatistic::Order => layers.order(),
            EngulfmentStatistic::Ceiling => layers.ceiling(&pairs),
            EngulfmentStatistic::Relative => layers.segregation(&pairs) / layers.ceiling(&pairs),
        })
    }
}

/// The cells that touch another, from the middle outward.
struct Layers {
    /// Number, distance from the middle (µm) and whether it is an inner one, of each cell.
    cells: Vec<(u32, f64, bool)>,
    /// How many are inner ones.
    inner: usize,
}

impl Layers {
    /// None where all are inner ones or none is.
    fn of(pairs: &[[u32; 2]], is_inner: impl Fn(u32) -> bool, position: impl Fn(u32) -> Vec3) -> Option<Self> {
        let touching = touching_cells(pairs);
        let middle = touching.iter().map(|cell| position(*cell)).sum::<Vec3>() / touching.len().max(1) as f64;
        let of_cell = |cell: &u32| (*cell, (position(*cell) - middle).norm(), is_inner(*cell));
        let mut cells: Vec<_> = touching.iter().map(of_cell).collect();
        cells.sort_by(|one, other| one.1.total_cmp(&other.1).then(one.0.cmp(&other.0)));
        let inner = cells.iter().filter(|(.., inner)| *inner).count();
        (inner > 0 && inner < cells.len()).then_some(Self { cells, inner })
    }

    /// How much nearer to the middle some cells are than the others, µm.
    fn nearer(&self, is_inner: impl Fn(usize) -> bool) -> f64 {
        let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
        for (rank, (_, distance, _)) in self.cells.iter().enumerate() {
            let side = usize::from(is_inner(rank));
            sums[side] += distance;
            counts[side] += 1.0;
        }
        sums[0] / counts[0] - sums[1] / counts[1]
    }

    /// Eq. (analysis.37).
    fn order(&self) -> f64 {
        self.nearer(|rank| self.cells[rank].2) / self.nearer(|rank| rank < self.inner)
    }

    /// The segregation index of the pairs.
    fn segregation(&self, pairs: &[[u32; 2]]) -> f64 {
        self.segregation_if(pairs, |rank| self.cells[rank].2)
    }

    /// The segregation index of the same pairs if the inner ones were the innermost.
    fn ceiling(&self, pairs: &[[u32; 2]]) -> f64 {
        self.segregation_if(pairs, |rank| rank < self.inner)
    }

    fn segregation_if(&self, pairs: &[[u32; 2]], is_inner: impl Fn(usize) -> bool) -> f64 {
        let most = self.cells.iter().map(|(cell, ..)| *cell as usize).max().unwrap_or(0);
        let mut types = vec![1; most + 1];
        for (rank, (cell, ..)) in self.cells.iter().enumerate() {
            types[*cell as usize] = u32::from(!is_inner(rank));
        }
        segregation(&types, pairs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of nine cells that touch their neighbours, inner ones where it is said.
    fn row(inner: [u8; 9]) -> (Layers, Vec<[u32; 2]>) {
        let pairs: Vec<[u32; 2]> = (0..8).map(|cell| [cell, cell + 1]).collect();
        let position = |cell: u32| Vec3::new(f64::from(cell), 0.0, 0.0);
        (Layers::of(&pairs, |cell| inner[cell as usize] == 1, position).unwrap(), pairs)
    }

    #[test]
    fn order_is_one_inside_and_below_zero_outside() {
        let (inside, pairs) = row([0, 0, 0, 1, 1, 1, 0, 0, 0]);
        assert!((inside.order() - 1.0).abs() < 1e-15);
        // Distances 4 3 2 1 0 1 2 3 4: the outermost four are 3.5 from the middle in the mean, the other five 1.2.
        let (outside, _) = row([1, 1, 0, 0, 0, 0, 0, 1, 1]);
        assert!((outside.order() - (6.0 / 5.0 - 3.5) / (16.0 / 5.0 - 1.0)).abs() < 1e-15, "{}", outside.order());
        // Of eight pairs six are alike; of pairs dealt at random (3·2 + 6·5)/(9·8) = 1/2.
        assert!((inside.ceiling(&pairs) - (6.0 / 8.0 - 0.5) / 0.5).abs() < 1e-15);
    }

    #[test]
    fn segregation_is_told_relative_to_what_layers_would_have() {
        let (inside, pairs) = row([0, 0, 0, 1, 1, 1, 0, 0, 0]);
        assert_eq!(inside.segregation(&pairs).to_bits(), inside.ceiling(&pairs).to_bits());
        // Two pairs are of two types either way: one type need not be in the middle of the other to be as segregated.
        let (beside, _) = row([1, 1, 1, 1, 1, 0, 0, 0, 1]);
        assert!((beside.segregation(&pairs) / beside.ceiling(&pairs) - 1.0).abs() < 1e-15);
        // Every pair is.
        let (mixed, _) = row([1, 0, 1, 0, 1, 0, 1, 0, 1]);
        let random = (5.0 * 4.0 + 4.0 * 3.0) / (9.0 * 8.0);
        assert!((mixed.segregation(&pairs) + random / (1.0 - random)).abs() < 1e-15);
        assert!((mixed.ceiling(&pairs) - (6.0 / 8.0 - random) / (1.0 - random)).abs() < 1e-15);
    }

    #[test]
    fn without_inner_or_outer_cells_there_is_no_order() {
        let pairs = [[0, 1]];
        assert!(Layers::of(&pairs, |_| true, |_| Vec3::zeros()).is_none());
        assert!(Layers::of(&[], |_| true, |_| Vec3::zeros()).is_none());
    }
}
