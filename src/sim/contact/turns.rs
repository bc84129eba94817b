//! In which order contacts are swept: those side by side move different cells.
//!
//! What a contact does waits for what the one before it on the same cell did. So the pairs of cells that touch are coloured, no cell twice
//! in a colour, and the contacts of a few pairs of a colour take turns: the processor works at several at once. The order depends on
//! who touches whom alone. Sweeps read all rows many times, so that rows are put in this order for them and back again.

use rayon::prelude::*;

use super::together::Together;

/// Pairs that take turns.
const SIDE_BY_SIDE: usize = 8;

/// Colours; a pair for which none is left has the last, whoever else has it.
const COLOURS: u32 = 64;

/// Rows from which on several threads share a sweep; fewer are swept sooner by one.
const SHARED_FROM: usize = 4096;

/// Rows that a thread takes at once, at least.
const ROWS_PER_JOB: u32 = 256;

/// Rows whose bodies a thread looks up, bodies whose rows it sorts, and groups of pairs that it gives turns at once, at least.
const KEYS_PER_JOB: usize = 2048;
const BODIES_PER_JOB: usize = 64;
const GROUPS_PER_JOB: usize = 64;

/// Marks the first row of a pair.
const FIRST: u32 = 1 << 31;

/// Rows of a body that are sorted with what they are sorted by beside them.
const FEW_ROWS: usize = 256;

/// The order of the sweeps, and what is needed to find it.
#[derive(Debug, Clone, Default)]
pub struct Turns {
    /// The turn of each row.
    turn_of: Vec<u32>,
    /// The rows by the smaller of their bodies and then by the larger, so that those of a pair stand together; the first of each is marked.
    rows: Vec<u32>,
    /// Where those of each body end.
    ends: Vec<u32>,
    /// Pairs: colour, first row in `rows` and one behind the last.
    pairs: Vec<(u32, u32, u32)>,
    /// Pairs that take turns: the first of them, one behind the last, and their first turn.
    groups: Vec<(u32, u32, u32)>,
    /// Of each cell the colours that it has.
    taken: Vec<u64>,
    /// What has been put where it belongs.
    done: Vec<bool>,
    /// One behind the last turn of each job; jobs of a colour move different cells.
    jobs: Vec<u32>,
    /// One behind the last job of each colour.
    colours: Vec<u32>,
}

impl Turns {
    /// Finds the order of so many rows, each between two bodies.
    pub fn find(&mut self, count: usize, between: impl Fn(usize) -> [u32; 2] + Sync, bodies: usize) {
        self.turn_of.resize(count, 0);
        self.sort_rows(&between, bodies);
        self.colour_pairs(&between, bodies);
        // Pairs with as many rows stay side by side longest.
        self.pairs.par_sort_unstable_by_key(|&(colour, first, end)| (colour, end - first, first));
        self.group_pairs(Self::are_many(count));
        let (pairs, rows, turn_of) = (&self.pairs, &self.rows, Together::new(&mut self.turn_of));
        let groups = self.groups.par_iter().with_min_len(GROUPS_PER_JOB);
        groups.for_each(|&(first, end, mut next)| {
            let group = &pairs[first as usize..end as usize];
            let longest = group.iter().map(|&(_, first, end)| end - first).max().unwrap_or(0);
            for turn in 0..longest {
                for &(_, first, _) in group.iter().filter(|&&(_, first, end)| first + turn < end) {
                    // SAFETY: each row is in one pair, and that in one group.
                    unsafe { *turn_of.item(number(rows[(first + turn) as usize])) = next };
                    next += 1;
                }
            }
        });
    }

    /// Sorts the rows by the pairs of bodies that they are between: by the smaller of these first, which is counted.
    fn sort_rows(&mut self, between: &(impl Fn(usize) -> [u32; 2] + Sync), bodies: usize) {
        let Self { turn_of, rows, ends, .. } = self;
        let smaller = turn_of.par_iter_mut().enumerate().with_min_len(KEYS_PER_JOB);
        smaller.for_each(|(row, smaller)| {
            let [one, other] = between(row);
            *smaller = one.min(other);
        });
        ends.clear();
        ends.resize(bodies + 1, 0);
        turn_of.iter().for_each(|body| ends[*body as usize + 1] += 1);
        (0..bodies).for_each(|body| ends[body + 1] += ends[body]);
        rows.resize(turn_of.len(), 0);
        for (row, body) in (0..).zip(&*turn_of) {
            let end = &mut ends[*body as usize];
            rows[*end as usize] = row;
            *end += 1;
        }
        // By now the end of each is where the next one begins.
        ends.pop();
        let (ends, rows) = (&*ends, Together::new(rows));
        (0..bodies).into_par_iter().with_min_len(BODIES_PER_JOB).for_each(|body| {
            let start = if body == 0 { 0 } else { ends[body - 1] };
            // SAFETY: each body has rows of its own.
            let own = unsafe { rows.part(start as usize..ends[body] as usize) };
            let larger = |row: u32| {
                let [one, other] = between(row as usize);
                one.max(other)
            };
            sort_by_body(own, larger);
            let mut last = None;
            for row in own {
                let other = larger(*row);
                *row |= if last == Some(other) { 0 } else { FIRST };
                last = Some(other);
            }
        });
    }

