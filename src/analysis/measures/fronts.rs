//! How fronts of a membrane come and go.

use super::declared::Declared;
use super::finished::Finished;
use super::successive::{Successive, SuccessiveStatistic, upward};
use crate::analysis::fronts::{Follower, Front};
use crate::error::{Error, Fault, Result, words};
use crate::output::ResultFile;
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How regions of the surface where a substance is above a threshold come and go: pseudopods, for instance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Fronts {
    /// The substance on membranes, SYSTEM.VARIABLE.
    pub of: String,
    /// The density above which the surface is a front, in the unit of the substance.
    pub above: f64,
    /// How long a front lasts at least to count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lasting: Option<Time>,
    /// When they are counted from; from the start when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// Until when they are counted; to the end when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// The axis around which turns are told.
    #[serde(default = "upward")]
    pub axis: [f64; 3],
    /// Which number.
    #[serde(default)]
    pub statistic: SuccessiveStatistic,
}

impl Fronts {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.system_of("of", &self.of);
        at.stretch(self.from, self.to);
        at.direction("axis", self.axis);
        if self.statistic.is_of_explicit_ones() {
            let message = format!("`{}.statistic` is not known of fronts of a membrane", at.path());
            let help = "take another statistic, or `kind = \"pseudopods\"` where cells have [cells.NAME.pseudopods]";
            at.fault("statistic", "of explicit pseudopods only", message, help);
        }
        if let Some(lasting) = self.lasting {
            at.instant("lasting", lasting);
        }
    }

    /// The number that is asked for; NaN where there were too few fronts to tell.
    ///
    /// # Errors
    /// When the run has no such substance.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let Some(file) = run.file else {
            let fault = Fault::new("there is no file that says what is on membranes");
            return Err(Error::input(fault.help("measure the result of a run")));
        };
        let times = &run.recording.times;
        let within = |time: f64| {
            self.from.is_none_or(|from| time >= from.value()) && self.to.is_none_or(|to| time <= to.value())
        };
        let frames: Vec<usize> = (0..times.len()).filter(|frame| within(times[*frame])).collect();
        let mut seen = Successive::new(self.axis);
        for (fronts, cell_frames) in self.follow(file, &frames)? {
            let of_cell: Vec<f64> = cell_frames.iter().map(|frame| times[*frame]).collect();
            self.add(&mut seen, &fronts, &of_cell);
        }
        Ok(seen.number(self.statistic))
    }

    /// The fronts of each cell, and the frames in which it was there.
    fn follow(&self, file: &ResultFile, frames: &[usize]) -> Result<Vec<(Vec<Front>, Vec<usize>)>> {
        let layout = file.layout();
        let mut cells: BTreeMap<u64, (Follower, Vec<usize>)> = BTreeMap::new();
        for &frame in frames {
            let Some(densities) = file.membrane(&self.of, frame)? else { return Err(self.missing(file)) };
            let (positions, there) = (file.positions(frame)?, file.cells(frame));
            for (cell, atoms) in there.iter().zip(layout.atoms_of(&there)) {
                // Cells without the system have no values.
                if densities[atoms.clone()].iter().any(|density| density.is_nan()) {
                    continue;
                }
                let facets = &layout.types[cell.kind as usize].facets;
                let (follower, seen) = cells
                    .entry(cell.id)
                    .or_insert_with(|| (Follower::new(atoms.len(), facets, self.above), Vec::new()));
                follower.see(&densities[atoms.clone()], &positions[atoms]);
                seen.push(frame);
            }
        }
        Ok(cells.into_values().map(|(follower, frames)| (follower.finish().0, frames)).collect())
    }

    /// Counts the fronts of one cell, which was there at these times.
    fn add(&self, seen: &mut Successive, fronts: &[Front], times: &[f64]) {
        let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return };
        seen.followed += last - first;
        // A front is there from the middle before the first frame that shows it to the middle after the last.
        let middle = |before: usize| match before {
            0 => first,
            _ if before == times.len() => last,
            _ => 0.5 * (times[before - 1] + times[before]),
        };
        let life = |front: &Front| middle(front.last() + 1) - middle(front.begin);
        let least = self.lasting.map_or(0.0, |lasting| lasting.value());
        let counted: Vec<&Front> = fronts.iter().filter(|front| life(front) >= least).collect();
        seen.lasted += counted.iter().map(|front| life(front)).sum::<f64>();
        for front in counted.iter().filter(|front| front.begin > 0) {
            seen.began += 1;
            seen.split += usize::from(front.split);
            if front.last() + 1 < times.len() {
                seen.lifetimes.push(life(front));
            }
        }
        let turns = counted.windows(2).map(|pair| (*pair[0].direction_at(pair[1].begin), pair[1].directions[0]));
        seen.add_turns(turns);
    }

    fn missing(&self, file: &ResultFile) -> Error {
        let names: Vec<&str> = file.layout().membranes.iter().map(|membrane| membrane.name.as_str()).collect();
        let fault = Fault::new(format!("there is no substance \"{}\" on membranes in this run", self.of));
        Error::input(fault.help(match names.is_empty() {
            true => "the run has no chemistry of membranes".to_owned(),
            false => format!("on its membranes are {}", words::all_of(names)),
        }))
    }
}

#[cfg(test)]
#[path = "fronts_tests.rs"]
mod tests;
