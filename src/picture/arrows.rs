//! The loads of an experiment as arrows: where they act, in which direction, and how strong they are beside the strongest.

use crate::Vec3;
use crate::error::Result;
use crate::experiment::{Document, compile};
use crate::output::{Cell, Layout};

/// The largest arrow measures this part of a typical cell.
const LONGEST: f64 = 0.35;

/// A load on every cell of a type.
#[derive(Debug, Clone)]
struct Arrow {
    /// Number of the type.
    kind: u32,
    /// Atoms by their numbers in the cell, and their shares.
    atoms: Vec<(u32, f64)>,
    direction: Vec3,
    /// (time s, force pN), rising in time.
    course: Vec<(f64, f64)>,
}

/// All loads of an experiment.
#[derive(Debug, Clone, Default)]
pub struct LoadArrows {
    arrows: Vec<Arrow>,
    /// Length of an arrow for a force, µm/pN.
    scale: f64,
}

impl LoadArrows {
    /// The loads of a document.
    ///
    /// # Errors
    /// When the document cannot be compiled any more, because a mesh file is gone, say.
    pub fn of(document: &Document) -> Result<Self> {
        let model = compile(document)?.model;
        let mut arrows = Vec::new();
        for (number, kind) in (0..).zip(&model.kinds) {
            arrows.extend(kind.loads().map(|load| Arrow {
                kind: number,
                atoms: load.atoms.clone(),
                direction: load.direction,
                course: load.force.points().to_vec(),
            }));
        }
        let strongest = arrows.iter().flat_map(|arrow| &arrow.course).map(|(_, force)| force.abs()).fold(0.0, f64::max);
        let mut sizes: Vec<f64> = model.kinds.iter().map(|kind| size(&kind.rest.positions)).collect();
        sizes.sort_by(f64::total_cmp);
        let typical = sizes.get(sizes.len() / 2).copied().unwrap_or(1.0);
        Ok(Self { arrows, scale: if strongest > 0.0 { LONGEST * typical / strongest } else { 0.0 } })
    }

    /// The arrows at a time on these cells with their positions (µm), from tail to tip, µm. A pull leaves the surface, a
    /// push ends at it.
    pub fn at(&self, time: f64, layout: &Layout, cells: &[Cell], positions: &[[f64; 3]]) -> Vec<[[f64; 3]; 2]> {
        let of_cell = cells.iter().zip(layout.atoms_of(cells));
        let loaded = of_cell.flat_map(|(cell, atoms)| {
            self.arrows.iter().filter(|arrow| arrow.kind == cell.kind).map(move |arrow| (arrow, atoms.clone()))
        });
        loaded.filter_map(|(arrow, atoms)| self.arrow_at(arrow, time, &positions[atoms])).collect()
    }

    /// The arrow on a cell; none when there is no force.
    fn arrow_at(&self, arrow: &Arrow, time: f64, positions: &[[f64; 3]]) -> Option<[[f64; 3]; 2]> {
        let along = arrow.direction * (self.scale * force_at(&arrow.course, time));
        if along.norm() == 0.0 {
            return None;
        }
        let position = |atom: u32| Vec3::from(positions[atom as usize]);
        let middle: Vec3 = arrow.atoms.iter().map(|&(atom, share)| share * position(atom)).sum();
        let centre = positions.iter().map(|p| Vec3::from(*p)).sum::<Vec3>() / positions.len().max(1) as f64;
        let direction = along.normalize();
        // Outside the cell: a pull starts at the loaded atoms that stand out most, a push ends there.
        let reach = |sign: f64| {
            arrow.atoms.iter().map(|&(atom, _)| sign * (position(atom) - middle).dot(&direction)).fold(0.0, f64::max)
        };
        let tail = if (middle - centre).dot(&along) >= 0.0 {
            middle + direction * reach(1.0)
        } else {
            middle - direction * reach(-1.0) - along
        };
        Some([tail.into(), (tail + along).into()])
    }
}

/// Length of the diagonal of a box around points.
fn size(points: &[Vec3]) -> f64 {
    let low = points.iter().fold(Vec3::repeat(f64::INFINITY), |low, p| low.inf(p));
    let high = points.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
    (high - low).norm()
}

/// A course on straight lines between its points, constant beyond them.
fn force_at(course: &[(f64, f64)], time: f64) -> f64 {
    let after = course.partition_point(|(t, _)| *t <= time);
    match (after.checked_sub(1).map(|i| course[i]), course.get(after)) {
        (Some((t0, f0)), Some(&(t1, f1))) => f0 + (f1 - f0) * (time - t0) / (t1 - t0),
        (Some((_, force)), None) | (None, Some(&(_, force))) => force,
        (None, None) => 0.0,
    }
}
