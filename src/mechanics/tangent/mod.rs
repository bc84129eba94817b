//! The tangent stiffness of each cell in the shape that it has: what the implicit step takes where no constant matrix tells how stiff
//! the cells of a mesh are, eq. (step.10).
//!
//! It is the second derivative of the energies, without what is negative of a facet or a hinge and without the bend of curvatures at
//! atoms, so that it can always be factored and is never far less than the true stiffness. Forces without one of their own take their
//! constant stiffness. Of filled bodies all of it counts, where that can be factored.

mod dense;
mod dissection;
pub mod facet;
mod factor;
mod fronts;
pub mod matrix;
mod multifrontal;
mod pattern;
mod substitution;
#[cfg(test)]
mod tests;

use super::Force;
use super::lanes::{BlockWork, LANES, Real, Vectors, VectorsMut, dispatch};
use super::stiffness::StiffnessMatrix;
use super::viscosity::Viscosity;
use crate::Vec3;
use fronts::Fronts;
use matrix::Blocks;
use multifrontal::Factorise;
pub use pattern::Pattern;
use substitution::{SolveMany, SolveOne};

/// Bodies that stand alone are factored by fronts from so many atoms on: a choice. Of the smallest that was measured, 343 atoms of a filled body,
/// a step takes 5 ms.
const LARGE: usize = 150;

/// How the tangent stiffness of the cells of a kind is made and factored.
#[derive(Debug, Clone, PartialEq)]
pub struct Tangent {
    pattern: Pattern,
    /// Where one large body is factored by fronts; the pattern is that of the matrix alone then.
    fronts: Option<Fronts>,
    /// Constant stiffness of the elastic forces, and of all others, that have no tangent stiffness: entries of the lower triangle.
    constant: [Vec<(u32, u32, f64)>; 2],
}

/// What a factor is made of.
#[derive(Debug, Clone, Copy)]
pub struct Scales<'a> {
    /// Drag over step, pN/µm.
    pub diagonal: f64,
    /// Factor of all stiffness.
    pub gamma: f64,
    /// Factor of the stiffness of elastic forces in each lane.
    pub elastic: &'a [f64],
    /// One factor an atom and axis, 0 where held; empty when nothing is held.
    pub held: &'a [f64],
    /// Viscosity of the membrane and of the inside, and one over the step, 1/s.
    pub viscous: Option<(&'a Viscosity, f64)>,
}

impl Tangent {
    /// Finds the pattern for the cells of a mesh with this rest shape (µm), these forces and this viscosity, that stand in blocks of so many
    /// lanes.
    pub fn new(forces: &[Force], viscosity: Option<&Viscosity>, rest: &[Vec3], lanes: usize) -> Self {
        let mut whole = StiffnessMatrix::new(rest.len());
        for [i, j] in viscosity.into_iter().flat_map(Viscosity::pairs) {
            // Only where entries are counts here.
            whole.add_spring(i as usize, j as usize, 1.0);
        }
        let mut constant = [StiffnessMatrix::new(rest.len()), StiffnessMatrix::new(rest.len())];
        for force in forces {
            force.add_stiffness(rest, rest, &mut whole);
            if let Force::Plate(plate) = force {
                plate.add_pattern(&mut whole);
            }
            if !force.has_tangent() {
                force.add_stiffness(rest, rest, &mut constant[usize::from(!force.is_elastic())]);
            }
        }
        let lower = |matrix: &StiffnessMatrix| -> Vec<(u32, u32, f64)> {
            let rows = 0..matrix.atoms();
            rows.flat_map(|i| matrix.row(i).filter(move |(j, _)| *j <= i).map(move |(j, v)| (i as u32, j as u32, v)))
                .collect()
        };
        let (pattern, fronts) = if lanes == 1 && rest.len() >= LARGE {
            let near = |i: usize| whole.row(i).map(|(j, _)| j as u32).filter(|&j| j as usize != i).collect();
            let (fronts, pattern) = Fronts::of(&(0..rest.len()).map(near).collect::<Vec<_>>(), rest);
            (pattern, Some(fronts))
        } else {
            (Pattern::of(&whole), None)
        };
        Self { pattern, fronts, constant: [lower(&constant[0]), lower(&constant[1])] }
    }

    /// Numbers of the factor of a block of so many cells.
    pub fn len(&self, lanes: usize) -> usize {
        9 * self.pattern.blocks() * lanes + self.fronts.as_ref().map_or(0, Fronts::len)
    }

    /// Makes and factors `diagonal + γ·stiffness` for a block of `lanes` cells at `x` (µm).
    pub fn factor(&self, forces: &[Force], lanes: usize, x: &[f64], scales: Scales, values: &mut [f64]) {
        // Of a filled body all that bends counts, where that is positive: the positive part takes a bent beam for several times as stiff.
        let whole = forces.iter().any(|force| matches!(force, Force::Solid(_)));
        if !self.make(lanes, Make { tangent: self, forces, x, scales, values, is_factored: true, whole }) && whole {
            self.make(lanes, Make { tangent: self, forces, x, scales, values, is_factored: true, whole: false });
        }
    }

