//! What must hold in the table of contacts: pairs of known names, each once, none forgotten.

use super::Check;
use crate::error::words;
use crate::experiment::Method;
use crate::experiment::contact::{Contact, ContactModel, Pair};

impl Check<'_> {
    pub(super) fn contact(&mut self) {
        let experiment = &self.document.experiment;
        let Some(contact) = &experiment.contact else { return };
        if experiment.run.integrator.method.is_inertial() {
            let message =
                "`run.integrator.method` moves masses, and contacts are there for over-damped motion only".to_owned();
            let help = "take the method \"implicit\" or \"explicit\" with drag instead of mass, or leave [contact] out";
            self.fault("run.integrator.method", "not with [contact]", message, help);
        }
        if experiment.chemistry.contains_key("contact") {
            let message = "`chemistry.contact` has the name under which contacts are recorded".to_owned();
            self.fault("chemistry.contact", "taken", message, "give the system another name");
        }
        self.contact_model(contact);
        let adhesives = matches!(contact.model, ContactModel::Adhesives | ContactModel::Cohesion);
        let says_all = match contact.model {
            ContactModel::Links => true,
            ContactModel::VirtualAdhesives => contact.kappa.is_some(),
            ContactModel::Adhesives | ContactModel::Penalty => contact.strength.is_some(),
            ContactModel::Cohesion => contact.strength.is_some() || contact.energy.is_some(),
        };
        if adhesives && contact.shear_strength.is_some() && !says_all {
            let message = "`contact.shear_strength` is given without `strength`".to_owned();
            let help = "add `strength`; \"0 Pa\" for surfaces that resist sliding but not parting";
            self.fault("contact.shear_strength", "`strength` is missing", message, help);
        }
        if contact.model == ContactModel::Adhesives && contact.energy.is_some() && contact.strength.is_none() {
            let message = "`contact.energy` is given without `strength`".to_owned();
            let help =
                "add `strength`: where contacts spread, their rim is pulled, and without strength nothing holds it";
            self.fault("contact.energy", "`strength` is missing", message, help);
        }
        if contact.model == ContactModel::Cohesion {
            self.work_of_separation(contact);
            self.friction(contact);
            self.bonds(contact);
        }
        let mut named: Vec<Pair> = Vec::new();
        for (index, between) in contact.between.iter().enumerate() {
            let path = format!("contact.between[{index}].types");
            let known = (0..2).filter(|side| self.surface(&format!("{path}[{side}]"), &between.types[*side])).count();
            let Some(pair) = between.pair(experiment) else {
                if known == 2 {
                    let message =
                        format!("`{path}` names no type of cells, and planes and tools never touch each other");
                    self.fault(&path, "no cells", message, "name a type of cells and a plane or tool, or two types");
                }
                continue;
            };
            if named.contains(&pair) {
                let [one, other] = &between.types;
                let message = format!("`{path}`: the pair of \"{one}\" and \"{other}\" is given a second time");
                self.fault(&path, "given before", message, "keep one of the two; their order does not matter");
            }
            named.push(pair);
        }
        if !says_all && !contact.between.is_empty() {
            self.forgotten(contact, &named);
        }
    }

    /// Energies of nothing, strengths that nothing opens against, and energies beside ranges: what says how far surfaces attract each other
    /// must say it once.
    fn work_of_separation(&mut self, contact: &Contact) {
        let all = (String::from("contact"), contact.strength, contact.energy, contact.range);
        let pairs = contact
            .between
            .iter()
            .enumerate()
            .map(|(index, pair)| (format!("contact.between[{index}]"), pair.strength, pair.energy, pair.range));
        for (path, strength, energy, range) in std::iter::once(all).chain(pairs) {
            if strength.is_some() && energy.is_some() && range.is_some() {
                let message = format!("`{path}` has a strength, an energy and a range");
                let help = "keep two of them: the range is twice the energy over the strength";
                self.fault(&format!("{path}.range"), "besides `strength` and `energy`", message, help);
            }
            let (Some(strength), Some(energy)) = (strength, energy) else { continue };
            if strength.value() > 0.0 && energy.value() == 0.0 {
                let message =
                    format!("`{path}.energy` is 0, and surfaces that part at a strength take an energy to part");
                let help = "give the work that parts an area, or leave `energy` out and give `range`";
                self.fault(&format!("{path}.energy"), "must be above 0", message, help);
            } else if strength.value() == 0.0 && energy.value() > 0.0 {
                let message = format!("`{path}.energy` is given with a strength of 0");
                let help = "give a `strength` above 0, or leave `energy` out";
                self.fault(&format!("{path}.energy"), "nothing to open with it", message, help);
            }
        }
    }

    /// Friction of surfaces that do not attract each other: nothing says over which area it acts.
    fn friction(&mut self, contact: &Contact) {
        let sticks = |strength, energy| contact.cohesive(strength, energy, None)[0] > 0.0;
        let all = (String::from("contact"), sticks(contact.strength, contact.energy), contact.friction);
        let pairs = contact.between.iter().enumerate().map(|(index, pair)| {
            (format!("contact.between[{index}]"), sticks(pair.strength, pair.energy), pair.friction)
        });
        for (path, sticks, friction) in std::iter::once(all).chain(pairs) {
            let rubs = friction.is_some_and(|friction| friction.value() > 0.0);
            if rubs && !sticks {
                let message = format!("`{path}.friction` is given without a `strength` above 0");
                let help =
                    "give a `strength`, however small: surfaces rub where they are nearer than half of their range";
                self.fault(&format!("{path}.friction"), "over which area?", message, help);
            }
        }
    }

    /// Bonds of surfaces that do not attract each other, and bonds that are never closed.
    fn bonds(&mut self, contact: &Contact) {
        let sticks = |strength, energy| contact.cohesive(strength, energy, None)[0] > 0.0;
        let all = (String::from("contact"), sticks(contact.strength, contact.energy), contact.bonds);
        let pairs =
            contact.between.iter().enumerate().map(|(index, pair)| {
                (format!("contact.between[{index}]"), sticks(pair.strength, pair.energy), pair.bonds)
            });
        for (path, sticks, bonds) in std::iter::once(all).chain(pairs) {
            let Some(bonds) = bonds else { continue };
            if !sticks {
                let message = format!("`{path}.bonds` is given without a `strength` above 0");
                let help = "give the `strength` of all bonds together, or leave `bonds` out";
                self.fault(&format!("{path}.bonds"), "what do they bear?", message, help);
            }
            if bonds.on.value() == 0.0 && bonds.start == 0.0 {
                let message = format!("`{path}.bonds` never close: `on` is 0, and none are closed at the start");
                let help = "give `on` above 0, or `start`, the share that is closed when the run begins";
                self.fault(&format!("{path}.bonds.on"), "never", message, help);
            }
        }
    }

    /// Keys that belong to another model than the one that is named, and what the model needs.
    fn contact_model(&mut self, contact: &Contact) {
        let run = &self.document.experiment.run.integrator;
        let chosen = run.step.is_none() && run.method == Method::Implicit;
        if contact.model == ContactModel::VirtualAdhesives && run.step.is_none() {
            let message = format!(
                "`contact.model` is {}, whose `kappa` is a displacement in a step, and no step is given",
                named(contact)
            );
            let help =
                "give `step` to run.integrator: \"0.1 s\", say; or leave `model` out: strengths do not depend on it";
            self.fault("contact.model", "needs fixed steps", message, help);
        }
        if matches!(contact.model, ContactModel::Links | ContactModel::Penalty) && !chosen {
            let message = format!(
                "`contact.model` is {}, whose springs need steps that are chosen by their error",
                named(contact)
            );
            let help = "leave `step` and `method` out of run.integrator, or `model` out of [contact]";
            self.fault("contact.model", "not with fixed steps", message, help);
        }
        if contact.model == ContactModel::Penalty && contact.penalty.is_none() {
            let message = "`contact.model` is \"penalty\", and nothing says how stiff it is".to_owned();
            let help = "add `penalty`, the push over depth: \"50 pN/um\", say";
            self.fault("contact.model", "`penalty` is missing", message, help);
        }
        for (index, between) in contact.between.iter().enumerate() {
            let path = format!("contact.between[{index}]");
            let on_plane = matches!(between.pair(&self.document.experiment), Some(Pair::OnObstacle(..)));
            if contact.model == ContactModel::Links && on_plane {
                let message = format!("`{path}` names a plane or tool, and links join facets of cells");
                let help = "leave the pair out: cells rest on planes and tools and slide there";
                self.fault(&format!("{path}.types"), "has no facets", message, help);
            } else if contact.model == ContactModel::Links && between.link.is_none() {
                let message = format!("`{path}` does not say how stiff its links are");
                self.fault(&path, "`link` is missing", message, "add `link`; \"0 pN/um\" does not bind");
            } else if contact.model == ContactModel::VirtualAdhesives && between.kappa.is_none() {
                let message = format!("`{path}` does not say how well the two are glued");
                self.fault(&path, "`kappa` is missing", message, "add `kappa`; \"0 um\" does not stick");
            } else if contact.model == ContactModel::Cohesion && between.strength.is_none() && between.energy.is_none()
            {
                let message = format!("`{path}` does not say how strongly the two stick");
                let help = "add `strength` or `energy`; \"0 Pa\" does not stick";
                self.fault(&path, "`strength` is missing", message, help);
            } else if needs_strength(contact.model) && between.strength.is_none() {
                let message = format!("`{path}` does not say how strongly the two stick");
                self.fault(&path, "`strength` is missing", message, "add `strength`; \"0 Pa\" does not stick");
            }
        }
        for (path, models) in keys_of_models(contact) {
            if !models.contains(&contact.model) {
                let owners = models.iter().map(|model| name_of(*model)).collect::<Vec<_>>().join(" or ");
                let message = format!("`{path}` means nothing in the contact model {}", named(contact));
                self.fault(&path, "of another model", message, format!("leave it out, or choose model = {owners}"));
            }
        }
    }

    /// Whether a name is that of one type, plane or tool; a fault if not.
    fn surface(&mut self, path: &str, name: &str) -> bool {
        let experiment = &self.document.experiment;
        let types = || experiment.cells.keys().map(String::as_str);
        let planes = || experiment.planes.iter().map(|plane| plane.name.as_str());
        let tools = || experiment.tools.iter().map(|tool| tool.name.as_str());
        match (types().any(|known| known == name), experiment.obstacles().any(|known| known == name)) {
            // A tool with the name of a type is told where it stands.
            (true, true) if planes().all(|known| known != name) => {}
            (true, true) => {
                let message = format!("`{path}`: \"{name}\" is a type of cells and a plane");
                self.fault(path, "which of the two?", message, "give the plane another name");
            }
            (false, false) => {
                let meant = words::meant(name, types().chain(experiment.obstacles()));
                let label = meant.map_or("unknown".to_owned(), |meant| format!("did you mean \"{meant}\"?"));
                let mut help = format!("types of cells here are {}", words::all_of(types()));
                if planes().next().is_some() {
                    help += &format!("; planes are {}", words::all_of(planes()));
                }
                if tools().next().is_some() {
                    help += &format!("; tools are {}", words::all_of(tools()));
                }
                let message = format!("`{path}`: there is no type of cells, plane or tool \"{name}\"");
                self.fault(path, &label, message, help);
                return false;
            }
            _ => {}
        }
        true
    }

    /// Pairs of types that can touch and are not in the table, where nothing else says how they stick.
    fn forgotten(&mut self, contact: &Contact, named: &[Pair]) {
        let cells: Vec<_> = self.document.experiment.cells.iter().collect();
        let mut missing = Vec::new();
        for (first, (name, cell)) in cells.iter().enumerate() {
            for (second, (other, _)) in cells.iter().enumerate().skip(first) {
                // The only cell of a type meets no other of it.
                let meet = first != second || cell.count() > 1;
                if meet && !named.contains(&Pair::Types(first, second)) {
                    missing.push(format!("{name}/{other}"));
                }
            }
        }
        let misspelt = contact.between.iter().any(|between| between.pair(&self.document.experiment).is_none());
        if missing.is_empty() || misspelt {
            return;
        }
        let pairs = words::all_of(missing.iter().map(String::as_str));
        let message = format!("`contact.between` does not say how strongly {pairs} stick");
        let (key, none) =
            if contact.model == ContactModel::VirtualAdhesives { ("kappa", "0 um") } else { ("strength", "0 Pa") };
        let help = format!(
            "add them, or give `{key}` to [contact] for all pairs that are not in the table; \"{none}\" does not stick"
        );
        self.fault("contact.between", "the table lacks pairs", message, help);
    }
}

