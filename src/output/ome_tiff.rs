//! A field as a stack of pictures in TIFF, with what the Open Microscopy Environment wants to be told of them.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use tiff::encoder::colortype::Gray32Float;
use tiff::encoder::{TiffEncoder, TiffKind};
use tiff::tags::Tag;
use tiff::{TiffError, TiffResult};

use super::container::machine_error;
use super::field_layout::{Along, FieldLayout};
use super::vtk_xml::escaped;
use super::{Header, ResultFile};
use crate::error::Result;

/// Files beyond it are BigTIFF: offsets of four bytes end at 2³² bytes, and fewer programs read the other.
const LARGEST_PLAIN: u64 = 4_000_000_000;
/// What a picture takes in the file besides its values: a directory of entries, at most.
const DIRECTORY: u64 = 400;

/// Writes species of a field at some frames as OME-TIFF: one picture for each layer, species and frame, in this order, four bytes
/// for each box, its first row that of the lowest y. Sizes of boxes (µm), times of frames (s), names and units of species are told in
/// OME-XML. One frame of one species is in memory at a time. An existing file is replaced.
///
/// # Errors
/// A damaged result, or a file that cannot be written.
///
/// # Panics
/// If there is no such frame or species.
pub fn write_field_tiff(
    result: &ResultFile,
    field: &FieldLayout,
    species: &[usize],
    frames: &[usize],
    path: &Path,
) -> Result<()> {
    let times = result.times()?;
    let times: Vec<f64> = frames.iter().map(|frame| times[*frame]).collect();
    let words = ome_xml(result.header(), field, species, &times);
    let stack = Stack { result, field, species, frames, words };
    let out = File::create(path).map(BufWriter::new).map_err(|error| Failure::Tiff(error.into()));
    out.and_then(|out| stack.write_all(out, LARGEST_PLAIN)).map_err(|failure| match failure {
        Failure::Result(error) => error,
        Failure::Tiff(error) => machine_error(path, "cannot be written", &error.to_string()),
    })
}

/// What kept a stack from being written: what is read, or where it goes.
enum Failure {
    Result(crate::error::Error),
    Tiff(TiffError),
}

impl From<crate::error::Error> for Failure {
    fn from(error: crate::error::Error) -> Self {
        Self::Result(error)
    }
}

impl From<TiffError> for Failure {
    fn from(error: TiffError) -> Self {
        Self::Tiff(error)
    }
}

/// What is written.
struct Stack<'a> {
    result: &'a ResultFile,
    field: &'a FieldLayout,
    species: &'a [usize],
    frames: &'a [usize],
    words: String,
}

impl Stack<'_> {
    /// Writes the file, as BigTIFF if it would be larger than so many bytes.
    fn write_all(&self, mut out: impl Write + Seek, largest_plain: u64) -> std::result::Result<(), Failure> {
        let pictures = (self.frames.len() * self.species.len() * self.field.cells[2]) as u64;
        let picture = (4 * self.field.cells[0] * self.field.cells[1]) as u64 + DIRECTORY;
        match pictures * picture + self.words.len() as u64 > largest_plain {
            true => self.write(TiffEncoder::new_big(&mut out)?)?,
            false => self.write(TiffEncoder::new(&mut out)?)?,
        }
        Ok(out.flush().map_err(TiffError::from)?)
    }

    fn write<W: Write + Seek, K: TiffKind>(&self, mut encoder: TiffEncoder<W, K>) -> std::result::Result<(), Failure> {
        let [nx, ny, _] = self.field.cells;
        let mut words = Some(self.words.as_str());
        for frame in self.frames {
            for number in self.species {
                let values = self.result.field_frame(&self.field.name, &self.field.species[*number].0, *frame)?;
                for layer in values.chunks(nx * ny) {
                    // As many digits as were stored.
                    let layer: Vec<f32> = layer.iter().map(|value| *value as f32).collect();
                    add(&mut encoder, [nx, ny], &layer, words.take())?;
                }
            }
        }
        Ok(())
    }
}

/// Adds a picture; the first carries the words about all of them.
fn add<W: Write + Seek, K: TiffKind>(
    encoder: &mut TiffEncoder<W, K>,
    [width, height]: [usize; 2],
    values: &[f32],
    words: Option<&str>,
) -> TiffResult<()> {
    let mut image = encoder.new_image::<Gray32Float>(u32::try_from(width)?, u32::try_from(height)?)?;
    if let Some(words) = words {
        image.encoder().write_tag(Tag::ImageDescription, words)?;
    }
    image.write_data(values)
}

