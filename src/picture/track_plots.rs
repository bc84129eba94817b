//! Charts of tracks, simulated or measured: paths, displacements, directions, and how a number of tracks is distributed.

use super::chart::{Aspect, Axis, Chart, Ground, Legend, Marker, Range, Scale, Series, Stroke};
use super::colour::Colour;
use super::field_view::with_unit;
use super::ticks::nice_above;
use crate::analysis::circular;
use crate::analysis::furth::{Localisation, furth};
use crate::analysis::msd;
use crate::analysis::speed_persistence::{Point, relation};
use crate::analysis::statistics::mean;
use crate::analysis::tracks::motion::{Quantity, turning_angles};
use crate::analysis::tracks::{Tracks, summary};
use crate::error::{Error, Fault, Result};
use std::f64::consts::TAU;

/// Tracks under one name, such as those of a type of cells.
pub struct Group {
    /// What the legend calls them.
    pub label: String,
    /// The tracks.
    pub tracks: Tracks,
    /// Their colour, that of the type in pictures; the next of the palette when absent, and of paths one for each.
    pub colour: Option<Colour>,
}

/// The paths of the cells seen from above.
pub fn paths(groups: &[Group]) -> Chart {
    let mut chart =
        Chart { x: Axis::linear("x (µm)"), y: Axis::linear("y (µm)"), aspect: Aspect::Equal, ..Chart::default() };
    for Group { tracks, label, colour } in groups {
        let point =
            |frame: usize, track: usize| [tracks.positions[[frame, track, 0]], tracks.positions[[frame, track, 1]]];
        // A cell that comes late or leaves has a track where it is.
        let path = |track: usize| tracks.frames_of(track).map(|frame| point(frame, track)).collect();
        let tracks = (0..tracks.number()).map(path).collect();
        // What has one colour has a name.
        let label = colour.map_or_else(String::new, |_| label.clone());
        chart.series.push(Series::Tracks { label, tracks, colour: *colour });
    }
    chart
}

/// Most lags of a curve of displacements: more would lie on top of each other.
const MOST_LAGS: usize = 40;

/// The mean squared displacement over windows that overlap, eq. (analysis.5), with its interval, eq. (analysis.19), up to half of the frames.
///
/// * `formula` – speed (µm/s) and persistence (s) for a curve of Fürth's formula.
pub fn displacements(groups: &[Group], formula: Option<(f64, f64)>, seed: u64) -> Chart {
    let mut chart = Chart {
        x: Axis { scale: Scale::Log, ..Axis::linear("lag (s)") },
        y: Axis { scale: Scale::Log, ..Axis::linear("mean squared displacement (µm²)") },
        ..Chart::default()
    };
    for (index, Group { label, tracks, colour }) in groups.iter().enumerate() {
        let colour = colour.unwrap_or_else(|| Colour::of_palette(index));
        let of = msd::of_cells(tracks.positions.view(), &tracks.times, &lags(tracks.times.len()));
        let found = of.displacements();
        let points: Vec<[f64; 2]> = found.iter().map(|one| [one.lag, one.msd]).collect();
        let band = points.iter().zip(of.intervals(seed)).map(|([lag, _], [low, high])| [*lag, low, high]).collect();
        chart.series.push(Series::band(label.clone(), band).coloured(colour));
        chart.series.push(Series::line(label.clone(), points).coloured(colour));
        if let Some((speed, persistence)) = formula {
            let points = found.iter().map(|one| [one.lag, furth(one.lag, speed, persistence)]).collect();
            chart.series.push(Series::dashed("Fürth's formula", points).coloured(Colour([0x33; 3])));
        }
    }
    chart
}

