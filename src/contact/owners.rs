//! Whose an atom, a facet or an edge is, all numbered through the bodies of a scene.

/// Numbers to a block.
const BLOCK: usize = 64;

/// The body that each number belongs to, found by a look and a few steps.
#[derive(Debug, Clone)]
pub(super) struct Owners {
    /// The first number of each body, and how many there are.
    first: Vec<u32>,
    /// The body of the first number of each block.
    of_blocks: Vec<u32>,
}

impl Owners {
    /// For bodies that have so many of them, one body after the other.
    pub fn of(counts: impl Iterator<Item = usize>) -> Self {
        let mut first = vec![0];
        let mut end = 0;
        first.extend(counts.map(|count| {
            end += count as u32;
            end
        }));
        let bodies = |number: u32| first.partition_point(|first| *first <= number) as u32 - 1;
        let of_blocks = (0..end).step_by(BLOCK).map(bodies).collect();
        Self { first, of_blocks }
    }

    /// The body of a number.
    ///
    /// # Panics
    /// When no body has it.
    #[inline]
    pub fn body(&self, number: u32) -> u32 {
        let mut body = self.of_blocks[number as usize / BLOCK];
        while self.first[body as usize + 1] <= number {
            body += 1;
        }
        body
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_has_its_body_whatever_their_sizes() {
        let counts = [3, 0, 200, 1, 0, 0, 64, 63, 1, 500, 0];
        let owners = Owners::of(counts.into_iter());
        let expected = counts.iter().enumerate().flat_map(|(body, count)| std::iter::repeat_n(body as u32, *count));
        for (number, body) in expected.enumerate() {
            assert_eq!(owners.body(number as u32), body, "{number}");
        }
    }

    #[test]
    fn there_may_be_none_at_all() {
        assert!(Owners::of(std::iter::empty()).of_blocks.is_empty());
    }
}
