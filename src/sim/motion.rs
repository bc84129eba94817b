//! The stage that moves atoms freely: by what forces do to them, as if contacts and constraints were not there.

use super::implicit::advance_implicitly;
use super::inertial::advance_explicitly;
use super::model::Model;
use super::state::State;
use super::workspace::Workspace;
use crate::mechanics::integrator::Method;

/// Moves all atoms freely by one step. Returns the largest error estimate over the mean edge, 0 for schemes without one.
pub fn move_freely(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) -> f64 {
    match model.integrator.method {
        Method::Implicit { order } => advance_implicitly(model, dt, order, from, to, ws),
        _ => {
            advance_explicitly(model, dt, from, to, ws);
            0.0
        }
    }
}
