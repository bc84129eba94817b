//! What stands once beside the fields of a document: which numbers it takes from them and gives to them, and what its events set.

use std::ops::Range as Part;

use rayon::prelude::*;

use super::grid::Grid;
use super::rows::File;
use super::scales::{POSITION, Scales, in_circle};
use super::sites::Sites;
use super::tables::{Now, Table};
use crate::equations::eml::{self, Document, FieldEvent, Taken};
use crate::equations::program::Program;
use crate::equations::tree::{Expr, QuantityId, Role, System};
use crate::error::Result;
use crate::ode::{EventMemory, EventPlan, Method, Population, clocked};

/// Boxes whose values are summed up one after the other: sums are the same with any number of threads.
const SUMMED: usize = 4096;

/// What stands beside fields: compiled, and never changed.
#[derive(Debug, Clone)]
pub struct Beside {
    /// The equations of the system of the scene.
    pub program: Program,
    /// Its events.
    pub plan: EventPlan,
    /// Its quantities that are numbers of the scene and may change.
    pub quantities: Vec<QuantityId>,
    pub(super) totals: Vec<Total>,
    /// What is given to the fields: the number of an input, and where its value stands.
    fed: Vec<(usize, Slot)>,
    pub(super) sets: Vec<Sets>,
    /// Whether what the fields do depends on sums over them, with no variable between.
    pub(super) reads_totals: bool,
}

/// A sum over the grid.
#[derive(Debug, Clone)]
pub(super) struct Total {
    table: Table,
    /// From the sum over the boxes to the number of the document.
    factor: f64,
    /// Its number among the inputs of the fields.
    pub input: usize,
    /// Its number among the open quantities of the system.
    open: usize,
}

/// What an event sets fields to.
#[derive(Debug, Clone)]
pub(super) struct Sets {
    /// The variable that counts its executions.
    pub count: usize,
    /// Fields and their values.
    pub values: Vec<(usize, Table)>,
    /// How it is told.
    pub name: String,
}

/// Where a number of the system stands.
#[derive(Debug, Clone, Copy)]
enum Slot {
    State(usize),
    Open(usize),
}

impl Beside {
    /// What stands beside the fields of a document; none where there are fields alone.
    ///
    /// # Errors
    /// Definitions in a circle.
    pub fn new(document: &Document, grid: &Grid, scales: Scales) -> Result<Option<Self>> {
        let (Some(scene), Some((alone, events))) = (&document.scene, document.scene_alone()) else { return Ok(None) };
        let compiled = match alone.system.events.is_empty() {
            true => clocked(&alone.system).map(|program| (program, EventPlan::default())),
            false => EventPlan::compile(&alone.system, 0.0),
        };
        let (program, plan) = compiled.map_err(|circle| in_circle(document, &circle))?;
        let fields = document.fields_alone();
        let inputs = inputs(&fields.system);
        let input = |quantity: QuantityId| inputs.iter().position(|input| *input == quantity);
        let slot = |quantity: QuantityId| {
            let state = program.variable_index(quantity).map(Slot::State);
            state.or_else(|| program.open_index(quantity).map(Slot::Open))
        };
        let measure = grid.measure() / scales.micrometres.powi(grid.dimension() as i32);
        let total = |total: &eml::Total| -> Result<Option<Total>> {
            let (Some(input), Some(open)) = (input(total.quantity), program.open_index(total.quantity)) else {
                return Ok(None);
            };
            let factor = if total.taken == Taken::Mean { 1.0 / grid.len() as f64 } else { measure };
            let table = Table::new(&fields, Sites::Boxes, &total.integrand, 1.0)?;
            Ok(Some(Total { table, factor, input, open }))
        };
        let totals: Result<Vec<Option<Total>>> = scene.totals.iter().map(total).collect();
        let sets: Result<Vec<Sets>> = events.iter().map(|event| sets(&fields, &program, event)).collect();
        // What comes to the scene from outside is handed on.
        let is_total = |quantity: &QuantityId| scene.totals.iter().any(|total| total.quantity == *quantity);
        let fed = inputs.iter().copied().filter(|quantity| !is_total(quantity));
        let fed = fed.filter_map(|quantity| Some((input(quantity)?, slot(quantity)?))).collect();
        let reads_totals = reads_totals(&fields, scene);
        let totals = totals?.into_iter().flatten().collect();
        let quantities = document.quantities_beside();
        Ok(Some(Self { quantities, totals, fed, sets: sets?, reads_totals, program, plan }))
    }

