//! The options of `eml solve` and what they ask for, over what the document asks for.

use std::path::PathBuf;

use crate::equations::eml::{self, Document, SCHEMES};
use crate::error::Fault;
use crate::error::words::meant;
use crate::ode::{MOST_IMPLICIT, Method, Scheme, SolveOptions, too_large};

/// Solves the equations of a document, EML or SBML, and writes a table: a row for each point of time.
#[derive(Debug, Clone, clap::Args)]
pub struct SolveArgs {
    /// The document.
    #[arg(value_name = "FILE")]
    pub document: PathBuf,
    /// Where the time begins, in the document's unit of time.
    #[arg(long, value_name = "TIME", default_value_t = 0.0, allow_negative_numbers = true)]
    pub from: f64,
    /// Where it ends.
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub until: f64,
    /// Rows of the table, evenly spaced in time, with both ends.
    #[arg(long, value_name = "NUMBER", default_value_t = 101, allow_negative_numbers = true)]
    pub points: i64,
    /// Columns, by commas: time, identifiers, in SBML S for an amount and [S] for a concentration; time and all
    /// variables when absent. Of a field F: F.mean, F.min, F.max and F.total.
    #[arg(long, value_delimiter = ',', value_name = "COLUMNS")]
    pub columns: Vec<String>,
    /// Another value of a parameter or input, or another start of a variable, as in --set k=0.2.
    #[arg(long = "set", value_name = "ID=NUMBER")]
    pub sets: Vec<String>,
    /// The scheme: rk45, rk65, rosenbrock, bdf, rk4 or euler; the document's when absent, or rosenbrock. Of
    /// fields: that of their reactions.
    #[arg(long, value_name = "SCHEME")]
    pub scheme: Option<String>,
    /// Tolerance relative to the size of each variable.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    pub rtol: Option<f64>,
    /// Tolerance in the unit of each variable.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    pub atol: Option<f64>,
    /// The step of rk4 and euler; of fields, the longest step, in place of tolerances.
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub inner_step: Option<f64>,
    /// The longest step of rk45, rk65 and rosenbrock, so that nothing short is passed over between two.
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub max_step: Option<f64>,
    /// The most steps that are taken.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..))]
    pub max_steps: Option<u32>,
    /// The seed of what is drawn at random: starts, and the order of events of one time and one priority.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    pub seed: u64,
    /// The table to write, as CSV; the terminal when absent.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Draws the curves: .svg or .png.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Of fields: writes their values at the end, as .csv (a row for each box) or .h5 (a dataset for each field).
    #[arg(long, value_name = "FILE")]
    pub last: Option<PathBuf>,
    /// Of fields: lengths of the sides of a grid that has no size, by commas, in its unit.
    #[arg(long, value_delimiter = ',', value_name = "LENGTHS", allow_negative_numbers = true)]
    pub size: Vec<f64>,
    /// Of fields: its lower corner, beside --size; when absent the grid lies around the origin, its floor at z = 0.
    #[arg(long, value_delimiter = ',', value_name = "POSITION", allow_negative_numbers = true)]
    pub origin: Vec<f64>,
    /// Replaces files that are there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was done as JSON.
    #[arg(long, requires = "output")]
    pub json: bool,
}

/// The most rows of a table.
const MOST_POINTS: i64 = 10_000_000;
/// The most steps of a fixed length.
const MOST_STEPS: f64 = 4e9;

/// The times of the rows.
pub(super) fn points(args: &SolveArgs, faults: &mut Vec<Fault>) -> Vec<f64> {
    let (from, until, points) = (args.from, args.until, args.points);
    if !(from.is_finite() && until.is_finite() && until > from) {
        let fault = Fault::new(format!("the time ends at {until} and begins at {from}"));
        faults.push(fault.help("let --until be a number above --from, which is 0 when absent"));
        return Vec::new();
    }
    if !(2..=MOST_POINTS).contains(&points) {
        let fault = Fault::new(format!("--points {points} makes no table"));
        faults.push(fault.help(format!("let --points be from 2 (the two ends) to {MOST_POINTS}")));
        return Vec::new();
    }
    let points = points as u32;
    let last = f64::from(points - 1);
    // 0.3 rather than 0.30000000000000004: the product is exact more often than the step.
    let at = |point: u32| if point == points - 1 { until } else { from + f64::from(point) * (until - from) / last };
    (0..points).map(|point| at(point).clamp(from, until)).collect()
}

