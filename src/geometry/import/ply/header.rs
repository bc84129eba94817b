//! The header of a PLY file: which elements follow, how many, with which properties.

use super::super::text::{Text, Word};
use crate::error::Fault;

/// How the values are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// One value, or a list of values, of every item of an element.
#[derive(Debug)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
    /// The type of the length, if the property is a list.
    pub list: Option<Kind>,
}

/// A table of the file.
#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

/// Reads the header, the text up to and with `end_header`.
pub(super) fn parse(text: &Text) -> Result<Header, Fault> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.iter().map(|word| word.text).collect();
        let bad = |word: Word, expected: &str| {
            let message = format!("`{}` does not belong here in a PLY header", word.text);
            Err(text.fault(word, message, expected, "see the lines `format`, `element` and `property` of a PLY file"))
        };
        match words[..] {
            ["ply"] if number == 0 => {}
            _ if number == 0 => return bad(line[0], "expected `ply`"),
            ["comment" | "obj_info", ..] | ["end_header"] => {}
            ["format", word, _] => {
                encoding = Some(match word {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => return bad(line[1], "expected ascii, binary_little_endian or binary_big_endian"),
                });
            }
            ["element", name, count] => match count.parse() {
                Ok(count) => elements.push(Element { name: name.into(), count, properties: Vec::new() }),
                Err(_) => return bad(line[2], "expected a number of items"),
            },
            ["property", ref rest @ ..] => {
                let Some(element) = elements.last_mut() else { return bad(line[0], "expected `element` first") };
                let property =
                    match *rest {
                        ["list", length, kind, name] => kind_of(kind)
                            .zip(kind_of(length))
                            .map(|(kind, length)| Property { name: name.into(), kind, list: Some(length) }),
                        [kind, name] => kind_of(kind).map(|kind| Property { name: name.into(), kind, list: None }),
                        _ => None,
                    };
                let Some(property) = property else {
                    return bad(line[0], "expected `property TYPE NAME` or `property list TYPE TYPE NAME`");
                };
                element.properties.push(property);
            }
            _ => return bad(line[0], "expected format, element, property, comment or end_header"),
        }
    }
    let Some(encoding) = encoding else {
        return Err(text.fault_at_end("the PLY header has no `format` line", "write `format ascii 1.0`"));
    };
    Ok(Header { encoding, elements })
}

fn kind_of(word: &str) -> Option<Kind> {
    Some(match word {
        "char" | "int8" => Kind::I8,
        "uchar" | "uint8" => Kind::U8,
        "short" | "int16" => Kind::I16,
        "ushort" | "uint16" => Kind::U16,
        "int" | "int32" => Kind::I32,
        "uint" | "uint32" => Kind::U32,
        "float" | "float32" => Kind::F32,
        "double" | "float64" => Kind::F64,
        _ => return None,
    })
}
