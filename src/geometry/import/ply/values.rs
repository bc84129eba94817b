//! The values behind the header of a PLY file, one after the other.

use super::super::text::{Text, Word};
use super::header::{Encoding, Kind};
use crate::error::Fault;

/// Where the values come from.
pub(super) enum Values<'a> {
    /// Words of a text.
    Words {
        /// The whole file.
        text: &'a Text,
        /// The words not read yet.
        words: Box<dyn Iterator<Item = Word<'a>> + 'a>,
        /// The word read last.
        last: Word<'a>,
    },
    /// Bytes not read yet.
    Bytes {
        /// The bytes.
        bytes: &'a [u8],
        /// Their order.
        encoding: Encoding,
    },
}

/// Why a value could not be read.
pub(super) enum Trouble {
    /// The file ends.
    End,
    /// The word is not a number.
    Word(Box<Fault>),
}

impl<'a> Values<'a> {
    /// The values of an ASCII file from byte `start` on.
    pub fn of_text(text: &'a Text, start: usize) -> Self {
        let words = Box::new(text.words_from(start));
        Self::Words { text, words, last: Word { text: "", start } }
    }

    /// Reads one value. All types of PLY fit a double exactly.
    pub fn next(&mut self, kind: Kind) -> Result<f64, Trouble> {
        match self {
            Self::Words { text, words, last } => {
                *last = words.next().ok_or(Trouble::End)?;
                last.text.parse().map_err(|_| {
                    let message = format!("`{}` is not a number", last.text);
                    Trouble::Word(Box::new(text.fault(*last, message, "expected a number", "check the line")))
                })
            }
            Self::Bytes { bytes, encoding } => {
                let big = *encoding == Encoding::BigEndian;
                Ok(match kind {
                    Kind::I8 => f64::from(i8::from_le_bytes(take(bytes, big)?)),
                    Kind::U8 => f64::from(u8::from_le_bytes(take(bytes, big)?)),
                    Kind::I16 => f64::from(i16::from_le_bytes(take(bytes, big)?)),
                    Kind::U16 => f64::from(u16::from_le_bytes(take(bytes, big)?)),
                    Kind::I32 => f64::from(i32::from_le_bytes(take(bytes, big)?)),
                    Kind::U32 => f64::from(u32::from_le_bytes(take(bytes, big)?)),
                    Kind::F32 => f64::from(f32::from_le_bytes(take(bytes, big)?)),
                    Kind::F64 => f64::from_le_bytes(take(bytes, big)?),
                })
            }
        }
    }

    /// A fault of the value read last: with its location in a text.
    pub fn fault(&self, file: &str, message: String, help: &str) -> Fault {
        match self {
            Self::Words { text, last, .. } => text.fault(*last, message, "here", help),
            Self::Bytes { .. } => Fault::new(format!("mesh file `{file}`: {message}")).help(help),
        }
    }
}

/// Takes the next N bytes, as little-endian.
fn take<const N: usize>(bytes: &mut &[u8], big_endian: bool) -> Result<[u8; N], Trouble> {
    let (head, rest) = bytes.split_first_chunk::<N>().ok_or(Trouble::End)?;
    *bytes = rest;
    let mut value = *head;
    if big_endian {
        value.reverse();
    }
    Ok(value)
}
