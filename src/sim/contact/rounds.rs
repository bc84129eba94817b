//! Short jobs in rounds on several threads: what a round does may begin when the one before is done.
//!
//! A round of a sweep takes some ten microseconds, in which a thread that sleeps does not wake up. So threads that help stay awake from the first
//! round to the last. None of them is waited for: what it has not begun others do.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Looks for a job after which a thread lets others have its processor for a moment.
const PATIENCE: u32 = 200;

/// Jobs that are numbered through all rounds.
#[derive(Default)]
struct Rounds {
    /// The next job to be taken.
    next: AtomicUsize,
    /// One behind the last job that may be taken; all taken and none left where this is the largest number.
    end: AtomicUsize,
    /// Jobs done.
    done: AtomicUsize,
}

/// A job counts as done whatever became of it: nobody waits for one that failed.
struct Counted<'a>(&'a AtomicUsize);

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Release);
    }
}

/// All rounds are over, also where a job of the one who leads failed: those who help go home.
struct Over<'a>(&'a AtomicUsize);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(usize::MAX, Ordering::Release);
    }
}

impl Rounds {
    /// Takes a job and does it, if there is one.
    fn take(&self, work: &impl Fn(usize)) -> bool {
        let next = self.next.load(Ordering::Relaxed);
        let end = self.end.load(Ordering::Acquire);
        if next >= end || end == usize::MAX {
            return false;
        }
        if self.next.compare_exchange(next, next + 1, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
            let _counted = Counted(&self.done);
            work(next);
        }
        true
    }

    /// Does all rounds, with whoever helps.
    fn lead(&self, rounds: impl Iterator<Item = Range<usize>>, work: &impl Fn(usize)) {
        let _over = Over(&self.end);
        for round in rounds {
            self.end.store(round.end, Ordering::Release);
            while self.take(work) {}
            let mut looks = 0;
            while self.done.load(Ordering::Acquire) < round.end {
                wait(&mut looks);
            }
        }
    }

    /// Does jobs until the last round is over.
    fn help(&self, work: &impl Fn(usize)) {
        let mut looks = 0;
        while self.end.load(Ordering::Acquire) != usize::MAX {
            match self.take(work) {
                true => looks = 0,
                false => wait(&mut looks),
            }
        }
    }
}

fn wait(looks: &mut u32) {
    *looks += 1;
    if looks.is_multiple_of(PATIENCE) {
        std::thread::yield_now();
    } else {
        std::hint::spin_loop();
    }
}

/// Does `work` with the number of each job, round by round: jobs of a round at the same time, all before the first of the next. Rounds
/// follow each other without gaps, from job 0 on.
pub fn in_rounds(rounds: impl Iterator<Item = Range<usize>> + Send, work: impl Fn(usize) + Sync) {
    let threads = rayon::current_num_threads();
    if threads == 1 {
        return rounds.flatten().for_each(work);
    }
    let all = Rounds::default();
    let mut rounds = Some(rounds);
    let mut lead = || rounds.take().into_iter().for_each(|rounds| all.lead(rounds, &work));
    with_helpers(threads - 1, &mut lead, &|| all.help(&work));
}

/// Leads on this thread while others, where any are idle, help.
fn with_helpers(helpers: usize, lead: &mut (dyn FnMut() + Send), help: &(dyn Fn() + Sync)) {
    match helpers {
        0 => lead(),
        _ => drop(rayon::join(|| with_helpers(helpers - 1, lead, help), help)),
    }
}

#[cfg(test)]
mod tests {
    use super::in_rounds;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn in_pool(threads: usize, work: impl FnOnce() + Send) {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work);
    }

    #[test]
    fn every_job_is_done_once_and_after_all_of_the_rounds_before() {
        for threads in [1, 2, 5] {
            in_pool(threads, || {
                for _ in 0..200 {
                    let ends = [3, 3, 10, 11, 40];
                    let starts = [0].into_iter().chain(ends);
                    let done: Vec<AtomicUsize> = (0..40).map(|_| AtomicUsize::new(0)).collect();
                    in_rounds(starts.zip(ends).map(|(start, end)| start..end), |job| {
                        let before = ends.iter().filter(|end| **end <= job).max().copied().unwrap_or(0);
                        assert!(done[..before].iter().all(|done| done.load(Ordering::Relaxed) == 1), "{job}");
                        done[job].fetch_add(1, Ordering::Relaxed);
                    });
                    assert!(done.iter().all(|done| done.load(Ordering::Relaxed) == 1));
                }
            });
        }
    }

    #[test]
    fn a_job_that_fails_is_told_and_stops_nobody() {
        let caught = std::panic::catch_unwind(|| {
            in_pool(2, || in_rounds([0..4, 4..8].into_iter(), |job| assert!(job != 5, "this one")));
        });
        assert!(caught.is_err());
    }

    #[test]
    fn those_who_lead_at_the_same_time_in_a_pool_do_not_wait_for_each_other() {
        in_pool(2, || {
            let count = AtomicUsize::new(0);
            rayon::scope(|scope| {
                for _ in 0..6 {
                    scope.spawn(|_| {
                        in_rounds((0..50).map(|round| 4 * round..4 * round + 4), |_| {
                            count.fetch_add(1, Ordering::Relaxed);
                        });
                    });
                }
            });
            assert_eq!(count.into_inner(), 6 * 200);
        });
    }
}
