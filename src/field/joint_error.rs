//! Whether a step of fields and what stands beside them is good enough, and what its halves say of shorter ones.

use super::beside::{PartSum, parts_of, sum};
use super::joint::Joint;
use super::scene::Scene;
use super::step::Stepping;
use crate::equations::Range;
use crate::error::{Error, Result, short};

/// Of what changes in a step at least this part of the whole counts, as in (field.14).
const LEAST_CHANGE: f64 = 0.01;
/// What differs from the mean by less of the whole is round-off.
const ROUND_OFF: f64 = 1e-9;

impl Joint<'_, '_> {
    /// Whether a step that was taken whole stands, by what it is in two halves, which are kept then.
    pub(super) fn is_good(&mut self, now: f64, until: f64, cut: bool) -> Result<bool> {
        let Stepping::Adaptive { relative, absolute } = self.stepping else { return Ok(true) };
        self.report.checks += 1;
        let mut whole = std::mem::take(&mut self.scene.scratch.whole);
        whole.take(self.scene.population, self.scene.memories);
        self.sizes(&mut whole.sizes);
        if self.alone.are_acted_on {
            whole.values.clone_from(&self.fields.values);
        }
        self.scene.scratch.whole = whole;
        self.restore(now);
        let middle = 0.5 * (now + until);
        self.step(middle)?;
        self.fields.time = middle;
        self.step(until)?;
        let error = self.error([relative, absolute]);
        let length = until - now;
        let factor = (0.9 * error.powf(-1.0 / 3.0)).clamp(0.2, 4.0);
        if error.is_nan() || error > 1.0 {
            self.report.rejected += 1;
            self.scene.pace.step = length * if error.is_nan() { 0.2 } else { factor.min(0.5) };
            self.restore(now);
            return Ok(false);
        }
        self.report.error = self.report.error.max(error);
        self.extrapolate();
        let next = length * factor;
        self.scene.pace.step = if cut { next.max(self.scene.pace.step) } else { next };
        Ok(true)
    }

    /// What a step in halves and one in one piece say of shorter ones, as in (field.15): of what stands beside, and of each field where that is below
    /// zero nowhere, or may be.
    fn extrapolate(&mut self) {
        let Self { fields, scene, .. } = self;
        let further = |fine: f64, whole: f64| fine + (fine - whole) / 3.0;
        for variable in 0..self.beside.program.size() {
            let [now, whole] =
                [&*scene.population, scene.scratch.whole.population()].map(|population| population.state(0, variable));
            scene.population.set_state(0, variable, further(now, whole));
        }
        let boxes = fields.grid.len();
        let values = fields.values.chunks_exact_mut(boxes).zip(scene.scratch.whole.values.chunks_exact(boxes));
        for ((values, whole), species) in values.zip(&fields.species).filter(|_| self.alone.are_acted_on) {
            let floor = if species.range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
            if values.iter().zip(whole).all(|(fine, whole)| further(*fine, *whole) >= floor) {
                values.iter_mut().zip(whole).for_each(|(fine, whole)| *fine = further(*fine, *whole));
            }
        }
    }

    pub(super) fn keep(&mut self) {
        let before = &mut self.scene.scratch.before;
        before.take(self.scene.population, self.scene.memories);
        before.values.clone_from(&self.fields.values);
        before.inputs.clear();
        before.inputs.extend_from_slice(self.inputs);
    }

    pub(super) fn restore(&mut self, time: f64) {
        let before = &self.scene.scratch.before;
        self.scene.population.copy_from(before.population());
        self.scene.memories.iter_mut().zip(&before.memories).for_each(|(to, from)| to.copy_from(from));
        self.fields.values.copy_from_slice(&before.values);
        self.inputs.copy_from_slice(&before.inputs);
        self.fields.time = time;
    }

    /// The mean of each field and how far its values are from it, as root mean square.
    fn sizes(&mut self, to: &mut Vec<[f64; 2]>) {
        to.clear();
        let Self { fields, scene, .. } = self;
        let (boxes, sums) = (fields.grid.len(), &mut scene.scratch.sums);
        sums.resize_with(parts_of(&fields.grid), PartSum::default);
        to.extend(fields.values.chunks_exact(boxes).map(|values| sizes(values, sums)));
    }

    /// The error of a step that was taken whole and in halves, in tolerances.
    fn error(&mut self, [relative, absolute]: [f64; 2]) -> f64 {
        let mut fine = std::mem::take(&mut self.scene.scratch.trial.sizes);
        self.sizes(&mut fine);
        let Scene { population, eventful, scratch, .. } = &mut self.scene;
        let mut worst: f64 = 0.0;
        let mut note = |error: f64| worst = if error.is_nan() { f64::NAN } else { worst.max(error) };
        let part = |apart: f64, change: f64, size: f64, least: f64| match 4.0 / 3.0 * apart {
            0.0 => 0.0,
            apart => apart / (relative * change.max(LEAST_CHANGE * size) + least),
        };
        for variable in 0..self.beside.program.size() {
            let [before, whole] = [&scratch.before, &scratch.whole].map(|kept| kept.population().state(0, variable));
            let now = population.state(0, variable);
            let size = now.abs().max(before.abs());
            let least = eventful.tolerances.absolute * self.beside.program.sizes[variable];
            note(part((now - whole).abs(), (now - before).abs(), size, least));
        }
        if self.alone.are_acted_on {
            let boxes = self.fields.grid.len();
            for (species, (fine, whole)) in fine.iter().zip(&scratch.whole.sizes).enumerate() {
                let before = sizes(&scratch.before.values[species * boxes..][..boxes], &mut scratch.sums);
                let all = fine[0].hypot(fine[1]);
                for kind in 0..2 {
                    let (change, size) = ((fine[kind] - before[kind]).abs(), fine[kind].abs().max(before[kind].abs()));
                    note(part((fine[kind] - whole[kind]).abs(), change, size, absolute + ROUND_OFF * all));
                }
            }
        }
        self.scene.scratch.trial.sizes = fine;
        worst
    }

    pub(super) fn unreachable_tolerance(&self, time: f64) -> Error {
        Error::Numbers {
            message: format!(
                "document '{}': no step of the fields and what stands beside them meets the tolerance at t = {} s",
                self.alone.name,
                short(time)
            ),
            help: "check the rates for values that grow without bound, or raise the tolerance".into(),
            kept: None,
        }
    }
}

/// The mean of values and how far they are from it.
fn sizes(values: &[f64], sums: &mut [PartSum]) -> [f64; 2] {
    let boxes = values.len();
    let mean = sum(boxes, sums, |part, _| values[part].iter().sum()) / boxes as f64;
    let square = sum(boxes, sums, |part, _| values[part].iter().map(|value| (value - mean) * (value - mean)).sum());
    [mean, (square / boxes as f64).sqrt()]
}
