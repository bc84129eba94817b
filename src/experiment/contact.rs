//! Contacts between cells: how near is a contact, and how strongly which surfaces stick.

use crate::recorded::Recorded;
use crate::units::{Force, Frequency, Length, LineStiffness, Stress, SurfaceDensity, SurfaceDrag};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What cells do that touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum ContactModel {
    /// Contacts bear any push and a shear, and surfaces attract each other: with `strength` at most, and over twice the `energy` that
    /// parts them over the strength.
    #[default]
    Cohesion,
    /// Contacts of atoms bear any push, and a pull and a shear by `strength`: to compare with.
    Adhesives,
    /// Contacts bear any push, and springs hold the atoms of facets that collided, by `link`; they break beyond `range`.
    Links,
    /// Contacts push by `penalty` times their depth, and pull within the proximity, by `strength`: to compare with.
    Penalty,
    /// Contacts bear any push, and atoms that touch move as one rigid body until a step would take one farther than `kappa` from it.
    VirtualAdhesives,
}

/// Bonds between surfaces: how many there can be, and how fast they close and open.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct Bonds {
    /// The most bonds that an area of contact can have.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub density: SurfaceDensity,
    /// Rate at which each that is open closes while the surfaces are within the range.
    #[schemars(extend("x-minimum" = 0))]
    pub on: Frequency,
    /// Rate at which bonds without load open.
    #[schemars(extend("x-minimum" = 0))]
    pub off: Frequency,
    /// Load of a bond that makes it open e times as fast.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub force: Force,
    /// A second pathway along which they open, which load shuts: catch bonds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub catch: Option<Catch>,
    /// The share that is closed in contacts that are there when the run begins; 0 when absent.
    #[serde(default, skip_serializing_if = "is_none_closed")]
    #[schemars(range(min = 0, max = 1))]
    pub start: f64,
}

fn is_none_closed(share: &f64) -> bool {
    *share == 0.0
}

/// A pathway along which bonds open that load shuts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct Catch {
    /// Rate at which bonds without load open along it.
    #[schemars(extend("x-minimum" = 0))]
    pub off: Frequency,
    /// Load of a bond that makes this e times slower.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub force: Force,
}

/// Which virtual adhesives merge where their atoms are neighbours on a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Zones {
    /// All.
    #[default]
    Merged,
    /// Those of the same two cells, or the same cell and plane; an atom that touches several belongs to the nearest.
    Pairs,
}

/// Contacts of cells with each other, with themselves and with planes. Without this table cells pass through each other.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Contact {
    /// What cells do that touch.
    pub model: ContactModel,
    /// Gap below which surfaces touch; a tenth of the smallest mean edge when absent, or `prediction` where that is less.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub proximity: Option<Length>,
    /// Gap below which a step keeps surfaces apart that might meet in it: cells that are near each other move past each other by no more than
    /// that in a step. It changes steps, not what touches. A fifth of the smallest mean edge when absent, or `proximity` where that is more.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub prediction: Option<Length>,
    /// Opening below which surfaces count as area of contact in what is recorded; 0.3 um when absent, or ten of the smallest mean edge
    /// where that is less.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub area_within: Option<Length>,
    /// Pull over area of contact at which surfaces of any two types part, the most that they attract each other with: twice `energy` over
    /// `range` when absent. Nothing sticks where neither it nor `energy` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub strength: Option<Stress>,
    /// Shear over area of contact at which they slide; as `strength` when absent, or 0 where there is `friction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub shear_strength: Option<Stress>,
    /// Model cohesion: what resists sliding beyond `shear_strength`, over area of contact and speed; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub friction: Option<SurfaceDrag>,
    /// Model cohesion: bonds that close and open and do all that holds these surfaces together; without, all are closed wherever surfaces are within the range.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bonds: Option<Bonds>,
    /// Work that parts an area of contact: half of `strength` times `range` when absent. Model adhesives: energy that an area of contact
    /// releases, none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub energy: Option<LineStiffness>,
    /// Model links: stiffness of the springs between facets that collided, for any two types; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub link: Option<LineStiffness>,
    /// How far open surfaces still attract each other, in place of `energy` or `strength`; 1.5 um where one of the three is given. Model links: mean length of its
    /// springs above which a link breaks; the smallest mean edge when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub range: Option<Length>,
    /// Model penalty: push of a contact over its depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub penalty: Option<LineStiffness>,
    /// Model virtual_adhesives: what an atom's own displacement in a step may differ from that of its adhesive before it is
    /// released, for any two types; nothing sticks when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub kappa: Option<Length>,
    /// Model virtual_adhesives: which of them merge; "merged" when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zones: Option<Zones>,
    /// Strengths, links or kappas of single pairs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub between: Vec<Between>,
}

