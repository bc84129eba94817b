//! Where another cell fits among those that are there.

use std::collections::HashMap;

use crate::Vec3;
use crate::random::Stream;

/// Space that is taken, by boxes and by spheres.
pub struct Occupied {
    boxes: Near<[Vec3; 2]>,
    spheres: Near<(Vec3, f64)>,
    gap: f64,
}

impl Occupied {
    /// Nothing yet, where no sphere that is asked for or added is larger than `largest` and others keep `gap` from it, µm.
    pub fn new(largest: f64, gap: f64) -> Self {
        let width = 2.0 * largest + gap;
        Self { boxes: Near::new(width), spheres: Near::new(width), gap }
    }

    /// Takes a box, by its lowest and highest corner, µm.
    pub fn add_box(&mut self, low: Vec3, high: Vec3) {
        self.boxes.add([low, high], low, high);
    }

    /// Takes a sphere, µm.
    pub fn add_sphere(&mut self, centre: Vec3, radius: f64) {
        self.spheres.add((centre, radius), centre, centre);
    }

    /// Whether a sphere keeps the gap from all that is taken.
    pub fn is_clear(&self, centre: Vec3, radius: f64) -> bool {
        let of_box = |[low, high]: &[Vec3; 2]| (centre - centre.sup(low).inf(high)).norm();
        self.spheres.around(centre).all(|(other, its)| (centre - other).norm() >= radius + its + self.gap)
            && self.boxes.around(centre).all(|one| of_box(one) >= radius + self.gap)
    }

    /// The spheres that were added: centre and radius, µm.
    pub fn spheres(&self) -> &[(Vec3, f64)] {
        &self.spheres.all
    }
}

/// A point in a box, uniformly at random, µm.
pub fn point_in_box(stream: &mut Stream, low: Vec3, high: Vec3) -> Vec3 {
    let ([x, y], [z, _]) = (stream.uniform_pair(), stream.uniform_pair());
    low + (high - low).component_mul(&Vec3::new(x, y, z))
}

/// What may be near a point: things in the cubes of a grid, each in those that it meets.
struct Near<T> {
    all: Vec<T>,
    /// Side of a cube, µm: nothing farther than this matters.
    width: f64,
    cubes: HashMap<[i64; 3], Vec<u32>>,
    /// Those that meet too many cubes.
    everywhere: Vec<u32>,
}

/// What meets more cubes than this is looked at everywhere.
const MOST_CUBES: f64 = 10_000.0;

impl<T> Near<T> {
    fn new(width: f64) -> Self {
        Self { all: Vec::new(), width, cubes: HashMap::new(), everywhere: Vec::new() }
    }

    fn cube(&self, point: Vec3) -> [i64; 3] {
        [point.x, point.y, point.z].map(|x| (x / self.width).floor() as i64)
    }

    /// Adds something that lies within a box.
    fn add(&mut self, thing: T, low: Vec3, high: Vec3) {
        let number = self.all.len() as u32;
        self.all.push(thing);
        let cubes = (high - low).iter().map(|side| side / self.width + 2.0).product::<f64>();
        // What is not a number is everywhere, too.
        if cubes.is_nan() || cubes > MOST_CUBES {
            return self.everywhere.push(number);
        }
        let (from, to) = (self.cube(low), self.cube(high));
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                (from[2]..=to[2]).for_each(|z| self.cubes.entry([x, y, z]).or_default().push(number));
            }
        }
    }

    /// All that may be nearer to a point than the width of a cube; some of it several times.
    fn around(&self, point: Vec3) -> impl Iterator<Item = &T> {
        let [x, y, z] = self.cube(point);
        let offsets = (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
        let cubes =
            offsets.map(move |[i, j, k]: [i64; 3]| [x.saturating_add(i), y.saturating_add(j), z.saturating_add(k)]);
        let near = cubes.filter_map(|cube| self.cubes.get(&cube)).flatten();
        near.chain(&self.everywhere).map(|number| &self.all[*number as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;

    #[test]
    fn all_that_is_nearer_than_the_width_is_found_in_the_grid() {
        let mut stream = Stream::new(1, Purpose::Placement, 0, 0);
        let corner = Vec3::repeat(20.0);
        let (mut points, mut boxes) = (Near::new(3.0), Near::new(3.0));
        for number in 0..400 {
            let low = point_in_box(&mut stream, -corner, corner);
            // Boxes from a speck to one that is wider than the whole scene.
            let high = low + Vec3::new(1.0, 0.3, 0.1) * 0.2 * f64::from(number);
            points.add(low, low, low);
            boxes.add([low, high], low, high);
        }
        boxes.add([-1e9 * corner, 1e9 * corner], -1e9 * corner, 1e9 * corner);
        for _ in 0..50 {
            let here = point_in_box(&mut stream, -corner, corner);
            let is_near = |point: &&Vec3| (here - **point).norm() < 3.0;
            let count = points.all.iter().filter(is_near).count();
            assert_eq!(points.around(here).filter(is_near).count(), count, "a point is in one cube");
            let is_near = |[low, high]: &&[Vec3; 2]| (here - here.sup(low).inf(high)).norm() < 3.0;
            let found: Vec<_> = boxes.around(here).filter(is_near).collect();
            assert!(boxes.all.iter().filter(is_near).all(|one| found.contains(&one)));
        }
    }
}
