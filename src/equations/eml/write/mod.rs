//! Writes documents: what the program read, or a model that came from SBML, as a text that can be read and edited.

mod fixed;
mod names;

use super::declare::{POSITION, SURFACE};
use super::document::{Document, FieldDescription, Level, LinkDescription, Profile, SIDES, Taken, Wall};
use super::solver::SCHEMES;
use crate::equations::expression;
use crate::equations::program::initial_values;
use crate::equations::tree::{Event, Expr, Participant, Quantity, QuantityId, Reaction, Role};
use crate::error::Source;
use fixed::{fixed, uses};
use names::Names;
use std::fmt::Write as _;
use std::sync::Arc;

/// A document as a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// What is not as it was, one sentence each: new names, values that EML cannot have.
    pub notices: Vec<String>,
}

/// Longest rate that stands in its variable's element, bytes.
const SHORT: usize = 60;

/// Writes a document, below a comment (none when it is empty). Reading the text gives the same system; one that came
/// from SBML gets names that EML can have and solves to the same numbers. Functions are written out where they were
/// called. Units are written, unless some expression had numbers with units of their own, which a [`Document`] does not
/// keep: then all units of quantities are left out.
pub fn write(document: &Document, comment: &str) -> Written {
    let measured = document.system.quantities.iter().any(|quantity| !quantity.unit.is_empty());
    let written = Writer::new(document, measured).document(comment);
    if !measured || stands(document, &written) {
        return written;
    }
    let mut written = Writer::new(document, false).document(comment);
    written.notices.push("units are left out: numbers had units of their own, which are not kept".into());
    written
}

/// Whether the units of a document's quantities fit its expressions when all numbers in these are plain ones; not where numbers had
/// units of their own, which a [`Document`] does not keep.
pub fn numbers_are_plain(document: &Document) -> bool {
    stands(document, &Writer::new(document, true).document(""))
}

/// Whether what was written of a document can be read.
fn stands(document: &Document, written: &Written) -> bool {
    let source = Source { name: document.name.clone(), text: written.text.clone() };
    super::read(Arc::new(source)).is_ok()
}

struct Writer<'a> {
    document: &'a Document,
    names: Names,
    /// Parameters of the text: what keeps one value that other such values give.
    fixed: Vec<bool>,
    measured: bool,
    text: String,
}

impl<'a> Writer<'a> {
    fn new(document: &'a Document, measured: bool) -> Self {
        let names = Names::of(&document.system, document.level);
        Self { document, names, fixed: fixed(document), measured, text: String::new() }
    }

    fn document(mut self, comment: &str) -> Written {
        let document = self.document;
        self.text.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
        if !comment.is_empty() {
            let comment = comment.replace("--", "- -");
            self.line(format_args!("<!-- {}{} -->", comment, if comment.ends_with('-') { " " } else { "" }));
        }
        let level = match document.level {
            Level::Scene => "",
            Level::Cell => " level=\"cell\"",
            Level::Field => " level=\"field\"",
            Level::Membrane => " level=\"membrane\"",
        };
        let seconds = document.time_unit == "s" && !self.measured;
        let unit = if seconds { String::new() } else { attribute("time_unit", &document.time_unit) };
        self.line(format_args!("<eml{}{level}{unit}>", attribute("name", &document.name)));
        for number in 0..document.system.quantities.len() {
            self.quantity(number as QuantityId);
        }
        for (index, event) in document.system.events.iter().enumerate() {
            self.event(event, index);
        }
        self.grid();
        self.solver();
        document.links.iter().for_each(|link| self.link(link));
        self.text.push_str("</eml>\n");
        Written { text: self.text, notices: self.names.notices }
    }

