//! Lists of pairs in words of two bytes: they are most of what contacts hold in memory, and all of it is read in every look.
//!
//! A list is the atom (or edge) that has it, then a body, by its index among the neighbours of the owner's, then facets (or edges) of
//! that body as they are numbered in its shape, ascending, with their levels; then the next body. Owners, bodies and what is beyond
//! the bits of a number are told by how much farther on they are; where that does not fit into a word, several add up.

/// Bits of the number of a facet or an edge in its page; its level stands above them.
const NUMBER_BITS: u32 = 10;

/// The highest level of a pair.
pub(super) const HIGHEST: u32 = 31;

/// Marks a word that goes on to another body; bits that tell how far, and bits below them that tell how many words are listed of it.
const BODY: u16 = 0b10 << 14;
const BODY_BITS: u32 = 6;
const COUNT_BITS: u32 = 8;

/// This many words or more: up to the next owner or body.
const MANY: u16 = (1 << COUNT_BITS) - 1;

/// Marks a word that goes on to another owner.
const OWNER: u16 = 0b110 << 13;
const OWNER_BITS: u32 = 13;

/// Marks a word that goes on to another page.
const PAGE: u16 = 0b111 << 13;
const PAGE_BITS: u32 = 13;

/// Lists one after the other, by their owners. Only those are there that have a pair.
#[derive(Debug, Clone, Default)]
pub(super) struct Words {
    words: Vec<u16>,
    /// The owner and the index that the last words belong to.
    owner: u32,
    index: u32,
}

impl Words {
    /// Forgets all lists and keeps the memory.
    pub fn clear(&mut self) {
        self.words.clear();
        (self.owner, self.index) = (0, 0);
    }

    /// Adds the pairs of an owner with the body at an index among its neighbours, as (number, level), ascending. Owners must
    /// ascend from call to call, and indices of one owner.
    pub fn add(&mut self, owner: u32, position: u32, pairs: &[(u32, u32)]) {
        if pairs.is_empty() {
            return;
        }
        let (body, mut page) = (self.begin(owner, position), 0);
        for &(number, level) in pairs {
            if number >> NUMBER_BITS != page {
                self.go_on(PAGE, PAGE_BITS, 0, (number >> NUMBER_BITS) - page);
                page = number >> NUMBER_BITS;
            }
            let number = number & ((1 << NUMBER_BITS) - 1);
            self.push((level.min(HIGHEST) << NUMBER_BITS | number) as u16);
        }
        self.end(body);
    }

    /// Adds what another list has of an owner and a body, in the same order.
    pub fn add_part(&mut self, owner: u32, position: u32, part: Part) {
        let body = self.begin(owner, position);
        part.0.iter().for_each(|word| self.push(*word));
        self.end(body);
    }

    /// Takes over the lists of another; what they end with is of no use any more.
    pub fn copy(&mut self, other: &Self) {
        self.clear();
        self.words.reserve_exact(other.words.len());
        self.words.extend_from_slice(&other.words);
    }

    /// Goes on to an owner and a body; returns the index of the word that tells how many words are listed of it.
    fn begin(&mut self, owner: u32, position: u32) -> usize {
        if owner != self.owner {
            self.go_on(OWNER, OWNER_BITS, 0, owner - self.owner);
            (self.owner, self.index) = (owner, 0);
        }
        self.go_on(BODY, BODY_BITS, COUNT_BITS, position - self.index);
        self.index = position;
        self.words.len() - 1
    }

    fn end(&mut self, body: usize) {
        self.words[body] |= (self.words.len() - body - 1).min(usize::from(MANY)) as u16;
    }

    /// Writes as many marked words as a distance takes, which stands above some bits.
    fn go_on(&mut self, mark: u16, bits: u32, above: u32, mut displacement: u32) {
        let most = (1 << bits) - 1;
        loop {
            let word = displacement.min(most);
            self.push(mark | (word << above) as u16);
            displacement -= word;
            if displacement == 0 {
                break;
            }
        }
    }

    fn push(&mut self, word: u16) {
        super::found::push(&mut self.words, word);
    }

    /// Gives memory back that only a wider margin needed.
    pub fn release_spare(&mut self) {
        if self.words.capacity() > self.words.len() + self.words.len() / 2 + 64 {
            self.words.shrink_to(self.words.len() + self.words.len() / 8);
        }
    }

    /// Number of words.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        2 * self.words.capacity()
    }

    /// All that is listed: the owner, ascending, the index of a body among the neighbours of the owner's, ascending for each owner, and
    /// the pairs with it.
    pub fn parts(&self) -> Parts<'_> {
        Parts { rest: &self.words, owner: 0, index: 0 }
    }
}

