//! What expressions promise: precedence, locations of faults, writing them as text, units.

use super::*;
use crate::equations::tree::{Binary, Expr, Unary};
use proptest::prelude::*;
use std::collections::HashMap;

fn scope() -> Scope {
    let names = [("x", 0), ("y", 1), ("K", 2)].map(|(name, number)| (name.to_owned(), number));
    let mut scope = Scope { quantities: names.into(), ..Scope::default() };
    let arguments = vec!["a".to_owned(), "b".to_owned()];
    let raised = Function { arguments: vec!["a".to_owned(), "n".to_owned()], body: parse("a^n").0 };
    scope.functions.insert("raised".to_owned(), raised);
    scope.functions.insert("mix".to_owned(), Function { arguments, body: parse("a + 2*b").0 });
    scope
}

fn name(number: u32) -> String {
    ["x", "y", "K"][number as usize].to_owned()
}

/// The expression, or all troubles of reading and resolving.
fn read(text: &str) -> Result<Expr, Vec<Trouble>> {
    let (node, mut troubles) = parse(text);
    match scope().resolve(&node) {
        Ok(expr) if troubles.is_empty() => Ok(expr),
        Ok(_) => Err(troubles),
        Err(more) => {
            troubles.extend(more);
            troubles.sort_by_key(|trouble| trouble.at.start);
            Err(troubles)
        }
    }
}

fn value(text: &str) -> f64 {
    let expr = read(text).unwrap_or_else(|troubles| panic!("{text}: {troubles:?}"));
    expr.evaluate(5.0, &|number| [2.0, 3.0, 7.0][number as usize])
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("8 - 3 - 2", 3.0),
        ("8/4/2", 1.0),
        ("2^3^2", 512.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("(1 + 2)*3", 9.0),
        ("-x*y", -6.0),
        ("2*-x", -4.0),
        ("not x == 2", 0.0),
        ("x < y and y < K", 1.0),
        ("x > y or K > y", 1.0),
        ("1 or 1 xor 1", 0.0),
        ("x lt y", 1.0),
        ("x ≤ 2 && y != 2", 1.0),
        ("!0", 1.0),
        ("min(x, y, K)", 2.0),
        ("log(x, 8)", 3.0),
        ("hill(x, 2, 9)", 0.5),
        ("time", 5.0),
        ("mix(x, y)", 8.0),
        ("piecewise(1, x > 2, 4, x == 2, 9)", 4.0),
        ("2 [uM]*3", 6.0),
        ("1e3 + .5", 1000.5),
        ("+x", 2.0),
        ("mix(mix(1, 2), 3)", 11.0),
        ("rem(-7, 3)", -1.0),
        ("quotient(-7, 3)", -3.0),
        ("--x", 2.0),
        ("2·x", 4.0),
    ] {
        assert!((value(text) - expected).abs() < 1e-14, "{text} is {} and not {expected}", value(text));
    }
}

#[test]
fn every_fault_of_an_expression_is_told_at_its_location() {
    for (text, expected) in [
        ("(x + 1", &[(0..1, "the parenthesis is not closed")][..]),
        ("x + 1)", &[(5..6, "never opened")]),
        ("exp(x", &[(3..4, "the parenthesis of `exp` is not closed")]),
        ("x +", &[(3..3, "an operand is missing")]),
        ("x + * y", &[(4..5, "an operand is missing")]),
        ("2 x", &[(2..3, "an operator is missing")]),
        ("exp(x, y)", &[(0..3, "`exp` cannot take 2 arguments")]),
        ("mix(x)", &[(0..3, "`mix` cannot take 1 argument")]),
        ("piecewise(1, x)", &[(0..9, "cannot take 2 arguments")]),
        ("tanh()", &[(0..4, "cannot take no argument")]),
        ("z + tanhh(y) + k", &[(0..1, "`z`"), (4..9, "`tanhh`"), (15..16, "`k`")]),
        ("x = 3", &[(2..3, "`=` is no sign")]),
        ("x ** 3", &[(2..4, "`**` is no sign")]),
        ("1 < x < 3", &[(6..7, "a comparison of a comparison")]),
        ("x # 3", &[(2..3, "`#` cannot stand"), (4..5, "an operator is missing")]),
        ("1e999*x", &[(0..5, "not finite")]),
        ("1.2.3", &[(0..5, "is not a number")]),
        ("1,5", &[(1..2, "a comma outside a function"), (2..3, "an operator is missing")]),
        ("", &[(0..0, "empty")]),
        ("((x) + (y * (", &[(0..1, "not closed"), (7..8, "not closed"), (12..13, "not closed"), (13..13, "missing")]),
        ("x(3)", &[(0..1, "`x` is not a function")]),
        ("exp + 1", &[(0..3, "nothing has the identifier `exp`")]),
        ("3 [uM", &[(2..3, "the bracket of a unit"), (3..5, "an operator is missing"), (3..5, "`uM`")]),
    ] {
        let troubles = read(text).expect_err(text);
        let found: Vec<_> = troubles.iter().map(|trouble| (trouble.at.clone(), trouble.message.as_str())).collect();
        assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
        for ((at, message), (location, part)) in found.iter().zip(expected) {
            assert!(at == location && message.contains(part), "{text}: {at:?} {message}");
        }
        assert!(troubles.iter().all(|trouble| !trouble.help.is_empty()), "{text}");
    }
    assert_eq!(read("tanhh(x)").expect_err("a slip")[0].help, "did you mean `tanh`?");
    assert_eq!(read("k").expect_err("a slip")[0].help, "did you mean `K`?");
}

