//! What is measured of a simulation: series by name, at this instant or kept as it goes.

use super::error::SimulationError;
use super::history::{History, passed};
use super::id::CellId;
use super::record::{Recorder, outline_of};
use super::snapshot::{Snapshot, unknown};
use super::stepping::Simulation;
use crate::cell::pseudopods;
use crate::output::{Frame, SeriesInfo};

/// A run of Brownian motility that ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndedRun {
    /// Whose.
    pub cell: CellId,
    /// When it ended, s.
    pub time: f64,
    /// How long it lasted, s.
    pub duration: f64,
}

/// A pseudopod whose protrusion ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndedPseudopod {
    /// Whose.
    pub cell: CellId,
    /// When it ended, s.
    pub time: f64,
    /// How long it was pushed, s.
    pub lifetime: f64,
    /// Unit vector to which it pointed.
    pub direction: [f64; 3],
    /// Angle from the one before, rad; none of the first of a cell.
    pub turn: Option<f64>,
    /// The side to which it split off from the one before: 1 left, -1 right, 0 where it started anew.
    pub side: i8,
    /// Whether there was no other when it began.
    pub alone: bool,
    /// Whether it was given up then.
    pub abandoned: bool,
}

impl Simulation {
    /// The series that there are: names, units, and whether they have a number for each cell or one for the scene. They are
    /// those of results, but for changes from frame to frame (`contact.births` and its like).
    pub fn series_infos(&self) -> Vec<SeriesInfo> {
        outline_of(&self.model).series()
    }

    /// A series at this instant: one number for each cell in the order of [`Simulation::cells`] (NaN where a cell does not have
    /// it), or a single one of the scene. Looking changes nothing.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// simulation.run_until(1.0)?;
    /// assert_eq!(simulation.series("volume")?.len(), 2);
    /// assert_eq!(simulation.series("load.pull")?, [5.0]);
    ///
    /// let error = simulation.series("volumes").unwrap_err();
    /// assert_eq!(error.to_string(), "there is no series `volumes`");
    /// assert!(error.help().unwrap().starts_with("did you mean `volume`?"));
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a name that is not among [`Simulation::series_infos`].
    pub fn series(&self, name: &str) -> Result<Vec<f64>, SimulationError> {
        self.snapshot().series(name)
    }

    /// Everything that is measured at this instant. Where several series are wanted this costs as much as one of them.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { layout: outline_of(&self.model), frame: self.frame() }
    }

    /// Begins to keep series: now, and from then on after the first step that reaches a multiple of `every`, s; after every step
    /// where that is 0. What was kept before is dropped. Keeping shortens no step.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// simulation.keep(&["size_x"], 0.5)?;
    /// simulation.run_until(2.0)?;
    /// let history = simulation.history();
    /// assert_eq!(history.times().len(), 5);
    /// let lengths = history.values("size_x").unwrap();
    /// assert!(lengths[4][0] > lengths[0][0], "the pulled cell has become longer");
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a name that is not among [`Simulation::series_infos`], [`SimulationError::Value`] for a
    /// time that is negative or not finite.
    pub fn keep(&mut self, names: &[&str], every: f64) -> Result<(), SimulationError> {
        if !(every >= 0.0 && every.is_finite()) {
            let what = "the time between what is kept".to_owned();
            return Err(SimulationError::Value { what, value: every, expected: "a time not below 0" });
        }
        let layout = outline_of(&self.model);
        let known = layout.series();
        let is_known =
            |name: &str| known.iter().any(|info| info.name == name.strip_prefix("chemistry.").unwrap_or(name));
        if let Some(name) = names.iter().find(|name| !is_known(name)) {
            return Err(unknown(&layout, name));
        }
        let (names, values) = (names.iter().map(|name| (*name).to_owned()).collect(), vec![Vec::new(); names.len()]);
        self.history = History { names, every, values, ..History::default() };
        self.keep_now();
        Ok(())
    }

    /// What was kept since [`Simulation::keep`].
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The runs of Brownian motility that ended since this was asked last. They are part of the state and of checkpoints until
    /// they are taken.
    pub fn take_ended_runs(&mut self) -> Vec<EndedRun> {
        let runs = std::mem::take(&mut self.state.ended_runs);
        let run = |(cell, time, duration)| EndedRun { cell: CellId::new(cell), time, duration };
        runs.into_iter().map(run).collect()
    }

    /// The pseudopods of `[cells.NAME.pseudopods]` whose protrusion ended since this was asked last. They are part of the state and of
    /// checkpoints until they are taken.
    pub fn take_ended_pseudopods(&mut self) -> Vec<EndedPseudopod> {
        let pods = std::mem::take(&mut self.state.ended_pseudopods);
        let told = |(cell, time, pod): (u64, f64, pseudopods::EndedPseudopod)| {
            let pseudopods::EndedPseudopod { lifetime, direction, turn, side, alone, abandoned } = pod;
            EndedPseudopod { cell: CellId::new(cell), time, lifetime, direction, turn, side, alone, abandoned }
        };
        pods.into_iter().map(told).collect()
    }

    /// Keeps what is to be kept after a step that began at `before`, s.
    pub(super) fn keep_if_due(&mut self, before: f64) {
        let History { names, every, .. } = &self.history;
        if !names.is_empty() && (*every == 0.0 || passed(before, self.state.time, *every)) {
            self.keep_now();
        }
    }

    /// Drops what was kept of times after this one, s.
    pub(super) fn forget_after(&mut self, time: f64) {
        let History { times, cells, values, .. } = &mut self.history;
        times.truncate(times.partition_point(|kept| *kept <= time));
        cells.truncate(times.len());
        values.iter_mut().for_each(|values| values.truncate(times.len()));
    }

    fn keep_now(&mut self) {
        if self.history.names.is_empty() {
            return;
        }
        let (layout, frame) = (outline_of(&self.model), self.frame());
        let now: Vec<CellId> = self.cells().collect();
        let History { names, times, cells, values, .. } = &mut self.history;
        times.push(frame.time);
        cells.push(cells.last().filter(|known| known[..] == now[..]).cloned().unwrap_or_else(|| now.into()));
        for (name, values) in names.iter().zip(values) {
            values.push(frame.series(&layout, name).unwrap_or_default());
        }
    }

    /// The frame of this instant; what it needs to look is its own.
    fn frame(&self) -> Frame {
        Recorder::new(&self.model).look(&self.model, &self.state, &self.scratch, self.last_step)
    }
}