/// Speed and persistence of each group with its interval, and the line ln p = a + b v through them, eq. (analysis.36), where there are three
/// groups or more.
///
/// # Errors
/// When the persistence of a group cannot be told.
pub fn speed_persistence(groups: &[Group], seed: u64) -> Result<Chart> {
    let point = |group: &Group| Point::of(&group.tracks, Localisation::Exact, seed);
    let found: Vec<Point> = groups.iter().map(point).collect::<Result<_>>()?;
    let mut chart = Chart {
        x: Axis::linear("mean speed (µm/min)"),
        y: Axis { scale: Scale::Log, ..Axis::linear("persistence (s)") },
        ..Chart::default()
    };
    let per_minute = |speed: f64| 60.0 * speed;
    if let Ok(relation) = relation(&found) {
        let speeds = found.iter().map(|point| point.speed);
        let ends = speeds.fold([f64::INFINITY, 0.0_f64], |[low, high], v| [low.min(v), high.max(v)]);
        let points = ends.map(|v| [per_minute(v), (relation.line.intercept + relation.line.slope * v).exp()]);
        let label = format!("line of ln p: r = {}", digits(relation.correlation));
        chart.series.push(Series::dashed(label, points.to_vec()).coloured(Colour([0x33; 3])));
    }
    for (Group { label, colour, .. }, point) in groups.iter().zip(&found) {
        chart.series.push(Series::Points {
            label: label.clone(),
            points: vec![[per_minute(point.speed), point.persistence.value]],
            bars: vec![[point.persistence.low, point.persistence.high]],
            colour: *colour,
            marker: Marker::default(),
        });
    }
    Ok(chart)
}

/// Lags in frames: all up to half of the frames, or some in equal ratios.
fn lags(frames: usize) -> Vec<usize> {
    let last = (frames.saturating_sub(1) / 2).max(1);
    if last <= MOST_LAGS {
        return (1..=last).collect();
    }
    let at = |index: usize| (last as f64).powf(index as f64 / (MOST_LAGS - 1) as f64).round() as usize;
    let mut lags: Vec<usize> = (0..MOST_LAGS).map(at).collect();
    lags.dedup();
    lags
}

/// Sectors of a rose where nobody says how many.
pub const SECTORS: u32 = 16;

/// How many net displacements in the plane point into each sector, and their mean, eq. (analysis.27). A displacement on the border of two sectors counts for the one to the left.
///
/// # Errors
/// When no cell ends elsewhere than it began.
pub fn rose(groups: &[Group], sectors: u32) -> Result<Chart> {
    let width = TAU / f64::from(sectors);
    let counted: Vec<(&Group, Vec<f64>, Vec<u32>)> = groups
        .iter()
        .map(|group| {
            let directions = summary::directions(&group.tracks);
            let mut counts = vec![0; sectors as usize];
            for direction in directions.iter().filter(|direction| !direction.is_nan()) {
                // The first sector has the x axis in its middle.
                let sector = ((direction + 0.5 * width).rem_euclid(TAU) / width) as usize;
                counts[sector.min(sectors as usize - 1)] += 1;
            }
            (group, directions, counts)
        })
        .collect();
    let most = counted.iter().flat_map(|(_, _, counts)| counts).copied().max().unwrap_or(0);
    if most == 0 {
        let fault = Fault::new("no cell ends elsewhere in the plane than it began, so there are no directions");
        return Err(Error::input(fault.help("give tracks of cells that move")));
    }
    let radius = f64::from(most);
    let ground = Ground::Polar { radius };
    let around = Axis::linear("tracks in each sector; x points to 0°, y to 90°")
        .range(Range::Fixed(-1.16 * radius, 1.16 * radius));
    let y = Axis { label: String::new(), ..around.clone() };
    let mut chart = Chart { x: around, y, aspect: Aspect::Equal, ground, legend: Legend::Beside, ..Chart::default() };
    for (index, (group, directions, counts)) in counted.iter().enumerate() {
        let wedge = |(sector, count): (usize, &u32)| wedge((sector as f64 - 0.5) * width, width, f64::from(*count));
        let colour = group.colour.unwrap_or_else(|| Colour::of_palette(index));
        let outlines = counts.iter().enumerate().filter(|(_, count)| **count > 0).map(wedge).collect();
        chart.series.push(Series::Areas { label: group.label.clone(), outlines, colour: Some(colour) });
        let all = circular::describe(directions.iter().copied());
        let name = if groups.len() > 1 { format!("{}: ", group.label) } else { String::new() };
        let label = format!("{name}mean of {}: R = {}, p = {}", all.number, digits(all.resultant), digits(all.p_value));
        let end = [all.mean.cos(), all.mean.sin()].map(|part| part * all.resultant * radius);
        // Dark enough to stand out on the wedges of the same colour.
        let dark = colour.mixed(Colour([0; 3]), 0.55);
        chart.series.push(Series::Line {
            label,
            points: vec![[0.0; 2], end],
            colour: Some(dark),
            stroke: Stroke::Solid,
            width: 3.2,
        });
    }
    Ok(chart)
}

/// Three digits that count, one of what is next to nothing.
fn digits(value: f64) -> String {
    if value < 1e-3 {
        format!("{value:.0e}")
    } else {
        format!("{}", format!("{value:.2e}").parse::<f64>().unwrap_or(value))
    }
}

