//! In which order contacts are swept: those side by side move different cells.
//!
//! What a contact does waits for what the one before it on the same cell did. So the pairs of cells that touch are coloured, no cell twice
//! in a colour, and the contacts of a few pairs of a colour take turns: the processor works at several at once. The order depends on
//! who touches whom alone. Sweeps read all rows many times, so that rows are put in this order for them and back again.

/// Pairs that take turns.
const SIDE_BY_SIDE: usize = 8;

/// Colours; a pair for which none is left has the last, whoever else has it.
const COLOURS: u32 = 64;

/// The order of the sweeps, and what is needed to find it.
#[derive(Debug, Clone, Default)]
pub struct Turns {
    /// The number of the row that has each turn.
    order: Vec<u32>,
    /// Pairs of cells with the numbers of their rows.
    rows: Vec<(u64, u32)>,
    /// Pairs: colour, first row in `rows` and one behind the last.
    pairs: Vec<(u32, u32, u32)>,
    /// Of each cell the colours that it has.
    taken: Vec<u64>,
    /// What has been put where it belongs.
    done: Vec<bool>,
}

impl Turns {
    /// Finds the order for rows between bodies.
    pub fn find(&mut self, between: impl Iterator<Item = [u32; 2]>, bodies: usize) {
        let key = |[a, b]: [u32; 2]| u64::from(a.min(b)) << 32 | u64::from(a.max(b));
        self.rows.clear();
        self.rows.extend(between.zip(0..).map(|(bodies, row)| (key(bodies), row)));
        self.rows.sort_unstable();
        self.taken.clear();
        self.taken.resize(bodies, 0);
        self.pairs.clear();
        let mut first = 0;
        for pair in self.rows.chunk_by(|one, other| one.0 == other.0) {
            let [a, b] = [pair[0].0 >> 32, pair[0].0 & 0xffff_ffff].map(|body| body as usize);
            let colour = (self.taken[a] | self.taken[b]).trailing_ones().min(COLOURS - 1);
            self.taken[a] |= 1 << colour;
            self.taken[b] |= 1 << colour;
            let end = first + pair.len() as u32;
            self.pairs.push((colour, first, end));
            first = end;
        }
        // Pairs with as many rows stay side by side longest.
        self.pairs.sort_unstable_by_key(|&(colour, first, end)| (colour, end - first, first));
        self.order.clear();
        for colour in self.pairs.chunk_by(|one, other| one.0 == other.0) {
            for group in colour.chunks(SIDE_BY_SIDE) {
                let longest = group.iter().map(|&(_, first, end)| end - first).max().unwrap_or(0);
                for turn in 0..longest {
                    let there = group.iter().filter(|&&(_, first, end)| first + turn < end);
                    self.order.extend(there.map(|&(_, first, _)| self.rows[(first + turn) as usize].1));
                }
            }
        }
    }

    /// Puts what is listed row by row in the order of the sweeps.
    pub fn arrange<T: Copy>(&mut self, list: &mut [T]) {
        self.done.clear();
        self.done.resize(list.len(), false);
        for start in 0..list.len() {
            if self.done[start] {
                continue;
            }
            let (first, mut to) = (list[start], start);
            loop {
                self.done[to] = true;
                let from = self.order[to] as usize;
                if from == start {
                    list[to] = first;
                    break;
                }
                list[to] = list[from];
                to = from;
            }
        }
    }

    /// Puts what is in the order of the sweeps back row by row.
    pub fn put_back<T: Copy>(&mut self, list: &mut [T]) {
        self.done.clear();
        self.done.resize(list.len(), false);
        for start in 0..list.len() {
            if self.done[start] {
                continue;
            }
            let (mut carried, mut from) = (list[start], start);
            loop {
                let to = self.order[from] as usize;
                self.done[from] = true;
                std::mem::swap(&mut list[to], &mut carried);
                if to == start {
                    break;
                }
                from = to;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of twelve cells with five contacts each, told from both sides.
    fn ring() -> Vec<[u32; 2]> {
        (0..60).map(|i| if i % 2 == 0 { [i % 12, (i + 1) % 12] } else { [(i + 1) % 12, i % 12] }).collect()
    }

    #[test]
    fn each_row_has_one_turn_and_neighbours_in_the_order_move_different_cells() {
        let (ring, mut turns) = (ring(), Turns::default());
        turns.find(ring.iter().copied(), 12);
        let mut sorted = turns.order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..60).collect::<Vec<u32>>());
        let shared = turns.order.windows(2).filter(|two| {
            let [one, other] = [two[0], two[1]].map(|row| ring[row as usize]);
            one.iter().any(|body| other.contains(body))
        });
        assert!(shared.count() <= 3, "only where a colour begins");
    }

    #[test]
    fn what_is_put_in_order_comes_back() {
        let mut turns = Turns::default();
        turns.find(ring().into_iter(), 12);
        let mut list: Vec<u32> = (0..60).collect();
        turns.arrange(&mut list);
        assert_eq!(list, turns.order);
        turns.put_back(&mut list);
        assert_eq!(list, (0..60).collect::<Vec<u32>>());
    }
}
