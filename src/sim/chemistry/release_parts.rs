//! The parts of a step in each of which what is released comes at once, eqs. (coupling.4) and (coupling.8).

use super::super::model::Model;
use super::links::{AtAtoms, Source};

/// The longest part of a step over the time in which what is released decays: it does not spread much farther than what lives so long.
const LONGEST: f64 = 0.5;

/// Parts of a piece of a step at most.
const MOST_PARTS: f64 = 64.0;

/// How many times longer ago a part begins than it ends, counted from when what is released would have been a point.
const RATIO: f64 = 2.0;

/// How what is released is sensed by the cells around: it has spread from the width of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    /// The time in which a point spreads as wide as a cell is, s.
    widened: f64,
    /// Along how many axes it spreads.
    dimension: usize,
}

impl Near {
    /// Of what is released into some species of a field; none where nobody senses what is released where it is, or it stays there.
    pub fn of(model: &Model, field: usize, species: impl Iterator<Item = usize>) -> Option<Self> {
        let system = &model.chemistry.fields[field].system;
        let sensed = |species: &usize| is_sensed(model, (field, *species));
        let diffusion = |species: usize| system.species()[species].diffusion;
        let fastest = species.filter(sensed).map(diffusion).fold(0.0, f64::max);
        let spacing = system.grid().spacing[0];
        // A sphere of this area has a fourth of it in the square of its radius, over pi.
        let cell = model.chemistry.rest.iter().map(|[_, area]| area / (4.0 * std::f64::consts::PI));
        let width = cell.fold(f64::INFINITY, f64::min) + spacing * spacing;
        let widened = width / (4.0 * fastest);
        (widened.is_finite() && widened > 0.0).then_some(Self { widened, dimension: system.grid().dimension() })
    }
}

/// Whether links sense a species where cells or their atoms are.
fn is_sensed(model: &Model, channel: (usize, usize)) -> bool {
    let at_atoms = |from: Source| match from {
        Source::AtAtom(.., field, species, _) | Source::Atoms(AtAtoms::Sensed(field, species, _)) => {
            (field, species) == channel
        }
        _ => false,
    };
    model.chemistry.sensed.contains(&channel) || model.chemistry.links.iter().any(|link| at_atoms(link.from))
}

/// A part of a piece of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    /// Where it begins, as a share of the piece.
    pub begin: f64,
    /// Its length over that of the piece.
    pub share: f64,
    /// Its length, s.
    pub length: f64,
    /// How long before its end what it releases comes, s: half of it, or less where it is still long for what decays fastest or has spread little.
    pub rest: f64,
    /// What is left of the piece behind it, s; none where it is the last.
    pub left: Option<f64>,
}

impl Part {
    /// The next part of a piece of some length, s, of which so much is left, s, that ends so long before the step does, s; with the fastest rate of decay of what
    /// is released, 1/s.
    pub fn next((piece, left): (f64, f64), age: f64, decay: f64, near: Option<Near>) -> Option<Self> {
        let of_decay = piece / (decay * piece / LONGEST).ceil().clamp(1.0, MOST_PARTS);
        let longest = near.map_or(of_decay, |near| {
            // From here to the instant at which it is half as long ago.
            let since = age + left + near.widened;
            of_decay.min(since * (1.0 - 1.0 / RATIO))
        });
        // What would be left of round-off belongs to it.
        let length = if longest >= left * (1.0 - 1e-9) { left } else { longest };
        let is_last = length >= left;
        // What would be left is much shorter than the time in which it becomes as wide as a cell.
        let length = match near {
            Some(near) if !is_last && left - length < 0.5 * near.widened => left.min(of_decay),
            _ => length,
        };
        let left_behind = (length < left).then_some(left - length);
        let middle = 0.5 * length.min(LONGEST / decay);
        let rest = near.map_or(middle, |near| middle.min(near.middle(age + left - length, length)));
        Some(Self { begin: (piece - left) / piece, share: length / piece, length, rest, left: left_behind })
    }

    /// What it releases, over the rates where it begins, in its middle and where it ends, s: as much as is left at its end of what flows in at a
    /// rate on a parabola through the three, when the rest of the part has decayed.
    pub fn released(&self, decay: f64) -> [f64; 3] {
        let [constant, rising, square] = left_of_powers(decay * self.length);
        let left = [constant - 3.0 * rising + 2.0 * square, 4.0 * (rising - square), 2.0 * square - rising];
        left.map(|left| left * self.length * (decay * self.rest).exp())
    }
}

impl Near {
    /// How long before its end a part of some length, s, that ends so long before the step does, s, releases what is sensed at the end of the step where it
    /// came from as if it had come all the time: the mean of 1/t (or of t^(-1/2), t^(-3/2)) over the time t since it would have been a point.
    fn middle(&self, age: f64, length: f64) -> f64 {
        let (last, first) = (age + self.widened, age + length + self.widened);
        let mean = match self.dimension {
            1 => (0.5 * (first.sqrt() + last.sqrt())).powi(2),
            2 => length / (length / last).ln_1p(),
            _ => (0.5 * length / (1.0 / last.sqrt() - 1.0 / first.sqrt())).powf(2.0 / 3.0),
        };
        (mean - last).clamp(0.0, length)
    }
}

