//! Pseudopods as a mesh can carry them.

use super::super::{CellType, Document, Pseudopods};
use crate::Vec3;
use crate::cell::Behaviour;
use crate::cell::motility::Space;
use crate::error::Fault;
use crate::sim::Kind;

/// Atoms that a front has at least: with fewer it is a spike.
const LEAST: usize = 4;

/// What the cells of a type do by pseudopods; faults where their mesh has no inside or is too coarse for a front.
pub fn pseudopods(
    document: &Document,
    key: &str,
    cell: &CellType,
    kind: &Kind,
    faults: &mut Vec<Fault>,
) -> Option<Behaviour> {
    let pods = cell.pseudopods.as_ref()?;
    let mut fault = |key: &str, label: &str, message: String, help: &str| {
        let fault = Fault::new(message).help(help);
        faults.push(document.location(key, label).into_iter().fold(fault, Fault::at));
    };
    let path = format!("{key}.pseudopods");
    if !kind.closed {
        let message = format!("`{path}` needs a closed mesh; the surface of `{}` has a border", kind.name);
        fault(&path, "nothing to push from", message, "give a closed mesh, or remove the pseudopods");
        return None;
    }
    let fewest = fewest_in_front(pods, &kind.rest.positions);
    if let Some(fibres) = pods.fibres.as_ref().filter(|fibres| fibres.number as usize > fewest) {
        let key = format!("{path}.fibres.number");
        let message = format!(
            "`{key}`: {} fibres need as many atoms at each end, and a front has {fewest} of {}",
            fibres.number,
            kind.atoms()
        );
        let help = "give a finer mesh, a wider `half_angle`, or fewer and stiffer fibres";
        fault(&key, "this mesh is too coarse to carry them", message, help);
    }
    if fewest < LEAST {
        let message = format!("`{path}`: a front would have {fewest} of {} atoms, which makes spikes", kind.atoms());
        let key = format!("{path}.half_angle");
        let at = if document.location(&key, "").is_some() { key } else { path };
        fault(&at, "too narrow for this mesh", message, "give a finer mesh, or a wider `half_angle`");
    }
    Some(pods.behaviour())
}

/// The fewest atoms that a front has in one of the directions of the axes, while the cell is at rest.
fn fewest_in_front(pods: &Pseudopods, positions: &[Vec3]) -> usize {
    let centre = positions.iter().sum::<Vec3>() / positions.len() as f64;
    let least = pods.half_angle.value().cos();
    let count =
        |direction: Vec3| positions.iter().filter(|x| (*x - centre).normalize().dot(&direction) > least).count();
    let along = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y(), Vec3::z(), -Vec3::z()];
    let directions = if pods.space == Space::Plane { &along[..4] } else { &along };
    directions.iter().map(|direction| count(*direction)).min().unwrap_or(0)
}
