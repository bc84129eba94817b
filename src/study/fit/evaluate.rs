//! Evaluations of a fit: the experiment run with some parameters, each run in a file that is named by all that it follows from.
//!
//! A run is made as those of studies are, so one that was interrupted goes on, and one that is there is read and not made again: whoever
//! stops a fit and starts it again has the same numbers without running anything twice.

use super::observed::Observed;
use super::space::Space;
use crate::error::{Error, Result};
use crate::output::ResultFile;
use crate::run::Quiet;
use crate::simulation::CancelToken;
use crate::study::design::run_seed;
use crate::study::facts::Run;
use crate::study::one::{Complete, Done, Files, OneOptions, run_one};
use crate::study::paths::fingerprint;
use crate::study::plan::Plan;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};

/// How evaluations are made.
pub struct EvaluateOptions<'a> {
    /// Runs at a time. Results do not depend on it.
    pub jobs: usize,
    /// Threads of each run. Results do not depend on it.
    pub threads: usize,
    /// Ends all runs at their next step.
    pub cancel: CancelToken,
    /// Bytes of memory that a run may take, by an estimate; any number when absent.
    pub memory: Option<u64>,
    /// Hears what is said on the way.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

/// What a point gave: the numbers beside the data; none where the run failed.
type Found = Option<Arc<Vec<f64>>>;
/// The entry of a point: locked by whoever makes its runs, so that nobody else makes them, too.
type Entry = Arc<Mutex<Option<Found>>>;

/// Makes evaluations, as many at a time as are wanted, and each once.
pub struct Evaluator<'a> {
    plan: &'a Plan,
    space: &'a Space,
    observed: &'a [Observed],
    options: &'a EvaluateOptions<'a>,
    known: Mutex<BTreeMap<Vec<String>, Entry>>,
    free: Mutex<usize>,
    freed: Condvar,
    made: AtomicUsize,
}

impl<'a> Evaluator<'a> {
    /// For the plan of a fit in its folder.
    pub fn new(plan: &'a Plan, space: &'a Space, observed: &'a [Observed], options: &'a EvaluateOptions<'a>) -> Self {
        Self {
            plan,
            space,
            observed,
            options,
            known: Mutex::default(),
            free: Mutex::new(options.jobs),
            freed: Condvar::new(),
            made: AtomicUsize::new(0),
        }
    }

    /// The weighted residuals at some points, eq. (fit.1), none where a run fails. Runs that are not there are made, several at a time.
    ///
    /// # Errors
    /// [`Error::Stopped`] once the token is cancelled; [`Error::Input`] when a run has no number beside a datum, or was made from other
    /// inputs; [`Error::Machine`] when the disk refuses.
    pub fn residuals(&self, points: &[Vec<f64>]) -> Result<Vec<Option<Vec<f64>>>> {
        let found =
            side_by_side(points.len(), self.options.jobs, |index| self.predicted(&self.space.cells(&points[index])));
        found.into_iter().map(|found| Ok(found?.map(|predicted| self.weighted(&predicted)))).collect()
    }

    fn weighted(&self, predicted: &[f64]) -> Vec<f64> {
        let data = self.observed.iter().flat_map(|one| &one.data);
        data.zip(predicted).map(|(datum, predicted)| (predicted - datum.y) / datum.error).collect()
    }

    /// The numbers beside all data, means over the replicates.
    fn predicted(&self, cells: &[String]) -> Result<Found> {
        let entry = {
            let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            known.entry(cells.to_vec()).or_default().clone()
        };
        let mut entry = entry.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = &*entry {
            return Ok(found.clone());
        }
        let replicates = self.plan.facts.replicates;
        let all = side_by_side(replicates as usize, self.options.jobs, |replicate| self.one(cells, replicate as u32));
        let all: Option<Vec<Vec<f64>>> = all.into_iter().collect::<Result<_>>()?;
        let found = all.map(|all| {
            let sum = |datum: usize| all.iter().map(|one| one[datum]).sum::<f64>();
            Arc::new((0..all[0].len()).map(|datum| sum(datum) / f64::from(replicates)).collect())
        });
        *entry = Some(found.clone());
        Ok(found)
    }

