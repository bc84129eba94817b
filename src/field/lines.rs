//! The method of lines, eq. (field.13): one differential equation for each species and box, handed whole to the engine.
//!
//! It knows no splitting and no approximant, so that it measures both; its steps are as short as diffusion asks.

use super::grid::{Grid, Wall};
use super::scales::{POSITION, Scales};
use super::species::Species;
use super::state::Fields;
use crate::equations::Range;
use crate::equations::tree::{Binary, Expr, Quantity, QuantityId, Role, System};
use crate::error::{Error, Fault, Result};
use crate::ode::{Method, Scheme, SolveOptions, solve};

/// Most values that are taken.
pub const MOST_UNKNOWNS: usize = 4000;

/// The fields after a window, by the engine's explicit method of order 5 with these tolerances, relative and absolute.
pub fn solve_lines(
    system: &System,
    scales: Scales,
    fields: &Fields,
    window: f64,
    inputs: &[(&str, f64)],
    [relative, absolute]: [f64; 2],
) -> Result<Fields> {
    let (grid, count) = (fields.grid(), fields.grid().len());
    let unknowns = count * fields.species().len();
    if unknowns > MOST_UNKNOWNS {
        let message = format!("the method of lines is given {unknowns} values; {MOST_UNKNOWNS} at most were expected");
        return Err(Error::input(Fault::new(message).help("take a smaller grid, or the splitting")));
    }
    let large = whole(system, scales, fields, inputs);
    let (from, until) = (fields.time() / scales.seconds, (fields.time() + window) / scales.seconds);
    let scheme = Scheme::OneStep(Method::Rk45);
    let options = SolveOptions { scheme, relative, absolute, ..SolveOptions::default() };
    let solution = solve(&large, from, until, &[until], &options)?;
    let last = &solution.values[0];
    let mut after = fields.clone();
    for (s, species) in fields.species().iter().enumerate() {
        let number = system.find(&species.name).expect("a field is a quantity of its document");
        let floor = if species.range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
        let values: Vec<f64> =
            (0..count).map(|at| last[number_in(system, grid, at, number) as usize].max(floor)).collect();
        after.set_values(s, &values)?;
    }
    after.set_time(fields.time() + window);
    Ok(after)
}

/// Where a quantity of a box stands in the large system: the quantities of the first box, of the second, …
fn number_in(system: &System, _grid: &Grid, at: usize, number: QuantityId) -> QuantityId {
    (at * system.quantities.len()) as QuantityId + number
}

/// One system with the quantities of every box.
fn whole(system: &System, scales: Scales, fields: &Fields, inputs: &[(&str, f64)]) -> System {
    let (grid, species) = (fields.grid(), fields.species());
    let mut large = System { name: system.name.clone(), ..System::default() };
    for at in 0..grid.len() {
        let mut position = grid.centre(at) / scales.micrometres;
        if grid.is_flat() {
            position.z = grid.origin.z / scales.micrometres;
        }
        for (number, quantity) in system.quantities.iter().enumerate() {
            let here = |expr: &Expr| moved(expr, (at * system.quantities.len()) as QuantityId);
            let (mut role, mut initial) = (quantity.role.clone(), here(&quantity.initial));
            let axis = POSITION.iter().position(|name| *name == quantity.id);
            match &quantity.role {
                Role::Variable { rate } => {
                    let s = species.iter().position(|species| species.name == quantity.id);
                    let s = s.expect("every variable of a document of fields is a field");
                    initial = Expr::Number(fields.values(s)[at]);
                    let spread = spread(system, grid, &species[s], at, number as QuantityId, scales.seconds);
                    role = Role::Variable { rate: sum(here(rate), spread) };
                }
                Role::Defined { rule } => role = Role::Defined { rule: here(rule) },
                Role::Input => {
                    let held = inputs.iter().find(|(id, _)| *id == quantity.id).map(|(_, value)| *value);
                    let value = axis.map(|axis| position[axis]).or(held);
                    (role, initial) = (Role::Parameter, value.map_or(initial, Expr::Number));
                }
                Role::Parameter => {}
            }
            let id = format!("{}[{at}]", quantity.id);
            large.quantities.push(Quantity { id, role, initial, ..quantity.clone() });
        }
    }
    large
}

fn sum(a: Expr, b: Expr) -> Expr {
    Expr::Binary(Binary::Add, Box::new(a), Box::new(b))
}

fn times(a: Expr, factor: f64) -> Expr {
    Expr::Binary(Binary::Mul, Box::new(a), Box::new(Expr::Number(factor)))
}

/// An expression of the same quantities in another box.
fn moved(expr: &Expr, by: QuantityId) -> Expr {
    let moved_box = |expr: &Expr| Box::new(moved(expr, by));
    match expr {
        Expr::Number(_) | Expr::Time => expr.clone(),
        Expr::Quantity(number) => Expr::Quantity(number + by),
        Expr::Unary(function, a) => Expr::Unary(*function, moved_box(a)),
        Expr::Binary(function, a, b) => Expr::Binary(*function, moved_box(a), moved_box(b)),
        Expr::Piecewise { branches, otherwise } => Expr::Piecewise {
            branches: branches.iter().map(|(condition, value)| (moved(condition, by), moved(value, by))).collect(),
            otherwise: moved_box(otherwise),
        },
        Expr::Delay(value, delay) => Expr::Delay(moved_box(value), moved_box(delay)),
        Expr::Root(equations, index) => {
            let mut equations = equations.map(|part| moved(part, by));
            equations.unknowns.iter_mut().for_each(|unknown| *unknown += by);
            Expr::Root(Box::new(equations), *index)
        }
    }
}

/// Diffusion and decay of a species in a box, per unit of time of the document: central differences of second order,
/// with a wall that is held half a box from the centre.
fn spread(system: &System, grid: &Grid, species: &Species, at: usize, number: QuantityId, seconds: f64) -> Expr {
    let [nx, ny, _] = grid.cells;
    let (index, strides) = ([at % nx, at / nx % ny, at / (nx * ny)], [1, nx, nx * ny]);
    let value = |at: usize| Expr::Quantity(number_in(system, grid, at, number));
    let (mut inflow, mut own, mut fixed) = (Expr::Number(0.0), -species.decay * seconds, 0.0);
    for axis in 0..3 {
        let rate = species.diffusion * seconds / (grid.spacing[axis] * grid.spacing[axis]);
        let (i, n, stride) = (index[axis], grid.cells[axis], strides[axis]);
        if n == 1 {
            continue;
        }
        let sides = [(i > 0, at.wrapping_sub(stride)), (i + 1 < n, at + stride)];
        let opposite = [at + (n - 1) * stride, at.wrapping_sub((n - 1) * stride)];
        for (side, (inside, neighbour)) in sides.into_iter().enumerate() {
            let from = match species.walls[axis][side] {
                _ if inside => neighbour,
                Wall::Periodic => opposite[side],
                Wall::NoFlux => continue,
                Wall::Fixed(held) => {
                    own -= 2.0 * rate;
                    fixed += 2.0 * rate * held;
                    continue;
                }
            };
            own -= rate;
            inflow = sum(inflow, times(value(from), rate));
        }
    }
    sum(sum(inflow, times(value(at), own)), Expr::Number(fixed))
}
