//! How a simulation is asked, from anywhere, to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks a simulation to stop after the step it is at. Clones ask the same simulations.
///
/// ```
/// use pseudopod::simulation::CancelToken;
///
/// let token = CancelToken::new();
/// let of_another_thread = token.clone();
/// std::thread::spawn(move || of_another_thread.cancel()).join().unwrap();
/// assert!(token.is_cancelled());
/// ```
#[derive(Debug, Clone, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// A token that nobody has cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks to stop. It stays asked: to go on, give the simulation a new token.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
