//! Pictures of a fit: the data with the fitted curve above their residuals, and the profile of each parameter.

use super::identifiable::percent;
use super::observed::{Beside, Observed};
use super::outcome::{Compared, Estimated, Outcome};
use super::space::Axis as Parameter;
use crate::picture::chart::{Legend, Marker};
use crate::picture::colour::Colour;
use crate::picture::field_view::with_unit;
use crate::picture::{Axis, Chart, Series};

/// A picture of a fit: charts below each other with the height of each, px.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The name of its files.
    pub name: String,
    /// Its charts, the uppermost first.
    pub charts: Vec<(Chart, f64)>,
}

/// Heights of an overlay, of the residuals below it, and of a profile, px.
const HEIGHTS: [f64; 3] = [420.0, 240.0, 420.0];

/// All pictures of a fit.
pub fn figures(outcome: &Outcome, title: &str) -> Vec<Figure> {
    let mut groups: Vec<Vec<&Compared>> = Vec::new();
    for one in outcome.compared.iter().filter(|one| matches!(one.observed.beside, Beside::Curve { .. })) {
        match groups.iter_mut().find(|group| stand_together(&group[0].observed, &one.observed)) {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    let alone = groups.len() == 1;
    let overlays = groups.iter().map(|group| {
        let name = if alone { "fit".to_owned() } else { file_name("fit", &group[0].observed.name) };
        Figure { name, charts: vec![(overlay(group, title), HEIGHTS[0]), (residuals(group), HEIGHTS[1])] }
    });
    let profiles = outcome.each().filter(|(_, found)| found.profile.is_some()).map(|(parameter, found)| Figure {
        name: file_name("profile", &parameter.column.name),
        charts: vec![(profile(outcome, parameter, found, title), HEIGHTS[2])],
    });
    overlays.chain(profiles).collect()
}

/// A name of a file with all that files may be named with on any system.
fn file_name(begins: &str, name: &str) -> String {
    let sign = |sign: char| if sign.is_alphanumeric() || "-_.".contains(sign) { sign } else { '_' };
    format!("{begins}_{}", name.chars().map(sign).collect::<String>())
}

/// Whether two share their axes.
fn stand_together(one: &Observed, other: &Observed) -> bool {
    let x = |of: &Observed| match &of.beside {
        Beside::Curve { x, .. } => x.clone(),
        Beside::Measure(name) => name.clone(),
    };
    one.units == other.units && x(one) == x(other)
}

fn x_axis(of: &Observed) -> Axis {
    let Beside::Curve { x, .. } = &of.beside else { return Axis::linear("") };
    Axis::linear(with_unit(&spoken(x), &of.units[0]))
}

/// A series as a reader says it.
fn spoken(series: &str) -> String {
    series.replace(['_', '.'], " ")
}

/// So many series are named on an axis.
const MOST_NAMES: usize = 3;

fn overlay(group: &[&Compared], title: &str) -> Chart {
    let name = |of: &Observed| match &of.beside {
        Beside::Curve { y, .. } => spoken(y),
        Beside::Measure(name) => spoken(name),
    };
    let first = &group[0].observed;
    let mut names: Vec<String> = group.iter().map(|one| name(&one.observed)).collect();
    names.dedup();
    let label = if names.len() <= MOST_NAMES { names.join(", ") } else { "fitted".to_owned() };
    let mut chart = Chart { title: title.to_owned(), x: x_axis(first), ..Chart::default() };
    chart.y = Axis::linear(with_unit(&label, &first.units[1]));
    for (index, one) in group.iter().enumerate() {
        let colour = Colour::of_palette(index);
        chart.series.push(Series::line(format!("{}, fitted", one.observed.name), one.course.clone()).coloured(colour));
    }
    for (index, one) in group.iter().enumerate() {
        let points = one.observed.data.iter().map(|datum| [datum.x, datum.y]).collect();
        let bars = one.observed.data.iter().map(|datum| [datum.y - datum.error, datum.y + datum.error]).collect();
        let measured = Series::measured(format!("{}, measured", one.observed.name), points, bars);
        chart.series.push(measured.coloured(Colour::of_palette(index)));
    }
    chart
}

fn residuals(group: &[&Compared]) -> Chart {
    let first = &group[0].observed;
    let mut chart =
        Chart { x: x_axis(first), y: Axis::linear("residual / error"), legend: Legend::Hidden, ..Chart::default() };
    let ends = group
        .iter()
        .flat_map(|one| &one.course)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point[0]), high.max(point[0])]);
    // As far as the curve above, so that both charts have the same axis.
    chart.series.push(Series::dashed("", ends.iter().map(|x| [*x, 0.0]).collect()));
    for (index, one) in group.iter().enumerate() {
        let points =
            one.observed.data.iter().zip(one.residuals()).map(|(datum, residual)| [datum.x, residual]).collect();
        chart.series.push(Series::measured("", points, Vec::new()).coloured(Colour::of_palette(index)));
    }
    chart
}

fn profile(outcome: &Outcome, parameter: &Parameter, found: &Estimated, title: &str) -> Chart {
    let label = with_unit(&parameter.column.name, parameter.column.kind.unit().unwrap_or("1"));
    let mut chart =
        Chart { title: title.to_owned(), x: Axis::linear(label), y: Axis::linear("χ²"), ..Chart::default() };
    let best = [found.value, outcome.chi2];
    let ends = [found.points[0][0], found.points[found.points.len() - 1][0]];
    let level = outcome.chi2 + outcome.rise;
    chart.series.push(Series::line("χ², all others at their best", found.points.clone()));
    let told = format!("{} % interval ends here", percent(outcome.confidence));
    chart.series.push(Series::dashed(told, ends.map(|end| [end, level]).to_vec()));
    chart.series.push(Series::measured("", found.points.clone(), Vec::new()).coloured(Colour::of_palette(0)));
    chart.series.push(Series::measured("best value", vec![best], Vec::new()).marked(Marker::Diamond));
    chart
}