    /// The system of the scene where it starts, and what it knows of its events.
    pub fn start(&self, method: Method, time: f64) -> (Population, Vec<EventMemory>) {
        let memories = if self.plan.is_empty() { Vec::new() } else { vec![self.plan.before_start(time)] };
        (Population::new(&self.program, 1, method), memories)
    }

    /// Gives the fields the numbers of the system.
    pub(super) fn feed(&self, population: &Population, inputs: &mut [f64]) {
        for &(input, slot) in &self.fed {
            inputs[input] = match slot {
                Slot::State(variable) => population.state(0, variable),
                Slot::Open(open) => population.open_value(0, open),
            };
        }
    }

    /// Gives the system sums over the grid.
    pub(super) fn tell(&self, totals: &[f64], population: &mut Population) {
        self.totals.iter().zip(totals).for_each(|(total, value)| population.set_open(0, total.open, *value));
    }

    /// Works out all sums over the grid.
    pub(super) fn sum(&self, now: &Now, sums: &mut [PartSum], to: &mut Vec<f64>) {
        to.clear();
        for total in &self.totals {
            to.push(
                total.factor
                    * sum(now.grid.len(), sums, |part, scratch| {
                        let PartSum { file, values, .. } = scratch;
                        values.resize(part.len(), 0.0);
                        total.table.fill(now, part.start, values, file);
                        values.iter().sum()
                    }),
            );
        }
    }
}

/// What a part of the grid is summed up in.
#[derive(Debug, Clone, Default)]
pub struct PartSum {
    file: File,
    values: Vec<f64>,
    found: f64,
}

impl PartSum {
    /// Registers of programs.
    pub(super) fn file(&mut self) -> &mut File {
        &mut self.file
    }
}

/// As many as a grid has parts.
pub(super) fn parts_of(grid: &Grid) -> usize {
    grid.len().div_ceil(SUMMED)
}

/// The sum over all boxes of what is found in parts of the grid.
pub(super) fn sum(boxes: usize, sums: &mut [PartSum], of: impl Fn(Part<usize>, &mut PartSum) -> f64 + Sync) -> f64 {
    let one = |(part, scratch): (usize, &mut PartSum)| {
        let part = part * SUMMED..((part + 1) * SUMMED).min(boxes);
        scratch.found = of(part, scratch);
    };
    if sums.len() > 1 && rayon::current_num_threads() > 1 {
        sums.par_iter_mut().enumerate().for_each(one);
    } else {
        sums.iter_mut().enumerate().for_each(one);
    }
    sums.iter().map(|part| part.found).sum()
}

/// The inputs of fields, in their order.
fn inputs(system: &System) -> Vec<QuantityId> {
    let is_input = |number: &QuantityId| {
        let quantity = &system.quantities[*number as usize];
        quantity.role == Role::Input && !POSITION.contains(&quantity.id.as_str())
    };
    (0..system.quantities.len() as QuantityId).filter(is_input).collect()
}

/// What an event sets fields to.
fn sets(fields: &Document, program: &Program, event: &FieldEvent) -> Result<Sets> {
    let species = |quantity: QuantityId| fields.fields.iter().position(|field| field.quantity == quantity);
    let one = |(quantity, value): &(QuantityId, Expr)| -> Result<Option<(usize, Table)>> {
        let Some(species) = species(*quantity) else { return Ok(None) };
        Ok(Some((species, Table::new(fields, Sites::Boxes, value, 1.0)?)))
    };
    let values: Result<Vec<Option<(usize, Table)>>> = event.sets.iter().map(one).collect();
    let count = program.variable_index(event.count).unwrap_or_default();
    Ok(Sets { count, values: values?.into_iter().flatten().collect(), name: event.id.clone() })
}

/// Whether the rates of fields, or what carries them, depend on sums over them.
fn reads_totals(fields: &Document, scene: &eml::SceneDescription) -> bool {
    let system = &fields.system;
    let is_total = |quantity: &QuantityId| scene.totals.iter().any(|total| total.quantity == *quantity);
    let reads = |expr: &Expr| eml::reached(expr, system).iter().any(is_total);
    fields.fields.iter().any(|field| {
        let by_rate = match &system.quantities[field.quantity as usize].role {
            Role::Variable { rate } => reads(rate),
            _ => false,
        };
        by_rate || field.carriers().any(reads)
    })
}
