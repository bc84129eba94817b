//! Reads the documents of equations and fields that an experiment names, and joins them to its cells.

mod ends;
mod links;
mod membrane;
mod names;
mod neighbours;
mod order;
mod profile;
mod read;

pub use profile::load as load_profile;

use super::super::{Chemistry as Entry, Document, Scheme};
use super::size::{self, Size};
use crate::equations::eml::{self, Level};
use crate::equations::expression::is_identifier;
use crate::equations::program::initial_values;
use crate::equations::tree::{Quantity, QuantityId, Role, Schedule};
use crate::error::{Error, Fault, Location};
use crate::field::{FieldSystem, Fields, Placing};
use crate::ode::{
    EventPlan, MOST_IMPLICIT, Method, Noise, Pace, Starts, Tolerances, assigned_parameters, clocked, too_large,
    too_many_times,
};
use crate::sim::Kind;
use crate::sim::chemistry::{Chemistry, FieldReactor, FieldStepping, Members, Reactor};

/// Tolerances of systems, where neither document says any: relative and absolute.
const SYSTEM_TOLERANCE: (f64, f64) = (1e-6, 1e-9);

/// A document of equations, read, with what the experiment says of it.
struct Part<'a> {
    /// Its name in the experiment.
    name: &'a str,
    entry: &'a Entry,
    document: eml::Document,
    /// Kinds that have it.
    kinds: Vec<usize>,
    /// Its number among the systems, or among the fields.
    number: usize,
    /// Of what stands beside fields, these.
    beside: Option<BesideFields>,
}

/// Which fields a system stands beside.
struct BesideFields {
    /// Their number.
    field: usize,
    /// Of each quantity of the document, whether it differs from point to point.
    local: Vec<bool>,
}

impl Part<'_> {
    fn is_field(&self) -> bool {
        !self.document.fields.is_empty()
    }

    /// Whether a quantity differs from atom to atom of a membrane.
    fn is_local(&self, quantity: QuantityId) -> bool {
        self.document.membrane.as_ref().is_some_and(|membrane| membrane.local[quantity as usize])
    }

    /// Whether a quantity is given by a membrane: a measure of the cell, or a sum over its surface.
    fn is_given(&self, quantity: QuantityId) -> bool {
        let Some(membrane) = &self.document.membrane else { return false };
        let id = self.document.system.quantities[quantity as usize].id.as_str();
        eml::SURFACE.contains(&id) || membrane.totals.iter().any(|total| total.quantity == quantity)
    }

    /// How many numbers a copy of the system has, and how many copies there are at most.
    fn numbers(&self, document: &Document, kinds: &[Kind]) -> [f64; 2] {
        let of_kind = |kind: &usize| {
            let kind = &kinds[*kind];
            let each = if self.document.level == Level::Membrane { kind.atoms() } else { 1 };
            document.experiment.cells.get(&kind.name).map_or(0.0, |cell| cell.most() as f64 * each as f64)
        };
        let copies = if self.kinds.is_empty() { 1.0 } else { self.kinds.iter().map(of_kind).sum() };
        [self.document.system.quantities.len() as f64, copies]
    }

    /// The key of the experiment that says something of it.
    fn key(&self, of: &str) -> String {
        format!("chemistry.{}.{of}", self.name)
    }
}

