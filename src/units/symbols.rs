//! The units that documents may use, their prefixes, and what a misspelt one was meant for.

use super::dimension::Dimension;

/// The size of a unit as significand/divisor × 10^ten, so that decimal prefixes cost no rounding: "100 nm" is exactly
/// the number 0.1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    pub(super) numerator: f64,
    pub(super) divisor: f64,
    pub(super) ten: i32,
    pub(super) dimension: Dimension,
}

/// No unit at all.
pub(super) const ONE: Scale = Scale { numerator: 1.0, divisor: 1.0, ten: 0, dimension: Dimension::NUMBER };

/// Units that take prefixes: symbol, power of ten in base units, dimension.
#[rustfmt::skip] // a table
const PREFIXED: [(&str, i32, Dimension); 21] = [
    ("m", 6, Dimension::LENGTH), ("s", 0, Dimension::TIME), ("N", 12, Dimension::FORCE),
    ("g", 3, Dimension::MASS), ("J", 18, Dimension::ENERGY), ("Pa", 0, Dimension::STRESS),
    ("l", 15, Dimension::VOLUME), ("L", 15, Dimension::VOLUME), ("Hz", 0, Dimension::FREQUENCY),
    ("rad", 0, Dimension::ANGLE), ("mol", 21, Dimension::AMOUNT), ("M", 6, Dimension::CONCENTRATION),
    ("A", 12, Dimension::CURRENT), ("C", 12, Dimension::CHARGE), ("V", 6, Dimension::VOLTAGE), ("F", 6, Dimension::CAPACITANCE),
    ("S", 6, Dimension::CONDUCTANCE), ("ohm", -6, Dimension::RESISTANCE), ("Ω", -6, Dimension::RESISTANCE),
    ("W", 18, Dimension::POWER), ("K", 0, Dimension::TEMPERATURE),
];
/// Prefixes; µ is both the micro sign and the Greek letter.
#[rustfmt::skip] // a table
const PREFIXES: [(&str, i32); 15] = [
    ("a", -18), ("f", -15), ("p", -12), ("n", -9), ("u", -6), ("µ", -6), ("μ", -6), ("m", -3), ("c", -2), ("d", -1),
    ("h", 2), ("k", 3), ("M", 6), ("G", 9), ("z", -21),
];
/// Units that take none: symbol, number of base units as significand × 10^ten, dimension.
#[rustfmt::skip] // a table
const PLAIN: [(&str, f64, i32, Dimension); 10] = [
    ("min", 60.0, 0, Dimension::TIME), ("h", 3600.0, 0, Dimension::TIME), ("d", 86400.0, 0, Dimension::TIME),
    ("deg", std::f64::consts::PI / 180.0, 0, Dimension::ANGLE), ("°", std::f64::consts::PI / 180.0, 0, Dimension::ANGLE),
    ("%", 1.0, -2, Dimension::NUMBER), ("1", 1.0, 0, Dimension::NUMBER), ("dyn", 1.0, 7, Dimension::FORCE),
    ("Å", 1.0, -4, Dimension::LENGTH), ("bar", 1.0, 5, Dimension::STRESS),
];
/// Words that people write for units.
#[rustfmt::skip] // a table
const SPELT: [(&str, &str); 33] = [
    ("sec", "s"), ("secs", "s"), ("second", "s"), ("seconds", "s"), ("mins", "min"), ("minute", "min"),
    ("minutes", "min"), ("hr", "h"), ("hrs", "h"), ("hour", "h"), ("hours", "h"), ("day", "d"), ("days", "d"),
    ("micron", "um"), ("microns", "um"), ("micrometer", "um"), ("micrometre", "um"), ("degree", "deg"),
    ("degrees", "deg"), ("radian", "rad"), ("radians", "rad"), ("percent", "%"), ("newton", "N"), ("cc", "ml"),
    ("mole", "mol"), ("moles", "mol"), ("molar", "M"), ("volt", "V"), ("volts", "V"), ("ampere", "A"),
    ("amp", "A"), ("kelvin", "K"), ("siemens", "S"),
];

impl Scale {
    pub(super) fn times(self, other: Self) -> Self {
        let (a, b) = (self.dimension, other.dimension);
        let dimension = Dimension {
            length: a.length.saturating_add(b.length),
            time: a.time.saturating_add(b.time),
            force: a.force.saturating_add(b.force),
            angle: a.angle.saturating_add(b.angle),
            amount: a.amount.saturating_add(b.amount),
            current: a.current.saturating_add(b.current),
            temperature: a.temperature.saturating_add(b.temperature),
        };
        Self {
            numerator: self.numerator * other.numerator,
            divisor: self.divisor * other.divisor,
            ten: self.ten.saturating_add(other.ten),
            dimension,
        }
    }

    pub(super) fn to_the(self, power: i32) -> Self {
        let base = if power < 0 { self.inverse() } else { self };
        (0..power.abs()).fold(ONE, |product, _| product.times(base))
    }

    fn inverse(self) -> Self {
        let d = self.dimension;
        let dimension = Dimension {
            length: d.length.saturating_neg(),
            time: d.time.saturating_neg(),
            force: d.force.saturating_neg(),
            angle: d.angle.saturating_neg(),
            amount: d.amount.saturating_neg(),
            current: d.current.saturating_neg(),
            temperature: d.temperature.saturating_neg(),
        };
        Self { numerator: self.divisor, divisor: self.numerator, ten: -self.ten, dimension }
    }
}

/// Looks a symbol up, with or without a prefix. Whole symbols come first: "min" is a minute, not a milli-inch.
pub(super) fn unit(symbol: &str) -> Option<Scale> {
    let scale = |numerator: f64, ten: i32, dimension: Dimension| Scale { numerator, divisor: 1.0, ten, dimension };
    let plain = PLAIN.iter().find(|(name, ..)| *name == symbol);
    if let Some(&(_, numerator, ten, dimension)) = plain {
        return Some(scale(numerator, ten, dimension));
    }
    PREFIXED.iter().find_map(|&(name, ten, dimension)| {
        let prefix = symbol.strip_suffix(name)?;
        if prefix.is_empty() {
            return Some(scale(1.0, ten, dimension));
        }
        PREFIXES.iter().find(|(letters, _)| *letters == prefix).map(|(_, power)| scale(1.0, ten + power, dimension))
    })
}

/// The unit that an unknown symbol was meant for: a word, other capitals, or a slip of the finger.
pub(super) fn meant(symbol: &str) -> Option<String> {
    let lower = symbol.to_lowercase();
    if let Some((_, unit)) = SPELT.iter().find(|(word, _)| *word == lower) {
        return Some((*unit).to_owned());
    }
    let prefixes = PREFIXES.iter().map(|(prefix, _)| *prefix).chain([""]);
    let known = prefixes.flat_map(|prefix| PREFIXED.iter().map(move |(name, ..)| format!("{prefix}{name}")));
    let known: Vec<String> = known.chain(PLAIN.iter().map(|(name, ..)| (*name).to_owned())).collect();
    // "um" and "pN" are far more likely than "Um" and "PN": among equals the smaller prefix, which comes first, wins.
    let same_letters = known.iter().find(|unit| unit.to_lowercase() == lower);
    // Any two letters are near any third: a slip is only seen in longer symbols.
    let near = |unit: &&String| symbol.len() > 2 && unit.len() > 1 && strsim::damerau_levenshtein(unit, symbol) == 1;
    same_letters.or(known.iter().find(near)).cloned()
}
