//! Thin dark lines where two cells meet in the picture, by which cells of one colour are told apart.

use super::geometry::Geometry;
use super::raster::Band;
use super::samples::{NOTHING, SAMPLES};

/// How much light a line takes away where it covers a pixel.
const DARKNESS: f32 = 0.5;

/// Which cell is seen through each sample of a band.
pub(super) struct Outlines {
    bodies: Vec<u32>,
    width: usize,
}

impl Outlines {
    /// Of what a band shows.
    pub fn of(band: &Band, geometry: &Geometry) -> Self {
        let mut last = ([NOTHING; 2], NOTHING);
        let body = |(seen, veil): (&u32, &u32)| {
            if last.0 != [*seen, *veil] {
                let nearest = if *veil == NOTHING { *seen } else { *veil };
                // The floor and the background are beyond the last triangle.
                let body = geometry.triangles.get(nearest as usize).map_or(NOTHING, |triangle| triangle.body);
                last = ([*seen, *veil], body);
            }
            last.1
        };
        let mut bodies: Vec<u32> = band.seen.iter().zip(&band.veil).map(body).collect();
        let mut met = bodies.iter().filter(|body| **body != NOTHING);
        let first = met.next();
        if met.all(|body| Some(body) == first) {
            bodies.clear();
        }
        Self { bodies, width: band.width }
    }

    /// The light that is left of a pixel whose first sample is number `corner` of the band.
    pub fn light(&self, corner: usize) -> f32 {
        if self.bodies.is_empty() {
            return 1.0;
        }
        let samples = (0..SAMPLES * SAMPLES).map(|k| corner + k / SAMPLES * self.width + k % SAMPLES);
        let covered = samples.filter(|sample| self.is_line(*sample)).count();
        1.0 - DARKNESS * covered as f32 / (SAMPLES * SAMPLES) as f32
    }

    /// Whether another cell begins beside a sample, where both go on: what is one sample wide is mostly a miss at a side that facets share.
    fn is_line(&self, sample: usize) -> bool {
        let own = self.bodies[sample];
        let (column, last) = (sample % self.width, self.width - 1);
        let at = |by: isize| sample.checked_add_signed(by).and_then(|at| self.bodies.get(at)).copied();
        // What lies beyond the band is taken for more of the same.
        let begins = |by: isize, before: bool, beyond: bool| {
            let next = at(by).filter(|body| *body != NOTHING && *body != own);
            next.is_some_and(|next| {
                (!before || at(-by).is_none_or(|body| body == own))
                    && (!beyond || at(2 * by).is_none_or(|body| body == next))
            })
        };
        let row = self.width as isize;
        own != NOTHING
            && ((column > 0 && begins(-1, column < last, column > 1))
                || (column < last && begins(1, column > 0, column + 1 < last))
                || begins(-row, true, true)
                || begins(row, true, true))
    }
}
