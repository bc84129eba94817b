//! Methods that choose their steps by their error.

use pulp::Simd;

use super::control::{Controller, EXPLICIT, SIXTH, STIFF};
use super::scratch::{LooksBack, Scratch};
use super::{explicit, rosenbrock};
use crate::equations::program::{Lanes, Program};

/// What the loops over steps need to know of a method.
pub trait Adaptive {
    /// How it chooses the next step.
    const CONTROLLER: Controller;
    /// Evaluations of the rates in a step, without the first stage where that is the last of the step before.
    const RATES: u64;
    /// Factored Jacobians in a step.
    const JACOBIANS: u64;
    /// The stage that is the first of the next step, if there is one.
    const LAST: Option<usize>;
    /// Whether it can let values keep to their side of nothing.
    const KEEPS_SIDE: bool;

    /// One step from (time, state). Leaves proposal, error and stages; see the methods themselves.
    fn step<S: Simd, const L: usize, P: LooksBack<L>>(
        simd: S,
        program: &Program,
        s: &mut Scratch<L, P>,
        time: &Lanes<L>,
        step: &Lanes<L>,
    );
}

/// The explicit pair of order 5(4).
pub struct Tsitouras;

impl Adaptive for Tsitouras {
    const CONTROLLER: Controller = EXPLICIT;
    const RATES: u64 = 6;
    const JACOBIANS: u64 = 0;
    const LAST: Option<usize> = Some(6);
    const KEEPS_SIDE: bool = false;

    #[inline(always)]
    fn step<S: Simd, const L: usize, P: LooksBack<L>>(
        simd: S,
        program: &Program,
        s: &mut Scratch<L, P>,
        time: &Lanes<L>,
        step: &Lanes<L>,
    ) {
        explicit::tsitouras(simd, program, s, time, step);
    }
}

/// The explicit pair of order 6(5).
pub struct Verner;

impl Adaptive for Verner {
    const CONTROLLER: Controller = SIXTH;
    const RATES: u64 = 8;
    const JACOBIANS: u64 = 0;
    const LAST: Option<usize> = Some(8);
    const KEEPS_SIDE: bool = false;

    #[inline(always)]
    fn step<S: Simd, const L: usize, P: LooksBack<L>>(
        simd: S,
        program: &Program,
        s: &mut Scratch<L, P>,
        time: &Lanes<L>,
        step: &Lanes<L>,
    ) {
        explicit::verner(simd, program, s, time, step);
    }
}

/// The Rosenbrock method of order 4(3).
pub struct Rodas;

impl Adaptive for Rodas {
    const CONTROLLER: Controller = STIFF;
    const RATES: u64 = 6;
    const JACOBIANS: u64 = 1;
    const LAST: Option<usize> = None;
    const KEEPS_SIDE: bool = true;

    #[inline(always)]
    fn step<S: Simd, const L: usize, P: LooksBack<L>>(
        simd: S,
        program: &Program,
        s: &mut Scratch<L, P>,
        time: &Lanes<L>,
        step: &Lanes<L>,
    ) {
        rosenbrock::step(simd, program, s, time, step);
    }
}
