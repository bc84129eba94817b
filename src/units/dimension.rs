//! What kind of quantity a number is: a length, a speed, a stiffness.

/// The powers of length, time, force, angle, amount of substance, electric current and temperature in a quantity. An angle counts as a dimension of its
/// own, so that "15 deg" is not taken for a plain number. The base unit of amount is the zeptomole (602.2 molecules),
/// because then 1 µM, the usual concentration in a cell, is exactly 1 zmol/µm³.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Dimension {
    /// Power of length (base unit µm).
    pub length: i8,
    /// Power of time (base unit s).
    pub time: i8,
    /// Power of force (base unit pN).
    pub force: i8,
    /// Power of angle (base unit rad).
    pub angle: i8,
    /// Power of amount of substance (base unit zmol, so that µM = zmol/µm³ is 1).
    pub amount: i8,
    /// Power of electric current (base unit pA, the current of one channel).
    pub current: i8,
    /// Power of temperature (base unit K).
    pub temperature: i8,
}

/// A dimension that has a name: how messages, documents and legends speak of it.
struct Named {
    dimension: Dimension,
    /// As in "a speed".
    name: &'static str,
    /// The base unit as a document writes it; its factor is exactly 1.
    unit: &'static str,
    /// The base unit as a legend shows it.
    label: &'static str,
    /// A typical quantity for messages and for the schema.
    example: &'static str,
    /// Units for people, smallest first, with the number of base units in each.
    ladder: &'static [(&'static str, f64)],
}

