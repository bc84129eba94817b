//! The legend of a chart: how large it is and where it hides the least.

use super::entry::{Entry, write_sample};
use super::frame::{Frame, NUMBER};
use super::{Chart, Corner, Legend, Series};
use crate::picture::text::{Anchor, Style, Weight, text_width, write_text};

/// Height of a line of the legend, px.
const ROW: f64 = 21.0;
/// Length of the sample before each name, px.
const SAMPLE: f64 = 30.0;
/// Margin between the legend and the frame, px.
const GAP: f64 = 10.0;

/// A legend of a certain size, not yet placed.
pub(super) struct Box {
    entries: Vec<Entry>,
    pub width: f64,
    height: f64,
}

impl Box {
    /// The legend of the named series; `None` when there is nothing to name.
    pub fn of(entries: Vec<Entry>) -> Option<Self> {
        if entries.is_empty() {
            return None;
        }
        let widest = entries.iter().map(|entry| text_width(&entry.label, NUMBER)).fold(0.0, f64::max);
        let height = ROW * entries.len() as f64 + 8.0;
        Some(Self { width: widest + SAMPLE + 26.0, height, entries })
    }

    /// Draws the legend with its top left corner at a point.
    pub fn write(&self, svg: &mut String, left: f64, top: f64) {
        svg.push_str(&format!(
            r##"<rect x="{left:.1}" y="{top:.1}" width="{:.1}" height="{:.1}" rx="4" fill="#ffffff" fill-opacity="0.86" stroke="#e3e6ea"/>"##,
            self.width, self.height
        ));
        svg.push('\n');
        for (row, entry) in self.entries.iter().enumerate() {
            let middle = top + 4.0 + ROW * (row as f64 + 0.5);
            write_sample(svg, entry, left + 8.0, left + 8.0 + SAMPLE, middle);
            let style = Style { size: NUMBER, anchor: Anchor::Start, weight: Weight::Plain };
            write_text(svg, left + 16.0 + SAMPLE, middle + 0.36 * NUMBER, style, &entry.label);
        }
    }

    /// The top left corner of the legend in a corner of the frame.
    pub fn corner(&self, frame: &Frame, corner: Corner) -> [f64; 2] {
        let (left, right) = (frame.left + GAP, frame.right - GAP - self.width);
        let (top, bottom) = (frame.top + GAP, frame.bottom - GAP - self.height);
        match corner {
            Corner::TopLeft => [left, top],
            Corner::TopRight => [right, top],
            Corner::BottomLeft => [left, bottom],
            Corner::BottomRight => [right, bottom],
        }
    }

    /// The corner where the legend covers nothing, if there is one.
    pub fn free_corner(&self, frame: &Frame, chart: &Chart) -> Option<[f64; 2]> {
        if self.width > 0.6 * (frame.right - frame.left) || self.height > 0.6 * (frame.bottom - frame.top) {
            return None;
        }
        let order = [Corner::TopLeft, Corner::TopRight, Corner::BottomRight, Corner::BottomLeft];
        let mut covered = [false; 4];
        let corners = order.map(|corner| self.corner(frame, corner));
        visit(chart, frame, |at| {
            for (hidden, corner) in covered.iter_mut().zip(&corners) {
                let margin = 6.0;
                *hidden |= at[0] > corner[0] - margin
                    && at[0] < corner[0] + self.width + margin
                    && at[1] > corner[1] - margin
                    && at[1] < corner[1] + self.height + margin;
            }
        });
        (0..4).find(|k| !covered[*k]).map(|k| corners[k])
    }
}

/// Whether the legend of a chart stands right of it for certain.
pub(super) fn always_beside(chart: &Chart) -> bool {
    chart.legend == Legend::Beside
}

/// Calls `seen` for points on the page that data cover, at most 5 px apart along lines.
fn visit(chart: &Chart, frame: &Frame, mut seen: impl FnMut([f64; 2])) {
    let mut along = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut last: Option<[f64; 2]> = None;
        for point in points {
            let at = frame.pixel(point);
            if let (Some(a), Some(b)) = (last, at) {
                let pieces = ((b[0] - a[0]).hypot(b[1] - a[1]) / 5.0).ceil().clamp(1.0, 400.0);
                for piece in 0..=pieces as usize {
                    let share = piece as f64 / pieces;
                    seen([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]);
                }
            } else if let Some(b) = at {
                seen(b);
            }
            last = at;
        }
    };
    for series in &chart.series {
        match series {
            Series::Line { points, .. } => along(&mut points.iter().copied()),
            Series::Points { points, bars, .. } => {
                points.iter().for_each(|p| along(&mut std::iter::once(*p)));
                for (p, bar) in points.iter().zip(bars) {
                    along(&mut bar.iter().map(|end| [p[0], *end]));
                }
            }
            Series::Band { points, .. } => {
                points.iter().for_each(|p| along(&mut [[p[0], p[1]], [p[0], p[2]]].into_iter()))
            }
            Series::Areas { outlines, .. } => outlines.iter().for_each(|outline| along(&mut outline.iter().copied())),
            Series::Tracks { tracks, .. } => tracks.iter().for_each(|track| along(&mut track.iter().copied())),
        }
    }
}
