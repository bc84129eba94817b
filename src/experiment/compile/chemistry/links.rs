//! Links: those in the documents of equations and those that the experiment adds, joined to the model.

use super::super::super::{Chemistry as Entry, ChemistryLink, Document};
use super::ends::{Ends, Side, differs, kind_of_cell};
use super::order::order;
use super::{BesideFields, Part, at, membrane, within};
use crate::cell::ends::Reading;
use crate::equations::eml::{self, Endpoint, LinkDescription, Root};
use crate::equations::expression::Trouble;
use crate::equations::tree::{Event, Expr, QuantityId, Role, System};
use crate::error::{Fault, Location};
use crate::ode::assigned_parameters;
use crate::sim::Kind;
use crate::sim::chemistry::{
    AtAtoms, Chemistry, Control, Link, NeighbourNumber, NeighbourReading, Owner, Source, Target,
};

/// Parameters that a link of the experiment sets become inputs; those that events set do not.
pub(super) fn open_linked_parameters(parts: &mut [Part]) {
    for part in parts.iter_mut().filter(|part| part.beside.is_none() && part.document.scene.is_none()) {
        open_linked(&mut part.document.system, part.entry);
    }
}

/// The same of one system.
pub(super) fn open_linked(system: &mut System, entry: &Entry) {
    let set_by_events = assigned_parameters(system);
    for link in &entry.links {
        if let Ok((Root::System(number), _)) = eml::read_end(&link.to, system)
            && !set_by_events.contains(&number)
        {
            let role = &mut system.quantities[number as usize].role;
            if *role == Role::Parameter {
                *role = Role::Input;
            }
        }
    }
}

/// Joins all links to the model, in an order in which they can carry their numbers.
pub(super) fn links(
    document: &Document,
    parts: &[Part],
    counts: &[usize],
    kinds: &mut [Kind],
    chemistry: &mut Chemistry,
    faults: &mut Vec<Fault>,
) {
    let before = faults.len();
    let mut links: Vec<(Link, Location)> = Vec::new();
    let planes: Vec<&str> = document.experiment.obstacles().collect();
    for part in parts.iter().filter(|part| part.document.scene.is_none()) {
        let mut shown = Vec::new();
        let described = part.document.links.iter().map(|link| (link.clone(), Ok(link.location.clone())));
        let own: Vec<_> = described.chain(outside(document, part, faults)).collect();
        for (description, location) in own {
            let location = location.unwrap_or_else(|key| nowhere(document, &key));
            let touching = document.experiment.contact.is_some();
            let mut ends = Ends { parts, part, kinds, counts, chemistry, touching, planes: &planes };
            match link(&mut ends, &mut shown, &description) {
                Ok(link) => links.push((link, location)),
                Err(fault) => faults.push(fault),
            }
        }
        if !shown.is_empty() {
            membrane::show(part, chemistry, &shown);
        }
    }
    if faults.len() > before {
        return;
    }
    let systems: Vec<&System> =
        parts.iter().filter(|part| !part.is_field()).map(|part| &part.document.system).collect();
    let (plain, locations): (Vec<Link>, Vec<Location>) = links.into_iter().unzip();
    match order(&plain, &systems, &chemistry.reactors) {
        Ok(order) => {
            for &number in &order {
                act(&plain[number], chemistry, counts, kinds);
            }
            chemistry.set_links(order.into_iter().map(|number| plain[number].clone()).collect());
        }
        Err(circle) => {
            let texts: Vec<&str> = circle.iter().map(|&number| plain[number].text.as_str()).collect();
            let message = format!("links close a loop without a time step: {}", texts.join(", then "));
            let help = "let a variable stand between them: what only definitions join has no beginning";
            faults.push(within(&locations[circle[0]], "in the loop", message, help));
        }
    }
}

/// A location for a link of the experiment that is not written there.
fn nowhere(document: &Document, key: &str) -> Location {
    let whole = Location { source: document.source.clone(), start: 0, length: 0, label: String::new() };
    document.location(key, "this link").unwrap_or(whole)
}

