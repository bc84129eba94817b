//! Units as they are put together: sizes, powers, and what they are called.

use crate::units::{Dimension, UnitError, parse_unit};

/// A unit: how many base units, the powers of these, and how it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    size: f64,
    /// Powers of length, time, force, angle, amount, current and temperature; roots make them fractions.
    powers: [f64; 7],
    /// What it was put together from, with powers.
    written: Vec<(String, f64)>,
    /// Parts whose powers are not known before the system runs.
    raised: Vec<Raised>,
}

/// A unit to a power that is a multiple of an expression: uM^(2 n).
#[derive(Debug, Clone, PartialEq)]
struct Raised {
    base: Unit,
    /// The expression, as it is written without its number.
    exponent: String,
    multiple: f64,
}

impl Unit {
    /// A plain number.
    pub fn plain() -> Self {
        Self { size: 1.0, powers: [0.0; 7], written: Vec::new(), raised: Vec::new() }
    }

    /// Reads a unit, "uM/min"; "1" is a plain number.
    ///
    /// # Errors
    /// Says what is wrong with the text.
    pub fn read(text: &str) -> Result<Self, UnitError> {
        let found = parse_unit(text)?;
        let d = found.dimension;
        let powers = [d.length, d.time, d.force, d.angle, d.amount, d.current, d.temperature].map(f64::from);
        let mut unit = Self { size: found.value, powers, written: Vec::new(), raised: Vec::new() };
        unit.written = factors(text.trim());
        Ok(unit)
    }

    /// The dimension, where its powers are whole.
    pub fn dimension(&self) -> Option<Dimension> {
        let whole =
            self.raised.is_empty() && self.powers.iter().all(|power| power.fract() == 0.0 && power.abs() <= 100.0);
        let [length, time, force, angle, amount, current, temperature] = self.powers.map(|power| power as i8);
        whole.then_some(Dimension { length, time, force, angle, amount, current, temperature })
    }

    /// How many base units (µm, s, pN, rad, zmol and their products) the unit holds.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The unit to a power.
    pub fn to_the(&self, power: f64) -> Self {
        let written = self.written.iter().map(|(name, own)| (name.clone(), own * power));
        let raised = self.raised.iter().map(|part| Raised { multiple: part.multiple * power, ..part.clone() });
        Self {
            size: self.size.powf(power),
            powers: self.powers.map(|own| own * power),
            written: written.collect(),
            raised: raised.collect(),
        }
    }

    /// The unit to a power that is a multiple of an expression; nothing when it is such a power already.
    pub(super) fn to_the_expression(&self, exponent: String, multiple: f64) -> Option<Self> {
        if self.raised.is_empty() {
            let raised = vec![Raised { base: self.clone(), exponent, multiple }];
            return Some(Self { raised, ..Self::plain() });
        }
        None
    }

    /// Whether a part has a power that is not known.
    pub(super) fn is_raised(&self) -> bool {
        !self.raised.is_empty()
    }

    /// The product of two units.
    pub fn times(&self, other: &Self) -> Self {
        let mut powers = self.powers;
        for (power, other) in powers.iter_mut().zip(other.powers) {
            *power += other;
        }
        let mut written = self.written.clone();
        for (name, power) in &other.written {
            match written.iter_mut().find(|(known, _)| known == name) {
                Some((_, own)) => *own += power,
                None => written.push((name.clone(), *power)),
            }
        }
        written.retain(|(_, power)| *power != 0.0);
        let mut raised = self.raised.clone();
        for part in &other.raised {
            match raised.iter_mut().find(|known| known.exponent == part.exponent && known.base.is_same(&part.base)) {
                Some(known) => known.multiple += part.multiple,
                None => raised.push(part.clone()),
            }
        }
        raised.retain(|part| part.multiple != 0.0);
        Self { size: self.size * other.size, powers, written, raised }
    }