/// The chemistry of an experiment that starts with so many cells of each kind, and the fields as they start. Marks the kinds that links
/// act on.
pub fn chemistry(
    document: &Document,
    counts: &[usize],
    kinds: &mut [Kind],
    size: &mut Size,
    faults: &mut Vec<Fault>,
) -> (Chemistry, Vec<Fields>) {
    let before = faults.len();
    let mut chemistry = Chemistry::default();
    if document.experiment.chemistry.is_empty() {
        names::check(document, &chemistry, faults);
        return (chemistry, Vec::new());
    }
    let mut parts = read::parts(document, kinds, faults);
    if faults.len() > before {
        return (chemistry, Vec::new());
    }
    chemistry.rest = kinds
        .iter()
        .map(|kind| {
            [if kind.closed { crate::geometry::volume(&kind.rest) } else { 0.0 }, crate::geometry::area(&kind.rest)]
        })
        .collect();
    let mut fields = Vec::new();
    let scene_of = |field: usize| {
        let beside = |part: &&Part| part.beside.as_ref().is_some_and(|beside| beside.field == field);
        parts.iter().find(beside).map(|part| part.number)
    };
    for part in parts.iter().filter(|part| part.is_field()) {
        if let Some((mut reactor, start)) = field(document, part, size, faults) {
            reactor.scene = scene_of(part.number);
            chemistry.fields.push(reactor);
            fields.push(start);
        }
    }
    links::open_linked_parameters(&mut parts);
    for part in parts.iter().filter(|part| !part.is_field()) {
        match size::with_system(document, part.name, *size, part.numbers(document, kinds)) {
            Ok(with) => *size = with,
            Err(error) => tell(error, faults),
        }
        chemistry.reactors.extend(match part.document.level {
            Level::Membrane => membrane::reactor(document, part, kinds, faults),
            _ => reactor(document, part, faults),
        });
    }
    // Ends of links name systems and fields by their numbers, which stand only when all are there.
    if faults.len() == before {
        links::links(document, &parts, counts, kinds, &mut chemistry, faults);
        names::check(document, &chemistry, faults);
    }
    (chemistry, fields)
}

/// A fault at a key of the experiment.
fn at(document: &Document, key: &str, label: &str, fault: Fault) -> Fault {
    document.location(key, label).into_iter().fold(fault, Fault::at)
}

/// A fault in the document of equations, at a location there.
fn within(location: &Location, label: &str, message: String, help: impl Into<String>) -> Fault {
    Fault::new(message).at(Location { label: label.to_owned(), ..location.clone() }).help(help)
}

/// What a failed part of chemistry adds to the faults.
fn tell(error: Error, faults: &mut Vec<Fault>) {
    match error {
        Error::Input(more) => faults.extend(more),
        other => faults.push(Fault::new(other.to_string())),
    }
}

fn reactor(document: &Document, part: &Part, faults: &mut Vec<Fault>) -> Option<Reactor> {
    // What the experiment says of a document of fields is of these; what stands beside them is solved as is usual.
    let (entry, eml) = (part.beside.is_none().then_some(part.entry), &part.document);
    let method = if entry.is_some() { method(document, part, faults)? } else { Method::Rosenbrock };
    let variables = eml.system.variables().len();
    if method.is_implicit() && variables > MOST_IMPLICIT {
        let fault = too_large(&format!("`{}`", part.name), variables, "rosenbrock", "add `scheme = \"rk45\"`");
        faults.push(at(document, &part.key("document"), "this document", fault));
        return None;
    }
    if eml.system.has_delays() {
        faults.push(delays(document, part));
        return None;
    }
    let compiled = match eml.system.events.is_empty() {
        true => clocked(&eml.system).map(|program| (program, EventPlan::default())),
        false => EventPlan::compile(&eml.system, 0.0),
    };
    let compiled = compiled.and_then(|(program, events)| Ok((program, events, Noise::new(eml)?)));
    let (program, events, noise) = match compiled {
        Ok(compiled) => compiled,
        Err(circle) => {
            let message = format!("`{}` has a circle of definitions: {}", part.name, circle.join(" → "));
            let help = "let one of them be a variable";
            faults.push(at(document, &part.key("document"), "this document", Fault::new(message).help(help)));
            return None;
        }
    };
    let until = document.experiment.run.until.value() / eml.seconds;
    if let Some(detail) = too_many_times(&eml.system, &program.initial, (0.0, until)) {
        let fault = Fault::new(format!(
            "`{}` has an event that would fire more than {} times: {detail}",
            part.name,
            Schedule::MOST
        ));
        let fault = fault.help("let `every` be longer, or write what goes on all the time as a rate");
        faults.push(at(document, &part.key("document"), "this document", fault));
        return None;
    }
    let members = if part.kinds.is_empty() { Members::Scene } else { Members::Kinds(part.kinds.clone()) };
    let exchange = entry.and_then(|entry| entry.exchange).map(|time| time.value());
    let exchange = exchange.or(eml.solver.step.map(|step| step * eml.seconds));
    let set_by_events = assigned_parameters(&eml.system);
    let kept = |number: u32, role: &Role| match role {
        Role::Variable { .. } | Role::Defined { .. } | Role::Input => true,
        Role::Parameter => set_by_events.contains(&number),
    };
    // What counts executions of events that set fields has no identifier.
    let quantities = eml.system.quantities.iter().enumerate();
    let quantities = quantities.filter(|(number, q)| kept(*number as u32, &q.role) && is_identifier(&q.id));
    Some(Reactor {
        name: part.name.to_owned(),
        program,
        events,
        noise,
        starts: Starts::new(&eml.system),
        pace: if entry.is_some() { pace(document, part, eml.seconds, faults) } else { Pace::Never },
        membrane: None,
        beside: part.beside.as_ref().map(|beside| beside.field),
        members,
        seconds: eml.seconds,
        method,
        tolerances: Tolerances {
            relative: entry.and_then(|entry| entry.rtol).or(eml.solver.rtol).unwrap_or(SYSTEM_TOLERANCE.0),
            absolute: entry.and_then(|entry| entry.atol).or(eml.solver.atol).unwrap_or(SYSTEM_TOLERANCE.1),
            ..Tolerances::default()
        },
        exchange,
        recorded: quantities.map(|(number, q)| (number as u32, q.id.clone(), q.unit.clone())).collect(),
    })
}

