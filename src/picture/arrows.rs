//! The loads of an experiment as arrows: where they act, which way, and how strong they are beside the strongest.

use crate::Vec3;
use crate::error::Result;
use crate::experiment::{Document, compile};
use crate::output::Layout;

/// The largest arrow measures this part of a typical cell.
const LONGEST: f64 = 0.35;

/// A load on one cell.
#[derive(Debug, Clone)]
struct Arrow {
    /// Atoms in the order of the result, and their shares.
    atoms: Vec<(usize, f64)>,
    /// All atoms of the cell.
    cell: std::ops::Range<usize>,
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
    /// The loads of a document on the cells of its result.
    ///
    /// # Errors
    /// When the document cannot be compiled any more, because a mesh file is gone, say.
    pub fn of(document: &Document, layout: &Layout) -> Result<Self> {
        let model = compile(document)?.model;
        let mut arrows = Vec::new();
        let mut cells = layout.cells.iter();
        for kind in &model.kinds {
            for cell in cells.by_ref().take(kind.cells) {
                for load in kind.loads() {
                    let atom = |&(atom, share): &(u32, f64)| ((cell.first_atom + atom) as usize, share);
                    arrows.push(Arrow {
                        atoms: load.atoms.iter().map(atom).collect(),
                        cell: cell.first_atom as usize..(cell.first_atom + cell.atoms) as usize,
                        direction: load.direction,
                        course: load.force.points().to_vec(),
                    });
                }
            }
        }
        let strongest = arrows.iter().flat_map(|arrow| &arrow.course).map(|(_, force)| force.abs()).fold(0.0, f64::max);
        let mut sizes: Vec<f64> = model.kinds.iter().map(|kind| size(&kind.rest.positions)).collect();
        sizes.sort_by(f64::total_cmp);
        let typical = sizes.get(sizes.len() / 2).copied().unwrap_or(1.0);
        Ok(Self { arrows, scale: if strongest > 0.0 { LONGEST * typical / strongest } else { 0.0 } })
    }

    /// The arrows at a time, from tail to tip, µm. A pull leaves the surface, a push ends at it.
    pub fn at(&self, time: f64, positions: &[[f64; 3]]) -> Vec<[[f64; 3]; 2]> {
        let mut shown = Vec::new();
        for arrow in &self.arrows {
            let along = arrow.direction * (self.scale * force_at(&arrow.course, time));
            if along.norm() == 0.0 {
                continue;
            }
            let place = |atom: usize| Vec3::from(positions[atom]);
            let middle: Vec3 = arrow.atoms.iter().map(|&(atom, share)| share * place(atom)).sum();
            let centre = arrow.cell.clone().map(place).sum::<Vec3>() / arrow.cell.len().max(1) as f64;
            let way = along.normalize();
            // Outside the cell: a pull starts at the loaded atoms that stand out most, a push ends there.
            let reach = |sign: f64| {
                arrow.atoms.iter().map(|&(atom, _)| sign * (place(atom) - middle).dot(&way)).fold(0.0, f64::max)
            };
            let tail = if (middle - centre).dot(&along) >= 0.0 {
                middle + way * reach(1.0)
            } else {
                middle - way * reach(-1.0) - along
            };
            shown.push([tail.into(), (tail + along).into()]);
        }
        shown
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