/// The scheme by its name, and how it is used.
pub(super) fn options(args: &SolveArgs, document: &Document, faults: &mut Vec<Fault>) -> (&'static str, SolveOptions) {
    let usual = SolveOptions::default();
    let mut options = usual;
    let numbers = [
        ("--rtol", args.rtol),
        ("--atol", args.atol),
        ("--inner-step", args.inner_step),
        ("--max-step", args.max_step),
    ];
    for (name, value) in numbers {
        if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
            let fault = Fault::new(format!("{name} {} is not above 0", value.unwrap_or(f64::NAN)));
            faults.push(fault.help("give a number such as 1e-6"));
        }
    }
    let name = scheme(args, document, faults);
    let fixed = ["rk4", "euler"].contains(&name);
    let idle = match fixed {
        true => vec![
            ("--rtol", args.rtol.is_some()),
            ("--atol", args.atol.is_some()),
            ("--max-step", args.max_step.is_some()),
        ],
        false => vec![("--inner-step", args.inner_step.is_some())],
    };
    if name == "bdf" && args.max_step.is_some() {
        let fault = Fault::new("the scheme bdf takes no --max-step");
        faults.push(fault.help("take --scheme rosenbrock: it is for stiff systems too"));
    }
    for (option, _) in idle.into_iter().filter(|(_, given)| *given) {
        let help = match fixed {
            true => format!("{name} takes steps of --inner-step; rk45, rk65 and rosenbrock keep to tolerances"),
            false => format!("{name} finds its step; --rtol and --atol say how exactly"),
        };
        faults.push(Fault::new(format!("{option} has no meaning for the scheme {name}")).help(help));
    }
    options.relative = args.rtol.or(document.solver.rtol).unwrap_or(usual.relative);
    options.absolute = args.atol.or(document.solver.atol).unwrap_or(usual.absolute);
    options.max_steps = args.max_steps.unwrap_or(usual.max_steps);
    options.seed = args.seed;
    options.longest = args.max_step.unwrap_or(usual.longest);
    let inner = args.inner_step.or(document.solver.inner_step);
    match Scheme::named(name, inner) {
        Some(scheme) => options.scheme = scheme,
        // One that is not above 0 has been told of.
        None if inner.is_some() => {}
        None => {
            let fault = Fault::new(format!("the scheme {name} has no inner step"));
            faults.push(fault.help("give --inner-step, or take --scheme rosenbrock, which finds its step"));
        }
    }
    if let Scheme::OneStep(Method::Rk4 { step } | Method::Euler { step }) = options.scheme {
        options.max_steps = args.max_steps.unwrap_or(u32::MAX);
        let steps = (args.until - args.from) / step;
        if steps > MOST_STEPS {
            let fault = Fault::new(format!("{steps:.0} steps of {step} are too many"));
            faults.push(fault.help("give a longer --inner-step, or take --scheme rosenbrock, which finds its step"));
        }
    }
    let variables = document.system.variables().len();
    if options.scheme.is_implicit() && variables > MOST_IMPLICIT {
        faults.push(too_large(&document.name, variables, name, "take --scheme rk45"));
    }
    if !options.scheme.is_built_in() {
        let fault = Fault::new(format!("this program was built without diffsol, which has the scheme {name}"));
        faults.push(fault.help("take --scheme rosenbrock, or build with `--features diffsol`"));
    }
    if options.scheme == Scheme::Bdf && !document.system.events.is_empty() {
        let fault = Fault::new(format!("the scheme bdf takes no events, and {} has some", document.name));
        faults.push(fault.help("take --scheme rosenbrock: it is for stiff systems too"));
    }
    if options.scheme == Scheme::Bdf && document.system.has_delays() {
        let fault = Fault::new(format!("the scheme bdf takes no delays, and {} has some", document.name));
        faults.push(fault.help("take --scheme rosenbrock: it is for stiff systems too"));
    }
    (name, options)
}

/// The name of the scheme: the user's, the document's, or the usual one.
fn scheme(args: &SolveArgs, document: &Document, faults: &mut Vec<Fault>) -> &'static str {
    let chosen = SCHEMES.iter().find(|(_, scheme)| Some(*scheme) == document.solver.scheme);
    let own = chosen.map_or("rosenbrock", |(name, _)| *name);
    wished(args, faults).map_or(own, |(name, _)| name)
}

/// The scheme that the user names.
pub(super) fn wished_scheme(args: &SolveArgs, faults: &mut Vec<Fault>) -> Option<eml::Scheme> {
    wished(args, faults).map(|(_, scheme)| scheme)
}

fn wished(args: &SolveArgs, faults: &mut Vec<Fault>) -> Option<(&'static str, eml::Scheme)> {
    let wish = args.scheme.as_ref()?;
    if let Some(found) = SCHEMES.into_iter().find(|(name, _)| name == wish) {
        return Some(found);
    }
    let names = SCHEMES.map(|(name, _)| name);
    let near = meant(wish, names).map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let fault = Fault::new(format!("there is no scheme `{wish}`"));
    faults.push(fault.help(format!("{near}there are: {}", names.join(", "))));
    None
}
