//! Problems with known answers, for the tests and benches of the ODE engine.
#![allow(dead_code)]

use std::collections::HashMap;

use pseudopod::equations::tree::{Binary, Expr, Quantity, QuantityId, Role, System, Unary};

/// A quantity with an initial value.
pub fn quantity(id: &str, role: Role, initial: f64) -> Quantity {
    Quantity { id: id.into(), name: String::new(), role, initial: Expr::Number(initial), unit: String::new() }
}

/// A system from variables (name, initial value, rate) and parameters (name, value).
pub fn system(name: &str, variables: &[(&str, f64, &str)], parameters: &[(&str, f64)]) -> System {
    let ids = variables.iter().map(|v| v.0).chain(parameters.iter().map(|p| p.0));
    let numbers: HashMap<String, QuantityId> = ids.enumerate().map(|(n, id)| (id.to_string(), n as u32)).collect();
    let mut quantities: Vec<Quantity> = variables
        .iter()
        .map(|(id, initial, rate)| quantity(id, Role::Variable { rate: expression(rate, &numbers) }, *initial))
        .collect();
    quantities.extend(parameters.iter().map(|(id, value)| quantity(id, Role::Parameter, *value)));
    System { name: name.into(), quantities, ..System::default() }
}

/// An expression of + − * / ^, numbers, names, `t`, and exp, ln, sin, cos.
pub fn expression(text: &str, numbers: &HashMap<String, QuantityId>) -> Expr {
    let mut reader = Reader { rest: text, numbers };
    let expression = reader.sum();
    assert!(reader.rest.trim().is_empty(), "'{}' is left of '{text}'", reader.rest);
    expression
}

struct Reader<'a> {
    rest: &'a str,
    numbers: &'a HashMap<String, QuantityId>,
}

fn binary(function: Binary, a: Expr, b: Expr) -> Expr {
    Expr::Binary(function, Box::new(a), Box::new(b))
}

impl Reader<'_> {
    fn take(&mut self, signs: &[char]) -> Option<char> {
        self.rest = self.rest.trim_start();
        let sign = self.rest.chars().next().filter(|sign| signs.contains(sign))?;
        self.rest = &self.rest[sign.len_utf8()..];
        Some(sign)
    }

    fn sum(&mut self) -> Expr {
        let mut left = self.product();
        while let Some(sign) = self.take(&['+', '-']) {
            let right = self.product();
            left = binary(if sign == '+' { Binary::Add } else { Binary::Sub }, left, right);
        }
        left
    }

    fn product(&mut self) -> Expr {
        let mut left = self.sign();
        while let Some(sign) = self.take(&['*', '/']) {
            let right = self.sign();
            left = binary(if sign == '*' { Binary::Mul } else { Binary::Div }, left, right);
        }
        left
    }

    fn sign(&mut self) -> Expr {
        if self.take(&['-']).is_some() { Expr::Unary(Unary::Neg, Box::new(self.sign())) } else { self.power() }
    }

    fn power(&mut self) -> Expr {
        let base = self.atom();
        if self.take(&['^']).is_some() { binary(Binary::Pow, base, self.sign()) } else { base }
    }

    fn atom(&mut self) -> Expr {
        if self.take(&['(']).is_some() {
            let inside = self.sum();
            self.take(&[')']).expect("a closing parenthesis");
            return inside;
        }
        let word = |sign: char| sign.is_alphanumeric() || sign == '.' || sign == '_';
        let length = self.rest.find(|sign| !word(sign)).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(length);
        self.rest = rest;
        if let Ok(number) = name.parse::<f64>() {
            return Expr::Number(number);
        }
        let function = match name {
            "t" => return Expr::Time,
            "exp" => Unary::Exp,
            "ln" => Unary::Ln,
            "sqrt" => Unary::Sqrt,
            "sin" => Unary::Sin,
            "cos" => Unary::Cos,
            _ => return Expr::Quantity(*self.numbers.get(name).unwrap_or_else(|| panic!("unknown name '{name}'"))),
        };
        Expr::Unary(function, Box::new(self.atom()))
    }
}

/// Two coupled van der Pol oscillators.
pub fn van_der_pol_pair(stiffness: f64) -> System {
    let variables =
        [("x", 2.0, "y"), ("y", 0.0, "mu*(1-x^2)*y-x+k*(u-x)"), ("u", 1.0, "v"), ("v", 0.5, "mu*(1-u^2)*v-u+k*(x-u)")];
    system("van der Pol pair", &variables, &[("mu", stiffness), ("k", 0.1)])
}

/// The three variables of Martiel and Goldbeter (Biophys. J. 52, 1987) with the parameters of the reference run.
pub fn martiel_goldbeter() -> System {
    let sum = "(k1+k2*gamma)/(1+gamma)";
    let other = "(k1*L1+k2*L2*c*gamma)/(1+c*gamma)";
    let bound = "(rho*gamma/(1+gamma))^2";
    let rho = format!("-({sum})*rho+({other})*(1-rho)");
    let cyclase = format!("al*(lam*th+eps*{bound})/(1+al*th+eps*{bound}*(1+al))");
    let beta = format!("q*sig*{cyclase}-(ki+kt)*beta");
    let variables = [("rho", 0.8, rho.as_str()), ("beta", 0.5, beta.as_str()), ("gamma", 0.1, "kt*beta/h-ke*gamma")];
    let parameters = [
        ("k1", 0.036),
        ("k2", 0.666),
        ("L1", 10.0),
        ("L2", 0.005),
        ("c", 10.0),
        ("al", 3.0),
        ("lam", 0.01),
        ("th", 0.01),
        ("eps", 1.0),
        ("q", 4000.0),
        ("sig", 0.6),
        ("ki", 1.7),
        ("kt", 0.9),
        ("ke", 5.4),
        ("h", 5.0),
    ];
    system("Martiel–Goldbeter", &variables, &parameters)
}

/// The five variables of Goldbeter's PER oscillator of the fruit fly (Proc. R. Soc. Lond. B 261, 1995, 319–324), in µM and
/// hours, with the parameters of its figure 2: the period is close to 24 h.
pub fn goldbeter_per() -> System {
    let (there1, back1) = ("V1*P0/(K1+P0)", "V2*P1/(K1+P1)");
    let (there2, back2) = ("V3*P1/(K1+P1)", "V4*P2/(K1+P2)");
    let m = "vs*KI^4/(KI^4+PN^4)-vm*M/(Km+M)";
    let p0 = format!("ks*M-{there1}+{back1}");
    let p1 = format!("{there1}-{back1}-{there2}+{back2}");
    let p2 = format!("{there2}-{back2}-k1*P2+k2*PN-vd*P2/(Kd+P2)");
    let variables = [("M", 0.6, m), ("P0", 0.5, &p0), ("P1", 0.6, &p1), ("P2", 0.6, &p2), ("PN", 1.1, "k1*P2-k2*PN")];
    let parameters = [
        ("vs", 0.76),
        ("vm", 0.65),
        ("Km", 0.5),
        ("ks", 0.38),
        ("vd", 0.95),
        ("k1", 1.9),
        ("k2", 1.3),
        ("KI", 1.0),
        ("Kd", 0.2),
        ("K1", 2.0),
        ("V1", 3.2),
        ("V2", 1.58),
        ("V3", 5.0),
        ("V4", 2.5),
    ];
    system("Goldbeter PER", &variables, &parameters)
}
