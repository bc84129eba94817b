//! Charts of a result file, as the experiment or the command line asks for them.

use super::chart::{Axis, Chart, Scale, Series, Stroke};
use super::colour::Colour;
use super::documented::type_colours;
use super::field_plots;
use super::field_view::{unit_text, with_unit};
use super::track_plots::{self, Group, SECTORS};
use crate::analysis::over::Over;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::table::Table;
use crate::analysis::tracks::Tracks;
use crate::cell::motility::Space;
use crate::error::{Error, Fault, Result};
use crate::experiment::{Document, MeasureCurve, OneOrMany, Plot, PlotKind, PlotTable};
use crate::output::ResultFile;

/// Colour of measured points.
const MEASURED: Colour = Colour([0x33, 0x33, 0x33]);

/// A series' name as a reader would say it, with its unit.
pub fn label_of(result: &ResultFile, series: &str) -> String {
    if series == "time" {
        return "time (s)".into();
    }
    let unit = result.units(series).unwrap_or_default();
    with_unit(&result.label(series), &unit)
}

/// The chart that a plot asks for.
///
/// # Errors
/// A series, table or column that is not there.
pub fn chart_of(result: &ResultFile, document: &Document, plot: &Plot) -> Result<Chart> {
    let mut chart = match &plot.kind {
        PlotKind::Series { y, each_cell } => {
            let mut chart = curves(result, document, plot, "time", y.as_slice())?;
            if *each_cell {
                chart.series.splice(0..0, lines_of_cells(result, document, plot, y.as_slice())?);
            }
            chart
        }
        PlotKind::Curve { x, y } => curves(result, document, plot, x, y.as_slice())?,
        PlotKind::Tracks => track_plots::paths(&groups(result, document, plot)?),
        PlotKind::Msd { speed, persistence } => {
            let formula = speed.zip(*persistence).map(|(v, p)| (v.value(), p.value()));
            track_plots::displacements(&groups(result, document, plot)?, formula, result.header().seed)
        }
        PlotKind::SpeedPersistence => {
            let in_plane = |group: Group| Group { tracks: group.tracks.along(Space::Plane.axes()), ..group };
            let groups: Vec<Group> = groups(result, document, plot)?.into_iter().map(in_plane).collect();
            track_plots::speed_persistence(&groups, result.header().seed)?
        }
        PlotKind::Measures { x, log_x, curves } => measures(result, x, *log_x, curves)?,
        PlotKind::Rose { sectors } => track_plots::rose(&groups(result, document, plot)?, sectors.unwrap_or(SECTORS))?,
        PlotKind::Histogram { quantity, bins } => {
            track_plots::histogram(&groups(result, document, plot)?, *quantity, *bins)?
        }
        PlotKind::Profile { line, times } => field_plots::profile(result, line, times.as_ref())?,
        PlotKind::Kymograph { line, range, log } => {
            let scale = if *log { Scale::Log } else { Scale::Linear };
            field_plots::kymograph(result, line, *range, scale)?
        }
    };
    let tables = plot.table.as_ref().map_or(&[][..], |tables| tables.as_slice());
    for table in tables {
        chart.series.extend(measured(document, table)?);
    }
    chart.title = plot.title.clone().unwrap_or_else(|| document.experiment.title.clone());
    plot.x_label.iter().for_each(|label| chart.x.label.clone_from(label));
    plot.y_label.iter().for_each(|label| chart.y.label.clone_from(label));
    Ok(chart)
}

/// The colour that each type of cells has in pictures, where there are several: charts have the same.
fn colours_of_types(result: &ResultFile, document: &Document) -> impl Fn(&str) -> Option<Colour> {
    let (names, colours) = (result.layout().type_names(), type_colours(result, document));
    move |kind: &str| names.iter().position(|name| name == kind).filter(|_| names.len() > 1).map(|kind| colours[kind])
}

/// The types that a plot shows, each as a curve of its own.
fn types_of(result: &ResultFile, plot: &Plot) -> Vec<String> {
    plot.cells.as_ref().map_or_else(|| result.layout().type_names(), |name| vec![name.clone()])
}

