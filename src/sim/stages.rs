//! The stages of the implicit step for a block of cells: its forces, and the increments that they cause.

use super::forces::Forces;
use super::kind::{Kind, VolumeRule};
use super::model::Model;
use super::moved::Displacements;
use super::obstacles::{self, TouchScratch};
use super::pressure::{add_pressure_on_held, carry_pressure, constrain};
use super::scheme::{gamma, root_mean_square, share_of_stage};
use super::solver::{Solver, Stage, System, solve_block, solve_turning};
use super::targets::Targets;
use super::turning::Turning;
use crate::mechanics::integrator::{Order, StepSize};
use crate::mechanics::lanes::LANES;
use crate::mechanics::tangent::Scales;

/// What the stages of a step need of a kind.
pub struct Step<'a> {
    /// The model.
    pub model: &'a Model,
    /// The kind.
    pub kind: &'a Kind,
    /// The forces on its cells.
    pub forces: Forces<'a>,
    /// Their linear system, or where their own come from.
    pub solver: &'a Solver,
    /// What volumes are to be; none where nothing keeps them.
    pub targets: Option<Targets<'a>>,
    /// Where moved atoms go; none where no atom is moved on a course.
    pub displacements: Option<Displacements<'a>>,
    /// The order of the scheme.
    pub order: Order,
    /// When it begins, s.
    pub start: f64,
    /// How long it is, s.
    pub dt: f64,
}

/// A block of cells in a step.
pub struct Block<'a> {
    /// Its number.
    pub number: usize,
    /// Positions after the stages that were made.
    pub x: &'a mut [f64],
    /// Rest volumes of its cells.
    pub rest: &'a [f64],
    /// Positions where the step begins.
    pub start: &'a [f64],
    /// Volumes there.
    pub volume: &'a mut [f64],
    /// What they are to be.
    pub target: &'a mut [f64],
    /// Energies.
    pub energy: &'a mut [f64],
    /// Pressures of the stage made last.
    pub pressure: &'a mut [f64],
    /// Where forces from outside are added up, if somebody asks.
    pub outer: Option<&'a mut [f64]>,
    /// Where all forces on held atoms are added up then, those of pressure included.
    pub on_held: Option<&'a mut [f64]>,
    /// Where the gradients of volumes and what a unit of pressure moves are kept, where cells are coupled to others.
    pub swelling: Option<(&'a mut [f64], &'a mut [f64])>,
    /// Where the increments of the second stage are kept then.
    pub second: Option<&'a mut [f64]>,
    /// Contact with obstacles.
    pub touch: &'a mut TouchScratch,
}

