//! The series of cells by their names: those of all runs, and those of runs that record tractions or have fibres that come and go.

use super::cell::{CELL, CellQuantity, CellRecord, VISCOUS, Values};
use super::fibres::FIBRES;
use super::traction::TRACTION;
use Values::{Number, Vector};

/// A series that is not stored: a number made of a vector that is.
#[derive(Debug, Clone, Copy)]
pub struct Derived {
    /// Its name.
    pub name: &'static str,
    /// Its unit; `1` for pure numbers.
    pub unit: &'static str,
    /// What charts call it.
    pub label: &'static str,
    /// The series of the components of the vector.
    pub components: [&'static str; 3],
    /// The vector in a record.
    pub vector: fn(&CellRecord) -> [f64; 3],
    /// What is made of it.
    pub by: fn([f64; 3]) -> f64,
}

/// All of them.
pub const DERIVED: [Derived; 2] = [
    Derived {
        name: "speed",
        unit: "um/s",
        label: "speed",
        components: ["velocity_x", "velocity_y", "velocity_z"],
        vector: |record| record.velocity,
        by: |[x, y, z]| (x * x + y * y + z * z).sqrt(),
    },
    Derived {
        name: "aspect_ratio",
        unit: "1",
        label: "length over width",
        components: ["principal_1", "principal_2", "principal_3"],
        vector: |record| record.principal,
        by: |[longest, middle, _]| longest / middle,
    },
];

/// The derived series of a name.
pub fn derived(name: &str) -> Option<&'static Derived> {
    DERIVED.iter().find(|derived| derived.name == name)
}

/// What only some runs record of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OnDemand {
    /// What cells do to what is around them.
    pub tractions: bool,
    /// Fibres that are made at run time.
    pub fibres: bool,
    /// What viscosity takes.
    pub viscosity: bool,
}

impl OnDemand {
    /// All that any run records.
    pub const ALL: Self = Self { tractions: true, fibres: true, viscosity: true };
}

/// The quantities of cells of a run that records these.
pub fn cell_quantities(with: OnDemand) -> impl Iterator<Item = &'static CellQuantity> {
    let tractions = TRACTION.iter().filter(move |_| with.tractions);
    let viscous = VISCOUS.iter().filter(move |_| with.viscosity);
    CELL.iter().chain(tractions).chain(FIBRES.iter().filter(move |_| with.fibres)).chain(viscous)
}

/// Names of the series of such a run, vectors by their components (`position_x`), in the order of [`cell_quantities`], and of [`DERIVED`].
pub fn cell_series(with: OnDemand) -> impl Iterator<Item = String> {
    let names = cell_quantities(with).flat_map(|quantity| match &quantity.values {
        Number(..) => vec![quantity.name().to_owned()],
        Vector(_, components) => components.iter().map(|(end, _)| format!("{}_{end}", quantity.name())).collect(),
    });
    names.chain(DERIVED.iter().map(|derived| derived.name.to_owned()))
}

/// The unit of a series of cells.
pub fn cell_unit(series: &str) -> Option<&'static str> {
    let stored = || cell_quantities(OnDemand::ALL).find(|quantity| quantity.component(series).is_some());
    derived(series).map(|derived| derived.unit).or_else(|| stored().map(|quantity| quantity.unit))
}

/// What a chart calls a series of cells.
pub fn cell_label(series: &str) -> Option<&'static str> {
    let found = cell_quantities(OnDemand::ALL).find_map(|quantity| quantity.component(series)).map(|(_, label)| label);
    found.or_else(|| derived(series).map(|derived| derived.label))
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
