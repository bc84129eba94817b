//! Identifiers of a system as SBML may write them: ASCII letters, digits and `_`, each given once in the whole model.

use crate::equations::tree::System;
use std::collections::HashSet;

/// Names of Greek letters, from α to ω, with the final ς.
const GREEK: [&str; 25] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu", "xi",
    "omicron", "pi", "rho", "sigma", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega",
];

/// What the things of a system are called in a model.
pub struct Names {
    taken: HashSet<String>,
    /// Of each quantity.
    pub quantities: Vec<String>,
    /// Of each event; empty for one whose identifier is made from its index.
    pub events: Vec<String>,
    /// What is called otherwise, one sentence each.
    pub notices: Vec<String>,
}

impl Names {
    /// Identifiers that can stand keep their names; all others get new ones that nothing else has.
    pub fn of(system: &System) -> Self {
        let stands = system.quantities.iter().map(|quantity| &quantity.id).filter(|id| is_identifier(id));
        let mut names =
            Self { taken: stands.cloned().collect(), quantities: Vec::new(), events: Vec::new(), notices: Vec::new() };
        for (number, quantity) in system.quantities.iter().enumerate() {
            let id = match system.draws.iter().find(|draw| draw.quantity as usize == number) {
                // It has no name of its own.
                Some(draw) => names.new_id(&format!("drawn_for_{}", identifier(&draw.variable))),
                None if is_identifier(&quantity.id) => quantity.id.clone(),
                None => names.renamed(&quantity.id),
            };
            names.quantities.push(id);
        }
        for (index, event) in system.events.iter().enumerate() {
            let made = event.id == format!("event_{}", index + 1);
            let free = is_identifier(&event.id) && !names.taken.contains(&event.id);
            let id = match () {
                () if made => String::new(),
                () if free => names.new_id(&event.id),
                () => names.renamed(&event.id),
            };
            names.events.push(id);
        }
        names
    }

    /// A new identifier that is this one, or like it where it is taken.
    pub fn new_id(&mut self, wanted: &str) -> String {
        let mut id = wanted.to_owned();
        while !self.taken.insert(id.clone()) {
            id.push('_');
        }
        id
    }

    fn renamed(&mut self, id: &str) -> String {
        let new = self.new_id(&identifier(id));
        self.notices.push(format!("`{id}` is called `{new}`"));
        new
    }
}

/// Whether SBML can have an identifier.
pub fn is_identifier(id: &str) -> bool {
    let good = |c: char| c.is_ascii_alphanumeric() || c == '_';
    id.chars().all(good) && id.starts_with(|c: char| !c.is_ascii_digit())
}

/// An identifier for a text: `α` becomes `alpha`, other letters their numbers, everything else `_`.
pub fn identifier(text: &str) -> String {
    let mut id = String::new();
    for c in text.chars() {
        match c {
            c if c.is_ascii_alphanumeric() || c == '_' => id.push(c),
            'α'..='ω' => id.push_str(GREEK[c as usize - 'α' as usize]),
            'Α'..='Ω' => {
                let name = GREEK[c as usize - 'Α' as usize];
                id.push_str(&name[..1].to_uppercase());
                id.push_str(&name[1..]);
            }
            'µ' => id.push_str("mu"),
            c if c.is_alphanumeric() => id.push_str(&format!("u{:04X}", u32::from(c))),
            _ => id.push('_'),
        }
    }
    if is_identifier(&id) { id } else { format!("_{id}") }
}

#[cfg(test)]
mod tests {
    use super::{identifier, is_identifier};

    #[test]
    fn every_text_has_an_identifier() {
        for (text, id) in [
            ("α_1", "alpha_1"),
            ("Ωx", "Omegax"),
            ("é", "u00E9"),
            ("J.k", "J_k"),
            ("2nd", "_2nd"),
            ("", "_"),
            ("ς", "sigma"),
        ] {
            assert_eq!(identifier(text), id);
            assert!(is_identifier(id));
        }
        assert!(!is_identifier("") && !is_identifier("é") && !is_identifier("1a"));
    }
}
