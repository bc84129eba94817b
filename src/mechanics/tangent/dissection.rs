//! Nested dissection: the order in which the atoms of a large mesh are eliminated, by cutting it in halves (George, SIAM J. Numer. Anal. 10,
//! 345, 1973).

use crate::Vec3;

/// Groups up to this size are eliminated as one.
const LEAF: usize = 24;

/// Where along an axis a part of a mesh may be cut, as shares of its atoms.
const CUTS: [f64; 5] = [0.5, 0.45, 0.55, 0.4, 0.6];

/// Atoms that are eliminated together. They touch atoms of their own group, of the groups whose ancestor theirs is, and of ancestors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// The atoms; none where what a cut leaves is apart already.
    pub atoms: Vec<u32>,
    /// The group that separates it from others, by its place in the order; none for the last of a mesh.
    pub parent: Option<usize>,
}

/// Groups of all atoms, each after those that it separates; `near` are the neighbours of each atom, `x` its position (µm).
pub fn dissect(near: &[Vec<u32>], x: &[Vec3]) -> Vec<Group> {
    let mut cutter = Cutter { near, x, side: vec![Side::Out; x.len()], groups: Vec::new() };
    cutter.divide((0..x.len() as u32).collect());
    cutter.groups
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Out,
    Lower,
    Upper,
}

struct Cutter<'a> {
    near: &'a [Vec<u32>],
    x: &'a [Vec3],
    /// On which side of the cut that is tried each atom is.
    side: Vec<Side>,
    groups: Vec<Group>,
}

/// A cut: what it leaves on both sides, and what separates them.
struct Cut {
    parts: [Vec<u32>; 2],
    between: Vec<u32>,
}

impl Cut {
    /// How bad it is: atoms between the parts for each that the smaller part has.
    fn cost(&self) -> f64 {
        self.between.len() as f64 / self.parts.iter().map(Vec::len).min().unwrap_or(0) as f64
    }
}

impl Cutter<'_> {
    /// Adds the groups of a part of the mesh; returns the number of the last.
    fn divide(&mut self, atoms: Vec<u32>) -> usize {
        let cut = if atoms.len() > LEAF { self.best_cut(&atoms) } else { None };
        let Some(Cut { parts, between }) = cut else { return self.add(atoms, &[]) };
        let children = parts.map(|part| self.divide(part));
        self.add(between, &children)
    }

    fn add(&mut self, atoms: Vec<u32>, children: &[usize]) -> usize {
        let number = self.groups.len();
        children.iter().for_each(|&child| self.groups[child].parent = Some(number));
        self.groups.push(Group { atoms, parent: None });
        number
    }

    /// The best of cuts across the three axes; none where all leave nothing on a side.
    fn best_cut(&mut self, atoms: &[u32]) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        for axis in 0..3 {
            let mut sorted = atoms.to_vec();
            sorted.sort_by(|&a, &b| self.x[a as usize][axis].total_cmp(&self.x[b as usize][axis]).then(a.cmp(&b)));
            for share in CUTS {
                for cut in self.cuts(&sorted, (share * sorted.len() as f64) as usize) {
                    let is_sound = cut.parts.iter().all(|part| !part.is_empty());
                    if is_sound && best.as_ref().is_none_or(|best| cut.cost() < best.cost()) {
                        best = Some(cut);
                    }
                }
            }
        }
        best
    }

    /// The cuts between sorted atoms at a place: atoms of the upper side that touch the lower are between them, or the other way about.
    fn cuts(&mut self, sorted: &[u32], at: usize) -> [Cut; 2] {
        let (lower, upper) = sorted.split_at(at);
        lower.iter().for_each(|&atom| self.side[atom as usize] = Side::Lower);
        upper.iter().for_each(|&atom| self.side[atom as usize] = Side::Upper);
        let touching = |part: &[u32], side: Side| -> (Vec<u32>, Vec<u32>) {
            part.iter().partition(|&&atom| self.near[atom as usize].iter().any(|&one| self.side[one as usize] == side))
        };
        let (above, upper_rest) = touching(upper, Side::Lower);
        let (below, lower_rest) = touching(lower, Side::Upper);
        sorted.iter().for_each(|&atom| self.side[atom as usize] = Side::Out);
        [
            Cut { parts: [lower.to_vec(), upper_rest], between: above },
            Cut { parts: [lower_rest, upper.to_vec()], between: below },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_touch_only_their_own_kin() {
        let (n, mut x, mut near) = (7usize, Vec::new(), Vec::new());
        let number = |i: usize, j: usize| (i * n + j) as u32;
        for i in 0..n {
            for j in 0..n {
                x.push(Vec3::new(i as f64, j as f64, 0.0));
                let around = |i: usize| i.saturating_sub(1)..(i + 2).min(n);
                near.push(
                    around(i)
                        .flat_map(|a| around(j).map(move |b| number(a, b)))
                        .filter(|&k| k != number(i, j))
                        .collect(),
                );
            }
        }
        let near: Vec<Vec<u32>> = near;
        let groups = dissect(&near, &x);
        let mut of = vec![usize::MAX; x.len()];
        for (group, number) in groups.iter().zip(0..) {
            assert!(group.parent.is_none_or(|parent| parent > number));
            group.atoms.iter().for_each(|&atom| of[atom as usize] = number);
        }
        assert!(of.iter().all(|&group| group != usize::MAX), "every atom has a group");
        assert!(groups.iter().all(|group| group.atoms.len() <= LEAF), "a square is cut in lines");
        let ancestors = |group: usize| std::iter::successors(Some(group), |&g| groups[g].parent).collect::<Vec<_>>();
        for (atom, near) in near.iter().enumerate() {
            for &one in near {
                let (a, b) = (of[atom], of[one as usize]);
                assert!(ancestors(a).contains(&b) || ancestors(b).contains(&a), "atoms {atom} and {one}");
            }
        }
    }
}
