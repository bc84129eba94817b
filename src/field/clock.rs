//! When the clock switches something in what a document does to its fields: windows are cut there, as those of populations are, eq. (ode.9).

use super::scales::in_circle;
use crate::equations::eml::Document;
use crate::equations::program::Program;
use crate::equations::tree::{Expr, Quantity, Role};
use crate::error::Result;
use crate::ode::clocked;

/// The program that tells the switches of all boxes alike, of rates and of what carries the fields; none where there are none.
///
/// # Errors
/// Definitions in a circle.
pub fn clock(document: &Document) -> Result<Option<Program>> {
    let mut system = document.system.clone();
    let transport: Vec<Expr> = document.fields.iter().flat_map(|field| field.carriers()).cloned().collect();
    for rule in transport {
        system.quantities.push(Quantity {
            id: String::new(),
            name: String::new(),
            role: Role::Defined { rule },
            initial: Expr::Number(0.0),
            unit: String::new(),
        });
    }
    let program = clocked(&system).map_err(|circle| in_circle(document, &circle))?;
    Ok((!program.further.is_empty()).then_some(program))
}
