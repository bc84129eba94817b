//! Short jobs in rounds on several threads: what a round does may begin when the one before is done.
//!
//! A round of a sweep takes some ten microseconds, in which a thread that sleeps does not wake up. So threads that help stay awake from the first
//! round to the last. None of them is waited for: what it has not begun others do.

use std::ptr;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};

/// Looks for a job after which a thread lets others have its processor for a moment.
const PATIENCE: u32 = 200;

/// What the jobs of a round do, each told its number in the round.
struct Round<'a> {
    /// The number of its first job through all rounds.
    first: usize,
    work: &'a (dyn Fn(usize) + Sync),
}

/// Jobs that are numbered through all rounds.
#[derive(Default)]
struct Rounds {
    /// The round under way.
    round: AtomicPtr<Round<'static>>,
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

/// A round with jobs up to this one is over, also where one of them failed: no job of it is begun any more or still done.
struct Finished<'a> {
    rounds: &'a Rounds,
    end: usize,
}

impl Drop for Finished<'_> {
    fn drop(&mut self) {
        let Self { rounds, end } = *self;
        let begun = rounds.next.swap(end, Ordering::Relaxed);
        rounds.done.fetch_add(end - begun, Ordering::Release);
        let mut looks = 0;
        while rounds.done.load(Ordering::Acquire) < end {
            wait(&mut looks);
        }
    }
}

impl Rounds {
    /// Takes a job and does it, if there is one.
    fn take(&self) -> bool {
        let next = self.next.load(Ordering::Relaxed);
        let end = self.end.load(Ordering::Acquire);
        if next >= end || end == usize::MAX {
            return false;
        }
        if self.next.compare_exchange(next, next + 1, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
            let _counted = Counted(&self.done);
            // SAFETY: written before the end of this round was, and there until all of its jobs are done, of which this is one.
            let round = unsafe { &*self.round.load(Ordering::Relaxed) };
            (round.work)(next - round.first);
        }
        true
    }

    /// Does the jobs of a round, with whoever helps.
    fn lead(&self, jobs: usize, work: &(dyn Fn(usize) + Sync)) {
        let first = self.end.load(Ordering::Relaxed);
        let (round, end) = (Round { first, work }, first + jobs);
        self.round.store(ptr::from_ref(&round).cast_mut().cast(), Ordering::Relaxed);
        let _finished = Finished { rounds: self, end };
        self.end.store(end, Ordering::Release);
        while self.take() {}
    }

    /// Does jobs until the last round is over.
    fn help(&self) {
        let mut looks = 0;
        while self.end.load(Ordering::Acquire) != usize::MAX {
            match self.take() {
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

/// Threads that do the jobs of rounds together.
#[derive(Clone, Copy)]
pub struct Crew<'a>(Option<&'a Rounds>);

impl Crew<'_> {
    /// Nobody but the thread that asks.
    pub const ALONE: Crew<'static> = Crew(None);

    /// Does `work` with each number below that of the `jobs`: a round, done when this returns.
    pub fn each(self, jobs: usize, work: impl Fn(usize) + Sync) {
        match self.0.filter(|_| jobs > 1) {
            Some(rounds) => rounds.lead(jobs, &work),
            None => (0..jobs).for_each(work),
        }
    }
}

/// Leads on this thread through as many rounds as there are, which others of its pool help with, where any are idle; alone where the work
/// is not `worth` waking them.
pub fn with_crew(worth: bool, lead: impl FnOnce(Crew) + Send) {
    let threads = rayon::current_num_threads();
    if !worth || threads == 1 {
        return lead(Crew::ALONE);
    }
    let rounds = Rounds::default();
    let mut lead = Some(lead);
    let mut lead = || {
        let _over = Over(&rounds.end);
        lead.take().into_iter().for_each(|lead| lead(Crew(Some(&rounds))));
    };
    with_helpers(threads - 1, &mut lead, &|| rounds.help());
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
    use super::with_crew;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn in_pool(threads: usize, work: impl FnOnce() + Send) {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work);
    }

    #[test]
    fn every_job_is_done_once_and_after_all_of_the_rounds_before() {
        for threads in [1, 2, 5] {
            in_pool(threads, || {
                for _ in 0..200 {
                    let done: Vec<AtomicUsize> = (0..40).map(|_| AtomicUsize::new(0)).collect();
                    let done = &done;
                    with_crew(true, |crew| {
                        let mut begun = 0;
                        for jobs in [3, 0, 7, 1, 29] {
                            crew.each(jobs, |job| {
                                let before = &done[..begun];
                                assert!(before.iter().all(|done| done.load(Ordering::Relaxed) == 1), "{job}");
                                done[begun + job].fetch_add(1, Ordering::Relaxed);
                            });
                            begun += jobs;
                            let now = done.iter().filter(|done| done.load(Ordering::Relaxed) == 1).count();
                            assert_eq!(now, begun, "a round is done when it returns");
                        }
                    });
                    assert!(done.iter().all(|done| done.load(Ordering::Relaxed) == 1));
                }
            });
        }
    }

    #[test]
    fn a_job_that_fails_is_told_and_stops_nobody() {
        for threads in [1, 2, 3] {
            for failing in [0, 5, 63] {
                let caught = std::panic::catch_unwind(|| {
                    in_pool(threads, || {
                        with_crew(true, |crew| {
                            // What a round uses is gone once it is over, also where it fails.
                            let used: Vec<usize> = (0..64).collect();
                            crew.each(64, |job| assert!(used[job] != failing, "this one"));
                            crew.each(64, |job| assert!(used[job] < 64));
                        });
                    });
                });
                assert!(caught.is_err(), "{threads} {failing}");
            }
        }
    }

    #[test]
    fn those_who_lead_at_the_same_time_in_a_pool_do_not_wait_for_each_other() {
        in_pool(2, || {
            let count = AtomicUsize::new(0);
            rayon::scope(|scope| {
                for _ in 0..6 {
                    scope.spawn(|_| {
                        with_crew(true, |crew| {
                            for _ in 0..50 {
                                crew.each(4, |_| {
                                    count.fetch_add(1, Ordering::Relaxed);
                                });
                            }
                        });
                    });
                }
            });
            assert_eq!(count.into_inner(), 6 * 200);
        });
    }
}
