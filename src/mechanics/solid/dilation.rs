//! Resistance of a solid to changes of volume, measured over parts of it, eq. (solids.6).
//!
//! A single tetrahedron has one volume and three edges that leave a face each: where every one keeps its volume, there is hardly a motion left, and
//! bodies of them are far too stiff ("locking"). Over the cells that they were cut from, or around atoms (Bonet & Burton 1998), there is.

use super::super::lanes::{Real, V3, Vectors, VectorsMut};
use super::super::stiffness::StiffnessMatrix;
use super::super::tangent::matrix::Blocks;
use crate::Vec3;
use crate::geometry::solid::faces;
use std::collections::BTreeMap;

/// Where volumes are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parts {
    /// Over each tetrahedron.
    Tetrahedra,
    /// Over all tetrahedra that were cut from one cell.
    Cells,
    /// Over all tetrahedra around an atom, a quarter of each.
    Atoms,
}

/// How the energy per volume at rest depends on J, the volume over that at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DilationLaw {
    /// K/2 (J − 1)².
    Bulk(f64),
    /// γ/3 |J − 1|³: the documents' penalty, whose force is γ sign(J − 1) (J − 1)² along the normals. Nothing at rest.
    Penalty(f64),
}

impl DilationLaw {
    /// The energy, its slope and a bound of how it bends, Pa.
    #[inline(always)]
    fn at<T: Real>(&self, by: T) -> [T; 3] {
        match *self {
            Self::Bulk(modulus) => [by * by * (0.5 * modulus), by * modulus, by * 0.0 + modulus],
            Self::Penalty(modulus) => {
                let size = by.max(-by);
                [by * by * size * (modulus / 3.0), by * size * modulus, size * (2.0 * modulus)]
            }
        }
    }
}

/// A part of a body.
#[derive(Debug, Clone, PartialEq)]
struct Part {
    /// Its surface, facets turned outwards.
    facets: Vec<[u32; 3]>,
    /// The atoms on it, and which of its facets each is on.
    atoms: Vec<(u32, Vec<u32>)>,
    /// One over its volume at rest, 1/µm³.
    per_volume: f64,
    /// What of its energy counts: its volume at rest, or a quarter of that, µm³.
    weight: f64,
}

/// The resistance, ready for all cells that share the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Dilation {
    law: DilationLaw,
    parts: Vec<Part>,
    /// The parts that each tetrahedron belongs to.
    parts_of: Vec<Vec<u32>>,
    /// What of a tetrahedron counts in each of them.
    share: f64,
}

impl Dilation {
    /// Over these parts of a body at rest (µm), of which cell `k` has the tetrahedra from `cells[k]` to before `cells[k + 1]`.
    pub fn new(rest: &[Vec3], tetrahedra: &[[u32; 4]], cells: &[u32], law: DilationLaw, parts: Parts) -> Self {
        let numbers = 0..tetrahedra.len() as u32;
        let groups: Vec<Vec<u32>> = match parts {
            Parts::Tetrahedra => numbers.map(|number| vec![number]).collect(),
            Parts::Cells => cells.windows(2).map(|range| (range[0]..range[1]).collect()).collect(),
            Parts::Atoms => {
                let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
                for (atoms, number) in tetrahedra.iter().zip(numbers) {
                    atoms.iter().for_each(|atom| around.entry(*atom).or_default().push(number));
                }
                around.into_values().collect()
            }
        };
        let share = if parts == Parts::Atoms { 0.25 } else { 1.0 };
        let mut parts_of = vec![Vec::new(); tetrahedra.len()];
        for (group, part) in groups.iter().zip(0..) {
            group.iter().for_each(|number| parts_of[*number as usize].push(part));
        }
        let made = |group: &Vec<u32>| {
            let own: Vec<[u32; 4]> = group.iter().map(|number| tetrahedra[*number as usize]).collect();
            Part::new(rest, &own, share)
        };
        Self { law, parts: groups.iter().map(made).collect(), parts_of, share }
    }

    /// The law.
    pub fn law(&self) -> DilationLaw {
        self.law
    }

