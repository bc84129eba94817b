//! What a force on one side of a contact moves of a cell that has a stiffness of its own: both stages of the implicit step, with its volume
//! kept as they keep it.

use std::ops::Range;

use rayon::prelude::*;

use super::columns::{Columns, Counted, direction, directions};
use super::rows::Row;
use super::scene::ContactScene;
use super::scratch::ContactScratch;
use super::together::Together;
use super::vectors::{V4, map};
use crate::Vec3;
use crate::mechanics::integrator::{Method, Order};
use crate::mechanics::lanes::LANES;
use crate::mechanics::tangent::Tangent;
use crate::mechanics::volume;
use crate::sim::kind::{Kind, VolumeRule};
use crate::sim::model::Model;
use crate::sim::pressure::pressure;
use crate::sim::scheme::gamma;
use crate::sim::solver::{System, solve_block};
use crate::sim::state::{KindState, State, index};
use crate::sim::thread_buffers::{SETS, ThreadBuffers};
use crate::sim::workspace::KindScratch;

/// Finds the columns of all rows and volumes of cells that move by them.
pub fn find_columns(
    model: &Model,
    contact: &ContactScene,
    dt: f64,
    (from, to): (&State, &State),
    s: &mut ContactScratch,
    kinds: &mut [KindScratch],
    buffers: &ThreadBuffers,
) {
    let Method::Implicit { order } = model.integrator.method else { return };
    if !s.mobility.columns.are_there() {
        return;
    }
    let ContactScratch { rows, volumes, gradient, mobility, .. } = s;
    let columns = &mut mobility.columns;
    let bodies_of = |row: &Row| [row.atoms[0], row.atoms[3]].map(|atom| contact.body_of(atom));
    let counted = |body: u32| {
        let kind = contact.kind_of(body);
        let keeps_volume = matches!(model.kinds[kind].volume, VolumeRule::Exact(_));
        let first_atom = contact.scene.bodies[body as usize].first_atom;
        Counted { kind, first_atom, atoms: model.kinds[kind].atoms() as u32, keeps_volume }
    };
    columns.count(rows, bodies_of, contact.scene.bodies.len(), counted);
    let mut values = std::mem::take(&mut columns.values);
    let together = Together::new(&mut values);
    let mut first_body = 0;
    let cells = from.kinds.iter().zip(&to.kinds);
    for (number, ((kind, w), (now, next))) in model.kinds.iter().zip(kinds).zip(cells).enumerate() {
        let first = first_body;
        first_body += now.cells();
        if !columns.are_of(number) {
            continue;
        }
        let solver = w.solver(kind, dt, gamma(kind, order));
        let part = OfKind { kind, order, dt, own: &solver.own, now, next, w, rows };
        (0..now.cells()).into_par_iter().for_each(|cell| {
            let (sides, own) = columns.of_body(first + cell);
            // SAFETY: each cell has columns of its own.
            let own = unsafe { together.part(own) };
            if !own.is_empty() {
                let first_atom = contact.scene.bodies[first + cell].first_atom;
                buffers.enter_with_factor(3 * kind.atoms() * LANES * SETS, |arrays, factor| {
                    part.solve((cell, first + cell, first_atom), (columns, sides), own, arrays, factor);
                });
            }
        });
    }
    columns.values = values;
    for row in volumes {
        if let Some(first) = columns.of_volume(row.body, contact.kind_of(row.body as u32)) {
            let first_atom = contact.scene.bodies[row.body].first_atom as usize;
            let (g, s) = (&gradient[first_atom..], &columns.values[first..first + row.end - row.first]);
            let (mut along, mut squared) = (0.0, 0.0);
            for (g, s) in g.iter().zip(s) {
                along += (0..3).map(|axis| g[axis] * s[axis]).sum::<f64>();
                squared += (0..3).map(|axis| s[axis] * s[axis]).sum::<f64>();
            }
            (row.inverse, row.swelling, row.column) = (1.0 / along, squared, Some(first));
        }
    }
}

/// What the cells of a kind need.
struct OfKind<'a> {
    kind: &'a Kind,
    order: Order,
    dt: f64,
    /// The factor of a cell that stands alone; else empty.
    own: &'a [f64],
    /// Where they are and where they went freely.
    now: &'a KindState,
    next: &'a KindState,
    w: &'a KindScratch,
    rows: &'a [Row],
}

