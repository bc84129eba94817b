//! One step of reactions, diffusion and exchange together, eq. (surface.5) and (surface.6).

use pulp::Simd;

use super::evaluate::{Atoms, Cell, rates, sum};
use super::mesh::SurfaceMesh;
use super::scratch::Work;
use super::shape::total;
use super::solve::{Matrix, outflow, solve};
use super::system::MembraneSystem;
use super::tableau::{B, C, ERROR, EXPLICIT, GAMMA, IMPLICIT, STAGES};

/// What the linear solver may leave of a density, over the tolerance of a step.
const LEFT: f64 = 1e-3;

/// The error of a step whose linear systems were not solved.
pub const UNSOLVED: f64 = f64::MAX;

/// Tries a step of each lane from `work.y` and `work.pools`; lanes whose step is 0 stay. Where it leads stands in `work.next` and
/// `work.pools_next`. Returns the error of each lane over what is allowed.
#[inline(always)]
pub fn attempt<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    work: &mut Work<L>,
    (time, step): (&[f64; L], &[f64; L]),
) -> [f64; L] {
    let mut error = [0.0; L];
    for stage in 0..STAGES {
        for variable in 0..system.variables() {
            let solved = spread_stage(system, mesh, work, variable, stage, step);
            for l in 0..L {
                error[l] = if solved[l] { error[l] } else { UNSOLVED };
            }
        }
        react_stage(simd, system, work, stage, (time, step));
    }
    for variable in 0..system.variables() {
        let own = arrive(system, work, variable, step);
        for l in 0..L {
            // A number that is not one is as bad as infinity.
            error[l] = if own[l] <= error[l] {
                error[l]
            } else if own[l].is_nan() {
                f64::INFINITY
            } else {
                own[l]
            };
        }
    }
    let own = arrive_pools(system, work, step);
    for l in 0..L {
        error[l] = if own[l] <= error[l] {
            error[l]
        } else if own[l].is_nan() {
            f64::INFINITY
        } else {
            own[l]
        };
    }
    error
}

/// The densities of a variable at a stage, and the rates of diffusion there. Returns which lanes were solved.
#[inline(always)]
fn spread_stage<const L: usize>(
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    work: &mut Work<L>,
    variable: usize,
    stage: usize,
    step: &[f64; L],
) -> [bool; L] {
    let (atoms, all) = (mesh.atoms, work.y.len());
    let (row, diffusion) = (variable * atoms..(variable + 1) * atoms, system.diffusion[variable]);
    let spreads = diffusion > 0.0;
    let Work { y, right, stage: values, explicit, implicit, areas, weights, gradients, .. } = work;
    let y = &y[row.clone()];
    right.copy_from_slice(y);
    for earlier in 0..stage {
        let (own, drift) = (&explicit[earlier * all..][row.clone()], &implicit[earlier * all..][row.clone()]);
        let (a, b) = (EXPLICIT[stage][earlier], if spreads { IMPLICIT[stage][earlier] } else { 0.0 });
        for i in 0..atoms {
            for l in 0..L {
                right[i][l] += step[l] * (a * own[i][l] + b * drift[i][l]);
            }
        }
    }
    let values = &mut values[row.clone()];
    values.copy_from_slice(right);
    if !spreads {
        implicit[stage * all..][row].fill([0.0; L]);
        return [true; L];
    }
    if stage == 0 {
        let drift = &mut implicit[row];
        for i in 0..atoms {
            let out = outflow(mesh, weights, y, i);
            for l in 0..L {
                drift[i][l] = -diffusion * out[l] / areas[i][l];
            }
        }
        return [true; L];
    }
    let (before, drift) = implicit.split_at_mut(stage * all);
    let (before, drift) = (&before[(stage - 1) * all..][row.clone()], &mut drift[row]);
    let (relative, absolute) = system.stepping.tolerances();
    let size = root_mean_square(areas, y);
    let (mut factor, mut inverse, mut bound) = ([0.0; L], [0.0; L], [0.0; L]);
    for l in 0..L {
        factor[l] = GAMMA * step[l] * diffusion;
        inverse[l] = if step[l] > 0.0 { 1.0 / (GAMMA * step[l]) } else { 0.0 };
        bound[l] = LEFT * (absolute + relative * size[l]);
    }
    // The first guess is that diffusion goes on as in the stage before.
    for i in 0..atoms {
        for l in 0..L {
            values[i][l] += GAMMA * step[l] * before[i][l];
        }
    }
    let solved = solve(&Matrix { mesh, areas, weights, factor }, right, values, &bound, gradients);
    for i in 0..atoms {
        for l in 0..L {
            drift[i][l] = (values[i][l] - right[i][l]) * inverse[l];
        }
    }
    solved
}

