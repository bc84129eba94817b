//! Arrays in VTK's XML files: numbers in blocks that are compressed with zlib, as text in base64.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::packing::LEVEL;

/// Bytes that are compressed at once.
const BLOCK: usize = 1 << 18;

/// The element around everything, for files of this type of data.
pub(super) fn opening(kind: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
    )
}

/// The simulated time of what a file shows, s, where VTK looks for it.
pub(super) fn time_value(time: f64) -> String {
    format!(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time}\
         </DataArray>\n</FieldData>\n"
    )
}

/// A text as the value of an attribute, or between tags.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The numbers of an array.
pub(super) enum Numbers<'a> {
    Floats(&'a [f64]),
    Singles(&'a [f32]),
    Integers(&'a [i64]),
    Bytes(&'a [u8]),
}

impl Numbers<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::Floats(_) => "Float64",
            Self::Singles(_) => "Float32",
            Self::Integers(_) => "Int64",
            Self::Bytes(_) => "UInt8",
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::Floats(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            Self::Singles(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            Self::Integers(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            Self::Bytes(numbers) => numbers.to_vec(),
        }
    }
}

/// Writes an array with so many numbers for each point or cell; its unit goes where VTK keeps units, unless it is a pure number.
pub(super) fn write_array(
    out: &mut impl Write,
    name: &str,
    components: usize,
    unit: &str,
    numbers: &Numbers,
) -> io::Result<()> {
    let (kind, name) = (numbers.kind(), escaped(name));
    writeln!(out, "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">")?;
    write_packed(out, &numbers.bytes())?;
    if !matches!(unit, "" | "1") {
        let unit = escaped(unit);
        write!(out, "\n<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{unit}</InformationKey>")?;
    }
    writeln!(out, "\n</DataArray>")
}

/// Writes how many blocks there are, the bytes of a whole one, of the last if it is not whole, and of each when compressed; then
/// the blocks. Both parts are encoded by themselves.
fn write_packed(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let pack = |block: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
        encoder.write_all(block)?;
        encoder.finish()
    };
    let blocks: Vec<Vec<u8>> = bytes.par_chunks(BLOCK).map(pack).collect::<io::Result<_>>()?;
    let mut header = vec![blocks.len(), BLOCK, bytes.len() % BLOCK];
    header.extend(blocks.iter().map(Vec::len));
    let header: Vec<u8> = header.into_iter().flat_map(|length| (length as u64).to_le_bytes()).collect();
    out.write_all(base64(&header).as_bytes())?;
    out.write_all(base64(&blocks.concat()).as_bytes())
}

/// Bytes as text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0_u32, |word, at| word << 8 | u32::from(three.get(at).copied().unwrap_or(0)));
        for sign in 0..4 {
            // So many bytes make one sign more, and the rest is filled up.
            let is_filling = sign > three.len();
            text.push(if is_filling { '=' } else { char::from(SIGNS[(word >> (18 - 6 * sign) & 63) as usize]) });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    #[test]
    fn texts_of_bytes_are_those_of_the_standard() {
        let known = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (bytes, text) in known {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xff, 0xfe, 0xfb]), "//77");
    }
}
