//! Pictures and charts made by software, without a display, a graphics card or installed fonts.
//!
//! [`render::draw`] turns cells into an [`Image`]; [`chart`] draws measured and simulated curves as SVG and PNG;
//! [`movie::Movie`] strings images together; [`from_result`] makes a scene out of the arrays that a run records.
//! Everything here takes plain data, so it serves the program's commands and any Rust user alike.

pub mod chart;
pub mod colour;
pub mod from_result;
pub mod image;
pub mod movie;
pub mod render;
pub(crate) mod text;
pub mod ticks;

pub use chart::{Axis, Chart, Series, save_chart};
pub use colour::{Colour, ColourMap};
pub use image::Image;
pub use movie::Movie;
pub use render::{Camera, Overlay, Scene, draw};

/// Makes the default picture and charts of a result.
pub fn make_defaults(_result: &std::path::Path) -> crate::error::Result<Vec<std::path::PathBuf>> {
    Ok(Vec::new())
}
