//! Edits: the inputs of fuzz targets whose files the program makes itself. An input is a list of edits of 16 bytes each, so that it stays
//! small, means the same part of the file whatever version wrote it, and is changed well by libFuzzer as it is.

/// One edit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edit {
    /// What is done.
    pub kind: u8,
    /// How much of it.
    pub extent: u8,
    /// Which of several parts of the file.
    pub part: u16,
    /// Where in it.
    pub at: u32,
    /// With which number.
    pub value: u64,
}

/// More edits than these say nothing new.
const MOST: usize = 32;

/// Numbers at the ends of their ranges.
pub const EXTREMES: [u64; 12] = [
    0,
    1,
    u64::MAX,
    i64::MAX as u64,
    i64::MIN as u64,
    u32::MAX as u64,
    1 << 31,
    1 << 40,
    0x7ff0_0000_0000_0000, // infinity
    0x7ff8_0000_0000_0000, // no number
    0x7fef_ffff_ffff_ffff, // the largest float
    0x8000_0000_0000_0001, // the smallest below zero
];

/// The edits in an input; what is left over at its end is none.
pub fn read(input: &[u8]) -> Vec<Edit> {
    let edit = |bytes: &[u8; 16]| Edit {
        kind: bytes[0],
        extent: bytes[1],
        part: u16::from_le_bytes([bytes[2], bytes[3]]),
        at: u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]),
        value: u64::from_le_bytes(std::array::from_fn(|i| bytes[8 + i])),
    };
    input.as_chunks::<16>().0.iter().take(MOST).map(edit).collect()
}

impl Edit {
    /// The number that it writes: an extreme one, or its own.
    pub fn number(self) -> u64 {
        EXTREMES.get(usize::from(self.extent >> 2)).copied().unwrap_or(self.value)
    }

    /// Edits bytes.
    pub fn apply(self, bytes: &mut Vec<u8>) {
        let at = self.at as usize % bytes.len().max(1);
        let few = usize::from(self.extent % 32).min(bytes.len() - at);
        match self.kind % 8 {
            0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << (self.value % 8)),
            1 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = self.value as u8),
            2 | 3 => {
                let length = [1, 2, 4, 8][usize::from(self.extent % 4)];
                let number = self.number().to_le_bytes();
                bytes.iter_mut().skip(at).zip(&number[..length]).for_each(|(byte, new)| *byte = *new);
            }
            // A number as postcard writes it, in place of one of one byte.
            4 => drop(bytes.splice(at..(at + 1).min(bytes.len()), varint(self.number()))),
            5 => drop(bytes.drain(at..at + few)),
            6 => {
                let copy = bytes[at..at + few].to_vec();
                let to = self.value as usize % (bytes.len() + 1);
                drop(bytes.splice(to..to, copy));
            }
            _ => bytes.truncate(at),
        }
    }
}

/// A number in groups of seven bits, the lowest first.
fn varint(mut number: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}
