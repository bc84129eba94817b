//! What the reactions of a document work in.

use super::rows::ROW as WIDTH;
use crate::equations::program::{Lanes, Program};
use crate::ode::Method;
use crate::ode::scratch::Scratch;

/// What reactions work in, one for each part of the boxes.
#[derive(Debug, Clone)]
pub struct ReactorScratch {
    /// The program and method that it was made for.
    pub key: (u64, Option<Method>),
    /// Registers, states and matrices of a row of boxes.
    pub scratch: Scratch<WIDTH>,
    /// States now and before, and open quantities, of a row of boxes, for the engine's methods.
    pub states: Vec<Lanes<WIDTH>>,
    pub before: Vec<Lanes<WIDTH>>,
    pub open_values: Vec<Lanes<WIDTH>>,
}

impl ReactorScratch {
    /// Scratch for a program and method.
    pub fn new(key: (u64, Option<Method>), program: &Program) -> Self {
        let (states, open_values) = (vec![[0.0; WIDTH]; program.size()], vec![[0.0; WIDTH]; program.open.len()]);
        let scratch = Scratch::new(program, key.1.is_some_and(Method::is_implicit));
        Self { key, scratch, before: states.clone(), states, open_values }
    }
}
