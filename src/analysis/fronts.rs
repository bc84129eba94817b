//! Fronts of a membrane: regions of its surface where a substance is above a threshold, followed from frame to frame.

use crate::Vec3;

/// One front, from the frame in which it is first seen to the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Front {
    /// Number of the frame in which it began.
    pub begin: usize,
    /// Unit vectors from the middle of the cell to the middle of the front, one for each frame that it was there.
    pub directions: Vec<Vec3>,
    /// Whether it began out of another front: with atoms of one, or with neighbours of them.
    pub split: bool,
}

impl Front {
    /// Number of the last frame in which it was there.
    pub fn last(&self) -> usize {
        self.begin + self.directions.len() - 1
    }

    /// Where it was in a frame, or at the end of its life that is nearest to it.
    pub fn direction_at(&self, frame: usize) -> &Vec3 {
        &self.directions[frame.saturating_sub(self.begin).min(self.directions.len() - 1)]
    }
}

/// Follows the fronts of one cell. A region goes on as the front with which it shares most atoms; of several regions that share atoms
/// with one front, the one that shares most goes on as it, and the others begin.
#[derive(Debug)]
pub struct Follower {
    neighbours: Vec<Vec<u32>>,
    above: f64,
    frames: usize,
    /// Fronts in the order in which they began.
    fronts: Vec<Front>,
    /// For each atom the front that it belongs to in the frame seen last.
    of_atoms: Vec<Option<usize>>,
}

impl Follower {
    /// Follows fronts above a threshold on a surface with these facets.
    pub fn new(atoms: usize, facets: &[[u32; 3]], above: f64) -> Self {
        let mut neighbours = vec![Vec::new(); atoms];
        for facet in facets {
            for corner in 0..3 {
                neighbours[facet[corner] as usize].extend([facet[(corner + 1) % 3], facet[(corner + 2) % 3]]);
            }
        }
        for of_atom in &mut neighbours {
            of_atom.sort_unstable();
            of_atom.dedup();
        }
        Self { neighbours, above, frames: 0, fronts: Vec::new(), of_atoms: vec![None; atoms] }
    }

    /// Looks at the next frame: densities and positions (µm) of the atoms.
    pub fn see(&mut self, densities: &[f64], positions: &[[f64; 3]]) {
        let regions = self.regions(densities);
        let middle = positions.iter().map(|x| Vec3::from(*x)).sum::<Vec3>() / positions.len().max(1) as f64;
        // Where most is shared, that is decided first; the order of regions and fronts decides between equals.
        let mut shared: Vec<(usize, usize, usize)> = Vec::new();
        for (region, atoms) in regions.iter().enumerate() {
            for front in atoms.iter().filter_map(|atom| self.of_atoms[*atom as usize]) {
                match shared.iter_mut().find(|known| (known.1, known.2) == (region, front)) {
                    Some(known) => known.0 += 1,
                    None => shared.push((1, region, front)),
                }
            }
        }
        shared.sort_by_key(|(atoms, region, front)| (std::cmp::Reverse(*atoms), *region, *front));
        let mut goes_on: Vec<Option<usize>> = vec![None; regions.len()];
        for (_, region, front) in shared {
            if goes_on[region].is_none() && !goes_on.contains(&Some(front)) {
                goes_on[region] = Some(front);
            }
        }
        let mut of_atoms = vec![None; self.of_atoms.len()];
        for (atoms, front) in regions.iter().zip(goes_on) {
            let weighted = |atom: &u32| {
                let weight = densities[*atom as usize] - self.above;
                weight * (Vec3::from(positions[*atom as usize]) - middle)
            };
            // A region around the middle on all sides points nowhere; it keeps where it pointed, or begins along x.
            let sum = atoms.iter().map(weighted).sum::<Vec3>();
            let number = front.unwrap_or_else(|| {
                let split = atoms.iter().any(|atom| self.is_beside_a_front(*atom));
                self.fronts.push(Front { begin: self.frames, directions: Vec::new(), split });
                self.fronts.len() - 1
            });
            let kept = self.fronts[number].directions.last().copied().unwrap_or_else(Vec3::x);
            self.fronts[number].directions.push(sum.try_normalize(0.0).unwrap_or(kept));
            atoms.iter().for_each(|atom| of_atoms[*atom as usize] = Some(number));
        }
        self.of_atoms = of_atoms;
        self.frames += 1;
    }

    fn is_beside_a_front(&self, atom: u32) -> bool {
        let was_front = |atom: u32| self.of_atoms[atom as usize].is_some();
        was_front(atom) || self.neighbours[atom as usize].iter().any(|beside| was_front(*beside))
    }

