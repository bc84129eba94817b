//! Which facets of a mesh meet at which sides.

/// No side.
pub(super) const NONE: u32 = u32::MAX;

/// The sides of a mesh's facets; side 3 f + k of facet f goes from its corner k to the next.
#[derive(Debug, PartialEq)]
pub(super) struct Topology {
    /// The side of another facet that is the same line, or [`NONE`] at a rim and where more than two facets meet.
    pub across: Vec<u32>,
    /// Whether there is neither.
    pub is_closed: bool,
}

impl Topology {
    /// Of facets with `atoms` atoms; a facet with others has no neighbours.
    pub fn new(facets: &[[u32; 3]], atoms: usize) -> Self {
        let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * facets.len());
        for (number, facet) in facets.iter().enumerate().filter(|(_, f)| f.iter().all(|a| (*a as usize) < atoms)) {
            for k in 0..3 {
                let (from, to) = (facet[k], facet[(k + 1) % 3]);
                sides.push(([from.min(to), from.max(to)], (3 * number + k) as u32));
            }
        }
        sides.sort_unstable();
        let mut across = vec![NONE; 3 * facets.len()];
        for same in sides.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, one), (_, other)] = *same
                && start(facets, one) != start(facets, other)
            {
                (across[one as usize], across[other as usize]) = (other, one);
            }
        }
        let is_closed = !across.contains(&NONE);
        Self { across, is_closed }
    }
}

/// The atom where a side begins.
pub(super) fn start(facets: &[[u32; 3]], side: u32) -> u32 {
    facets[side as usize / 3][side as usize % 3]
}

/// The atoms where a side begins and ends.
pub(super) fn ends(facets: &[[u32; 3]], side: usize) -> [u32; 2] {
    [facets[side / 3][side % 3], facets[side / 3][(side + 1) % 3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_known_from_both_facets_and_rims_are_told() {
        let two = Topology::new(&[[0, 1, 2], [2, 1, 3]], 4);
        assert_eq!(two.across, [NONE, 3, NONE, 1, NONE, NONE]);
        assert!(!two.is_closed);
        assert!(Topology::new(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], 4).is_closed);
    }

    #[test]
    fn facets_that_turn_against_each_other_or_meet_in_threes_have_rims_there() {
        assert!(Topology::new(&[[0, 1, 2], [1, 2, 3]], 4).across.iter().all(|side| *side == NONE));
        assert!(Topology::new(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5).across.iter().all(|side| *side == NONE));
        assert!(Topology::new(&[[0, 1, 2], [2, 1, 9]], 4).across.iter().all(|side| *side == NONE));
    }
}
