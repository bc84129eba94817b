//! The units of loads: those of the schema and those of the reference reader, which disagree.

use super::LoadKind;

/// Units by kind: their names and what they are in µm, s, pN and radians. A pascal is a pN/µm².
const UNITS: [(LoadKind, &[(&str, f64)]); 5] = [
    (LoadKind::Translation, &[("mm", 1e3), ("micron", 1.0), ("microm", 1.0), ("nm", 1e-3), ("m", 1e6)]),
    (
        LoadKind::Rotation,
        &[
            ("radian", 1.0),
            ("radians", 1.0),
            ("degree", std::f64::consts::PI / 180.0),
            ("degrees", std::f64::consts::PI / 180.0),
        ],
    ),
    (LoadKind::Force, &[("pN", 1.0), ("N", 1e12), ("kN", 1e15)]),
    (LoadKind::Pressure, &[("Pa", 1.0), ("kPa", 1e3), ("mmHg", 133.322_387_415)]),
    (LoadKind::Acceleration, &[("m/s^2", 1e6), ("cm/s^2", 1e4), ("mm/s^2", 1e3)]),
];

/// What a unit of a kind of load is.
pub(super) fn value(kind: &LoadKind, unit: &str) -> Option<f64> {
    units_of(kind).iter().find(|(name, _)| *name == unit).map(|(_, value)| *value)
}

/// The names of the units of a kind of load.
pub(super) fn names(kind: &LoadKind) -> impl Iterator<Item = &'static str> {
    units_of(kind).iter().map(|(name, _)| *name)
}

fn units_of(kind: &LoadKind) -> &'static [(&'static str, f64)] {
    UNITS.iter().find(|(own, _)| own == kind).map_or(&[], |(_, units)| units)
}
