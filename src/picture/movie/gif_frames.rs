//! Films as animated GIF: 255 colours chosen for the whole film, of each frame only what changed since the frame before.
//!
//! A colour at a point of the picture is drawn in the same way in all frames. So nothing flickers that stands still, and what moves leaves
//! no trace where it was.

use std::io::Write;

use super::kept::{Kept, Taken};

/// Hundredths of a second.
pub(super) const PER_SECOND: f64 = 100.0;
/// Bits per channel in which colours are counted.
const BITS: u32 = 6;
/// Palette entry that leaves the frame before visible.
const UNCHANGED: u8 = 255;

/// Writes the file: its colours are known once all frames are.
pub(super) fn write(frames: &Kept, target: &mut impl Write) -> std::io::Result<()> {
    let Some([width, height, _]) = frames.extent() else { return Ok(()) };
    let side = |pixels: usize| {
        u16::try_from(pixels).map_err(|_| std::io::Error::other("a GIF is at most 65 535 pixels wide and high"))
    };
    let palette = Palette::of(frames)?;
    let mut table = palette.table();
    let encoder = gif::Encoder::new(target, side(width)?, side(height)?, &palette.bytes());
    let mut encoder = encoder.map_err(std::io::Error::other)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(std::io::Error::other)?;
    frames.take(|Taken { image, area, before, delay }| {
        let mut buffer = Vec::with_capacity(area.width() * area.height());
        for y in area.top..area.bottom {
            for x in area.left..area.right {
                let at = 3 * (y * width + x)..3 * (y * width + x) + 3;
                let pixel = &image.rgb[at.clone()];
                let stays = before.is_some_and(|before| before.rgb[at] == *pixel);
                buffer.push(if stays { UNCHANGED } else { table.index([pixel[0], pixel[1], pixel[2]], x, y) });
            }
        }
        let frame = gif::Frame {
            delay,
            dispose: gif::DisposalMethod::Keep,
            transparent: Some(UNCHANGED),
            left: side(area.left)?,
            top: side(area.top)?,
            width: side(area.width())?,
            height: side(area.height())?,
            buffer: buffer.into(),
            ..gif::Frame::default()
        };
        encoder.write_frame(&frame).map_err(std::io::Error::other)
    })?;
    encoder.into_inner().map(drop).map_err(std::io::Error::other)
}

/// Up to 255 colours that stand for all of a film's.
struct Palette {
    colours: Vec<[u8; 3]>,
}

/// How often a colour occurs, with the sums of its channels.
#[derive(Clone, Copy)]
struct Count {
    bin: u32,
    number: u64,
    sum: [u64; 3],
}

impl Palette {
    /// Colours by median cut: the box of colours with the largest squared spread is halved until 255 boxes are there.
    fn of(frames: &Kept) -> std::io::Result<Self> {
        let mut counts = vec![Count { bin: 0, number: 0, sum: [0; 3] }; 1 << (3 * BITS)];
        frames.take(|Taken { image, area, .. }| {
            for row in area.rows(image.width) {
                for pixel in image.rgb[row].chunks_exact(3) {
                    let count = &mut counts[bin([pixel[0], pixel[1], pixel[2]]) as usize];
                    count.number += 1;
                    (0..3).for_each(|k| count.sum[k] += u64::from(pixel[k]));
                }
            }
            Ok(())
        })?;
        Ok(Self::of_counts(counts))
    }

    fn of_counts(counts: Vec<Count>) -> Self {
        let mut used: Vec<Count> = Vec::new();
        for (n, count) in counts.into_iter().enumerate().filter(|(_, count)| count.number > 0) {
            used.push(Count { bin: n as u32, ..count });
        }
        if used.is_empty() {
            return Self { colours: vec![[255; 3]] };
        }
        let mut boxes = vec![(0, used.len(), spread(&used))];
        while boxes.len() < usize::from(UNCHANGED) {
            let Some(widest) = (0..boxes.len())
                .filter(|k| boxes[*k].1 - boxes[*k].0 > 1)
                .max_by(|a, b| boxes[*a].2.1.total_cmp(&boxes[*b].2.1).then(b.cmp(a)))
            else {
                break;
            };
            let (from, to, (channel, _)) = boxes[widest];
            let part = &mut used[from..to];
            part.sort_unstable_by_key(|count| (count.sum[channel] / count.number, count.bin));
            let half = part.iter().map(|count| count.number).sum::<u64>() / 2;
            let mut passed = 0;
            let cut = part.iter().position(|count| {
                passed += count.number;
                passed > half
            });
            let middle = from + cut.unwrap_or(0).clamp(1, to - from - 1);
            boxes[widest] = (from, middle, spread(&used[from..middle]));
            boxes.push((middle, to, spread(&used[middle..to])));
        }
        let mean = |part: &[Count]| {
            let number: u64 = part.iter().map(|count| count.number).sum();
            [0, 1, 2].map(|k| ((part.iter().map(|count| count.sum[k]).sum::<u64>() + number / 2) / number) as u8)
        };
        Self { colours: boxes.iter().map(|(from, to, _)| mean(&used[*from..*to])).collect() }
    }

    /// 256 colours for the file; the last is the transparent one.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes: Vec<u8> = self.colours.iter().flatten().copied().collect();
        bytes.resize(256 * 3, 0);
        bytes
    }

    fn table(&self) -> Table<'_> {
        Table { palette: self, nearest: vec![u16::MAX; 1 << (3 * BITS)] }
    }
}

/// The widest channel of some colours and their summed squared distance from the mean along it.
fn spread(part: &[Count]) -> (usize, f64) {
    let number: f64 = part.iter().map(|count| count.number as f64).sum();
    let mut widest = (0, -1.0);
    for channel in 0..3 {
        let value = |count: &Count| count.sum[channel] as f64 / count.number as f64;
        let mean = part.iter().map(|count| count.sum[channel] as f64).sum::<f64>() / number;
        let squares: f64 = part.iter().map(|count| count.number as f64 * (value(count) - mean).powi(2)).sum();
        if squares > widest.1 {
            widest = (channel, squares);
        }
    }
    widest
}

/// Finds palette entries, remembering what it found.
struct Table<'a> {
    palette: &'a Palette,
    nearest: Vec<u16>,
}

impl Table<'_> {
    /// The entry for a pixel. A fixed pattern of small offsets spreads rounding over neighbours, so that gradients do
    /// not show bands, and stands still from frame to frame.
    fn index(&mut self, pixel: [u8; 3], x: usize, y: usize) -> u8 {
        const PATTERN: [[i32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
        let offset = (PATTERN[y % 4][x % 4] * 2 - 15) / 5;
        let moved = pixel.map(|value| (i32::from(value) + offset).clamp(0, 255) as u8);
        let known = &mut self.nearest[bin(moved) as usize];
        if *known == u16::MAX {
            let distance = |colour: &[u8; 3]| -> i32 {
                // Green differences are seen best, blue ones least.
                let weigh = [3, 6, 2];
                (0..3).map(|k| weigh[k] * (i32::from(colour[k]) - i32::from(moved[k])).pow(2)).sum()
            };
            let best = (0..self.palette.colours.len()).min_by_key(|k| distance(&self.palette.colours[*k]));
            *known = best.unwrap_or(0) as u16;
        }
        *known as u8
    }
}

/// The number under which a colour is counted.
fn bin(pixel: [u8; 3]) -> u32 {
    pixel.iter().fold(0, |bin, value| bin << BITS | u32::from(*value) >> (8 - BITS))
}
