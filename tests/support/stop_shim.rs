//! A library that is put before the system's (LD_PRELOAD) and kills the process in front of the Nth call by which files are
//! changed: PSEUDOPOD_TEST_STOP says which. With PSEUDOPOD_TEST_HALF a write is half done first. PSEUDOPOD_TEST_CRASH lets the
//! process crash where HDF5 reads a file, as a damaged one may. Compiled by `tests/processes/shim.rs`; it uses nothing but the
//! C library.

use std::ffi::{CStr, c_char, c_int, c_long, c_uint, c_void};
use std::sync::atomic::{AtomicI64, Ordering};

unsafe extern "C" {
    fn dlsym(handle: *mut c_void, name: *const c_char) -> *mut c_void;
    fn getenv(name: *const c_char) -> *const c_char;
    fn atoll(text: *const c_char) -> i64;
    fn getpid() -> c_int;
    fn kill(process: c_int, signal: c_int) -> c_int;
}

/// The next library that has the name: the system's.
const NEXT: *mut c_void = -1_isize as *mut c_void;
const SIGKILL: c_int = 9;
const SIGSEGV: c_int = 11;
/// Calls that are still to be let through; negative: all.
static LEFT: AtomicI64 = AtomicI64::new(i64::MIN);

fn number(name: &CStr) -> i64 {
    let text = unsafe { getenv(name.as_ptr()) };
    if text.is_null() { -1 } else { unsafe { atoll(text) } }
}

fn die() -> ! {
    unsafe { kill(getpid(), SIGKILL) };
    loop {}
}

/// Whether this is the call to be stopped at.
fn is_last() -> bool {
    if LEFT.load(Ordering::SeqCst) == i64::MIN {
        LEFT.store(number(c"PSEUDOPOD_TEST_STOP"), Ordering::SeqCst);
    }
    LEFT.load(Ordering::SeqCst) > 0 && LEFT.fetch_sub(1, Ordering::SeqCst) == 1
}

/// How much of a write is done before the end, if this call is the last.
fn cut(length: usize) -> usize {
    if number(c"PSEUDOPOD_TEST_HALF") > 0 { length / 2 } else { 0 }
}

macro_rules! writes {
    ($($name:ident as $text:literal ($file:ident, $data:ident, $length:ident $(, $rest:ident: $kind:ty)*);)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($file: c_int, $data: *const c_void, $length: usize $(, $rest: $kind)*) -> isize {
            type Call = unsafe extern "C" fn(c_int, *const c_void, usize $(, $kind)*) -> isize;
            let call: Call = unsafe { std::mem::transmute(dlsym(NEXT, $text.as_ptr())) };
            if is_last() {
                if cut($length) > 0 {
                    unsafe { call($file, $data, cut($length) $(, $rest)*) };
                }
                die();
            }
            unsafe { call($file, $data, $length $(, $rest)*) }
        }
    )*};
}

macro_rules! changes {
    ($($name:ident as $text:literal ($($of:ident: $kind:ty),*) -> $back:ty;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($of: $kind),*) -> $back {
            type Call = unsafe extern "C" fn($($kind),*) -> $back;
            if is_last() {
                die();
            }
            let call: Call = unsafe { std::mem::transmute(dlsym(NEXT, $text.as_ptr())) };
            unsafe { call($($of),*) }
        }
    )*};
}

/// HDF5 reads at places; the standard library of Rust does not.
macro_rules! reads {
    ($($name:ident as $text:literal;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(file: c_int, data: *mut c_void, length: usize, at: i64) -> isize {
            type Call = unsafe extern "C" fn(c_int, *mut c_void, usize, i64) -> isize;
            if number(c"PSEUDOPOD_TEST_CRASH") > 0 {
                unsafe { kill(getpid(), SIGSEGV) };
            }
            let call: Call = unsafe { std::mem::transmute(dlsym(NEXT, $text.as_ptr())) };
            unsafe { call(file, data, length, at) }
        }
    )*};
}

reads! {
    pread as c"pread";
    pread64 as c"pread64";
}

writes! {
    write as c"write" (file, data, length);
    pwrite as c"pwrite" (file, data, length, at: i64);
    pwrite64 as c"pwrite64" (file, data, length, at: i64);
}

changes! {
    writev as c"writev" (file: c_int, parts: *const c_void, number: c_int) -> isize;
    copy_file_range as c"copy_file_range" (from: c_int, from_at: *mut i64, to: c_int, to_at: *mut i64, length: usize, flags: c_uint) -> isize;
    sendfile as c"sendfile" (to: c_int, from: c_int, at: *mut i64, length: usize) -> isize;
    sendfile64 as c"sendfile64" (to: c_int, from: c_int, at: *mut i64, length: usize) -> isize;
    ftruncate as c"ftruncate" (file: c_int, length: c_long) -> c_int;
    ftruncate64 as c"ftruncate64" (file: c_int, length: i64) -> c_int;
    rename as c"rename" (from: *const c_char, to: *const c_char) -> c_int;
    unlink as c"unlink" (path: *const c_char) -> c_int;
    fsync as c"fsync" (file: c_int) -> c_int;
    fdatasync as c"fdatasync" (file: c_int) -> c_int;
}