/// What links do to the model as a whole.
fn act(link: &Link, chemistry: &mut Chemistry, counts: &[usize], kinds: &mut [Kind]) {
    let of_neighbours = |reading: NeighbourReading| matches!(reading.number, NeighbourNumber::Cell(_));
    chemistry.measures_cells |= match link.from {
        Source::Cell(_, reading) => !matches!(reading, Reading::Atom(..)),
        Source::Neighbours(reading) => of_neighbours(reading),
        _ => false,
    };
    let Target::Cell(whose, control) = link.to else { return };
    let cells = link_kinds(link.owner, whose, chemistry, counts);
    for kind in cells {
        let kind = &mut kinds[kind];
        match control {
            Control::Bias(_) => kind.make_biased(),
            Control::Atom(atom, axis) => {
                chemistry.imposes_atoms = true;
                let held =
                    if kind.held.is_empty() { vec![1.0; 3 * kind.atoms()] } else { std::mem::take(&mut kind.held) };
                kind.held = held;
                kind.held[3 * atom + axis] = 0.0;
            }
            _ => {}
        }
    }
}

/// The kinds whose cells a link sets.
fn link_kinds(
    owner: Owner,
    whose: crate::sim::chemistry::Whose,
    chemistry: &Chemistry,
    counts: &[usize],
) -> Vec<usize> {
    use crate::sim::chemistry::{Members, Whose};
    match (whose, owner) {
        (Whose::Kind(kind), _) => vec![kind],
        (Whose::Cell(cell), _) => kind_of_cell(counts, cell).into_iter().collect(),
        (Whose::Own, Owner::Reactor(number)) => match &chemistry.reactors[number].members {
            Members::Scene => Vec::new(),
            Members::Kinds(kinds) => kinds.clone(),
        },
        (Whose::Own, Owner::Field(_)) => Vec::new(),
    }
}

/// A link; what membranes have to work out at atoms for it is put to what is shown.
fn link(ends: &mut Ends, shown: &mut Vec<Expr>, description: &LinkDescription) -> Result<Link, Fault> {
    let owner = ends.owner();
    if let Some(beside) = &ends.part.beside {
        let fields = &ends.chemistry.fields[beside.field].system;
        one_of_scene(ends.part, beside, &|id| fields.species_number(id).is_some(), description)?;
    }
    let (from, to, source) = joined(ends, shown.len(), description)?;
    let mut needs: Vec<QuantityId> = source.into_iter().collect();
    description.transfer.each_quantity(&mut |quantity| {
        if quantity != LinkDescription::VALUE && !needs.contains(&quantity) {
            needs.push(quantity);
        }
    });
    if let (Source::Atoms(AtAtoms::Shown(_)), Some(quantity)) = (from, source) {
        shown.push(carried(description, quantity));
    }
    let uses = match from {
        Source::Atoms(AtAtoms::Shown(_)) => Vec::new(),
        _ => needs.clone(),
    };
    if let Some(used) = uses.iter().find(|used| ends.part.is_local(**used)) {
        let id = &ends.part.document.system.quantities[*used as usize].id;
        let message = format!("the transfer uses `{id}`, which differs from atom to atom");
        let help = "use a <mean> or an <integral> of it";
        return Err(within(&description.location, "on the membrane", message, help));
    }
    ends.check_grid(description, &from, &to)?;
    let text = format!("of `{}` from {} to {}", ends.part.name, description.from.text, description.to.text);
    let (transfer, gain) = (description.transfer.clone(), description.gain);
    let drives = match (to, &description.to.root) {
        (Target::Own(_), Root::System(quantity)) => drives(ends.part, *quantity),
        _ => false,
    };
    Ok(Link { text, owner, from, to, transfer, uses, needs, gain, drives })
}

/// Whether rates change with a quantity that is set from outside, and no events may happen by it.
fn drives(part: &Part, quantity: QuantityId) -> bool {
    let system = &part.document.system;
    let by_rate = |role: &Role| match role {
        Role::Variable { rate } => eml::reached(rate, system).contains(&quantity),
        _ => false,
    };
    let of_fields = part.is_field() || part.beside.is_some();
    system.events.is_empty() && (of_fields || system.quantities.iter().any(|quantity| by_rate(&quantity.role)))
}

