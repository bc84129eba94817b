//! A crash of the HDF5 library, told as what it is: the sign of a damaged file.
//!
//! HDF5 follows the addresses in a file, and not all that a damaged one can say is caught there. Then the system ends the
//! program with a signal. While a result is read the signal is answered with a message and exit 2.

use super::report::Form;
#[cfg(unix)]
use super::report::failure_text;
#[cfg(unix)]
use crate::error::{Error, Fault, Paint, render};
use std::path::Path;

/// Does what reads a file of the user, a result perhaps; should it crash, the program ends with exit 2 and says which file is damaged.
#[cfg(unix)]
pub fn told_as_damage<T>(command: &str, form: Form, file: &Path, read: impl FnOnce() -> T) -> T {
    let fault = Fault::new(format!("{} is damaged: reading it crashed the HDF5 library", file.display()));
    let error =
        Error::input(fault.help("copy it again if it was copied; otherwise run the experiment again with --force"));
    let object = if form == Form::Json { failure_text(command, &error) } else { String::new() };
    let _answer = unix::Answer::prepare(render(&error, Paint::Plain), object);
    read()
}

/// Elsewhere the system has its own words.
#[cfg(not(unix))]
pub fn told_as_damage<T>(_: &str, _: Form, _: &Path, read: impl FnOnce() -> T) -> T {
    read()
}

#[cfg(unix)]
mod unix {
    use std::mem::MaybeUninit;
    use std::ptr;
    use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};

    /// What a crash ends with: a wild address, one beyond the end of a file, a division, and what the allocator does when it
    /// finds its lists broken.
    const SIGNALS: [i32; 4] = [libc::SIGSEGV, libc::SIGBUS, libc::SIGFPE, libc::SIGABRT];

    /// What a crash says on standard error and on standard output, made before: a handler may not allocate. It is never freed,
    /// since a handler could be reading it.
    static WORDS: [Words; 2] = [const { Words::none() }; 2];

    struct Words {
        start: AtomicPtr<u8>,
        length: AtomicUsize,
    }

    impl Words {
        const fn none() -> Self {
            Self { start: AtomicPtr::new(ptr::null_mut()), length: AtomicUsize::new(0) }
        }

        fn set(&self, words: String) {
            let words = Box::leak(words.into_bytes().into_boxed_slice());
            self.length.store(0, Ordering::SeqCst);
            self.start.store(words.as_mut_ptr(), Ordering::SeqCst);
            self.length.store(words.len(), Ordering::SeqCst);
        }

        /// Writes them to a file of the system.
        fn say(&self, to: libc::c_int) {
            let (start, length) = (self.start.load(Ordering::SeqCst), self.length.load(Ordering::SeqCst));
            if length > 0 {
                // SAFETY: the words live as long as the program, and `write` may be called in a handler.
                unsafe { libc::write(to, start.cast(), length) };
            }
        }
    }

    /// Holds the answer to crashes for as long as it lives.
    pub struct Answer {
        before: Vec<(i32, libc::sigaction)>,
    }

    impl Answer {
        pub fn prepare(words: String, object: String) -> Self {
            WORDS[0].set(words);
            WORDS[1].set(object);
            Self { before: SIGNALS.iter().filter_map(|signal| answer(*signal)).collect() }
        }
    }

    impl Drop for Answer {
        fn drop(&mut self) {
            for (signal, action) in &self.before {
                // SAFETY: the action is the one that `answer` got from the same call.
                unsafe { libc::sigaction(*signal, action, ptr::null_mut()) };
            }
        }
    }

    /// Lets the handler answer a signal; what answered it before.
    fn answer(signal: i32) -> Option<(i32, libc::sigaction)> {
        let mut before = MaybeUninit::<libc::sigaction>::uninit();
        // SAFETY: all zeros are a valid action; both pointers lead to one, and the handler calls nothing but what a handler may.
        unsafe {
            let mut action: libc::sigaction = MaybeUninit::zeroed().assume_init();
            action.sa_sigaction = say_and_exit as extern "C" fn(libc::c_int) as usize;
            action.sa_flags = libc::SA_ONSTACK | libc::SA_RESETHAND;
            libc::sigemptyset(&mut action.sa_mask);
            match libc::sigaction(signal, &action, before.as_mut_ptr()) {
                0 => Some((signal, before.assume_init())),
                _ => None,
            }
        }
    }

    extern "C" fn say_and_exit(_: libc::c_int) {
        WORDS[0].say(2);
        WORDS[1].say(1);
        // SAFETY: `_exit` may be called in a handler.
        unsafe { libc::_exit(2) };
    }
}
