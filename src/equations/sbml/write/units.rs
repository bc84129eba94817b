//! Units as SBML defines them: products of the units of the SI and litres, each with a power of ten or a factor.

use super::element::Element;
use super::names::identifier;
use crate::units::{Dimension, parse_unit};

/// Units that need no definition, and their names in SBML.
const KNOWN: [(&str, &str); 21] = [
    ("s", "second"),
    ("m", "metre"),
    ("mol", "mole"),
    ("l", "litre"),
    ("L", "litre"),
    ("g", "gram"),
    ("N", "newton"),
    ("J", "joule"),
    ("Pa", "pascal"),
    ("Hz", "hertz"),
    ("rad", "radian"),
    ("A", "ampere"),
    ("C", "coulomb"),
    ("V", "volt"),
    ("F", "farad"),
    ("S", "siemens"),
    ("ohm", "ohm"),
    ("Ω", "ohm"),
    ("W", "watt"),
    ("K", "kelvin"),
    ("1", "dimensionless"),
];

/// (multiplier · 10^scale · kind)^exponent.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Base {
    kind: &'static str,
    exponent: i32,
    scale: i32,
    multiplier: f64,
}

/// The unit definitions of a model.
#[derive(Default)]
pub struct Units {
    /// Identifier, text and parts of each.
    defined: Vec<(String, String, Vec<Base>)>,
}

impl Units {
    /// The identifier of a unit of EML; none for an empty text, and for what SBML has no unit for.
    pub fn reference(&mut self, text: &str) -> Option<String> {
        parse_unit(text).ok()?;
        let factors = factors(text);
        match factors.as_slice() {
            [] => return Some("dimensionless".to_owned()),
            [(name, 1)] => {
                if let Some((_, known)) = KNOWN.iter().find(|(symbol, _)| symbol == name) {
                    return Some((*known).to_owned());
                }
            }
            _ => {}
        }
        let bases: Option<Vec<Vec<Base>>> = factors.iter().map(|(name, power)| bases(name, *power)).collect();
        Some(self.define(&label(&factors), text.trim(), bases?.concat()))
    }

    /// The unit of the amount that makes a concentration of 1 unit in 1 l.
    pub fn amount_in_litre(&mut self, concentration: &str) -> Option<String> {
        let (multiplier, scale) = decimal(parse_unit(concentration).ok()?.value);
        // The base unit is 1 zmol/µm³ = 1 µmol/l.
        let base = Base { kind: "mole", exponent: 1, scale: scale - 6, multiplier };
        let text = format!("{concentration} l");
        Some(self.define(&identifier(&format!("{}_l", label(&factors(concentration)))), &text, vec![base]))
    }

    /// The definitions.
    pub fn elements(&self) -> Vec<Element> {
        let unit = |base: &Base| {
            Element::new("unit")
                .with("kind", base.kind)
                .with("exponent", base.exponent.to_string())
                .with("scale", base.scale.to_string())
                .with("multiplier", base.multiplier.to_string())
        };
        let definition = |(id, text, bases): &(String, String, Vec<Base>)| {
            let head = Element::new("unitDefinition").with("id", id).with("name", text);
            head.list("listOfUnits", bases.iter().map(unit).collect())
        };
        self.defined.iter().map(definition).collect()
    }

    /// The identifier of a definition, which is made where there is none for the text.
    fn define(&mut self, label: &str, text: &str, bases: Vec<Base>) -> String {
        if let Some((id, ..)) = self.defined.iter().find(|(_, known, _)| known == text) {
            return id.clone();
        }
        let mut id = label.to_owned();
        while self.defined.iter().any(|(known, ..)| *known == id) || is_kind(&id) {
            id.push('_');
        }
        self.defined.push((id.clone(), text.to_owned(), bases));
        id
    }
}

/// Whether SBML keeps a word for a unit of its own.
fn is_kind(id: &str) -> bool {
    const OTHERS: [&str; 16] = [
        "avogadro",
        "becquerel",
        "candela",
        "celsius",
        "gray",
        "henry",
        "item",
        "katal",
        "kilogram",
        "lumen",
        "lux",
        "meter",
        "sievert",
        "steradian",
        "tesla",
        "weber",
    ];
    OTHERS.contains(&id) || KNOWN.iter().any(|(_, known)| *known == id)
}

