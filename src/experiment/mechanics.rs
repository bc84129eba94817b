//! What cells are made of: drag, mass, elasticity, the rule for their volume.

use super::loads::Selection;
use super::values::Course;
use crate::units::{Angle, Drag, Energy, LineStiffness, Mass, Stress, Volume};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The mechanics of a type of cells. Several elastic models may act together; none is on unless it is given.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Mechanics {
    /// Drag of the whole cell, shared equally by its atoms. Required unless the motion is inertial.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub drag: Option<Drag>,
    /// Mass of the whole cell, shared equally by its atoms. Required for inertial motion and under gravity.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub mass: Option<Mass>,
    /// Every atom is drawn to where its neighbours remember it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape_memory: Option<ShapeMemory>,
    /// An elastic membrane with physical moduli.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub membrane: Option<Membrane>,
    /// A spring on every edge of the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub springs: Option<Springs>,
    /// Keeps facets from collapsing and folding; does nothing in ordinary deformation.
    pub barrier: Barrier,
    /// What happens to the enclosed volume.
    pub volume: VolumeControl,
}

/// Shape memory: the force on an atom is a stiffness times its distance from the place that its neighbours give it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct ShapeMemory {
    /// How stiff.
    #[serde(flatten)]
    pub strength: ShapeStrength,
    /// What the neighbours feel.
    #[serde(default)]
    pub reaction: Reaction,
    /// How the remembered place is found.
    #[serde(default)]
    pub form: Form,
    /// The atoms that remember; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only: Option<Selection>,
}

impl ShapeMemory {
    /// Shape memory of this modulus, with the exact reaction and in the triplet form.
    pub fn of_modulus(modulus: LineStiffness) -> Self {
        let strength = ShapeStrength::ShapeModulus(modulus);
        Self { strength, reaction: Reaction::Exact, form: Form::Triplets, only: None }
    }
}

/// How stiff shape memory is: give one of the two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShapeStrength {
    /// A modulus that does not depend on the mesh.
    ShapeModulus(#[schemars(extend("x-minimum" = 0))] LineStiffness),
    /// The stiffness of every atom; the cell then softens as its mesh is refined.
    Stiffness(#[schemars(extend("x-minimum" = 0))] LineStiffness),
}

/// What the neighbours of an atom feel of its shape memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Reaction {
    /// The gradient of the energy: keeps momentum and angular momentum.
    #[default]
    Exact,
    /// The opposite force spread by the weights: keeps momentum only.
    Spread,
}

/// How the place that the neighbours remember is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Form {
    /// From every triplet of neighbours.
    #[default]
    Triplets,
    /// From two angles and a distance (α, β, γ) in the frame of the ordered neighbours.
    Angles,
}

/// An elastic membrane at the surface, at rest in the shape of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// The law of its energy.
    pub law: Law,
    /// Shear modulus µ at small strain.
    #[schemars(extend("x-minimum" = 0))]
    pub shear: LineStiffness,
    /// Modulus K of local area at small strain.
    #[schemars(extend("x-minimum" = 0))]
    pub area: LineStiffness,
    /// Strain hardening of the neo-Hookean law: cubic term over shear modulus.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub hardening: f64,
    /// Modulus of the total area, within which lipids flow.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub total_area: LineStiffness,
    /// Bending rigidity κ.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub bending: Energy,
    /// The shape without bending energy.
    #[serde(default)]
    pub bending_rest: BendingRest,
    /// Surface tension.
    #[serde(default)]
    pub tension: LineStiffness,
    /// Stiffness with which an atom is drawn along the surface to each neighbour, so that a surface without shear keeps its
    /// mesh in order; its shape is left alone. For closed meshes.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub ordering: LineStiffness,
}

impl Membrane {
    /// A membrane of this law with shear and area moduli, without bending, tension and hardening.
    pub fn new(law: Law, shear: LineStiffness, area: LineStiffness) -> Self {
        let (none, bending_rest) = (LineStiffness::ZERO, BendingRest::Shape);
        let (hardening, bending) = (0.0, Energy::ZERO);
        Self { law, shear, area, hardening, total_area: none, bending, bending_rest, tension: none, ordering: none }
    }
}

/// The law of a membrane's energy; both have the same response at small strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Law {
    /// Skalak (1973): hardens with the area.
    Skalak,
    /// Neo-Hookean, as rubber.
    NeoHookean,
}

/// The shape without bending energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum BendingRest {
    /// The mesh at rest.
    #[default]
    Shape,
    /// A plane.
    Flat,
}

/// A spring on every edge of the mesh, at rest in the shape of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Springs {
    /// Stiffness of each spring.
    #[schemars(extend("x-minimum" = 0))]
    pub stiffness: LineStiffness,
}

/// An energy that rises without bound before a facet collapses or an edge folds, and is zero in ordinary deformation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Barrier {
    /// Whether it acts.
    pub active: bool,
    /// Its strength; follows the elasticity when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub stiffness: Option<LineStiffness>,
    /// The area of a facet, over its area at rest, below which it acts.
    #[schemars(range(max = 0.9), extend("exclusiveMinimum" = 0))]
    pub area: f64,
    /// The fold between two facets (0 when flat) above which it acts.
    #[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = std::f64::consts::PI))]
    pub angle: Angle,
}

impl Default for Barrier {
    fn default() -> Self {
        Self { active: true, stiffness: None, area: 0.2, angle: Angle::new(0.5 * std::f64::consts::PI) }
    }
}

/// What happens to the enclosed volume.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VolumeControl {
    /// The rule; exact for closed surfaces and free for open ones when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<VolumeRule>,
    /// Bulk modulus of the compressible rule.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub modulus: Option<Stress>,
    /// The volume to keep, or its course in time; the volume at rest when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Course<Volume>>,
    /// The same as a multiple of the volume at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Course<f64>>,
}

/// A rule for the enclosed volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum VolumeRule {
    /// The volume is the target at the end of every step, to round-off.
    Exact,
    /// A pressure proportional to the relative change of volume.
    Compressible,
    /// Nothing keeps the volume.
    Free,
}
