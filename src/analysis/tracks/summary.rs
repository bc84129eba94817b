//! What tracks are like on the whole: the measures of the field, each with its interval, or why it is not defined.

use super::motion::{Cue, Motion, Quantity};
use super::set::Tracks;
use super::velocity::{Correlated, products};
use crate::analysis::bootstrap::{self, Estimate};
use crate::analysis::circular::{self, Directions};
use crate::analysis::furth::{self, Localisation};
use crate::analysis::msd::{self, OfCells};
use crate::analysis::statistics::fit_line;

/// What is to be known besides the tracks.
#[derive(Debug, Clone, PartialEq)]
pub struct Wishes {
    /// Where cells are expected to go; without it there are no forward migration indices.
    pub cue: Option<Cue>,
    /// Whether positions have an error.
    pub localisation: Localisation,
    /// Lags of displacements, in frames.
    pub lags: Vec<usize>,
    /// Seed of the draws of cells.
    pub seed: u64,
}

/// One measure.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its name for programs.
    pub name: &'static str,
    /// Its name for people.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The number, NaN where it is not defined.
    pub estimate: Estimate,
    /// Why it is not defined.
    pub undefined: Option<String>,
}

const UNDEFINED: Estimate = Estimate { value: f64::NAN, low: f64::NAN, high: f64::NAN };

impl Line {
    fn new(name: &'static str, label: &'static str, unit: &'static str, estimate: Estimate, why: &str) -> Self {
        let undefined = estimate.value.is_nan().then(|| why.to_owned());
        Self { name, label, unit, estimate, undefined }
    }
}

/// All measures, in the order in which they are told.
pub fn summary(tracks: &Tracks, wishes: &Wishes) -> Vec<Line> {
    let mut lines = Vec::new();
    for (name, quantity) in [
        ("mean_speed", Quantity::MeanSpeed),
        ("directness", Quantity::Directness),
        ("path_length", Quantity::PathLength),
        ("net_displacement", Quantity::NetDisplacement),
        ("turning_angle", Quantity::TurningAngle),
    ] {
        let mean = bootstrap::of_mean(&quantity.of(tracks), wishes.seed);
        lines.push(Line::new(name, quantity.label(), quantity.unit(), mean, quantity.undefined()));
    }
    if let Some(cue) = wishes.cue {
        let [parallel, perpendicular] = forward_indices(tracks, cue);
        let why = "no cell moved, or all start at the point of the cue";
        for (name, label, values) in [
            ("forward_index_parallel", "forward migration index, parallel", parallel),
            ("forward_index_perpendicular", "forward migration index, perpendicular", perpendicular),
        ] {
            lines.push(Line::new(name, label, "1", bootstrap::of_mean(&values, wishes.seed), why));
        }
    }
    lines.push(correlation(tracks, wishes.seed));
    let of = msd::of_cells(tracks.positions.view(), &tracks.times, &wishes.lags);
    lines.push(msd_exponent(&of, wishes.seed));
    lines.extend(persistent_walk(&of, tracks.axes(), wishes));
    lines.extend(rayleigh(tracks, wishes.seed));
    lines
}

/// Forward migration indices of each track, parallel and perpendicular; NaN where they are not defined.
pub fn forward_indices(tracks: &Tracks, cue: Cue) -> [Vec<f64>; 2] {
    let of =
        |track| Motion::of(tracks, track).map_or([f64::NAN; 2], |motion| motion.forward_indices(cue, tracks.axes()));
    (0..tracks.number()).map(of).map(|[parallel, across]| (parallel, across)).unzip().into()
}

/// Directions of the net displacements in the plane x, y, radians; NaN for cells that end where they began.
pub fn directions(tracks: &Tracks) -> Vec<f64> {
    (0..tracks.number()).map(|track| Motion::of(tracks, track).map_or(f64::NAN, |motion| motion.direction())).collect()
}

fn correlation(tracks: &Tracks, seed: u64) -> Line {
    let products = products(tracks, Correlated::Velocity, &[0, 1]);
    let estimate = bootstrap::of_cells(tracks.number(), seed, |cells| products.correlation(cells)[1]);
    let label = "velocity autocorrelation, next step";
    Line::new(
        "velocity_autocorrelation",
        label,
        "1",
        estimate,
        "no cell was found in three frames in a row, or none moved",
    )
}

/// The slope of the logarithm of the mean squared displacement against that of the lag, eq. (analysis.25); NaN where fewer than two lags have displacements.
pub fn exponent(lags: &[f64], squares: &[f64]) -> f64 {
    let defined = lags.iter().zip(squares).filter(|(lag, square)| **lag > 0.0 && **square > 0.0);
    let (x, y): (Vec<f64>, Vec<f64>) = defined.map(|(lag, square)| (lag.ln(), square.ln())).unzip();
    fit_line(&x, &y).map_or(f64::NAN, |line| line.slope)
}

