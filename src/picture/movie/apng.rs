//! Films as animated PNG, in which every pixel has the colour that it has in the picture.

use std::io::Write;

use super::kept::{Kept, Taken};

/// Thousandths of a second.
pub(super) const PER_SECOND: f64 = 1000.0;

/// Writes the file: how many frames there are stands at its begin.
pub(super) fn write(frames: &Kept, target: &mut impl Write) -> std::io::Result<()> {
    let Some([width, height, count]) = frames.extent() else { return Ok(()) };
    let mut encoder = png::Encoder::new(target, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_animated(count as u32, 0)?;
    encoder.set_dispose_op(png::DisposeOp::None)?;
    encoder.set_blend_op(png::BlendOp::Source)?;
    let mut writer = encoder.write_header()?;
    frames.take(|Taken { image, area, delay, .. }| {
        // Sides are checked against where the frame before stood.
        writer.reset_frame_position()?;
        writer.set_frame_dimension(area.width() as u32, area.height() as u32)?;
        writer.set_frame_position(area.left as u32, area.top as u32)?;
        writer.set_frame_delay(delay, PER_SECOND as u16)?;
        let pixels: Vec<u8> = area.rows(width).flat_map(|row| &image.rgb[row]).copied().collect();
        Ok(writer.write_image_data(&pixels)?)
    })?;
    Ok(writer.finish()?)
}
