//! The starting expressions of a document's fields at all boxes of a grid.

use super::grid::Grid;
use super::positions::{positions, set_positions};
use super::reactor::WIDTH;
use super::scales::Scales;
use crate::equations::program::{Program, run};
use crate::equations::tree::{Expr, QuantityId, Role, System};

/// A field and, where they come from a file, its values.
pub type Start = (QuantityId, Option<Vec<f64>>);

/// The values of all fields at time 0, one for each box. Expressions may use the values of fields from files.
///
/// # Errors
/// The identifiers along a circle of initial values.
pub fn profiles(
    system: &System,
    grid: &Grid,
    scales: Scales,
    starts: Vec<Start>,
) -> Result<Vec<Vec<f64>>, Vec<String>> {
    // At the start a field is what its expression says, or given.
    let mut system = system.clone();
    for (number, inputs) in &starts {
        let quantity = &mut system.quantities[*number as usize];
        let rule = std::mem::replace(&mut quantity.initial, Expr::Number(0.0));
        quantity.role = if inputs.is_some() { Role::Input } else { Role::Defined { rule } };
    }
    let wanted: Vec<Expr> = starts.iter().map(|(number, _)| Expr::Quantity(*number)).collect();
    let program = Program::with(&system, 0.0, &[], &[wanted])?;
    let code = &program.further[0];
    let registers = positions(&program, code);
    let register = |number: QuantityId| program.open_index(number).map(|at| program.first_open() + at);
    let inputs: Vec<(usize, &Vec<f64>)> =
        starts.iter().filter_map(|(number, values)| Some((register(*number)?, values.as_ref()?))).collect();
    let mut found = vec![vec![0.0; grid.len()]; starts.len()];
    let mut file = program.file::<WIDTH>();
    for first in (0..grid.len()).step_by(WIDTH) {
        let count = WIDTH.min(grid.len() - first);
        set_positions(grid, scales, &registers, first, &mut file);
        for (register, values) in &inputs {
            file[*register][..count].copy_from_slice(&values[first..first + count]);
        }
        run(code, &mut file);
        for (found, output) in found.iter_mut().zip(&code.outputs) {
            found[first..first + count].copy_from_slice(&file[*output as usize][..count]);
        }
    }
    Ok(found)
}
