//! What measures promise, on small recordings made by hand and on walks.

use super::*;
use crate::analysis::noise;
use crate::units::{Speed, Time};
use ndarray::Array2;
use std::collections::BTreeMap;
use std::io::Write;

/// Three frames of a red and two white cells under a growing load.
fn pulled() -> Recording {
    let sizes = Array2::from_shape_vec((3, 3), vec![8.0, 4.0, 6.0, 9.0, 4.5, 6.5, 10.0, 5.0, 9.0]).unwrap();
    Recording {
        times: vec![0.0, 1.0, 3.0],
        types: vec!["red".to_owned(), "white".to_owned()],
        cell_types: vec![0, 1, 1],
        cells: BTreeMap::from([("size_x".to_owned(), sizes)]),
        scene: BTreeMap::from([("load.pull".to_owned(), vec![0.0, 10.0, 20.0])]),
        ..Recording::default()
    }
}

/// Evaluates with paths that can be opened as they are.
fn evaluate(kind: &MeasureKind, recording: &Recording) -> Result<f64> {
    super::evaluate(kind, recording, None, &Path::to_path_buf)
}

fn value(cells: Option<&str>, over: Over, time: Reduction) -> MeasureKind {
    MeasureKind::Value { series: "size_x".to_owned(), cells: cells.map(str::to_owned), over, time }
}

#[test]
fn values_are_reduced_over_cells_and_time() {
    let recording = pulled();
    let found = |cells, over, time| evaluate(&value(cells, over, time), &recording).unwrap();
    assert_eq!(found(Some("white"), Over::Mean, Reduction::Last), 7.0);
    assert_eq!(found(None, Over::Min, Reduction::First), 4.0);
    assert_eq!(found(None, Over::Max, Reduction::Mean), 9.0);
    assert_eq!(found(Some("white"), Over::Sum, Reduction::Max), 14.0);
    assert_eq!(found(Some("white"), Over::First, Reduction::Min), 4.0);
    assert_eq!(found(Some("red"), Over::Mean, Reduction::Range), 2.0);
    assert_eq!(found(Some("red"), Over::Mean, Reduction::At(Time::new(2.0))), 9.5);
}

#[test]
fn a_time_meant_to_be_the_last_is_the_last() {
    let mut recording = pulled();
    recording.times[2] = 3.0 - 1e-12;
    let at = |time| evaluate(&value(Some("red"), Over::Mean, Reduction::At(Time::new(time))), &recording);
    assert_eq!(at(3.0).unwrap(), 10.0);
    assert!(at(3.001).is_err());
}

#[test]
fn what_is_not_there_is_named() {
    let recording = pulled();
    let message = |measure: MeasureKind| evaluate(&measure, &recording).unwrap_err().to_string();
    let missing = value(Some("blue"), Over::Mean, Reduction::Last);
    assert_eq!(message(missing), "there is no cell type \"blue\" in this run");
    assert_eq!(message(value(None, Over::Mean, Reduction::At(Time::new(4.0)))), "nothing was recorded at 4 s");
    let measure = MeasureKind::Value { series: "volume".into(), cells: None, over: Over::Mean, time: Reduction::Last };
    assert_eq!(series_of(&measure), ["volume"]);
    assert_eq!(message(measure), "there is no series \"volume\" in this run");
}

#[test]
fn lines_are_fitted_to_the_stretch_asked_for() {
    let slope = |x_to| {
        let (x, y, cells) = ("load.pull".into(), "size_x".into(), Some("white".into()));
        evaluate(&MeasureKind::Slope(Fit { x, y: OneOrMany::One(y), cells, x_from: None, x_to }), &pulled()).unwrap()
    };
    // The white cells measure 5, 5.5 and 7 µm.
    assert!((slope(None) - 0.1).abs() < 1e-14);
    assert!((slope(Some(10.0)) - 0.05).abs() < 1e-14);
    let (x, y, cells) = ("load.pull".into(), "size_x".into(), Some("white".into()));
    let r_squared =
        evaluate(&MeasureKind::RSquared(Fit { x, y: OneOrMany::One(y), cells, x_from: None, x_to: None }), &pulled())
            .unwrap();
    // Residuals 1/6, −1/3, 1/6 of values whose squares about the mean sum to 13/6.
    assert!((r_squared - (1.0 - (1.0 / 6.0) / (13.0 / 6.0))).abs() < 1e-14);
}

