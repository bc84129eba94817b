//! The compiled programs against the plain evaluation of the tree, and their derivatives against differences.

use crate::every_function::{POINTS, binary, functions, system, unary};
use pseudopod::equations::program::{Program, initial_values, run};
use pseudopod::equations::tree::{Binary, Expr, Unary};

#[test]
fn programs_give_what_the_tree_gives() {
    for expression in functions() {
        let system = system(expression.clone(), binary(Binary::Mul, expression.clone(), Expr::Quantity(1)));
        let program = Program::new(&system).expect("no circles");
        let mut file = program.file::<8>();
        for time in [0.0, 2.5] {
            for (lane, &(x, y)) in POINTS.iter().enumerate() {
                (file[0][lane], file[1][lane], file[2][lane]) = (time, x, y);
            }
            run(&program.rates, &mut file);
            for (lane, &(x, y)) in POINTS.iter().enumerate() {
                let wanted = expression.evaluate(time, &|number| [x, y, 1.5, 0.25, x + y][number as usize]);
                let found = file[program.rates.outputs[0] as usize][lane];
                // Products in place of whole powers differ by half a unit in the last place a factor.
                let close = (found - wanted).abs() <= 2e-15 * wanted.abs() || (found.is_nan() && wanted.is_nan());
                assert!(close || found == wanted, "{expression:?} at {x}, {y}: {found} instead of {wanted}");
            }
        }
    }
}

#[test]
fn derivatives_agree_with_differences() {
    for expression in functions() {
        let system = system(expression.clone(), binary(Binary::Sub, expression.clone(), Expr::Time));
        let program = Program::new(&system).expect("no circles");
        let mut file = program.file::<8>();
        for (lane, &(x, y)) in POINTS.iter().enumerate() {
            (file[0][lane], file[1][lane], file[2][lane]) = (0.4, x, y);
        }
        run(&program.linear, &mut file);
        let output = |number: usize, lane: usize| file[program.linear.outputs[number] as usize][lane];
        for (lane, &(x, y)) in POINTS.iter().enumerate() {
            let value =
                |t: f64, x: f64, y: f64| expression.evaluate(t, &|number| [x, y, 1.5, 0.25, x + y][number as usize]);
            if !value(0.4, x, y).is_finite() {
                continue;
            }
            let (h, mut wanted) = (1e-5, [0.0; 2]);
            wanted[0] = (value(0.4, x + h, y) - value(0.4, x - h, y)) / (2.0 * h);
            wanted[1] = (value(0.4, x, y + h) - value(0.4, x, y - h)) / (2.0 * h);
            for column in 0..2 {
                let at = program.pattern.iter().position(|&entry| entry == (0, column));
                let found = at.map_or(0.0, |at| output(4 + at, lane));
                // Central differences of step 1e-5: 1e-10 of truncation, 1e-11 of round-off, both times the size.
                let size = 1.0 + value(0.4, x, y).abs() + wanted[column as usize].abs();
                let error = (found - wanted[column as usize]).abs();
                let both_nan = found.is_nan() && wanted[column as usize].is_nan();
                assert!(error < 1e-6 * size || both_nan, "{expression:?} at {x}, {y} by {column}: {found} {wanted:?}");
            }
            let by_time = (value(0.4 + h, x, y) - value(0.4 - h, x, y)) / (2.0 * h);
            assert!((output(2, lane) - by_time).abs() < 1e-8, "{expression:?} by time");
            assert!((output(3, lane) - by_time + 1.0).abs() < 1e-8, "{expression:?} by time");
        }
    }
}

#[test]
fn what_occurs_twice_is_worked_out_once() {
    let shared = || unary(Unary::Exp, binary(Binary::Mul, Expr::Quantity(0), Expr::Quantity(3)));
    let system = system(binary(Binary::Add, shared(), shared()), shared());
    let program = Program::new(&system).expect("no circles");
    assert_eq!(program.rates.ops.len(), 3, "a product, an exponential and a sum: {:?}", program.rates.ops);
    let folded = binary(Binary::Mul, Expr::Number(2.0), unary(Unary::Sqrt, Expr::Quantity(3)));
    let program = Program::new(&self::system(folded, Expr::Number(0.0))).expect("no circles");
    assert!(program.rates.ops.is_empty(), "constants are folded: {:?}", program.rates.ops);
}

#[test]
fn initial_values_follow_each_other_in_any_order_and_circles_are_named() {
    let mut system = system(Expr::Number(0.0), Expr::Number(0.0));
    system.quantities[0].initial = binary(Binary::Mul, Expr::Number(2.0), Expr::Quantity(1));
    system.quantities[1].initial = Expr::Quantity(3);
    assert_eq!(initial_values(&system, 0.0), Ok(vec![0.5, 0.25, 1.5, 0.25, 0.75]));
    system.quantities[3].initial = Expr::Quantity(4);
    let circle = initial_values(&system, 0.0).expect_err("k needs the sum, the sum needs x, x needs k");
    assert!(circle.contains(&"k".to_string()) && circle.contains(&"sum".to_string()), "{circle:?}");
}