    fn line(&mut self, line: std::fmt::Arguments) {
        // Writing to a text cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    /// The text of an expression; comparisons are words, so that nothing need be escaped.
    fn expression(&self, expr: &Expr) -> String {
        let name = |number: QuantityId| match number {
            LinkDescription::VALUE => "value".to_owned(),
            number => self.names.quantities[number as usize].clone(),
        };
        expression::write(expr, &name).replace(" < ", " lt ").replace(" <= ", " le ")
    }

    fn quantity(&mut self, number: QuantityId) {
        let document = self.document;
        let quantity = &document.system.quantities[number as usize];
        let is_given = match document.level {
            Level::Field => POSITION.contains(&quantity.id.as_str()),
            Level::Membrane => SURFACE.contains(&quantity.id.as_str()),
            Level::Scene | Level::Cell => false,
        };
        if is_given || document.system.draws.iter().any(|draw| draw.quantity == number) {
            return;
        }
        let id = self.names.quantities[number as usize].clone();
        let mut head = attribute("id", &id);
        let mut tail = String::new();
        if self.measured && !quantity.unit.is_empty() {
            tail.push_str(&attribute("unit", &quantity.unit));
        }
        if !quantity.name.is_empty() {
            tail.push_str(&attribute("name", &quantity.name));
        }
        if let Some(reaction) = document.system.reactions.iter().find(|reaction| reaction.rate == number) {
            return self.reaction(reaction, quantity, &head);
        }
        if let Some(field) = document.fields.iter().find(|field| field.quantity == number) {
            return self.field(field, quantity, &head, &tail);
        }
        if let Some(before) = document.system.before_start(number) {
            tail.push_str(&attribute("history", &self.history(before)));
        }
        if let Role::Defined { rule: Expr::Root(equations, index) } = &quantity.role {
            let index = *index as usize;
            let start = attribute("start", &self.expression(&equations.starts[index]));
            let residual = self.expression(&equations.residuals[index]);
            return self.line(format_args!("  <algebraic{head}{start}{tail}>{residual} = 0</algebraic>"));
        }
        if let Role::Defined { rule } = &quantity.role {
            let rule = self.expression(rule);
            return self.line(format_args!("  <define{head}{tail}>{rule}</define>"));
        }
        let of_scene = document.scene.iter().flat_map(|scene| &scene.totals);
        let mut totals = document.membrane.iter().flat_map(|membrane| &membrane.totals).chain(of_scene);
        if let Some(total) = totals.find(|total| total.quantity == number) {
            let element = if total.taken == Taken::Mean { "mean" } else { "integral" };
            let integrand = self.expression(&total.integrand);
            return self.line(format_args!("  <{element}{head}{tail}>{integrand}</{element}>"));
        }
        if let Some(membrane) = &document.membrane {
            match membrane.surface.iter().find(|variable| variable.quantity == number) {
                Some(variable) => tail.push_str(&attribute("diffusion", &self.expression(&variable.diffusion))),
                None if matches!(quantity.role, Role::Variable { .. }) => tail.push_str(&attribute("level", "cell")),
                None if membrane.given.contains(&number) => tail.push_str(&attribute("level", "membrane")),
                None => {}
            }
        }
        tail.push_str(&self.noise(number));
        let initial = self.initial(number);
        let zero = Expr::Number(0.0);
        let (element, value, rate) = match &quantity.role {
            Role::Variable { .. } if self.is_changed(number) => ("variable", "initial", None),
            Role::Variable { rate } => ("variable", "initial", Some(rate)),
            Role::Input => ("input", "default", None),
            // What events change, or what needs the start of what changes, is a variable in EML.
            _ if !self.fixed[number as usize] => ("variable", "initial", Some(&zero)),
            _ => ("parameter", "value", None),
        };
        head.push_str(&attribute(value, &initial));
        let rate = rate.map(|rate| self.expression(rate));
        match rate {
            Some(rate) if rate.len() > SHORT => {
                self.line(format_args!("  <{element}{head}{tail}/>"));
                self.line(format_args!("  <equation of=\"{id}\">{rate}</equation>"));
            }
            Some(rate) => self.line(format_args!("  <{element}{head}{}{tail}/>", attribute("rate", &rate))),
            None => self.line(format_args!("  <{element}{head}{tail}/>")),
        }
    }

    /// Whether reactions say all of the rate of a variable.
    fn is_changed(&self, number: QuantityId) -> bool {
        self.document.system.reactions.iter().any(|reaction| reaction.changed().any(|changed| changed == number))
    }

    fn reaction(&mut self, reaction: &Reaction, quantity: &Quantity, head: &str) {
        let Role::Defined { rule } = &quantity.role else { return };
        let side = |participants: &[Participant]| {
            let term = |participant: &Participant| {
                let count = participant.stoichiometry;
                let count = if count == 1.0 { String::new() } else { format!("{count} ") };
                let held = if participant.is_held { "$" } else { "" };
                format!("{count}{held}{}", self.names.quantities[participant.quantity as usize])
            };
            participants.iter().map(term).collect::<Vec<_>>().join(" + ")
        };
        let arrow = if reaction.reversible { "=" } else { "->" };
        let equation = format!("{} {arrow} {}", side(&reaction.reactants), side(&reaction.products));
        let name = if quantity.name.is_empty() { String::new() } else { attribute("name", &quantity.name) };
        let equation = attribute("equation", equation.trim());
        let rate = attribute("rate", &self.expression(rule));
        self.line(format_args!("  <reaction{head}{equation}{rate}{name}/>"));
    }

    /// The attribute of the noise of a variable; empty without.
    fn noise(&self, number: QuantityId) -> String {
        let noise = self.document.noise.iter().find(|noise| noise.quantity == number);
        noise.map_or(String::new(), |noise| attribute("noise", &self.expression(&noise.strength)))
    }

    /// The text of what was before the start, which EML makes of parameters and the time.
    fn history(&self, before: &Expr) -> String {
        if !uses(before, &|other| !self.fixed[other]) {
            return self.expression(before);
        }
        let values = initial_values(&self.document.system, 0.0).unwrap_or_default();
        let at_start = |number: QuantityId| values.get(number as usize).copied().unwrap_or(f64::NAN);
        self.expression(&Expr::Number(before.evaluate(0.0, &at_start)))
    }

    /// The text of the value at the start, which EML wants finite and without time.
    fn initial(&mut self, number: QuantityId) -> String {
        let system = &self.document.system;
        let quantity = &system.quantities[number as usize];
        if let Expr::Number(value) = quantity.initial
            && value.is_nan()
        {
            let id = &self.names.quantities[number as usize];
            self.names.notices.push(format!("`{id}` has no value at the start: 0 stands in its stead"));
            return "0".to_owned();
        }
        let outside = matches!(quantity.role, Role::Input) && uses(&quantity.initial, &|other| !self.fixed[other]);
        if quantity.initial.uses_time() || outside {
            let values = initial_values(system, 0.0).unwrap_or_default();
            let value = values.get(number as usize).copied().unwrap_or(f64::NAN);
            return self.expression(&Expr::Number(value));
        }
        self.expression(&quantity.initial)
    }

    fn event(&mut self, event: &Event, index: usize) {
        if event.assignments.is_empty() {
            let notice = format!("the event `{}` sets nothing and is left out", event.id);
            return self.names.notices.push(notice);
        }
        let mut head = String::new();
        if !self.names.events[index].is_empty() {
            head.push_str(&attribute("id", &self.names.events[index]));
        }
        match &event.schedule {
            Some(schedule) => {
                let until = schedule.until.as_ref();
                let times = [("every", Some(&schedule.every)), ("first", Some(&schedule.first)), ("until", until)];
                for (name, time) in times {
                    head.push_str(&time.map_or(String::new(), |time| attribute(name, &self.expression(time))));
                }
            }
            None => head.push_str(&attribute("when", &self.expression(&event.trigger))),
        }
        for (name, value) in [("delay", &event.delay), ("priority", &event.priority)] {
            if let Some(value) = value {
                head.push_str(&attribute(name, &self.expression(value)));
            }
        }
        let words = [
            (!event.values_from_firing, " values_from=\"execution\""),
            (!event.persistent, " persistent=\"false\""),
            (event.true_before_start, " at_start=\"wait\""),
        ];
        words.iter().filter(|(said, _)| *said).for_each(|(_, word)| head.push_str(word));
        self.line(format_args!("  <event{head}>"));
        for (target, value) in &event.assignments {
            let id = self.names.quantities[*target as usize].clone();
            let value = self.expression(value);
            self.line(format_args!("    <set id=\"{id}\">{value}</set>"));
        }
        self.line(format_args!("  </event>"));
    }

    fn grid(&mut self) {
        let Some(grid) = &self.document.grid else { return };
        let numbers = |values: &[f64; 3]| values[..grid.dimension].iter().map(f64::to_string).collect::<Vec<_>>();
        let mut head = format!(" dimension=\"{}\" spacing=\"{}\"", grid.dimension, grid.spacing);
        for (name, values) in [("origin", &grid.origin), ("size", &grid.size)] {
            if let Some(values) = values {
                head.push_str(&attribute(name, &numbers(values).join(" ")));
            }
        }
        if grid.unit != "um" {
            head.push_str(&attribute("unit", &grid.unit));
        }
        self.line(format_args!("  <grid{head}/>"));
    }

    fn field(&mut self, field: &FieldDescription, quantity: &Quantity, head: &str, tail: &str) {
        let mut head = head.to_owned();
        for (name, value) in [("diffusion", &field.diffusion), ("decay", &field.decay)] {
            if *value != Expr::Number(0.0) {
                head.push_str(&attribute(name, &self.expression(value)));
            }
        }
        let scaled = |name: &str, file: &str, scale: f64| format!("{} scale=\"{scale}\"", attribute(name, file));
        head.push_str(&match &field.initial {
            Profile::Expression(initial) => attribute("initial", &self.expression(initial)),
            Profile::Image { file, scale, .. } => scaled("image", file, *scale),
            Profile::Dataset { file, dataset, scale, .. } => scaled("dataset", &format!("{file}:{dataset}"), *scale),
        });
        if field.range == crate::equations::Range::Free {
            head.push_str(" range=\"free\"");
        }
        head.push_str(&self.noise(field.quantity));
        self.line(format_args!("  <field{head}{tail}>"));
        self.transport(field);
        for (side, wall) in SIDES.iter().zip(&field.walls) {
            match wall {
                Wall::NoFlux => {}
                Wall::Periodic => self.line(format_args!("    <wall side=\"{side}\" kind=\"periodic\"/>")),
                Wall::Fixed(value) | Wall::Flux(value) | Wall::Open(value) => {
                    let value = attribute("value", &self.expression(value));
                    let kind = match wall {
                        Wall::Flux(_) => "flux",
                        Wall::Open(_) => "open",
                        _ => "fixed",
                    };
                    self.line(format_args!("    <wall side=\"{side}\" kind=\"{kind}\"{value}/>"));
                }
            }
        }
        if let Role::Variable { rate } = &quantity.role
            && *rate != Expr::Number(0.0)
            && !self.is_changed(field.quantity)
        {
            let rate = self.expression(rate);
            self.line(format_args!("    <reaction>{rate}</reaction>"));
        }
        self.line(format_args!("  </field>"));
    }

    /// What carries a field, and its sources.
    fn transport(&mut self, field: &FieldDescription) {
        let dimension = self.document.grid.as_ref().map_or(3, |grid| grid.dimension);
        if let Some(velocity) = &field.advection {
            let along = velocity.iter().zip(POSITION).take(dimension);
            let head: String = along.map(|(along, name)| attribute(name, &self.expression(along))).collect();
            self.line(format_args!("    <advection{head}/>"));
        }
        for taxis in &field.taxis {
            let towards = attribute("towards", &self.names.quantities[taxis.towards as usize]);
            let sensitivity = attribute("sensitivity", &self.expression(&taxis.sensitivity));
            self.line(format_args!("    <taxis{towards}{sensitivity}/>"));
        }
        for source in &field.sources {
            let numbers = |ends: &[f64; 3]| ends[..dimension].iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
            let [from, to] = source.ends.each_ref().map(numbers);
            let head = match from == to {
                true => attribute("at", &from),
                false => attribute("from", &from) + &attribute("to", &to),
            };
            let strength = attribute("strength", &self.expression(&source.strength));
            self.line(format_args!("    <source{head}{strength}/>"));
        }
    }

    fn solver(&mut self) {
        let solver = &self.document.solver;
        let scheme = SCHEMES.iter().find(|(_, scheme)| Some(*scheme) == solver.scheme);
        let mut head = scheme.map_or(String::new(), |(name, _)| attribute("scheme", name));
        let numbers = [
            ("rtol", solver.rtol),
            ("atol", solver.atol),
            ("step", solver.step),
            ("inner_step", solver.inner_step),
            ("noise_step", solver.noise_step),
        ];
        for (name, value) in numbers {
            if let Some(value) = value {
                head.push_str(&attribute(name, &self.expression(&Expr::Number(value))));
            }
        }
        if !head.is_empty() {
            self.line(format_args!("  <solver{head}/>"));
        }
    }

    fn link(&mut self, link: &LinkDescription) {
        let mut head = if link.id.is_empty() { String::new() } else { attribute("id", &link.id) };
        head.push_str(&attribute("from", &link.from.text));
        head.push_str(&attribute("to", &link.to.text));
        if link.transfer != Expr::Quantity(LinkDescription::VALUE) {
            head.push_str(&attribute("transfer", &self.expression(&link.transfer)));
        }
        if link.gain != 1.0 {
            head.push_str(&attribute("gain", &link.gain.to_string()));
        }
        self.line(format_args!("  <link{head}/>"));
    }
}

/// ` name="value"`, with what XML wants escaped.
fn attribute(name: &str, value: &str) -> String {
    let mut text = format!(" {name}=\"");
    for c in value.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '"' => text.push_str("&quot;"),
            '\n' | '\t' | '\r' => text.push_str(&format!("&#{};", u32::from(c))),
            c => text.push(c),
        }
    }
    text.push('"');
    text
}