/// What is left at 1 of what flows in from 0 on at the rates 1, u and u² and decays with a rate x.
fn left_of_powers(x: f64) -> [f64; 3] {
    // Of that which rises with the power n, (1 − n times that of the power before) / x; of small x the sum of its powers.
    if x < 1.0 {
        return [0.0, 1.0, 2.0].map(|n| {
            let (mut term, mut sum, mut next) = (1.0 / (n + 1.0), 0.0, n + 2.0);
            while term != 0.0 && sum + term != sum {
                sum += term;
                term *= -x / next;
                next += 1.0;
            }
            sum
        });
    }
    let constant = -f64::exp_m1(-x) / x;
    let rising = (1.0 - constant) / x;
    [constant, rising, (1.0 - 2.0 * rising) / x]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All parts of a piece.
    fn parts(piece: f64, age: f64, decay: f64, near: Option<Near>) -> Vec<Part> {
        let (mut found, mut left) = (Vec::new(), Some(piece));
        while let Some(part) = left.and_then(|left| Part::next((piece, left), age, decay, near)) {
            left = part.left;
            found.push(part);
        }
        found
    }

    /// Whether parts lie one behind the other and are the whole piece.
    fn are_whole(parts: &[Part]) -> bool {
        let end = parts
            .iter()
            .try_fold(0.0_f64, |end, part| ((part.begin - end).abs() < 1e-12).then_some(part.begin + part.share));
        end.is_some_and(|end| (end - 1.0).abs() < 1e-12)
    }

    #[test]
    fn what_is_released_into_decay_is_there_in_full_at_the_end_however_fast_it_is() {
        for (decay, dt, count) in [
            (0.0, 3.0, 1),
            (1e-12, 1.0, 1),
            (8e-9, 1.0, 1),
            (0.3, 0.1, 1),
            (2.0, 1.0, 4),
            (0.7, 400.0, 64),
            (1e7, 10.0, 64),
        ] {
            let near = Some(Near { widened: 0.07, dimension: 2 });
            for (near, age) in [(None, 0.0), (near, 0.0), (near, 0.4)] {
                let parts = parts(dt, age, decay, near);
                assert!(are_whole(&parts), "{parts:?}");
                assert!(near.is_some() || parts.len() == count, "{decay} {dt}: {parts:?}");
                parts.iter().for_each(|part| are_in_full(part, decay));
            }
        }
    }

    /// A part of which what flows in at any rate on a parabola is there at its end as it should be.
    fn are_in_full(part: &Part, decay: f64) {
        assert!(part.rest >= 0.0 && part.rest <= 0.5 * part.length && decay * part.rest <= 0.25, "{part:?}");
        for decay in [decay, 0.5 * decay] {
            let turns = decay * part.length;
            // Of what flowed in at all times before; the sum of its powers where it hardly decays.
            let exact = if turns < 1e-3 {
                part.length * (1.0 - turns / 2.0 * (1.0 - turns / 3.0 * (1.0 - turns / 4.0)))
            } else {
                (1.0 - (-turns).exp()) / decay
            };
            let weights = part.released(decay).map(|left| left * f64::exp(-decay * part.rest));
            // What both round.
            let whole = weights.iter().sum::<f64>();
            assert!((whole / exact - 1.0).abs() < 1e-12, "{decay} {part:?}: {weights:?} {exact}");
            // Of rates on parabolas, by Simpson's rule. Where much decays in a part, 2 000 points do not resolve it.
            for powers in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
                let rate = |u: f64| powers[0] + powers[1] * u + powers[2] * u * u;
                let n = 2000;
                let weight = |i: usize| if i.is_multiple_of(n) { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
                let left = |i: usize| {
                    let share = i as f64 / n as f64;
                    rate(share) * (-turns * (1.0 - share)).exp() * weight(i)
                };
                let wanted = (0..=n).map(left).sum::<f64>() * part.length / (3 * n) as f64;
                let found: f64 = weights.iter().zip([0.0, 0.5, 1.0]).map(|(weight, u)| weight * rate(u)).sum();
                assert!(turns > 10.0 || (found / wanted - 1.0).abs() < 1e-9, "{decay} {part:?}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn what_is_sensed_where_it_came_from_is_as_if_it_had_come_all_the_time() {
        for dimension in [1, 2, 3] {
            let power = -0.5 * dimension as f64;
            for (dt, age) in [(0.01, 0.0), (1.0, 0.0), (4.0, 0.0), (4.0, 0.3), (50.0, 0.0)] {
                let near = Near { widened: 0.07, dimension };
                let parts = parts(dt, age, 0.0, Some(near));
                // At most one for each doubling of the time since it would have been a point.
                let most = (1.0 + dt / (0.07 + age)).log2().ceil() as usize + 1;
                assert!(are_whole(&parts) && parts.len() <= most, "{dt}: {parts:?}");
                let at = |part: &Part| age + (1.0 - part.begin - part.share) * dt + part.rest + 0.07;
                let found: f64 = parts.iter().map(|part| part.length * at(part).powf(power)).sum();
                let (last, first): (f64, f64) = (age + 0.07, age + 0.07 + dt);
                let exact = match dimension {
                    1 => 2.0 * (first.sqrt() - last.sqrt()),
                    2 => (first / last).ln(),
                    _ => 2.0 * (1.0 / last.sqrt() - 1.0 / first.sqrt()),
                };
                assert!((found / exact - 1.0).abs() < 1e-9, "{dimension} {dt} {age}: {found} {exact}");
            }
        }
    }
}
