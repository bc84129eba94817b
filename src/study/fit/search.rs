//! The course of a fit: searches from all starts, intervals about the best, once more from anything better that is met there.

use super::document::Errors;
use super::evaluate::{EvaluateOptions, Evaluator, side_by_side};
use super::outcome::{Compared, Estimated, Evaluation, Outcome, Started};
use super::prepared::Prepared;
use super::profile::{End, Profile, Side, end};
use super::solve::{Iterate, Minimum, Search, minimise};
use super::space::Axis;
use super::statistics::standard_errors;
use super::uncertainty::{Covariance, covariance};
use crate::error::{Error, Fault, Result};

/// How often intervals are sought anew from a better point that was met on the way.
const MOST_TURNS: usize = 3;

/// Fits. The plan has to be written.
///
/// # Errors
/// [`Error::Input`] for a parameter that changes nothing, and for data that a run does not reach; [`Error::Numbers`] when the experiment
/// fails at all starts; [`Error::Stopped`] once the token is cancelled; [`Error::Machine`] when the disk refuses.
pub fn fit(prepared: &Prepared, options: &EvaluateOptions) -> Result<Outcome> {
    let evaluator = Evaluator::new(&prepared.plan, &prepared.space, &prepared.observed, options);
    Course { prepared, options, evaluator: &evaluator }.run()
}

struct Course<'a> {
    prepared: &'a Prepared,
    options: &'a EvaluateOptions<'a>,
    evaluator: &'a Evaluator<'a>,
}

/// Intervals about a minimum, with what they go by.
struct Intervals {
    covariance: Covariance,
    /// Standard errors to each side that have the confidence.
    reach: f64,
    rise: f64,
    /// Two ends for each parameter; none where no profile was asked for.
    ends: Vec<End>,
}

