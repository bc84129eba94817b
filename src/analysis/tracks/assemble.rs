//! Puts measured positions on common frames.

use super::set::Tracks;
use crate::analysis::csv_fields::location;
use crate::error::{Error, Fault, Result, Source};
use ndarray::Array3;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// One position of one track.
#[derive(Debug, Clone, PartialEq)]
pub struct Spot {
    /// What the track is called.
    pub track: String,
    /// The type of the cell, if it is known.
    pub kind: String,
    /// The number of the frame, if it is known.
    pub frame: Option<f64>,
    /// When, s.
    pub time: f64,
    /// Where, µm; NaN along z in the plane.
    pub position: [f64; 3],
    /// The bytes of its row.
    pub row: Range<usize>,
}

/// Most numbers that tracks on their frames may take: 1 GB.
const LARGEST: usize = 125_000_000;

/// At most this many faults are told of one file.
pub const MOST_FAULTS: usize = 10;

/// Tracks of spots, in the order in which tracks appear first. Frames are those that spots name, or else all times that there are.
///
/// # Errors
/// No spots; two times for a frame, or times that do not grow with it; two positions of a track in a frame; times that are all different.
pub fn assemble(spots: &[Spot], source: &Arc<Source>) -> Result<Tracks> {
    if spots.is_empty() {
        let fault = Fault::new(format!("{} has no positions of tracks", source.name));
        return Err(Error::input(fault.help("give a row for each track and frame")));
    }
    let (frames, times) = frames_of(spots, source)?;
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut names, mut types): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    for spot in spots {
        numbers.entry(&spot.track).or_insert_with(|| {
            names.push(spot.track.clone());
            types.push(spot.kind.clone());
            names.len() - 1
        });
    }
    let axes = if spots.iter().any(|spot| !spot.position[2].is_nan()) { 3 } else { 2 };
    if times.len() * names.len() * axes > LARGEST {
        let found = format!("{} tracks have {} different times in {} rows", names.len(), times.len(), spots.len());
        let help = "tracks must share their frames: add a column FRAME, or round times to the interval between frames";
        return Err(Error::input(Fault::new(found).help(help)));
    }
    let mut positions = Array3::from_elem((times.len(), names.len(), axes), f64::NAN);
    let mut faults = Vec::new();
    for (spot, frame) in spots.iter().zip(frames) {
        let mut at = positions.slice_mut(ndarray::s![frame, numbers[spot.track.as_str()], ..]);
        if !at[0].is_nan() && faults.len() < MOST_FAULTS {
            let found = format!("track {} has two positions at {} s", spot.track, times[frame]);
            let fault = Fault::new(found).at(location(source, spot.row.clone(), "the second one"));
            faults.push(
                fault.help("give each track one position a frame; tracks of several films need ids of their own"),
            );
        }
        (0..axes).for_each(|axis| at[axis] = spot.position[axis]);
    }
    if faults.is_empty() { Ok(Tracks { times, names, types, positions }) } else { Err(Error::Input(faults)) }
}

/// The index of the frame of each spot, and the times of the frames, s.
fn frames_of(spots: &[Spot], source: &Arc<Source>) -> Result<(Vec<usize>, Vec<f64>)> {
    // Without numbers of frames, times themselves number them.
    let key = |spot: &Spot| spot.frame.unwrap_or(spot.time);
    let mut keys: Vec<f64> = spots.iter().map(key).collect();
    keys.sort_by(f64::total_cmp);
    // The same time may have been rounded in two ways.
    let slack = 1e-9 * keys.iter().fold(0.0, |most: f64, key| most.max(key.abs()));
    keys.dedup_by(|later, earlier| *later - *earlier <= slack);
    let index = |spot: &Spot| keys.partition_point(|known| *known < key(spot) - slack);
    let frames: Vec<usize> = spots.iter().map(index).collect();
    let mut times: Vec<Option<f64>> = vec![None; keys.len()];
    let mut faults = Vec::new();
    let longest = spots.iter().fold(0.0, |most: f64, spot| most.max(spot.time.abs()));
    for (spot, frame) in spots.iter().zip(&frames) {
        let known = *times[*frame].get_or_insert(spot.time);
        // Times are written with at least six digits.
        if (known - spot.time).abs() > 1e-6 * longest && faults.len() < MOST_FAULTS {
            let found = format!("frame {} has the times {known} s and {} s", key(spot), spot.time);
            let fault = Fault::new(found).at(location(source, spot.row.clone(), "another time than before"));
            faults.push(fault.help("films of different intervals go into different files"));
        }
    }
    let times: Vec<f64> = times.into_iter().flatten().collect();
    if let (Some(at), true) = (times.windows(2).position(|pair| pair[1] <= pair[0]), faults.is_empty()) {
        let found = format!("frame {} is at {} s, and {} at {} s", keys[at], times[at], keys[at + 1], times[at + 1]);
        faults.push(Fault::new(found).help("times must grow with the number of the frame"));
    }
    if faults.is_empty() { Ok((frames, times)) } else { Err(Error::Input(faults)) }
}
