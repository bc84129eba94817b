//! The series of cells by their names: those of all runs, and those of runs that record tractions.

use super::cell::{CELL, CellQuantity, Values};
use super::traction::TRACTION;
use Values::{Number, Vector};

/// The length of the velocity, a series that is not stored.
pub const SPEED: &str = "speed";

/// The quantities of cells of a run that records tractions, or of one that does not.
pub fn cell_quantities(tractions: bool) -> impl Iterator<Item = &'static CellQuantity> {
    CELL.iter().chain(TRACTION.iter().filter(move |_| tractions))
}

/// Names of the series of such a run, vectors by their components (`position_x`), in the order of [`cell_quantities`], and [`SPEED`].
pub fn cell_series(tractions: bool) -> impl Iterator<Item = String> {
    let names = cell_quantities(tractions).flat_map(|quantity| match &quantity.values {
        Number(..) => vec![quantity.name().to_owned()],
        Vector(_, components) => components.iter().map(|(end, _)| format!("{}_{end}", quantity.name())).collect(),
    });
    names.chain([SPEED.to_owned()])
}

/// The unit of a series of cells.
pub fn cell_unit(series: &str) -> Option<&'static str> {
    let stored = if series == SPEED { "velocity_x" } else { series };
    cell_quantities(true).find(|quantity| quantity.component(stored).is_some()).map(|quantity| quantity.unit)
}

/// What a chart calls a series of cells.
pub fn cell_label(series: &str) -> Option<&'static str> {
    let found = cell_quantities(true).find_map(|quantity| quantity.component(series)).map(|(_, label)| label);
    found.or_else(|| (series == SPEED).then_some(SPEED))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vector_series_are_named_by_component_and_every_series_has_unit_and_label() {
        let names: Vec<String> = cell_series(true).collect();
        let of_all: Vec<String> = cell_series(false).collect();
        assert!(of_all.iter().all(|name| names.contains(name) && !name.starts_with("traction")));
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