/// The symbols of a unit that has been read, with their powers. After a `/` stands one symbol or bracket.
fn factors(text: &str) -> Vec<(String, i32)> {
    let mut found: Vec<(String, i32)> = Vec::new();
    // Where a bracket began, and the sign in front of it.
    let mut open: Vec<(usize, i32)> = Vec::new();
    let (mut rest, mut sign) = (text, 1);
    while let Some(c) = rest.chars().next() {
        let length = match c {
            '(' => {
                open.push((found.len(), std::mem::replace(&mut sign, 1)));
                1
            }
            ')' => {
                let (first, outer) = open.pop().unwrap_or((found.len(), 1));
                let (power, length) = power(&rest[1..]);
                found[first..].iter_mut().for_each(|(_, own)| *own *= outer * power);
                1 + length
            }
            '/' => {
                sign = -1;
                1
            }
            c if c.is_alphabetic() || "%°1".contains(c) => {
                let is_symbol = |c: char| c.is_alphabetic() && !"²³¹".contains(c) || "%°".contains(c);
                let end = if c == '1' { 1 } else { rest.find(|c| !is_symbol(c)).unwrap_or(rest.len()) };
                let (power, length) = power(&rest[end..]);
                if c != '1' {
                    found.push((rest[..end].to_owned(), std::mem::replace(&mut sign, 1) * power));
                }
                sign = 1;
                end + length
            }
            c => c.len_utf8(),
        };
        rest = &rest[length..];
    }
    found
}

/// The power at the beginning of a text, 1 where there is none, and how many bytes it takes.
fn power(text: &str) -> (i32, usize) {
    let mut digits = String::new();
    let mut length = 0;
    for c in text.chars() {
        let raised = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).and_then(|index| "-0123456789".chars().nth(index));
        match (c, raised) {
            ('^', _) if length == 0 => {}
            (_, Some(digit)) => digits.push(digit),
            ('0'..='9' | '-', _) if text.starts_with('^') => digits.push(c),
            _ => break,
        }
        length += c.len_utf8();
    }
    (digits.parse().unwrap_or(1), length)
}

/// A symbol to a power in the units of SBML, if it has such.
fn bases(symbol: &str, exponent: i32) -> Option<Vec<Base>> {
    let unit = parse_unit(symbol).ok()?;
    // What the base unit (µm, s, pN, zmol, pA, K and their products) is in that of SBML, as a power of ten.
    let (kind, ten) = match unit.dimension {
        Dimension::LENGTH => ("metre", -6),
        Dimension::TIME => ("second", 0),
        Dimension::FORCE => ("newton", -12),
        Dimension::ANGLE => ("radian", 0),
        Dimension::AMOUNT => ("mole", -21),
        Dimension::CONCENTRATION => ("mole", -6),
        Dimension::VOLUME => ("litre", -15),
        Dimension::STRESS => ("pascal", 0),
        Dimension::ENERGY => ("joule", -18),
        Dimension::MASS => ("gram", -3),
        Dimension::FREQUENCY => ("hertz", 0),
        Dimension::CURRENT => ("ampere", -12),
        Dimension::CHARGE => ("coulomb", -12),
        Dimension::VOLTAGE => ("volt", -6),
        Dimension::CAPACITANCE => ("farad", -6),
        Dimension::CONDUCTANCE => ("siemens", -6),
        Dimension::RESISTANCE => ("ohm", 6),
        Dimension::POWER => ("watt", -18),
        Dimension::TEMPERATURE => ("kelvin", 0),
        Dimension::NUMBER => ("dimensionless", 0),
        _ => return None,
    };
    let (multiplier, scale) = decimal(unit.value);
    let mut bases = vec![Base { kind, exponent, scale: scale + ten, multiplier }];
    if unit.dimension == Dimension::CONCENTRATION {
        bases.push(Base { kind: "litre", exponent: -exponent, scale: 0, multiplier: 1.0 });
    }
    Some(bases)
}

