//! The position of boxes as the equations of a document see it.

use super::grid::Grid;
use super::rows::ROW as WIDTH;
use super::scales::{POSITION, Scales};
use crate::equations::program::code::Code;
use crate::equations::program::{Lanes, Program};

/// Registers of the position that the equations use.
pub type Positions = [Option<usize>; 3];

/// Where the position stands among the registers, as far as the code uses it.
pub fn positions(program: &Program, code: &Code) -> Positions {
    POSITION.map(|name| {
        let number = program.open.iter().position(|open| program.names[*open as usize] == name)?;
        let register = program.first_open() + number;
        let read = code.ops.iter().flat_map(|op| [op.a, op.b, op.c]).chain(code.outputs.iter().copied());
        read.into_iter().any(|one| one as usize == register).then_some(register)
    })
}

/// Sets the position of boxes that follow each other in memory, in the document's unit.
pub fn set_positions(grid: &Grid, scales: Scales, registers: &Positions, first: usize, file: &mut [Lanes<WIDTH>]) {
    if registers.iter().all(Option::is_none) {
        return;
    }
    let [nx, ny, _] = grid.cells;
    let mut index = [first % nx, first / nx % ny, first / (nx * ny)];
    // On the substrate z is its height.
    let centre = if grid.is_flat() { [0.5, 0.5, 0.0] } else { [0.5; 3] };
    for lane in 0..WIDTH {
        for (axis, register) in registers.iter().enumerate() {
            if let Some(register) = register {
                let position = grid.origin[axis] + (index[axis] as f64 + centre[axis]) * grid.spacing[axis];
                file[*register][lane] = position / scales.micrometres;
            }
        }
        index[0] += 1;
        if index[0] == nx {
            index = [0, index[1] + 1, index[2]];
        }
        if index[1] == ny {
            index = [0, 0, index[2] + 1];
        }
    }
}
