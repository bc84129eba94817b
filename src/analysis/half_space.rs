//! How the surface of an elastic half space moves under tractions on it: Boussinesq's solution for those along the normal, Cerruti's for those across
//! it.

use crate::Vec3;
use std::f64::consts::PI;

/// Facets whose middle is nearer than this many times their longest edge are cut into four, again and again, before their tractions are summed.
const NEAR: f64 = 3.0;

/// How often at most.
const CUTS: usize = 4;

/// Points and weights of the rule of Gauss with eight points on 0 to 1: one half of them, the others mirror it.
const GAUSS: [[f64; 2]; 4] = [
    [0.019_855_071_751_231_88, 0.050_614_268_145_188_13],
    [0.101_666_761_293_186_63, 0.111_190_517_226_687_24],
    [0.237_233_795_041_835_5, 0.156_853_322_938_943_64],
    [0.408_282_678_752_175_1, 0.181_341_891_689_181],
];

/// A half space of an isotropic material.
#[derive(Debug, Clone, Copy)]
pub struct HalfSpace {
    /// Young's modulus, pN/µm².
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Unit vector out of it.
    pub normal: Vec3,
}

impl HalfSpace {
    /// What a force (pN) at a point of the surface moves another point of it times their distance, eq. (traction.5): it depends on the direction to that
    /// point alone, µm².
    fn moved(&self, towards: Vec3, force: Vec3) -> Vec3 {
        let Self { young, poisson, normal } = *self;
        let inward = -normal.dot(&force);
        let across = force + inward * normal;
        let along = across.dot(&towards);
        let shear = 1.0 - 2.0 * poisson;
        let in_plane = 2.0 * (1.0 - poisson) * across + (2.0 * poisson * along - shear * inward) * towards;
        let down = 2.0 * (1.0 - poisson) * inward + shear * along;
        (1.0 + poisson) / (2.0 * PI * young) * (in_plane - down * normal)
    }
}

/// A part of the plane surface, with tractions at its points that go on a straight line between them.
pub struct Loaded {
    /// Where the points are, µm.
    pub points: Vec<Vec3>,
    /// Its facets, each three points.
    pub facets: Vec<[usize; 3]>,
    /// The tractions at the points, pN/µm².
    pub tractions: Vec<Vec3>,
}

impl Loaded {
    /// That with these forces (pN) on its points, each shared by a third of the area of the facets around it.
    pub fn by_forces(points: Vec<Vec3>, facets: Vec<[usize; 3]>, forces: &[Vec3]) -> Self {
        let areas = areas(&points, &facets);
        let traction = |(force, area): (&Vec3, &f64)| if *area > 0.0 { force / *area } else { Vec3::zeros() };
        let tractions = forces.iter().zip(&areas).map(traction).collect();
        Self { points, facets, tractions }
    }

    /// How far the half space that it is the surface of moves at one of the points, µm: the sum of (traction.5) over the surface.
    pub fn moved(&self, half_space: &HalfSpace, point: usize) -> Vec3 {
        let at = self.points[point];
        let loaded =
            self.facets.iter().filter(|facet| facet.iter().any(|corner| self.tractions[*corner] != Vec3::zeros()));
        loaded
            .map(|facet| {
                let corners = facet.map(|corner| (self.points[corner], self.tractions[corner]));
                match facet.iter().position(|corner| *corner == point) {
                    Some(first) => from_corner(half_space, [0, 1, 2].map(|k| corners[(first + k) % 3])),
                    None => from_beside(half_space, at, corners, CUTS),
                }
            })
            .sum()
    }
}

/// A third of the area of all facets around each point, µm².
pub fn areas(points: &[Vec3], facets: &[[usize; 3]]) -> Vec<f64> {
    let mut areas = vec![0.0; points.len()];
    for facet in facets {
        let [a, b, c] = facet.map(|corner| points[corner]);
        let third = (b - a).cross(&(c - a)).norm() / 6.0;
        facet.iter().for_each(|corner| areas[*corner] += third);
    }
    areas
}

fn gauss() -> impl Iterator<Item = [f64; 2]> {
    GAUSS.into_iter().flat_map(|[at, weight]| [[at, weight], [1.0 - at, weight]])
}

/// What the tractions of a facet move its first corner. With y = a + s ((1 − t) (b − a) + t (c − a)) the area is 2 A s ds dt, which takes away what is
/// singular; along s the traction is linear.
fn from_corner(half_space: &HalfSpace, [(a, first), (b, second), (c, third)]: [(Vec3, Vec3); 3]) -> Vec3 {
    let twice_area = (b - a).cross(&(c - a)).norm();
    let along = |[t, weight]: [f64; 2]| {
        let arm = (1.0 - t) * (b - a) + t * (c - a);
        let far = (1.0 - t) * second + t * third;
        weight / arm.norm() * half_space.moved(-arm.normalize(), 0.5 * (first + far))
    };
    twice_area * gauss().map(along).sum::<Vec3>()
}

