//! Noise on surfaces and in pools, eq. (noise.3).

use pulp::Simd;

use super::evaluate::{Atoms, Cell, strengths, sum};
use super::scratch::Work;
use super::system::MembraneSystem;
use crate::ode::{Kick, Numbers, Substep, Substeps};

/// A window of time: how noise cuts it, and with which numbers it kicks.
#[derive(Debug, Clone, Copy)]
pub struct Course<'a> {
    /// The window, in the document's unit of time.
    pub substeps: Substeps,
    /// Whose random numbers kick.
    pub numbers: Numbers<'a>,
    /// A number of each cell that is never that of another.
    pub ids: &'a [u64],
}

impl Course<'_> {
    /// The numbers of the cells of a block, 0 of lanes without one.
    #[inline(always)]
    fn cells<const L: usize>(&self, block: usize) -> [u32; L] {
        std::array::from_fn(|l| self.ids.get(block * L + l).map_or(0, |id| *id as u32))
    }
}

/// Kicks the cells of a block where a part of the window begins.
#[inline(always)]
pub fn kick<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    (course, block): (&Course, usize),
    (part, kick): (&Substep, Kick),
    work: &mut Work<L>,
) {
    let Work { y, coordinates, given, areas, pools, open, registers, explicit, pool_rates, area, volume, .. } = work;
    let cell = Cell { time: [part.begin; L], pools, area: area[0], volume: volume[0] };
    let atoms = Atoms { y, coordinates, given };
    // Where densities have moved since sums were taken, so have these.
    sum(simd, system, &cell, (atoms, areas), open, registers);
    // Rates are worked out after the kick: their memory is free.
    strengths(simd, system, &cell, atoms, open, registers, (explicit, pool_rates));
    let (cells, count) = (course.cells::<L>(block), areas.len());
    let [surface, of_pools] = &system.noisy;
    for (strengths, &variable) in explicit.chunks_exact(count).zip(surface) {
        let normals = course.numbers.of(&system.names[variable].0);
        let y = &mut y[variable * count..(variable + 1) * count];
        for (pair, two) in y.chunks_mut(2).enumerate() {
            let numbers = normals.pairs(kick.number, &cells, &[pair as u32; L]);
            for (half, (value, number)) in two.iter_mut().zip(&numbers).enumerate() {
                let (strength, area) = (&strengths[2 * pair + half], &areas[2 * pair + half]);
                for l in 0..L {
                    value[l] += strength[l] * (kick.span / area[l]).sqrt() * number[l];
                }
            }
        }
    }
    let (root, program) = (kick.span.sqrt(), &system.inside);
    for (strength, &pool) in pool_rates.iter().zip(of_pools) {
        let normals = course.numbers.of(&program.names[program.variables[pool] as usize]);
        let [numbers, _] = normals.pairs(kick.number, &cells, &[0; L]);
        for l in 0..L {
            pools[pool][l] += strength[l] * root * numbers[l];
        }
    }
}
