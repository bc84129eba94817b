//! What must hold between planes, pictures, plots and the run.

use super::Check;
use crate::experiment::cut_short::Late;
use crate::experiment::{MeasureCurve, OneOrMany, PlotKind, When};
use crate::units::{Dimension, pretty};
use std::collections::HashSet;

/// The most frames of a run: a result of one cell has 14 GB with so many.
const MOST_FRAMES: f64 = 1e7;

impl Check<'_> {
    /// An equilibrium is one of forces that drag alone answers, and of cells that do nothing by themselves.
    fn equilibrium(&mut self) {
        let experiment = &self.document.experiment;
        if experiment.run.equilibrium.is_none() {
            return;
        }
        let key = "run.equilibrium";
        let mut never = |path: &str, label: &str, why: &str, help: &str| {
            self.fault(path, label, format!("`{key}` is never reached: {why}"), help);
        };
        if experiment.run.integrator.method.is_inertial() {
            let why = "with mass, forces are out of balance wherever something swings";
            never(
                "run.integrator.method",
                "moves masses",
                why,
                "take the method \"implicit\", with drag instead of mass",
            );
        }
        if !experiment.chemistry.is_empty() {
            never("chemistry", "goes on", "chemistry goes on", "remove `equilibrium`, or [chemistry]");
        }
        for (name, cell) in &experiment.cells {
            if cell.motility.brownian.is_some() {
                let path = format!("cells.{name}.motility");
                never(&path, "walks on", "these cells walk", "remove `equilibrium`, or the motility");
            }
            if cell.pseudopods.is_some() {
                let path = format!("cells.{name}.pseudopods");
                never(&path, "crawls on", "these cells crawl", "remove `equilibrium`, or the pseudopods");
            }
        }
    }

    pub(super) fn scene(&mut self) {
        let experiment = &self.document.experiment;
        let mut names = HashSet::new();
        for (index, plane) in experiment.planes.iter().enumerate() {
            self.direction(&format!("planes[{index}].normal"), plane.normal);
            if !names.insert(plane.name.as_str()) {
                let message = format!("`planes[{index}].name` is the name of another plane too");
                self.fault(&format!("planes[{index}].name"), "taken", message, "give every plane its own name");
            }
        }
        self.tools();
        for (index, plot) in experiment.plot.iter().enumerate() {
            if experiment.plot[..index].iter().any(|other| other.name == plot.name) {
                let message = format!("`plot[{index}].name` is the name of another plot too");
                let help = "give every plot its own name: it names its files";
                self.fault(&format!("plot[{index}].name"), "taken", message, help);
            }
        }
        self.equilibrium();
        let view = &experiment.picture.view;
        let (from, up) = (crate::Vec3::from(view.from), crate::Vec3::from(view.up));
        self.direction("picture.view.from", view.from);
        self.direction("picture.view.up", view.up);
        let parallel = from.norm() > 0.0 && up.norm() > 0.0 && from.cross(&up).norm() <= 1e-9 * from.norm() * up.norm();
        if parallel {
            let message = "`picture.view.up` is the direction of sight".to_owned();
            self.fault(
                "picture.view.up",
                "parallel to `from`",
                message,
                "choose another direction as up, such as [0, 1, 0]",
            );
        }
        for (index, time) in experiment.output.times.iter().enumerate().filter(|(_, time)| time.value() < 0.0) {
            let (path, time) = (format!("output.times[{index}]"), pretty(time.value(), Dimension::TIME));
            let message = format!("`{path}` is {time}, before the start of the run");
            self.fault(&path, "before the start", message, "times of frames count from the start of the run, 0 s");
        }
        if let Some(every) = &experiment.output.every
            && experiment.run.until.value() > MOST_FRAMES * every.value()
        {
            let until = experiment.run.until.value();
            // Two digits of it, rounded up, so that what is advised is enough.
            let digit = 10.0_f64.powf((until / MOST_FRAMES).log10().floor() - 1.0);
            let least = (until / MOST_FRAMES / digit - 1e-9).ceil() * digit;
            let [every, until, least] = [every.value(), until, least].map(|time| pretty(time, Dimension::TIME));
            let message =
                format!("`output.every` is {every}, so that a run of {until} has more than ten million frames");
            let help = format!(
                "make `output.every` {least} or longer, or record what is of interest alone, at `output.times`"
            );
            self.fault("output.every", "too short for this run", message, help);
        }
        if let When::At(time) = experiment.picture.time {
            self.instant("picture.time", time.value(), Late::Picture);
        }
        self.range("picture.colour_range", experiment.picture.colour_range);
        self.range("picture.field_range", experiment.picture.field_range);
        if experiment.picture.field_log {
            self.decades("picture.field_range", experiment.picture.field_range);
        }
        for (index, plot) in experiment.plot.iter().enumerate() {
            match &plot.kind {
                PlotKind::Profile { times: Some(times), .. } => {
                    for (number, time) in times.as_slice().iter().enumerate() {
                        let within = if let OneOrMany::Many(_) = times { format!("[{number}]") } else { String::new() };
                        if let When::At(time) = time {
                            let late = Late::Plot(index, number);
                            self.instant(&format!("plot[{index}].times{within}"), time.value(), late);
                        }
                    }
                }
                PlotKind::Measures { x, log_x, curves } => {
                    self.measures_of_plot(&format!("plot[{index}]"), (x, *log_x), curves);
                }
                PlotKind::Kymograph { range, log, .. } => {
                    self.range(&format!("plot[{index}].range"), *range);
                    if *log {
                        self.decades(&format!("plot[{index}].range"), *range);
                    }
                }
                _ => {}
            }
        }
    }

    /// Each curve has a measure for each x, and a logarithm of each is there where it is drawn.
    fn measures_of_plot(&mut self, plot: &str, (x, log_x): (&[f64], bool), curves: &[MeasureCurve]) {
        if let Some(at) = x.iter().position(|x| !x.is_finite() || log_x && *x <= 0.0) {
            let message = format!("`{plot}.x[{at}]` has no place on the axis");
            let help = if log_x { "give numbers above 0, or leave out `log_x`" } else { "give finite numbers" };
            self.fault(&format!("{plot}.x[{at}]"), "cannot be drawn", message, help);
        }
        for (number, curve) in curves.iter().enumerate() {
            let lists = [("y", Some(&curve.y)), ("low", curve.low.as_ref()), ("high", curve.high.as_ref())];
            for (key, names) in lists.into_iter().filter_map(|(key, names)| Some((key, names?.as_slice()))) {
                if names.len() != x.len() {
                    let path = format!("{plot}.curves[{number}].{key}");
                    let message = format!("`{path}` has {} measures for {} numbers of x", names.len(), x.len());
                    self.fault(&path, "not as many", message, "give one for each x");
                }
            }
            if curve.low.is_some() != curve.high.is_some() {
                let path = format!("{plot}.curves[{number}]");
                let message = format!("`{path}` has only one end of its bars");
                self.fault(&path, "one of `low` and `high`", message, "give both, or neither");
            }
        }
    }

    /// A scale of colours must go upwards.
    fn range(&mut self, path: &str, range: Option<[f64; 2]>) {
        if range.is_some_and(|[low, high]| low.is_nan() || high.is_nan() || low >= high) {
            let message = format!("`{path}` does not go upwards");
            self.fault(path, "the first must be smaller", message, "give the smaller number first");
        }
    }

    /// A scale of powers of ten must be above 0.
    fn decades(&mut self, path: &str, range: Option<[f64; 2]>) {
        if range.is_some_and(|[low, _]| low <= 0.0) {
            let message =
                format!("`{path}` begins at {}, which powers of ten never reach", range.unwrap_or_default()[0]);
            self.fault(
                path,
                "must be above 0",
                message,
                "let it begin above 0, as [0.001, 1] does, or take a linear scale",
            );
        }
    }

    /// An instant must lie within the run. Of one that is cut short what is `late` is left out.
    pub(super) fn instant(&mut self, path: &str, time: f64, late: Late) {
        let until = self.document.experiment.run.until.value();
        if time > until && self.document.is_cut_short {
            self.late.push(late);
        } else if !(0.0..=until).contains(&time) {
            let (time, until) = (pretty(time, Dimension::TIME), pretty(until, Dimension::TIME));
            let message = format!("`{path}` is {time}, which the run does not reach");
            self.fault(path, "outside of the run", message, format!("give a time from 0 s to {until} (run.until)"));
        }
    }
}
