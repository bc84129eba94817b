//! The functions that draw numbers where a system starts.

use crate::equations::expression::{Node, Scope, Trouble};

/// The functions, and what their two arguments are.
pub const DRAWS: [(&str, &str); 3] = [
    ("uniform", "the least and the largest value"),
    ("normal", "the mean and the standard deviation"),
    ("lognormal", "the median and the standard deviation of the logarithm"),
];

/// Whether a call draws a number: a function of the document may have the same name.
pub fn is_draw(name: &str, scope: &Scope) -> bool {
    DRAWS.iter().any(|(known, _)| *known == name) && !scope.functions.contains_key(name)
}

/// A fault where a number is drawn that may not be.
pub fn misplaced(node: &Node, scope: &Scope) -> Option<Trouble> {
    let (name, at) = node.calls().into_iter().find(|(name, _)| is_draw(name, scope))?;
    let help = "write it in the `initial` of a <variable>; one with rate=\"0\" keeps what was drawn";
    Some(
        Trouble::new(format!("`{name}` draws a number where a system starts"), at).label("not at the start").help(help),
    )
}
