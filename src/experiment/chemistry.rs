//! Equations and fields that take part in an experiment: which documents, how they are solved, and how they are joined
//! to cells.

use crate::units::{Length, Time};
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A document of equations or of fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chemistry {
    /// The document, relative to this one: EML, or an SBML model.
    #[schemars(extend("x-text" = "file"))]
    pub document: PathBuf,
    /// Parameters and initial values that replace the document's, in its units.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub set: IndexMap<String, f64>,
    /// How the equations are solved; otherwise as the document says, else rosenbrock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<Scheme>,
    /// Relative tolerance; otherwise as the document says, else 1e-6, and 1e-3 for a step of fields.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-13, max = 0.5))]
    pub rtol: Option<f64>,
    /// Absolute tolerance in the units of the document; otherwise as the document says, else 1e-9, and 1e-6 for a step of
    /// fields.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub atol: Option<f64>,
    /// Step of rk4 and euler, and of fields where it is to be fixed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub inner_step: Option<Time>,
    /// Time between two kicks of noise; otherwise as the document says, else every step, or exchange of a system that has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub noise_step: Option<Time>,
    /// Time between two exchanges of numbers with cells and fields; otherwise as the document says, else every step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub exchange: Option<Time>,
    /// Lower corner of a grid whose document leaves it open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<[Length; 3]>,
    /// Lengths of the sides of a grid whose document leaves them open; the third does not count in 2-D.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub size: Option<[Length; 3]>,
    /// What joins the system to cells and fields, besides the links in the document.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<ChemistryLink>,
}

/// How equations are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Scheme {
    /// Explicit Runge–Kutta of order 5, finds its step.
    Rk45,
    /// Explicit Runge–Kutta of order 6, finds its step: for tight tolerances.
    Rk65,
    /// Rosenbrock, for stiff systems, finds its step.
    Rosenbrock,
    /// Explicit Runge–Kutta of order 4 with `inner_step`.
    Rk4,
    /// Explicit Euler with `inner_step`.
    Euler,
}

/// Carries a number from one end to the other at each exchange.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChemistryLink {
    /// Where the number comes from, such as "cell.volume" or "system.U".
    pub from: String,
    /// Where it goes, such as "system.stretch" or "cell.stiffness"; one of the ends is in the system.
    pub to: String,
    /// What becomes of it: an expression of `value` and the system's quantities; "value" when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer: Option<String>,
    /// Factor of what the transfer gives; 1 when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
}
