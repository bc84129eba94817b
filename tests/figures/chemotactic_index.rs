//! The experiment `chemotactic_index` beside the indices that were measured in eight gradients, channel by channel.

use pseudopod::analysis::recording::{POSITION, Recording};
use pseudopod::analysis::statistics::{mean, standard_error};
use pseudopod::analysis::tracks::Tracks;
use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};
use std::collections::BTreeMap;
use std::path::Path;

use crate::index_table::{Measured, index_table};

/// Length of a channel, and of the parts of it in which indices were measured, µm.
const CHANNEL: f64 = 1_000.0;
const BIN: f64 = 100.0;
/// Frames of ten seconds in the two minutes of a piece.
const PIECE: usize = 12;

/// A measured index, with what cells do at its concentration (nM) in its gradient (nM/mm).
struct Row {
    concentration: f64,
    measured: f64,
    pieces: Vec<f64>,
}

/// The rows of the table by channel: the gradient and the concentration at the lower end.
fn channels() -> Option<BTreeMap<(u64, u64), Vec<Row>>> {
    let mut channels = BTreeMap::new();
    for Measured { concentration, gradient, index } in index_table()? {
        // A channel spans as many nM as the gradient has in its millimetre.
        let low = (concentration / gradient).floor() * gradient;
        let rows: &mut Vec<Row> = channels.entry((gradient as u64, low as u64)).or_default();
        rows.push(Row { concentration, measured: index, pieces: Vec::new() });
    }
    Some(channels)
}

/// Runs a channel and sorts the indices of pieces of two minutes by where the cells were.
fn measure(seed: usize, (gradient, low): (u64, u64), rows: &mut [Row]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/chemotactic_index/channel.toml");
    let slope = gradient as f64 / CHANNEL;
    let sets = [
        format!("seed={seed}"),
        "cells.amoeba.number=360".to_owned(),
        "run.until=9 min".to_owned(),
        format!("chemistry.gradient.set={{ low = {low}, slope = {slope} }}"),
    ];
    let document = Document::read(&path, &sets).expect("a good document");
    let scratch = tempfile::tempdir().expect("a folder");
    let result = scratch.path().join("result.h5");
    run(&document, &RunOptions::new(&result), &mut Quiet).expect("a run");
    let result = ResultFile::open(&result).expect("a result");
    let recording = Recording::read(&result, &POSITION).expect("positions");
    // The first minute, in which receptors are bound and shapes settle, does not count.
    let tracks = Tracks::of(&recording, None).expect("tracks").along(2).between(Some(60.0), None).expect("frames");
    for track in 0..tracks.number() {
        for first in (0..tracks.times.len().saturating_sub(PIECE)).step_by(PIECE) {
            let at: Vec<[f64; 3]> = (first..=first + PIECE).map(|frame| tracks.position(frame, track)).collect();
            let path: f64 = at.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum();
            let x = at.iter().map(|position| position[0]).sum::<f64>() / at.len() as f64;
            let concentration = low as f64 + slope * x;
            let row = rows.iter_mut().find(|row| (row.concentration - concentration).abs() <= 0.5 * slope * BIN);
            if let Some(row) = row {
                row.pieces.push((at[PIECE][0] - at[0][0]) / path);
            }
        }
    }
}

#[test]
#[ignore = "slow: fourteen channels of 360 cells, some fifteen minutes of one core"]
fn indices_follow_the_measured_table_over_four_decades() {
    let Some(mut channels) = channels() else { return };
    let (mut squares, mut errors, mut number, mut peaks) = (0.0, 0.0, 0, BTreeMap::new());
    println!("nM/mm     nM  measured  simulated");
    for (seed, (channel, rows)) in channels.iter_mut().enumerate() {
        measure(seed + 1, *channel, rows);
        for row in rows.iter() {
            let (index, error) = (mean(&row.pieces), standard_error(&row.pieces));
            println!("{} {} {:.3} {index:.3} ± {error:.3}", channel.0, row.concentration, row.measured);
            squares += (index - row.measured).powi(2);
            errors += error * error;
            number += 1;
            let peak = peaks.entry(channel.0).or_insert(f64::NEG_INFINITY);
            *peak = f64::max(*peak, index);
        }
    }
    let rms = (squares / f64::from(number)).sqrt();
    let chance = (errors / f64::from(number)).sqrt();
    println!("{number} rows: rms {rms:.4}, of which chance has {chance:.4}; peaks by gradient {peaks:?}");
    assert!(rms < 0.1, "{rms}");
    // At saturation the best index falls.
    let highest = peaks.values().copied().fold(f64::NEG_INFINITY, f64::max);
    let steepest = peaks.last_key_value().expect("a channel").1;
    assert!(*steepest < highest - 0.1, "{steepest} in the steepest gradient, {highest} at best");
}