/// What the tractions of a facet move a point that is none of its corners.
fn from_beside(half_space: &HalfSpace, at: Vec3, corners: [(Vec3, Vec3); 3], cuts: usize) -> Vec3 {
    let [(a, first), (b, second), (c, third)] = corners;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    if cuts > 0 && ((a + b + c) / 3.0 - at).norm() < NEAR * longest {
        let [ab, bc, ca] = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
            let middle = |k: fn(&(Vec3, Vec3)) -> Vec3| 0.5 * (k(&corners[i]) + k(&corners[j]));
            (middle(|corner| corner.0), middle(|corner| corner.1))
        });
        let parts = [[corners[0], ab, ca], [ab, corners[1], bc], [ca, bc, corners[2]], [ab, bc, ca]];
        return parts.into_iter().map(|part| from_beside(half_space, at, part, cuts - 1)).sum();
    }
    // The rule with the middles of the edges, exact for squares.
    let sixth = (b - a).cross(&(c - a)).norm() / 6.0;
    let middles = [(a, b, first, second), (b, c, second, third), (c, a, third, first)];
    let part = |(one, other, left, right): (Vec3, Vec3, Vec3, Vec3)| {
        let arm = at - 0.5 * (one + other);
        half_space.moved(arm.normalize(), 0.5 * (left + right)) / arm.norm()
    };
    sixth * middles.into_iter().map(part).sum::<Vec3>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_SPACE: HalfSpace = HalfSpace { young: 2.0, poisson: 0.3, normal: Vec3::new(0.0, 0.0, 1.0) };

    /// A disc of rings and sectors with one traction everywhere; its middle comes first, the last point is on its rim.
    fn disc(radius: f64, traction: Vec3) -> Loaded {
        let (rings, sectors) = (12, 96);
        let mut points = vec![Vec3::zeros()];
        for ring in 1..=rings {
            for sector in 0..sectors {
                let (r, angle) = (radius * ring as f64 / rings as f64, 2.0 * PI * sector as f64 / sectors as f64);
                points.push(Vec3::new(r * angle.cos(), r * angle.sin(), 0.0));
            }
        }
        let at = |ring: usize, sector: usize| if ring == 0 { 0 } else { 1 + (ring - 1) * sectors + sector % sectors };
        let mut facets = Vec::new();
        for (ring, sector) in (0..rings).flat_map(|ring| (0..sectors).map(move |sector| (ring, sector))) {
            let [a, b, c, d] = [at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1)];
            facets.push([a, b, c]);
            if ring > 0 {
                facets.push([a, c, d]);
            }
        }
        let tractions = vec![traction; points.len()];
        Loaded { points, facets, tractions }
    }

    /// The polygon lacks 0.07 % of the area of the disc, all of it beside the points of the rim.
    const POLYGON: f64 = 0.0015;

    #[test]
    fn a_pressure_on_a_disc_moves_its_middle_and_rim_as_known() {
        // Johnson, Contact Mechanics, (3.29): 2 (1 − ν²) p a / E in the middle, 2/π of it at the rim.
        let (radius, pressure) = (1.5, 0.01);
        let disc = disc(radius, Vec3::new(0.0, 0.0, -pressure));
        let middle = disc.moved(&HALF_SPACE, 0);
        let expected = 2.0 * (1.0 - 0.09) * pressure * radius / 2.0;
        assert!((-middle.z / expected - 1.0).abs() < POLYGON, "{middle} for {expected}");
        assert!(middle.xy().norm() < 1e-12 * expected, "{middle}");
        let rim = disc.moved(&HALF_SPACE, disc.points.len() - 96);
        assert!((-rim.z / (expected * 2.0 / PI) - 1.0).abs() < POLYGON, "{rim}");
        // Under a pressure the rim goes inwards by (1 − 2ν)(1 + ν) p a / 2E.
        let inwards = 0.4 * 1.3 * pressure * radius / (2.0 * 2.0);
        assert!((-rim.x / inwards - 1.0).abs() < 0.01, "{rim} for {inwards}");
    }

    #[test]
    fn a_traction_across_a_disc_moves_its_middle_as_known() {
        // The mean over directions of (1 − ν) + ν cos² is 1 − ν/2, and that of 1/r over a disc 2/a.
        let (radius, traction) = (1.5, 0.01);
        let disc = disc(radius, Vec3::new(traction, 0.0, 0.0));
        let middle = disc.moved(&HALF_SPACE, 0);
        let expected = 1.3 * (2.0 - 0.3) * traction * radius / 2.0;
        assert!((middle.x / expected - 1.0).abs() < POLYGON, "{middle} for {expected}");
        assert!(middle.yz().norm() < 1e-12 * expected, "{middle}");
    }

    #[test]
    fn far_from_forces_it_is_that_of_their_sum() {
        let near = disc(0.1, Vec3::zeros());
        let mut points = near.points.clone();
        points.push(Vec3::new(30.0, 40.0, 0.0));
        let mut forces = vec![Vec3::zeros(); points.len()];
        (forces[0], forces[5]) = (Vec3::new(0.2, 0.0, -0.5), Vec3::new(0.1, 0.3, 0.0));
        let last = points.len() - 1;
        let far = Loaded::by_forces(points, near.facets, &forces).moved(&HALF_SPACE, last);
        let expected = HALF_SPACE.moved(Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.3, 0.3, -0.5)) / 50.0;
        assert!((far - expected).norm() < 0.003 * expected.norm(), "{far} for {expected}");
    }

    #[test]
    fn what_one_force_moves_where_another_is_is_the_same_the_other_way_round() {
        let (towards, one, other) = (Vec3::new(0.6, -0.8, 0.0), Vec3::new(0.3, 0.5, -0.7), Vec3::new(-0.2, 0.4, 0.9));
        let there = HALF_SPACE.moved(towards, one).dot(&other);
        let back = HALF_SPACE.moved(-towards, other).dot(&one);
        assert!((there - back).abs() < 1e-15, "{there} and {back}");
    }
}
