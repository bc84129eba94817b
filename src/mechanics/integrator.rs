//! The schemes that move atoms in time.

/// How a step is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Over-damped, linearly implicit, eq. (step.2) and (step.3).
    Implicit {
        /// One (linearly implicit Euler) or two stages (the W-method).
        order: Order,
    },
    /// Over-damped, explicit Euler.
    Explicit,
    /// Inertial, explicit Euler.
    Euler,
    /// Inertial, velocities first and positions with the new velocities.
    SemiImplicitEuler,
    /// Inertial, velocity Verlet with the drag inside.
    Verlet,
    /// Inertial, the classical fourth-order Runge–Kutta scheme.
    RungeKutta4,
}

/// The order of the implicit scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// One force and one solve a step, eq. (step.2).
    First,
    /// Two forces and two solves a step, with an error estimate, eq. (step.3).
    #[default]
    Second,
}

impl Method {
    /// Whether atoms have velocities of their own.
    pub fn is_inertial(self) -> bool {
        !matches!(self, Self::Implicit { .. } | Self::Explicit)
    }
}

/// How the size of a step is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepSize {
    /// Always the same, s.
    Fixed(f64),
    /// From the error estimate: an error a step below `tolerance` times the mean edge, never above `largest`, s.
    Adaptive {
        /// Error a step over the mean edge length.
        tolerance: f64,
        /// Largest step, s.
        largest: f64,
    },
}

impl StepSize {
    /// The longest step that may be made, s.
    pub fn longest(self) -> f64 {
        match self {
            Self::Fixed(step) => step,
            Self::Adaptive { largest, .. } => largest,
        }
    }
}

/// Scheme and step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integrator {
    /// The scheme.
    pub method: Method,
    /// The step.
    pub size: StepSize,
}