    /// Adds the force on every atom and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for part in &self.parts {
            let [stored, slope, _] = self.law.at(part.dilation(x));
            energy += stored * part.weight;
            let pressure = slope * (part.weight * part.per_volume / 6.0);
            for facet in &part.facets {
                let push = doubled_area(x, facet).times(pressure);
                f.sub(facet[0] as usize, push);
                f.sub(facet[1] as usize, push);
                f.sub(facet[2] as usize, push);
            }
        }
        energy
    }

    /// Adds what of the second derivative is never negative: that along the gradients of volumes. What is due to how these gradients turn is added
    /// with what each tetrahedron has, see [`Dilation::slope_of`].
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        for part in &self.parts {
            let [_, _, bend] = self.law.at(part.dilation(x));
            let weight = bend * (part.weight * (part.per_volume / 6.0) * (part.per_volume / 6.0));
            for (number, (i, around)) in part.atoms.iter().enumerate() {
                let on_i = part.gradient(x, around);
                for (j, around) in &part.atoms[..=number] {
                    blocks.add_product(*i, *j, [on_i, part.gradient(x, around)], weight);
                }
            }
        }
    }

    /// The slope of the energy by the volume of a tetrahedron, Pa.
    #[inline(always)]
    pub fn slope_of<T: Real>(&self, tetrahedron: usize, x: &Vectors<T>) -> T {
        let mut sum = T::constant(x.token, 0.0);
        for &part in &self.parts_of[tetrahedron] {
            let [_, slope, _] = self.law.at(self.parts[part as usize].dilation(x));
            sum += slope;
        }
        sum * self.share
    }

    /// Adds nothing to each pair of atoms that a part joins, so that the matrix has room for them.
    pub fn add_pattern(&self, matrix: &mut StiffnessMatrix) {
        for part in &self.parts {
            for (i, _) in &part.atoms {
                part.atoms.iter().for_each(|(j, _)| matrix.add(*i as usize, *j as usize, 0.0));
            }
        }
    }

    /// What multiplies the Laplacian of the body so that it is nowhere less stiff at rest, Pa: the square of a mean is at most the mean of
    /// squares, and that of a trace three times that of the gradient.
    pub fn bound(&self) -> f64 {
        match self.law {
            DilationLaw::Bulk(modulus) => 3.0 * modulus,
            DilationLaw::Penalty(_) => 0.0,
        }
    }
}

impl Part {
    fn new(rest: &[Vec3], tetrahedra: &[[u32; 4]], share: f64) -> Self {
        let mut facets: Vec<[u32; 3]> = Vec::new();
        for &atoms in tetrahedra {
            for face in faces(atoms) {
                // Seen from the other side its atoms run the other way round.
                let is_other =
                    |other: &[u32; 3]| (0..3).any(|k| [face[k], face[(k + 2) % 3], face[(k + 1) % 3]] == *other);
                match facets.iter().position(is_other) {
                    Some(inner) => drop(facets.swap_remove(inner)),
                    None => facets.push(face),
                }
            }
        }
        facets.sort_unstable();
        let mut atoms: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (facet, number) in facets.iter().zip(0..) {
            facet.iter().for_each(|atom| atoms.entry(*atom).or_default().push(number));
        }
        let origin = rest[facets[0][0] as usize];
        let six_volumes: f64 = facets
            .iter()
            .map(|facet| {
                let [a, b, c] = facet.map(|atom| rest[atom as usize] - origin);
                a.dot(&(b - a).cross(&(c - a)))
            })
            .sum();
        let atoms = atoms.into_iter().collect();
        Self { facets, atoms, per_volume: 6.0 / six_volumes, weight: share * six_volumes / 6.0 }
    }

    /// J − 1.
    #[inline(always)]
    fn dilation<T: Real>(&self, x: &Vectors<T>) -> T {
        let origin = x.get(self.facets[0][0] as usize);
        let mut six_volumes = T::constant(x.token, 0.0);
        for facet in &self.facets {
            six_volumes += (x.get(facet[0] as usize) - origin).dot(doubled_area(x, facet));
        }
        six_volumes * (self.per_volume / 6.0) + -1.0
    }

    /// Six times the gradient of its volume by where an atom is, from the facets around that.
    #[inline(always)]
    fn gradient<T: Real>(&self, x: &Vectors<T>, around: &[u32]) -> V3<T> {
        let mut sum = V3::zero(x.token);
        for &facet in around {
            sum += doubled_area(x, &self.facets[facet as usize]);
        }
        sum
    }
}

/// Twice the area of a facet along its normal.
#[inline(always)]
fn doubled_area<T: Real>(x: &Vectors<T>, [a, b, c]: &[u32; 3]) -> V3<T> {
    let origin = x.get(*a as usize);
    (x.get(*b as usize) - origin).cross(x.get(*c as usize) - origin)
}
