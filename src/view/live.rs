//! A run that is watched: what it shows of itself, and what those who watch want of it.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::pack::{self, Box3};
use crate::experiment::Settling;
use crate::output::Cell;
use crate::run::Report;
use crate::simulation::{CancelToken, Simulation};

/// Time between two pictures of a run that goes on, at least.
const INTERVAL: Duration = Duration::from_millis(80);

/// A picture is made after so many times what one takes, at least: watching costs a hundredth.
const SPARED: u32 = 100;

/// Who has not asked for so long does not watch.
const ATTENTION: Duration = Duration::from_secs(3);

/// What is wanted of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// Going on.
    Go,
    /// Waiting after the step.
    Pause,
    /// Ending after the step, with a checkpoint to resume from.
    Stop,
}

/// Where a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Its document is compiled, cells are pushed apart.
    Preparing,
    /// Steps are made.
    Running,
    /// It waits.
    Paused,
    /// No more steps will be made.
    Ended,
}

impl Phase {
    /// The word that the page knows it by.
    pub fn word(self) -> &'static str {
        match self {
            Self::Preparing => "preparing",
            Self::Running => "running",
            Self::Paused => "paused",
            Self::Ended => "ended",
        }
    }
}

/// What a run tells of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// Where it is.
    pub phase: Phase,
    /// Simulated time, s.
    pub time: f64,
    /// When it will end, s.
    pub until: f64,
    /// Steps made.
    pub steps: u64,
    /// The number of the last picture.
    pub picture: u64,
    /// What is being done before the first step, in words.
    pub words: String,
}

struct Inner {
    told: Told,
    wish: Wish,
    /// Cells and positions at `told.time`, packed.
    picture: Option<(f64, Arc<Vec<u8>>)>,
    asked: Option<Instant>,
}

/// A run and those who watch it, between threads.
pub struct Live {
    inner: Mutex<Inner>,
    changed: Condvar,
    cancel: CancelToken,
}

impl Live {
    /// A run that has not begun, and that this token ends.
    pub fn new(cancel: CancelToken) -> Self {
        let told = Told { phase: Phase::Preparing, time: 0.0, until: 0.0, steps: 0, picture: 0, words: String::new() };
        let inner = Mutex::new(Inner { told, wish: Wish::Go, picture: None, asked: None });
        Self { inner, changed: Condvar::new(), cancel }
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Where the run is now.
    pub fn told(&self) -> Told {
        self.lock().told.clone()
    }

    /// Says what is wanted of the run.
    pub fn want(&self, wish: Wish) {
        let mut inner = self.lock();
        inner.wish = wish;
        if wish == Wish::Stop {
            self.cancel.cancel();
        }
        drop(inner);
        self.changed.notify_all();
    }

    /// The last picture of the run and its time, s; from now on there will be newer ones for a while.
    pub fn picture(&self) -> Option<(f64, Arc<Vec<u8>>)> {
        let mut inner = self.lock();
        inner.asked = Some(Instant::now());
        inner.picture.clone()
    }

    /// The run makes no more steps.
    pub fn end(&self) {
        self.lock().told.phase = Phase::Ended;
        self.changed.notify_all();
    }

    /// Waits for as long as the run is to wait.
    fn wait(&self) {
        let mut inner = self.lock();
        while inner.wish == Wish::Pause && !self.cancel.is_cancelled() {
            inner.told.phase = Phase::Paused;
            // A signal cancels without a word to us.
            let waited = self.changed.wait_timeout(inner, Duration::from_millis(100));
            inner = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        inner.told.phase = Phase::Running;
    }
}

/// Listens to a run for those who watch it, and passes all on to another listener.
pub struct Watched {
    live: Arc<Live>,
    other: Box<dyn Report>,
    next: Instant,
}

impl Watched {
    /// Listens for `live`, and for `other`.
    pub fn new(live: Arc<Live>, other: Box<dyn Report>) -> Self {
        Self { live, other, next: Instant::now() }
    }

    fn take_picture(&mut self, simulation: &Simulation) {
        let began = Instant::now();
        let mut positions = vec![[0.0; 3]; simulation.atom_count()];
        if simulation.positions_into(&mut positions).is_err() {
            return;
        }
        let kinds = (0..).zip(simulation.types());
        let cells =
            kinds.flat_map(|(kind, known)| known.cells().map(move |id| Cell { id: id.number(), kind, parent: None }));
        let cells: Vec<Cell> = cells.collect();
        let packed = Arc::new(pack::frame(&cells, &positions, &Box3::around(&positions)));
        self.next = Instant::now() + INTERVAL.max(SPARED * began.elapsed());
        let mut inner = self.live.lock();
        inner.picture = Some((simulation.time(), packed));
        inner.told.picture += 1;
    }
}

impl Report for Watched {
    fn notice(&mut self, words: &str) {
        self.other.notice(words);
    }

    fn settle(&mut self, what: Settling) {
        self.live.lock().told.words = match &what {
            Settling::Looking(share) => format!("looking whether cells overlap: {:.0} %", 100.0 * share),
            Settling::Pushing { pairs, .. } => format!("pushing cells apart: {pairs} pairs overlap"),
        };
        self.other.settle(what);
    }

    fn begin(&mut self, time: f64, until: f64) {
        {
            let mut inner = self.live.lock();
            (inner.told.phase, inner.told.time, inner.told.until) = (Phase::Running, time, until);
        }
        self.other.begin(time, until);
    }

    fn look(&mut self, simulation: &Simulation) {
        let (pauses, watched) = {
            let mut inner = self.live.lock();
            (inner.told.time, inner.told.steps) = (simulation.time(), simulation.steps());
            (inner.wish == Wish::Pause, inner.asked.is_some_and(|asked| asked.elapsed() < ATTENTION))
        };
        if pauses || watched && Instant::now() >= self.next {
            self.take_picture(simulation);
        }
        if pauses {
            self.live.wait();
        }
        self.other.look(simulation);
    }

    fn step(&mut self, time: f64, steps: u64) {
        self.other.step(time, steps);
    }

    fn end(&mut self) {
        self.other.end();
    }
}
