//! Bonds of surfaces as the step knows them, and what is worth a word about them before a run.

use super::super::Document;
use super::super::contact::{Bonds, ContactModel as Text};
use crate::error::short;
use crate::sim::contact::{BondKinetics, Pathway};
use crate::units::{Dimension, Force, Frequency, Stress, pretty};

/// How bonds close and open.
pub fn kinetics(text: Bonds) -> BondKinetics {
    let pathway = |off: Frequency, force: Force| Pathway { off: off.value(), force: force.value() };
    BondKinetics {
        density: text.density.value(),
        on: text.on.value(),
        slip: pathway(text.off, text.force),
        catch: text.catch.map_or(Pathway::NONE, |catch| pathway(catch.off, catch.force)),
        start: text.start,
    }
}

/// The most that a bond bears over the force at which it opens e times as fast, between which load matters and bonds bear it: below the one
/// rates change by less than a tenth, above the other bonds that bear half of their strength are gone within a ten-thousandth of their time.
const LOADS: std::ops::RangeInclusive<f64> = 0.1..=20.0;

/// What there is to say about bonds, a sentence for each table that has some.
pub fn notices(document: &Document) -> Vec<String> {
    let Some(text) = document.experiment.contact.as_ref().filter(|text| text.model == Text::Cohesion) else {
        return Vec::new();
    };
    let all = (
        "contact".to_owned(),
        (text.strength, text.energy, text.range),
        text.shear_strength,
        text.friction,
        text.bonds,
    );
    let pairs = text.between.iter().enumerate().map(|(index, pair)| {
        let path = format!("contact.between[{index}]");
        (path, (pair.strength, pair.energy, pair.range), pair.shear_strength, pair.friction, pair.bonds)
    });
    let said =
        std::iter::once(all).chain(pairs).filter_map(|(path, (strength, energy, range), shear, friction, bonds)| {
            let [strength, _] = text.cohesive(strength, energy, range);
            let most = shear.map_or(strength, |shear: Stress| strength.hypot(shear.value()));
            notice(&path, most, friction.is_some_and(|friction| friction.value() > 0.0), &kinetics(bonds?))
        });
    said.collect()
}

/// What there is to say about the bonds of a table that bear so much together, pN/µm², and rub or not.
fn notice(path: &str, strength: f64, rubs: bool, bonds: &BondKinetics) -> Option<String> {
    let most = strength / bonds.density;
    let told = |force: f64| pretty(force, Dimension::FORCE);
    let least_force = bonds.slip.force.min(bonds.catch.force);
    if !rubs && most > 0.0 && most < LOADS.start() * least_force {
        return Some(format!(
            "the bonds of `{path}` bear {} each at most, the strength over their density, and {} changes how fast they open: load does next to nothing to \
             them. Give them a lower `density` or `force`, or more strength",
            told(most),
            told(least_force)
        ));
    }
    let times = most / bonds.slip.force;
    (times > *LOADS.end() && bonds.slip.off > 0.0).then(|| {
        format!(
            "the bonds of `{path}` would bear {} each before their surfaces part, the strength over their density, {} times the `force` at which they open \
             e times as fast: they open long before, and how strong they are decides nothing. Give them a higher `density` or `force`, or less strength",
            told(most),
            short(times.round())
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bonds_whose_load_does_nothing_or_all_are_told_of() {
        let bonds = |density: f64| BondKinetics {
            density,
            on: 1.0,
            slip: Pathway { off: 0.1, force: 4.0 },
            catch: Pathway::NONE,
            start: 0.0,
        };
        let said = |density: f64| notice("contact", 1.0, false, &bonds(density));
        assert_eq!([0.25, 0.02, 2.0].map(said), [None, None, None]);
        let (many, few) = (said(100.0).unwrap_or_default(), said(0.01).unwrap_or_default());
        assert!(many.contains("bear 10 fN each at most") && many.contains("next to nothing"), "{many}");
        assert!(few.contains("would bear 100 pN each") && few.contains("25 times"), "{few}");
        assert_eq!(notice("contact", 1.0, true, &bonds(100.0)), None, "friction loads them as fast as they slide");
    }
}