/// Refuses a link of what stands beside fields that uses what differs from point to point.
fn one_of_scene(
    part: &Part,
    BesideFields { local, .. }: &BesideFields,
    is_field: &dyn Fn(&str) -> bool,
    description: &LinkDescription,
) -> Result<(), Fault> {
    let mut used = Vec::new();
    if let Root::System(quantity) = description.from.root {
        used.push((quantity, &description.from.location));
    }
    description.transfer.each_quantity(&mut |quantity| used.push((quantity, &description.location)));
    let differs = |quantity: QuantityId| local.get(quantity as usize) == Some(&true);
    let Some((quantity, location)) = used.into_iter().find(|(quantity, _)| differs(*quantity)) else { return Ok(()) };
    let id = &part.document.system.quantities[quantity as usize].id;
    let message = format!("`{id}` differs from point to point, and a link carries one number");
    let help = match is_field(id) {
        true => format!("link from field[{id}], which a cell senses where it is, or from a <mean> or <integral> of it"),
        false => "link from a <mean> or an <integral> of it".to_owned(),
    };
    Err(within(location, "at which point?", message, help))
}

/// The two ends of a link, and the quantity of the system that it reads.
fn joined(
    ends: &mut Ends,
    shown: usize,
    description: &LinkDescription,
) -> Result<(Source, Target, Option<QuantityId>), Fault> {
    let local = match description.from.root {
        Root::System(quantity) => ends.part.is_local(quantity).then_some(quantity),
        _ => None,
    };
    if let Some(quantity) = local {
        let to = ends.target(&description.to)?;
        return match to.is_at_atoms() {
            true => Ok((Source::Atoms(AtAtoms::Shown(shown)), to, Some(quantity))),
            false => Err(differs(&description.from)),
        };
    }
    let from = ends.source(&description.from)?;
    let to = ends.target(&description.to)?;
    if let (Source::Atoms(_), false) = (from, to.is_at_atoms()) {
        let message = format!("{} has a number for each atom, {} one", description.from.text, description.to.text);
        let help = "declare the <input> with level=\"membrane\"; a <mean> or an <integral> makes one number of it";
        return Err(within(&description.to.location, "one number", message, help));
    }
    let source = match from {
        Source::Own(quantity) => Some(quantity),
        _ => None,
    };
    Ok((from, to, source))
}

/// What the transfer of a link makes of a quantity.
fn carried(description: &LinkDescription, quantity: QuantityId) -> Expr {
    description.transfer.replaced(LinkDescription::VALUE, &Expr::Quantity(quantity))
}

type Located = (LinkDescription, Result<Location, String>);

/// The links that the experiment adds to a document.
fn outside(document: &Document, part: &Part, faults: &mut Vec<Fault>) -> Vec<Located> {
    let mut found = Vec::new();
    for (index, link) in part.entry.links.iter().enumerate() {
        let key = part.key(&format!("links[{index}]"));
        if let Some(description) = described(document, &key, link, &part.document.system, faults) {
            found.push((description, Err(key)));
        }
    }
    found
}

