//! Where membranes start, and what is summed over them where they stand.

use pulp::Simd;

use super::evaluate::{Atoms, Cell, measures, start, sum};
use super::mesh::SurfaceMesh;
use super::scratch::Work;
use super::shape::{areas, coordinates};
use super::system::MembraneSystem;
use super::window::Part;

/// Gives the cells of a block that have not started their first values, and works out what is summed over their surfaces.
#[inline(always)]
pub fn begin<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    part: &mut Part<L>,
    x: &[[f64; L]],
    time: f64,
    work: &mut Work<L>,
) {
    let pools = system.inside.size();
    let fresh: [bool; L] = std::array::from_fn(|l| l < part.cells && part.areas[0][l] == 0.0);
    areas(mesh, x, &mut work.areas);
    coordinates(x, &work.areas, &mut work.coordinates);
    let (area, volume) = measures(mesh, x, &work.areas);
    work.open.copy_from_slice(&part.inside[pools..]);
    work.pools.copy_from_slice(&part.inside[..pools]);
    let Work { next, pools_next, open, registers, .. } = work;
    let cell = Cell { time: [time; L], pools: &work.pools, area, volume };
    let atoms = Atoms { y: &[], coordinates: &work.coordinates, given: part.given };
    start(simd, system, &cell, atoms, open, registers, (next, pools_next));
    for l in (0..L).filter(|l| fresh[*l]) {
        part.values.iter_mut().zip(&*next).for_each(|(value, start)| value[l] = start[l]);
        part.areas.iter_mut().zip(&work.areas).for_each(|(area, own)| area[l] = own[l]);
        work.pools.iter_mut().zip(&*pools_next).for_each(|(pool, start)| pool[l] = start[l]);
        part.volume[l] = volume[l];
    }
    let cell = Cell { time: [time; L], pools: &work.pools, area, volume };
    sum(simd, system, &cell, (Atoms { y: part.values, ..atoms }, &work.areas), open, registers);
    for l in (0..L).filter(|l| fresh[*l]) {
        part.inside.iter_mut().zip(work.pools.iter().chain(&*open)).for_each(|(to, value)| to[l] = value[l]);
    }
}