#[test]
fn a_deep_or_growing_expression_is_refused_and_not_followed() {
    let deep = format!("{}x{}", "(".repeat(40_000), ")".repeat(40_000));
    assert!(read(&deep).expect_err("deep")[0].message.contains("levels"));
    let row = format!("x{}", "+x".repeat(5_000));
    assert!(read(&row).expect_err("a long row")[0].message.contains("levels"));
    let long = " x".repeat(LONGEST);
    assert!(read(&long).expect_err("long")[0].message.contains("bytes"));
    // Forty functions, each of which calls the one before twice.
    let mut scope = scope();
    scope.functions.insert("f0".into(), Function { arguments: vec!["a".into()], body: parse("a + a").0 });
    for level in 1..40 {
        let body = parse(&format!("f{0}(a) + f{0}(a)", level - 1)).0;
        scope.functions.insert(format!("f{level}"), Function { arguments: vec!["a".into()], body });
    }
    let troubles = scope.resolve(&parse("f39(x)").0).expect_err("2^40 parts");
    assert!(troubles[0].message.contains("too large"), "{troubles:?}");
    // Arguments in arguments of a function that puts them deep.
    let deep = format!("{}a{}", "sin(".repeat(300), ")".repeat(300));
    scope.functions.insert("g".into(), Function { arguments: vec!["a".into()], body: parse(&deep).0 });
    let nested = format!("{}x{}", "g(".repeat(300), ")".repeat(300));
    assert!(scope.resolve(&parse(&nested).0).is_err());
}

fn any_expr() -> impl Strategy<Value = Expr> {
    let number = prop_oneof![any::<f64>().prop_filter("finite", |v| v.is_finite()), (-9i32..9).prop_map(f64::from)];
    let leaf = prop_oneof![number.prop_map(Expr::Number), Just(Expr::Time), (0u32..3).prop_map(Expr::Quantity)];
    leaf.prop_recursive(5, 40, 3, |inner| {
        prop_oneof![
            (prop::sample::select(&Unary::ALL[..]), inner.clone()).prop_map(|(f, a)| a.unary(f)),
            (prop::sample::select(&Binary::ALL[..]), inner.clone(), inner.clone()).prop_map(|(f, a, b)| a.binary(f, b)),
            (prop::collection::vec((inner.clone(), inner.clone()), 1..3), inner)
                .prop_map(|(branches, otherwise)| Expr::Piecewise { branches, otherwise: Box::new(otherwise) }),
        ]
    })
}

proptest! {
    #[test]
    fn an_expression_is_read_back_from_its_text(expr in any_expr()) {
        let text = write(&expr, &name);
        let back = read(&text);
        prop_assert_eq!(back.as_ref(), Ok(&expr), "{}", text);
    }

    #[test]
    fn any_text_is_read_or_refused_within_its_bounds(text in "[xyK0-9eE.+*/^()<>=!,\\[\\] a-d-]{0,40}|\\PC{0,20}") {
        let (node, troubles) = parse(&text);
        let more = scope().resolve(&node).err().unwrap_or_default();
        for trouble in troubles.iter().chain(&more) {
            prop_assert!(text.get(trouble.at.clone()).is_some(), "{:?} in {:?}", trouble, text);
        }
        prop_assert!(text.get(node.at.clone()).is_some(), "{:?} in {:?}", node.at, text);
        // A tree with an unread part is never returned in silence.
        prop_assert!(!troubles.is_empty() || !format!("{node:?}").contains("Unread"), "{:?}", text);
    }
}

