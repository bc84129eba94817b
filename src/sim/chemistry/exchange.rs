//! When systems exchange numbers with the model.

use super::super::model::Model;
use super::model::Reactor;

/// The next time after `time` at which a system exchanges numbers with the model, s; a step ends there.
pub fn next_exchange(model: &Model, time: f64) -> f64 {
    let next = |every: f64| ((time / every * (1.0 + 1e-12)).floor() + 1.0) * every;
    model.chemistry.reactors.iter().filter_map(|reactor| reactor.exchange).map(next).fold(f64::INFINITY, f64::min)
}

/// Whether a system exchanges numbers with the model at a time.
pub(super) fn is_due(reactor: &Reactor, time: f64) -> bool {
    reactor.exchange.is_none_or(|every| {
        let count = time / every;
        (count - count.round()).abs() <= 1e-9 * count.abs().max(1.0)
    })
}