    /// The connected regions of atoms above the threshold.
    fn regions(&self, densities: &[f64]) -> Vec<Vec<u32>> {
        let mut open: Vec<bool> = densities.iter().map(|density| *density > self.above).collect();
        let mut regions = Vec::new();
        for first in 0..open.len() {
            if !std::mem::take(&mut open[first]) {
                continue;
            }
            let (mut region, mut next) = (vec![first as u32], 0);
            while next < region.len() {
                for &beside in &self.neighbours[region[next] as usize] {
                    if std::mem::take(&mut open[beside as usize]) {
                        region.push(beside);
                    }
                }
                next += 1;
            }
            regions.push(region);
        }
        regions
    }

    /// The fronts that there were, and how many frames were seen.
    pub fn finish(self) -> (Vec<Front>, usize) {
        (self.fronts, self.frames)
    }
}

/// The angle by which one direction is turned from another around an axis, radians from −π to π; none where one of them is along the axis.
pub fn turn(from: &Vec3, to: &Vec3, axis: &Vec3) -> Option<f64> {
    let across = |direction: &Vec3| direction - direction.dot(axis) * axis;
    let [from, to] = [from, to].map(across);
    let (cosine, sine) = (from.dot(&to), from.cross(&to).dot(axis));
    (cosine != 0.0 || sine != 0.0).then(|| sine.atan2(cosine))
}

/// The probability that at least `number` of `of` independent trials with even chances succeed, eq. (analysis.35).
pub fn chance_of_at_least(number: usize, of: usize) -> f64 {
    let mut term = 0.5_f64.powi(of as i32);
    let mut sum = 0.0;
    for successes in 0..=of {
        if successes >= number {
            sum += term;
        }
        term *= (of - successes) as f64 / (successes + 1) as f64;
    }
    sum.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::icosphere;

    /// Densities of spots of 30° around directions.
    fn spots(positions: &[Vec3], directions: &[Vec3]) -> Vec<f64> {
        let near =
            |x: &Vec3| directions.iter().any(|direction| x.normalize().dot(direction) > 30_f64.to_radians().cos());
        positions.iter().map(|x| if near(x) { 1.0 } else { 0.0 }).collect()
    }

    fn follow(frames: &[Vec<Vec3>]) -> Vec<Front> {
        let ball = icosphere(5.0, 3);
        // The cell moves along; fronts are seen from its middle.
        let at = |frame: usize| -> Vec<[f64; 3]> {
            ball.positions.iter().map(|x| (x + Vec3::new(frame as f64, 2.0, 0.0)).into()).collect()
        };
        let mut follower = Follower::new(ball.positions.len(), &ball.facets, 0.5);
        for (number, directions) in frames.iter().enumerate() {
            follower.see(&spots(&ball.positions, directions), &at(number));
        }
        follower.finish().0
    }

    fn around(degrees: f64) -> Vec3 {
        Vec3::new(degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0)
    }

    #[test]
    fn a_front_that_wanders_stays_one_and_ends_when_it_is_gone() {
        let found = follow(&[vec![], vec![around(0.0)], vec![around(20.0)], vec![around(40.0)], vec![]]);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].begin, found[0].last(), found[0].split), (1, 3, false));
        for (direction, degrees) in found[0].directions.iter().zip([0.0, 20.0, 40.0]) {
            // Atoms are 9° apart, and a spot holds some 45 of them.
            let away = direction.dot(&around(degrees)).min(1.0).acos().to_degrees();
            assert!(away < 2.0, "{away}");
        }
    }

    #[test]
    fn what_begins_out_of_a_front_is_split_off_and_what_begins_elsewhere_is_new() {
        let frames = [vec![around(0.0)], vec![around(-35.0), around(35.0)], vec![around(35.0), around(180.0)]];
        let found = follow(&frames);
        assert_eq!(found.len(), 3);
        let told: Vec<_> = found.iter().map(|front| (front.begin, front.last(), front.split)).collect();
        let of_two = if told[0].1 == 2 { [(0, 2, false), (1, 1, true)] } else { [(0, 1, false), (1, 2, true)] };
        assert_eq!(told, [of_two[0], of_two[1], (2, 2, false)]);
    }

    #[test]
    fn turns_are_counted_around_the_axis_and_chances_are_those_of_coins() {
        let up = Vec3::z();
        for degrees in [-170.0_f64, -60.0, 0.0, 90.0, 179.0] {
            let raised = around(degrees + 10.0) + 0.7 * up;
            let found = turn(&around(10.0), &raised, &up).unwrap();
            assert!((found.to_degrees() - degrees).abs() < 1e-9, "{found}");
        }
        assert_eq!(turn(&up, &around(0.0), &up), None);
        assert_eq!(chance_of_at_least(0, 5), 1.0);
        assert_eq!(chance_of_at_least(5, 5), 1.0 / 32.0);
        assert_eq!(chance_of_at_least(3, 4), 5.0 / 16.0);
    }
}