/// How far open surfaces attract each other where the document does not say, µm: about as far as folds and microvilli of a cell's surface
/// reach.
pub(super) const RANGE: f64 = 1.5;

impl Contact {
    /// Which series a run records besides those of all contacts.
    pub(super) fn recorded(&self) -> Recorded {
        match self.model {
            ContactModel::Cohesion if self.has_bonds() => Recorded::WithBonds,
            ContactModel::Adhesives | ContactModel::Cohesion | ContactModel::Penalty => Recorded::Always,
            ContactModel::Links => Recorded::WithLinks,
            ContactModel::VirtualAdhesives => Recorded::WithAdhesives,
        }
    }

    /// Whether any surfaces have bonds.
    fn has_bonds(&self) -> bool {
        self.bonds.is_some() || self.between.iter().any(|pair| pair.bonds.is_some())
    }

    /// Strength (pN/µm²) and work of separation (pN/µm) of surfaces of which two of strength, energy and range are given, or one, and
    /// the range for all; zero where neither of the first two is.
    pub(super) fn cohesive(
        &self,
        strength: Option<Stress>,
        energy: Option<LineStiffness>,
        range: Option<Length>,
    ) -> [f64; 2] {
        let range = range.or(self.range).map_or(RANGE, |range| range.value());
        match (strength.map(|strength| strength.value()), energy.map(|energy| energy.value())) {
            (Some(strength), Some(energy)) => [strength, energy],
            (Some(strength), None) => [strength, 0.5 * strength * range],
            (None, Some(energy)) => [2.0 * energy / range, energy],
            (None, None) => [0.0, 0.0],
        }
    }
}

/// How strongly the cells of two types stick to each other, or those of a type to a plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Between {
    /// Two types of cells, or a type and a plane; the same type twice for its cells among themselves.
    pub types: [String; 2],
    /// Pull over area of contact at which they part: twice `energy` over `range` when absent. Needed in the models adhesives and penalty.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub strength: Option<Stress>,
    /// Shear over area of contact at which they slide; as `strength` when absent, or 0 where there is `friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub shear_strength: Option<Stress>,
    /// Model cohesion: what resists sliding beyond `shear_strength`, over area of contact and speed; none when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub friction: Option<SurfaceDrag>,
    /// Model cohesion: bonds that close and open and do all that holds these surfaces together; without, all are closed wherever surfaces are within the range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bonds: Option<Bonds>,
    /// Work that parts an area of contact: half of `strength` times `range` when absent. Model adhesives: energy that an area of contact
    /// releases, none when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub energy: Option<LineStiffness>,
    /// How far open they still attract each other, in place of `energy` or `strength`; that of [contact] where one of the three is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub range: Option<Length>,
    /// Model links: stiffness of the springs between facets that collided; "0 pN/um" does not bind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub link: Option<LineStiffness>,
    /// Model virtual_adhesives: the difference of displacements at which an atom is released; "0 um" does not stick.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub kappa: Option<Length>,
}

/// What two names of a pair mean in an experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pair {
    /// Two types, by number, the smaller first.
    Types(usize, usize),
    /// A type and a plane or, numbered behind all planes, a tool.
    OnObstacle(usize, usize),
}

impl Between {
    /// The meaning of the pair; none where a name is unknown or both are planes.
    pub(super) fn pair(&self, experiment: &super::Experiment) -> Option<Pair> {
        let kind = |name: &str| experiment.cells.get_index_of(name);
        let obstacle = |name: &str| experiment.obstacles().position(|known| known == name);
        let [first, second] = &self.types;
        match (kind(first), kind(second)) {
            (Some(one), Some(other)) => Some(Pair::Types(one.min(other), one.max(other))),
            (Some(one), None) => obstacle(second).map(|other| Pair::OnObstacle(one, other)),
            (None, Some(one)) => obstacle(first).map(|other| Pair::OnObstacle(one, other)),
            (None, None) => None,
        }
    }
}
