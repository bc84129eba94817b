//! The series of a single frame, by the names that a result has for them.

use super::contacts::{series_of_frame, values_of_frame};
use super::{Frame, Layout, SystemScope};
use crate::recorded::{Values, cell_quantities, cell_series, cell_unit, derived};

/// What prefix quantities of chemistry may have.
const CHEMISTRY: &str = "chemistry.";

/// What a series has numbers of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeriesScope {
    /// One number for each cell; NaN for cells without the system of a quantity.
    Cells,
    /// One number for the scene.
    Scene,
}

/// A series that can be asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SeriesInfo {
    /// Its name, as in results: `size_x`, `load.pull`, `SYSTEM.QUANTITY`.
    pub name: String,
    /// The unit of its numbers; `1` for pure numbers.
    pub unit: String,
    /// What it has numbers of.
    pub scope: SeriesScope,
}

impl Layout {
    /// The series that every frame has. Those of changes from frame to frame are not among them.
    pub fn series(&self) -> Vec<SeriesInfo> {
        let info = |name: &str, unit: &str, scope| SeriesInfo { name: name.to_owned(), unit: unit.to_owned(), scope };
        let mut all = vec![info("time", "s", SeriesScope::Scene)];
        all.extend(self.scene_series.iter().map(|(name, unit)| info(name, unit, SeriesScope::Scene)));
        all.extend(series_of_frame(self).iter().map(|(name, unit)| info(name, unit, SeriesScope::Scene)));
        for name in cell_series(self.on_demand()) {
            all.push(info(&name, cell_unit(&name).unwrap_or("1"), SeriesScope::Cells));
        }
        for system in &self.systems {
            let scope = match system.scope {
                SystemScope::Scene => SeriesScope::Scene,
                SystemScope::Cells => SeriesScope::Cells,
            };
            let named = |(quantity, unit): &(String, String)| info(&format!("{}.{quantity}", system.name), unit, scope);
            all.extend(system.quantities.iter().map(named));
        }
        all
    }
}

impl Frame {
    /// The numbers of a series: one for each cell, or a single one of the scene. Quantities of chemistry may be called
    /// `chemistry.SYSTEM.QUANTITY`, too. None for a name that is not among [`Layout::series`].
    pub fn series(&self, layout: &Layout, name: &str) -> Option<Vec<f64>> {
        let of_scene = || match name {
            "time" => Some(self.time),
            _ => {
                let number = layout.scene_series.iter().position(|(known, _)| known == name)?;
                self.scene.get(number).copied()
            }
        };
        let found = of_scene().or_else(|| self.of_contacts(layout, name)).map(|value| vec![value]);
        found.or_else(|| self.of_cells(layout, name)).or_else(|| self.of_systems(layout, name))
    }

    fn of_contacts(&self, layout: &Layout, name: &str) -> Option<f64> {
        let number = series_of_frame(layout).iter().position(|(known, _)| known == name)?;
        let surface = self.records.iter().map(|cell| cell.area).sum();
        values_of_frame(layout, &self.cells, surface, &self.pairs, &self.on_planes).get(number).copied()
    }

    fn of_cells(&self, layout: &Layout, name: &str) -> Option<Vec<f64>> {
        if let Some(derived) = derived(name) {
            return Some(self.records.iter().map(|cell| (derived.by)((derived.vector)(cell))).collect());
        }
        let (values, (component, _)) = cell_quantities(layout.on_demand())
            .find_map(|quantity| Some((quantity.values, quantity.component(name)?)))?;
        Some(match (values, component) {
            (Values::Number(value, _), _) => self.records.iter().map(value).collect(),
            (Values::Vector(value, _), axis) => {
                self.records.iter().map(|cell| value(cell)[axis.unwrap_or(0)]).collect()
            }
        })
    }

    fn of_systems(&self, layout: &Layout, name: &str) -> Option<Vec<f64>> {
        let name = name.strip_prefix(CHEMISTRY).unwrap_or(name);
        layout.systems.iter().zip(&self.systems).find_map(|(system, values)| {
            let quantity = name.strip_prefix(&system.name)?.strip_prefix('.')?;
            let number = system.quantities.iter().position(|(known, _)| known == quantity)?;
            values.get(number).cloned()
        })
    }
}