/// The fault of a system that looks back, told where it does.
fn delays(document: &Document, part: &Part) -> Fault {
    let system = &part.document.system;
    let looks_back = |quantity: &Quantity| match &quantity.role {
        Role::Variable { rate: own } | Role::Defined { rule: own } => own.has_delay() || quantity.initial.has_delay(),
        Role::Parameter | Role::Input => false,
    };
    let message = format!("`{}` uses `delay`, and systems in an experiment keep no history", part.name);
    let help = "solve it alone with `pseudopod eml solve`, or write a chain of stages in place of the delay";
    match system.quantities.iter().position(looks_back) {
        Some(number) => within(&part.document.locations[number], "looks back", message, help),
        None => at(document, &part.key("document"), "this document", Fault::new(message).help(help)),
    }
}

/// How often the noise of a system kicks, in a unit of time of so many seconds.
fn pace(document: &Document, part: &Part, seconds: f64, faults: &mut Vec<Fault>) -> Pace {
    let (entry, eml) = (part.entry, &part.document);
    let step = entry.noise_step.map(|step| step.value()).or(eml.solver.noise_step.map(|step| step * eml.seconds));
    if eml.noise.is_empty() && entry.noise_step.is_some() {
        let key = part.key("noise_step");
        let fault = Fault::new(format!("`{key}` is given, but nothing in the document has noise"))
            .help("write noise=\"…\" at a variable of the document, or remove the key");
        faults.push(at(document, &key, "not used", fault));
    }
    match step {
        _ if eml.noise.is_empty() => Pace::Never,
        None => Pace::EachWindow,
        Some(step) => Pace::Every(step / seconds),
    }
}

/// The scheme of a system, with its inner step in the system's unit of time.
fn method(document: &Document, part: &Part, faults: &mut Vec<Fault>) -> Option<Method> {
    let (entry, solver) = (part.entry, &part.document.solver);
    let chosen = entry.scheme.map(eml::Scheme::from);
    let inner = entry.inner_step.map(|step| step.value() / part.document.seconds).or(solver.inner_step);
    let adaptive = matches!(entry.scheme, Some(Scheme::Rk45 | Scheme::Rk65 | Scheme::Rosenbrock));
    if adaptive && entry.inner_step.is_some() {
        let key = part.key("inner_step");
        let fault = Fault::new(format!("`{key}` has no meaning: the scheme finds its step"))
            .help("remove it, or choose scheme = \"rk4\"");
        faults.push(at(document, &key, "not used", fault));
    }
    let fixed = |make: fn(f64) -> Method, faults: &mut Vec<Fault>| {
        if inner.is_none() {
            let fault = Fault::new(format!("the scheme of `{}` needs a step", part.name))
                .help("add `inner_step = \"10 ms\"`, or choose scheme = \"rosenbrock\", which finds its step");
            faults.push(at(document, &part.key("scheme"), "has no step", fault));
        }
        inner.map(make)
    };
    match chosen.or(solver.scheme).unwrap_or(eml::Scheme::Rosenbrock) {
        eml::Scheme::Rk45 => Some(Method::Rk45),
        eml::Scheme::Rk65 => Some(Method::Rk65),
        eml::Scheme::Rosenbrock => Some(Method::Rosenbrock),
        eml::Scheme::Rk4 => fixed(|step| Method::Rk4 { step }, faults),
        eml::Scheme::Euler => fixed(|step| Method::Euler { step }, faults),
        eml::Scheme::Bdf => {
            let fault = Fault::new(format!("`{}` asks for the scheme bdf, which cannot take part in a run", part.name))
                .help("add `scheme = \"rosenbrock\"`: it takes stiff systems too, and a run can be resumed with it");
            faults.push(at(document, &part.key("document"), "this document", fault));
            None
        }
    }
}

