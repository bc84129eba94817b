//! How the surface of an elastic half space moves under tractions on it: Boussinesq's solution for those along the normal, Cerruti's for those across
//! it.

use crate::Vec3;
use std::f64::consts::PI;

/// Facets whose middle is nearer than this many times their longest edge are summed exactly but for the rule of Gauss, others by the middles of their edges.
const NEAR: f64 = 3.0;

/// Points that are nearer to the line of an edge than this, over its length, are on it: the wedge between them has no area.
const ON_IT: f64 = 1e-12;

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

    /// How far the half space that it is the surface of moves at a point of the surface, µm: the sum of (traction.5) over it.
    pub fn moved(&self, half_space: &HalfSpace, at: Vec3) -> Vec3 {
        let loaded =
            self.facets.iter().filter(|facet| facet.iter().any(|corner| self.tractions[*corner] != Vec3::zeros()));
        loaded
            .map(|facet| {
                let corners = facet.map(|corner| Corner { at: self.points[corner], traction: self.tractions[corner] });
                let [a, b, c] = corners.map(|corner| corner.at);
                let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
                let is_near = ((a + b + c) / 3.0 - at).norm() < NEAR * longest;
                if is_near { from_near(half_space, at, corners) } else { from_far(half_space, at, corners) }
            })
            .sum()
    }
}

