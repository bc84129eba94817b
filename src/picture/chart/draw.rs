//! Writes a chart as SVG.

use std::fmt::Write;

use super::entry::entries;
use super::frame::{FINE_GRID_COLOUR, FRAME_COLOUR, FittedAxis, Frame, GRID_COLOUR, LABEL, NUMBER, TITLE};
use super::heat::Heat;
use super::legend::{self, Box};
use super::series::{write_points, write_series};
use super::{Chart, Ground, Legend, Series, polar, svg_to_image};
use crate::error::Result;
use crate::picture::Image;
use crate::picture::colour::Colour;
use crate::picture::svg::svg_to_pixels;
use crate::picture::text::{self, Anchor, Style, Weight, write_text, write_turned_text};
use crate::picture::ticks;

/// Draws a chart on a page of `width` × `height` px. Any contents give a valid SVG document.
pub fn to_svg(chart: &Chart, width: f64, height: f64) -> String {
    compose(chart, width, height, Page::Whole).0
}

/// The pixels of a chart whose SVG is known, `scale` of them for each of its units.
pub(super) fn to_image(chart: &Chart, svg: &str, [width, height]: [f64; 2], scale: f64) -> Result<Image> {
    let Some(heat) = &chart.heat else { return svg_to_image(svg, scale as f32) };
    // Our own drawing of SVG knows no pictures inside: the heat is painted first, the rest laid over it.
    let (svg, frame) = compose(chart, width, height, Page::Lines);
    let mut pixels = svg_to_pixels(&svg, scale as f32)?;
    let mut image = Image::filled(pixels.width() as usize, pixels.height() as usize, Colour([255; 3]));
    let pixel = |at: f64| (at * scale).round().max(0.0) as usize;
    let (left, top) = (pixel(frame.left), pixel(frame.top));
    let area = heat.image(pixel(frame.right) - left, pixel(frame.bottom) - top);
    for (row, colours) in area.rgb.chunks(3 * area.width).enumerate() {
        let start = 3 * ((top + row) * image.width + left);
        image.rgb[start..start + colours.len()].copy_from_slice(colours);
    }
    image.lay_over(pixels.data_mut());
    Ok(image)
}

/// What is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Page {
    /// Everything, on white.
    Whole,
    /// Without the ground and the heat.
    Lines,
}