fn described(
    document: &Document,
    key: &str,
    link: &ChemistryLink,
    system: &System,
    faults: &mut Vec<Fault>,
) -> Option<LinkDescription> {
    let before = faults.len();
    let mut end = |name: &str, text: &str| -> Option<Endpoint> {
        let key = format!("{key}.{name}");
        match eml::read_end(text, system) {
            Ok((root, path)) => {
                Some(Endpoint { root, path, text: text.trim().to_owned(), location: nowhere(document, &key) })
            }
            Err(trouble) => {
                faults.push(fault_of(document, &key, &trouble));
                None
            }
        }
    };
    let (from, to) = (end("from", &link.from), end("to", &link.to));
    let transfer = match &link.transfer {
        None => Some(Expr::Quantity(LinkDescription::VALUE)),
        Some(text) => match eml::read_transfer(text, system) {
            Ok(transfer) => Some(transfer),
            Err(troubles) => {
                let key = format!("{key}.transfer");
                faults.extend(troubles.iter().map(|trouble| fault_of(document, &key, trouble)));
                None
            }
        },
    };
    let (from, to) = (from?, to?);
    match (&from.root, &to.root) {
        (Root::System(_), Root::System(_)) => {
            let fault = Fault::new("both ends of the link are in the system")
                .help("inside a system write expressions; a link joins it to scene, cell, type or field");
            faults.push(at(document, &format!("{key}.to"), "the same system", fault));
        }
        (Root::System(_), _) => {}
        (_, Root::System(number)) => {
            let quantity = &system.quantities[*number as usize];
            let sets = |event: &&Event| event.assignments.iter().any(|(set, _)| set == number);
            if let Some(event) = system.events.iter().find(sets) {
                let message = format!("a link cannot set `{}`, which the event `{}` sets", quantity.id, event.id);
                let fault = Fault::new(message).help("let it set a parameter that no event sets, or an <input>");
                faults.push(at(document, &format!("{key}.to"), "set by an event", fault));
            } else if quantity.role != Role::Input {
                let fault = Fault::new(format!("a link cannot set `{}`, which the equations give", quantity.id))
                    .help("let it set a parameter or an <input>");
                faults.push(at(document, &format!("{key}.to"), "not set from outside", fault));
            }
        }
        _ => {
            let fault = Fault::new("no end of the link is in the system")
                .help("let one end be system.ID: the link belongs to this document");
            faults.push(at(document, key, "this link", fault));
        }
    }
    if faults.len() > before {
        return None;
    }
    let location = nowhere(document, key);
    Some(LinkDescription { id: String::new(), from, to, transfer: transfer?, gain: link.gain.unwrap_or(1.0), location })
}

/// A trouble in a text of the experiment, marked where it is in the text.
fn fault_of(document: &Document, key: &str, trouble: &Trouble) -> Fault {
    let fault = Fault::new(trouble.message.clone()).help(trouble.help.clone());
    let Some(mut location) = document.location(key, trouble.label.clone()) else { return fault };
    let written = &location.source.text[location.start..location.start + location.length];
    // In a text with escapes locations shift; then the whole text is marked.
    let plain = written.len() >= 2 && written.starts_with(['"', '\'']) && !written.contains('\\');
    if plain && trouble.at.end <= written.len() - 2 {
        location.start += 1 + trouble.at.start;
        location.length = trouble.at.len();
    }
    fault.at(location)
}

impl Ends<'_, '_> {
    /// Whose link it is.
    pub(super) fn owner(&self) -> Owner {
        if self.part.is_field() { Owner::Field(self.part.number) } else { Owner::Reactor(self.part.number) }
    }

    /// Where a number comes from.
    fn source(&mut self, end: &Endpoint) -> Result<Source, Fault> {
        match &end.root {
            Root::System(quantity) if self.part.is_local(*quantity) => Err(differs(end)),
            Root::System(quantity) if !self.part.is_field() => Ok(Source::Own(*quantity)),
            Root::System(_) => Err(within(
                &end.location,
                "of fields",
                "a document of fields has no single number to give".to_owned(),
                "link from field[NAME].mean, .largest, .smallest or .amount in the system that wants it",
            )),
            _ => self.read(end, Side::From),
        }
    }

    /// An input of a membrane that differs from atom to atom.
    fn given(&self, quantity: QuantityId) -> Option<Target> {
        let reactor = self.chemistry.reactors.get(self.part.number).filter(|_| !self.part.is_field())?;
        reactor.membrane.as_ref()?.system.given_number(quantity).map(Target::Given)
    }

    /// Where a number goes.
    fn target(&mut self, end: &Endpoint) -> Result<Target, Fault> {
        let Root::System(quantity) = end.root else { return self.set(end) };
        if self.part.is_given(quantity) {
            let message = format!("{} cannot be set by a link: it is taken from the membrane", end.text);
            return Err(within(&end.location, "not an input", message, "link to an <input>"));
        }
        let location = if self.part.is_field() {
            let id = &self.part.document.system.quantities[quantity as usize].id;
            let inputs = self.chemistry.fields[self.part.number].system.inputs();
            inputs.iter().position(|(input, _)| input == id)
        } else {
            self.chemistry.reactors[self.part.number].program.open_index(quantity)
        };
        let given = self.given(quantity);
        given.or(location.map(Target::Own)).ok_or_else(|| {
            let message = format!("{} cannot be set by a link", end.text);
            within(&end.location, "not an input", message, "link to an <input>")
        })
    }
}