#[test]
fn tables_are_compared_with_the_curve() {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    write!(file, "F,A,low,high\n0,8,7,9\n15,10,9.6,11\n").unwrap();
    let comparison = Comparison {
        table: file.path().to_owned(),
        x_column: "F".into(),
        y_column: "A".into(),
        low_column: Some("low".into()),
        high_column: Some("high".into()),
        x: "load.pull".into(),
        y: "size_x".into(),
        cells: Some("red".into()),
    };
    let recording = pulled();
    // The red cell measures 8 and 9.5 µm at the two loads.
    let rms = evaluate(&MeasureKind::TableRms(comparison.clone()), &recording).unwrap();
    assert!((rms - 0.05 / 2.0_f64.sqrt()).abs() < 1e-14);
    let ratio = evaluate(&MeasureKind::TableRatio(comparison.clone()), &recording).unwrap();
    assert!((ratio - 0.975).abs() < 1e-14);
    assert_eq!(evaluate(&MeasureKind::TableBars(comparison.clone()), &recording).unwrap(), 1.0);
    let without = Comparison { low_column: None, ..comparison };
    assert!(
        evaluate(&MeasureKind::TableBars(without), &recording).unwrap_err().to_string().contains("without the columns")
    );
}

#[test]
fn a_curve_through_the_cells_of_mills_meets_all_their_bars() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/optical_tweezers/data/mills2004_b.csv");
    let table = Table::read(&file).unwrap();
    let (force, axial) = (table.column("F_pN").unwrap(), table.column("A_um").unwrap());
    // A staircase: each load is held for two frames, and the cell has settled in the second.
    let twice = |values: &[f64], first: f64| values.iter().flat_map(|y| [first * y, *y]).collect::<Vec<f64>>();
    let recording = |stretch: f64| {
        let load = twice(force, 1.0);
        let sizes = twice(axial, 0.9).into_iter().map(|size| stretch * size).collect();
        Recording {
            times: (0..load.len()).map(|frame| frame as f64).collect(),
            types: vec!["red".to_owned()],
            cell_types: vec![0],
            cells: BTreeMap::from([("size_x".to_owned(), Array2::from_shape_vec((load.len(), 1), sizes).unwrap())]),
            scene: BTreeMap::from([("load.pull".to_owned(), load)]),
            ..Recording::default()
        }
    };
    let comparison = Comparison {
        table: file.clone(),
        x_column: "F_pN".into(),
        y_column: "A_um".into(),
        low_column: Some("Amin".into()),
        high_column: Some("Amax".into()),
        x: "load.pull".into(),
        y: "size_x".into(),
        cells: None,
    };
    let [rms, ratio, bars] = [MeasureKind::TableRms, MeasureKind::TableRatio, MeasureKind::TableBars]
        .map(|kind| move |recording: &Recording, of: &Comparison| evaluate(&kind(of.clone()), recording).unwrap());
    // Interpolation at the points themselves is exact; a twentieth more is a twentieth off in each row.
    assert_eq!(rms(&recording(1.0), &comparison), 0.0);
    assert_eq!(bars(&recording(1.0), &comparison), table.rows() as f64);
    assert!((rms(&recording(1.05), &comparison) - 0.05).abs() < 1e-14);
    assert!((ratio(&recording(1.05), &comparison) - 1.05).abs() < 1e-14);
    // No bar reaches a quarter beyond its mean.
    assert_eq!(bars(&recording(1.25), &comparison), 0.0);
}

/// Persistence of the walkers below, s, and the number of frames, four of which fill it.
const PERSISTENCE: f64 = 20.0;
const FRAMES: usize = 81;

