//! The rates at which cells release into fields in a step: on parabolas, piece after piece, that lie close to what their systems do meanwhile,
//! eq. (coupling.5).

/// The rates of a step.
#[derive(Debug, Clone, Default)]
pub struct Released {
    /// Begin and end of each piece, as shares of the step.
    pub pieces: Vec<[f64; 2]>,
    /// How many rates there are: those of all cells for each channel.
    pub(super) width: usize,
    /// The rates where each piece begins, in its middle and where it ends: `[piece][begin, middle, end][channel][cell]`.
    pub(super) rates: Vec<f64>,
    /// Those at the end of the step of what is not followed.
    pub(super) at_end: Vec<f64>,
    /// When the clock switches something: until when all is as before, when it is, and from when all is as after it, s.
    pub(super) switches: Vec<[f64; 3]>,
    /// When the rates at the end of the step are looked at, s: before what is switched there.
    pub(super) last_look: f64,
    /// Halves of pieces, and how many pieces there are between two switches.
    pub(super) cuts: Vec<Cut>,
    pub(super) counts: Vec<u32>,
}

/// Half a piece of a step, through which systems are followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// When its first and last rates are looked at, s.
    pub(super) looks: [f64; 2],
    /// When it ends, s.
    pub(super) until: f64,
    /// Whether something was switched where it begins.
    pub(super) is_switched: bool,
}

impl Released {
    /// The rates of a channel, one a cell, where a piece begins, in its middle and where it ends.
    pub fn of_channel(&self, piece: usize, channel: usize, cells: usize) -> [&[f64]; 3] {
        [0, 1, 2].map(|side| &self.rates[(3 * piece + side) * self.width..][channel * cells..][..cells])
    }

    /// One piece, on a line from these rates to those at the end.
    pub(super) fn set_line<'r>(&mut self, begin: impl Iterator<Item = &'r f64> + Clone) {
        self.pieces.clear();
        self.pieces.push([0.0, 1.0]);
        self.rates.clear();
        self.rates.extend(begin.clone());
        self.rates.extend(begin.zip(&self.at_end).map(|(begin, end)| 0.5 * (begin + end)));
        self.rates.extend_from_slice(&self.at_end);
    }

    /// Cuts the step into halves of so many pieces, or more: whole ones between two switches, of equal lengths.
    pub(super) fn cut(&mut self, (start, dt): (f64, f64), pieces: u32) {
        self.cuts.clear();
        self.counts.clear();
        let (end, mut first, mut is_switched) = (start + dt, [start; 2], false);
        for &[before, at, after] in self.switches.iter().chain([&[self.last_look, end, end]]) {
            let length = at - first[0];
            let count = (2.0 * (f64::from(pieces) * length / dt * (1.0 - 1e-12)).ceil()).max(2.0) as u32;
            // Nothing is between what is switched at once.
            if length > 0.0 && before > first[1] {
                self.counts.push(count / 2);
                for part in 0..count {
                    let instant = |part: u32| first[0] + length * f64::from(part) / f64::from(count);
                    let (is_first, is_last) = (part == 0, part + 1 == count);
                    let until = if is_last { at } else { instant(part + 1) };
                    let begin = if is_first { first[1] } else { instant(part) };
                    let looks = [begin, if is_last { before } else { until }];
                    self.cuts.push(Cut { looks, until, is_switched: is_first && is_switched });
                }
            }
            (first, is_switched) = ([at, after], true);
        }
    }

    /// What lines would leave out in the stead of the parabolas, by Simpson's rule, over the amount: that of the channel of which it is most.
    pub(super) fn bent(&self, channels: usize) -> f64 {
        let cells = self.width / channels.max(1);
        let of_channel = |channel: usize| {
            let (mut bent, mut amount) = (0.0, 0.0);
            for (number, piece) in self.pieces.iter().enumerate() {
                let sixth = (piece[1] - piece[0]) / 6.0;
                let [begins, middles, ends] = self.of_channel(number, channel, cells);
                for ((begin, middle), end) in begins.iter().zip(middles).zip(ends) {
                    bent += 4.0 * sixth * (middle - 0.5 * (begin + end)).abs();
                    amount += sixth * (begin.abs() + 4.0 * middle.abs() + end.abs());
                }
            }
            if bent > 0.0 { bent / amount } else { 0.0 }
        };
        (0..channels).map(of_channel).fold(0.0, f64::max)
    }

    /// What one parabola for all of the time between two switches would leave out, over the amount: that of the channel of which it is most.
    pub(super) fn misses_as_one(&self, channels: usize) -> f64 {
        let cells = self.width / channels.max(1);
        let of_channel = |channel: usize| {
            let (mut missed, mut amount, mut first) = (0.0, 0.0, 0);
            for count in self.counts.iter().map(|count| *count as usize) {
                let [begins, middles, ends] = self.as_one(first, count, channel, cells);
                for piece in 0..count {
                    let length = self.pieces[first + piece][1] - self.pieces[first + piece][0];
                    let weights = [0.5, 1.0].map(|share| parabola((piece as f64 + share) / count as f64));
                    let [_, halves, wholes] = self.of_channel(first + piece, channel, cells);
                    for cell in 0..cells {
                        let of = |[a, b, c]: [f64; 3]| a * begins[cell] + b * middles[cell] + c * ends[cell];
                        let (half, whole) = (halves[cell], wholes[cell]);
                        missed += 0.5 * length * ((of(weights[0]) - half).abs() + (of(weights[1]) - whole).abs());
                        amount += 0.5 * length * (half.abs() + whole.abs());
                    }
                }
                first += count;
            }
            if missed > 0.0 { missed / amount } else { 0.0 }
        };
        (0..channels).map(of_channel).fold(0.0, f64::max)
    }

    /// The rates of a channel in so many pieces as if they were one: where it begins, in its middle and where it ends.
    fn as_one(&self, first: usize, count: usize, channel: usize, cells: usize) -> [&[f64]; 3] {
        let middle = self.of_channel(first + count / 2, channel, cells);
        let middle = if count.is_multiple_of(2) { middle[0] } else { middle[1] };
        [self.of_channel(first, channel, cells)[0], middle, self.of_channel(first + count - 1, channel, cells)[2]]
    }

    /// Makes one piece of all between two switches.
    pub(super) fn join(&mut self) {
        let (width, mut first) = (self.width, 0);
        for number in 0..self.counts.len() {
            let count = self.counts[number] as usize;
            let middle = if count.is_multiple_of(2) { 3 * (first + count / 2) } else { 3 * (first + count / 2) + 1 };
            for (side, from) in [3 * first, middle, 3 * (first + count) - 1].into_iter().enumerate() {
                self.rates.copy_within(from * width..(from + 1) * width, (3 * number + side) * width);
            }
            self.pieces[number] = [self.pieces[first][0], self.pieces[first + count - 1][1]];
            first += count;
        }
        self.pieces.truncate(self.counts.len());
        self.rates.truncate(3 * self.counts.len() * width);
    }
}

/// The weights of the values where it begins, in its middle and where it ends of a parabola at a share of its length.
pub fn parabola(share: f64) -> [f64; 3] {
    let (rest, turned) = (1.0 - share, 1.0 - 2.0 * share);
    [rest * turned, 4.0 * share * rest, -share * turned]
}
