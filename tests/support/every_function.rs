//! Systems in which every function of the tree occurs.
#![allow(dead_code)]

use pseudopod::equations::tree::{Binary, Expr, Quantity, Role, System, Unary};

pub fn quantity(id: &str, role: Role, initial: f64) -> Quantity {
    Quantity { id: id.into(), name: String::new(), role, initial: Expr::Number(initial), unit: String::new() }
}

pub fn unary(function: Unary, a: Expr) -> Expr {
    Expr::Unary(function, Box::new(a))
}

pub fn binary(function: Binary, a: Expr, b: Expr) -> Expr {
    Expr::Binary(function, Box::new(a), Box::new(b))
}

/// A system of two variables whose rates are two expressions of quantities 0 and 1, with an input and a parameter.
pub fn system(first: Expr, second: Expr) -> System {
    let quantities = vec![
        quantity("x", Role::Variable { rate: first }, 0.3),
        quantity("y", Role::Variable { rate: second }, 0.7),
        quantity("given", Role::Input, 1.5),
        quantity("k", Role::Parameter, 0.25),
        quantity("sum", Role::Defined { rule: binary(Binary::Add, Expr::Quantity(0), Expr::Quantity(1)) }, 0.0),
    ];
    System { name: "test".into(), quantities, ..System::default() }
}

/// Every function of the tree, alone.
pub fn functions() -> Vec<Expr> {
    let (x, y) = (|| Expr::Quantity(0), || Expr::Quantity(1));
    let mut all: Vec<Expr> = Unary::ALL.iter().map(|&function| unary(function, x())).collect();
    all.extend(Binary::ALL.iter().map(|&function| binary(function, x(), y())));
    for exponent in [-3.0, -1.0, 0.0, 0.5, 1.0, 2.0, 7.0, 16.0, 17.0, 2.5] {
        all.push(binary(Binary::Pow, x(), Expr::Number(exponent)));
        all.push(binary(Binary::Pow, Expr::Number(exponent.abs() + 0.5), x()));
    }
    // acosh lives above 1; piecewise in a nest; definitions, inputs, parameters and time.
    all.push(unary(Unary::Acosh, binary(Binary::Add, Expr::Number(1.5), x())));
    let below = |value| binary(Binary::Lt, x(), Expr::Number(value));
    let square = binary(Binary::Mul, x(), x());
    let inner = Expr::Piecewise { branches: vec![(below(0.6), square)], otherwise: Box::new(unary(Unary::Exp, x())) };
    all.push(Expr::Piecewise { branches: vec![(below(0.2), y()), (below(1.2), inner)], otherwise: Box::new(x()) });
    let sum = binary(Binary::Mul, Expr::Quantity(4), Expr::Quantity(2));
    all.push(binary(Binary::Add, sum, binary(Binary::Mul, Expr::Quantity(3), unary(Unary::Sin, Expr::Time))));
    all
}

pub const POINTS: [(f64, f64); 7] =
    [(0.31, 0.72), (0.55, 2.3), (1.7, 0.41), (-0.45, 1.3), (2.6, -1.2), (0.05, 0.9), (0.93, 3.6)];
