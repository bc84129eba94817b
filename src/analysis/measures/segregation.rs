//! Whether cells of a type seek each other: the segregation index, and what it would be if types were dealt at random.

use super::declared::Declared;
use super::finished::Finished;
use crate::analysis::statistics;
use crate::error::{Error, Fault, Result, words};
use crate::output::{Alike, count_alike, touching_cells};
use crate::random::{Purpose, Stream};
use crate::values::{OneOrMany, When};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How much cells of a type touch each other beyond chance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Segregation {
    /// The types of cells, two or more; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<OneOrMany<String>>,
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// How often the types are dealt anew to the cells that touch another.
    #[serde(default = "permutations")]
    #[schemars(range(min = 1, max = 1_000_000))]
    pub permutations: u32,
    /// Which number.
    #[serde(default)]
    pub statistic: SegregationStatistic,
}

fn permutations() -> u32 {
    1000
}

/// Which number of the segregation index and its permutations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum SegregationStatistic {
    /// The index itself.
    #[default]
    Index,
    /// The probability of an index as large or larger by chance; at least 1/(1 + permutations).
    PValue,
    /// The mean of the permutations.
    RandomMean,
    /// The standard deviation of the permutations.
    RandomDeviation,
}

impl Segregation {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        if !at.records_contacts() {
            return;
        }
        let mut types: Vec<&str> = match &self.cells {
            Some(types) => types.as_slice().iter().map(String::as_str).collect(),
            None => at.types(),
        };
        types.sort_unstable();
        types.dedup();
        if types.len() < 2 {
            let (key, path) = match &self.cells {
                Some(_) => ("cells", format!("{}.cells", at.path())),
                None => ("", at.path().to_owned()),
            };
            let message = format!("`{path}`: cells of one type cannot be sorted");
            at.fault(key, "one type only", message, "name two types of cells or more");
        }
        at.when("time", self.time);
    }

    /// The number that is asked for.
    ///
    /// # Errors
    /// When the run has no contacts or no such type, or when at that time no two cells touch or all that do are of one type.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let recording = run.recording;
        let kinds: Vec<&str> = match &self.cells {
            Some(kinds) => kinds.as_slice().iter().map(String::as_str).collect(),
            None => recording.types.iter().map(String::as_str).collect(),
        };
        let mut counts = vec![false; recording.cell_types.len()];
        for kind in &kinds {
            recording.cells_of(Some(kind))?.into_iter().for_each(|cell| counts[cell] = true);
        }
        let Some(file) = run.file else {
            let fault = Fault::new("there is no file that says who touches whom");
            return Err(Error::input(fault.help("measure the result of a run")));
        };
        let frame = recording.frame_at(self.time);
        let pairs = file.pairs(frame)?;
        let pairs = pairs.iter().filter_map(|pair| Some([file.column_of(pair.cell)?, file.column_of(pair.other)?]));
        let pairs: Vec<[u32; 2]> = pairs.filter(|pair| pair.iter().all(|cell| counts[*cell as usize])).collect();
        let touching = touching_cells(&pairs);
        let time = recording.times[frame];
        let help = "give a time at which cells of two types touch";
        let Some(first) = touching.first() else {
            let which = words::all_of(kinds);
            return Err(Error::input(Fault::new(format!("no two cells of {which} touch at {time} s")).help(help)));
        };
        let kind_of = |cell: u32| recording.cell_types[cell as usize];
        if touching.iter().all(|cell| kind_of(*cell) == kind_of(*first)) {
            let kind = recording.types.get(kind_of(*first) as usize).map_or("", String::as_str);
            let fault = Fault::new(format!("all cells that touch another at {time} s are of the type \"{kind}\""));
            return Err(Error::input(fault.help(help)));
        }
        let found = sorting(&recording.cell_types, &pairs, self.permutations, file.header().seed);
        Ok(match self.statistic {
            SegregationStatistic::Index => found.index,
            SegregationStatistic::PValue => found.p_value,
            SegregationStatistic::RandomMean => found.mean,
            SegregationStatistic::RandomDeviation => found.standard_deviation,
        })
    }
}

/// The segregation index of some pairs of cells beside those of the same pairs with types dealt at random.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sorting {
    /// The index, eq. (analysis.16).
    pub index: f64,
    /// Mean of the permutations; 0 but for chance.
    pub mean: f64,
    /// Standard deviation of the permutations.
    pub standard_deviation: f64,
    /// Probability of an index as large or larger by chance, eq. (analysis.17).
    pub p_value: f64,
}

/// Finds the index and its permutation distribution. All numbers are NaN where there is no pair or where all cells that
/// touch another are of one type.
///
/// * `types` – the type of every cell.
/// * `pairs` – cells that touch, each pair once.
/// * `permutations` – how often the types of the cells that touch another are dealt anew.
/// * `seed` – the seed of the experiment: the same permutations for the same seed, on every machine.
///
/// # Panics
/// If a pair names a cell that is not there.
pub fn sorting(types: &[u32], pairs: &[[u32; 2]], permutations: u32, seed: u64) -> Sorting {
    let found = Alike::of(types, pairs);
    let index = found.index(found.alike);
    if index.is_nan() {
        return Sorting { index, mean: f64::NAN, standard_deviation: f64::NAN, p_value: f64::NAN };
    }
    let cells = touching_cells(pairs);
    let mut dealt = types.to_vec();
    let permuted: Vec<usize> = (0..permutations)
        .map(|number| {
            let stream = &mut Stream::new(seed, Purpose::Permutation, number, 0);
            // Fisher and Yates: each cell changes places with one of those before it, or stays.
            for last in (1..cells.len()).rev() {
                let other = (stream.uniform_pair()[0] * (last + 1) as f64) as usize;
                dealt.swap(cells[last] as usize, cells[other] as usize);
            }
            count_alike(&dealt, pairs)
        })
        .collect();
    let indices: Vec<f64> = permuted.iter().map(|alike| found.index(*alike)).collect();
    let as_many = permuted.iter().filter(|alike| **alike >= found.alike).count();
    Sorting {
        index,
        mean: statistics::mean(&indices),
        standard_deviation: statistics::standard_deviation(&indices),
        p_value: (1 + as_many) as f64 / (1.0 + f64::from(permutations)),
    }
}

#[cfg(test)]
#[path = "segregation_tests.rs"]
mod tests;
