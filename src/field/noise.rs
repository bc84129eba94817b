//! Noise of fields, eq. (noise.4).

use pulp::{Arch, Simd, WithSimd};

use super::grid::Grid;
use super::positions::{Positions, positions, set_positions};
use super::react::{Chunk, POINTS, react};
use super::rows::ROW;
use super::scales::{POSITION, Scales, in_circle};
use super::state::Fields;
use crate::equations::eml::Document;
use crate::equations::program::{Program, run_wide};
use crate::error::Result;
use crate::ode::{Kick, Numbers};

/// How strongly the fields of a document are kicked: compiled, and never changed.
#[derive(Debug, Clone)]
pub struct Noise {
    /// The equations, with the strengths as their only further group.
    program: Program,
    /// The fields that are kicked.
    species: Vec<usize>,
    /// Where the position and the inputs stand among the registers.
    position_registers: Positions,
    inputs: Vec<usize>,
    scales: Scales,
}

/// Pairs of neighbours that are kicked side by side.
const PAIRS: usize = 8;

impl Noise {
    /// The noise of a document; none where no field has any.
    ///
    /// # Errors
    /// Definitions in a circle.
    pub fn new(document: &Document, scales: Scales) -> Result<Option<Self>> {
        if document.noise.is_empty() {
            return Ok(None);
        }
        let strengths = document.noise.iter().map(|noise| noise.strength.clone()).collect();
        let program =
            Program::with(&document.system, 0.0, &[], &[strengths]).map_err(|circle| in_circle(document, &circle))?;
        let position_registers = positions(&program, &program.further[0]);
        let ours = |number: &usize| !POSITION.contains(&program.names[program.open[*number] as usize].as_str());
        let inputs = (0..program.open.len()).filter(ours).map(|number| program.first_open() + number).collect();
        let species = document.noise.iter().filter_map(|noise| program.variable_index(noise.quantity)).collect();
        Ok(Some(Self { program, species, position_registers, inputs, scales }))
    }

    /// Kicks all boxes. What a box gets depends on its own values alone.
    pub fn kick(&self, fields: &mut Fields, inputs: &[f64], kick: Kick, numbers: Numbers) {
        let Fields { grid, species, values, work, time, .. } = fields;
        let (time, grid) = (*time, &*grid);
        // In the document's units of time and length.
        let measure = grid.measure() / self.scales.micrometres.powi(grid.dimension() as i32);
        let factor = (kick.span / self.scales.seconds / measure).sqrt();
        let one = |chunk: &mut Chunk| {
            let (number, time) = (kick.number, time / self.scales.seconds);
            Arch::new().dispatch(Job { noise: self, grid, inputs, chunk, numbers, number, time, factor });
        };
        react(grid, species, &one, (time, 0.0), values, &mut work.reacting);
    }
}

/// The boxes of a chunk, so that they are kicked in the processor's lanes.
struct Job<'a, 'c> {
    noise: &'a Noise,
    grid: &'a Grid,
    inputs: &'a [f64],
    chunk: &'a mut Chunk<'c>,
    numbers: Numbers<'a>,
    number: u64,
    time: f64,
    factor: f64,
}

impl WithSimd for Job<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { noise, grid, inputs, chunk, numbers, number, time, factor } = self;
        let Noise { program, species, position_registers, inputs: registers, scales } = noise;
        let file = &mut *chunk.kicks;
        program.suit(file);
        let code = &program.further[0];
        for first in (0..chunk.points).step_by(ROW) {
            file[0] = [time; ROW];
            for (s, register) in file[1..=program.size()].iter_mut().enumerate() {
                register.copy_from_slice(&chunk.values[s * POINTS + first..][..ROW]);
            }
            for (register, value) in registers.iter().zip(inputs) {
                file[*register] = [*value; ROW];
            }
            set_positions(grid, *scales, position_registers, chunk.first + first, file);
            run_wide(simd, code, file);
            for (&s, &output) in species.iter().zip(&code.outputs) {
                let normals = numbers.of(&program.names[program.variables[s] as usize]);
                let values = &mut chunk.values[s * POINTS + first..][..ROW];
                let strengths = file[output as usize].chunks_exact(2 * PAIRS);
                for (part, (values, strengths)) in values.chunks_exact_mut(2 * PAIRS).zip(strengths).enumerate() {
                    let begin = ((chunk.first + first) / 2 + part * PAIRS) as u32;
                    let pairs = std::array::from_fn(|l| begin + l as u32);
                    let numbers = normals.pairs(number, &[0; PAIRS], &pairs);
                    for l in 0..PAIRS {
                        values[2 * l] += strengths[2 * l] * factor * numbers[0][l];
                        values[2 * l + 1] += strengths[2 * l + 1] * factor * numbers[1][l];
                    }
                }
            }
        }
    }
}
