//! Noise of populations: what kicks the cells of a system, eq. (noise.2).

use pulp::{Arch, Simd, WithSimd};

use super::buffers::PopulationScratch;
use super::events::assigned_parameters;
use super::population::{LANES, Population};
use super::substeps::Kick;
use super::{OdeTrouble, Reason};
use crate::equations::eml::Document;
use crate::equations::program::{Lanes, Program, run_wide};
use crate::random::{Choices, Normals, Purpose};

/// How strongly the variables of a system are kicked: compiled, and never changed.
#[derive(Debug, Clone)]
pub struct Noise {
    /// The system, with the strengths as its only further group.
    program: Program,
    /// The variables that are kicked, by their numbers in the state.
    variables: Vec<usize>,
}

/// Whose random numbers kick, and choose between events.
#[derive(Debug, Clone, Copy)]
pub struct Numbers<'a> {
    /// The seed of the run.
    pub seed: u64,
    /// The name of the system in the run.
    pub system: &'a str,
}

impl Numbers<'_> {
    /// Those that choose between events of one time and one priority.
    pub(super) fn choices(&self) -> Choices {
        Choices::new(self.seed, Purpose::Events, &[self.system])
    }

    /// The numbers of a variable.
    pub fn of(&self, variable: &str) -> Normals {
        Normals::new(self.seed, Purpose::Noise, &[self.system, variable])
    }
}

impl Noise {
    /// The noise of a document of the scene or of cells; none where no variable has any.
    ///
    /// # Errors
    /// The identifiers along a circle of definitions or initial values.
    pub fn new(document: &Document) -> Result<Option<Self>, Vec<String>> {
        if document.noise.is_empty() {
            return Ok(None);
        }
        let strengths = document.noise.iter().map(|noise| noise.strength.clone()).collect();
        let open = assigned_parameters(&document.system);
        let program = Program::with(&document.system, 0.0, &open, &[strengths])?;
        let variables = document.noise.iter().filter_map(|noise| program.variable_index(noise.quantity));
        Ok(Some(Self { variables: variables.collect(), program }))
    }
}

impl Population {
    /// Kicks all cells at a time of the system, eq. (noise.2); `ids` has one number a cell, which is never that of another. What a cell gets does
    /// not depend on the others. Nothing is allocated after the first time with the same scratch.
    ///
    /// # Errors
    /// A cell of which a number is none after the kick; the population then holds anything.
    ///
    /// # Panics
    /// When the noise is that of a system with other variables or open quantities.
    pub fn kick(
        &mut self,
        noise: &Noise,
        numbers: Numbers,
        ids: impl Iterator<Item = u64>,
        (time, kick): (f64, Kick),
        scratch: &mut PopulationScratch,
    ) -> Result<(), OdeTrouble> {
        let program = &noise.program;
        assert_eq!((self.variables, self.open), (program.size(), program.open.len()), "the population's own noise");
        let PopulationScratch { kicks: file, normals, .. } = scratch;
        program.suit(file);
        normals.clear();
        let name = |variable: &usize| program.names[program.variables[*variable] as usize].as_str();
        normals.extend(noise.variables.iter().map(|variable| numbers.of(name(variable))));
        let broken = Arch::new().dispatch(Blocks { population: self, noise, normals, ids, time, kick, file });
        broken.map_or(Ok(()), |(cell, variable)| {
            Err(OdeTrouble {
                system: program.name.clone(),
                cell: Some(cell),
                time,
                variable: Some(name(&variable).to_owned()),
                reason: Reason::NotFinite,
                detail: "of its noise".to_owned(),
            })
        })
    }
}

/// All blocks of a population, as an object with a method of its own: only so is all of it compiled for the wide registers.
struct Blocks<'a, I> {
    population: &'a mut Population,
    noise: &'a Noise,
    /// The numbers of each variable that is kicked.
    normals: &'a [Normals],
    ids: I,
    time: f64,
    kick: Kick,
    file: &'a mut [Lanes<LANES>],
}

impl<I: Iterator<Item = u64>> WithSimd for Blocks<'_, I> {
    /// A cell that has no number after the kick, and the variable.
    type Output = Option<(usize, usize)>;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let mut broken = None;
        let Self { population, noise, normals, mut ids, time, kick, file } = self;
        let (n, m, root) = (population.variables, population.open, kick.span.sqrt());
        let code = &noise.program.further[0];
        for block in 0..population.blocks() {
            let states = &mut population.states[block * n..(block + 1) * n];
            file[0] = [time; LANES];
            file[1..=n].copy_from_slice(states);
            file[1 + n..1 + n + m].copy_from_slice(&population.open_values[block * m..(block + 1) * m]);
            run_wide(simd, code, file);
            let (mut cells, count) = ([0; LANES], LANES.min(population.cells - block * LANES));
            for (cell, id) in cells[..count].iter_mut().zip(&mut ids) {
                *cell = id as u32;
            }
            for ((&variable, normals), &output) in noise.variables.iter().zip(normals).zip(&code.outputs) {
                let [numbers, _] = normals.pairs(kick.number, &cells, &[0; LANES]);
                let strength = &file[output as usize];
                for l in 0..count {
                    states[variable][l] += strength[l] * root * numbers[l];
                    if !states[variable][l].is_finite() && broken.is_none() {
                        broken = Some((block * LANES + l, variable));
                    }
                }
            }
        }
        broken
    }
}
