//! Where the grid of a document lies, by its own origin and size or those that the experiment gives it, and its fields
//! in µm and s.

use super::grid::{FEWEST, Grid, Wall};
use super::scales::Scales;
use super::species::Species;
use crate::Vec3;
use crate::equations::eml::{self, Document, GridDescription, reads};
use crate::equations::tree::{Expr, System};
use crate::error::{Error, Fault, Result};

/// Where the experiment puts a grid whose document leaves origin or size open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placing {
    /// The lower corner, µm. Its third number is the height of a field on the substrate.
    pub origin: [f64; 3],
    /// Lengths of the sides, µm; the third counts in the medium only.
    pub size: [f64; 3],
}

/// Most boxes of a grid.
const MOST: f64 = (1_u64 << 31) as f64;
/// A size that is a multiple of the spacing but for round-off counts as one.
const ROUND_OFF: f64 = 1e-9;
/// Arrays as large as the values that moving the fields needs, the values included.
pub const ARRAYS: usize = 6;
/// The same that transport needs beside them: stages, rates, and coefficients that vary.
pub const CARRYING: usize = 8;

/// The grid of a document in µm, if memory holds its fields.
pub fn layout(document: &Document, placing: Option<&Placing>) -> Result<Grid> {
    let Some(wanted) = &document.grid else {
        let message = format!("the document '{}' has no grid", document.name);
        let fault = Fault::new(message).help("give it a <grid> and a <field>");
        return Err(Error::input(match document.locations.first() {
            Some(location) => fault.at(location.clone()),
            None => fault,
        }));
    };
    let fault = |message: String, help: String| Fault::new(message).at(wanted.location.clone()).help(help);
    let in_micrometres = |numbers: [f64; 3]| numbers.map(|number| number * wanted.micrometres);
    let flat = wanted.dimension < 3;
    let origin = wanted.origin.map(in_micrometres).or(placing.map(|placing| placing.origin));
    let size = wanted.size.map(in_micrometres).or(placing.map(|placing| placing.size));
    let mut faults = Vec::new();
    for (name, open) in [("origin", origin.is_none()), ("size", size.is_none())] {
        if open {
            let example = match (name, wanted.dimension) {
                ("origin", 1) => "0",
                ("origin", 2) => "0 0",
                ("origin", _) => "0 0 0",
                (_, 1) => "100",
                (_, 2) => "100 100",
                _ => "100 100 50",
            };
            let help = format!(
                "write {name}=\"{example}\" in <grid>, or give `size` (and `origin`) beside the document in the experiment, or --size to `eml solve`"
            );
            faults.push(fault(format!("the grid has no {name}, and nothing else places it"), help));
        }
    }
    let (Some(mut origin), Some(size)) = (origin, size) else { return Err(Error::Input(faults)) };
    if document.fields.is_empty() {
        let help = "declare <field id=\"c\" initial=\"0\" diffusion=\"1\"/>".to_owned();
        faults.push(fault(format!("the grid of '{}' has no fields", document.name), help));
    }
    if let (true, Some(placing)) = (flat, placing) {
        origin[2] = placing.origin[2];
    }
    let spacing = wanted.spacing * wanted.micrometres;
    let counts = boxes(wanted, size, spacing);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(wanted.dimension) {
        if !(size[axis].is_finite() && size[axis] > 0.0) {
            let message = format!("the grid is {} µm long along {name}", size[axis]);
            faults.push(fault(message, "give it a positive length".into()));
        } else if counts[axis] < FEWEST as f64 {
            let message = format!("the grid has {} boxes along {name}; {FEWEST} or more were expected", counts[axis]);
            let help = format!("let `spacing` be at most a {FEWEST}th of the side, {} µm", size[axis]);
            faults.push(fault(message, help));
        }
    }
    let count: f64 = counts.iter().product();
    if count.is_nan() || count > MOST {
        let told = counts[..wanted.dimension].iter().map(f64::to_string).collect::<Vec<_>>().join(" × ");
        let message = format!("the grid has {told} boxes; {MOST} at most were expected");
        faults.push(fault(message, "choose a wider spacing or a smaller size".into()));
    }
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    let carried = document.fields.iter().any(|field| field.is_carried(&document.system));
    let arrays = if carried { ARRAYS + CARRYING } else { ARRAYS };
    let numbers = count as usize * document.fields.len().max(1) * arrays;
    if Vec::<f64>::new().try_reserve_exact(numbers).is_err() {
        let gigabytes = (numbers as f64 * 8e-9).ceil();
        let message = format!("the fields need {gigabytes} GB of memory, more than there is");
        return Err(Error::input(fault(message, "choose a wider spacing or a smaller size".into())));
    }
    let mut spacings = [spacing; 3];
    if wanted.dimension == 1 {
        // Around the axis, where y and z are 0.
        (spacings, origin) = ([spacing, 1.0, 1.0], [origin[0], -0.5, 0.0]);
    }
    Grid::new(counts.map(|count| count as usize), spacings, Vec3::from(origin)).map_err(|error| match error {
        Error::Input(more) => Error::Input(more.into_iter().map(|one| one.at(wanted.location.clone())).collect()),
        other => other,
    })
}

/// Boxes along each axis: as many as cover the size, so that the spacing is kept.
fn boxes(wanted: &GridDescription, size: [f64; 3], spacing: f64) -> [f64; 3] {
    let count = |axis: usize| {
        if axis >= wanted.dimension { 1.0 } else { (size[axis] / spacing * (1.0 - ROUND_OFF)).ceil().max(1.0) }
    };
    [count(0), count(1), count(2)]
}

/// A field with its coefficients in µm and s.
///
/// Of one that is carried a diffusion coefficient that is no number counts as 0 here. A wall whose value does not stay, or through which it
/// passes otherwise, counts as closed where it is sensed.
pub fn describe(field: &eml::FieldDescription, system: &System, constants: &[f64], scales: Scales) -> Species {
    let value = |expr: &Expr| expr.evaluate(0.0, &|number| constants[number as usize]);
    let wall = |number: usize| match &field.walls[number] {
        eml::Wall::NoFlux => Wall::NoFlux,
        eml::Wall::Fixed(held) if reads(held, system).is_number() => Wall::Fixed(value(held)),
        eml::Wall::Fixed(_) | eml::Wall::Flux(_) | eml::Wall::Open(_) => Wall::NoFlux,
        eml::Wall::Periodic => Wall::Periodic,
    };
    let walls = [[wall(0), wall(1)], [wall(2), wall(3)], [wall(4), wall(5)]];
    let spreads = if reads(&field.diffusion, system).is_number() { value(&field.diffusion) } else { 0.0 };
    let diffusion = spreads * scales.micrometres * scales.micrometres / scales.seconds;
    let species = Species::new(field.id.clone(), diffusion, value(&field.decay) / scales.seconds)
        .with_walls(walls)
        .with_range(field.range);
    Species { carried: field.is_carried(system), ..species }
}

/// The unit of a field, as written.
pub fn unit(system: &System, field: &eml::FieldDescription) -> String {
    system.quantities[field.quantity as usize].unit.clone()
}