    /// Lists the pairs of bodies, no body twice in a colour.
    fn colour_pairs(&mut self, between: &impl Fn(usize) -> [u32; 2], bodies: usize) {
        self.taken.clear();
        self.taken.resize(bodies, 0);
        self.pairs.clear();
        let mut first = 0;
        for (body, &end) in self.ends.iter().enumerate() {
            for pair in self.rows[first as usize..end as usize].chunk_by(|_, next| next & FIRST == 0) {
                let [one, other] = between(number(pair[0]));
                let other = one.max(other) as usize;
                let colour = (self.taken[body] | self.taken[other]).trailing_ones().min(COLOURS - 1);
                self.taken[body] |= 1 << colour;
                self.taken[other] |= 1 << colour;
                let end = first + pair.len() as u32;
                self.pairs.push((colour, first, end));
                first = end;
            }
        }
    }

    /// Groups the pairs of a colour that take turns, and the groups to jobs.
    fn group_pairs(&mut self, is_shared: bool) {
        self.groups.clear();
        self.jobs.clear();
        self.colours.clear();
        let (mut next, mut pair) = (0, 0);
        for colour in self.pairs.chunk_by(|one, other| one.0 == other.0) {
            for group in colour.chunks(SIDE_BY_SIDE) {
                let end = pair + group.len() as u32;
                self.groups.push((pair, end, next));
                next += group.iter().map(|&(_, first, end)| end - first).sum::<u32>();
                pair = end;
                let begun = self.jobs.last().copied().unwrap_or(0);
                if is_shared && colour[0].0 + 1 < COLOURS && next - begun >= ROWS_PER_JOB {
                    self.jobs.push(next);
                }
            }
            if is_shared {
                end_job(&mut self.jobs, next);
                self.colours.push(self.jobs.len() as u32);
            }
        }
        end_job(&mut self.jobs, next);
        if !is_shared {
            self.colours.push(self.jobs.len() as u32);
        }
    }

    /// The turn of a row in the order that was found last.
    pub fn of_row(&self, row: usize) -> usize {
        self.turn_of[row] as usize
    }

    /// One job that sweeps so many rows as they stand.
    pub fn leave(&mut self, rows: usize) {
        self.jobs.clear();
        self.jobs.push(rows as u32);
        self.colours.clear();
        self.colours.push(1);
    }

    /// Whether so many rows are shared among threads.
    pub fn are_many(rows: usize) -> bool {
        rows >= SHARED_FROM
    }

    /// How many jobs there are.
    pub fn jobs(&self) -> usize {
        self.jobs.len()
    }

    /// The turns of a job.
    pub fn of_job(&self, job: usize) -> std::ops::Range<usize> {
        let start = if job == 0 { 0 } else { self.jobs[job - 1] };
        start as usize..self.jobs[job] as usize
    }

    /// The jobs of each colour, colour by colour: those of one may be done at the same time.
    pub fn colours(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        let starts = std::iter::once(0).chain(self.colours.iter().copied());
        starts.zip(&self.colours).map(|(start, end)| start as usize..*end as usize)
    }

    /// Puts what is listed row by row in the order of the sweeps.
    pub fn arrange<T>(&mut self, list: &mut [T]) {
        self.for_each_step(list.len(), |start, _, to| list.swap(start, to));
    }

    /// Puts what is in the order of the sweeps back row by row.
    pub fn put_back<T>(&mut self, list: &mut [T]) {
        self.for_each_step(list.len(), |_, to, from| list.swap(to, from));
    }