#[rustfmt::skip] // a table
const NAMED: [Named; 26] = [
    Named { dimension: Dimension::LENGTH, name: "length", unit: "um", label: "µm", example: "5 um",
        ladder: &[("nm", 1e-3), ("µm", 1.0), ("mm", 1e3), ("m", 1e6)] },
    Named { dimension: Dimension::TIME, name: "time", unit: "s", label: "s", example: "10 s",
        ladder: &[("ns", 1e-9), ("µs", 1e-6), ("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("h", 3600.0)] },
    Named { dimension: Dimension::FORCE, name: "force", unit: "pN", label: "pN", example: "10 pN",
        ladder: &[("fN", 1e-3), ("pN", 1.0), ("nN", 1e3), ("µN", 1e6)] },
    Named { dimension: Dimension::ANGLE, name: "angle", unit: "rad", label: "rad", example: "15 deg",
        ladder: &[("°", std::f64::consts::PI / 180.0)] },
    Named { dimension: Dimension::SPEED, name: "speed", unit: "um/s", label: "µm/s", example: "5 um/min",
        ladder: &[("nm/s", 1e-3), ("µm/s", 1.0), ("mm/s", 1e3)] },
    Named { dimension: Dimension::ACCELERATION, name: "acceleration", unit: "um/s^2", label: "µm/s²",
        example: "-9.81 m/s^2", ladder: &[("µm/s²", 1.0), ("mm/s²", 1e3), ("m/s²", 1e6)] },
    Named { dimension: Dimension::LINE_STIFFNESS, name: "stiffness", unit: "pN/um", label: "pN/µm",
        example: "5 pN/um", ladder: &[("nN/m", 1e-3), ("pN/µm", 1.0), ("mN/m", 1e3)] },
    Named { dimension: Dimension::ENERGY, name: "energy", unit: "pN um", label: "pN·µm", example: "0.2 pN um",
        ladder: &[("aJ", 1.0), ("fJ", 1e3), ("pJ", 1e6)] },
    Named { dimension: Dimension::DRAG, name: "drag", unit: "pN s/um", label: "pN·s/µm", example: "20 pN s/um",
        ladder: &[("pN·s/µm", 1.0)] },
    Named { dimension: Dimension::SURFACE_DRAG, name: "friction of surfaces", unit: "pN s/um^3", label: "pN·s/µm³",
        example: "0.2 pN s/um^3", ladder: &[("pN·s/µm³", 1.0)] },
    Named { dimension: Dimension::MASS, name: "mass", unit: "mg", label: "mg", example: "1 mg",
        ladder: &[("pg", 1e-9), ("ng", 1e-6), ("µg", 1e-3), ("mg", 1.0), ("g", 1e3)] },
    Named { dimension: Dimension::AREA, name: "area", unit: "um^2", label: "µm²", example: "100 um^2",
        ladder: &[("µm²", 1.0), ("mm²", 1e6)] },
    Named { dimension: Dimension::VOLUME, name: "volume", unit: "um^3", label: "µm³", example: "100 um^3",
        ladder: &[("µm³", 1.0), ("pl", 1e3), ("nl", 1e6), ("µl", 1e9), ("ml", 1e12)] },
    Named { dimension: Dimension::STRESS, name: "stress", unit: "Pa", label: "Pa", example: "1 kPa",
        ladder: &[("mPa", 1e-3), ("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6)] },
    Named { dimension: Dimension::SURFACE_DENSITY, name: "density on a surface", unit: "/um^2", label: "1/µm²",
        example: "100 /um^2", ladder: &[("/mm²", 1e-6), ("/µm²", 1.0)] },
    Named { dimension: Dimension::FREQUENCY, name: "rate", unit: "/s", label: "1/s", example: "3 /min",
        ladder: &[("mHz", 1e-3), ("Hz", 1.0), ("kHz", 1e3)] },
    Named { dimension: Dimension::AMOUNT, name: "amount", unit: "zmol", label: "zmol", example: "2 fmol",
        ladder: &[("zmol", 1.0), ("amol", 1e3), ("fmol", 1e6), ("pmol", 1e9), ("nmol", 1e12), ("mol", 1e21)] },
    Named { dimension: Dimension::CONCENTRATION, name: "concentration", unit: "uM", label: "µM", example: "5 uM",
        ladder: &[("nM", 1e-3), ("µM", 1.0), ("mM", 1e3), ("M", 1e6)] },
    Named { dimension: Dimension::CURRENT, name: "current", unit: "pA", label: "pA", example: "20 pA",
        ladder: &[("fA", 1e-3), ("pA", 1.0), ("nA", 1e3), ("µA", 1e6), ("mA", 1e9), ("A", 1e12)] },
    Named { dimension: Dimension::CHARGE, name: "charge", unit: "pC", label: "pC", example: "2 pC",
        ladder: &[("fC", 1e-3), ("pC", 1.0), ("nC", 1e3), ("µC", 1e6), ("C", 1e12)] },
    Named { dimension: Dimension::VOLTAGE, name: "voltage", unit: "uV", label: "µV", example: "-70 mV",
        ladder: &[("µV", 1.0), ("mV", 1e3), ("V", 1e6)] },
    Named { dimension: Dimension::CAPACITANCE, name: "capacitance", unit: "uF", label: "µF", example: "10 pF",
        ladder: &[("pF", 1e-6), ("nF", 1e-3), ("µF", 1.0), ("mF", 1e3)] },
    Named { dimension: Dimension::CONDUCTANCE, name: "conductance", unit: "uS", label: "µS", example: "20 pS",
        ladder: &[("pS", 1e-6), ("nS", 1e-3), ("µS", 1.0), ("mS", 1e3), ("S", 1e6)] },
    Named { dimension: Dimension::RESISTANCE, name: "resistance", unit: "Mohm", label: "MΩ", example: "100 Mohm",
        ladder: &[("ohm", 1e-6), ("kohm", 1e-3), ("Mohm", 1.0), ("Gohm", 1e3)] },
    Named { dimension: Dimension::POWER, name: "power", unit: "aW", label: "aW", example: "3 fW",
        ladder: &[("aW", 1.0), ("fW", 1e3), ("pW", 1e6), ("nW", 1e9), ("W", 1e18)] },
    Named { dimension: Dimension::TEMPERATURE, name: "temperature", unit: "K", label: "K", example: "310 K",
        ladder: &[("K", 1.0)] },
];

impl Dimension {
    /// A plain number.
    pub const NUMBER: Self = Self::of(0, 0, 0);
    /// A length, µm.
    pub const LENGTH: Self = Self::of(1, 0, 0);
    /// A time, s.
    pub const TIME: Self = Self::of(0, 1, 0);
    /// A force, pN.
    pub const FORCE: Self = Self::of(0, 0, 1);
    /// An angle, rad.
    pub const ANGLE: Self = Self { angle: 1, ..Self::of(0, 0, 0) };
    /// A speed, µm/s.
    pub const SPEED: Self = Self::of(1, -1, 0);
    /// An acceleration, µm/s².
    pub const ACCELERATION: Self = Self::of(1, -2, 0);
    /// A stiffness of a line or of a surface, a surface tension: pN/µm = µN/m.
    pub const LINE_STIFFNESS: Self = Self::of(-1, 0, 1);
    /// An energy, a bending rigidity, a torque: pN·µm = aJ.
    pub const ENERGY: Self = Self::of(1, 0, 1);
    /// A drag, pN·s/µm.
    pub const DRAG: Self = Self::of(-1, 1, 1);
    /// A friction of surfaces, pN·s/µm³.
    pub const SURFACE_DRAG: Self = Self::of(-3, 1, 1);
    /// A mass, pN·s²/µm = mg.
    pub const MASS: Self = Self::of(-1, 2, 1);
    /// An area, µm².
    pub const AREA: Self = Self::of(2, 0, 0);
    /// A volume, µm³ = fl.
    pub const VOLUME: Self = Self::of(3, 0, 0);
    /// A stress, a pressure, a bulk modulus: pN/µm² = Pa.
    pub const STRESS: Self = Self::of(-2, 0, 1);
    /// How many there are on an area, 1/µm².
    pub const SURFACE_DENSITY: Self = Self::of(-2, 0, 0);
    /// A rate, 1/s.
    pub const FREQUENCY: Self = Self::of(0, -1, 0);
    /// An amount of substance, zmol.
    pub const AMOUNT: Self = Self { amount: 1, ..Self::of(0, 0, 0) };
    /// A concentration, µM = zmol/µm³.
    pub const CONCENTRATION: Self = Self { amount: 1, ..Self::of(-3, 0, 0) };
    /// An electric current, pA.
    pub const CURRENT: Self = Self { current: 1, ..Self::of(0, 0, 0) };
    /// A charge, pA·s = pC.
    pub const CHARGE: Self = Self { current: 1, ..Self::of(0, 1, 0) };
    /// A voltage, pN·µm/pC = µV.
    pub const VOLTAGE: Self = Self { current: -1, ..Self::of(1, -1, 1) };
    /// A capacitance, pC/µV = µF.
    pub const CAPACITANCE: Self = Self { current: 2, ..Self::of(-1, 2, -1) };
    /// A conductance, pA/µV = µS.
    pub const CONDUCTANCE: Self = Self { current: 2, ..Self::of(-1, 1, -1) };
    /// A resistance, µV/pA = MΩ.
    pub const RESISTANCE: Self = Self { current: -2, ..Self::of(1, -1, 1) };
    /// A power, pN·µm/s = aW.
    pub const POWER: Self = Self::of(1, -1, 1);
    /// A temperature, K.
    pub const TEMPERATURE: Self = Self { temperature: 1, ..Self::of(0, 0, 0) };

    /// The dimension with these powers of length, time and force, and nothing else.
    pub const fn of(length: i8, time: i8, force: i8) -> Self {
        Self { length, time, force, angle: 0, amount: 0, current: 0, temperature: 0 }
    }

    /// The dimension named `name` ("length", "speed" …), if there is one.
    pub fn by_name(name: &str) -> Option<Self> {
        NAMED.iter().find(|named| named.name == name).map(|named| named.dimension)
    }

    fn named(self) -> Option<&'static Named> {
        NAMED.iter().find(|named| named.dimension == self)
    }

    /// The name of the dimension, e.g. "speed"; a combination without a name is told by its units.
    pub fn name(self) -> String {
        match self.named() {
            Some(named) => named.name.to_owned(),
            None if self == Self::NUMBER => "plain number".to_owned(),
            None => format!("quantity in {}", label(self)),
        }
    }

    /// The name with its article: "a speed", "an energy".
    pub fn with_article(self) -> String {
        let name = self.name();
        let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        format!("{article} {name}")
    }

    /// A quantity of this dimension as a document would write it, e.g. "5 um/min".
    pub fn example(self) -> String {
        match self.named() {
            Some(named) => named.example.to_owned(),
            None => format!("1 {}", self.base_unit()).trim_end().to_owned(),
        }
    }

    /// The base unit as a document writes it, e.g. "pN/um": `format!("{value} {}", …)` is read back exactly.
    pub fn base_unit(self) -> String {
        match self.named() {
            Some(named) => named.unit.to_owned(),
            None => self.powers(&["pN", "um", "s", "rad", "zmol", "pA", "K"], " ", |power| format!("^{power}")),
        }
    }

    /// The product of the base units with their powers.
    fn powers(self, symbols: &[&str; 7], times: &str, power_text: impl Fn(i8) -> String) -> String {
        let powers = [self.force, self.length, self.time, self.angle, self.amount, self.current, self.temperature];
        let factors = symbols.iter().zip(powers);
        let written = factors.filter(|(_, power)| *power != 0).map(|(symbol, power)| match power {
            1 => (*symbol).to_owned(),
            _ => format!("{symbol}{}", power_text(power)),
        });
        written.collect::<Vec<_>>().join(times)
    }
}

/// The base unit of a dimension as legends and axes show it, e.g. "pN/µm"; empty for a plain number.
pub fn label(dimension: Dimension) -> String {
    match dimension.named() {
        Some(named) => named.label.to_owned(),
        None => dimension.powers(&["pN", "µm", "s", "rad", "zmol", "pA", "K"], "·", superscript),
    }
}

/// A value (in base units) for people: four digits in the unit that keeps the number between 1 and 1000 where there is
/// one, e.g. "1.5 min". Not meant to be read back; [`super::Quantity`]'s `Display` is.
pub fn pretty(value: f64, dimension: Dimension) -> String {
    let ladder = dimension.named().map_or(&[][..], |named| named.ladder);
    let fitting = ladder.iter().rev().find(|(_, size)| value.abs() >= 0.9999 * size).or(ladder.first());
    match fitting {
        Some((unit, _)) if value == 0.0 || !value.is_finite() => {
            let unit = if *unit == "°" { *unit } else { &label(dimension) };
            format!("{value} {unit}")
        }
        Some((unit, size)) => format!("{} {unit}", four_digits(value / size)),
        None => format!("{} {}", four_digits(value), label(dimension)).trim_end().to_owned(),
    }
}

/// Rounds to four digits and writes no needless zeros.
fn four_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e6).contains(&rounded.abs()) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// A whole power as superscript: "⁻²".
fn superscript(power: i8) -> String {
    power
        .to_string()
        .chars()
        .map(|c| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth("-0123456789".find(c).unwrap_or(0)).unwrap_or(c))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dimension_without_a_name_is_told_by_its_units() {
        let odd = Dimension::of(2, -1, 0);
        assert_eq!(odd.name(), "quantity in µm²·s⁻¹");
        assert_eq!(odd.base_unit(), "um^2 s^-1");
    }

    #[test]
    fn every_named_dimension_reads_its_own_example_and_its_base_unit_is_one() {
        for named in &NAMED {
            let example = super::super::parse(named.example).expect("an example is a quantity");
            assert_eq!(example.dimension, named.dimension, "{}", named.name);
            let unit = super::super::parse(&format!("1 {}", named.unit)).expect("a base unit is a unit");
            assert_eq!((unit.value, unit.dimension), (1.0, named.dimension), "{}", named.name);
            for (unit, size) in named.ladder {
                let rung = super::super::parse(&format!("1 {unit}")).expect("a unit for people is a unit");
                assert_eq!(rung.dimension, named.dimension, "{unit}");
                assert!((rung.value - size).abs() <= 1e-15 * size, "{unit}: round-off at most");
            }
        }
    }

    #[test]
    fn a_value_is_shown_in_the_unit_that_suits_it() {
        assert_eq!(pretty(90.0, Dimension::TIME), "1.5 min");
        assert_eq!(pretty(0.02, Dimension::LENGTH), "20 nm");
        assert_eq!(pretty(0.0, Dimension::FORCE), "0 pN");
        assert_eq!(pretty(std::f64::consts::FRAC_PI_2, Dimension::ANGLE), "90 °");
        assert_eq!(pretty(-250.0, Dimension::LENGTH), "-250 µm");
        assert_eq!(pretty(1.0 / 3.0, Dimension::NUMBER), "0.3333");
    }
}
