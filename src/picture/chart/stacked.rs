//! Charts below each other in one picture.

use super::{Chart, draw, to_svg};
use crate::error::Result;
use crate::picture::Image;
use crate::picture::image::write_file;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The width of all charts, px.
const WIDTH: f64 = 720.0;

/// Writes charts below each other, the first uppermost, each with its height, as `path.svg` and `path.png` (720 px wide, the PNG with twice as
/// many pixels) and returns both paths.
///
/// # Errors
/// When a file cannot be written.
pub fn save_stacked(charts: &[(Chart, f64)], path_without_extension: &Path) -> Result<Vec<PathBuf>> {
    let with = |extension: &str| {
        let mut name = path_without_extension.as_os_str().to_owned();
        name.push(extension);
        PathBuf::from(name)
    };
    let height: f64 = charts.iter().map(|(_, height)| height).sum();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\">\n"
    );
    let (mut top, mut image) = (0.0, Image::filled(2 * WIDTH as usize, 0, super::Colour([255; 3])));
    for (number, (chart, height)) in charts.iter().enumerate() {
        let drawn = to_svg(chart, WIDTH, *height);
        // Names of clips are those of the whole document: each chart needs its own.
        let placed = drawn.replacen("<svg ", &format!("<svg y=\"{top}\" "), 1);
        let placed = placed.replace("id=\"frame\"", &format!("id=\"frame{number}\""));
        // Writing to a text cannot fail.
        let _ = writeln!(svg, "{}", placed.replace("url(#frame)", &format!("url(#frame{number})")));
        let part = draw::to_image(chart, &drawn, [WIDTH, *height], 2.0)?;
        image.rgb.extend_from_slice(&part.rgb);
        image.height += part.height;
        top += height;
    }
    svg.push_str("</svg>\n");
    let paths = vec![with(".svg"), with(".png")];
    write_file(&paths[0], svg.as_bytes())?;
    write_file(&paths[1], &image.to_png()?)?;
    Ok(paths)
}
