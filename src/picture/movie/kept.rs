//! Frames of a film that wait, packed, until all of them are known: of each what has changed since the one before.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use crate::picture::Image;

/// The part of a picture from the left and the top edge to the right and the bottom one, px.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Area {
    pub left: usize,
    pub top: usize,
    pub right: usize,
    pub bottom: usize,
}

/// Frames of one size.
#[derive(Default)]
pub(super) struct Kept {
    before: Option<Image>,
    /// What changed, packed, and how long the frame stays.
    frames: Vec<(Area, Vec<u8>, u16)>,
}

/// A frame that is taken out again.
pub(super) struct Taken<'a> {
    /// All of it.
    pub image: &'a Image,
    /// What differs from the frame before; all of the first one.
    pub area: Area,
    /// The frame before.
    pub before: Option<&'a Image>,
    /// How long it stays, in the parts of a second that it was added with.
    pub delay: u16,
}

impl Kept {
    /// Adds a frame of the size of the others, which stays for `delay` parts of a second.
    pub fn add(&mut self, image: &Image, delay: u16) -> std::io::Result<()> {
        let area = Area::changed(self.before.as_ref(), image);
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
        for row in area.rows(image.width) {
            packer.write_all(&image.rgb[row])?;
        }
        self.frames.push((area, packer.finish()?, delay));
        self.before = Some(image.clone());
        Ok(())
    }

    /// Width, height and number of the frames; none where there are none.
    pub fn extent(&self) -> Option<[usize; 3]> {
        self.before.as_ref().map(|image| [image.width, image.height, self.frames.len()])
    }

    /// Takes all frames out, in their order.
    pub fn take(&self, mut one: impl FnMut(Taken) -> std::io::Result<()>) -> std::io::Result<()> {
        let Some(last) = &self.before else { return Ok(()) };
        let mut before: Option<Image> = None;
        for (area, packed, delay) in &self.frames {
            let blank = || Image { width: last.width, height: last.height, rgb: vec![0; last.rgb.len()] };
            let mut image = before.clone().unwrap_or_else(blank);
            let mut unpacker = ZlibDecoder::new(&packed[..]);
            for row in area.rows(last.width) {
                unpacker.read_exact(&mut image.rgb[row])?;
            }
            one(Taken { image: &image, area: *area, before: before.as_ref(), delay: *delay })?;
            before = Some(image);
        }
        Ok(())
    }
}

impl Area {
    /// The smallest one with all pixels that differ; one pixel when none does, and all of it where there is nothing before.
    fn changed(before: Option<&Image>, image: &Image) -> Self {
        let all = Self { left: 0, top: 0, right: image.width, bottom: image.height };
        let Some(before) = before else { return all };
        let mut found = Self { left: usize::MAX, top: usize::MAX, right: 0, bottom: 0 };
        for (n, (a, b)) in before.rgb.chunks_exact(3).zip(image.rgb.chunks_exact(3)).enumerate() {
            if a != b {
                let (x, y) = (n % image.width, n / image.width);
                found.left = found.left.min(x);
                found.top = found.top.min(y);
                found.right = found.right.max(x + 1);
                found.bottom = found.bottom.max(y + 1);
            }
        }
        if found.right == 0 { Self { right: 1, bottom: 1, ..all } } else { found }
    }

    pub fn width(&self) -> usize {
        self.right - self.left
    }

    pub fn height(&self) -> usize {
        self.bottom - self.top
    }

    /// Where its rows stand among the bytes of a picture that is so wide.
    pub fn rows(self, width: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
        (self.top..self.bottom).map(move |y| 3 * (y * width + self.left)..3 * (y * width + self.right))
    }
}
