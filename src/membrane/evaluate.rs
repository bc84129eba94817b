//! The compiled equations on a block of cells: one pass over the atoms, eight numbers side by side (eight cells of a block, or eight
//! atoms of a cell that stands alone).

use pulp::Simd;

use std::ops::Range;

use super::shape;
use super::system::{MembraneSystem, Slot};
use crate::equations::eml::Taken;
use crate::equations::program::code::Code;
use crate::equations::program::{Lanes, Program, run_wide};

/// Numbers side by side.
pub const WIDTH: usize = 8;

/// Register files of the three programs.
#[derive(Debug, Default)]
pub struct Registers {
    /// The programs that they were made for.
    key: Option<[u64; 3]>,
    surface: Vec<Lanes<WIDTH>>,
    inside: Vec<Lanes<WIDTH>>,
    start: Vec<Lanes<WIDTH>>,
}

impl Registers {
    pub fn suit(&mut self, system: &MembraneSystem) {
        let key = Some([system.surface.mark, system.inside.mark, system.start.mark]);
        if self.key != key {
            (self.surface, self.inside, self.start) =
                (system.surface.file(), system.inside.file(), system.start.file());
            self.key = key;
        }
        // Constants stand where no code writes; they are set anew since other numbers may be poisoned.
        system.surface.set_constants(&mut self.surface);
        system.inside.set_constants(&mut self.inside);
        system.start.set_constants(&mut self.start);
    }

    pub fn poison(&mut self) {
        for file in [&mut self.surface, &mut self.inside, &mut self.start] {
            file.fill([f64::NAN; WIDTH]);
        }
    }
}

/// What is the same for all atoms of a cell.
pub struct Cell<'a, const L: usize> {
    pub time: [f64; L],
    pub pools: &'a [[f64; L]],
    pub area: [f64; L],
    pub volume: [f64; L],
}

/// One number of each lane for each of eight: as they are, or that of the only cell for all its atoms.
#[inline(always)]
fn spread<const L: usize>(value: &[f64; L]) -> Lanes<WIDTH> {
    std::array::from_fn(|l| value[l % L])
}

/// Fills what all atoms of a cell share.
#[inline(always)]
fn fill<const L: usize>(
    program: &Program,
    slots: &[Slot],
    cell: &Cell<L>,
    open: &[[f64; L]],
    file: &mut [Lanes<WIDTH>],
) {
    file[0] = spread(&cell.time);
    for (register, slot) in file[program.first_open()..].iter_mut().zip(slots) {
        match *slot {
            Slot::Position(_) | Slot::Given(_) => {}
            Slot::Pool(pool) => *register = spread(&cell.pools[pool]),
            Slot::Open(number) => *register = spread(&open[number]),
            Slot::Area => *register = spread(&cell.area),
            Slot::Volume => *register = spread(&cell.volume),
        }
    }
}

/// What differs from atom to atom, one number an atom: `[variable][atom]`, `[axis][atom]`, `[number][atom]`.
#[derive(Clone, Copy)]
pub struct Atoms<'a, const L: usize> {
    /// Densities of the variables.
    pub y: &'a [[f64; L]],
    /// Positions from the centre, µm.
    pub coordinates: &'a [[f64; L]],
    /// What is set from outside.
    pub given: &'a [[f64; L]],
}

/// Runs a code for all atoms, and shows the registers after each group: which numbers of a row they belong to.
#[inline(always)]
fn sweep<S: Simd, const L: usize>(
    simd: S,
    (program, code, slots): (&Program, &Code, &[Slot]),
    atoms: Atoms<L>,
    file: &mut [Lanes<WIDTH>],
    mut each: impl FnMut(Range<usize>, &[Lanes<WIDTH>]),
) {
    let (y, x, given) = (atoms.y.as_flattened(), atoms.coordinates.as_flattened(), atoms.given.as_flattened());
    let length = x.len() / 3;
    for first in (0..length).step_by(WIDTH) {
        let count = WIDTH.min(length - first);
        for (variable, register) in file[1..=program.size()].iter_mut().enumerate() {
            register[..count].copy_from_slice(&y[variable * length + first..][..count]);
        }
        for (register, slot) in file[program.first_open()..].iter_mut().zip(slots) {
            let (rows, number) = match *slot {
                Slot::Position(axis) => (x, axis),
                Slot::Given(number) => (given, number),
                _ => continue,
            };
            register[..count].copy_from_slice(&rows[number * length + first..][..count]);
        }
        run_wide(simd, code, file);
        each(first..first + count, file);
    }
}

/// Works out what is summed over the surface, eq. (surface.4), and puts it among what is open of the inside.
#[inline(always)]
pub fn sum<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    cell: &Cell<L>,
    (atoms, areas): (Atoms<L>, &[[f64; L]]),
    open: &mut [[f64; L]],
    registers: &mut Registers,
) {
    open[system.measures[0]] = cell.area;
    open[system.measures[1]] = cell.volume;
    if system.sums.is_empty() {
        return;
    }
    for sum in &system.sums {
        open[sum.open] = [0.0; L];
    }
    let (program, code) = (&system.surface, &system.surface.further[0]);
    fill(program, &system.slots, cell, open, &mut registers.surface);
    let areas = areas.as_flattened();
    sweep(simd, (program, code, &system.slots), atoms, &mut registers.surface, |numbers, file| {
        for (sum, &output) in system.sums.iter().zip(&code.outputs) {
            let total = &mut open[sum.open];
            // Numbers of a group are eight cells, or eight atoms of one: added in the order of the atoms either way.
            for (value, number) in file[output as usize].iter().zip(numbers.clone()) {
                total[number % L] += areas[number] * value;
            }
        }
    });
    for sum in system.sums.iter().filter(|sum| sum.taken == Taken::Mean) {
        for l in 0..L {
            open[sum.open][l] /= cell.area[l];
        }
    }
}

