//! All that a page asks for, in one piece: the answers of a [`Scene`], packed.
//!
//! What follows an answer of the same kind and size is told by how its numbers of 16 bits differ from it; low and high bytes stand
//! apart, and all is deflated. Frames are left out, evenly, where they take more than they may.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};

use super::pack::Box3;
use super::scene::{Answer, Scene};
use crate::error::Result;

/// The share of the whole that the numbers of all cells may take, unless they are what colours show.
const NUMBERS: usize = 4;

/// Packed answers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Film {
    /// Of each answer its request, where it begins, how long it is packed and unpacked, and the request that it differs from.
    index: Vec<Value>,
    bytes: Vec<u8>,
    /// Frames in it.
    pub frames: usize,
    /// Frames of the result.
    pub of: usize,
}

impl Film {
    /// The answers of a result that a page may ask for, in no more than `limit` bytes of text, if that can be. Of quantities there
    /// are those that are named, what the document colours by, and all of the cells where these take little.
    ///
    /// # Errors
    /// A damaged file.
    pub fn of(scene: &mut Scene, named: &[String], limit: usize) -> Result<Self> {
        let frames = scene.with_result(|result| result.frames());
        let mut within: Option<Box3> = None;
        for frame in 0..frames {
            let around = Box3::around(&scene.with_result(|result| result.positions(frame))?);
            within = Some(within.map_or(around, |before| before.joined(around)));
        }
        // All frames in one box, so that what stands still has the same numbers in all.
        scene.within = within;
        let mut stride = 1;
        loop {
            let kept = thinned(frames, stride);
            match Self::packed(scene, named, &kept, limit)? {
                Ok(film) => return Ok(film),
                Err(done) if kept.len() > 2 => {
                    let longer = (stride as f64 * 1.1 * kept.len() as f64 / done.max(1) as f64).ceil() as usize;
                    stride = longer.clamp(stride + 1, frames);
                }
                // Less than the first and the last frame is no film.
                Err(_) => return Self::packed(scene, named, &kept, usize::MAX).map(|film| film.unwrap_or_default()),
            }
        }
    }

    /// The film of these frames; the number of those that went in where it is too long.
    fn packed(
        scene: &Scene,
        named: &[String],
        kept: &[usize],
        limit: usize,
    ) -> Result<std::result::Result<Self, usize>> {
        let mut film = Self { frames: kept.len(), of: scene.with_result(|result| result.frames()), ..Self::default() };
        let about = parsed(scene, "scene")?;
        let course = cut_course(parsed(scene, "course")?, kept);
        let asked = Asked::of(scene, &about, named, kept.len(), limit);
        film.add("scene", asked.told(about).to_string().as_bytes(), None);
        film.add("course", course.to_string().as_bytes(), None);
        for request in asked.once {
            if let Some(answer) = scene.answer(&request)? {
                film.add(&request, answer.bytes(), None);
            }
        }
        let mut before: Vec<(String, Vec<u8>)> = Vec::new();
        for (number, frame) in kept.iter().enumerate() {
            let mut now = Vec::with_capacity(before.len());
            for [first, rest] in &asked.each {
                let Some(answer) = scene.answer(&format!("{first}/{frame}{rest}"))? else { continue };
                let request = format!("{first}/{number}{rest}");
                let bytes = answer.bytes().to_vec();
                let like =
                    |(other, _): &&(String, Vec<u8>)| *other == format!("{first}/{}{rest}", number.wrapping_sub(1));
                film.add(&request, &bytes, before.iter().find(like).map(|(name, bytes)| (name.as_str(), &bytes[..])));
                now.push((request, bytes));
            }
            before = now;
            if text_size(film.bytes.len()) > limit {
                return Ok(Err(number + 1));
            }
        }
        let is_short = film.to_base64().len() <= limit;
        Ok(if is_short { Ok(film) } else { Err(kept.len()) })
    }

    /// Adds an answer, told by how it differs from another of its size.
    fn add(&mut self, request: &str, bytes: &[u8], before: Option<(&str, &[u8])>) {
        let before = before.filter(|(_, other)| other.len() == bytes.len() && bytes.len().is_multiple_of(2));
        let start = self.bytes.len();
        let told = before.map(|(_, other)| parted(&differences(bytes, other)));
        self.bytes.extend(deflated(told.as_deref().unwrap_or(bytes)));
        let packed = self.bytes.len() - start;
        self.index.push(json!([request, start, packed, bytes.len(), before.map(|(name, _)| name)]));
    }

    /// The length of the packed index, and in base 64 the index, JSON, and the packed answers.
    pub(super) fn to_base64(&self) -> String {
        let index = deflated(Value::from(self.index.clone()).to_string().as_bytes());
        format!("{} {}", index.len(), STANDARD.encode([index.as_slice(), &self.bytes].concat()))
    }
}

/// What so many bytes take in base 64.
fn text_size(bytes: usize) -> usize {
    bytes.div_ceil(3) * 4
}

/// What is asked for once, and of each frame: what stands before the number of the frame, and behind it.
struct Asked {
    once: Vec<String>,
    each: Vec<[String; 2]>,
    quantities: Vec<String>,
}

