//! The run itself: duration, integrator, what acts everywhere, what is recorded.

use crate::units::{Acceleration, Force, Length, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How long and with which integrator to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Simulated time at the end.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub until: Time,
    /// Ends the run before, once the cells are in mechanical equilibrium.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equilibrium: Option<Equilibrium>,
    /// How the atoms are moved in time.
    #[serde(default)]
    pub integrator: Integrator,
}

/// When cells count as being in equilibrium.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equilibrium {
    /// The largest force on an atom that may be out of balance: what its drag answers, and what is viscous, in the mean over a step.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub force: Force,
}

/// How the atoms are moved in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Integrator {
    /// The method.
    pub method: Method,
    /// Order of the implicit method: 2 has an error estimate and adapts, 1 costs half and needs a fixed step.
    #[schemars(range(min = 1, max = 2))]
    pub order: u8,
    /// A fixed step. Without it the implicit method adapts and the others choose a stable step, which contacts shorten where atoms
    /// would travel too far.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub step: Option<Time>,
    /// Error that the adaptive method allows in a step, over the mean length of an edge.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub tolerance: f64,
    /// The longest step, where none is fixed.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub max_step: Option<Time>,
    /// Runs even when the fixed step is known to be unstable.
    pub allow_unstable: bool,
}

impl Default for Integrator {
    fn default() -> Self {
        Self { method: Method::Implicit, order: 2, step: None, tolerance: 3e-3, max_step: None, allow_unstable: false }
    }
}

/// A method of integration. The first two are for motion without inertia, the others for motion with mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Method {
    /// Linearly implicit, over-damped: large steps, adaptive.
    #[default]
    Implicit,
    /// Explicit Euler, over-damped.
    Explicit,
    /// Explicit Euler with mass.
    Euler,
    /// Semi-implicit (symplectic) Euler with mass.
    SemiImplicitEuler,
    /// Velocity Verlet with mass.
    Verlet,
    /// The classical Runge–Kutta method of fourth order with mass.
    #[serde(rename = "runge_kutta_4")]
    RungeKutta4,
}

impl Method {
    /// Whether the method moves masses; the others balance forces with drag.
    pub fn is_inertial(self) -> bool {
        matches!(self, Self::Euler | Self::SemiImplicitEuler | Self::Verlet | Self::RungeKutta4)
    }
}

/// What acts everywhere.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Environment {
    /// Acceleration of everything that has mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[Acceleration; 3]>,
}

/// A rigid plane that no atom passes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Its name in the result.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// Any of its points.
    pub point: [Length; 3],
    /// Points to the free side; its length does not matter.
    pub normal: [f64; 3],
}

/// What is recorded, and how often. The positions of all atoms always are.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = {
    "positions": "remove the key: positions are always recorded; for a smaller file make `every` longer",
}))]
pub struct Output {
    /// Simulated time between frames, which are at exactly its multiples; a hundredth of the run when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub every: Option<Time>,
    /// Times of more frames; where only these are given, the start and the end have one besides them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub times: Vec<Time>,
    /// Simulated time between checkpoints to resume from; a tenth of the run when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub checkpoint: Option<Time>,
    /// Records the force on every atom.
    pub forces: bool,
    /// Records what cells do to what they stand on and to each other, and the drag of the medium, at every atom and of every cell.
    pub tractions: bool,
}