/// How the volume of a cell answers.
struct Swelling<'a> {
    gradient: &'a [f64],
    /// Displacement over pressure, µm³/pN.
    swell: &'a [f64],
    /// Change of volume over pressure, µm⁵/pN.
    swelling: f64,
    target: f64,
}

impl OfKind<'_> {
    /// Finds the columns of a cell.
    fn solve(
        &self,
        (cell, body, first_atom): (usize, usize, u32),
        (columns, sides): (&Columns, Range<usize>),
        values: &mut [V4],
        [x, y, first, spare, spare2, of_volume]: [&mut [f64]; 6],
        factor: &mut [f64],
    ) {
        let Some(tangent) = &self.kind.tangent else { return };
        let (kind, size) = (self.kind, 3 * self.kind.atoms());
        let factor = match self.own {
            [] => self.take_factor(tangent, cell, factor),
            own => own,
        };
        let system = System::Own { mobility: self.dt / kind.drag, tangent, factor, lanes: 1 };
        let (gradient, swell) = of_volume[..2 * size].split_at_mut(size);
        let mut volume = None;
        if kind.volume != VolumeRule::Free {
            take_cell(kind, &self.next.positions, cell, 1, y);
            volume::measure_block(&kind.rest.facets, &y[..size], &kind.held, gradient, &mut [0.0]);
            take_cell(kind, &self.now.positions, cell, 1, x);
            swell.copy_from_slice(gradient);
            let [x, spare, spare2] = [&mut *x, &mut *spare, &mut *spare2].map(|array| &mut array[..size]);
            solve_block(kind, 1, &system, x, swell, spare, spare2);
            let swelling = gradient.iter().zip(&*swell).map(|(g, s)| g * s).sum();
            volume = Some(Swelling { gradient, swell, swelling, target: self.w.target[cell] });
        }
        take_cell(kind, &self.now.positions, cell, LANES, x);
        let x = &x[..size * LANES];
        let touched = columns.touched_of(body);
        let (values, answers) = values.split_at_mut(values.len() - 3 * touched.len() * kind.atoms());
        let mut ends = values.chunks_exact_mut(kind.atoms());
        if let (VolumeRule::Exact(_), Some(Swelling { swell, .. })) = (&kind.volume, &volume) {
            let to = ends.next().into_iter().flatten();
            to.zip(swell.chunks_exact(3)).for_each(|(to, by)| *to = [by[0], by[1], by[2], 0.0]);
        }
        let mut solve = |y: &mut [f64]| {
            let [first, spare] = [&mut *first, &mut *spare].map(|array| &mut array[..y.len()]);
            self.answer(&system, volume.as_ref(), x, y, spare, spare2);
            if self.order == Order::Second {
                first.copy_from_slice(y);
                // Of the drag and of what is viscous.
                for (y, first) in y.chunks_exact(x.len()).zip(first.chunks_exact_mut(x.len())) {
                    kind.add_resistance(LANES, 1.0 / kind.drag, [x, y], first);
                }
                self.answer(&system, volume.as_ref(), x, first, spare, spare2);
                let back = 0.5 / system.mobility();
                y.iter_mut().zip(&*first).for_each(|(y, first)| *y = 1.5 * *y - back * first);
            }
        };
        let all = columns.sides[sides].iter().flat_map(|&(row, side)| {
            let (row, corners) = (&self.rows[row as usize], columns.corners_of(row as usize, side as usize));
            (0..directions(row)).map(move |number| (row, corners.clone(), direction(row, number)))
        });
        if touched.is_empty() {
            let forces = all.map(|(row, corners, direction)| {
                let weights = row.weights();
                corners.map(move |corner| ((row.atoms[corner] - first_atom) as usize, weights[corner] * direction))
            });
            solve_all(forces, y, &mut solve, ends);
            return;
        }
        let units = touched.iter().flat_map(|atom| (0..3).map(move |axis| (atom - first_atom, Vec3::ith(axis, 1.0))));
        let units = units.map(|(atom, along)| std::iter::once((atom as usize, along)));
        solve_all(units, y, &mut solve, answers.chunks_exact_mut(kind.atoms()));
        put_together(all, (touched, answers), ends);
    }

    /// Takes the factor of a cell out of that of its block.
    fn take_factor<'b>(&self, tangent: &Tangent, cell: usize, factor: &'b mut [f64]) -> &'b [f64] {
        let (lanes, length) = (self.kind.lanes, tangent.len(self.kind.lanes));
        let of_block = &self.w.own_factors[cell / lanes * length..][..length];
        let factor = &mut factor[..tangent.len(1)];
        factor.iter_mut().zip(of_block[cell % lanes..].iter().step_by(lanes)).for_each(|(to, from)| *to = *from);
        factor
    }

    /// What a stage of the step makes of forces, volumes kept as the step keeps them, for some sets of right sides.
    fn answer(
        &self,
        system: &System,
        volume: Option<&Swelling>,
        x: &[f64],
        y: &mut [f64],
        spare: &mut [f64],
        spare2: &mut [f64],
    ) {
        solve_block(self.kind, LANES, system, x, y, spare, spare2);
        let Some(Swelling { gradient, swell, swelling, target }) = volume else { return };
        let gamma = gamma(self.kind, self.order);
        for set in y.chunks_exact_mut(x.len()) {
            let (y, _) = set.as_chunks_mut::<LANES>();
            let mut along = [0.0; LANES];
            for (y, g) in y.iter().zip(*gradient) {
                (0..LANES).for_each(|lane| along[lane] += g * y[lane]);
            }
            let pressures = along.map(|along| pressure(self.kind, gamma, along, *swelling, 0.0, *target));
            for (y, s) in y.iter_mut().zip(*swell) {
                (0..LANES).for_each(|lane| y[lane] += pressures[lane] * s);
            }
        }
    }
}

