//! The sum of all forces on a block of cells, and what they depend on beside positions.

use std::ops::Range;

use super::Force;
use super::lanes::{BlockWork, LANES, Real, Vectors, VectorsMut, dispatch};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// What forces on a block of cells depend on beside positions.
#[derive(Debug, Clone)]
pub struct Context<'a> {
    /// Time, s.
    pub time: f64,
    /// Mass of an atom, pN·s²/µm.
    pub mass: f64,
    /// The cells of the lanes, in the order of the lists below; lanes beyond the last are empty.
    pub cells: Range<usize>,
    /// Factor of the elastic forces of every cell; empty where all are 1.
    pub stiffness: &'a [f64],
    /// What chemistry sets of forces: a list for each control, a number for each cell, NaN where nothing is set.
    pub controls: &'a [Vec<f64>],
}

impl Context<'_> {
    /// A time at which chemistry sets nothing; atoms have the mass 1.
    pub fn at(time: f64) -> Self {
        Self { time, mass: 1.0, cells: 0..0, stiffness: &[], controls: &[] }
    }

    /// What a control sets in each lane; NaN where it sets nothing.
    pub fn control(&self, control: Option<usize>) -> [f64; LANES] {
        let list = control.and_then(|control| self.controls.get(control));
        list.map_or([f64::NAN; LANES], |list| self.in_lanes(list, f64::NAN))
    }

    /// The numbers of the cells in a list, lane by lane.
    fn in_lanes(&self, list: &[f64], empty: f64) -> [f64; LANES] {
        let mut lanes = [empty; LANES];
        lanes.iter_mut().zip(&list[self.cells.clone()]).for_each(|(lane, number)| *lane = *number);
        lanes
    }
}

/// Sets `f` to the sum of all forces on the atoms of a block of `lanes` cells at `x` (µm), pN, and `energy` to the energy of each
/// cell, pN·µm. Elastic forces come first, and are scaled together; each of both groups is added up in the order of the list.
pub fn measure_forces(forces: &[Force], context: &Context, lanes: usize, x: &[f64], f: &mut [f64], energy: &mut [f64]) {
    measure_elastic(forces, lanes, x, f, energy);
    if !context.stiffness.is_empty() {
        let factors = context.in_lanes(context.stiffness, 1.0);
        for row in f.chunks_exact_mut(lanes).chain([&mut *energy]) {
            row.iter_mut().zip(&factors).for_each(|(slot, factor)| *slot *= factor);
        }
    }
    for force in forces.iter().filter(|force| !force.is_elastic()) {
        let (forces, strength) = (std::slice::from_ref(force), &force.strength(context)[..lanes]);
        dispatch(lanes, Work { forces, elastic: false, strength, x, f, energy });
    }
}

/// The same of elastic forces alone, as they are without chemistry.
pub fn measure_elastic(forces: &[Force], lanes: usize, x: &[f64], f: &mut [f64], energy: &mut [f64]) {
    f.fill(0.0);
    energy.fill(0.0);
    dispatch(lanes, Work { forces, elastic: true, strength: &[1.0; LANES][..lanes], x, f, energy });
}

/// The linear part for the implicit step, pN/µm, of those forces that are elastic or that are not, as it is fit for the shape `x`
/// (µm) of a cell with this rest shape.
pub fn stiffness(forces: &[Force], elastic: bool, rest: &[Vec3], x: &[Vec3]) -> StiffnessMatrix {
    let mut matrix = StiffnessMatrix::new(rest.len());
    let wanted = forces.iter().filter(|force| force.is_elastic() == elastic);
    wanted.for_each(|force| force.add_stiffness(rest, x, &mut matrix));
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