/// Goes through lists.
pub(super) struct Parts<'a> {
    rest: &'a [u16],
    owner: u32,
    index: usize,
}

impl<'a> Iterator for Parts<'a> {
    type Item = (u32, usize, Part<'a>);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let (&word, rest) = self.rest.split_first()?;
            self.rest = rest;
            if word >= OWNER {
                self.owner += u32::from(word & !OWNER);
                self.index = 0;
                continue;
            }
            self.index += usize::from((word & !BODY) >> COUNT_BITS);
            let count = match word & MANY {
                0 => continue,
                MANY => rest.iter().position(|word| (BODY..PAGE).contains(word)).unwrap_or(rest.len()),
                count => usize::from(count),
            };
            let part;
            (part, self.rest) = rest.split_at(count);
            return Some((self.owner, self.index, Part(part)));
        }
    }
}

/// What is listed of one body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part<'a>(&'a [u16]);

impl<'a> Part<'a> {
    /// Nothing.
    pub const EMPTY: Self = Self(&[]);

    /// Whether a facet or an edge has no higher level than this.
    #[inline]
    pub fn has(self, limit: u32) -> bool {
        let limit = limit.min(HIGHEST);
        self.0.iter().any(|&word| u32::from(word) >> NUMBER_BITS <= limit)
    }

    /// The numbers of the facets or edges of no higher level than this.
    #[inline]
    pub fn up_to(self, limit: u32) -> impl Iterator<Item = u32> + 'a {
        let (mut page, limit) = (0, limit.min(HIGHEST));
        self.0.iter().filter_map(move |&word| {
            let word = u32::from(word);
            if word >> NUMBER_BITS <= limit {
                return Some(page + (word & ((1 << NUMBER_BITS) - 1)));
            }
            if word >= u32::from(PAGE) {
                page += (word - u32::from(PAGE)) << NUMBER_BITS;
            }
            None
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Pairs = Vec<(u32, u32)>;

    fn written(lists: &[(u32, u32, Pairs)]) -> Words {
        let mut words = Words::default();
        words.clear();
        lists.iter().for_each(|(owner, position, pairs)| words.add(*owner, *position, pairs));
        words
    }

    fn read(words: &Words, limit: u32) -> Vec<(u32, u32, Vec<u32>)> {
        let all = words.parts().map(|(owner, position, part)| (owner, position as u32, part.up_to(limit).collect()));
        all.filter(|(.., numbers): &(_, _, Vec<u32>)| !numbers.is_empty()).collect()
    }

    #[test]
    fn what_is_written_is_read() {
        // Words of one kind that are just filled and just overflow, at the first owner and later ones.
        let lists = [
            (0, 0, vec![(0, 0), (1, 31), (1023, 5), (1024, 6)]),
            (0, 16_383, vec![(5, 0)]),
            (0, 40_000, vec![(8_388_607, 1), (8_388_608, 2), (300_000_000, 3)]),
            (8_191, 3, vec![(7, 7)]),
            (16_383, 0, vec![(1_047_552, 0)]),
            (1_000_000, 63, vec![(2, 2), (3, 2)]),
            (1_000_000, 127, (0..254).map(|number| (number, 4)).collect()),
            (1_000_000, 128, (1..256).map(|number| (number, 4)).collect()),
            (1_000_000, 129, (0..2000).map(|number| (1000 * number, 4)).collect()),
            (1_000_001, 0, vec![(9, 4)]),
        ];
        let numbers = |limit: u32| -> Vec<(u32, u32, Vec<u32>)> {
            let of = |pairs: &Pairs| pairs.iter().filter(|pair| pair.1 <= limit).map(|pair| pair.0).collect();
            let all = lists.iter().map(|(owner, position, pairs)| (*owner, *position, of(pairs)));
            all.filter(|(.., numbers): &(_, _, Vec<u32>)| !numbers.is_empty()).collect()
        };
        let words = written(&lists);
        for limit in [0, 1, 2, 4, 30, 31, u32::MAX] {
            assert_eq!(read(&words, limit), numbers(limit), "up to level {limit}");
        }
    }

    #[test]
    fn owners_and_bodies_without_pairs_take_no_memory() {
        assert_eq!(written(&[(4, 2, vec![]), (9, 0, vec![])]).len(), 0);
        assert_eq!(written(&[(4, 2, vec![]), (9, 0, vec![(1, 0)]), (9, 1, vec![])]).len(), 3);
    }

    #[test]
    fn levels_above_the_highest_are_the_highest() {
        let words = written(&[(0, 0, vec![(3, 99)])]);
        assert_eq!(read(&words, HIGHEST - 1), []);
        assert_eq!(read(&words, HIGHEST), [(0, 0, vec![3])]);
    }
}
