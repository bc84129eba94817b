//! Draws cells as shaded surfaces on their substrate, entirely in software.
//!
//! A [`Scene`] holds surfaces, lines and planes in µm, a [`Camera`] looks at it, an [`Overlay`] carries title, time,
//! scale bar and legend; [`draw`] makes an [`Image`] of the three. Rows of the picture are worked on in parallel and
//! never share a sum, so the picture is the same to the last bit for any number of threads.

mod bars;
mod camera;
mod cut;
mod floor;
mod geometry;
mod glass;
mod outlines;
mod overlay;
mod raster;
mod samples;
mod scene;
mod shade;
mod sheet;
mod skin;
mod spans;
#[cfg(test)]
pub(in crate::picture) mod tests;
mod tripod;
mod tubes;
mod view;

use rayon::prelude::*;

use super::Image;

pub use bars::FieldBar;
pub(in crate::picture) use camera::basis;
pub use camera::{Bounds, Camera, Insets, Projection};
pub use overlay::{ClockUnit, Key, Overlay, ScaleBar, time_text};
pub use scene::{Background, Edges, Floor, Pane, Scene, Sheet, Surface, SurfaceColour};
pub use tripod::AXES;

use geometry::Geometry;
use raster::Band;
use samples::BAND_ROWS;
use shade::Shader;
use view::View;

/// Draws a picture of `width` × `height` pixels (at least one, at most 16 384 each).
///
/// Facets with positions that are not finite or with atoms that do not exist are left out.
pub fn draw(scene: &Scene, camera: &Camera, overlay: &Overlay, width: usize, height: usize) -> Image {
    let (width, height) = (width.clamp(1, 16_384), height.clamp(1, 16_384));
    let view = View::new(camera, width, height);
    let geometry = Geometry::new(scene, &view);
    let bins = geometry.bins(height);
    let shader = Shader::new(scene, &view, &geometry);
    let mut image = Image { width, height, rgb: vec![0; 3 * width * height] };
    image.rgb.par_chunks_mut(3 * width * BAND_ROWS).enumerate().for_each(|(number, rows)| {
        let first_row = number * BAND_ROWS;
        let mut band = Band::new(width, rows.len() / (3 * width), first_row, geometry.cut.is_some());
        shader.lay_floor(&mut band);
        shader.lay_sheet(&mut band);
        for triangle in &bins[number] {
            band.add(&geometry, *triangle);
        }
        band.settle(&geometry);
        shader.resolve(&band, &geometry, rows);
    });
    overlay.lay_over(&mut image, camera);
    image
}
