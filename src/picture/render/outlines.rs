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

    /// Whether a neighbour of a sample shows another cell.
    fn is_line(&self, sample: usize) -> bool {
        let own = self.bodies[sample];
        let column = sample % self.width;
        let other = |neighbour: usize| self.bodies.get(neighbour).is_some_and(|body| *body != NOTHING && *body != own);
        own != NOTHING
            && ((column > 0 && other(sample - 1))
                || (column + 1 < self.width && other(sample + 1))
                || (sample >= self.width && other(sample - self.width))
                || other(sample + self.width))
    }
}