/// A description in OME-XML (2016-06), in ASCII, which is all that TIFF has.
fn ome_xml(header: &Header, field: &FieldLayout, species: &[usize], times: &[f64]) -> String {
    let [nx, ny, nz] = field.cells;
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xsi:schemaLocation=\"http://www.openmicroscopy.org/Schemas/OME/2016-06 http://www.openmicroscopy.org/Schemas/OME/2016-06/ome.xsd\" \
         Creator=\"pseudopod {}\">\n<Image ID=\"Image:0\" Name=\"{}\">\n<Description>{}</Description>\n\
         <Pixels ID=\"Pixels:0\" DimensionOrder=\"XYZCT\" Type=\"float\" BigEndian=\"{}\" SizeX=\"{nx}\" SizeY=\"{ny}\" SizeZ=\"{nz}\" \
         SizeC=\"{}\" SizeT=\"{}\"",
        escaped(&header.version),
        escaped(&field.name),
        escaped(&header.title),
        cfg!(target_endian = "big"),
        species.len(),
        times.len(),
    );
    // The one layer of a field of the substrate has no thickness.
    let axes = if field.is_flat() { &[Along::X, Along::Y][..] } else { &[Along::X, Along::Y, Along::Z] };
    for axis in axes {
        let (letter, size) = (axis.letter().to_uppercase(), field.spacing[axis.number()]);
        let _ = write!(text, " PhysicalSize{letter}=\"{size}\" PhysicalSize{letter}Unit=\"\u{b5}m\"");
    }
    if let Some(interval) = interval_of(times) {
        let _ = write!(text, " TimeIncrement=\"{interval}\" TimeIncrementUnit=\"s\"");
    }
    text.push_str(">\n");
    for (channel, number) in species.iter().enumerate() {
        let name = escaped(&field.species[*number].0);
        let _ = writeln!(
            text,
            "<Channel ID=\"Channel:0:{channel}\" Name=\"{name}\" SamplesPerPixel=\"1\"><AnnotationRef ID=\"Annotation:{channel}\"/></Channel>"
        );
    }
    let _ = writeln!(text, "<TiffData IFD=\"0\" PlaneCount=\"{}\"/>", nz * species.len() * times.len());
    planes(&mut text, field, species.len(), times);
    text.push_str("</Pixels>\n</Image>\n<StructuredAnnotations>\n");
    for (channel, number) in species.iter().enumerate() {
        let unit = escaped(&field.species[*number].1);
        let _ = writeln!(
            text,
            "<MapAnnotation ID=\"Annotation:{channel}\" Namespace=\"pseudopod/unit\"><Value><M K=\"unit\">{unit}</M></Value></MapAnnotation>"
        );
    }
    text.push_str("</StructuredAnnotations>\n</OME>\n");
    in_ascii(&text)
}

/// When each picture is, s, and where the centre of its first box, µm.
fn planes(text: &mut String, field: &FieldLayout, channels: usize, times: &[f64]) {
    let centre = |along: Along, index: usize| (field.centre(along, index) * 1e9).round() / 1e9;
    let (x, y) = (centre(Along::X, 0), centre(Along::Y, 0));
    for (t, time) in times.iter().enumerate() {
        for (c, z) in (0..channels).flat_map(|c| (0..field.cells[2]).map(move |z| (c, z))) {
            let _ = writeln!(
                text,
                "<Plane TheZ=\"{z}\" TheC=\"{c}\" TheT=\"{t}\" DeltaT=\"{time}\" DeltaTUnit=\"s\" PositionX=\"{x}\" PositionXUnit=\"\u{b5}m\" \
                 PositionY=\"{y}\" PositionYUnit=\"\u{b5}m\" PositionZ=\"{}\" PositionZUnit=\"\u{b5}m\"/>",
                centre(Along::Z, z)
            );
        }
    }
}

/// The time from frame to frame, if it is always the same, s.
fn interval_of(times: &[f64]) -> Option<f64> {
    let interval = (times.last()? - times[0]) / (times.len() - 1).max(1) as f64;
    let same = times.windows(2).all(|pair| ((pair[1] - pair[0]) / interval - 1.0).abs() < 1e-6);
    (times.len() > 1 && same).then_some((interval * 1e9).round() / 1e9)
}

/// A text of XML in which other signs are references.
fn in_ascii(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign.is_ascii() {
            true => plain.push(sign),
            false => plain.push_str(&format!("&#{};", u32::from(sign))),
        }
    }
    plain
}

#[cfg(test)]
#[path = "ome_tiff_tests.rs"]
mod tests;
