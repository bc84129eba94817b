//! Writes the series of a chart as SVG: curves, bands, tracks and points.

use std::fmt::Write;

use super::frame::Frame;
use super::{Marker, Series, Stroke};
use crate::picture::colour::{Colour, ColourMap};

/// Steps along a curve that no eye can tell apart, px.
const FINE: f64 = 0.4;

/// Draws everything of a series that is clipped to the frame; points come later, see [`write_points`].
pub(super) fn write_series(svg: &mut String, series: &Series, colour: Colour, frame: &Frame) {
    let hex = colour.hex();
    match series {
        Series::Line { points, stroke, width, .. } => {
            let path = path(points.iter().copied(), frame, FINE);
            let dash = dashes(*stroke, *width);
            let _ = writeln!(
                svg,
                r#"<path d="{path}" fill="none" stroke="{hex}" stroke-width="{width}" stroke-linejoin="round"{dash}/>"#
            );
        }
        Series::Points { .. } => {}
        Series::Band { points, .. } => {
            let finite = |p: &&[f64; 3]| frame.pixel([p[0], p[1]]).is_some() && frame.pixel([p[0], p[2]]).is_some();
            for part in points.split(|p| !finite(&p)).filter(|part| part.len() > 1) {
                let there = part.iter().map(|p| [p[0], p[1]]);
                let back = part.iter().rev().map(|p| [p[0], p[2]]);
                let path = path(there.chain(back), frame, FINE);
                let _ = writeln!(svg, r#"<path d="{path}Z" fill="{hex}" fill-opacity="0.2"/>"#);
            }
        }
        Series::Areas { outlines, .. } => {
            for outline in outlines {
                let path = path(outline.iter().copied(), frame, FINE);
                let _ = writeln!(
                    svg,
                    r#"<path d="{path}Z" fill="{hex}" fill-opacity="0.5" stroke="{hex}" stroke-linejoin="round"/>"#
                );
            }
        }
        Series::Tracks { tracks, colour: one, .. } => write_tracks(svg, tracks, one.map(|_| colour), frame),
    }
}

/// Many tracks stay readable when they are thin and let each other through.
fn write_tracks(svg: &mut String, tracks: &[Vec<[f64; 2]>], one: Option<Colour>, frame: &Frame) {
    let crowd = tracks.len() as f64;
    let width = (4.2 / crowd.max(1.0).powf(0.25)).clamp(0.6, 1.8);
    let opacity = (4.0 / crowd.max(1.0).powf(0.38)).clamp(0.22, 0.9);
    // Two thousand tracks are a cloud: steps of a pixel and a half tell as much in a third of the file.
    let step = if tracks.len() > 200 { 1.5 } else { FINE };
    let dot = (9.0 / crowd.max(1.0).powf(0.3)).clamp(1.2, 3.6);
    let _ = writeln!(
        svg,
        r#"<g fill="none" stroke-width="{width:.2}" stroke-opacity="{opacity:.2}" stroke-linejoin="round" stroke-linecap="round">"#
    );
    for (number, track) in tracks.iter().enumerate() {
        // The golden ratio spreads neighbouring numbers over the map; its palest end is left out on white.
        let own = || ColourMap::Viridis.at(0.88 * ((number as f64 * 0.618_033_988_75 + 0.1) % 1.0));
        let few = || if tracks.len() <= 6 { Colour::of_palette(number) } else { own() };
        let hex = one.unwrap_or_else(few).hex();
        let _ = writeln!(svg, r#"<path d="{}" stroke="{hex}"/>"#, path(track.iter().copied(), frame, step));
        if let Some([x, y]) = track.iter().rev().find_map(|p| frame.pixel(*p)) {
            let _ = writeln!(svg, r#"<circle cx="{x:.1}" cy="{y:.1}" r="{dot:.1}" fill="{hex}"/>"#);
        }
    }
    svg.push_str("</g>\n");
}

/// Path data through points, broken where the axes cannot show one; points nearer than `step` px to the last are skipped.
fn path(points: impl Iterator<Item = [f64; 2]>, frame: &Frame, step: f64) -> String {
    let mut path = String::new();
    let mut last: Option<[f64; 2]> = None;
    let mut skipped: Option<[f64; 2]> = None;
    for at in points.map(|point| frame.pixel(point)) {
        match (last, at) {
            (Some(from), Some(to)) if (from[0] - to[0]).abs() + (from[1] - to[1]).abs() < step => skipped = at,
            (Some(_), Some([x, y])) => {
                let _ = write!(path, "L{x:.1} {y:.1}");
                (last, skipped) = (at, None);
            }
            (None, Some([x, y])) => {
                let _ = write!(path, "M{x:.1} {y:.1}");
                (last, skipped) = (at, None);
            }
            (_, None) => (last, skipped) = (None, None),
        }
    }
    if let Some([x, y]) = skipped {
        let _ = write!(path, "L{x:.1} {y:.1}");
    }
    // SVG wants a command to begin with; an empty series draws nothing at a harmless point.
    if path.is_empty() { "M0 0".into() } else { path }
}

/// The SVG attribute for a stroke of a width, with a space before it.
pub(super) fn dashes(stroke: Stroke, width: f64) -> String {
    match stroke {
        Stroke::Solid => String::new(),
        Stroke::Dashed => format!(r#" stroke-dasharray="{:.1} {:.1}""#, 4.0 * width, 2.6 * width),
        Stroke::Dotted => format!(r#" stroke-dasharray="0.1 {:.1}" stroke-linecap="round""#, 2.2 * width),
    }
}

/// Draws markers with their error bars.
pub(super) fn write_points(
    svg: &mut String,
    points: &[[f64; 2]],
    bars: &[[f64; 2]],
    marker: Marker,
    colour: Colour,
    frame: &Frame,
) {
    let hex = colour.hex();
    let inside = |at: &[f64; 2]| {
        at[0] >= frame.left - 0.5
            && at[0] <= frame.right + 0.5
            && at[1] >= frame.top - 0.5
            && at[1] <= frame.bottom + 0.5
    };
    for (number, point) in points.iter().enumerate() {
        let Some([x, y]) = frame.pixel(*point).filter(inside) else { continue };
        let ends = bars.get(number).map(|bar| bar.map(|end| frame.y.pixel(end)));
        if let Some([low, high]) = ends.filter(|ends| ends.iter().all(|end| end.is_finite())) {
            write_bar(svg, x, high.clamp(frame.top, frame.bottom), low.clamp(frame.top, frame.bottom), &hex);
        }
        write_marker(svg, marker, x, y, &hex);
    }
}

/// Draws an error bar with its two caps.
pub(super) fn write_bar(svg: &mut String, x: f64, top: f64, bottom: f64, colour: &str) {
    let _ = writeln!(
        svg,
        r#"<path d="M{x:.1} {top:.1}V{bottom:.1}M{0:.1} {top:.1}h7M{0:.1} {bottom:.1}h7" stroke="{colour}" stroke-width="1.3" fill="none"/>"#,
        x - 3.5
    );
}

/// Draws one marker around a point.
pub(super) fn write_marker(svg: &mut String, marker: Marker, x: f64, y: f64, colour: &str) {
    let _ = match marker {
        Marker::Disc => writeln!(
            svg,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="4.2" fill="{colour}" stroke="#ffffff" stroke-width="0.9"/>"##
        ),
        Marker::Circle => writeln!(
            svg,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="3.8" fill="#ffffff" stroke="{colour}" stroke-width="1.7"/>"##
        ),
        Marker::Square => writeln!(
            svg,
            r##"<rect x="{:.1}" y="{:.1}" width="7.6" height="7.6" fill="{colour}" stroke="#ffffff" stroke-width="0.9"/>"##,
            x - 3.8,
            y - 3.8
        ),
        Marker::Diamond => writeln!(
            svg,
            r##"<path d="M{x:.1} {:.1}l4.6 4.6l-4.6 4.6l-4.6 -4.6Z" fill="#ffffff" stroke="{colour}" stroke-width="1.6"/>"##,
            y - 4.6
        ),
        Marker::Triangle => writeln!(
            svg,
            r##"<path d="M{x:.1} {:.1}l4.9 8.4h-9.8Z" fill="{colour}" stroke="#ffffff" stroke-width="0.9"/>"##,
            y - 5.4
        ),
    };
}