/// Puts columns together from the answers to unit forces along x, y and z on the atoms that are touched.
fn put_together<'a>(
    forces: impl Iterator<Item = (&'a Row, Range<usize>, Vec3)>,
    (touched, answers): (&[u32], &[V4]),
    ends: std::slice::ChunksExactMut<V4>,
) {
    let atoms = answers.len() / (3 * touched.len());
    for ((row, corners, direction), to) in forces.zip(ends) {
        let weights = row.weights();
        to.fill([0.0; 4]);
        for corner in corners {
            let first = 3 * touched.binary_search(&row.atoms[corner]).expect("each corner is among them");
            for (axis, along) in direction.iter().enumerate().filter(|(_, along)| **along != 0.0) {
                let (by, share) = (&answers[(first + axis) * atoms..][..atoms], weights[corner] * along);
                to.iter_mut().zip(by).for_each(|(to, by)| *to = map(|i| to[i] + share * by[i]));
            }
        }
    }
}

/// Takes the numbers of a cell out of a block array, each as often as there are right sides.
fn take_cell(kind: &Kind, values: &[f64], cell: usize, copies: usize, to: &mut [f64]) {
    let from = values[index(kind, cell, 0, 0)..].iter().step_by(kind.lanes);
    to.chunks_exact_mut(copies).zip(from).take(3 * kind.atoms()).for_each(|(to, from)| to.fill(*from));
}

/// Finds what forces on some atoms make, several at once, and writes it, a column for each.
fn solve_all(
    forces: impl Iterator<Item = impl Iterator<Item = (usize, Vec3)>>,
    y: &mut [f64],
    solve: &mut impl FnMut(&mut [f64]),
    mut ends: std::slice::ChunksExactMut<V4>,
) {
    let mut forces = forces.peekable();
    let set = y.len() / SETS;
    while forces.peek().is_some() {
        y.fill(0.0);
        let mut filled = 0;
        for parts in forces.by_ref().take(SETS * LANES) {
            let y = &mut y[filled / LANES * set..][..set];
            for (atom, force) in parts {
                (0..3).for_each(|axis| y[(3 * atom + axis) * LANES + filled % LANES] += force[axis]);
            }
            filled += 1;
        }
        let y = &mut y[..filled.div_ceil(LANES) * set];
        solve(y);
        for (number, to) in (0..filled).zip(&mut ends) {
            let (lane, y) = (number % LANES, &y[number / LANES * set..][..set]);
            for (to, from) in to.iter_mut().zip(y.chunks_exact(3 * LANES)) {
                *to = [from[lane], from[LANES + lane], from[2 * LANES + lane], 0.0];
            }
        }
    }
}
