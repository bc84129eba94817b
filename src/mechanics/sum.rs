//! The sum of all forces on a block of cells.

use super::control::Context;
use super::lanes::{BlockWork, LANES, Real, Vectors, VectorsMut, dispatch};
use super::stiffness::StiffnessMatrix;
use super::{CONTROLLED, Force};
use crate::Vec3;

/// Sets `f` to the sum of all forces on the atoms of a block of `lanes` cells at `x` (µm), pN, and `energy` to the energy of each
/// cell, pN·µm. Elastic forces come first, and are scaled together; each of both groups is added up in the order of the list.
pub fn measure_forces(forces: &[Force], context: &Context, lanes: usize, x: &[f64], f: &mut [f64], energy: &mut [f64]) {
    measure_elastic(forces, lanes, x, f, energy);
    if !context.stiffness.is_empty() {
        let factors = context.stiffness();
        for row in f.chunks_exact_mut(lanes).chain([&mut *energy]) {
            row.iter_mut().zip(&factors).for_each(|(slot, factor)| *slot *= factor);
        }
    }
    measure_others(forces, context, lanes, x, f, energy, |_| true);
}

/// The same of forces from outside alone; their energy is added to `energy`.
pub fn measure_outer(forces: &[Force], context: &Context, lanes: usize, x: &[f64], f: &mut [f64], energy: &mut [f64]) {
    f.fill(0.0);
    measure_others(forces, context, lanes, x, f, energy, Force::is_outer);
}

/// Adds the forces that are not elastic and that are wanted.
fn measure_others(
    forces: &[Force],
    context: &Context,
    lanes: usize,
    x: &[f64],
    f: &mut [f64],
    energy: &mut [f64],
    is_wanted: impl Fn(&Force) -> bool,
) {
    // How many forces with each handle there were.
    let mut numbers = [0; CONTROLLED.len()];
    for force in forces.iter().filter(|force| !force.is_elastic()) {
        let set = force.handle().map(|(handle, _)| {
            numbers[handle] += 1;
            context.control(handle, numbers[handle] - 1, CONTROLLED[handle].unset)
        });
        if !is_wanted(force) {
            continue;
        }
        let strength = force.strength(context, &set.unwrap_or([1.0; LANES]));
        let (forces, strength) = (std::slice::from_ref(force), &strength[..lanes]);
        dispatch(lanes, Work { forces, elastic: false, strength, x, f, energy });
    }
}

/// The same of elastic forces alone, as they are without chemistry.
pub fn measure_elastic(forces: &[Force], lanes: usize, x: &[f64], f: &mut [f64], energy: &mut [f64]) {
    f.fill(0.0);
    energy.fill(0.0);
    dispatch(lanes, Work { forces, elastic: true, strength: &[1.0; LANES][..lanes], x, f, energy });
}

/// The linear part of the elastic forces for the implicit step, pN/µm, as it is fit for the shape `x` (µm) of a cell with this rest
/// shape.
pub fn stiffness(forces: &[Force], rest: &[Vec3], x: &[Vec3]) -> StiffnessMatrix {
    let mut matrix = StiffnessMatrix::new(rest.len());
    let elastic = forces.iter().filter(|force| force.is_elastic());
    elastic.for_each(|force| force.add_stiffness(rest, x, &mut matrix));
    matrix
}

/// Some forces on a block of cells.
struct Work<'a> {
    forces: &'a [Force],
    /// Whether those that are elastic are meant, or those that are not.
    elastic: bool,
    /// How strongly they act in each lane.
    strength: &'a [f64],
    x: &'a [f64],
    f: &'a mut [f64],
    energy: &'a mut [f64],
}

impl BlockWork for Work<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let (x, strength) = (T::view(token, self.x), T::view(token, self.strength));
        let f = T::view_mut(token, self.f);
        let energy = T::view_mut(token, self.energy);
        for part in 0..stride {
            let x = Vectors::<T>::new(token, x, stride, part);
            let mut f = VectorsMut::<T>::new(token, f, stride, part);
            let strength = T::load(token, strength[part]);
            let mut sum = T::load(token, energy[part]);
            for force in self.forces.iter().filter(|force| force.is_elastic() == self.elastic) {
                sum += force.add_forces(strength, &x, &mut f);
            }
            energy[part] = sum.raw();
        }
    }
}
