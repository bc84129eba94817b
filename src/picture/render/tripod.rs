//! Which way x, y and z go in a picture: three short lines from a point, with letters.

use std::fmt::Write;

use super::camera::{Camera, basis};
use crate::Vec3;
use crate::picture::colour::Colour;
use crate::picture::text::{Anchor, FONT_FAMILY, Style, Weight, write_text};

/// The names of the axes and their colours, which the page in the browser has too: vermilion, green and blue that all eyes tell apart.
pub const AXES: [(&str, Colour); 3] =
    [("x", Colour([0xd5, 0x5e, 0x00])), ("y", Colour([0x00, 0x9e, 0x73])), ("z", Colour([0x00, 0x72, 0xb2]))];

/// Length of a line that lies across the view, and from its end to the middle of its letter, for a picture 720 px high.
const LONG: f64 = 26.0;
const TO_LETTER: f64 = 10.0;
/// Size of the letters, and half the sides of the box that holds any of them.
const LETTER: f64 = 15.0;
const HALF: [f64; 2] = [5.0, 6.0];
/// An axis that is seen at less than this share of its length is a dot.
const END_ON: f64 = 0.15;

/// The axes as a camera sees them.
pub(super) struct Tripod {
    /// For each axis its share to the right, upwards and towards the viewer.
    ends: [[f64; 3]; 3],
}

impl Tripod {
    pub fn of(camera: &Camera) -> Self {
        let [right, up, forward] = basis(Vec3::from(camera.target) - Vec3::from(camera.eye), Vec3::from(camera.up));
        Self {
            ends: [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| [right.dot(&axis), up.dot(&axis), -forward.dot(&axis)]),
        }
    }

    fn is_end_on(end: &[f64; 3]) -> bool {
        end[0].hypot(end[1]) < END_ON
    }

    /// Where the letter of an axis stands from the point where all meet, to the right and upwards.
    fn letter(&self, axis: usize) -> [f64; 2] {
        let end = &self.ends[axis];
        let away = |[x, y]: [f64; 2], far: f64| {
            let length = x.hypot(y).max(1e-9);
            [x * far / length, y * far / length]
        };
        if !Self::is_end_on(end) {
            let plain = |end: &[f64; 3]| away([end[0], end[1]], LONG * end[0].hypot(end[1]) + TO_LETTER);
            let (own, length) = (plain(end), end[0].hypot(end[1]));
            // Where a longer line has its letter, that of a shorter one stands beside its end.
            let hides = |other: &&[f64; 3]| {
                let ([x, y], longer) = (plain(other), other[0].hypot(other[1]) > length);
                longer && (x - own[0]).hypot(y - own[1]) < 12.0
            };
            if self.ends.iter().any(|other| hides(&other)) {
                return [
                    own[0] - TO_LETTER * (end[1] / length + end[0] / length),
                    own[1] + TO_LETTER * (end[0] - end[1]) / length,
                ];
            }
            return own;
        }
        // Where the others are not.
        let sum = |k: usize| self.ends.iter().map(|end| end[k]).sum::<f64>() - end[k];
        away([-sum(0), -sum(1)], TO_LETTER + 3.0)
    }

    /// How far lines and letters reach from the point where all meet: left, right, down and up, for a picture 720 px high.
    fn reach(&self) -> [f64; 4] {
        let mut reach = [4.0; 4];
        for axis in 0..3 {
            let [x, y] = self.letter(axis);
            let far = [HALF[0] - x, HALF[0] + x, HALF[1] - y, HALF[1] + y];
            reach = [0, 1, 2, 3].map(|side| far[side].max(reach[side]));
        }
        reach
    }

    /// How wide it is, in pixels of a picture whose unit this is.
    pub fn width(&self, unit: f64) -> f64 {
        let [left, right, ..] = self.reach();
        (left + right) * unit
    }

    /// Writes it with its left lower corner here. A pale rim lets it be read on whatever is behind it.
    pub fn write(&self, svg: &mut String, left: f64, bottom: f64, unit: f64) {
        let reach = self.reach();
        let (x, y) = (left + reach[0] * unit, bottom - reach[2] * unit);
        let mut order = [0, 1, 2];
        // What points away is drawn first.
        order.sort_by(|a, b| self.ends[*a][2].total_cmp(&self.ends[*b][2]));
        for axis in order {
            let ([across, up, _], (name, colour)) = (self.ends[axis], AXES[axis]);
            for (paint, opacity, rim) in [("#ffffff".to_owned(), 0.75, 3.0), (colour.hex(), 1.0, 0.0)] {
                if Self::is_end_on(&self.ends[axis]) {
                    let radius = (3.2 + 0.5 * rim) * unit;
                    let _ = writeln!(
                        svg,
                        r#"<circle class="axis" cx="{x:.2}" cy="{y:.2}" r="{radius:.2}" fill="{paint}" fill-opacity="{opacity}"/>"#
                    );
                } else {
                    let (to_x, to_y, width) = (LONG * unit * across, -LONG * unit * up, (2.4 + rim) * unit);
                    let _ = writeln!(
                        svg,
                        r#"<path class="axis" d="M{x:.2} {y:.2}l{to_x:.2} {to_y:.2}" stroke="{paint}" stroke-opacity="{opacity}" stroke-width="{width:.2}" stroke-linecap="round" fill="none"/>"#
                    );
                }
            }
            let [right, above] = self.letter(axis);
            let (x, y, size) = (x + right * unit, y - (above - 0.33 * LETTER) * unit, LETTER * unit);
            let _ = writeln!(
                svg,
                r##"<text x="{x:.2}" y="{y:.2}" font-size="{size}" font-family="{FONT_FAMILY}" text-anchor="middle" fill="#ffffff" fill-opacity="0.75" stroke="#ffffff" stroke-opacity="0.75" stroke-width="{:.2}" stroke-linejoin="round">{name}</text>"##,
                3.0 * unit
            );
            write_text(svg, x, y, Style { size, anchor: Anchor::Middle, weight: Weight::Plain }, name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::render::Projection;

    fn seen(from: [f64; 3], up: [f64; 3]) -> Tripod {
        Tripod::of(&Camera {
            eye: from,
            target: [0.0; 3],
            up,
            projection: Projection::Orthographic { height: 1.0 },
            shift: [0.0; 2],
        })
    }

    #[test]
    fn axes_go_where_the_camera_sees_them_go() {
        let front = seen([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]);
        assert_eq!(front.ends, [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]);
        let top = seen([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
        assert_eq!(top.ends, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        // The letter of what is a dot stands across from the others.
        let [x, y] = top.letter(2);
        assert!(x < -5.0 && y < -5.0, "{x} {y}");
    }

    #[test]
    fn all_of_it_is_within_the_box_that_is_kept_free() {
        for from in [[1.0, -2.0, 1.0], [0.3, 0.2, -1.0], [-1.0, -0.1, 0.2], [0.0, 0.0, 1.0], [-1.0, 2.0, -3.0]] {
            let tripod = seen(from, [0.0, 0.0, 1.0]);
            let [left, right, down, up] = tripod.reach();
            for axis in 0..3 {
                let [x, y] = tripod.letter(axis);
                assert!(x - HALF[0] >= -left && x + HALF[0] <= right && y - HALF[1] >= -down && y + HALF[1] <= up);
            }
            // No higher than what is free below the scene, 0.095 of 720 px less the 10 px below it.
            assert!(down + up <= 58.0, "{from:?}: {}", down + up);
        }
    }
}