impl Course<'_> {
    fn run(&self) -> Result<Outcome> {
        self.check_effects()?;
        let (starts, mut best) = self.search()?;
        let mut intervals = self.intervals(&best)?;
        for _ in 0..MOST_TURNS {
            let Some(better) = intervals.ends.iter().find_map(|end| end.better.clone()) else { break };
            (self.options.tell)(&format!("a better point on the way: {}", self.prepared.space.told(&better)));
            match self.minimum(&better, "again")? {
                Some(found) if found.at.chi2 < best.at.chi2 => best = found,
                _ => break,
            }
            intervals = self.intervals(&best)?;
        }
        self.outcome(&best, &intervals, starts)
    }

    /// Makes sure that each parameter changes something that is compared, at the start or between its bounds.
    fn check_effects(&self) -> Result<()> {
        let (space, start) = (&self.prepared.space, &self.prepared.starts[0]);
        let mut points = vec![start.clone()];
        for (axis, one) in space.axes.iter().enumerate() {
            // The points that the first derivatives need.
            points.extend(
                [-1.0, 1.0].map(|side| space.with(start, axis, (start[axis] + side * one.step).clamp(0.0, 1.0))),
            );
        }
        let found = self.evaluator.residuals(&points)?;
        let mut faults = Vec::new();
        for (axis, one) in space.axes.iter().enumerate() {
            if found[1 + 2 * axis..3 + 2 * axis].iter().any(|near| *near != found[0]) {
                continue;
            }
            let ends = [0.0, 1.0].map(|bound| space.with(start, axis, bound));
            if self.evaluator.residuals(&ends)?.iter().all(|far| *far == found[0]) {
                let message =
                    format!("`{}` changes nothing that is compared with data, from bound to bound", one.column.key);
                let location = self.prepared.document.location(&format!("parameter[{axis}].key"), "touches nothing");
                let help = "leave it out, or add data beside something that it changes";
                faults.push(Fault::new(message).at(location).help(help));
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
    }

    /// A search from each start, and the best end.
    fn search(&self) -> Result<(Vec<Started>, Minimum)> {
        let starts = &self.prepared.starts;
        let name = |index: usize| if starts.len() > 1 { format!("start {}", index + 1) } else { String::new() };
        let found = side_by_side(starts.len(), self.options.jobs, |index| self.minimum(&starts[index], &name(index)));
        let found: Vec<Option<Minimum>> = found.into_iter().collect::<Result<_>>()?;
        let to = |minimum: &Minimum| (minimum.at.point.clone(), minimum.at.chi2);
        let started = starts
            .iter()
            .zip(&found)
            .map(|(from, minimum)| Started { from: from.clone(), to: minimum.as_ref().map(to) });
        let started = started.collect();
        let best = found.into_iter().flatten().min_by(|one, other| one.at.chi2.total_cmp(&other.at.chi2));
        match best {
            Some(best) => Ok((started, best)),
            None => Err(Error::Numbers {
                message: format!("the experiment fails at {}", if starts.len() > 1 { "all starts" } else { "the start" }),
                help: "start where the experiment runs to its end: try values with pseudopod run --set, or ask for more `starts`".into(),
                kept: None,
            }),
        }
    }

    fn minimum(&self, start: &[f64], name: &str) -> Result<Option<Minimum>> {
        let tell = |at: &Iterate| {
            let name = if name.is_empty() { String::new() } else { format!("{name}, ") };
            let told = self.prepared.space.told(&at.point);
            (self.options.tell)(&format!("{name}iteration {}: χ² = {:.6} at {told}", at.number, at.chi2));
        };
        let all: Vec<usize> = (0..self.prepared.space.axes.len()).collect();
        self.with_search(&all, &tell, |search| minimise(search, start))
    }

    fn with_search<T>(&self, free: &[usize], tell: &(dyn Fn(&Iterate) + Sync), work: impl FnOnce(&Search) -> T) -> T {
        let residuals = |points: &[Vec<f64>]| self.evaluator.residuals(points);
        let steps: Vec<f64> = self.prepared.space.axes.iter().map(|axis| axis.step).collect();
        work(&Search { residuals: &residuals, steps: &steps, free, tell })
    }

    fn intervals(&self, best: &Minimum) -> Result<Intervals> {
        let fit = &self.prepared.document.fit;
        let (freedom, parameters) = (self.freedom(), self.prepared.space.axes.len());
        let (variance, law) = match fit.errors {
            Errors::Given => (1.0, None),
            Errors::Estimated => (best.at.chi2 / freedom as f64, Some(freedom)),
        };
        let reach = standard_errors(fit.confidence, law);
        let (covariance, rise) = (covariance(best, variance), reach * reach * variance);
        let mut intervals = Intervals { covariance, reach, rise, ends: Vec::new() };
        if !(fit.profile && rise.is_finite() && rise > 0.0) {
            return Ok(intervals);
        }
        (self.options.tell)(&format!("profiles from χ² = {:.6} to {:.6}", best.at.chi2, best.at.chi2 + rise));
        let errors = &intervals.covariance.errors;
        let ends = self.with_search(&[], &|_| (), |search| {
            let profile = Profile { search: *search, minimum: best, rise };
            side_by_side(2 * parameters, self.options.jobs, |index| {
                let side = if index % 2 == 0 { Side::Below } else { Side::Above };
                // Errors are those of a weighted residual of variance 1 times its deviation, which the rise holds, too.
                end(&profile, index / 2, side, errors[index / 2] / variance.sqrt())
            })
        });
        intervals.ends = ends.into_iter().collect::<Result<_>>()?;
        Ok(intervals)
    }

    fn freedom(&self) -> usize {
        let data = self.prepared.observed.iter().map(|one| one.data.len()).sum::<usize>();
        data.saturating_sub(self.prepared.space.axes.len())
    }

    fn outcome(&self, best: &Minimum, intervals: &Intervals, starts: Vec<Started>) -> Result<Outcome> {
        let Prepared { document, space, observed, .. } = self.prepared;
        let estimated = space.axes.iter().enumerate().map(|(index, axis)| estimated(axis, index, best, intervals));
        let file = self.evaluator.result(&best.at.point)?;
        let mut residuals = best.at.residuals.iter();
        let compared = observed.iter().map(|observed| {
            let beside =
                |datum: &super::observed::Datum| datum.y + datum.error * residuals.next().copied().unwrap_or(f64::NAN);
            let predicted = observed.data.iter().map(beside).collect();
            Ok(Compared { observed: observed.clone(), predicted, course: observed.course(&file)? })
        });
        let evaluations = self.evaluator.evaluations().into_iter();
        let evaluations = evaluations.map(|(cells, result, chi2)| Evaluation { cells, result, chi2 });
        Ok(Outcome {
            parameters: estimated.collect(),
            correlations: intervals.covariance.correlations.clone(),
            compared: compared.collect::<Result<_>>()?,
            chi2: best.at.chi2,
            freedom: self.freedom(),
            errors: document.fit.errors,
            confidence: document.fit.confidence,
            rise: intervals.rise,
            converged: best.converged,
            starts,
            evaluations: evaluations.collect(),
            made: self.evaluator.made(),
            space: space.clone(),
        })
    }
}

fn estimated(axis: &Axis, index: usize, best: &Minimum, intervals: &Intervals) -> Estimated {
    let share = best.at.point[index];
    let reach = intervals.reach * intervals.covariance.errors[index];
    let ends = intervals.ends.get(2 * index..2 * index + 2);
    let mut points = vec![[axis.value(share), best.at.chi2]];
    for end in ends.unwrap_or_default() {
        points.extend(end.points.iter().map(|[share, chi2]| [axis.value(*share), *chi2]));
    }
    points.sort_by(|one, other| one[0].total_cmp(&other[0]));
    Estimated {
        value: axis.value(share),
        share,
        covariance: [axis.value(share - reach), axis.value(share + reach)],
        profile: ends.map(|ends| [ends[0].at, ends[1].at].map(|at| at.map(|share| axis.value(share)))),
        points,
    }
}