/// Walkers of speed 1 in the plane; written anew so that measures are tested without the motility they measure.
fn walkers(number: u32) -> Recording {
    let times: Vec<f64> = (0..FRAMES).map(|frame| frame as f64 * PERSISTENCE / 4.0).collect();
    let shape = (FRAMES, number as usize);
    let (mut x, mut y, z) = (Array2::zeros(shape), Array2::zeros(shape), Array2::zeros(shape));
    let mut runs = Vec::new();
    for cell in 0..number {
        let mut uniform = noise::uniform(1 + u64::from(cell));
        let (mut begin, mut position, mut frame) = (0.0, [0.0, 0.0], 0);
        while frame < FRAMES {
            let duration = -PERSISTENCE * (-uniform()).ln_1p();
            let (sine, cosine) = (std::f64::consts::TAU * uniform()).sin_cos();
            while frame < FRAMES && times[frame] <= begin + duration {
                x[[frame, cell as usize]] = position[0] + cosine * (times[frame] - begin);
                y[[frame, cell as usize]] = position[1] + sine * (times[frame] - begin);
                frame += 1;
            }
            position = [position[0] + cosine * duration, position[1] + sine * duration];
            begin += duration;
            if begin <= times[FRAMES - 1] {
                runs.push((cell as usize, begin, duration));
            }
        }
    }
    let cells =
        [("position_x", x), ("position_y", y), ("position_z", z)].map(|(name, series)| (name.to_owned(), series));
    Recording {
        times,
        types: vec!["amoeba".to_owned()],
        cell_types: vec![0; number as usize],
        cells: BTreeMap::from(cells),
        runs,
        ..Recording::default()
    }
}

fn msd_deviation(speed: f64, persistence: f64, lag_from: f64, lag_to: f64) -> MeasureKind {
    let [persistence, lag_from, lag_to] = [persistence, lag_from, lag_to].map(Time::new);
    MeasureKind::MsdDeviation { cells: None, speed: Speed::new(speed), persistence, lag_from, lag_to }
}

#[test]
fn walkers_agree_with_fuerths_law_and_with_no_other() {
    let recording = walkers(2_000);
    let deviation = |speed: f64, persistence: f64| {
        let (lag_from, lag_to) = (PERSISTENCE / 4.0, 10.0 * PERSISTENCE);
        evaluate(&msd_deviation(speed, persistence, lag_from, lag_to), &recording).unwrap()
    };
    // Three standard errors, and far more where speed or persistence are a fifth off.
    assert!(deviation(1.0, PERSISTENCE) < 3.0);
    assert!(deviation(1.2, PERSISTENCE) > 8.0);
    assert!(deviation(1.0, 1.2 * PERSISTENCE) > 5.0);
}

#[test]
fn runs_cut_by_the_end_do_not_bias_their_law() {
    // A short recording, of which the plain comparison of all runs that ended would be wrong.
    let mut recording = walkers(2_000);
    recording.times.truncate(17);
    let last = recording.times[16];
    recording.runs.retain(|(_, end, _)| *end <= last);
    let p = |persistence| {
        let persistence = Time::new(persistence);
        evaluate(&MeasureKind::RunLengthP { cells: None, persistence }, &recording).unwrap()
    };
    assert!(p(PERSISTENCE) > 0.01);
    assert!(p(1.2 * PERSISTENCE) < 1e-4);
    let all: Vec<f64> = recording.runs.iter().map(|run| run.2).collect();
    let plain = statistics::kolmogorov_smirnov(&all, |duration| -(-duration / PERSISTENCE).exp_m1()).unwrap();
    assert!(plain.p_value < 1e-4, "{plain:?}");
}

#[test]
fn displacements_need_two_cells_and_time_enough() {
    let measure = |lag_to| msd_deviation(1.0, 20.0, 5.0, lag_to);
    let recording = walkers(3);
    assert!(evaluate(&measure(400.0), &recording).is_ok());
    assert!(evaluate(&measure(401.0), &recording).unwrap_err().to_string().contains("81 frames of 400 s"));
    assert!(evaluate(&measure(400.0), &walkers(1)).unwrap_err().to_string().contains("of 1 cells"));
}

#[test]
fn displacements_go_by_the_times_of_frames() {
    // Frames as an adaptive step leaves them: every third only, then all but a few.
    let mut recording = walkers(2_000);
    let kept: Vec<usize> = (0..FRAMES).filter(|frame| frame % 3 == 0 || (*frame > 40 && frame % 5 != 0)).collect();
    recording.times = kept.iter().map(|&frame| recording.times[frame]).collect();
    for series in recording.cells.values_mut() {
        *series = series.select(ndarray::Axis(0), &kept);
    }
    let measure = |lag_to| msd_deviation(1.0, 20.0, 5.0, lag_to);
    assert!(evaluate(&measure(200.0), &recording).unwrap() < 3.0);
}