fn compose(chart: &Chart, width: f64, height: f64, page: Page) -> (String, Frame) {
    let (width, height) = (width.clamp(160.0, 20_000.0), height.clamp(120.0, 20_000.0));
    let colours = colours(chart);
    let key = if chart.legend == Legend::Hidden { None } else { Box::of(entries(chart, &colours)) };
    let bar = chart.heat.as_ref().map_or(0.0, Heat::width);
    let mut frame = Frame::fit(chart, width, height, bar);
    let mut key_at = None;
    if let Some(key) = &key {
        key_at = match chart.legend {
            Legend::At(corner) => Some(key.corner(&frame, corner)),
            _ if legend::always_beside(chart) => None,
            _ => key.free_corner(&frame, chart),
        };
        if key_at.is_none() {
            frame = Frame::fit(chart, width, height, bar + (key.width + 4.0).min(0.5 * width));
            key_at = Some([frame.right + bar + 12.0, frame.top]);
        }
    }
    let mut svg = String::with_capacity(1 << 14);
    let _ = writeln!(
        svg,
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="{}">"##,
        text::FONT_FAMILY
    );
    if page == Page::Whole {
        let _ = writeln!(svg, r##"<rect width="{width}" height="{height}" fill="#ffffff"/>"##);
    }
    match &chart.heat {
        None => match chart.ground {
            Ground::Frame => write_grid(&mut svg, &frame),
            Ground::Polar { radius } => polar::write_rings(&mut svg, &frame, radius),
        },
        Some(heat) => {
            if page == Page::Whole {
                heat.write_image(&mut svg, &frame);
            }
            heat.write_bar(&mut svg, &frame);
        }
    }
    let _ = writeln!(
        svg,
        r#"<clipPath id="frame"><rect x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}"/></clipPath><g clip-path="url(#frame)">"#,
        frame.left,
        frame.top - 1.0,
        frame.right - frame.left + 1.0,
        frame.bottom - frame.top + 1.0
    );
    for (series, colour) in chart.series.iter().zip(&colours) {
        write_series(&mut svg, series, *colour, &frame);
    }
    svg.push_str("</g>\n");
    // Points stay whole at the edge of the frame, hence outside the clipped group.
    for (series, colour) in chart.series.iter().zip(&colours) {
        if let Series::Points { points, bars, marker, .. } = series {
            write_points(&mut svg, points, bars, *marker, *colour, &frame);
        }
    }
    match chart.ground {
        Ground::Frame => write_axes(&mut svg, chart, &frame),
        Ground::Polar { radius } => polar::write_names(&mut svg, chart, &frame, radius),
    }
    if let (Some(key), Some([left, top])) = (&key, key_at) {
        key.write(&mut svg, left, top);
    }
    svg.push_str("</svg>\n");
    (svg, frame)
}

/// The colour of every series: its own, or the next of the palette; series of one name share one, so that a measured
/// set and its band match.
pub fn colours(chart: &Chart) -> Vec<Colour> {
    let mut next = 0;
    let mut named: Vec<(&str, Colour)> = Vec::new();
    chart
        .series
        .iter()
        .map(|series| {
            let (Series::Line { colour, .. }
            | Series::Points { colour, .. }
            | Series::Band { colour, .. }
            | Series::Areas { colour, .. }
            | Series::Tracks { colour, .. }) = series;
            let label = series.label();
            let known = named.iter().find(|(name, _)| !label.is_empty() && *name == label).map(|n| n.1);
            let colour = colour.or(known).unwrap_or_else(|| {
                next += 1;
                Colour::of_palette(next - 1)
            });
            named.push((label, colour));
            colour
        })
        .collect()
}

fn write_grid(svg: &mut String, frame: &Frame) {
    let lines = |out: &mut String, colour: &str, x: &mut dyn Iterator<Item = f64>, y: &mut dyn Iterator<Item = f64>| {
        let _ = write!(out, r#"<path stroke="{colour}" fill="none" d=""#);
        for at in x {
            let _ = write!(out, "M{:.1} {:.1}V{:.1}", frame.x.pixel(at), frame.top, frame.bottom);
        }
        for at in y {
            let _ = write!(out, "M{:.1} {:.1}H{:.1}", frame.left, frame.y.pixel(at), frame.right);
        }
        out.push_str("\"/>\n");
    };
    let (x, y) = (&frame.x.ticks, &frame.y.ticks);
    lines(svg, FINE_GRID_COLOUR, &mut x.minor.iter().copied(), &mut y.minor.iter().copied());
    lines(svg, GRID_COLOUR, &mut x.major.iter().map(|m| m.0), &mut y.major.iter().map(|m| m.0));
}

fn write_axes(svg: &mut String, chart: &Chart, frame: &Frame) {
    let _ = write!(
        svg,
        r#"<path stroke="{FRAME_COLOUR}" stroke-width="1.1" fill="none" stroke-linecap="square" d="M{:.1} {:.1}V{:.1}H{:.1}"#,
        frame.left, frame.top, frame.bottom, frame.right
    );
    for (at, _) in &frame.x.ticks.major {
        let _ = write!(svg, "M{:.1} {:.1}v5", frame.x.pixel(*at), frame.bottom);
    }
    for (at, _) in &frame.y.ticks.major {
        let _ = write!(svg, "M{:.1} {:.1}h-5", frame.left, frame.y.pixel(*at));
    }
    svg.push_str("\"/>\n");
    let number = |anchor| Style { size: NUMBER, anchor, weight: Weight::Soft };
    for (at, label) in &frame.x.ticks.major {
        write_text(svg, frame.x.pixel(*at), frame.bottom + 20.0, number(Anchor::Middle), label);
    }
    for (at, label) in &frame.y.ticks.major {
        write_text(svg, frame.left - 9.0, frame.y.pixel(*at) + 0.36 * NUMBER, number(Anchor::End), label);
    }
    let named = |label: &str, axis: &FittedAxis| match axis.ticks.exponent {
        0 => label.to_string(),
        power => format!("{label}  ×{}", ticks::power_of_ten(power)),
    };
    let style = Style { size: LABEL, anchor: Anchor::Middle, weight: Weight::Plain };
    let (middle_x, middle_y) = (0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
    write_text(svg, middle_x, frame.bottom + 46.0, style, &named(&chart.x.label, &frame.x));
    write_turned_text(svg, 20.0, middle_y, -90.0, style, &named(&chart.y.label, &frame.y));
    if !chart.title.is_empty() {
        let style = Style { size: TITLE, anchor: Anchor::Start, weight: Weight::Strong };
        write_text(svg, frame.left, 28.0, style, &chart.title);
    }
}