/// Whether pairs of a model have a strength.
fn needs_strength(model: ContactModel) -> bool {
    matches!(model, ContactModel::Adhesives | ContactModel::Penalty)
}

/// A model as documents name it.
fn name_of(model: ContactModel) -> &'static str {
    match model {
        ContactModel::Adhesives => "\"adhesives\"",
        ContactModel::Cohesion => "\"cohesion\"",
        ContactModel::Links => "\"links\"",
        ContactModel::Penalty => "\"penalty\"",
        ContactModel::VirtualAdhesives => "\"virtual_adhesives\"",
    }
}

/// The model of a document in its words.
fn named(contact: &Contact) -> String {
    let default = if contact.model == ContactModel::default() { ", the default" } else { "" };
    format!("{}{default}", name_of(contact.model))
}

/// The keys of a table of contacts that some models know, as far as they are there, with these models.
fn keys_of_models(contact: &Contact) -> Vec<(String, &'static [ContactModel])> {
    use ContactModel::{Adhesives, Cohesion, Links, Penalty, VirtualAdhesives};
    let mut keys: Vec<(String, bool, &[ContactModel])> = vec![
        ("strength".into(), contact.strength.is_some(), &[Adhesives, Cohesion, Penalty]),
        ("shear_strength".into(), contact.shear_strength.is_some(), &[Adhesives, Cohesion]),
        ("friction".into(), contact.friction.is_some(), &[Cohesion]),
        ("bonds".into(), contact.bonds.is_some(), &[Cohesion]),
        ("energy".into(), contact.energy.is_some(), &[Adhesives, Cohesion]),
        ("link".into(), contact.link.is_some(), &[Links]),
        ("range".into(), contact.range.is_some(), &[Cohesion, Links]),
        ("penalty".into(), contact.penalty.is_some(), &[Penalty]),
        ("kappa".into(), contact.kappa.is_some(), &[VirtualAdhesives]),
        ("zones".into(), contact.zones.is_some(), &[VirtualAdhesives]),
    ];
    for (index, between) in contact.between.iter().enumerate() {
        let path = |key: &str| format!("between[{index}].{key}");
        keys.push((path("strength"), between.strength.is_some(), &[Adhesives, Cohesion, Penalty]));
        keys.push((path("shear_strength"), between.shear_strength.is_some(), &[Adhesives, Cohesion]));
        keys.push((path("friction"), between.friction.is_some(), &[Cohesion]));
        keys.push((path("bonds"), between.bonds.is_some(), &[Cohesion]));
        keys.push((path("energy"), between.energy.is_some(), &[Adhesives, Cohesion]));
        keys.push((path("range"), between.range.is_some(), &[Cohesion]));
        keys.push((path("link"), between.link.is_some(), &[Links]));
        keys.push((path("kappa"), between.kappa.is_some(), &[VirtualAdhesives]));
    }
    keys.retain(|(_, is_there, _)| *is_there);
    keys.into_iter().map(|(key, _, models)| (format!("contact.{key}"), models)).collect()
}
