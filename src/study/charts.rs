//! A chart for each measure of a study: a curve over one parameter, a map over two, rank correlations with more, or Sobol's indices.

use super::bars::bars;
use super::collect::{Collected, Status};
use super::document::Design;
use super::ranks::correlation;
use super::sensitivity::{Sensitivity, sensitivity};
use super::variation::Column;
use crate::analysis::bootstrap::Estimate;
use crate::analysis::statistics::mean;
use crate::error::short;
use crate::picture::colour::{Colour, ColourMap};
use crate::picture::field_view::with_unit;
use crate::picture::{Axis, Chart, Heat, Range, Series, Shading};

/// Longest description that stands along an axis, letters; the name of the measure stands there otherwise.
const LONGEST_LABEL: usize = 48;
/// The same beside the colours of a map, where the number of runs follows.
const LONGEST_BAR: usize = 62;

/// The charts of all measures that some run has, each with the name of its files.
pub fn charts(collected: &Collected) -> Vec<(String, Chart)> {
    let facts = &collected.plan.facts;
    let mut made = Vec::new();
    for (index, measure) in facts.measures.iter().enumerate() {
        let data = Data::of(collected, index);
        if data.values.is_empty() {
            continue;
        }
        let chart = match (sensitivity(collected, index), &facts.parameters[..]) {
            (Some(found), columns) => shared_out(&found, &measure.name, columns),
            (None, [only]) => Some(curve(&data, only, facts.design.is_sampled())),
            (None, [one, other]) if facts.design == Design::Grid => Some(map(&data, one, other)),
            (None, columns) => ranked(&data, columns),
        };
        made.extend(chart.map(|chart| (measure.name.clone(), Chart { title: facts.title.clone(), ..chart })));
    }
    made
}

/// A measure of the runs that have it.
struct Data<'a> {
    collected: &'a Collected,
    /// Point, from 0, and value of each run.
    values: Vec<(u32, f64)>,
    /// Values of each point.
    points: Vec<Vec<f64>>,
    /// Name or description, with the unit.
    label: String,
    /// The name of the measure, and the same with its unit.
    name: &'a str,
    short: String,
}

impl<'a> Data<'a> {
    fn of(collected: &'a Collected, index: usize) -> Self {
        let (runs, measure) = (&collected.plan.runs, &collected.plan.facts.measures[index]);
        let of_run = collected.rows.iter().zip(runs).filter(|(row, _)| row.status == Status::Complete);
        let values = of_run.filter_map(|(row, run)| Some((run.point - 1, row.values[index]?)));
        let said = measure.description.chars().count();
        let said = if (1..=LONGEST_LABEL).contains(&said) { &measure.description } else { &measure.name };
        let label = with_unit(said, &measure.unit);
        let values: Vec<(u32, f64)> = values.filter(|(_, value)| value.is_finite()).collect();
        let mut points = vec![Vec::new(); collected.plan.facts.points as usize];
        values.iter().for_each(|(point, value)| points[*point as usize].push(*value));
        let (name, short) = (&measure.name, with_unit(&measure.name, &measure.unit));
        Self { collected, values, points, label, name, short }
    }

    /// The values of a point.
    fn of_point(&self, point: u32) -> &[f64] {
        &self.points[point as usize]
    }

    /// The cell of a parameter at a point: that of its first run.
    fn cell(&self, point: u32, column: usize) -> &str {
        &self.collected.plan.runs[point as usize].cells[column]
    }

    fn points(&self) -> u32 {
        self.collected.plan.facts.points
    }

    /// "5 runs", or "3 to 5 runs" while some are missing.
    fn runs_told(&self) -> String {
        let counts = || (0..self.points()).map(|point| self.of_point(point).len()).filter(|count| *count > 0);
        let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
        if least == most { format!("{most} runs") } else { format!("{least} to {most} runs") }
    }
}

/// What an axis says of a parameter.
fn label(column: &Column) -> String {
    with_unit(&column.name, column.kind.unit().unwrap_or("1"))
}

/// A measure against one parameter: the mean of each point, a band from the least to the most of its runs.
fn curve(data: &Data, column: &Column, sampled: bool) -> Chart {
    let x_of = |point: u32| match column.kind.is_numeric() {
        true => data.cell(point, 0).parse().unwrap_or(f64::NAN),
        false => f64::from(point),
    };
    let x = match column.kind.is_numeric() {
        true if column.log => Axis::log(label(column)),
        true => Axis::linear(label(column)),
        false => Axis::named(label(column), (0..data.points()).map(|point| data.cell(point, 0).to_owned())),
    };
    let mut chart = Chart { x, y: Axis::linear(data.label.clone()), ..Chart::default() };
    let blue = Colour::of_palette(0);
    if sampled {
        let points = data.values.iter().map(|(point, value)| [x_of(*point), *value]).collect();
        chart.series.push(Series::measured("", points, Vec::new()).coloured(blue));
        return chart;
    }
    let mut found: Vec<(f64, &[f64])> = (0..data.points()).map(|point| (x_of(point), data.of_point(point))).collect();
    found.retain(|(_, values)| !values.is_empty());
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    let means: Vec<[f64; 2]> = found.iter().map(|(x, values)| [*x, mean(values)]).collect();
    let repeated = found.iter().any(|(_, values)| values.len() > 1);
    if repeated {
        let ends = |values: &[f64]| {
            values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
        };
        let band: Vec<[f64; 3]> =
            found.iter().map(|(x, values)| (*x, ends(values))).map(|(x, [low, high])| [x, low, high]).collect();
        // A band needs a width to be seen: words stand side by side, and each has a bar.
        match column.kind.is_numeric() {
            true => chart
                .series
                .push(Series::band(format!("range of {}, least to most", data.runs_told()), band).coloured(blue)),
            false => {
                let bars = band.iter().map(|[_, low, high]| [*low, *high]).collect();
                let told = format!("mean and range of {}", data.runs_told());
                chart.series.push(Series::measured(told, means, bars).coloured(blue));
                return chart;
            }
        }
    }
    let told = if repeated { format!("mean of {}", data.runs_told()) } else { String::new() };
    if column.kind.is_numeric() {
        chart.series.push(Series::line(told, means.clone()).coloured(blue));
    }
    chart.series.push(Series::measured("", means, Vec::new()).coloured(blue));
    chart
}