impl Step<'_> {
    /// The linear system of the cells of a block; `factor` takes one of their own, or has it from the first stage.
    pub fn system<'b>(&'b self, block: &Block, factor: &'b mut [f64], has_factor: bool) -> System<'b> {
        let (kind, dt) = (self.kind, self.dt);
        let Some(tangent) = &kind.tangent else { return System::Shared(self.solver) };
        let mobility = dt / kind.drag;
        if !self.solver.own.is_empty() {
            return System::Own { mobility, tangent, factor: &self.solver.own, lanes: 1 };
        }
        let elastic = self.forces.elastic_factors(block.number);
        let scales = Scales {
            diagonal: kind.drag / dt,
            gamma: gamma(kind, self.order),
            elastic: &elastic[..kind.lanes],
            held: &kind.held,
            viscous: kind.viscosity.as_ref().map(|viscosity| (viscosity, 1.0 / dt)),
        };
        let factor = &mut factor[..tangent.len(kind.lanes)];
        if !has_factor {
            tangent.factor(&kind.forces, kind.lanes, block.start, scales, factor);
        }
        System::Own { mobility, tangent, factor, lanes: kind.lanes }
    }

    /// Whether the step is as long as its error allows: one of a fixed size needs no estimate, which costs another solution.
    fn asks_for_error(&self) -> bool {
        matches!(self.model.integrator.size, StepSize::Adaptive { .. })
    }

    /// Takes a block through stages of the step. The increments of the first are `kept` where stages are made one by one. Returns the
    /// largest error estimate, µm.
    pub fn advance(
        &self,
        block: &mut Block,
        system: &System,
        stages: &[Stage],
        mut kept: Option<&mut [f64]>,
        [y, first, gradient, swell, spare, spare2]: [&mut [f64]; 6],
    ) -> f64 {
        let kind = self.kind;
        let (loaded, end) = ((&self.forces, block.number), self.start + self.dt);
        let scheme = (system.mobility(), gamma(kind, self.order));
        let turning = Turning::of(self.model, loaded, end, block.start, scheme);
        self.swell(block, system, gradient, swell, [&mut *spare, &mut *spare2]);
        let mut error = 0.0;
        for &stage in stages {
            if let (Stage::Second, Some(kept)) = (stage, &kept) {
                first.copy_from_slice(kept);
            }
            self.push(block, stage, y, [&mut *spare, &mut *spare2]);
            let solved = (system, turning.rows());
            self.solve(solved, block, stage, y, first, (&*gradient, &*swell), [&mut *spare, &mut *spare2]);
            block.go_on(stage, y, first);
            if let (Stage::Second, Some(kept)) = (stage, &mut block.second) {
                kept.copy_from_slice(y);
            } else if stage == Stage::Second && self.settles(block) {
                let solved = (system, turning.rows());
                error = self.settle(
                    block,
                    solved,
                    (&*gradient, &*swell),
                    [&mut *y, &mut *first, &mut *spare, &mut *spare2],
                );
            } else if stage == Stage::Second && self.asks_for_error() {
                first.iter_mut().zip(&*y).for_each(|(first, y)| *first = 0.5 * (*first + y));
                system.filter(kind, (block.start, turning.rows()), first, spare, spare2);
                error = root_mean_square(kind, first);
            }
            if let (Stage::First, Some(kept)) = (stage, &mut kept) {
                kept.copy_from_slice(first);
            }
        }
        error
    }

    /// Measures volumes, and finds the displacement that a unit of pressure causes, eq. (step.5). What moved atoms make of volumes by going is
    /// in them.
    fn swell(
        &self,
        block: &mut Block,
        system: &System,
        gradient: &mut [f64],
        swell: &mut [f64],
        [spare, spare2]: [&mut [f64]; 2],
    ) {
        let Some(targets) = &self.targets else { return };
        let x = match &self.displacements {
            Some(displacements) => {
                spare.copy_from_slice(block.start);
                displacements.put_to_end(spare);
                &*spare
            }
            None => block.start,
        };
        targets.on_block(x, block.rest, gradient, block.volume, block.target);
        swell.copy_from_slice(gradient);
        solve_block(self.kind, self.kind.lanes, system, block.start, swell, spare, spare2);
        if let Some(kept) = &mut block.swelling {
            kept.0.copy_from_slice(gradient);
            kept.1.copy_from_slice(swell);
        }
    }

    /// Writes the forces of a stage to `y`.
    fn push(&self, block: &mut Block, stage: Stage, y: &mut [f64], [spare, spare2]: [&mut [f64]; 2]) {
        let (kind, share) = (self.kind, share_of_stage(self.order));
        // With what the first stage takes in advance of how forces change with time, and the second gives back, eq. (step.14).
        let ahead = gamma(kind, self.order) * self.dt;
        let time = if stage == Stage::First { self.start + ahead } else { self.start + self.dt - ahead };
        let x = match (&self.displacements, stage) {
            (None, Stage::First) => block.start,
            (None, Stage::Second) => &*block.x,
            (Some(displacements), _) => {
                spare2.copy_from_slice(if stage == Stage::First { block.start } else { block.x });
                displacements.put_to_stage(stage, spare2);
                &*spare2
            }
        };
        self.forces.on_block(block.number, time, (x, block.rest), (&mut *y, &mut *block.energy), spare);
        if let Some(outer) = &mut block.outer {
            self.forces.add_outer(block.number, (time, share), x, outer, spare);
        }
        if let Some(on_held) = &mut block.on_held {
            self.forces.add_without_contacts(block.number, share, y, on_held, spare);
        }
        if stage == Stage::Second {
            // The gradient of the first stage is the one with moved atoms where they end: in the mean of both they are half way.
            let x = match &self.displacements {
                None => &*block.x,
                Some(displacements) => {
                    spare2.copy_from_slice(block.x);
                    displacements.put_to_start(spare2);
                    &*spare2
                }
            };
            carry_pressure(kind, x, block.pressure, y, spare);
            if let (Some(on_held), VolumeRule::Exact(_)) = (&mut block.on_held, &kind.volume) {
                add_pressure_on_held(kind, block.x, (block.pressure, share), on_held, spare);
            }
        }
    }

    /// Turns forces into the increments of a stage, in place.
    fn solve(
        &self,
        (system, turning): (&System, &[f64]),
        block: &mut Block,
        stage: Stage,
        y: &mut [f64],
        first: &[f64],
        (gradient, swell): (&[f64], &[f64]),
        [spare, spare2]: [&mut [f64]; 2],
    ) {
        let &Self { model, kind, order, .. } = self;
        if stage == Stage::Second {
            let back = 2.0 / system.mobility();
            y.iter_mut().zip(first).for_each(|(y, k)| *y -= back * k);
        }
        self.resist(block, stage, y, first, spare);
        let bulged = self.bulged(block, stage, spare);
        let Block { x, start, volume, target, pressure, touch, .. } = block;
        // All that is left of forces on a rigid body is how they turn it where it is then.
        let frame = if kind.rigid.is_some() && stage == Stage::Second { &**x } else { &**start };
        solve_turning(kind, kind.lanes, system, (frame, turning), y, spare, spare2);
        let mut wanted = [0.0; LANES];
        for lane in 0..kind.lanes {
            let missing = target[lane] - volume[lane];
            wanted[lane] = if stage == Stage::First { missing } else { 2.0 * bulged[lane] - missing };
        }
        let gamma = gamma(kind, order);
        constrain(kind, gamma, gradient, swell, &wanted[..kind.lanes], target, y, pressure);
        let (share, end) = (share_of_stage(order), self.start + self.dt);
        let scene = obstacles::Scene { model, kind, system: *system, stage, end, gamma, share };
        obstacles::correct_block(&scene, start, first, gradient, swell, target, y, pressure, touch);
        if let Some(displacements) = &self.displacements {
            displacements.set_increments(stage, start, y);
        }
        if let Some(on_held) = &mut block.on_held {
            add_pressure_on_held(kind, block.start, (block.pressure, share_of_stage(order)), on_held, spare);
        }
        self.resist_on_held(block, stage, (&*y, first), spare);
    }
}

impl Block<'_> {
    /// Moves atoms by the increments of a stage, and keeps those of the first.
    fn go_on(&mut self, stage: Stage, y: &[f64], first: &mut [f64]) {
        let starts = self.x.iter_mut().zip(self.start).zip(y);
        if stage == Stage::First {
            starts.for_each(|((x, start), y)| *x = start + y);
            first.copy_from_slice(y);
        } else {
            starts.zip(first).for_each(|(((x, start), y2), y1)| *x = start + 1.5 * *y1 + 0.5 * y2);
        }
    }
}
