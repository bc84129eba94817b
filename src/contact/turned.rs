//! Pairs of edges that cannot touch for a while, however near they are, since facets of theirs rise towards each other's edge.

use super::edge_edge::RISE;
use super::ridge::Ridge;
use crate::Vec3;

/// Round-off of a sine, with much to spare.
const ROUND_OFF: f64 = 1e-9;

/// How far two bodies may move beside each other before two edges that are turned so that they cannot touch may do so, µm, no more than
/// `most`, eq. (contacts.12); 0 where nothing keeps them from it now.
pub(super) fn turned_for(first: &Ridge, second: &Ridge, most: f64) -> f64 {
    let normal = first.along.cross(&second.along);
    let heights =
        [first.flanks(), second.flanks().map(|flank| -flank)].map(|flanks| flanks.map(|flank| normal.dot(&flank)));
    let all = heights.as_flattened();
    if all.iter().all(|height| *height >= 0.0) || all.iter().all(|height| *height <= 0.0) {
        return 0.0;
    }
    let length = normal.norm();
    let (sine, flank) = both_sides(first, second, &(normal / length));
    let spare = sine - RISE - ROUND_OFF;
    if spare.is_nan() || spare <= 0.0 {
        return 0.0;
    }
    let longest = first.along.norm().max(second.along.norm());
    let fastest = (4.0 * longest + 2.0 * most) / length + 4.0 / flank;
    (spare / fastest).min(most)
}

/// How far flanks rise to either side of a unit normal, as a sine: the smaller of both, and the length of the shorter flank of the two, µm.
fn both_sides(first: &Ridge, second: &Ridge, normal: &Vec3) -> (f64, f64) {
    let (mut rising, mut falling) = ((0.0, 0.0), (0.0, 0.0));
    let others = second.flanks().map(|flank| -flank);
    for flank in first.flanks().iter().chain(&others) {
        let size = flank.norm();
        let sine = normal.dot(flank) / size;
        if sine > rising.0 {
            rising = (sine, size);
        }
        if -sine > falling.0 {
            falling = (-sine, size);
        }
    }
    (rising.0.min(falling.0), rising.1.min(falling.1))
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::{Dice, deform};
    use super::super::{Shape, Sides};
    use super::*;
    use crate::geometry::icosphere;

    #[test]
    fn edges_stay_turned_for_as_long_as_is_told() {
        let rest = icosphere(1.0, 1);
        let shape = Shape::new(&rest, Sides::Outer, 0.1);
        let (mut told, mut at_last) = (0, 0);
        for seed in 0..300 {
            let mut dice = Dice(seed);
            let points = [0, 1].map(|_| deform(&rest, &mut dice, 0.2, 0.15));
            for edge in 0..shape.edges.len() as u32 {
                let other = (7 * edge + seed as u32) % shape.edges.len() as u32;
                let ridges = |points: &[Vec<Vec3>; 2]| -> (f64, f64) {
                    let [first, second] = [0, 1].map(|k| Ridge::of(&shape, &points[k], [edge, other][k]));
                    let normal = first.along.cross(&second.along).normalize();
                    (turned_for(&first, &second, 0.5), both_sides(&first, &second, &normal).0)
                };
                let (wait, before) = ridges(&points);
                assert_eq!(wait > 0.0, before > RISE + ROUND_OFF, "{seed}, {edge}: {wait} for {before}");
                if wait == 0.0 {
                    continue;
                }
                // All of the motion that is allowed, or much more, shared out among both bodies and the displacement between them.
                let mut after = |motion: f64| {
                    let shares = [1.0 + dice.roll(), 1.0 + dice.roll(), 1.0 + dice.roll()];
                    let [one, two, displacement] = shares.map(|share| motion * share / shares.iter().sum::<f64>());
                    let displacement = dice.vector().normalize() * displacement;
                    let mut moved = points.clone();
                    moved[0].iter_mut().for_each(|x| *x += dice.vector().normalize() * one);
                    moved[1].iter_mut().for_each(|x| *x += dice.vector().normalize() * two + displacement);
                    ridges(&moved).1
                };
                for _ in 0..3 {
                    let sine = after(wait);
                    assert!(sine > RISE, "{seed}, {edge}: {sine} after {wait} from {before}");
                }
                told += 1;
                // Motions at random are far from the worst; that twelve times as far is enough for some shows that pairs do turn back.
                at_last += usize::from(after(12.0 * wait) <= RISE);
            }
        }
        assert!(told > 5000 && at_last > 100, "a bound of nothing: {told}, {at_last}");
    }
}
