//! Reading in a process apart. The HDF5 library follows the addresses in a file, and crashes in some that are damaged; the program answers
//! that with a message and exit 2 (`src/cli/crash.rs`), so here it must not end the fuzzer. What is ours (a panic, a wait, memory) must.
//!
//! The counters of coverage lie in memory that both processes share, so that libFuzzer sees what the child has reached.

use std::time::{Duration, Instant};

/// Exit of a child that panicked.
const PANICKED: i32 = 77;
/// The most memory of a child: what our own allocator does not count is HDF5's.
const MOST_KILOBYTES: i64 = 1_000_000;
/// Within this time a child has to end. libFuzzer's own limit ends the parent.
const PATIENCE: Duration = Duration::from_secs(10);

/// How reading in another process ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// By itself.
    Well,
    /// By a signal: HDF5 crashed, since Rust's own crashes come with a panic, or are told apart by it.
    Crashed(i32),
}

/// Does `work` in a child.
///
/// # Panics
/// If the child panicked, took too long or too much memory.
pub fn apart(work: impl FnOnce()) -> Ended {
    let began = Instant::now();
    // SAFETY: this process has one thread; `_exit` leaves everything of the parent alone.
    let child = unsafe { libc::fork() };
    assert!(child >= 0, "a process can be started");
    if child == 0 {
        prepare_child();
        work();
        // SAFETY: may be called anywhere.
        unsafe { libc::_exit(0) };
    }
    let mut status = 0;
    // SAFETY: all zeros are a valid `rusage`, and both pointers lead to what is to be filled.
    let used = unsafe {
        let mut used: libc::rusage = std::mem::zeroed();
        libc::wait4(child, &mut status, 0, &mut used);
        used
    };
    assert!(used.ru_maxrss < MOST_KILOBYTES, "{} kB of memory were used", used.ru_maxrss);
    assert!(began.elapsed() < PATIENCE, "it took {:?}", began.elapsed());
    if libc::WIFSIGNALED(status) {
        return Ended::Crashed(libc::WTERMSIG(status));
    }
    assert!(libc::WEXITSTATUS(status) != PANICKED, "the process apart has panicked");
    Ended::Well
}

/// In the child a panic ends it with its own exit, signals end it as they do by default, and nothing outlives the parent.
fn prepare_child() {
    // The hook of libFuzzer would abort, which is what the allocator does when HDF5 has broken its lists.
    std::panic::set_hook(Box::new(move |panic| {
        eprintln!("{panic}\n{}", std::backtrace::Backtrace::force_capture());
        // SAFETY: may be called anywhere.
        unsafe { libc::_exit(PANICKED) };
    }));
    // SAFETY: signals are set to what they do by default.
    unsafe {
        for signal in [libc::SIGSEGV, libc::SIGBUS, libc::SIGFPE, libc::SIGABRT, libc::SIGILL] {
            libc::signal(signal, libc::SIG_DFL);
        }
        #[cfg(target_os = "linux")]
        libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
    }
}

/// Puts the counters of coverage into memory that children share. Those at the ends, which share a page with other data, stay.
#[cfg(fuzzing)]
pub fn share_counters() {
    unsafe extern "C" {
        #[link_name = "__start___sancov_cntrs"]
        static mut FIRST: u8;
        #[link_name = "__stop___sancov_cntrs"]
        static mut END: u8;
    }
    const PAGE: usize = 4096;
    let (first, end) = (&raw mut FIRST as usize, &raw mut END as usize);
    let (first, end) = (first.next_multiple_of(PAGE), end / PAGE * PAGE);
    if first >= end {
        return;
    }
    // SAFETY: the pages hold counters and nothing else; they are copied out, mapped anew at the same address, and copied back.
    unsafe {
        let length = end - first;
        let kept = std::slice::from_raw_parts(first as *const u8, length).to_vec();
        let flags = libc::MAP_SHARED | libc::MAP_ANONYMOUS | libc::MAP_FIXED;
        let shared = libc::mmap(first as *mut _, length, libc::PROT_READ | libc::PROT_WRITE, flags, -1, 0);
        assert!(shared as usize == first, "memory can be shared");
        std::ptr::copy_nonoverlapping(kept.as_ptr(), first as *mut u8, length);
    }
}

/// Without instrumentation there are no counters.
#[cfg(not(fuzzing))]
pub fn share_counters() {}