    /// The numbers of one run beside all data.
    fn one(&self, cells: &[String], replicate: u32) -> Result<Option<Vec<f64>>> {
        let run = self.run_of(cells, replicate);
        let options = OneOptions {
            threads: Some(self.options.threads),
            cancel: self.options.cancel.clone(),
            complete: Complete::Skip,
            memory: self.options.memory,
        };
        let made = {
            let _permit = self.permit();
            if options.cancel.is_cancelled() {
                return Err(stopped());
            }
            run_one(self.plan, &run, &options, &mut Quiet)
        };
        match made {
            Ok(Done::Skipped) => {}
            Ok(Done::Made { .. }) => {
                self.made.fetch_add(1, Ordering::Relaxed);
            }
            Err(error @ Error::Numbers { .. }) => {
                let first = error.to_string().lines().next().unwrap_or_default().to_owned();
                (self.options.tell)(&format!("no number at {}: {first}", run.told(&self.plan.facts.parameters)));
                return Ok(None);
            }
            Err(Error::Stopped { .. }) => return Err(stopped()),
            Err(other) => return Err(other),
        }
        let file = ResultFile::open(&Files::of(self.plan, &run).result)?;
        let numbers: Result<Vec<Vec<f64>>> = self.observed.iter().map(|one| one.predicted(&file)).collect();
        let numbers = numbers?.concat();
        Ok(numbers.iter().all(|number| number.is_finite()).then_some(numbers))
    }

    /// A run of some parameters. Its seed is the same at all points, so that what chance does to them is the same, too; its file is named by
    /// all that it follows from.
    fn run_of(&self, cells: &[String], replicate: u32) -> Run {
        let facts = &self.plan.facts;
        let seed = run_seed(facts.seed, 0, replicate);
        let number = replicate + 1;
        let run = Run { number, point: 1, replicate: number, seed, cells: cells.to_vec(), output: PathBuf::new() };
        let files = facts.files.values().cloned();
        let inputs: Vec<String> = facts.sets_of(&run).into_iter().chain(files).collect();
        let output = Path::new("runs").join(format!("{}.vtkhdf", fingerprint(inputs.join("\n").as_bytes())));
        Run { output, ..run }
    }

    /// The result of the first replicate of a point that was evaluated.
    ///
    /// # Errors
    /// As [`ResultFile::open`].
    pub fn result(&self, point: &[f64]) -> Result<ResultFile> {
        ResultFile::open(&Files::of(self.plan, &self.run_of(&self.space.cells(point), 0)).result)
    }

    /// Runs that were made, those left out that were there.
    pub fn made(&self) -> usize {
        self.made.load(Ordering::Relaxed)
    }

    /// All points that were evaluated, by their cells: the file of the first replicate and χ², none where a run failed.
    pub fn evaluations(&self) -> Vec<(Vec<String>, PathBuf, Option<f64>)> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = Vec::with_capacity(known.len());
        for (cells, entry) in known.iter() {
            let Some(found) = &*entry.lock().unwrap_or_else(PoisonError::into_inner) else { continue };
            let chi2 = found.as_ref().map(|predicted| self.weighted(predicted).iter().map(|one| one * one).sum());
            all.push((cells.clone(), self.run_of(cells, 0).output, chi2));
        }
        all
    }

    /// Leave to run, once fewer runs go on than are wanted at a time.
    fn permit(&self) -> Permit<'_> {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        while *free == 0 {
            free = self.freed.wait(free).unwrap_or_else(PoisonError::into_inner);
        }
        *free -= 1;
        Permit { free: &self.free, freed: &self.freed }
    }
}

struct Permit<'a> {
    free: &'a Mutex<usize>,
    freed: &'a Condvar,
}

impl Drop for Permit<'_> {
    fn drop(&mut self) {
        *self.free.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        self.freed.notify_one();
    }
}

fn stopped() -> Error {
    Error::Stopped {
        message: "the fit was interrupted".into(),
        help: "the same command goes on, begun runs from their checkpoints".into(),
    }
}

/// Does so many pieces of work, `most` at a time; what they give in their order.
pub fn side_by_side<T: Send>(number: usize, most: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    if number <= 1 || most <= 1 {
        return (0..number).map(work).collect();
    }
    let (next, work) = (AtomicUsize::new(0), &work);
    let done: Mutex<Vec<Option<T>>> = Mutex::new((0..number).map(|_| None).collect());
    std::thread::scope(|scope| {
        for _ in 0..most.min(number) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= number {
                        return;
                    }
                    let made = work(index);
                    done.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(made);
                }
            });
        }
    });
    done.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_done_side_by_side_comes_in_its_order() {
        for most in [1, 3, 100] {
            assert_eq!(side_by_side(20, most, |index| index * index), (0..20).map(|k| k * k).collect::<Vec<_>>());
        }
    }
}
