//! Writes PML.

use super::super::writer::{Value, Writer};
use super::{Atom, Attributes, Cell, Colour, Component, PhysicalModel, References, StructuralComponent};
use std::io::{self, Write};

type Own<'a> = (&'a str, Option<Value<'a>>);

impl PhysicalModel {
    /// Writes the model. Numbers have as many digits as it takes to read the same numbers back; how many things there are
    /// is counted.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut writer = Writer::new(out)?;
        let cells = self.structural_components().iter().map(|component| component.cells.len()).sum();
        let informative = self.informative.as_ref().map(|components| number(count(components)).1);
        let own = [
            text("name", &self.name),
            ("nrOfAtoms", number(self.all_atoms().count()).1),
            ("nrOfExclusiveComponents", number(count(&self.exclusive)).1),
            ("nrOfInformativeComponents", informative.flatten()),
            ("nrOfCells", number(cells).1),
        ];
        writer.begin("physicalModel", &own, &self.properties)?;
        let none = Attributes::default();
        writer.begin("atoms", &[], &none)?;
        self.atoms.iter().try_for_each(|list| structural(&mut writer, list))?;
        writer.foreign(&self.beside_atoms)?;
        writer.end()?;
        writer.begin("exclusiveComponents", &[], &none)?;
        self.exclusive.iter().try_for_each(|own| component(&mut writer, own))?;
        writer.end()?;
        if let Some(informative) = &self.informative {
            writer.begin("informativeComponents", &[], &none)?;
            informative.iter().try_for_each(|own| component(&mut writer, own))?;
            writer.end()?;
        }
        writer.foreign(&self.foreign)?;
        writer.end()
    }
}

/// How many components are in the one around them all.
fn count(components: &[Component]) -> usize {
    match components {
        [Component::Multi(multi)] => multi.components.len(),
        _ => components.len(),
    }
}

fn text<'a>(key: &'a str, value: &'a Option<Box<str>>) -> Own<'a> {
    (key, value.as_deref().map(Value::Text))
}

fn number(count: usize) -> Own<'static> {
    ("value", Some(Value::Whole(count as i64)))
}

fn component<W: Write>(writer: &mut Writer<W>, own: &Component) -> io::Result<()> {
    match own {
        Component::Multi(multi) => {
            writer.begin("multiComponent", &[text("name", &multi.name)], &multi.properties)?;
            multi.components.iter().try_for_each(|own| component(writer, own))?;
            writer.end()
        }
        Component::Structural(own) => structural(writer, own),
        Component::Foreign(foreign) => writer.foreign(std::slice::from_ref(foreign)),
    }
}

fn structural<W: Write>(writer: &mut Writer<W>, own: &StructuralComponent) -> io::Result<()> {
    let mode = own.mode.as_ref().map(|mode| Value::Text(mode.word()));
    writer.begin("structuralComponent", &[text("name", &own.name), ("mode", mode)], &own.properties)?;
    colour(writer, own.colour.as_ref())?;
    let structures = own.atoms.len() + own.cells.len() + own.references.atoms.len();
    writer.empty("nrOfStructures", &[number(structures)], &Attributes::default())?;
    own.atoms.iter().try_for_each(|own| atom(writer, own))?;
    own.cells.iter().try_for_each(|own| cell(writer, own))?;
    references(writer, &own.references)?;
    writer.foreign(&own.foreign)?;
    writer.end()
}

fn colour<W: Write>(writer: &mut Writer<W>, own: Option<&Colour>) -> io::Result<()> {
    let Some(Colour { rgba: [r, g, b, a] }) = own else { return Ok(()) };
    let part = |key, value: &f64| (key, Some(Value::Number(*value)));
    writer.empty("color", &[part("r", r), part("g", g), part("b", b), part("a", a)], &Attributes::default())
}

fn atom<W: Write>(writer: &mut Writer<W>, own: &Atom) -> io::Result<()> {
    let [x, y, z] = own.position.map(|value| Some(Value::Number(value)));
    let index = Some(Value::Whole(own.index.into()));
    let properties = [("index", index), ("x", x), ("y", y), ("z", z), text("name", &own.name)];
    writer.begin("atom", &[], &own.beyond.attributes())?;
    writer.empty("atomProperties", &properties, &own.properties)?;
    writer.foreign(own.beyond.foreign())?;
    writer.end()
}

fn cell<W: Write>(writer: &mut Writer<W>, own: &Cell) -> io::Result<()> {
    let (index, kind) = (own.index.map(Value::Whole), Some(Value::Text(own.kind.word())));
    writer.begin("cell", &[], &own.beyond.attributes())?;
    writer.empty("cellProperties", &[("index", index), ("type", kind), text("name", &own.name)], &own.properties)?;
    colour(writer, own.colour.as_deref())?;
    writer.empty("nrOfStructures", &[number(own.references.atoms.len())], &Attributes::default())?;
    references(writer, &own.references)?;
    writer.foreign(own.beyond.foreign())?;
    writer.end()
}

fn references<W: Write>(writer: &mut Writer<W>, own: &References) -> io::Result<()> {
    let none = Attributes::default();
    let mut kept = own.properties.iter().peekable();
    for (position, atom) in own.atoms.iter().enumerate() {
        let properties = kept.next_if(|(owner, _)| *owner as usize == position).map_or(&none, |(_, own)| own);
        writer.empty("atomRef", &[("index", Some(Value::Whole((*atom).into())))], properties)?;
    }
    Ok(())
}