/// A number as a factor and a power of ten: the factor is 1 where that is exact.
fn decimal(value: f64) -> (f64, i32) {
    let ten = value.log10().round() as i32;
    let is_power = format!("1e{ten}").parse::<f64>().is_ok_and(|power| (power / value - 1.0).abs() < 1e-12);
    if is_power { (1.0, ten) } else { (value, 0) }
}

/// An identifier for a unit: `uM_per_min`.
fn label(factors: &[(String, i32)]) -> String {
    let part = |wanted: bool| {
        let chosen = factors.iter().filter(|(_, power)| (*power > 0) == wanted);
        let words = chosen.map(|(name, power)| {
            let name =
                name.replace(['µ', 'μ'], "u").replace('%', "percent").replace('°', "deg").replace('Å', "angstrom");
            if power.abs() == 1 { name } else { format!("{name}{}", power.abs()) }
        });
        words.collect::<Vec<_>>().join("_")
    };
    let (above, below) = (part(true), part(false));
    identifier(&match (above.as_str(), below.as_str()) {
        (above, "") => above.to_owned(),
        ("", below) => format!("per_{below}"),
        (above, below) => format!("{above}_per_{below}"),
    })
}

#[cfg(test)]
mod tests {
    use super::{Base, Units, factors, label};

    #[test]
    fn units_are_taken_apart_as_they_are_read() {
        for (text, expected, id) in [
            ("uM/min", vec![("uM", 1), ("min", -1)], "uM_per_min"),
            ("1/s", vec![("s", -1)], "per_s"),
            ("1/(uM s^2)", vec![("uM", -1), ("s", -2)], "per_uM_s2"),
            ("pN·s/µm²", vec![("pN", 1), ("s", 1), ("µm", -2)], "pN_s_per_um2"),
            ("(um/s)^2", vec![("um", 2), ("s", -2)], "um2_per_s2"),
            ("m s⁻²", vec![("m", 1), ("s", -2)], "m_per_s2"),
            ("pN/(um/s)", vec![("pN", 1), ("um", -1), ("s", 1)], "pN_s_per_um"),
        ] {
            let expected: Vec<(String, i32)> =
                expected.into_iter().map(|(name, power)| (name.to_owned(), power)).collect();
            assert_eq!(factors(text), expected, "{text}");
            assert_eq!(label(&expected), id);
        }
    }

    #[test]
    fn sizes_are_those_of_the_units() {
        // (multiplier · 10^scale)^exponent over the base units of SBML, against the sizes that the units are known to have.
        for (text, size) in [
            ("uM/min", 1e-6 / 60.0),
            ("kPa", 1e3),
            ("pN/um", 1e-12 / 1e-6),
            ("um^2/s", 1e-12),
            ("1/(nM h)", 1.0 / (1e-9 * 3600.0)),
            ("%", 0.01),
            ("deg", std::f64::consts::PI / 180.0),
            ("aJ", 1e-18),
            ("mg", 1e-3),
            ("fl", 1e-15),
            ("zmol", 1e-21),
            ("d", 86400.0),
            ("mV", 1e-3),
            ("nA/mV", 1e-6),
            ("kohm", 1e3),
            ("pS/um^2", 1.0),
            ("uF", 1e-6),
            ("fW", 1e-15),
            ("mC", 1e-3),
            ("mK", 1e-3),
        ] {
            let mut units = Units::default();
            units.reference(text).expect("a unit");
            let found: f64 = units.defined[0]
                .2
                .iter()
                .map(|base| (base.multiplier * 10f64.powi(base.scale)).powi(base.exponent))
                .product();
            assert!((found / size - 1.0).abs() < 1e-12, "{text}: {found} instead of {size}");
        }
        let mut units = Units::default();
        assert_eq!(units.reference("s"), Some("second".into()));
        assert_eq!((units.reference("V"), units.reference("K")), (Some("volt".into()), Some("kelvin".into())));
        assert_eq!(units.reference("uM^n"), None);
        assert_eq!(units.reference("1"), Some("dimensionless".into()));
        assert_eq!((units.reference(""), units.defined.len()), (None, 0));
        units.amount_in_litre("nM").expect("an amount");
        assert_eq!(units.defined[0].2, [Base { kind: "mole", exponent: 1, scale: -9, multiplier: 1.0 }]);
    }
}