/// A sector of a circle about the origin, from an angle on.
fn wedge(from: f64, width: f64, radius: f64) -> Vec<[f64; 2]> {
    let pieces = (width / 0.02).ceil().max(1.0) as usize;
    let rim = (0..=pieces).map(|piece| from + width * piece as f64 / pieces as f64);
    std::iter::once([0.0; 2]).chain(rim.map(|angle| [radius * angle.cos(), radius * angle.sin()])).collect()
}

/// How a number is distributed over tracks; turning angles over all steps.
///
/// * `bins` – how many columns; by the rule of Freedman and Diaconis when absent.
///
/// # Errors
/// When no track has the number.
pub fn histogram(groups: &[Group], quantity: Quantity, bins: Option<u32>) -> Result<Chart> {
    let values_of = |group: &Group| -> Vec<f64> {
        let tracks = &group.tracks;
        let values = match quantity {
            Quantity::TurningAngle => (0..tracks.number()).flat_map(|track| turning_angles(tracks, track)).collect(),
            _ => quantity.of(tracks),
        };
        values.into_iter().filter(|value| !value.is_nan()).collect()
    };
    let values: Vec<Vec<f64>> = groups.iter().map(values_of).collect();
    let mut all: Vec<f64> = values.iter().flatten().copied().collect();
    if all.is_empty() {
        let fault = Fault::new(format!("no track has a {}: {}", quantity.label(), quantity.undefined()));
        return Err(Error::input(fault.help("give tracks of cells that move")));
    }
    all.sort_by(f64::total_cmp);
    let most = all[all.len() - 1].max(f64::MIN_POSITIVE);
    let range = match quantity {
        Quantity::Directness => 1.0,
        Quantity::TurningAngle => 180.0,
        _ => most,
    };
    let (bins, width) = match bins {
        Some(bins) => (bins.max(1), range / f64::from(bins.max(1))),
        None => {
            // Columns of a round width may go on beyond the largest value.
            let width = width_of(&all, range);
            ((range / width - 1e-9).ceil().clamp(1.0, 200.0) as u32, width)
        }
    };
    let (low, high, bins) = (0.0, width * f64::from(bins), bins as usize);
    let what = if quantity == Quantity::TurningAngle { "steps" } else { "tracks" };
    let name = with_unit(quantity.label(), quantity.unit());
    let mut chart = Chart {
        x: Axis::linear(name).range(Range::Fixed(low, high)),
        y: Axis::linear(format!("number of {what}")).range(Range::FromZero),
        ..Chart::default()
    };
    for (index, (group, values)) in groups.iter().zip(&values).enumerate().filter(|(_, (_, values))| !values.is_empty())
    {
        let mut counts = vec![0_u32; bins];
        for value in values {
            counts[(((value - low) / width) as usize).min(bins - 1)] += 1;
        }
        let column = |(bin, count): (usize, &u32)| {
            let (left, right, top) = (low + bin as f64 * width, low + (bin + 1) as f64 * width, f64::from(*count));
            vec![[left, 0.0], [left, top], [right, top], [right, 0.0]]
        };
        let colour = group.colour.unwrap_or_else(|| Colour::of_palette(index));
        let outlines = counts.iter().enumerate().filter(|(_, count)| **count > 0).map(column).collect();
        let label = if groups.len() > 1 { group.label.clone() } else { String::new() };
        chart.series.push(Series::Areas { label: label.clone(), outlines, colour: Some(colour) });
        let (middle, most) = (mean(values), counts.iter().copied().max().unwrap_or(0));
        let label = format!(
            "{}mean of {}: {}",
            if label.is_empty() { label } else { format!("{label}: ") },
            values.len(),
            digits(middle)
        );
        let dark = colour.mixed(Colour([0; 3]), 0.55);
        chart.series.push(Series::dashed(label, vec![[middle, 0.0], [middle, f64::from(most)]]).coloured(dark));
    }
    Ok(chart)
}

/// A round width of columns near that of Freedman and Diaconis, twice the range of the middle half over the cube root of the number, for sorted values; it fits between about
/// five and forty times into a range.
fn width_of(sorted: &[f64], range: f64) -> f64 {
    let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
    let width = 2.0 * (at(0.75) - at(0.25)) / (sorted.len() as f64).cbrt();
    nice_above((0.6 * width).clamp(range / 40.0, range / 10.0))
}
