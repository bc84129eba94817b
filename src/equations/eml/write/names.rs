//! Identifiers of a system as a document may write them: SBML has names, such as `[S]` and `J.k`, that EML cannot have.

use super::super::Level;
use super::super::declare::POSITION;
use crate::equations::expression::{is_identifier, is_reserved};
use crate::equations::tree::System;
use std::collections::HashSet;

/// What the things of a system are called in a document.
pub(super) struct Names {
    /// Of each quantity.
    pub(super) quantities: Vec<String>,
    /// Of each event; empty for one whose identifier is made from its index.
    pub(super) events: Vec<String>,
    /// What is called otherwise, one sentence for each kind.
    pub(super) notices: Vec<String>,
}

impl Names {
    /// Identifiers that can stand keep their names; all others get new ones that nothing else has.
    pub(super) fn of(system: &System, level: Level) -> Self {
        let position = |id: &str| level == Level::Field && POSITION.contains(&id);
        let stands = |id: &str| is_identifier(id) && !is_reserved(id) && !position(id);
        let mut taken: HashSet<String> =
            system.quantities.iter().filter(|quantity| stands(&quantity.id)).map(|q| q.id.clone()).collect();
        let mut told = Told::default();
        let mut new_name = |id: &str, told: &mut Told| {
            let mut name = cleaned(id);
            while taken.contains(&name) || !stands(&name) {
                name.push('_');
            }
            taken.insert(name.clone());
            told.note(id, &name);
            name
        };
        let mut quantities = Vec::with_capacity(system.quantities.len());
        for (number, quantity) in system.quantities.iter().enumerate() {
            // What is drawn is written as the call that draws it.
            if let Some(draw) = system.draws.iter().find(|draw| draw.quantity as usize == number) {
                quantities.push(if draw.is_normal { "normal(0, 1)" } else { "uniform(0, 1)" }.to_owned());
                continue;
            }
            let keeps = stands(&quantity.id) || position(&quantity.id);
            quantities.push(if keeps { quantity.id.clone() } else { new_name(&quantity.id, &mut told) });
        }
        let mut seen: HashSet<&str> = HashSet::new();
        let mut events = Vec::with_capacity(system.events.len());
        for (index, event) in system.events.iter().enumerate() {
            let free = stands(&event.id) && !quantities.contains(&event.id) && seen.insert(&event.id);
            events.push(match () {
                () if event.id == format!("event_{}", index + 1) => String::new(),
                () if free => event.id.clone(),
                () => new_name(&event.id, &mut told),
            });
        }
        Self { quantities, events, notices: told.notices() }
    }
}

/// A name made of letters, digits and `_`: `[S]` becomes `S_concentration`, `J.k` becomes `J_k`.
fn cleaned(id: &str) -> String {
    if let Some(species) = id.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
        return format!("{species}_concentration");
    }
    let name: String = id.chars().map(|c| if c.is_alphanumeric() || c == '_' { c } else { '_' }).collect();
    let name = if name.ends_with('_') && !id.ends_with('_') { name.trim_end_matches('_').to_owned() } else { name };
    if is_identifier(&name) || is_reserved(&name) { name } else { format!("_{name}") }
}

/// New names, by the reason for them.
#[derive(Default)]
struct Told {
    words: Vec<(String, String)>,
    concentrations: Vec<(String, String)>,
    others: Vec<(String, String)>,
}

impl Told {
    fn note(&mut self, id: &str, name: &str) {
        let group = match () {
            () if is_reserved(id) => &mut self.words,
            () if id.starts_with('[') => &mut self.concentrations,
            () => &mut self.others,
        };
        group.push((id.to_owned(), name.to_owned()));
    }

    fn notices(self) -> Vec<String> {
        let word = |(id, name): &(String, String)| format!("`{id}` is a word of the language and is called `{name}`");
        let mut notices: Vec<String> = self.words.iter().map(word).collect();
        for (group, what) in [(self.concentrations, "concentrations"), (self.others, "other names")] {
            match group.as_slice() {
                [] => {}
                [(id, name)] => notices.push(format!("`{id}` is called `{name}`")),
                [(id, name), ..] => {
                    notices.push(format!("{} {what} are changed, such as `{id}` to `{name}`", group.len()));
                }
            }
        }
        notices
    }
}
