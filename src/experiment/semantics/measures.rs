//! What must hold between the keys of measures of fields and of chemistry.

use super::Check;
use crate::experiment::{ChemotacticIndex, FieldValue, MeasureKind, Period, Reduction, WaveSpeed, Wavelength, When};
use crate::units::Time;

impl Check<'_> {
    pub(super) fn measure_of_chemistry(&mut self, path: &str, kind: &MeasureKind) {
        match kind {
            MeasureKind::FieldValue(FieldValue { at, over, time, .. }) => {
                if at.is_some() && over.is_some() {
                    self.two_keys(path, "over", "at", "leave `over` out for the value at a place");
                }
                if let Reduction::At(time) = time {
                    self.instant(&format!("{path}.time"), time.value());
                }
            }
            MeasureKind::ChemotacticIndex(ChemotacticIndex { from, to, .. }) => {
                self.stretch(path, *from, *to);
            }
            MeasureKind::Period(Period { from, cells, cell, .. }) => {
                self.stretch(path, *from, None);
                let number: usize = self.document.experiment.cells.values().map(|cell| cell.count()).sum();
                if let Some(cell) = cell.filter(|cell| *cell as usize >= number) {
                    let message = format!("`{path}.cell` is {cell}, but there are {number} cells");
                    let help = format!("give a number from 0 to {}", number.saturating_sub(1));
                    self.fault(&format!("{path}.cell"), "no such cell", message, help);
                }
                if cells.is_some() && cell.is_some() {
                    self.two_keys(path, "cell", "cells", "name a type of cells or number one cell");
                }
            }
            MeasureKind::WaveSpeed(wave) => self.wave(path, wave),
            MeasureKind::Wavelength(Wavelength { time: When::At(time), .. }) => {
                self.instant(&format!("{path}.time"), time.value());
            }
            _ => {}
        }
    }

    fn wave(&mut self, path: &str, wave: &WaveSpeed) {
        match (&wave.series, &wave.field) {
            (Some(_), Some(_)) => self.two_keys(path, "field", "series", "measure the wave in one of them"),
            (None, None) => {
                let message = format!("`{path}` lacks what the wave runs through");
                let help = "add `field = \"NAME\"`, or `series = \"chemistry.SYSTEM.QUANTITY\"` of cells";
                self.fault(path, "`field` or `series` is missing here", message, help);
            }
            (Some(_), None) if wave.direction.is_some() => {
                self.two_keys(path, "direction", "series", "a ray is for fields; leave `direction` out");
            }
            (None, Some(_)) if wave.cells.is_some() => {
                self.two_keys(path, "cells", "field", "leave `cells` out: a field has none");
            }
            _ => {}
        }
        if let Some(direction) = wave.direction {
            self.direction(&format!("{path}.direction"), direction);
        }
        if let (Some(from), Some(to)) = (wave.distance_from, wave.distance_to)
            && from >= to
        {
            let message = format!("`{path}.distance_to` is not above `distance_from`");
            self.fault(&format!("{path}.distance_to"), "too small", message, "exchange the two");
        }
        self.stretch(path, wave.from, None);
    }

    /// A key that another one excludes.
    fn two_keys(&mut self, path: &str, key: &str, other: &str, help: &str) {
        let message = format!("`{path}` has both `{key}` and `{other}`");
        self.fault(&format!("{path}.{key}"), &format!("excluded by `{other}`"), message, help);
    }

    /// The stretch of time from `from` to `to` must lie within the run.
    fn stretch(&mut self, path: &str, from: Option<Time>, to: Option<Time>) {
        for (key, time) in [("from", from), ("to", to)] {
            if let Some(time) = time {
                self.instant(&format!("{path}.{key}"), time.value());
            }
        }
        if let (Some(from), Some(to)) = (from, to)
            && from >= to
        {
            let message = format!("`{path}.to` is not after `from`");
            self.fault(&format!("{path}.to"), "too early", message, "exchange the two");
        }
    }
}
