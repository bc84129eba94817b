//! What pseudopods that follow each other are like: how many, how long, and where the next one goes.

use crate::Vec3;
use crate::analysis::fronts::{chance_of_at_least, turn};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The axis around which turns are told where none is named.
pub(super) fn upward() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

/// Which number of pseudopods or fronts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum SuccessiveStatistic {
    /// How many there are, per second and cell.
    #[default]
    Rate,
    /// How many a cell has at once, mean over time and cells.
    AtOnce,
    /// The median time that they last, s.
    Lifetime,
    /// The median angle around the axis between one and the one before it, degrees from 0 to 180.
    Angle,
    /// The part that begins out of another one.
    SplitShare,
    /// The part of turns that go to the other side than the turn before.
    Alternation,
    /// The probability that so many or more turns go to the other side if both sides were as likely.
    AlternationP,
    /// The part that begins while the cell has no other; of explicit pseudopods only.
    AloneShare,
    /// The part that is given up when its protrusion ends; of explicit pseudopods only.
    AbandonedShare,
}

impl SuccessiveStatistic {
    /// Whether it tells of explicit pseudopods only.
    pub(super) fn is_of_explicit_ones(self) -> bool {
        matches!(self, Self::AloneShare | Self::AbandonedShare)
    }
}

/// What is known of those of all cells.
#[derive(Debug)]
pub(super) struct Successive {
    /// Unit vector around which turns are told.
    axis: Vec3,
    /// Time over which each cell was followed, summed, s.
    pub followed: f64,
    /// Time that each lasted, summed, s.
    pub lasted: f64,
    /// How many there were, and how many of them began out of another one.
    pub began: usize,
    pub split: usize,
    /// How many began while there was no other, and how many were given up.
    pub alone: usize,
    pub abandoned: usize,
    /// How long they lasted, s, where that is known.
    pub lifetimes: Vec<f64>,
    /// Angles between successive ones, degrees, without sign.
    angles: Vec<f64>,
    /// Turns after another turn, and how many of them went to the other side.
    turns: usize,
    alternating: usize,
}

impl Successive {
    /// Nothing is known yet.
    pub fn new(axis: [f64; 3]) -> Self {
        Self {
            axis: Vec3::from(axis).normalize(),
            followed: 0.0,
            lasted: 0.0,
            began: 0,
            split: 0,
            alone: 0,
            abandoned: 0,
            lifetimes: Vec::new(),
            angles: Vec::new(),
            turns: 0,
            alternating: 0,
        }
    }

    /// Counts the turns of one cell, from one direction to the next.
    pub fn add_turns(&mut self, turns: impl Iterator<Item = (Vec3, Vec3)>) {
        let mut before: Option<f64> = None;
        for (from, to) in turns {
            let turned = turn(&from, &to, &self.axis);
            if let Some(turned) = turned {
                self.angles.push(turned.abs().to_degrees());
                if let Some(before) = before {
                    self.turns += 1;
                    self.alternating += usize::from(before.signum() != turned.signum());
                }
            }
            before = turned;
        }
    }

    /// The number that is asked for; NaN where there were too few to tell.
    pub fn number(self, statistic: SuccessiveStatistic) -> f64 {
        let share = |part: usize, of: usize| if of == 0 { f64::NAN } else { part as f64 / of as f64 };
        match statistic {
            SuccessiveStatistic::Rate => self.began as f64 / self.followed,
            SuccessiveStatistic::AtOnce => self.lasted / self.followed,
            SuccessiveStatistic::Lifetime => median(self.lifetimes),
            SuccessiveStatistic::Angle => median(self.angles),
            SuccessiveStatistic::SplitShare => share(self.split, self.began),
            SuccessiveStatistic::AloneShare => share(self.alone, self.began),
            SuccessiveStatistic::AbandonedShare => share(self.abandoned, self.began),
            SuccessiveStatistic::Alternation => share(self.alternating, self.turns),
            SuccessiveStatistic::AlternationP if self.turns == 0 => f64::NAN,
            SuccessiveStatistic::AlternationP => chance_of_at_least(self.alternating, self.turns),
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
