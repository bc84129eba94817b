//! In which order the unknowns of an implicit step are eliminated, and where that leaves something: worked out once for all steps and cells.

/// The fewest unknowns for which it is worth leaving out what is nothing.
const FEWEST: usize = 24;

/// An operation among entries that are picked costs so many of those in whole rows.
const DEARER: usize = 4;

/// Where the entries of factored matrices 1/(γh) − J stand: those of L and U that may be other than nothing, row after row in the order of elimination.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elimination {
    /// The variable that is eliminated first, second, …
    pub order: Vec<u32>,
    /// Where each row of entries begins, and after the last where it ends.
    pub starts: Vec<u32>,
    /// The column of each entry, in the order of elimination; ascending within a row.
    pub columns: Vec<u32>,
    /// The entry on the diagonal of each row.
    pub diagonals: Vec<u32>,
    /// The entry of each one of the Jacobian's pattern.
    pub from_pattern: Vec<u32>,
}

impl Elimination {
    /// That of a Jacobian of `size` unknowns with entries at these rows and columns; none where whole matrices cost no more.
    pub fn of(size: usize, pattern: &[(u32, u32)]) -> Option<Self> {
        if size < FEWEST || size > u32::MAX as usize {
            return None;
        }
        // Whole matrices take a third of n³ products for the factors of one step.
        let most = (size as u128).pow(3) / 3 / DEARER as u128;
        let order = order_of_least_degree(size, pattern, most)?;
        let mut position = vec![0; size];
        order.iter().enumerate().for_each(|(at, &variable)| position[variable as usize] = at as u32);
        let mut rows: Vec<Vec<u32>> = (0..size as u32).map(|row| vec![row]).collect();
        for &(row, column) in pattern {
            rows[position[row as usize] as usize].push(position[column as usize]);
        }
        let mut operations = 0_u128;
        let mut diagonals = Vec::with_capacity(size);
        let mut is_in = vec![false; size];
        for at in 0..size {
            operations += fill_in(at, &mut rows, &diagonals, &mut is_in);
            if operations > most {
                return None;
            }
            diagonals.push(rows[at].binary_search(&(at as u32)).expect("the diagonal is there") as u32);
        }
        let mut starts = vec![0_u32];
        for row in &rows {
            starts.push(u32::try_from(starts[starts.len() - 1] as usize + row.len()).ok()?);
        }
        let at = |&(row, column): &(u32, u32)| {
            let row = position[row as usize] as usize;
            let among =
                rows[row].binary_search(&position[column as usize]).expect("the pattern is part of its factors");
            starts[row] + among as u32
        };
        let from_pattern = pattern.iter().map(at).collect();
        diagonals.iter_mut().zip(&starts).for_each(|(diagonal, start)| *diagonal += start);
        Some(Self { order, columns: rows.concat(), starts, diagonals, from_pattern })
    }
}

/// Adds to a row what the rows before leave in it, those whose diagonals are known; returns how many products that takes.
fn fill_in(at: usize, rows: &mut [Vec<u32>], diagonals: &[u32], is_in: &mut [bool]) -> u128 {
    let (before, rest) = rows.split_at_mut(at);
    let row = &mut rest[0];
    row.sort_unstable();
    row.dedup();
    row.iter().for_each(|&column| is_in[column as usize] = true);
    let mut operations = 0;
    // Those to be eliminated yet, in the order of elimination: what is added lies behind what adds it.
    let mut waiting: std::collections::BTreeSet<u32> =
        row.iter().copied().filter(|column| (*column as usize) < at).collect();
    while let Some(next) = waiting.pop_first() {
        let added = &before[next as usize][diagonals[next as usize] as usize + 1..];
        operations += 1 + added.len() as u128;
        for &column in added {
            if !std::mem::replace(&mut is_in[column as usize], true) {
                row.push(column);
                if (column as usize) < at {
                    waiting.insert(column);
                }
            }
        }
    }
    row.sort_unstable();
    row.iter().for_each(|&column| is_in[column as usize] = false);
    operations
}

/// The variables such that each is, when its turn comes, one of those with the fewest neighbours (Tinney and Walker 1967), and of these the
/// first; entries count for both directions. None where that takes more operations than `most`.
fn order_of_least_degree(size: usize, pattern: &[(u32, u32)], most: u128) -> Option<Vec<u32>> {
    let mut neighbours = vec![std::collections::BTreeSet::new(); size];
    for &(row, column) in pattern.iter().filter(|(row, column)| row != column) {
        neighbours[row as usize].insert(column);
        neighbours[column as usize].insert(row);
    }
    let mut waiting: std::collections::BTreeSet<(usize, u32)> =
        neighbours.iter().enumerate().map(|(variable, near)| (near.len(), variable as u32)).collect();
    let (mut order, mut operations) = (Vec::with_capacity(size), 0_u128);
    while let Some((degree, variable)) = waiting.pop_first() {
        operations += (degree as u128).pow(2);
        if operations > most {
            return None;
        }
        order.push(variable);
        let near = std::mem::take(&mut neighbours[variable as usize]);
        for &one in &near {
            let its = &mut neighbours[one as usize];
            waiting.remove(&(its.len(), one));
            its.remove(&variable);
            its.extend(near.iter().copied().filter(|other| *other != one));
            waiting.insert((its.len(), one));
        }
    }
    Some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(size: u32) -> Vec<(u32, u32)> {
        (0..size)
            .flat_map(|row| [row.saturating_sub(1), row, (row + 1).min(size - 1)].map(|column| (row, column)))
            .collect()
    }

    #[test]
    fn a_chain_has_no_entries_but_its_own() {
        let known = Elimination::of(100, &chain(100)).expect("a sparse one");
        assert_eq!(known.columns.len(), 298);
        let mut order = known.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..100));
    }

    #[test]
    fn a_hub_is_eliminated_last() {
        // All read the first, and the first reads all: eliminated first it would join all to all.
        let pattern: Vec<(u32, u32)> = (1..200).flat_map(|other| [(0, other), (other, 0), (other, other)]).collect();
        let known = Elimination::of(200, &pattern).expect("a sparse one");
        assert_eq!(known.columns.len(), 3 * 199 + 1);
    }

    #[test]
    fn whole_matrices_are_left_to_themselves() {
        let all: Vec<(u32, u32)> = (0..50).flat_map(|row| (0..50).map(move |column| (row, column))).collect();
        assert_eq!(Elimination::of(50, &all), None);
        assert_eq!(Elimination::of(8, &chain(8)), None);
    }
}
