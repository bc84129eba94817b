//! Tests that start other programs take turns with those that write result files: HDF5 locks the files it opens, and a
//! child inherits the locks of its parent.

use std::sync::{Mutex, MutexGuard, PoisonError};

static TURN: Mutex<()> = Mutex::new(());

/// Waits for the other tests of this program that take turns, and holds them until the guard is dropped.
pub fn take_turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}
