//! Expressions as MathML, in the subset that SBML takes.

use super::element::{Element, NAMESPACE};
use super::functions::{Helper, apply, ci, piecewise};
use super::kinds::Kind;
use super::names::Names;
use super::shape::{hill, is_bare, is_comparison, is_truth, operator_name, spine};
use crate::equations::tree::{Binary, Expr, QuantityId, Unary};
use std::cell::Cell;

/// Whole numbers below this are written as such.
const LARGEST_WHOLE: f64 = 1e9;

/// Writes the formulas of one model.
pub struct Formulas {
    /// What each quantity is called.
    quantities: Vec<String>,
    /// Whether each is the rate of a reaction of concentrations, which SBML has for the whole compartment.
    dense: Vec<bool>,
    /// What the compartment is called.
    compartment: String,
    /// What the functions are called that MathML does not have, and which of them were used.
    helpers: [String; 3],
    used: Cell<[bool; 3]>,
    /// The unit of time, where numbers say that they have no unit.
    time: Option<String>,
}

impl Formulas {
    /// Formulas of quantities with these names. `time` is the unit of time, for a model whose numbers have units: numbers in its
    /// formulas are plain ones then.
    pub fn new(names: &mut Names, kinds: &[Kind], compartment: &str, time: Option<String>) -> Self {
        let dense = kinds.iter().map(|kind| *kind == Kind::Reaction { is_dense: true }).collect();
        let (helpers, quantities) = (Helper::ids(names), names.quantities.clone());
        Self { quantities, dense, compartment: compartment.to_owned(), helpers, used: Cell::default(), time }
    }

    /// Whether numbers in formulas have units.
    pub fn has_units(&self) -> bool {
        self.time.is_some()
    }

    /// The formula of a number. `unit`: that of a number that stands alone, or of several, where nothing else says it.
    pub fn number(&self, expr: &Expr, unit: Option<&str>) -> Element {
        let unit = unit.filter(|_| is_bare(expr)).or(Some("dimensionless")).filter(|_| self.time.is_some());
        self.math(Writer { formulas: self, unit }.value(expr))
    }

    /// The formula of a condition.
    pub fn condition(&self, expr: &Expr) -> Element {
        self.math(self.plain_writer().truth(expr))
    }

    /// The formula of what happens in the whole compartment, where an expression says it for a litre.
    pub fn in_compartment(&self, expr: &Expr) -> Element {
        self.math(apply("times", vec![ci(&self.compartment), self.plain_writer().value(expr)]))
    }

    /// The definitions of the functions that formulas have used.
    pub fn functions(&self) -> Vec<Element> {
        let writer = self.plain_writer();
        let used = Helper::ALL.into_iter().zip(self.used.get()).zip(&self.helpers).filter(|((_, used), _)| *used);
        let definition = |((helper, _), id): ((Helper, bool), &String)| {
            let lambda = helper.lambda(&|value| writer.plain(value), writer.cn(0.0));
            Element::new("functionDefinition").with("id", id).child(self.math(lambda))
        };
        used.map(definition).collect()
    }

    /// A formula as SBML holds it.
    fn math(&self, formula: Element) -> Element {
        let math = Element::new("math").with("xmlns", "http://www.w3.org/1998/Math/MathML");
        math.with_some("xmlns:sbml", self.time.as_ref().map(|_| NAMESPACE)).child(formula)
    }

    fn plain_writer(&self) -> Writer<'_> {
        Writer { formulas: self, unit: Some("dimensionless").filter(|_| self.time.is_some()) }
    }
}

struct Writer<'a> {
    formulas: &'a Formulas,
    /// The unit of numbers.
    unit: Option<&'a str>,
}

