//! What cells are made of: drag, mass, elasticity, the rule for their volume. What documents say of it, and the forces that it means.

use super::compile::Builder;
use super::membrane::Membrane;
use super::rigid::Rigid;
use super::selection::Selection;
use super::solid::{Neighbours, Solid};
use super::viscosity::Viscosity;
use super::volume::VolumeControl;
use crate::geometry;
use crate::mechanics::angles::Angles;
use crate::mechanics::barrier::BarrierRules;
use crate::mechanics::shape_modulus::stiffness_of_modulus;
use crate::mechanics::{Force, barrier, shape_memory, springs, sum};
use crate::units::{Angle, Drag, LineStiffness, Mass};
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
    /// An elastic material that fills the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid: Option<Solid>,
    /// The surface is viscous, or what fills the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<Viscosity>,
    /// The cell never changes its shape: a tool, or a bead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rigid: Option<Rigid>,
    /// Keeps facets from collapsing and folding; does nothing in ordinary deformation.
    pub barrier: Barrier,
    /// What happens to the enclosed volume.
    pub volume: VolumeControl,
}

impl Mechanics {
    /// Whether anything is viscous.
    pub(super) fn is_viscous(&self) -> bool {
        let regions = self.solid.iter().flat_map(|solid| &solid.regions);
        self.viscosity.is_some_and(Viscosity::is_any)
            || regions.filter_map(|region| region.viscosity).any(|viscosity| viscosity.value() > 0.0)
    }
}

/// Shape memory: the force on an atom is a stiffness times its distance from the target that its neighbours define.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct ShapeMemory {
    /// How stiff.
    #[serde(flatten)]
    pub strength: ShapeStrength,
    /// What the neighbours feel.
    #[serde(default)]
    pub reaction: Reaction,
    /// How the remembered target is found.
    #[serde(default)]
    pub form: Form,
    /// The atoms that remember; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only: Option<Selection>,
    /// Who is whose neighbour in a filled body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neighbours: Option<Neighbours>,
}

impl ShapeMemory {
    /// Shape memory of this modulus, with the exact reaction and in the triplet form.
    pub fn of_modulus(modulus: LineStiffness) -> Self {
        let strength = ShapeStrength::ShapeModulus(modulus);
        Self { strength, reaction: Reaction::Exact, form: Form::Triplets, only: None, neighbours: None }
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

/// How the target that the neighbours remember is found.
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

/// A spring on every edge of the mesh, or between all neighbours of a filled body, at rest in the shape of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Springs {
    /// Stiffness of each spring.
    #[schemars(extend("x-minimum" = 0))]
    pub stiffness: LineStiffness,
    /// Which pairs of atoms of a filled body have one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neighbours: Option<Neighbours>,
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

impl Mechanics {
    /// Adds the forces that answer to the shape of a cell, but for the barrier.
    pub(super) fn add_elastic(&self, to: &mut Builder) {
        if let Some(memory) = &self.shape_memory {
            memory.add(to);
        }
        if let Some(membrane) = &self.membrane {
            membrane.add(to);
        }
        if let Some(springs) = &self.springs {
            springs.add(to);
        }
        if let Some(solid) = &self.solid {
            solid.add(to);
        }
    }
}

impl ShapeMemory {
    fn add(&self, to: &mut Builder) {
        let rest = to.rest();
        let mut rings = match Neighbours::pairs_of(self.neighbours, "mechanics.shape_memory.neighbours", to) {
            Some(pairs) => neighbours_of(rest.positions.len(), &pairs),
            None => to.topology.rings.iter().map(|ring| ring.atoms.clone()).collect(),
        };
        let stiffness = match self.strength {
            ShapeStrength::Stiffness(stiffness) => Some(stiffness.value()),
            ShapeStrength::ShapeModulus(modulus) => stiffness_of_modulus(rest, &rings, modulus.value()),
        };
        let Some(stiffness) = stiffness else {
            let found = "a flat mesh has no shape modulus: its shape memory does not resist stretching";
            let help = "give shape_memory = { stiffness = \"…\" }, or use membrane or springs";
            return to.fault("mechanics.shape_memory", "on a flat mesh", found, help);
        };
        if let Some(only) = &self.only {
            let chosen = to.atoms("mechanics.shape_memory.only", only);
            // An atom without neighbours remembers nothing.
            (0..rings.len()).filter(|atom| !chosen.contains(&(*atom as u32))).for_each(|atom| rings[atom].clear());
        }
        if self.form == Form::Angles {
            return to.forces.push(Force::Angles(Angles::new(&rest.positions, &rings, stiffness)));
        }
        let reaction = match self.reaction {
            Reaction::Exact => shape_memory::Reaction::Exact,
            Reaction::Spread => shape_memory::Reaction::Spread,
        };
        let triplets = shape_memory::ShapeMemory::new(&rest.positions, &rings, stiffness, reaction);
        if triplets.triplet_count() == 0 {
            let found = "no atom remembers anything: triplets take three neighbours that are not in line";
            let help = "use form = \"angles\", which takes two neighbours, or other atoms";
            to.fault("mechanics.shape_memory", "acts on no atom of this mesh", found, help);
        }
        to.forces.push(Force::ShapeMemory(triplets));
    }
}

impl Springs {
    fn add(&self, to: &mut Builder) {
        let pairs = Neighbours::pairs_of(self.neighbours, "mechanics.springs.neighbours", to);
        let edges = pairs.as_ref().unwrap_or(&to.topology.edges);
        let springs = springs::Springs::on_edges(&to.rest().positions, edges, self.stiffness.value());
        to.forces.push(Force::Springs(springs));
    }
}

/// The neighbours of each of so many atoms, rising, from pairs.
fn neighbours_of(atoms: usize, pairs: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut all = vec![Vec::new(); atoms];
    for &[a, b] in pairs {
        all[a as usize].push(b);
        all[b as usize].push(a);
    }
    all.iter_mut().for_each(|own| own.sort_unstable());
    all
}

/// The energy scale of the barrier where the document names none: this part of the elastic energy that moves an atom
/// by an edge, so that the barrier is as stiff as the cell that it guards.
const BARRIER_SHARE: f64 = 0.1;

impl Barrier {
    /// Adds the barrier for the elastic forces that are there.
    pub(super) fn add(&self, to: &mut Builder) {
        let rest = to.rest();
        let edge = geometry::mean_edge_length(rest);
        let stiffness = match self.stiffness {
            Some(stiffness) => stiffness.value(),
            None => {
                let matrix = sum::stiffness(&to.forces, &rest.positions, &rest.positions);
                BARRIER_SHARE * (0..rest.positions.len()).map(|i| matrix.diagonal(i)).fold(0.0, f64::max)
            }
        };
        if !self.active || stiffness == 0.0 {
            return;
        }
        let (energy, fold_angle) = (stiffness * edge * edge, self.angle.value());
        let rules = BarrierRules { energy, area_share: self.area, fold_angle };
        let barrier = barrier::Barrier::new(&rest.positions, &rest.facets, &to.topology.flaps, rules);
        to.forces.push(Force::Barrier(barrier));
    }
}