/// A corner of a facet, or another point in its plane.
#[derive(Clone, Copy)]
struct Corner {
    at: Vec3,
    traction: Vec3,
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

/// What the tractions of a facet move any point in its plane: it is the sum of three wedges from that point to its edges, of which those that are outside
/// of it count negative, with the tractions that go on along the same plane.
fn from_near(half_space: &HalfSpace, at: Vec3, corners: [Corner; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|corner| corner.at);
    let across = (b - a).cross(&(c - a));
    let of_b = (at - a).cross(&(c - a)).dot(&across) / across.norm_squared();
    let of_c = (b - a).cross(&(at - a)).dot(&across) / across.norm_squared();
    let shares = [1.0 - of_b - of_c, of_b, of_c];
    let traction = shares.iter().zip(&corners).map(|(share, corner)| *share * corner.traction).sum();
    let tip = Corner { at, traction };
    (0..3).map(|k| of_wedge(half_space, across, tip, corners[k], corners[(k + 1) % 3])).sum()
}

/// What the tractions in the triangle between a point and an edge move that point, negative where it goes around against `across`.
///
/// With y = tip + s ((1 − t) (a − tip) + t (b − tip)) the area is 2 A s ds dt, which takes away what is singular, and along s the traction is linear. What is
/// left over t has the distance to the edge below it, which may be small: with d from the line of the edge to the tip, t L = d sinh u + that of the foot,
/// dt over the distance is du/L.
fn of_wedge(half_space: &HalfSpace, across: Vec3, tip: Corner, a: Corner, b: Corner) -> Vec3 {
    let edge = b.at - a.at;
    let length = edge.norm();
    let along = edge / length;
    let foot = (tip.at - a.at).dot(&along);
    let height = tip.at - a.at - foot * along;
    let distance = height.norm();
    if distance < ON_IT * length {
        return Vec3::zeros();
    }
    let signed = distance * height.dot(&across.cross(&along)).signum();
    let [from, to] = [-foot, length - foot].map(|end| (end / distance).asinh());
    let part = |[at, weight]: [f64; 2]| {
        let beyond = distance * (from + (to - from) * at).sinh();
        let share = (foot + beyond) / length;
        let far = (1.0 - share) * a.traction + share * b.traction;
        let arm = beyond * along - height;
        weight * half_space.moved(-arm.normalize(), 0.5 * (tip.traction + far))
    };
    signed * (to - from) * gauss().map(part).sum::<Vec3>()
}

/// What the tractions of a facet move a point that is far from it: the rule with the middles of the edges, exact for squares.
fn from_far(half_space: &HalfSpace, at: Vec3, corners: [Corner; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|corner| corner.at);
    let sixth = (b - a).cross(&(c - a)).norm() / 6.0;
    let part = |k: usize| {
        let (one, other) = (corners[k], corners[(k + 1) % 3]);
        let arm = at - 0.5 * (one.at + other.at);
        half_space.moved(arm.normalize(), 0.5 * (one.traction + other.traction)) / arm.norm()
    };
    sixth * (0..3).map(part).sum::<Vec3>()
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
        let middle = disc.moved(&HALF_SPACE, Vec3::zeros());
        let expected = 2.0 * (1.0 - 0.09) * pressure * radius / 2.0;
        assert!((-middle.z / expected - 1.0).abs() < POLYGON, "{middle} for {expected}");
        assert!(middle.xy().norm() < 1e-12 * expected, "{middle}");
        let rim = disc.moved(&HALF_SPACE, disc.points[disc.points.len() - 96]);
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
        let middle = disc.moved(&HALF_SPACE, Vec3::zeros());
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
        let far = Loaded::by_forces(points, near.facets, &forces).moved(&HALF_SPACE, Vec3::new(30.0, 40.0, 0.0));
        let expected = HALF_SPACE.moved(Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.3, 0.3, -0.5)) / 50.0;
        assert!((far - expected).norm() < 0.003 * expected.norm(), "{far} for {expected}");
    }

    /// What a facet moves a point, by many small parts of it, each with its middle.
    fn by_parts(at: Vec3, corners: [Corner; 3], parts: usize) -> Vec3 {
        let [a, b, c] = corners;
        let area = 0.5 * (b.at - a.at).cross(&(c.at - a.at)).norm();
        let mut sum = Vec3::zeros();
        for (i, j) in (0..parts).flat_map(|i| (0..parts).map(move |j| (i, j))) {
            // Of each little parallelogram the half that is near the first corner, and that which is not where it is in the triangle.
            for (shift, is_in) in [(1.0 / 3.0, i + j < parts), (2.0 / 3.0, i + j + 1 < parts)] {
                if is_in {
                    let (u, v) = ((i as f64 + shift) / parts as f64, (j as f64 + shift) / parts as f64);
                    let arm = at - ((1.0 - u - v) * a.at + u * b.at + v * c.at);
                    let traction = (1.0 - u - v) * a.traction + u * b.traction + v * c.traction;
                    sum += HALF_SPACE.moved(arm.normalize(), traction) / arm.norm() * area / (parts * parts) as f64;
                }
            }
        }
        sum
    }

    fn facet() -> [Corner; 3] {
        let corner = |x, y, traction: [f64; 3]| Corner { at: Vec3::new(x, y, 0.0), traction: Vec3::from(traction) };
        [corner(0.0, 0.0, [0.1, 0.2, -0.3]), corner(1.3, 0.2, [-0.4, 0.3, 0.2]), corner(0.4, 0.9, [0.2, -0.5, 0.6])]
    }

    #[test]
    fn a_facet_moves_points_in_and_beside_it_as_many_small_parts_of_it_do() {
        let points = [(0.5, 0.4), (0.6, 0.02), (1.0, 0.7), (-0.3, -0.1), (2.0, 0.2), (0.0, 3.0)];
        for at in points.map(|(x, y)| Vec3::new(x, y, 0.0)) {
            let (found, expected) = (from_near(&HALF_SPACE, at, facet()), by_parts(at, facet(), 1_500));
            // One part in 1 500 beside the point is what the sum is uncertain by.
            assert!((found - expected).norm() < 1e-3 * expected.norm(), "{at}: {found} for {expected}");
        }
        // Where the rule for far facets begins both agree within a hundredth, of tractions that nearly cancel as these, and far away entirely.
        let at = Vec3::new(3.0, 3.5, 0.0);
        let (near, far) = (from_near(&HALF_SPACE, at, facet()), from_far(&HALF_SPACE, at, facet()));
        assert!((near - far).norm() < 2e-2 * near.norm(), "{near} and {far}");
        let at = 10.0 * at;
        let (near, far) = (from_near(&HALF_SPACE, at, facet()), from_far(&HALF_SPACE, at, facet()));
        assert!((near - far).norm() < 2e-4 * near.norm(), "{near} and {far}");
    }

    #[test]
    fn displacements_go_on_across_edges_and_corners() {
        let [a, b, c] = facet();
        let on_edge = 0.3 * a.at + 0.7 * b.at;
        let out = Vec3::new(0.2, -1.3, 0.0).normalize();
        for at in [on_edge, a.at, b.at, c.at] {
            let there = from_near(&HALF_SPACE, at, facet());
            for off in [1e-3, 1e-6, 1e-10, 1e-13_f64] {
                // It bends as off log off does.
                let most = 5.0 * off * (1.0 - off.ln()) + 1e-11;
                for side in [-1.0, 1.0] {
                    let beside = from_near(&HALF_SPACE, at + side * off * out, facet());
                    assert!((beside - there).norm() < most * there.norm(), "{off}: {beside} for {there}");
                }
            }
        }
    }

    #[test]
    fn what_one_force_moves_where_another_is_is_the_same_the_other_way_round() {
        let (towards, one, other) = (Vec3::new(0.6, -0.8, 0.0), Vec3::new(0.3, 0.5, -0.7), Vec3::new(-0.2, 0.4, 0.9));
        let there = HALF_SPACE.moved(towards, one).dot(&other);
        let back = HALF_SPACE.moved(-towards, other).dot(&one);
        assert!((there - back).abs() < 1e-15, "{there} and {back}");
    }
}