impl Writer<'_> {
    /// The element of a value; a condition is 1 or 0.
    fn value(&self, expr: &Expr) -> Element {
        match expr {
            Expr::Number(value) => self.cn(*value),
            Expr::Time => csymbol("time"),
            Expr::Quantity(number) => self.quantity(*number),
            _ if is_truth(expr) => piecewise(vec![(self.plain(1.0), self.truth(expr))], self.plain(0.0)),
            Expr::Unary(function, a) => self.function(*function, a),
            Expr::Binary(function, a, b) => self.operator(*function, a, b),
            Expr::Piecewise { branches, otherwise } if branches.is_empty() => self.value(otherwise),
            Expr::Piecewise { branches, otherwise } => {
                let pieces = branches.iter().map(|(condition, value)| (self.value(value), self.truth(condition)));
                piecewise(pieces.collect(), self.value(otherwise))
            }
            // Rules of unknowns are written as the equations that determine them.
            Expr::Root(equations, index) => self.quantity(equations.unknowns[*index as usize]),
            Expr::Delay(past, delay) => {
                // A bare number is in the unit of time.
                let time = self.formulas.time.as_deref().filter(|_| is_bare(delay));
                let ago = Writer { unit: time.or(self.unit), ..*self }.value(delay);
                Element::compact("apply").child(csymbol("delay")).child(self.value(past)).child(ago)
            }
        }
    }

    /// The element of a condition. A number is true where it is not 0.
    fn truth(&self, expr: &Expr) -> Element {
        match expr {
            Expr::Number(value) => Element::compact(if *value == 0.0 { "false" } else { "true" }),
            Expr::Unary(Unary::Not, a) => apply("not", vec![self.truth(a)]),
            Expr::Binary(function, a, b) => match function {
                Binary::And | Binary::Or | Binary::Xor => {
                    let parts = spine(*function, expr).into_iter().map(|part| self.truth(part));
                    apply(operator_name(*function), parts.collect())
                }
                function if is_comparison(*function) => {
                    apply(operator_name(*function), vec![self.value(a), self.compared(b, a)])
                }
                _ => self.not_zero(expr),
            },
            _ => self.not_zero(expr),
        }
    }

    /// The element of what is compared with another value: a number that is compared with the time is one.
    fn compared(&self, expr: &Expr, with: &Expr) -> Element {
        match (expr, with) {
            (Expr::Number(value), Expr::Time) => Writer { unit: self.formulas.time.as_deref(), ..*self }.plain(*value),
            _ => self.value(expr),
        }
    }

    fn not_zero(&self, expr: &Expr) -> Element {
        apply("neq", vec![self.value(expr), self.cn(0.0)])
    }

    fn quantity(&self, number: QuantityId) -> Element {
        let name = ci(&self.formulas.quantities[number as usize]);
        match self.formulas.dense[number as usize] {
            true => apply("divide", vec![name, ci(&self.formulas.compartment)]),
            false => name,
        }
    }

    /// A call of a function that the model defines.
    fn call(&self, helper: Helper, arguments: &[&Expr]) -> Element {
        let mut used = self.formulas.used.get();
        used[helper as usize] = true;
        self.formulas.used.set(used);
        let arguments = arguments.iter().map(|argument| self.value(argument));
        Element::compact("apply").child(ci(&self.formulas.helpers[helper as usize])).children(arguments)
    }

    fn function(&self, function: Unary, a: &Expr) -> Element {
        let name = match function {
            Unary::Sign => return self.call(Helper::Sign, &[a]),
            Unary::Heaviside => return self.call(Helper::Heaviside, &[a]),
            Unary::Sqrt => "root",
            Unary::Log10 => {
                let base = Element::compact("logbase").child(whole(10.0));
                return Element::compact("apply").child(Element::compact("log")).child(base).child(self.value(a));
            }
            Unary::Factorial => return self.factorial(a),
            Unary::Neg => "minus",
            // Conditions have been written as such.
            Unary::Not => "not",
            Unary::Abs => "abs",
            Unary::Floor => "floor",
            Unary::Ceil => "ceiling",
            Unary::Exp => "exp",
            Unary::Ln => "ln",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "arcsin",
            Unary::Acos => "arccos",
            Unary::Atan => "arctan",
            Unary::Sinh => "sinh",
            Unary::Cosh => "cosh",
            Unary::Tanh => "tanh",
            Unary::Asinh => "arcsinh",
            Unary::Acosh => "arccosh",
            Unary::Atanh => "arctanh",
        };
        apply(name, vec![self.value(a)])
    }

    /// MathML has factorials of whole numbers only, EML that of the nearest one, from 0 on.
    fn factorial(&self, a: &Expr) -> Element {
        let is_whole = match a {
            Expr::Number(value) => *value >= 0.0 && value.fract() == 0.0,
            Expr::Unary(Unary::Floor | Unary::Ceil, _) => true,
            _ => false,
        };
        if is_whole {
            return apply("factorial", vec![self.value(a)]);
        }
        let half = apply("plus", vec![self.value(a), self.cn(0.5)]);
        apply("factorial", vec![apply("max", vec![apply("floor", vec![half]), self.cn(0.0)])])
    }

    fn operator(&self, function: Binary, a: &Expr, b: &Expr) -> Element {
        let values = |parts: Vec<&Expr>| parts.into_iter().map(|part| self.value(part)).collect::<Vec<_>>();
        match function {
            Binary::Add | Binary::Sub => self.sum(function, a, b),
            Binary::Mul | Binary::Min | Binary::Max => {
                let mut parts = spine(function, a);
                parts.push(b);
                apply(operator_name(function), values(parts))
            }
            // That of MathML is cut towards zero.
            Binary::Quotient => apply("floor", vec![apply("divide", values(vec![a, b]))]),
            Binary::Div => match hill(a, b) {
                Some((x, half, exponent)) => self.call(Helper::Hill, &[x, half, exponent]),
                None => apply("divide", values(vec![a, b])),
            },
            _ => apply(operator_name(function), values(vec![a, b])),
        }
    }

    /// A sum: of more than two terms with one `<plus/>`, so that long ones do not nest.
    fn sum(&self, function: Binary, a: &Expr, b: &Expr) -> Element {
        let mut terms = vec![(b, function == Binary::Sub)];
        let mut first = a;
        while let Expr::Binary(function @ (Binary::Add | Binary::Sub), left, right) = first {
            terms.push((right, *function == Binary::Sub));
            first = left;
        }
        // A plain 0 says nothing, and is in no unit.
        terms.retain(|(term, _)| **term != Expr::Number(0.0));
        if terms.is_empty() {
            return self.value(first);
        }
        if let [(last, negative)] = terms[..] {
            let name = if negative { "minus" } else { "plus" };
            return apply(name, vec![self.value(first), self.value(last)]);
        }
        terms.push((first, false));
        let term = |(term, negative): (&Expr, bool)| match negative {
            true => apply("minus", vec![self.value(term)]),
            false => self.value(term),
        };
        apply("plus", terms.into_iter().rev().map(term).collect())
    }

    /// A number. What is 0 or infinite fits every unit and says none.
    fn cn(&self, value: f64) -> Element {
        if value == 0.0 { whole(value) } else { self.plain(value) }
    }

    /// A number in the unit of numbers.
    fn plain(&self, value: f64) -> Element {
        let element = match value {
            value if value.is_nan() => return Element::compact("notanumber"),
            f64::INFINITY => return Element::compact("infinity"),
            f64::NEG_INFINITY => return apply("minus", vec![Element::compact("infinity")]),
            std::f64::consts::PI => return Element::compact("pi"),
            std::f64::consts::E => return Element::compact("exponentiale"),
            value if value.fract() == 0.0 && value.abs() < LARGEST_WHOLE => whole(value),
            value if (1e-4..1e15).contains(&value.abs()) => Element::compact("cn").text(format!(" {value} ")),
            value => {
                let text = format!("{value:e}");
                let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
                let digits = Element::compact("cn").with("type", "e-notation").text(format!(" {digits} "));
                digits.child(Element::compact("sep")).tail(format!(" {power} "))
            }
        };
        element.with_some("sbml:units", self.unit)
    }
}

fn whole(value: f64) -> Element {
    Element::compact("cn").with("type", "integer").text(format!(" {value} "))
}

fn csymbol(name: &'static str) -> Element {
    Element::compact("csymbol")
        .with("encoding", "text")
        .with("definitionURL", format!("http://www.sbml.org/sbml/symbols/{name}"))
        .text(format!(" {name} "))
}