    /// Walks along the circles of the order: where one starts, a row, and its turn, but for the last of each.
    fn for_each_step(&mut self, rows: usize, mut step: impl FnMut(usize, usize, usize)) {
        self.done.clear();
        self.done.resize(rows, false);
        for start in 0..rows {
            let mut row = start;
            while !self.done[row] {
                self.done[row] = true;
                let turn = self.turn_of[row] as usize;
                if turn != start {
                    step(start, row, turn);
                }
                row = turn;
            }
        }
    }
}

/// The number of a row, marked or not.
fn number(row: u32) -> usize {
    (row & !FIRST) as usize
}

/// Sorts rows by a body of each, then by their numbers. Few, as they are, with the bodies beside them.
fn sort_by_body(rows: &mut [u32], body: impl Fn(u32) -> u32) {
    let mut beside = [0u64; FEW_ROWS];
    let Some(beside) = beside.get_mut(..rows.len()) else {
        return rows.sort_unstable_by_key(|row| (body(*row), *row));
    };
    beside.iter_mut().zip(&*rows).for_each(|(both, row)| *both = u64::from(body(*row)) << 32 | u64::from(*row));
    beside.sort_unstable();
    rows.iter_mut().zip(beside).for_each(|(row, both)| *row = *both as u32);
}

/// Ends the last job after so many turns, if it has any.
fn end_job(jobs: &mut Vec<u32>, turns: u32) {
    if jobs.last().copied().unwrap_or(0) < turns {
        jobs.push(turns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of twelve cells with five contacts each, told from both sides.
    fn ring() -> Vec<[u32; 2]> {
        (0..60).map(|i| if i % 2 == 0 { [i % 12, (i + 1) % 12] } else { [(i + 1) % 12, i % 12] }).collect()
    }

    /// Finds the order of rows; the row that has each turn comes back.
    fn found(turns: &mut Turns, rows: &[[u32; 2]], bodies: usize) -> Vec<u32> {
        turns.find(rows.len(), |row| rows[row], bodies);
        let mut order: Vec<u32> = (0..rows.len() as u32).collect();
        order.sort_by_key(|row| turns.of_row(*row as usize));
        order
    }

    #[test]
    fn each_row_has_one_turn_and_neighbours_in_the_order_move_different_cells() {
        let (ring, mut turns) = (ring(), Turns::default());
        let order = found(&mut turns, &ring, 12);
        let mut sorted = turns.turn_of.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..60).collect::<Vec<u32>>());
        let shared = order.windows(2).filter(|two| {
            let [one, other] = [two[0], two[1]].map(|row| ring[row as usize]);
            one.iter().any(|body| other.contains(body))
        });
        assert!(shared.count() <= 3, "only where a colour begins");
    }

    #[test]
    fn what_is_put_in_order_comes_back() {
        let mut turns = Turns::default();
        let order = found(&mut turns, &ring(), 12);
        let mut list: Vec<u32> = (0..60).collect();
        turns.arrange(&mut list);
        assert_eq!(list, order);
        turns.put_back(&mut list);
        assert_eq!(list, (0..60).collect::<Vec<u32>>());
    }

    #[test]
    fn jobs_of_a_colour_move_different_cells_and_all_turns_are_in_one() {
        // A grid of 20 x 20 cells with eight contacts between any two side by side.
        let cell = |x: u32, y: u32| 20 * y + x;
        let pairs = (0..20).flat_map(|y| (0..20).map(move |x| (x, y)));
        let beside = pairs.flat_map(|(x, y)| [(x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(u, v)| (x, y, u, v)));
        let rows: Vec<[u32; 2]> = beside
            .filter(|&(.., u, v)| u < 20 && v < 20)
            .flat_map(|(x, y, u, v)| std::iter::repeat_n([cell(x, y), cell(u, v)], 8))
            .collect();
        assert!(Turns::are_many(rows.len()), "{}", rows.len());
        let mut turns = Turns::default();
        let order = found(&mut turns, &rows, 400);
        let mut next = 0;
        for colour in turns.colours() {
            let mut mover = vec![None; 400];
            for job in colour {
                let of_job = turns.of_job(job);
                assert_eq!(of_job.start, next);
                next = of_job.end;
                for turn in of_job {
                    for body in rows[order[turn] as usize] {
                        assert!(mover[body as usize].replace(job).is_none_or(|mover| mover == job), "{body}");
                    }
                }
            }
        }
        assert_eq!(next, rows.len());
        assert!(turns.jobs() > turns.colours().count() + 4, "colours have several jobs: {}", turns.jobs());
    }
}
