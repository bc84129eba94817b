//! Contacts as the step knows them.

use super::super::contact::{ContactModel as Text, Pair, Zones as ZonesText};
use super::super::{Document, Experiment};
use crate::contact::Reach;
use crate::error::{Error, Fault, Result, short};
use crate::sim::contact::{AdhesiveTable, ContactModel, Law, LinkTable, Penalty, Strength, Zones};
use crate::sim::{Kind, Plane};
use crate::units::{LineStiffness, Stress};

/// The proximity over the smallest mean edge where the user names none.
const PROXIMITY: f64 = 0.1;

/// The largest proximity over the smallest mean edge: above it an atom is near everything around it.
const LARGEST: f64 = 0.5;

/// How near is a contact, in an experiment that has contacts.
///
/// # Errors
/// A proximity that does not fit the meshes.
pub fn reach(document: &Document, kinds: &[Kind]) -> Result<Option<Reach>> {
    let Some(text) = &document.experiment.contact else { return Ok(None) };
    let smallest = kinds.iter().min_by(|one, other| one.edge.total_cmp(&other.edge));
    let edge = smallest.map_or(1.0, |kind| kind.edge);
    let proximity = text.proximity.map_or(PROXIMITY * edge, |proximity| proximity.value());
    if let Some(kind) = smallest.filter(|_| proximity > LARGEST * edge) {
        let fault = Fault::new(format!(
            "a proximity of {} um is too large for the mesh of type `{}`, whose mean edge is {} um",
            short(proximity),
            kind.name,
            short(edge)
        ))
        .help(format!("give at most {} um, or leave it out: then it is a tenth of the edge", short(LARGEST * edge)));
        let location = document.location("contact.proximity", "above half of the mean edge");
        return Err(Error::input(location.into_iter().fold(fault, Fault::at)));
    }
    let depth = if text.model == Text::Penalty { PENALTY_DEPTH * edge } else { proximity };
    Ok(Some(Reach { proximity, depth, margin: proximity }))
}

/// How deep contacts are found where nothing but a penalty keeps cells apart, over the smallest mean edge.
const PENALTY_DEPTH: f64 = 0.5;

/// Contacts with the strengths of the document.
pub fn contact(experiment: &Experiment, kinds: &[Kind], planes: &[Plane], reach: Reach) -> Option<ContactModel> {
    let text = experiment.contact.as_ref()?;
    let mut model = ContactModel::new(kinds, planes, reach);
    match text.model {
        Text::Adhesives => {}
        Text::Links => {
            model.law = Law::Links(links(experiment, kinds));
            return Some(model);
        }
        Text::Penalty => {
            let stiffness = text.penalty.map_or(0.0, |penalty| penalty.value());
            model.law = Law::Penalty(Penalty { stiffness, range: reach.proximity });
        }
        Text::VirtualAdhesives => {
            model.law = Law::VirtualAdhesives(adhesives(experiment, kinds.len(), planes.len()));
            return Some(model);
        }
    }
    if let Some(strength) = text.strength {
        let strength = strength_of(strength, text.shear_strength, text.energy);
        for kind in 0..kinds.len() {
            (kind..kinds.len()).for_each(|other| model.stick(kind, other, strength));
        }
    }
    for between in &text.between {
        let strength = strength_of(between.strength.unwrap_or_default(), between.shear_strength, between.energy);
        match between.pair(experiment) {
            Some(Pair::Types(one, other)) => model.stick(one, other, strength),
            Some(Pair::OnPlane(kind, plane)) => model.stick_to_plane(kind, plane, strength),
            None => {}
        }
    }
    Some(model)
}

fn strength_of(strength: Stress, shear: Option<Stress>, energy: Option<LineStiffness>) -> Strength {
    let energy = energy.map_or(0.0, |energy| energy.value());
    Strength { tensile: strength.value(), shear: shear.unwrap_or(strength).value(), energy }
}

/// Which types are glued to each other and to planes, and how well. As with strengths, cells stick to planes that are named only.
fn adhesives(experiment: &Experiment, kinds: usize, planes: usize) -> AdhesiveTable {
    let text = experiment.contact.as_ref();
    let all = text.and_then(|text| text.kappa).map_or(0.0, |kappa| kappa.value());
    let zones = match text.and_then(|text| text.zones).unwrap_or_default() {
        ZonesText::Merged => Zones::Merged,
        ZonesText::Pairs => Zones::Pairs,
    };
    let mut table = AdhesiveTable { between: vec![all; kinds * kinds], on_planes: vec![0.0; kinds * planes], zones };
    for between in text.map_or(&[][..], |text| &text.between) {
        let kappa = between.kappa.map_or(0.0, |kappa| kappa.value());
        match between.pair(experiment) {
            Some(Pair::Types(one, other)) => {
                table.between[one * kinds + other] = kappa;
                table.between[other * kinds + one] = kappa;
            }
            Some(Pair::OnPlane(kind, plane)) => table.on_planes[kind * planes + plane] = kappa,
            None => {}
        }
    }
    table
}

/// Which types are linked, and how. The document's checks have refused links to planes.
fn links(experiment: &Experiment, kinds: &[Kind]) -> LinkTable {
    let smallest = kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
    let Some(text) = &experiment.contact else { return LinkTable::new(kinds.len(), smallest) };
    let mut table = LinkTable::new(kinds.len(), text.range.map_or(smallest, |range| range.value()));
    table.stiffness.fill(text.link.map_or(0.0, |stiffness| stiffness.value()));
    for between in &text.between {
        if let (Some(Pair::Types(one, other)), Some(stiffness)) = (between.pair(experiment), between.link) {
            table.stiffness[one * kinds.len() + other] = stiffness.value();
            table.stiffness[other * kinds.len() + one] = stiffness.value();
        }
    }
    table
}