fn curves(result: &ResultFile, document: &Document, plot: &Plot, x: &str, series: &[String]) -> Result<Chart> {
    let names: Vec<&str> = std::iter::once(x).chain(series.iter().map(String::as_str)).collect();
    // A name that the file does not know is told beside those that it does.
    names.iter().try_for_each(|name| result.units(name).map(drop))?;
    let recording = Recording::read(result, &names)?;
    let (types, colour) = (types_of(result, plot), colours_of_types(result, document));
    let mut chart = Chart { x: Axis::linear(label_of(result, x)), ..Chart::default() };
    let units: Vec<String> = series.iter().map(|y| result.units(y)).collect::<Result<_>>()?;
    let alike = units.windows(2).all(|pair| pair[0] == pair[1]);
    let lives =
        |name: &str, kind: &str| !recording.cells.contains_key(name) || recording.cells_with(name, Some(kind)).is_ok();
    let nobody = [String::new()];
    for y in series {
        // A series of the scene against time is the same for all types.
        let shared = x == "time" && recording.scene.contains_key(y);
        // A scene without cells has no type, but may have series of its own.
        let drawn = if shared { types.get(..1).unwrap_or(&nobody) } else { &types[..] };
        for kind in drawn {
            // A system of chemistry may live in the cells of some types only.
            if !(shared || lives(x, kind) && lives(y, kind)) {
                continue;
            }
            let points: Vec<[f64; 2]> = if x == "time" {
                let values = recording.series(y, Some(kind), Over::Mean)?;
                recording.times.iter().zip(values).map(|(t, v)| [*t, v]).collect()
            } else {
                recording.curve(x, y, Some(kind))?.points().collect()
            };
            let named = if alike { result.label(y) } else { label_of(result, y) };
            let label = match (series.len(), types.len()) {
                (1, _) if shared => String::new(),
                (1, 1) => String::new(),
                (1, _) => kind.clone(),
                (_, 1) => named,
                _ if shared => named,
                _ => format!("{kind}: {named}"),
            };
            // Among lines of single cells.
            let is_mean = plot.kind.shows_each_cell() && are_means(&recording, y, kind);
            let label = match (is_mean, label.is_empty()) {
                (true, true) => "mean".to_owned(),
                (true, false) => format!("{label}, mean"),
                (false, _) => label,
            };
            let line = Series::line(label, points);
            chart.series.push(match colour(kind).filter(|_| series.len() == 1 && !shared) {
                Some(colour) => line.coloured(colour),
                None => line,
            });
        }
    }
    if chart.series.is_empty() {
        let fault = Fault::new(format!("no cell of {} has a value of {}", types.join(", "), series.join(", ")));
        return Err(Error::input(fault.help("choose a type of cells with that system of chemistry")));
    }
    let mut all = series.iter().flat_map(|y| types.iter().map(move |kind| (y, kind)));
    let is_mean = !plot.kind.shows_each_cell() && all.any(|(y, kind)| are_means(&recording, y, kind));
    let label = match series {
        [only] if is_mean => format!("mean {}", label_of(result, only)),
        [only] => label_of(result, only),
        _ if alike => units.first().map_or_else(String::new, |unit| unit_text(unit)),
        _ => String::new(),
    };
    let label = match (is_mean && series.len() > 1, label.is_empty()) {
        (true, true) => "means of the cells".to_owned(),
        (true, false) => format!("means of the cells ({label})"),
        (false, _) => label,
    };
    chart.y = Axis::linear(label);
    Ok(chart)
}

/// Whether the curve of a series of the cells of a type is the mean over several.
fn are_means(recording: &Recording, series: &str, kind: &str) -> bool {
    recording.cells.contains_key(series) && recording.cells_of(Some(kind)).is_ok_and(|cells| cells.len() > 1)
}

