//! Pictures and charts made by software, without a display, a graphics card or installed fonts.
//!
//! [`render::draw`] turns cells into an [`Image`]; [`chart`] draws measured and simulated curves as SVG and PNG;
//! [`movie::Movie`] strings images together; [`from_result`] makes a scene out of the arrays that a run records.
//! Everything here takes plain data, so it serves the program's commands and any Rust user alike.

pub mod arrows;
pub mod chart;
pub mod colour;
pub mod display;
pub mod documented;
pub mod field_plots;
pub mod field_view;
mod framing;
pub mod from_file;
pub mod from_result;
pub mod image;
mod instant;
pub(crate) mod joined;
mod look;
pub mod movie;
pub mod palette;
mod planes;
pub mod plots;
pub mod quantities;
pub mod render;
pub mod shown;
mod snapshot;
mod stage;
mod svg;
pub(crate) mod text;
pub mod ticks;
pub(crate) mod tools;
pub mod track_plots;

pub use chart::{Axis, Chart, Heat, Range, Scale, Series, Shading, save_chart, save_stacked};
pub use colour::{Colour, ColourMap};
pub use display::Display;
pub use from_file::{default_files, make_defaults};
pub use image::Image;
pub use movie::Movie;
pub use render::{Camera, Overlay, Scene, draw};