    /// Makes and factors a matrix; returns whether it was positive.
    fn make(&self, lanes: usize, work: Make) -> bool {
        let Some(fronts) = &self.fronts else { return dispatch(lanes, work) };
        let (blocks, factor) = work.values.split_at_mut(9 * self.pattern.blocks());
        dispatch(1, Make { values: blocks, ..work });
        dispatch(LANES, Factorise { fronts, pattern: &self.pattern, blocks, factor })
    }

    /// What of a factor solves take, where fronts made it.
    fn panels<'a>(&'a self, factor: &'a [f64]) -> Option<(&'a Fronts, &'a [f64])> {
        self.fronts.as_ref().map(|fronts| (fronts, &factor[9 * self.pattern.blocks()..][..fronts.panels()]))
    }

    /// Solves in place for a block of `lanes` cells with its factor.
    pub fn solve(&self, lanes: usize, factor: &[f64], values: &mut [f64]) {
        match self.panels(factor) {
            Some((fronts, factor)) => dispatch(LANES, SolveOne { fronts, factor, values }),
            None => dispatch(lanes, Solve { pattern: &self.pattern, factor, values }),
        }
    }

    /// Solves in place for [`LANES`] right sides of one cell with its factor, or for several times as many, one set after the other.
    pub fn solve_columns(&self, factor: &[f64], values: &mut [f64]) {
        let rows = 3 * self.pattern.atoms();
        match self.panels(factor) {
            Some((fronts, factor)) => dispatch(LANES, SolveMany { fronts, factor, rows, values }),
            None => {
                for values in values.chunks_exact_mut(rows * LANES) {
                    dispatch(LANES, SolveColumns { pattern: &self.pattern, factor, values });
                }
            }
        }
    }
}

/// Several right sides of one cell side by side.
struct SolveColumns<'a> {
    pattern: &'a Pattern,
    /// The factor of the cell.
    factor: &'a [f64],
    values: &'a mut [f64],
}

impl BlockWork for SolveColumns<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let factor = matrix::Spread::<T>::new(token, self.factor);
        let values = T::view_mut(token, self.values);
        for part in 0..stride {
            factor::solve(self.pattern, &factor, &mut VectorsMut::<T>::new(token, &mut *values, stride, part));
        }
    }
}

struct Make<'a> {
    tangent: &'a Tangent,
    forces: &'a [Force],
    x: &'a [f64],
    scales: Scales<'a>,
    values: &'a mut [f64],
    is_factored: bool,
    /// Whether what is negative of the stiffness of filled bodies counts.
    whole: bool,
}

impl BlockWork for Make<'_> {
    /// Whether the matrix could be factored, where it was to be.
    type Output = bool;
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) -> bool {
        let Self { tangent: Tangent { pattern, constant, fronts }, forces, x, scales, values, is_factored, whole } =
            self;
        let mut is_positive = true;
        let (x, values) = (T::view(token, x), T::view_mut(token, values));
        let mut elastic = [1.0; LANES];
        elastic.iter_mut().zip(scales.elastic).for_each(|(slot, factor)| *slot = *factor);
        for part in 0..stride {
            let x = Vectors::<T>::new(token, x, stride, part);
            let mut blocks = Blocks::<T>::new(token, pattern, &mut *values, stride, part);
            blocks.clear();
            // What is done in a closure is not compiled for wide registers; elastic forces first, which are scaled, then all others.
            for (others, constant) in constant.iter().enumerate() {
                for force in forces {
                    if force.is_elastic() == (others == 0) {
                        force.add_tangent(&x, &mut blocks, whole);
                    }
                }
                for &(i, j, value) in constant {
                    blocks.add_isotropic(i, j, T::constant(token, value));
                }
                if others == 0 {
                    blocks.scale(T::load(token, T::view(token, &elastic)[part]));
                }
            }
            if is_factored {
                blocks.scale(T::constant(token, scales.gamma));
                if let Some((viscosity, per_step)) = scales.viscous {
                    viscosity.add_blocks(per_step, &x, &mut blocks);
                }
                for atom in 0..pattern.atoms() as u32 {
                    blocks.add_isotropic(atom, atom, T::constant(token, scales.diagonal));
                }
                if !scales.held.is_empty() {
                    blocks.hold(scales.held);
                }
                if fronts.is_none() {
                    is_positive &= factor::factor(pattern, &mut blocks);
                }
            }
        }
        is_positive
    }
}

struct Solve<'a> {
    pattern: &'a Pattern,
    factor: &'a [f64],
    values: &'a mut [f64],
}

impl BlockWork for Solve<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let (factor, values) = (T::view(token, self.factor), T::view_mut(token, self.values));
        for part in 0..stride {
            let factor = matrix::Seen::<T>::new(token, factor, stride, part);
            factor::solve(self.pattern, &factor, &mut VectorsMut::<T>::new(token, &mut *values, stride, part));
        }
    }
}