/// The troubles of an expression over x in µM, y in µM/s and K in s, which should be in `unit`.
fn unit_troubles(text: &str, unit: &str) -> Vec<Trouble> {
    let read = |unit: &str| Unit::read(unit).expect(unit);
    let units =
        HashMap::from([("x", "uM"), ("y", "uM/s"), ("K", "s")].map(|(name, unit)| (name.to_owned(), read(unit))));
    let (scope, time) = (scope(), read("s"));
    let mut troubles = Vec::new();
    let units = UnitScope { units: &units, scope: &scope, time: Some(&time) };
    units.expect(&parse(text).0, &read(unit), "the value", &mut troubles);
    troubles
}

#[test]
fn right_units_pass() {
    for (text, unit) in [
        ("x + K*y", "uM"),
        ("x/K - y", "uM/s"),
        ("0.5*x + 0", "uM"),
        ("exp(-time/K)", "1"),
        ("sqrt(x*x)", "uM"),
        ("hill(x, 2 [uM], 4)", "1"),
        ("(x/1 [uM])^2.5", "1"),
        ("x^2/x", "uM"),
        ("mix(x, K*y)", "uM"),
        ("x/x", "1"),
        ("piecewise(x, K > 0, 0)", "uM"),
        ("min(x, infinity)", "uM"),
        ("x*y", "uM^2/s"),
        ("1000 [nM]", "nM"),
        ("60 [s/min]*y", "uM/min"),
        ("sin(90 [rad]) + cos(1)", "1"),
        ("0", "uM"),
        ("x*60 [1/min]", "zmol/(um^3 min)"),
        ("x^(K/1 [s])/((2 [uM])^(K/1 [s]) + x^(K/1 [s]))", "1"),
        ("y*x^-(K/1 [s])*x^(K/1 [s])", "uM/s"),
        ("(x^(2*exp(1)) - (x^exp(1))^2)^0.5/x^exp(1)", "1"),
        ("raised(x, exp(1))/x^exp(1)", "1"),
        ("20 [pS]*-70 [mV]/10 [pF]", "fA/pF"),
        ("1 [kg m^2/s^3]/1 [A]", "V"),
    ] {
        assert_eq!(unit_troubles(text, unit), [], "{text}");
    }
}

#[test]
fn wrong_units_are_told_at_the_part_that_has_them() {
    for (text, unit, at, told) in [
        ("x + y", "uM", 4..5, "this part is in uM/s; uM was expected"),
        ("x*K", "uM", 0..3, "the value is in uM s; uM was expected"),
        ("exp(x)", "1", 4..5, "the argument of `exp` is in uM; a plain number was expected"),
        ("x^y", "uM", 2..3, "the exponent is in uM/s"),
        ("1 + x", "uM", 4..5, "this part is in uM; a plain number was expected"),
        ("x < K", "1", 4..5, "this part is in s; uM was expected"),
        ("y", "uM/min", 0..1, "the value is in uM/s; uM/min was expected"),
        ("mix(x, y)", "uM", 0..9, "in `mix`, called here, this part is in uM/s; uM was expected"),
        ("3 [uMM]", "uM", 0..7, "unknown unit"),
        ("x^exp(1) + x^exp(2)", "1", 11..19, "this part is in uM^(exp(2)); uM^(exp(1)) was expected"),
        ("x + x^(2*exp(2))", "uM", 4..16, "this part is in uM^(2*exp(2)); uM was expected"),
        ("raised(x, exp(1)) - raised(x, exp(2))", "1", 20..37, "this part is in uM^(exp(2)); uM^(exp(1)) was expected"),
    ] {
        let troubles = unit_troubles(text, unit);
        assert!(troubles.len() == 1 && troubles[0].at == at, "{text}: {troubles:?}");
        assert!(troubles[0].message.contains(told), "{text}: {}", troubles[0].message);
    }
    assert_eq!(unit_troubles("y", "uM/min")[0].help, "both measure the same; multiply by `60 [s/min]`");
}
