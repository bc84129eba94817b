//! What of a cell chemistry can read and what it can set: the words behind `cell.` in a link.
//!
//! A link's end such as `cell.atom[4].y` is grammar to EML; here its words get their meaning. Words that exist are in
//! [`READABLE`] and [`settable`], in the order in which messages list them.

use crate::equations::eml::{Index, Step};
use crate::mechanics::CONTROLLED;

/// A number that can be read from a cell at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// A component of the centre, µm.
    Position(usize),
    /// A component of an atom's position, µm.
    Atom(usize, usize),
    /// A component of the mean velocity of the atoms over the last step, µm/s.
    Velocity(usize),
    /// Size of that velocity, µm/s.
    Speed,
    /// Enclosed volume, µm³.
    Volume,
    /// (V − V₀)/V₀, V₀ the volume of the mesh at rest.
    VolumeStrain,
    /// Area of the surface, µm².
    Area,
    /// (A − A₀)/A₀, A₀ the area of the mesh at rest.
    AreaStrain,
    /// Extent of the bounding box along an axis, µm.
    Size(usize),
    /// Part of the atoms near another cell, as it is recorded; 0 in an experiment without contacts.
    ContactShare,
    /// Part of the atoms on a plane.
    PlaneShare,
}

/// A number of a cell that chemistry can set.
#[derive(Debug, Clone, PartialEq)]
pub enum Setting {
    /// Speed of the Brownian walk, µm/s.
    MotilitySpeed,
    /// A component of a velocity added to the walk, µm/s.
    Bias(usize),
    /// What tells pseudopods where to go and what to do.
    Pseudopods(PodSetting),
    /// Factor of all elastic forces; 1 without a link.
    Stiffness,
    /// Factor of the strength with which the cell sticks; 1 without a link.
    Adhesion,
    /// Rest volume, µm³.
    RestVolume,
    /// Rest volume over that of the mesh at rest.
    RestVolumeRatio,
    /// What may be set of a force: the number of its handle in [`CONTROLLED`], and its name.
    Force(usize, String),
    /// A component of an atom's position, µm, imposed.
    Atom(usize, usize),
    /// Amount of a field's substance that the cell releases in a second; negative: takes up.
    Secretion(String),
    /// Something of every atom.
    Atoms(AtomSetting),
}

/// What differs from atom to atom of a cell and can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtomReading {
    /// A component of the outward unit normal, eq. (coupling.2).
    Normal(usize),
    /// Mean curvature, per µm, eq. (coupling.3).
    Curvature,
    /// (A − A₀)/A₀ of the area of the atom, A₀ that of the mesh at rest.
    AreaStrain,
    /// 1 where the atom is near another cell, as it is recorded, and else 0; of a kind with this number where there is one.
    InContact(Option<usize>),
    /// 1 where the atom stands on a plane, and else 0; on the one with this number where there is one.
    OnPlane(Option<usize>),
    /// Force of the atom on planes and other cells over the last step over its area, pN/µm².
    Traction,
}

/// What chemistry can set of atoms.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AtomSetting {
    /// Pressure along the outward normal, pN/µm².
    Protrusion,
    /// Tension of the surface, beside that of the type, pN/µm.
    Tension,
    /// Factor of the moduli of the membrane.
    Elasticity,
    /// Factor of the strength with which the atom sticks.
    Adhesion,
    /// Amount of a field's substance that is released in a second and on a µm²; negative: taken up.
    Secretion(String),
}

/// What chemistry may tell pseudopods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PodSetting {
    /// A component of the cue.
    Cue(usize),
    /// How much the front is pushed, from 0 to 1.
    Protrusion,
    /// How much front and rear are drawn together, from 0 to 1.
    Retraction,
}

/// What is sensed of a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sense {
    /// The value, in the field's unit.
    Value,
    /// A component of the gradient, per µm.
    Gradient(usize),
    /// The size of the gradient, per µm.
    Steepness,
}

/// What can be read, as messages list it.
pub const READABLE: [&str; 26] = [
    "position.x",
    "atom[0].x",
    "velocity.x",
    "speed",
    "volume",
    "volume_strain",
    "area",
    "area_strain",
    "size.x",
    "contact_share",
    "plane_share",
    "field[NAME]",
    "field[NAME].gradient.x",
    "field[NAME].steepness",
    "chemistry[NAME].ID",
    "neighbours.count",
    "neighbours.chemistry[NAME].ID.mean",
    "atoms.normal.x",
    "atoms.curvature",
    "atoms.area_strain",
    "atoms.in_contact",
    "atoms.in_contact[TYPE]",
    "atoms.on_plane",
    "atoms.on_plane[NAME]",
    "atoms.traction",
    "atoms.field[NAME]",
];

/// What can be set, as messages list it.
pub fn settable() -> Vec<String> {
    let own = ["motility.speed", "motility.bias.x", "stiffness", "adhesion", "rest_volume", "rest_volume_ratio"];
    let pods = ["pseudopods.cue.x", "pseudopods.protrusion", "pseudopods.retraction"];
    let forces = CONTROLLED.map(|handle| format!("{}[NAME]", handle.word));
    let last = ["atom[0].x", "secretion[FIELD]"].map(String::from);
    let atoms =
        ["protrusion", "tension", "elasticity", "adhesion", "secretion[FIELD]"].map(|word| format!("atoms.{word}"));
    own.into_iter().chain(pods).map(String::from).chain(forces).chain(last).chain(atoms).collect()
}

/// The word of a handle of forces, by its number.
pub fn word_of(handle: usize) -> &'static str {
    CONTROLLED[handle].word
}

