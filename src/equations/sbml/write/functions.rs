//! Functions of EML that MathML has no element for: function definitions of the model.

use super::element::Element;
use super::names::Names;

/// A function that a model defines where formulas use it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Helper {
    /// xⁿ/(Kⁿ + xⁿ).
    Hill,
    /// 0 below zero, else 1.
    Heaviside,
    /// -1, 0 or 1.
    Sign,
}

impl Helper {
    /// All of them, in order.
    pub const ALL: [Self; 3] = [Self::Hill, Self::Heaviside, Self::Sign];

    fn name(self) -> &'static str {
        match self {
            Self::Hill => "hill",
            Self::Heaviside => "heaviside",
            Self::Sign => "sign",
        }
    }

    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Hill => &["x", "K", "n"],
            Self::Heaviside | Self::Sign => &["x"],
        }
    }

    fn formula(self, number: &impl Fn(f64) -> Element, zero: Element) -> Element {
        let power = |base: &str| apply("power", vec![ci(base), ci("n")]);
        let compared = |operator| apply(operator, vec![ci("x"), zero.clone()]);
        match self {
            Self::Hill => apply("divide", vec![power("x"), apply("plus", vec![power("K"), power("x")])]),
            Self::Heaviside => piecewise(vec![(number(1.0), compared("geq"))], number(0.0)),
            Self::Sign => {
                let pieces = vec![(number(1.0), compared("gt")), (number(-1.0), compared("lt"))];
                piecewise(pieces, number(0.0))
            }
        }
    }

    /// The identifiers of all of them in a model.
    pub fn ids(names: &mut Names) -> [String; 3] {
        Self::ALL.map(|helper| names.new_id(helper.name()))
    }

    /// The formula of its definition; `number` makes the element of a plain number, and `zero` is one that has every unit.
    pub fn lambda(self, number: &impl Fn(f64) -> Element, zero: Element) -> Element {
        let arguments = self.arguments().iter().map(|name| Element::compact("bvar").child(ci(name)));
        Element::compact("lambda").children(arguments).child(self.formula(number, zero))
    }
}

/// A name.
pub fn ci(name: &str) -> Element {
    Element::compact("ci").text(format!(" {name} "))
}

/// An operator with its operands.
pub fn apply(operator: &'static str, operands: Vec<Element>) -> Element {
    Element::compact("apply").child(Element::compact(operator)).children(operands)
}

/// Values with their conditions, and the value where none of these holds.
pub fn piecewise(pieces: Vec<(Element, Element)>, otherwise: Element) -> Element {
    let piece = |(value, condition)| Element::compact("piece").child(value).child(condition);
    let otherwise = Element::compact("otherwise").child(otherwise);
    Element::compact("piecewise").children(pieces.into_iter().map(piece)).child(otherwise)
}