/// Rates of change of all variables on the surface, `[variable][atom]`, and of the pools.
#[inline(always)]
pub fn rates<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    cell: &Cell<L>,
    atoms: Atoms<L>,
    open: &[[f64; L]],
    registers: &mut Registers,
    rates: (&mut [[f64; L]], &mut [[f64; L]]),
) {
    work_out(simd, system, (&system.surface.rates, &system.inside.rates), cell, atoms, open, registers, rates);
}

/// Strengths of noise, of each variable that has it at all atoms, `[variable][atom]`, and of each such pool.
#[inline(always)]
pub fn strengths<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    cell: &Cell<L>,
    atoms: Atoms<L>,
    open: &[[f64; L]],
    registers: &mut Registers,
    strengths: (&mut [[f64; L]], &mut [[f64; L]]),
) {
    let codes = (&system.surface.further[1], &system.inside.further[0]);
    work_out(simd, system, codes, cell, atoms, open, registers, strengths);
}

/// Numbers of all atoms, `[number][atom]`, and of the inside of each cell.
#[inline(always)]
fn work_out<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    (on_surface, of_inside): (&Code, &Code),
    cell: &Cell<L>,
    atoms: Atoms<L>,
    open: &[[f64; L]],
    registers: &mut Registers,
    (surface, inside): (&mut [[f64; L]], &mut [[f64; L]]),
) {
    if !on_surface.outputs.is_empty() {
        let program = &system.surface;
        fill(program, &system.slots, cell, open, &mut registers.surface);
        let (numbers, length) = (surface.as_flattened_mut(), atoms.coordinates.len() / 3 * L);
        sweep(simd, (program, on_surface, &system.slots), atoms, &mut registers.surface, |part, file| {
            for (number, &output) in on_surface.outputs.iter().enumerate() {
                let row = &mut numbers[number * length..][..length][part.clone()];
                row.copy_from_slice(&file[output as usize][..row.len()]);
            }
        });
    }
    if of_inside.outputs.is_empty() {
        return;
    }
    let file = &mut registers.inside;
    file[0] = spread(&cell.time);
    for (register, value) in file[1..].iter_mut().zip(cell.pools.iter().chain(open)) {
        *register = spread(value);
    }
    run_wide(simd, of_inside, file);
    for (number, &output) in inside.iter_mut().zip(&of_inside.outputs) {
        number.copy_from_slice(&file[output as usize][..L]);
    }
}

/// An expression that is shown, at all atoms.
#[inline(always)]
pub fn show<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    cell: &Cell<L>,
    (number, atoms): (usize, Atoms<L>),
    open: &[[f64; L]],
    registers: &mut Registers,
    shown: &mut [[f64; L]],
) {
    let (program, code) = (&system.surface, &system.surface.further[2 + number]);
    fill(program, &system.slots, cell, open, &mut registers.surface);
    let (shown, output) = (shown.as_flattened_mut(), code.outputs[0] as usize);
    sweep(simd, (program, code, &system.slots), atoms, &mut registers.surface, |numbers, file| {
        let row = &mut shown[numbers];
        row.copy_from_slice(&file[output][..row.len()]);
    });
}

/// The values of all variables at the start: on the surface `[variable][atom]`, and of the pools.
#[inline(always)]
pub fn start<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    cell: &Cell<L>,
    atoms: Atoms<L>,
    open: &[[f64; L]],
    registers: &mut Registers,
    (surface, pools): (&mut [[f64; L]], &mut [[f64; L]]),
) {
    let (program, code) = (&system.start, &system.start.further[0]);
    fill(program, &system.start_slots, cell, open, &mut registers.start);
    let (values, length) = (surface.as_flattened_mut(), atoms.coordinates.len() / 3 * L);
    let count = system.variables();
    sweep(simd, (program, code, &system.start_slots), atoms, &mut registers.start, |numbers, file| {
        for (variable, &output) in code.outputs[..count].iter().enumerate() {
            let row = &mut values[variable * length..][..length][numbers.clone()];
            row.copy_from_slice(&file[output as usize][..row.len()]);
        }
        if numbers.start == 0 {
            for (pool, &output) in pools.iter_mut().zip(&code.outputs[count..]) {
                pool.copy_from_slice(&file[output as usize][..L]);
            }
        }
    });
}

/// Area and volume of the cells of a block.
#[inline(always)]
pub fn measures<const L: usize>(mesh: &super::SurfaceMesh, x: &[[f64; L]], areas: &[[f64; L]]) -> ([f64; L], [f64; L]) {
    (shape::total(areas), shape::volume(mesh, x))
}
