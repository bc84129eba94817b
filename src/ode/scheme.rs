//! The schemes for single systems, by name.

use serde::{Deserialize, Serialize};

use super::Method;

/// How a single system is solved.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Scheme {
    /// One of our one-step methods.
    OneStep(Method),
    /// Backward differentiation of variable order, by diffsol; for systems without events.
    Bdf,
    /// A singly diagonally implicit Runge–Kutta method of order 4(3), by diffsol; for systems without events.
    Esdirk34,
    /// The pair of trapezoidal rule and BDF2, by diffsol; for systems without events.
    TrBdf2,
    /// The explicit pair of Tsitouras, by diffsol; for systems without events.
    Tsit45,
}

impl Scheme {
    /// Whether matrices are factored.
    pub fn is_implicit(self) -> bool {
        match self {
            Self::OneStep(method) => method.is_implicit(),
            Self::Bdf | Self::Esdirk34 | Self::TrBdf2 => true,
            Self::Tsit45 => false,
        }
    }

    /// Whether this build solves with it: those of diffsol need the feature of that name.
    pub fn is_built_in(self) -> bool {
        cfg!(feature = "diffsol") || matches!(self, Self::OneStep(_))
    }

    /// The scheme of a name: `rk45`, `rk65`, `rosenbrock`, `bdf`, `esdirk34`, `tr-bdf2`, `tsit45`, and with an inner step
    /// `rk4` and `euler`.
    pub fn named(name: &str, inner_step: Option<f64>) -> Option<Self> {
        let positive = inner_step.filter(|step| *step > 0.0);
        match name {
            "rk45" => Some(Self::OneStep(Method::Rk45)),
            "rk65" => Some(Self::OneStep(Method::Rk65)),
            "rosenbrock" => Some(Self::OneStep(Method::Rosenbrock)),
            "rk4" => positive.map(|step| Self::OneStep(Method::Rk4 { step })),
            "euler" => positive.map(|step| Self::OneStep(Method::Euler { step })),
            "bdf" => Some(Self::Bdf),
            "esdirk34" => Some(Self::Esdirk34),
            "tr-bdf2" => Some(Self::TrBdf2),
            "tsit45" => Some(Self::Tsit45),
            _ => None,
        }
    }
}