impl From<Scheme> for eml::Scheme {
    fn from(scheme: Scheme) -> Self {
        match scheme {
            Scheme::Rk45 => Self::Rk45,
            Scheme::Rk65 => Self::Rk65,
            Scheme::Rosenbrock => Self::Rosenbrock,
            Scheme::Rk4 => Self::Rk4,
            Scheme::Euler => Self::Euler,
        }
    }
}

/// The document of a field with the scheme of its reactions that the experiment asks for.
fn with_scheme(document: &Document, part: &Part, faults: &mut Vec<Fault>) -> eml::Document {
    let mut eml = part.document.clone();
    match part.entry.scheme {
        Some(Scheme::Euler) => {
            let fault = Fault::new(format!("the reactions of `{}` cannot be taken with euler", part.name)).help(
                "write \"rk4\", \"rk45\", \"rk65\" or, for stiff reactions, \"rosenbrock\", or leave the scheme out",
            );
            faults.push(at(document, &part.key("scheme"), "this scheme", fault));
        }
        Some(scheme) => eml.solver.scheme = Some(scheme.into()),
        None => {}
    }
    eml
}

fn field(document: &Document, part: &Part, size: &mut Size, faults: &mut Vec<Fault>) -> Option<(FieldReactor, Fields)> {
    let (entry, eml) = (part.entry, &with_scheme(document, part, faults));
    if entry.exchange.is_some() {
        let fault = Fault::new(format!("`{}` has no meaning for fields", part.key("exchange")))
            .help("remove it; fields advance with every step of the run, with rtol, or with a fixed inner_step");
        faults.push(at(document, &part.key("exchange"), "not used", fault));
    }
    let corner = |given: Option<[crate::units::Length; 3]>| given.map(|corner| corner.map(|x| x.value()));
    let placing = match (corner(entry.origin), corner(entry.size)) {
        (None, None) => None,
        (origin, Some(size)) => {
            // Where only the size is given, the grid lies around the origin, its floor at z = 0.
            let middle = [-0.5 * size[0], -0.5 * size[1], 0.0];
            Some(Placing { origin: origin.unwrap_or(middle), size })
        }
        (Some(_), None) => {
            let fault = Fault::new(format!("`{}` is given without a size", part.key("origin")))
                .help("add `size = [\"200 um\", \"200 um\", \"0 um\"]`");
            faults.push(at(document, &part.key("origin"), "without a size", fault));
            return None;
        }
    };
    let system = FieldSystem::new(eml, placing.as_ref()).map_err(|error| tell(error, faults)).ok()?;
    *size = size::with_field(document, part.name, *size, &system).map_err(|error| tell(error, faults)).ok()?;
    let folder = document.resolve(&entry.document);
    let load = |profile: &eml::Profile, grid: &_| profile::load(&folder, profile, grid);
    let start = system.start(&load).map_err(|error| tell(error, faults)).ok()?;
    let usual = system.usual_tolerance();
    let stepping = match entry.inner_step {
        Some(step) => FieldStepping::Longest(step.value()),
        None => FieldStepping::Adaptive {
            relative: entry.rtol.or(eml.solver.rtol).unwrap_or(usual.0),
            absolute: entry.atol.or(eml.solver.atol).unwrap_or(usual.1),
        },
    };
    let pace = pace(document, part, 1.0, faults);
    let constants = initial_values(&eml.system, 0.0).unwrap_or_default();
    let name = part.name.to_owned();
    Some((FieldReactor { name, system, scene: None, stepping, pace, constants }, start))
}
