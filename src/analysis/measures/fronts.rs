//! How fronts of a membrane come and go.

use super::declared::Declared;
use super::finished::Finished;
use crate::Vec3;
use crate::analysis::fronts::{Follower, Front, chance_of_at_least, turn};
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
    pub statistic: FrontStatistic,
}

fn upward() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

/// Which number of fronts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum FrontStatistic {
    /// How many begin, per second and cell.
    #[default]
    Rate,
    /// How many a cell has at once, mean over time and cells.
    AtOnce,
    /// The median time that they last, s, of those that begin and end in time.
    Lifetime,
    /// The median angle around the axis between one that begins and the one that began before it, degrees from 0 to 180.
    Angle,
    /// The part that begins out of another front.
    SplitShare,
    /// The part of turns that go to the other side than the turn before.
    Alternation,
    /// The probability that so many or more turns go to the other side if both sides were as likely.
    AlternationP,
}

/// What is known of the fronts of all cells.
#[derive(Debug, Default)]
struct Seen {
    /// Time over which each cell was followed, summed, s.
    followed: f64,
    /// Time that each front lasted, summed, s.
    lasted: f64,
    began: usize,
    split: usize,
    /// How long fronts lasted that began and ended in time, s.
    lifetimes: Vec<f64>,
    /// Angles between successive fronts, degrees, without sign.
    angles: Vec<f64>,
    /// Turns after another turn, and how many of them went to the other side.
    turns: usize,
    alternating: usize,
}

impl Fronts {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.stretch(self.from, self.to);
        at.direction("axis", self.axis);
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
        let mut seen = Seen::default();
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
    fn add(&self, seen: &mut Seen, fronts: &[Front], times: &[f64]) {
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
        let axis = Vec3::from(self.axis).normalize();
        let mut before: Option<f64> = None;
        for pair in counted.windows(2) {
            let turned = turn(pair[0].direction_at(pair[1].begin), &pair[1].directions[0], &axis);
            if let Some(turned) = turned {
                seen.angles.push(turned.abs().to_degrees());
                if let Some(before) = before {
                    seen.turns += 1;
                    seen.alternating += usize::from(before.signum() != turned.signum());
                }
            }
            before = turned;
        }
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

impl Seen {
    fn number(self, statistic: FrontStatistic) -> f64 {
        let share = |part: usize, of: usize| if of == 0 { f64::NAN } else { part as f64 / of as f64 };
        match statistic {
            FrontStatistic::Rate => self.began as f64 / self.followed,
            FrontStatistic::AtOnce => self.lasted / self.followed,
            FrontStatistic::Lifetime => median(self.lifetimes),
            FrontStatistic::Angle => median(self.angles),
            FrontStatistic::SplitShare => share(self.split, self.began),
            FrontStatistic::Alternation => share(self.alternating, self.turns),
            FrontStatistic::AlternationP if self.turns == 0 => f64::NAN,
            FrontStatistic::AlternationP => chance_of_at_least(self.alternating, self.turns),
        }
    }
}

/// The median; NaN of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        number if number.is_multiple_of(2) => 0.5 * (values[number / 2 - 1] + values[number / 2]),
        number => values[number / 2],
    }
}

#[cfg(test)]
#[path = "fronts_tests.rs"]
mod tests;
