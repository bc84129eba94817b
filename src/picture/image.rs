//! A finished picture in memory, and how it is written as a PNG file.

use std::path::Path;

use super::colour::Colour;
use crate::error::{Error, Result};

/// A picture: rows from top to bottom, three sRGB bytes a pixel, no transparency.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green, blue of every pixel; the length is 3 · width · height.
    pub rgb: Vec<u8>,
}

impl Image {
    /// A picture of one colour.
    pub fn filled(width: usize, height: usize, colour: Colour) -> Self {
        Self { width, height, rgb: colour.0.repeat(width * height) }
    }

    /// The colour of the pixel in column `x` and row `y`, counted from the top left corner.
    ///
    /// # Panics
    /// When the pixel lies outside the picture.
    pub fn pixel(&self, x: usize, y: usize) -> Colour {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) is outside {}×{}", self.width, self.height);
        let start = 3 * (y * self.width + x);
        Colour([self.rgb[start], self.rgb[start + 1], self.rgb[start + 2]])
    }

    /// The bytes of a PNG file that shows the picture. What would pack it a tenth smaller takes ten times as long: a quarter of
    /// the time of a run of two cells.
    ///
    /// # Errors
    /// When the picture has no pixels or more than PNG can hold.
    pub fn to_png(&self) -> Result<Vec<u8>> {
        encoded([self.width, self.height], &self.rgb, png::ColorType::Rgb)
    }

    /// Writes the picture as a PNG file, over one that exists.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save_png(&self, path: &Path) -> Result<()> {
        write_file(path, &self.to_png()?)
    }

    /// Lays an overlay with premultiplied transparency (four bytes a pixel, same size) over the picture.
    pub(crate) fn lay_over(&mut self, overlay: &[u8]) {
        for (below, above) in self.rgb.chunks_exact_mut(3).zip(overlay.chunks_exact(4)) {
            let share = 255 - u32::from(above[3]);
            if share < 255 {
                for k in 0..3 {
                    below[k] = (u32::from(above[k]) + (u32::from(below[k]) * share + 127) / 255).min(255) as u8;
                }
            }
        }
    }
}

/// A picture without what is behind everything: rows from top to bottom, four bytes a pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CutOut {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green, blue and opacity (0 for nothing there, 255 for nothing seen through) of every pixel.
    pub rgba: Vec<u8>,
}

impl CutOut {
    /// What is the same in two pictures of one size over black and over white: where they are unlike, the ground is seen.
    pub fn between(over_black: &Image, over_white: &Image) -> Self {
        let pairs = over_black.rgb.chunks_exact(3).zip(over_white.rgb.chunks_exact(3));
        let pixel = |(black, white): (&[u8], &[u8])| {
            let ground: i32 = (0..3).map(|k| i32::from(white[k]) - i32::from(black[k])).sum();
            let opacity = 255.0 - f64::from(ground) / 3.0;
            let paint = |k: usize| if opacity > 0.5 { 255.0 * f64::from(black[k]) / opacity } else { 0.0 };
            [paint(0), paint(1), paint(2), opacity].map(|part| part.round().clamp(0.0, 255.0) as u8)
        };
        Self { width: over_black.width, height: over_black.height, rgba: pairs.flat_map(pixel).collect() }
    }

    /// Writes it as a PNG file, over one that exists.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save_png(&self, path: &Path) -> Result<()> {
        write_file(path, &encoded([self.width, self.height], &self.rgba, png::ColorType::Rgba)?)
    }
}

/// The bytes of a PNG file.
fn encoded([width, height]: [usize; 2], pixels: &[u8], colour: png::ColorType) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels));
    match written {
        Ok(()) => Ok(bytes),
        Err(error) => Err(Error::Machine {
            message: format!("a picture of {width}×{height} pixels could not be encoded: {error}"),
            help: "choose a width and a height of at least one pixel".into(),
        }),
    }
}

/// Writes a whole file or says which one failed and what to do.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    std::fs::write(path, bytes).map_err(|error| unwritable(path, &error))
}

/// The error for a picture file that cannot be written.
pub(crate) fn unwritable(path: &Path, error: &std::io::Error) -> Error {
    Error::Machine {
        message: format!("cannot write the picture {}: {error}", path.display()),
        help: "check that its folder exists, that you may write there and that the disk is not full".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_cannot_be_written_names_its_path() {
        let image = Image::filled(2, 2, Colour([1, 2, 3]));
        let error = image.save_png(Path::new("/nowhere/at/all.png")).unwrap_err();
        assert!(error.to_string().contains("/nowhere/at/all.png"), "{error}");
        assert_eq!(error.exit_code(), 1);
    }

    #[test]
    fn a_cut_out_over_any_ground_is_the_picture_over_it() {
        let over = |grey: u8| {
            // Nothing, a veil of a third of red, and something opaque.
            let mix = |paint: u8| ((u32::from(paint) + 2 * u32::from(grey)) / 3) as u8;
            Image { width: 3, height: 1, rgb: vec![grey, grey, grey, mix(200), mix(40), mix(10), 7, 8, 9] }
        };
        let cut = CutOut::between(&over(0), &over(255));
        assert_eq!(cut.rgba[3], 0);
        assert_eq!(&cut.rgba[8..], &[7, 8, 9, 255]);
        for (k, paint) in [200, 40, 10].into_iter().enumerate() {
            assert!((i32::from(cut.rgba[4 + k]) - paint).abs() <= 3, "{:?}", cut.rgba);
        }
        assert!((i32::from(cut.rgba[7]) - 85).abs() <= 1, "{:?}", cut.rgba);
    }

    #[test]
    fn a_saved_picture_reads_back_the_same() {
        let mut image = Image::filled(5, 3, Colour([10, 20, 30]));
        image.rgb[7] = 200;
        let bytes = image.to_png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut read = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut read).unwrap();
        assert_eq!(read, image.rgb);
    }
}