/// A thin line for every cell, pale in the colour that its type's mean has.
fn lines_of_cells(result: &ResultFile, document: &Document, plot: &Plot, series: &[String]) -> Result<Vec<Series>> {
    let of_type = colours_of_types(result, document);
    let recording = Recording::read(result, &series.iter().map(String::as_str).collect::<Vec<_>>())?;
    let (mut lines, mut number) = (Vec::new(), 0);
    for y in series {
        let Some(values) = recording.cells.get(y) else { continue };
        for kind in types_of(result, plot) {
            let cells = recording.cells_of(Some(&kind))?;
            let own = of_type(&kind).filter(|_| series.len() == 1);
            let colour = own.unwrap_or_else(|| Colour::of_palette(number)).mixed(Colour([0xff; 3]), 0.62);
            let mut drawn = false;
            for cell in cells {
                let of_cell = recording.times.iter().zip(values.column(cell)).enumerate();
                let there = of_cell.filter(|(frame, _)| recording.is_there(*frame, cell));
                let points: Vec<[f64; 2]> = there.map(|(_, (t, v))| [*t, *v]).collect();
                if points.iter().any(|point| !point[1].is_nan()) {
                    drawn = true;
                    let (label, stroke, width) = (String::new(), Stroke::Solid, 0.9);
                    lines.push(Series::Line { label, points, colour: Some(colour), stroke, width });
                }
            }
            number += usize::from(drawn);
        }
    }
    Ok(lines)
}

/// The tracks of each type that a plot shows.
fn groups(result: &ResultFile, document: &Document, plot: &Plot) -> Result<Vec<Group>> {
    let recording = Recording::read(result, &POSITION)?;
    let colour = colours_of_types(result, document);
    let group =
        |label: String| Ok(Group { tracks: Tracks::of(&recording, Some(&label))?, colour: colour(&label), label });
    types_of(result, plot).into_iter().map(group).collect()
}

/// Measures of a finished run against what each belongs to.
fn measures(result: &ResultFile, x: &[f64], log_x: bool, curves: &[MeasureCurve]) -> Result<Chart> {
    let found = result.summary()?;
    let one = |name: &String| {
        found.iter().find(|measure| measure.name == *name).ok_or_else(|| {
            let fault = Fault::new(format!("the result has no measure \"{name}\""));
            Error::input(fault.help("measures are taken where a run has come to its end: resume it, then plot again"))
        })
    };
    let values = |names: &OneOrMany<String>| -> Result<Vec<f64>> {
        names.as_slice().iter().map(|name| Ok(one(name)?.value)).collect()
    };
    let scale = if log_x { Scale::Log } else { Scale::Linear };
    let mut chart = Chart { x: Axis { scale, ..Axis::linear("") }, ..Chart::default() };
    for (number, curve) in curves.iter().enumerate() {
        let points: Vec<[f64; 2]> = x.iter().zip(values(&curve.y)?).map(|(x, y)| [*x, y]).collect();
        let bars = match (&curve.low, &curve.high) {
            (Some(low), Some(high)) => values(low)?.into_iter().zip(values(high)?).map(|(l, h)| [l, h]).collect(),
            _ => Vec::new(),
        };
        let colour = Colour::of_palette(number);
        chart.series.push(Series::line(String::new(), points.clone()).coloured(colour));
        chart.series.push(Series::measured(curve.label.clone(), points, bars).coloured(colour));
    }
    let first = curves.first().and_then(|curve| curve.y.as_slice().first());
    let unit = first.map_or(Ok(String::new()), |name| one(name).map(|measure| unit_text(&measure.unit)))?;
    chart.y = Axis::linear(unit);
    Ok(chart)
}

/// The points and bars of a measured table.
fn measured(document: &Document, text: &PlotTable) -> Result<Vec<Series>> {
    let mut table = Table::read(&document.resolve(&text.file))?;
    table.shift(&text.x, text.x_shift)?;
    let x = table.column(&text.x)?;
    let ends = |columns: &Option<OneOrMany<String>>, i: usize| -> Result<Option<Vec<f64>>> {
        let name = columns.as_ref().and_then(|columns| columns.as_slice().get(i));
        name.map(|name| Ok(table.column(name)?.to_vec())).transpose()
    };
    let mut series = Vec::new();
    for (i, name) in text.y.as_slice().iter().enumerate() {
        let y = table.column(name)?;
        let points: Vec<[f64; 2]> = x.iter().zip(y).map(|(x, y)| [*x, *y]).collect();
        let bars = match (ends(&text.low, i)?, ends(&text.high, i)?) {
            (Some(low), Some(high)) => low.into_iter().zip(high).map(|(l, h)| [l, h]).collect(),
            _ => Vec::new(),
        };
        let label = match (&text.label, i) {
            (Some(label), 0) => label.clone(),
            (Some(_), _) => String::new(),
            (None, _) => name.clone(),
        };
        series.push(Series::measured(label, points, bars).coloured(MEASURED));
    }
    Ok(series)
}
