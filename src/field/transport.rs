//! What carries the fields of a document beyond one diffusion coefficient each and walls that stay: flow, taxis, diffusion that varies, walls with
//! a course or a flux, and sources. Compiled, and never changed.

use super::grid::Grid;
use super::scales::Scales;
use super::sites::Sites;
use super::tables::{Coefficient, Now, Table};
use crate::equations::Range;
use crate::equations::eml::{Document, FieldDescription, FieldSource, Wall, reads};
use crate::equations::tree::Expr;
use crate::error::{Error, Fault, Result};

/// The transport of a document's fields.
#[derive(Debug, Clone)]
pub struct Transport {
    pub carried: Vec<Carried>,
    pub tables: Vec<Table>,
    /// The tables that stand still; of the others the room that they take.
    pub still: Vec<Vec<f64>>,
    pub ranges: Vec<Range>,
    pub scales: Scales,
}

/// How one field is carried, µm and s.
#[derive(Debug, Clone)]
pub struct Carried {
    pub species: usize,
    /// In the boxes, µm²/s.
    pub diffusion: Coefficient,
    /// Whether the diffusion coefficient depends on fields: then that of a face is the mean of both boxes, and else their harmonic mean.
    pub follows_fields: bool,
    /// 1/s.
    pub decay: f64,
    /// On the faces across each axis, µm/s; none where nothing flows.
    pub velocity: [Option<Coefficient>; 3],
    /// The species that is followed and the sensitivity in the boxes, µm²/s for each unit of it.
    pub taxis: Vec<(usize, Coefficient)>,
    pub walls: [[CarriedWall; 2]; 3],
    pub sources: Vec<Source>,
}

/// What a wall does to what is carried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CarriedWall {
    NoFlux,
    Periodic,
    Fixed(Coefficient),
    /// What comes in, and its derivative by the field.
    Flux(Coefficient, Coefficient),
    Open(Coefficient),
}

/// A source: what comes from it, amount/s, and its boxes with their shares over the measure of a box.
#[derive(Debug, Clone)]
pub struct Source {
    pub strength: Coefficient,
    pub boxes: Vec<(usize, f64)>,
}

impl Transport {
    /// The transport of a document on a grid; none where no field is carried.
    ///
    /// # Errors
    /// A source outside the grid; a diffusion coefficient below 0 where it stands still; definitions in a circle.
    pub fn new(document: &Document, grid: &Grid, constants: &[f64], scales: Scales) -> Result<Option<Self>> {
        let carried = |field: &&FieldDescription| field.is_carried(&document.system);
        if !document.fields.iter().any(|field| carried(&field)) {
            return Ok(None);
        }
        let mut builder = Builder { document, grid, constants, scales, tables: Vec::new() };
        let mut found = Vec::new();
        for (species, field) in document.fields.iter().enumerate().filter(|(_, field)| carried(field)) {
            found.push(builder.carried(species, field)?);
        }
        let ranges: Vec<Range> = document.fields.iter().map(|field| field.range).collect();
        let mut file = Vec::new();
        let mut still = Vec::new();
        for table in &builder.tables {
            let mut values = vec![0.0; table.sites.len(grid)];
            if !table.varies {
                let now = Now { grid, scales, time: 0.0, inputs: &[], values: &[], ranges: &ranges };
                table.fill(&now, 0, &mut values, &mut file);
            }
            still.push(values);
        }
        let transport = Self { carried: found, tables: builder.tables, still, ranges, scales };
        transport.check(document, grid)?;
        Ok(Some(transport))
    }

    /// Whether a species is carried.
    pub fn carries(&self, species: usize) -> bool {
        self.carried.iter().any(|carried| carried.species == species)
    }

    /// Tells numbers that stand still and have no meaning.
    fn check(&self, document: &Document, grid: &Grid) -> Result<()> {
        for carried in &self.carried {
            let field = &document.fields[carried.species];
            if let Coefficient::Table(number) = carried.diffusion
                && let Some(at) = self.still[number].iter().position(|value| !(*value >= 0.0 && value.is_finite()))
            {
                let value = self.still[number][at];
                let told = grid.told(at);
                let message = format!("the diffusion coefficient of `{}` is {value} µm²/s at {told} µm", field.id);
                let help = "a field that gathers by itself has no solution: let it be 0 or more everywhere";
                return Err(Error::input(Fault::new(message).at(field.location.clone()).help(help)));
            }
        }
        Ok(())
    }
}

struct Builder<'a> {
    document: &'a Document,
    grid: &'a Grid,
    constants: &'a [f64],
    scales: Scales,
    tables: Vec<Table>,
}

