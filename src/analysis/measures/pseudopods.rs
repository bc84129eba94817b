//! How pseudopods follow each other.

use super::declared::Declared;
use super::finished::Finished;
use super::successive::{Successive, SuccessiveStatistic, upward};
use crate::error::{Error, Fault, Result};
use crate::output::PseudopodEvent;
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the pseudopods of `[cells.NAME.pseudopods]` follow each other: those whose protrusion ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct PseudopodTurns {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// When protrusions that count end at the earliest; any time when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// When they end at the latest; any time when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// The axis around which turns are told.
    #[serde(default = "upward")]
    pub axis: [f64; 3],
    /// Which number.
    #[serde(default)]
    pub statistic: SuccessiveStatistic,
}

impl PseudopodTurns {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.stretch(self.from, self.to);
        at.direction("axis", self.axis);
        if !at.has_pseudopods(self.cells.as_deref()) {
            let which = self
                .cells
                .as_ref()
                .map_or("no type of cells has".to_owned(), |kind| format!("\"{kind}\" does not have"));
            let message = format!("`{}` counts explicit pseudopods, which {which}", at.path());
            let help =
                "add [cells.NAME.pseudopods]; fronts of a membrane's chemistry are counted by `kind = \"fronts\"`";
            at.fault("", "no pseudopods", message, help);
        }
    }

    /// The number that is asked for; NaN where there were too few pseudopods to tell.
    ///
    /// # Errors
    /// When the run has no such type.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let Some(file) = run.file else {
            let fault = Fault::new("there is no file that says what pseudopods there were");
            return Err(Error::input(fault.help("measure the result of a run")));
        };
        let (recording, times) = (run.recording, &run.recording.times);
        let last = times.last().copied().unwrap_or(0.0);
        let within = [self.from.map_or(0.0, |from| from.value()), self.to.map_or(last, |to| to.value()).min(last)];
        let all = file.pseudopods()?;
        let mut seen = Successive::new(self.axis);
        for cell in recording.cells_of(self.cells.as_deref())? {
            let id = recording.ids[cell];
            let life = recording
                .lives
                .get(cell)
                .map_or([0.0, last], |life| [life.start, life.end - 1].map(|frame| times[frame]));
            seen.followed += (within[1].min(life[1]) - within[0].max(life[0])).max(0.0);
            let own = |pod: &&PseudopodEvent| pod.cell == id && (within[0]..=within[1]).contains(&pod.end);
            let pods: Vec<&PseudopodEvent> = all.iter().filter(own).collect();
            seen.began += pods.len();
            seen.split += pods.iter().filter(|pod| pod.side != 0).count();
            seen.alone += pods.iter().filter(|pod| pod.alone).count();
            seen.abandoned += pods.iter().filter(|pod| pod.abandoned).count();
            seen.lasted += pods.iter().map(|pod| pod.lifetime).sum::<f64>();
            seen.lifetimes.extend(pods.iter().map(|pod| pod.lifetime));
            seen.add_turns(pods.windows(2).map(|pair| (pair[0].direction.into(), pair[1].direction.into())));
        }
        Ok(seen.number(self.statistic))
    }
}

#[cfg(test)]
#[path = "pseudopods_tests.rs"]
mod tests;