    /// Whether two units are of the same kind, whatever their sizes.
    fn alike(&self, other: &Self) -> bool {
        let like = |part: &Raised, other: &Raised| {
            part.exponent == other.exponent && part.multiple == other.multiple && part.base.is_same(&other.base)
        };
        let has_all = |a: &Self, b: &Self| a.raised.iter().all(|part| b.raised.iter().any(|other| like(part, other)));
        has_all(self, other)
            && has_all(other, self)
            && self.powers.iter().zip(other.powers).all(|(a, b)| (a - b).abs() < 1e-9)
    }

    /// Whether two units are the same; sizes may differ by round-off.
    pub fn is_same(&self, other: &Self) -> bool {
        self.alike(other) && (self.size / other.size - 1.0).abs() < 1e-9
    }

    /// The unit for people: "uM/min"; "1" for a plain number.
    pub fn text(&self) -> String {
        let power = |power: f64| if power == 1.0 { String::new() } else { format!("^{power}") };
        let part = |wanted: bool| -> Vec<String> {
            let chosen = self.written.iter().filter(|(_, own)| (*own > 0.0) == wanted);
            let known = chosen.map(|(name, own)| format!("{name}{}", power(own.abs())));
            let raised = self.raised.iter().filter(|part| (part.multiple > 0.0) == wanted);
            known.chain(raised.map(Raised::text)).collect()
        };
        let (above, below) = (part(true), part(false));
        let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
        match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join(" ")),
        }
    }

    fn is_unwritten(&self) -> bool {
        self.written.is_empty() && self.raised.is_empty()
    }

    /// "in uM" or "a plain number".
    pub(super) fn told(&self) -> String {
        if self.is_unwritten() { "a plain number".to_owned() } else { format!("in {}", self.text()) }
    }

    /// "uM" or "a plain number".
    pub(super) fn wanted(&self) -> String {
        if self.is_unwritten() { "a plain number".to_owned() } else { self.text() }
    }

    /// What another unit would have to be multiplied by to be this one.
    pub(super) fn advice(&self, found: &Self) -> String {
        if self.is_raised() || found.is_raised() {
            return "a power that is not a number has a unit of its own: divide by a quantity in the same unit first, as in `(x/K)^n`, \
                    or use `hill(x, K, n)`"
                .to_owned();
        }
        if self.alike(found) {
            let factor = found.size / self.size;
            return format!(
                "both measure the same; multiply by `{factor} [{}]`",
                self.times(&found.to_the(-1.0)).text()
            );
        }
        // A unit has whole powers where it is written.
        if self.written.iter().any(|(_, power)| power.fract() != 0.0) {
            let square = self.to_the(2.0).text();
            return format!(
                "make it the root of a quantity, `sqrt(q)` with q in {square}, or correct the units of its parts"
            );
        }
        format!("make it a quantity in {}, or correct the units of its parts", self.text())
    }
}

impl Raised {
    /// "uM^n", "uM^(2*n)".
    fn text(&self) -> String {
        let base = if self.base.written.len() == 1 { self.base.text() } else { format!("({})", self.base.text()) };
        let bare = self.exponent.chars().all(char::is_alphanumeric);
        match self.multiple.abs() {
            1.0 if bare => format!("{base}^{}", self.exponent),
            1.0 => format!("{base}^({})", self.exponent),
            multiple => format!("{base}^({multiple}*{})", self.exponent),
        }
    }
}

/// The factors of a unit's text, with their powers; a text with brackets counts as one.
fn factors(text: &str) -> Vec<(String, f64)> {
    if text.contains('(') || text.is_empty() {
        return vec![(format!("({text})"), 1.0)];
    }
    let mut unit = Unit::plain();
    for (index, part) in text.split('/').enumerate() {
        for word in part.split([' ', '*', '·', '×']).filter(|word| !word.is_empty() && *word != "1") {
            let (name, power) = match word.split_once('^') {
                Some((name, power)) => (name.to_owned(), power.parse().unwrap_or(1.0)),
                None => (word.to_owned(), 1.0),
            };
            let sign = if index == 0 { 1.0 } else { -1.0 };
            let factor = Unit { written: vec![(name, sign * power)], ..Unit::plain() };
            unit = unit.times(&factor);
        }
    }
    unit.written
}
