//! Events beside fields: what is due is executed, and fields are set.

use super::beside::{PartSum, parts_of};
use super::joint::{Joint, now};
use crate::equations::Range;
use crate::error::{Error, Result, short};
use crate::ode::Population;

/// Executions of events at one instant after which they count as endless.
const MOST_AT_ONCE: u32 = 10_000;

impl Joint<'_, '_> {
    /// Lets each see the other as it is, and executes what is due now, until nothing more happens. Returns whether anything did.
    pub fn settle(&mut self) -> Result<bool> {
        let (time, mut any) = (self.fields.time, false);
        for _ in 0..MOST_AT_ONCE {
            self.look();
            if self.scene.memories.is_empty() {
                return Ok(false);
            }
            let mut before = std::mem::take(&mut self.scene.scratch.before);
            before.take(self.scene.population, self.scene.memories);
            let done = self.go_on((time, time));
            let set = if matches!(done, Ok(1..)) { self.set_fields(before.population()) } else { Ok(()) };
            self.scene.scratch.before = before;
            set?;
            if done? == 0 {
                return Ok(any);
            }
            any = true;
        }
        Err(Error::Numbers {
            message: format!(
                "document '{}': events follow each other without end at t = {} s",
                self.alone.name,
                short(time)
            ),
            help: "let each event change what triggers it, so that its condition turns false".into(),
            kept: None,
        })
    }

    /// Sets fields as the events say that have been executed since.
    pub(super) fn set_fields(&mut self, before: &Population) -> Result<()> {
        for sets in &self.beside.sets {
            let times = self.scene.population.state(0, sets.count) - before.state(0, sets.count);
            for _ in 0..times.round() as u32 {
                self.look();
                let boxes = self.fields.grid.len();
                let mut set = std::mem::take(&mut self.scene.scratch.set);
                set.resize(sets.values.len() * boxes, 0.0);
                let now = now(&self.alone, self.fields, self.inputs);
                let scratch = &mut self.scene.scratch.sums;
                scratch.resize_with(parts_of(&self.fields.grid), PartSum::default);
                for ((_, table), to) in sets.values.iter().zip(set.chunks_exact_mut(boxes)) {
                    table.fill(&now, 0, to, scratch[0].file());
                }
                for ((species, _), from) in sets.values.iter().zip(set.chunks_exact(boxes)) {
                    let (species, name) = (*species, &self.fields.species[*species].name);
                    let floor =
                        if self.fields.species[species].range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
                    if let Some(at) = from.iter().position(|value| !(value.is_finite() && *value >= floor)) {
                        return Err(Error::Numbers {
                            message: format!(
                                "document '{}': the event '{}' sets field '{name}' to {} at {} µm and t = {} s",
                                self.alone.name,
                                sets.name,
                                from[at],
                                self.fields.grid.told(at),
                                short(self.fields.time)
                            ),
                            help: "write max(…, 0) where less may come out, or range=\"free\" at a field that may be negative"
                                .into(),
                            kept: None,
                        });
                    }
                    self.fields.values[species * boxes..(species + 1) * boxes].copy_from_slice(from);
                }
                self.scene.scratch.set = set;
            }
        }
        Ok(())
    }
}