impl Asked {
    fn of(scene: &Scene, about: &Value, named: &[String], frames: usize, limit: usize) -> Self {
        let names = |list: &Value| -> Vec<String> {
            let all = list.as_array().into_iter().flatten();
            all.filter_map(|one| one["name"].as_str()).map(str::to_owned).collect()
        };
        let cells = scene.with_result(|result| result.known_cells().len());
        let all = about["quantities"].as_array().into_iter().flatten();
        let of_cells: Vec<String> =
            all.filter(|one| one["of"] == "cells").filter_map(|one| one["name"].as_str().map(str::to_owned)).collect();
        let takes_little = 4 * cells * frames * of_cells.len() <= limit / NUMBERS;
        let coloured = about["look"]["colour_by"].as_str().filter(|name| *name != "type");
        let mut quantities: Vec<String> =
            coloured.into_iter().map(str::to_owned).chain(named.iter().cloned()).collect();
        quantities.extend(of_cells.into_iter().filter(|_| takes_little));
        let mut unique = Vec::with_capacity(quantities.len());
        quantities.into_iter().for_each(|name| {
            if !unique.contains(&name) {
                unique.push(name)
            }
        });
        let quantities: Vec<String> = unique;
        let mut fields = Vec::new();
        for field in about["fields"].as_array().into_iter().flatten() {
            let name = field["name"].as_str().unwrap_or_default();
            fields.extend(names(&field["species"]).iter().map(|species| format!("{name}.{species}")));
        }
        let mut once: Vec<String> = names(&about["charts"]).iter().map(|name| format!("chart/{name}")).collect();
        once.extend(quantities.iter().chain(&fields).map(|name| format!("range/{name}")));
        once.extend(names(&about["series"]).iter().map(|name| format!("curve/{name}")));
        let mut each = vec![["frame".to_owned(), String::new()]];
        each.extend(quantities.iter().map(|name| ["values".to_owned(), format!("/{name}")]));
        each.extend(fields.iter().map(|name| ["field".to_owned(), format!("/{name}")]));
        let kinds = about["lines"].as_array().into_iter().flatten().filter_map(Value::as_str);
        each.extend(kinds.map(|kind| ["lines".to_owned(), format!("/{kind}")]));
        Self { once, each, quantities }
    }

    /// What the page is told of the scene, with no more quantities than there are in the film.
    fn told(&self, mut about: Value) -> Value {
        if let Some(all) = about["quantities"].as_array_mut() {
            all.retain(|one| {
                one["name"].as_str().is_some_and(|name| self.quantities.iter().any(|known| known == name))
            });
        }
        about
    }
}

fn parsed(scene: &Scene, request: &str) -> Result<Value> {
    let text = match scene.answer(request)? {
        Some(Answer::Text(text)) => text,
        _ => String::new(),
    };
    Ok(serde_json::from_str(&text).unwrap_or(Value::Null))
}

/// The course with what belongs to these frames, and their numbers in the result.
fn cut_course(mut course: Value, kept: &[usize]) -> Value {
    let cut = |list: &Value| -> Value {
        match list.as_array() {
            Some(all) => kept.iter().map(|frame| all[*frame].clone()).collect::<Vec<_>>().into(),
            None => Value::Null,
        }
    };
    // Curves are told of all frames.
    course["all"] = course["times"].clone();
    course["times"] = cut(&course["times"]);
    if let Some(gone) = course["gone"].as_array_mut() {
        gone.iter_mut().for_each(|one| *one = cut(one));
    }
    course["numbers"] = json!(kept);
    course["running"] = json!(false);
    course
}

/// Every so many of some frames, the last one among them.
fn thinned(frames: usize, stride: usize) -> Vec<usize> {
    let last = frames.saturating_sub(1);
    let mut kept: Vec<usize> = (0..frames).step_by(stride.max(1)).collect();
    if kept.last().is_some_and(|kept| *kept != last) {
        kept.push(last);
    }
    kept
}

/// How the numbers of 16 bits in one differ from those in another.
fn differences(bytes: &[u8], other: &[u8]) -> Vec<u8> {
    let number = |pair: &[u8]| u16::from_le_bytes([pair[0], pair[1]]);
    let pairs = bytes.chunks_exact(2).zip(other.chunks_exact(2));
    pairs.flat_map(|(now, then)| number(now).wrapping_sub(number(then)).to_le_bytes()).collect()
}

/// All low bytes, then all high ones.
fn parted(bytes: &[u8]) -> Vec<u8> {
    bytes.iter().step_by(2).chain(bytes.iter().skip(1).step_by(2)).copied().collect()
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::new(6));
    // Writing to memory cannot fail.
    let _ = packer.write_all(bytes);
    packer.finish().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_frames_end_with_the_last() {
        assert_eq!(thinned(7, 1), [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(thinned(7, 4), [0, 4, 6]);
        assert_eq!(thinned(1, 3), [0]);
        assert!(thinned(0, 3).is_empty());
    }

    #[test]
    fn differences_put_together_again_are_what_was() {
        let (then, now) = ([1u8, 2, 250, 255, 7, 0], [0u8, 3, 4, 0, 7, 0]);
        let told = parted(&differences(&now, &then));
        let number = |of: &[u8], at: usize| u16::from_le_bytes([of[2 * at], of[2 * at + 1]]);
        let back: Vec<u8> = (0..3)
            .flat_map(|at| {
                let by = u16::from_le_bytes([told[at], told[3 + at]]);
                number(&then, at).wrapping_add(by).to_le_bytes()
            })
            .collect();
        assert_eq!(back, now);
    }
}