impl Builder<'_> {
    fn coefficient(&mut self, sites: Sites, expr: &Expr, factor: f64) -> Result<Coefficient> {
        if reads(expr, &self.document.system).is_number() {
            return Ok(Coefficient::Number(factor * self.value(expr)));
        }
        self.tables.push(Table::new(self.document, sites, expr, factor)?);
        Ok(Coefficient::Table(self.tables.len() - 1))
    }

    fn value(&self, expr: &Expr) -> f64 {
        expr.evaluate(0.0, &|number| self.constants[number as usize])
    }

    fn carried(&mut self, species: usize, field: &FieldDescription) -> Result<Carried> {
        let Scales { seconds, micrometres } = self.scales;
        let (spreads, speed) = (micrometres * micrometres / seconds, micrometres / seconds);
        let diffusion = self.coefficient(Sites::Boxes, &field.diffusion, spreads)?;
        let mut velocity = [None; 3];
        for (axis, along) in field.advection.iter().flatten().enumerate() {
            if self.grid.cells[axis] > 1 && *along != Expr::Number(0.0) {
                velocity[axis] = Some(self.coefficient(Sites::Faces(axis), along, speed)?);
            }
        }
        let mut taxis = Vec::new();
        for one in &field.taxis {
            let fields = &self.document.fields;
            let towards = fields.iter().position(|field| field.quantity == one.towards).expect("a field is followed");
            taxis.push((towards, self.coefficient(Sites::Boxes, &one.sensitivity, spreads)?));
        }
        let mut walls = [[CarriedWall::NoFlux; 2]; 3];
        for (number, wall) in field.walls.iter().enumerate() {
            let sites = Sites::Wall(number / 2, number % 2);
            walls[number / 2][number % 2] = match wall {
                Wall::NoFlux => CarriedWall::NoFlux,
                Wall::Periodic => CarriedWall::Periodic,
                Wall::Fixed(value) => CarriedWall::Fixed(self.coefficient(sites, value, 1.0)?),
                Wall::Open(value) => CarriedWall::Open(self.coefficient(sites, value, 1.0)?),
                Wall::Flux(value) => {
                    if reads(value, &self.document.system).fields {
                        let tables = Table::with_slope(self.document, sites, value, field.quantity, speed)?;
                        self.tables.extend(tables);
                        let number = self.tables.len();
                        CarriedWall::Flux(Coefficient::Table(number - 2), Coefficient::Table(number - 1))
                    } else {
                        CarriedWall::Flux(self.coefficient(sites, value, speed)?, Coefficient::Number(0.0))
                    }
                }
            };
        }
        let sources = field.sources.iter().map(|source| self.source(source)).collect::<Result<_>>()?;
        Ok(Carried {
            species,
            diffusion,
            follows_fields: reads(&field.diffusion, &self.document.system).fields,
            decay: self.value(&field.decay) / seconds,
            velocity,
            taxis,
            walls,
            sources,
        })
    }

    fn source(&mut self, source: &FieldSource) -> Result<Source> {
        let Scales { seconds, micrometres } = self.scales;
        let grid = self.grid;
        let dimension = grid.dimension();
        let ends = source.ends.map(|end| end.map(|number| number * micrometres));
        for end in ends {
            for axis in 0..dimension {
                let (low, n) = (grid.origin[axis], grid.cells[axis] as f64);
                if !(low..=low + n * grid.spacing[axis]).contains(&end[axis]) {
                    let message = "a source lies outside the grid";
                    let help = "move it, or write a larger `size` of <grid>";
                    return Err(Error::input(Fault::new(message).at(source.location.clone()).help(help)));
                }
            }
        }
        let strength = self.coefficient(Sites::Once, &source.strength, micrometres.powi(dimension as i32) / seconds)?;
        Ok(Source { strength, boxes: deposit(grid, ends) })
    }
}

/// Points on a line for each box that it passes.
const POINTS_A_BOX: f64 = 8.0;

/// The boxes that share what comes from a line, or a point, with their shares over the measure of a box: those of linear interpolation,
/// eq. (field.8), evenly along the line.
fn deposit(grid: &Grid, [from, to]: [[f64; 3]; 2]) -> Vec<(usize, f64)> {
    let dimension = grid.dimension();
    let length = (0..dimension).map(|axis| ((to[axis] - from[axis]) / grid.spacing[axis]).abs()).fold(0.0, f64::max);
    let points = (POINTS_A_BOX * length).ceil().max(1.0);
    let mut shares = std::collections::BTreeMap::<usize, f64>::new();
    for point in 0..points as usize {
        let part = (point as f64 + 0.5) / points;
        // Along each axis the two boxes that share, and the part of the second.
        let pairs: [([usize; 2], f64); 3] = std::array::from_fn(|axis| {
            let n = grid.cells[axis];
            if n == 1 {
                return ([0, 0], 0.0);
            }
            let position = from[axis] + part * (to[axis] - from[axis]);
            let boxes = ((position - grid.origin[axis]) / grid.spacing[axis] - 0.5).clamp(0.0, (n - 1) as f64);
            let low = (boxes as usize).min(n - 2);
            ([low, low + 1], boxes - low as f64)
        });
        for corner in 0..8 {
            let side = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight: f64 =
                (0..3).map(|axis| if side[axis] == 1 { pairs[axis].1 } else { 1.0 - pairs[axis].1 }).product();
            let index: [usize; 3] = std::array::from_fn(|axis| pairs[axis].0[side[axis]]);
            if weight > 0.0 {
                *shares.entry(grid.at(index[0], index[1], index[2])).or_insert(0.0) += weight;
            }
        }
    }
    shares.into_iter().map(|(at, weight)| (at, weight / points / grid.measure())).collect()
}
