//! The frame of a chart: its ranges and marks, and where a value lies on the page.

use super::{Aspect, Axis, Chart, Range, Scale, Series};
use crate::picture::text::text_width;
use crate::picture::ticks::{self, Ends, Ticks};

/// Sizes of letters, px.
pub(super) const TITLE: f64 = 16.0;
pub(super) const LABEL: f64 = 14.0;
pub(super) const NUMBER: f64 = 12.5;

/// Colours of what is behind the data.
pub(super) const FRAME_COLOUR: &str = "#5a616b";
pub(super) const GRID_COLOUR: &str = "#e3e6ea";
pub(super) const FINE_GRID_COLOUR: &str = "#f2f4f6";

/// One axis fitted to data and page.
#[derive(Debug, Clone)]
pub(super) struct FittedAxis {
    pub scale: Scale,
    pub ticks: Ticks,
    /// Pixel of the low end.
    from: f64,
    /// Pixel of the high end.
    to: f64,
}

impl FittedAxis {
    /// Where a value lies, px; not finite where the value is not finite or not positive on a logarithmic axis.
    pub fn pixel(&self, value: f64) -> f64 {
        let (low, high, value) = match self.scale {
            Scale::Linear => (self.ticks.low, self.ticks.high, value),
            Scale::Log if value > 0.0 => (self.ticks.low.ln(), self.ticks.high.ln(), value.ln()),
            Scale::Log => return f64::NAN,
        };
        self.from + (value - low) / (high - low) * (self.to - self.from)
    }
}

/// The area that data are drawn in, px from the top left corner of the page.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    pub x: FittedAxis,
    pub y: FittedAxis,
}

impl Frame {
    /// Fits the axes of a chart into a page, leaving `beside` px free on the right.
    pub fn fit(chart: &Chart, width: f64, height: f64, beside: f64) -> Self {
        let [data_x, data_y] = extents(chart);
        let top = if chart.title.is_empty() { 18.0 } else { 46.0 };
        let bottom = height - if chart.x.label.is_empty() { 34.0 } else { 60.0 };
        let rows = ((bottom - top) / 62.0).clamp(2.0, 9.0) as usize;
        let mut y = thinned_rows(marks(&chart.y, data_y, rows), &chart.y, bottom - top);
        let left_for = |ticks: &Ticks| {
            let widest = ticks.major.iter().map(|mark| text_width(&mark.1, NUMBER)).fold(0.0, f64::max);
            widest + if chart.y.label.is_empty() { 24.0 } else { 46.0 }
        };
        let mut left = left_for(&y);
        let right = width - beside - 22.0;
        let mut x = fitted_columns(&chart.x, data_x, right - left);
        if chart.aspect == Aspect::Equal && chart.x.scale == Scale::Linear && chart.y.scale == Scale::Linear {
            for _ in 0..2 {
                let (plot_width, plot_height) = (right - left, bottom - top);
                let raw = |range: &Range, data: [f64; 2]| match range {
                    Range::Fixed(low, high) => [*low, *high],
                    _ => [data[0] - 0.05 * (data[1] - data[0]), data[1] + 0.05 * (data[1] - data[0])],
                };
                let (rx, ry) = (raw(&chart.x.range, data_x), raw(&chart.y.range, data_y));
                let unit = ((rx[1] - rx[0]) / plot_width).max((ry[1] - ry[0]) / plot_height).max(1e-12);
                let around = |range: [f64; 2], length: f64, most: usize| {
                    let (middle, half) = (0.5 * (range[0] + range[1]), 0.5 * unit * length);
                    ticks::linear(middle - half, middle + half, most, Ends::Exact)
                };
                x = around(rx, plot_width, rows);
                y = around(ry, plot_height, rows);
                left = left_for(&y);
            }
        }
        Self {
            left,
            right,
            top,
            bottom,
            x: FittedAxis { scale: chart.x.scale, ticks: x, from: left, to: right },
            y: FittedAxis { scale: chart.y.scale, ticks: y, from: bottom, to: top },
        }
    }

    /// Where a point lies, px; `None` where the axes cannot show it.
    pub fn pixel(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let at = [self.x.pixel(point[0]), self.y.pixel(point[1])];
        // Far outside, coordinates would lose their digits in the file; the drawing is clipped to the frame anyway.
        (at[0].is_finite() && at[1].is_finite()).then(|| at.map(|v| v.clamp(-2e4, 2e4)))
    }
}

