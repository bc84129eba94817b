//! What the program says of a fault of its own: no input, however wrong, is answered with the traces of a panic.

use crate::error::{Error, say};
use std::panic::{PanicHookInfo, catch_unwind, set_hook};
use std::sync::{Mutex, PoisonError};

/// What the first panic said, until it is told.
static SAID: Mutex<Option<String>> = Mutex::new(None);

/// From now on a panic, in whatever thread, leaves its words and its place for [`guarded`], and prints nothing itself but where the variable
/// RUST_BACKTRACE asks for the calls that led to it.
pub fn listen() {
    set_hook(Box::new(|panic| {
        let words = words(panic);
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0") {
            say(&format!("{words}\n{}", std::backtrace::Backtrace::force_capture()));
        }
        SAID.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(words);
    }));
}

/// What a panic says, and where in the code it arose.
fn words(panic: &PanicHookInfo) -> String {
    let payload = panic.payload();
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no words");
    match panic.location() {
        Some(at) => format!("{text} ({}:{})", at.file(), at.line()),
        None => text.to_owned(),
    }
}

/// Does some work; a panic in it becomes an error that asks for a report.
///
/// # Errors
/// [`Error::Machine`], exit status 1, with the words of the panic.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Error> {
    // Nothing that the work changed is looked at again: the program says why, and ends.
    catch_unwind(std::panic::AssertUnwindSafe(work)).map_err(|_| {
        let said = SAID.lock().unwrap_or_else(PoisonError::into_inner).take();
        own_fault(&said.unwrap_or_else(|| "no words".to_owned()))
    })
}

/// The report that is asked for.
fn own_fault(said: &str) -> Error {
    let (version, system) = (env!("CARGO_PKG_VERSION"), std::env::consts::OS);
    Error::Machine {
        message: format!("pseudopod has a fault of its own: {said}; version {version}, {system}"),
        help: "your input may be good, and no input should lead here: please send these lines and the document to those who \
               maintain pseudopod; what a run has recorded until then is kept, and `pseudopod resume` may go on from it"
            .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_that_asks_for_a_report() {
        let Err(error) = guarded(|| -> u8 { panic!("the cell is {}", "inside out") }) else { panic!("it was caught") };
        assert_eq!(error.exit_code(), 1);
        assert!(error.to_string().starts_with("pseudopod has a fault of its own"), "{error}");
        assert_eq!(guarded(|| 7).ok(), Some(7));
    }
}