/// Sums over the surface, rates of reactions and rates of pools at a stage.
#[inline(always)]
fn react_stage<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    work: &mut Work<L>,
    stage: usize,
    (time, step): (&[f64; L], &[f64; L]),
) {
    let (all, pools) = (work.y.len(), work.pools.len());
    for pool in 0..pools {
        for l in 0..L {
            let change: f64 =
                (0..stage).map(|earlier| EXPLICIT[stage][earlier] * work.pool_rates[earlier * pools + pool][l]).sum();
            work.pools_stage[pool][l] = work.pools[pool][l] + step[l] * change;
        }
    }
    let mut now = *time;
    for l in 0..L {
        now[l] += C[stage] * step[l];
    }
    let Work { stage: values, coordinates, given, areas, open, registers, explicit, pool_rates, pools_stage, .. } =
        work;
    let cell = Cell { time: now, pools: pools_stage, area: work.area[0], volume: work.volume[0] };
    let atoms = Atoms { y: values, coordinates, given };
    sum(simd, system, &cell, (atoms, areas), open, registers);
    let to = (&mut explicit[stage * all..(stage + 1) * all], &mut pool_rates[stage * pools..(stage + 1) * pools]);
    rates(simd, system, &cell, atoms, open, registers, to);
}

/// Where a variable is at the end of the step. Returns its error over what is allowed.
#[inline(always)]
fn arrive<const L: usize>(system: &MembraneSystem, work: &mut Work<L>, variable: usize, step: &[f64; L]) -> [f64; L] {
    let (atoms, all) = (work.areas.len(), work.y.len());
    let row = variable * atoms..(variable + 1) * atoms;
    let Work { y, next, explicit, implicit, areas, .. } = work;
    let (y, next) = (&y[row.clone()], &mut next[row.clone()]);
    let of = |stage: usize| (&explicit[stage * all..][row.clone()], &implicit[stage * all..][row.clone()]);
    let stages: [_; STAGES] = std::array::from_fn(of);
    let (mut wrong, mut amount, mut found) = ([0.0; L], [0.0; L], [0.0; L]);
    for i in 0..atoms {
        for l in 0..L {
            let (mut made, mut moved, mut error) = (0.0, 0.0, 0.0);
            for (stage, (own, drift)) in stages.iter().enumerate() {
                made += B[stage] * own[i][l];
                moved += B[stage] * drift[i][l];
                error += ERROR[stage] * (own[i][l] + drift[i][l]);
            }
            let (area, error) = (areas[i][l], step[l] * error);
            let without = y[i][l] + step[l] * made;
            let value = without + step[l] * moved;
            next[i][l] = value;
            wrong[l] += area * error * error;
            amount[l] += area * without;
            found[l] += area * value;
        }
    }
    // Diffusion moves substance and makes none: what the linear solver left is spread over the surface.
    let whole = total(areas);
    if system.diffusion[variable] > 0.0 {
        for value in next.iter_mut() {
            for l in 0..L {
                value[l] += (amount[l] - found[l]) / whole[l];
            }
        }
    }
    let size = root_mean_square(areas, next);
    let (relative, absolute) = system.stepping.tolerances();
    std::array::from_fn(|l| (wrong[l] / whole[l]).sqrt() / (absolute + relative * size[l]))
}

/// The same of the pools.
#[inline(always)]
fn arrive_pools<const L: usize>(system: &MembraneSystem, work: &mut Work<L>, step: &[f64; L]) -> [f64; L] {
    let pools = work.pools.len();
    let (relative, absolute) = system.stepping.tolerances();
    let mut worst = [0.0; L];
    for pool in 0..pools {
        for l in 0..L {
            let (mut made, mut error) = (0.0, 0.0);
            for stage in 0..STAGES {
                let rate = work.pool_rates[stage * pools + pool][l];
                made += B[stage] * rate;
                error += ERROR[stage] * rate;
            }
            let value = work.pools[pool][l] + step[l] * made;
            work.pools_next[pool][l] = value;
            let own = (step[l] * error).abs() / (absolute + relative * value.abs());
            worst[l] = if own <= worst[l] { worst[l] } else { own };
        }
    }
    worst
}

/// The root of the mean over the area of the square.
#[inline(always)]
fn root_mean_square<const L: usize>(areas: &[[f64; L]], values: &[[f64; L]]) -> [f64; L] {
    let (mut sum, mut whole) = ([0.0; L], [0.0; L]);
    for (area, value) in areas.iter().zip(values) {
        for l in 0..L {
            sum[l] += area[l] * value[l] * value[l];
            whole[l] += area[l];
        }
    }
    std::array::from_fn(|l| (sum[l] / whole[l]).sqrt())
}