/// A measure over two parameters of a grid: a box for each point, with the mean of its runs.
fn map(data: &Data, x: &Column, y: &Column) -> Chart {
    // The last parameter of a grid changes fastest.
    let rows = (0..data.points()).take_while(|point| data.cell(*point, 0) == data.cell(0, 0)).count();
    let columns = data.points() as usize / rows.max(1);
    let value = |column: usize, row: usize| {
        let values = data.of_point((column * rows + row) as u32);
        if values.is_empty() { f64::NAN } else { mean(values) }
    };
    let values: Vec<f64> = (0..rows).flat_map(|row| (0..columns).map(move |column| value(column, row))).collect();
    let known = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
    let range = if low < high { [low, high] } else { [low - 0.5, low + 0.5] };
    let repeated = data.collected.plan.facts.replicates > 1;
    let told = |label: &str| if repeated { format!("{label}, mean of {}", data.runs_told()) } else { label.to_owned() };
    let whole = told(&data.label);
    let told = if whole.chars().count() > LONGEST_BAR { told(&data.short) } else { whole };
    let heat = Heat {
        x: [-0.5, columns as f64 - 0.5],
        y: [-0.5, rows as f64 - 0.5],
        size: [columns, rows],
        values,
        map: ColourMap::Viridis,
        range,
        label: told,
        shading: Shading::Boxes,
        ..Heat::default()
    };
    let name = |cell: &str| cell.parse().map_or_else(|_| cell.to_owned(), rounded_text);
    Chart {
        x: Axis::named(label(x), (0..columns).map(|column| name(data.cell((column * rows) as u32, 0)))),
        y: Axis::named(label(y), (0..rows).map(|row| name(data.cell(row as u32, 1)))),
        heat: Some(heat),
        ..Chart::default()
    }
}

/// A number as a mark shows it: three digits.
fn rounded_text(value: f64) -> String {
    short(format!("{value:.2e}").parse().unwrap_or(value)).replace('-', "−")
}

/// How much the ranks of a measure follow those of each parameter; none where no parameter is a number.
fn ranked(data: &Data, columns: &[Column]) -> Option<Chart> {
    let numeric: Vec<(usize, &Column)> =
        columns.iter().enumerate().filter(|(_, column)| column.kind.is_numeric()).collect();
    let (points, measured): (Vec<u32>, Vec<f64>) = data.values.iter().copied().unzip();
    let of_column = |index: usize| {
        let values: Vec<f64> =
            points.iter().map(|point| data.cell(*point, index).parse().unwrap_or(f64::NAN)).collect();
        vec![correlation(&points, &values, &measured, data.collected.plan.facts.seed)]
    };
    let rows: Vec<_> = numeric.iter().map(|(index, _)| of_column(*index)).collect();
    let names: Vec<&str> = numeric.iter().map(|(_, column)| column.name.as_str()).collect();
    // What the lines on the bars are stands in the label: a legend would take half of the width.
    let told = format!("rank correlation with {}, and its 95 % interval", data.name);
    bars(&names, &[""], &rows, Axis::linear(told).range(Range::Fixed(-1.0, 1.0)))
}

/// Sobol's indices of a measure, of first order and total, for each parameter.
fn shared_out(found: &Sensitivity, name: &str, columns: &[Column]) -> Option<Chart> {
    let rows: Vec<Vec<Estimate>> = found.shares.indices.iter().map(|one| vec![one.first, one.total]).collect();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let ends = rows.iter().flatten().flat_map(|of| [of.value, of.low, of.high]).filter(|end| end.is_finite());
    let [low, high] = ends.fold([0.0, 1.0_f64], |[low, high]: [f64; 2], end| [low.min(end), high.max(end)]);
    // Few points leave intervals that are many times as wide as the range of shares: they end at the frame, so that bars can be seen.
    let [low, high] = [low.max(-0.5), high.min(1.5)];
    let range = Range::Fixed((10.0 * low).floor() / 10.0, (10.0 * high).ceil() / 10.0);
    let told = format!("share of the variance of {name}, and its 95 % interval");
    bars(&names, &["alone (first order)", "with others (total)"], &rows, Axis::linear(told).range(range))
}

#[cfg(test)]
mod tests {
    use super::rounded_text;

    #[test]
    fn marks_have_three_digits() {
        assert_eq!([0.00316227766, 0.1, -12.345, 0.0].map(rounded_text), ["0.00316", "0.1", "−12.3", "0"]);
    }
}
