//! Compresses pieces of the result file: what HDF5's own filters "shuffle" and "deflate" would make of them, faster.
//!
//! The library's deflate does 55 MB/s on one core. Here the pieces are packed on all cores, and the bytes that cannot
//! be packed are not tried: of the eight bytes of a position all but the first two or three are noise.

use flate2::{Compress, Compression, FlushCompress};

/// Level of compression of the bytes that can be packed.
pub(super) const LEVEL: u32 = 3;
/// Bytes looked at to see whether a row of bytes can be packed, evenly spread.
const LOOKED_AT: usize = 4096;
/// A row whose bytes carry more than this many of eight bits is left as it is: packing would gain under 6 %.
const NOISE_BITS: f64 = 7.5;

/// The state of a compressor, to be used again.
pub(super) fn packer() -> Compress {
    Compress::new(Compression::new(LEVEL), false)
}

/// Numbers of eight bytes: see [`pack_bytes`].
pub(super) fn pack(packer: &mut Compress, words: impl ExactSizeIterator<Item = u64>) -> Vec<u8> {
    pack_bytes(packer, words.map(u64::to_ne_bytes))
}

/// All first bytes of the numbers, all second bytes, …, as one zlib stream (RFC 1950, RFC 1951).
pub(super) fn pack_bytes<const W: usize>(
    packer: &mut Compress,
    words: impl ExactSizeIterator<Item = [u8; W]>,
) -> Vec<u8> {
    let count = words.len();
    let mut planes = vec![0_u8; W * count];
    for (number, word) in words.enumerate() {
        for (plane, byte) in word.into_iter().enumerate() {
            planes[plane * count + number] = byte;
        }
    }
    let mut packed = Vec::with_capacity(planes.len() + planes.len() / 256 + 256);
    packed.extend_from_slice(&[0x78, 0x01]);
    let noisy: Vec<bool> = planes.chunks(count.max(1)).map(is_noise).collect();
    let mut start = 0;
    for alike in noisy.chunk_by(|a, b| a == b) {
        let bytes = &planes[start..start + alike.len() * count];
        start += bytes.len();
        if alike[0] {
            store(bytes, &mut packed);
        } else {
            deflate(packer, bytes, &mut packed);
        }
    }
    // An empty block that says it is the last, and the checksum.
    packed.extend_from_slice(&[1, 0, 0, 0xff, 0xff]);
    packed.extend_from_slice(&adler32(&planes).to_be_bytes());
    packed
}

/// Appends the bytes as they are, in blocks as long as the format allows.
fn store(bytes: &[u8], packed: &mut Vec<u8>) {
    for block in bytes.chunks(usize::from(u16::MAX)) {
        let length = block.len() as u16;
        packed.push(0);
        packed.extend_from_slice(&length.to_le_bytes());
        packed.extend_from_slice(&(!length).to_le_bytes());
        packed.extend_from_slice(block);
    }
}

/// Appends the bytes compressed, in blocks that end at a whole byte and are not the last.
fn deflate(packer: &mut Compress, bytes: &[u8], packed: &mut Vec<u8>) {
    packer.reset();
    loop {
        packed.reserve(256);
        let taken = packer.total_in() as usize;
        // The only error is a lack of space, which the next turn makes.
        let _ = packer.compress_vec(&bytes[taken..], packed, FlushCompress::Sync);
        // Space left over means that nothing waits inside.
        if packer.total_in() as usize == bytes.len() && packed.len() < packed.capacity() {
            return;
        }
    }
}

/// The checksum of a zlib stream (RFC 1950).
fn adler32(bytes: &[u8]) -> u32 {
    // The most bytes whose sums cannot overflow.
    const TOGETHER: usize = 5552;
    let (mut a, mut b) = (1_u32, 0_u32);
    for together in bytes.chunks(TOGETHER) {
        for byte in together {
            a += u32::from(*byte);
            b += a;
        }
        (a, b) = (a % 65_521, b % 65_521);
    }
    (b << 16) | a
}

/// Whether the bytes look like chance: by the entropy of how often each value occurs.
fn is_noise(bytes: &[u8]) -> bool {
    // Fewer bytes than this tell little, and cost little to try.
    if bytes.len() < LOOKED_AT / 2 {
        return false;
    }
    let mut counts = [0_u32; 256];
    let mut looked_at = 0.0;
    for byte in bytes.iter().step_by((bytes.len() / LOOKED_AT).max(1)) {
        counts[usize::from(*byte)] += 1;
        looked_at += 1.0;
    }
    let share = |count: &u32| f64::from(*count) / looked_at;
    let bits: f64 = counts.iter().filter(|count| **count > 0).map(share).map(|p| -p * p.log2()).sum();
    bits > NOISE_BITS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unpack(packed: &[u8], count: usize) -> Vec<u64> {
        let mut planes = Vec::new();
        std::io::copy(&mut flate2::read::ZlibDecoder::new(packed), &mut planes).unwrap();
        assert_eq!(planes.len(), 8 * count);
        let byte = |number: usize, plane: usize| planes[plane * count + number];
        (0..count).map(|number| u64::from_ne_bytes(std::array::from_fn(|plane| byte(number, plane)))).collect()
    }

    /// Numbers without any rule, from a linear congruence.
    fn noise(count: usize) -> Vec<u64> {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state ^ (state >> 29)
        };
        (0..count).map(|_| next()).collect()
    }

    #[test]
    fn everything_comes_back() {
        let mut packer = packer();
        for count in [0, 1, 3, 126, 5000, 98_304] {
            let smooth: Vec<u64> = (0..count).map(|i| (5.0 + (i as f64 * 12.9898).sin()).to_bits()).collect();
            for words in [smooth, noise(count), vec![0; count]] {
                let packed = pack(&mut packer, words.iter().copied());
                assert_eq!(unpack(&packed, count), words, "{count} numbers");
            }
        }
    }

    #[test]
    fn noise_takes_no_more_space_than_it_has_and_zeros_hardly_any() {
        let length = |words: Vec<u64>| pack(&mut packer(), words.into_iter()).len();
        // Five bytes for each stored block of at most 65 535.
        assert!(length(noise(98_304)) < 8 * 98_304 + 256);
        assert!(length(vec![0; 98_304]) < 8_000);
    }
}