fn msd_exponent(of: &OfCells, seed: u64) -> Line {
    let estimate = bootstrap::of_cells(of.squares.dim().1, seed, |cells| exponent(&of.lags, &of.mean_of(cells)));
    Line::new("msd_exponent", "exponent of the MSD", "1", estimate, "fewer than two lags have displacements")
}

fn persistent_walk(of: &OfCells, axes: usize, wishes: &Wishes) -> Vec<Line> {
    let found = furth::estimate(of, axes, wishes.localisation, wishes.seed);
    let why = found.as_ref().err().map(ToString::to_string).unwrap_or_default();
    let part = |part: fn(&furth::PersistentWalkEstimate) -> Estimate| found.as_ref().map_or(UNDEFINED, part);
    let mut lines = vec![
        Line::new("furth_speed", "speed (Fürth)", "um/s", part(|walk| walk.speed), &why),
        Line::new("persistence_time", "persistence time (Fürth)", "s", part(|walk| walk.persistence), &why),
    ];
    if wishes.localisation == Localisation::Noisy {
        lines.push(Line::new(
            "localisation_error",
            "localisation error, along an axis",
            "um",
            part(|walk| walk.noise),
            &why,
        ));
    }
    lines
}

fn rayleigh(tracks: &Tracks, seed: u64) -> [Line; 3] {
    let directions = directions(tracks);
    let whole = circular::describe(directions.iter().copied());
    let resample = |part: fn(&Directions) -> f64| {
        bootstrap::of_cells(directions.len(), seed, |cells| {
            part(&circular::describe(cells.iter().map(|cell| directions[*cell])))
        })
    };
    let alone = |value: f64| Estimate { value, low: f64::NAN, high: f64::NAN };
    let why = "no cell ends elsewhere in the plane than it began";
    [
        Line::new("mean_direction", "mean direction, from x to y", "deg", alone(whole.mean.to_degrees()), why),
        Line::new("resultant_length", "mean resultant length", "1", resample(|all| all.resultant), why),
        Line::new("rayleigh_p", "p of the Rayleigh test", "1", alone(whole.p_value), why),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array3;

    fn wishes() -> Wishes {
        let cue = Some(Cue::Direction([1.0, 0.0, 0.0]));
        Wishes { cue, localisation: Localisation::Noisy, lags: vec![1, 2, 3], seed: 1 }
    }

    fn tracks(at: impl Fn(usize, usize, usize) -> f64) -> Tracks {
        Tracks {
            times: (0..13).map(f64::from).collect(),
            names: (0..4).map(|track: usize| track.to_string()).collect(),
            types: vec![String::new(); 4],
            positions: Array3::from_shape_fn((13, 4, 2), |(frame, track, axis)| at(frame, track, axis)),
        }
    }

    fn line<'a>(lines: &'a [Line], name: &str) -> &'a Line {
        lines.iter().find(|line| line.name == name).unwrap()
    }

    #[test]
    fn cells_that_stand_have_no_directness_and_no_persistence_and_it_is_said_why() {
        let lines = summary(&tracks(|_, track, _| track as f64), &wishes());
        for name in [
            "directness",
            "turning_angle",
            "forward_index_parallel",
            "velocity_autocorrelation",
            "msd_exponent",
            "persistence_time",
            "rayleigh_p",
        ] {
            let line = line(&lines, name);
            assert!(
                line.estimate.value.is_nan() && line.undefined.as_ref().is_some_and(|why| !why.is_empty()),
                "{line:?}"
            );
        }
        assert_eq!(line(&lines, "mean_speed").estimate.value, 0.0);
    }

    #[test]
    fn straight_cells_have_the_measures_of_straight_lines() {
        let lines = summary(&tracks(|frame, _, axis| [3.0, -4.0][axis] * frame as f64), &wishes());
        let value = |name: &str| line(&lines, name).estimate.value;
        for (name, wanted) in [
            ("mean_speed", 5.0),
            ("directness", 1.0),
            ("turning_angle", 0.0),
            ("forward_index_parallel", 0.6),
            ("forward_index_perpendicular", -0.8),
            ("velocity_autocorrelation", 1.0),
            ("msd_exponent", 2.0),
            ("mean_direction", (-4.0_f64).atan2(3.0).to_degrees()),
            ("resultant_length", 1.0),
        ] {
            assert!((value(name) - wanted).abs() < 1e-12, "{name}: {}", value(name));
        }
        assert!(line(&lines, "persistence_time").undefined.as_ref().unwrap().contains("hardly turn"));
    }
}
