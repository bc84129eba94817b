//! The series of cells by their names: those of all runs, and those of runs that record tractions or have fibres that come and go.

use super::cell::{CELL, CellQuantity, Values};
use super::fibres::FIBRES;
use super::traction::TRACTION;
use Values::{Number, Vector};

/// The length of the velocity, a series that is not stored.
pub const SPEED: &str = "speed";

/// What only some runs record of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OnDemand {
    /// What cells do to what is around them.
    pub tractions: bool,
    /// Fibres that are made at run time.
    pub fibres: bool,
}

impl OnDemand {
    /// All that any run records.
    pub const ALL: Self = Self { tractions: true, fibres: true };
}

/// The quantities of cells of a run that records these.
pub fn cell_quantities(with: OnDemand) -> impl Iterator<Item = &'static CellQuantity> {
    let tractions = TRACTION.iter().filter(move |_| with.tractions);
    CELL.iter().chain(tractions).chain(FIBRES.iter().filter(move |_| with.fibres))
}

/// Names of the series of such a run, vectors by their components (`position_x`), in the order of [`cell_quantities`], and [`SPEED`].
pub fn cell_series(with: OnDemand) -> impl Iterator<Item = String> {
    let names = cell_quantities(with).flat_map(|quantity| match &quantity.values {
        Number(..) => vec![quantity.name().to_owned()],
        Vector(_, components) => components.iter().map(|(end, _)| format!("{}_{end}", quantity.name())).collect(),
    });
    names.chain([SPEED.to_owned()])
}

/// The unit of a series of cells.
pub fn cell_unit(series: &str) -> Option<&'static str> {
    let stored = if series == SPEED { "velocity_x" } else { series };
    cell_quantities(OnDemand::ALL).find(|quantity| quantity.component(stored).is_some()).map(|quantity| quantity.unit)
}

/// What a chart calls a series of cells.
pub fn cell_label(series: &str) -> Option<&'static str> {
    let found = cell_quantities(OnDemand::ALL).find_map(|quantity| quantity.component(series)).map(|(_, label)| label);
    found.or_else(|| (series == SPEED).then_some(SPEED))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vector_series_are_named_by_component_and_every_series_has_unit_and_label() {
        let names: Vec<String> = cell_series(OnDemand::ALL).collect();
        let of_all: Vec<String> = cell_series(OnDemand::default()).collect();
        assert!(
            of_all
                .iter()
                .all(|name| names.contains(name) && !name.starts_with("traction") && !name.starts_with("fibre"))
        );
        for name in
            ["position_x", "size_z", "principal_1", "velocity_y", "volume", "speed", "traction_x", "traction_dipole"]
        {
            assert!(names.iter().any(|known| known == name), "{name} is missing from {names:?}");
        }
        for (number, name) in names.iter().enumerate() {
            assert!(cell_unit(name).is_some() && cell_label(name).is_some(), "{name}");
            assert!(!names[..number].contains(name), "{name} is there twice");
        }
        assert_eq!((cell_unit("speed"), cell_unit("position"), cell_label("size_w")), (Some("um/s"), None, None));
    }
}