/// The meaning of the words behind `cell.`, if they can be read from the cell alone.
pub fn reading(path: &[Step]) -> Option<Reading> {
    Some(match words(path)[..] {
        [("position", None), (axis, None)] => Reading::Position(component(axis)?),
        [("atom", Some(Index::Number(atom))), (axis, None)] => Reading::Atom(*atom, component(axis)?),
        [("velocity", None), (axis, None)] => Reading::Velocity(component(axis)?),
        [("speed", None)] => Reading::Speed,
        [("volume", None)] => Reading::Volume,
        [("volume_strain", None)] => Reading::VolumeStrain,
        [("area", None)] => Reading::Area,
        [("area_strain", None)] => Reading::AreaStrain,
        [("size", None), (axis, None)] => Reading::Size(component(axis)?),
        [("contact_share", None)] => Reading::ContactShare,
        [("plane_share", None)] => Reading::PlaneShare,
        _ => return None,
    })
}

/// The meaning of the words behind `cell.atoms.`, if they can be read from the cell alone.
pub fn atom_reading(path: &[Step]) -> Option<AtomReading> {
    Some(match words(path)[..] {
        [("normal", None), (axis, None)] => AtomReading::Normal(component(axis)?),
        [("curvature", None)] => AtomReading::Curvature,
        [("area_strain", None)] => AtomReading::AreaStrain,
        [("in_contact", None)] => AtomReading::InContact(None),
        [("on_plane", None)] => AtomReading::OnPlane(None),
        [("traction", None)] => AtomReading::Traction,
        _ => return None,
    })
}

/// The meaning of the words behind `cell.`, if they can be set.
pub fn setting(path: &[Step]) -> Option<Setting> {
    Some(match words(path)[..] {
        [("motility", None), ("speed", None)] => Setting::MotilitySpeed,
        [("motility", None), ("bias", None), (axis, None)] => Setting::Bias(component(axis)?),
        [("pseudopods", None), ("cue", None), (axis, None)] => Setting::Pseudopods(PodSetting::Cue(component(axis)?)),
        [("pseudopods", None), ("protrusion", None)] => Setting::Pseudopods(PodSetting::Protrusion),
        [("pseudopods", None), ("retraction", None)] => Setting::Pseudopods(PodSetting::Retraction),
        [("stiffness", None)] => Setting::Stiffness,
        [("adhesion", None)] => Setting::Adhesion,
        [("rest_volume", None)] => Setting::RestVolume,
        [("rest_volume_ratio", None)] => Setting::RestVolumeRatio,
        [("atom", Some(Index::Number(atom))), (axis, None)] => Setting::Atom(*atom, component(axis)?),
        [("secretion", Some(Index::Name(name)))] => Setting::Secretion(name.clone()),
        [("atoms", None), ("protrusion", None)] => Setting::Atoms(AtomSetting::Protrusion),
        [("atoms", None), ("tension", None)] => Setting::Atoms(AtomSetting::Tension),
        [("atoms", None), ("elasticity", None)] => Setting::Atoms(AtomSetting::Elasticity),
        [("atoms", None), ("adhesion", None)] => Setting::Atoms(AtomSetting::Adhesion),
        [("atoms", None), ("secretion", Some(Index::Name(name)))] => {
            Setting::Atoms(AtomSetting::Secretion(name.clone()))
        }
        [(word, Some(Index::Name(name)))] => {
            Setting::Force(CONTROLLED.iter().position(|handle| handle.word == word)?, name.clone())
        }
        _ => return None,
    })
}

/// The meaning of the words behind `field[NAME]`, where a cell or an atom senses it.
pub fn sense(path: &[Step]) -> Option<Sense> {
    Some(match words(path)[..] {
        [] | [("value", None)] => Sense::Value,
        [("gradient", None), (axis, None)] => Sense::Gradient(component(axis)?),
        [("steepness", None)] => Sense::Steepness,
        _ => return None,
    })
}

/// The axis of x, y or z.
pub fn component(name: &str) -> Option<usize> {
    ["x", "y", "z"].iter().position(|axis| *axis == name)
}

fn words(path: &[Step]) -> Vec<(&str, Option<&Index>)> {
    path.iter().map(|step| (step.name.as_str(), step.index.as_ref())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> Vec<Step> {
        let one = |word: &str| {
            let (name, index) = match word.split_once('[') {
                Some((name, rest)) => (name, Some(rest.trim_end_matches(']'))),
                None => (word, None),
            };
            let index = index.map(|index| match index.parse() {
                Ok(number) => Index::Number(number),
                Err(_) => Index::Name(index.to_owned()),
            });
            Step { name: name.to_owned(), index }
        };
        text.split('.').map(one).collect()
    }

    #[test]
    fn every_word_that_is_listed_is_known() {
        for text in settable() {
            assert!(setting(&path(&text)).is_some(), "{text} can be set");
        }
        // What has the name of a field, a system, a type or a plane is looked up in the experiment.
        let elsewhere =
            |text: &&str| text.contains("[NAME]") || text.contains("[TYPE]") || text.starts_with("neighbours.");
        for text in READABLE.into_iter().filter(|text| !elsewhere(text)) {
            let of_atoms = text.strip_prefix("atoms.").map(|text| atom_reading(&path(text)).is_some());
            assert!(of_atoms.unwrap_or_else(|| reading(&path(text)).is_some()), "{text} can be read");
        }
        assert_eq!(sense(&path("gradient.y")), Some(Sense::Gradient(1)));
        assert_eq!(reading(&path("volume.x")), None);
        assert_eq!(setting(&path("atom[2].w")), None);
    }
}