/// Marks for the x axis with as many labels as fit beside each other.
fn fitted_columns(axis: &Axis, data: [f64; 2], length: f64) -> Ticks {
    if !axis.names.is_empty() {
        return thinned(marks(axis, data, 2), |shown| {
            let widest = shown.iter().map(|mark| text_width(&mark.1, NUMBER)).fold(0.0, f64::max);
            shown.len() as f64 * (widest + 12.0) < length
        });
    }
    let mut most = (length / 75.0).clamp(2.0, 10.0) as usize;
    loop {
        let ticks = marks(axis, data, most);
        let widest = ticks.major.iter().map(|mark| text_width(&mark.1, NUMBER)).fold(0.0, f64::max);
        if most <= 2 || ticks.major.len() as f64 * (widest + 16.0) < length {
            return ticks;
        }
        most -= 1;
    }
}

/// Words along the y axis, as many as fit above each other.
fn thinned_rows(ticks: Ticks, axis: &Axis, length: f64) -> Ticks {
    if axis.names.is_empty() { ticks } else { thinned(ticks, |shown| shown.len() as f64 * (NUMBER + 4.0) < length) }
}

/// Marks of which so many are left out, always the same number between two, that the others fit.
fn thinned(mut ticks: Ticks, fits: impl Fn(&[(f64, String)]) -> bool) -> Ticks {
    let all = std::mem::take(&mut ticks.major);
    for every in 1..=all.len().max(1) {
        ticks.major = all.iter().step_by(every).cloned().collect();
        if fits(&ticks.major) {
            break;
        }
    }
    ticks
}

/// Marks for one axis over the data or the range asked for.
fn marks(axis: &Axis, data: [f64; 2], most: usize) -> Ticks {
    let (low, high, ends) = match axis.range {
        Range::Auto => (data[0], data[1], Ends::Rounded),
        Range::FromZero if axis.scale == Scale::Linear => (data[0].min(0.0), data[1].max(0.0), Ends::Rounded),
        Range::FromZero => (data[0], data[1], Ends::Rounded),
        Range::Fixed(low, high)
            if low.is_finite() && high.is_finite() && (axis.scale == Scale::Linear || low > 0.0) =>
        {
            (low.min(high), low.max(high), Ends::Exact)
        }
        Range::Fixed(..) => (data[0], data[1], Ends::Rounded),
    };
    if !axis.names.is_empty() {
        let major = axis.names.iter().filter(|(at, _)| (low..=high).contains(at)).cloned().collect();
        return Ticks { low, high, major, minor: Vec::new(), exponent: 0 };
    }
    match axis.scale {
        Scale::Linear => ticks::linear(low, high, most, ends),
        // Decades carry short labels.
        Scale::Log => ticks::logarithmic(low, high, most + most / 2, ends),
    }
}

/// Smallest and largest x and y of everything that can be drawn; 0 to 1 (1 to 10 on a logarithmic axis) without data.
fn extents(chart: &Chart) -> [[f64; 2]; 2] {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    let drawable = |value: f64, scale: Scale| value.is_finite() && (scale == Scale::Linear || value > 0.0);
    let mut take = |point: [f64; 2]| {
        if drawable(point[0], chart.x.scale) && drawable(point[1], chart.y.scale) {
            for k in 0..2 {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
    };
    for series in &chart.series {
        match series {
            Series::Line { points, .. } => points.iter().for_each(|p| take(*p)),
            Series::Points { points, bars, .. } => {
                points.iter().for_each(|p| take(*p));
                points.iter().zip(bars).for_each(|(p, bar)| bar.iter().for_each(|end| take([p[0], *end])));
            }
            Series::Band { points, .. } => points.iter().for_each(|p| {
                take([p[0], p[1]]);
                take([p[0], p[2]]);
            }),
            Series::Areas { outlines, .. } => outlines.iter().flatten().for_each(|p| take(*p)),
            Series::Tracks { tracks, .. } => tracks.iter().flatten().for_each(|p| take(*p)),
        }
    }
    [(0, chart.x.scale), (1, chart.y.scale)].map(|(k, scale)| match scale {
        _ if low[k] <= high[k] => [low[k], high[k]],
        Scale::Linear => [0.0, 1.0],
        Scale::Log => [1.0, 10.0],
    })
}
