//! Writes LML, in the order of the schema.

use super::super::cursor::INSTANCE;
use super::super::writer::{Value, Writer};
use super::{Component, Load, Loads, NAMESPACE};
use std::io::{self, Write};

impl Loads {
    /// Writes the loads. Numbers have as many digits as it takes to read the same numbers back.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut writer = Writer::new(out)?;
        // Unless the document declares others.
        let own = [("xmlns", NAMESPACE), ("xmlns:xsi", INSTANCE)];
        let own = own.map(|(key, name)| (key, self.properties.get(key).is_none().then_some(Value::Text(name))));
        writer.begin("loads", &own, &self.properties)?;
        self.loads.iter().try_for_each(|own| load(&mut writer, own))?;
        writer.foreign(&self.foreign)?;
        writer.end()
    }
}

fn load<W: Write>(writer: &mut Writer<W>, own: &Load) -> io::Result<()> {
    writer.begin("load", &[("xsi:type", Some(Value::Text(own.kind.word())))], &own.properties)?;
    let targets: Vec<String> = own.applied_to.iter().map(ToString::to_string).collect();
    writer.text("appliedTo", &targets.join(","))?;
    if let Some(direction) = &own.direction {
        let [x, y, z] = direction.components.map(|component| match component {
            Component::Free => None,
            Component::Null => Some(Value::Text("NULL")),
            Component::Number(number) => Some(Value::Number(number)),
        });
        let toward = direction.toward.as_ref().map(ToString::to_string);
        let toward = toward.as_deref().map(Value::Text);
        writer.empty("direction", &[("x", x), ("y", y), ("z", z), ("toward", toward)], &direction.properties)?;
    }
    for event in &own.events {
        let [date, value] = [event.date, event.value].map(|number| Some(Value::Number(number)));
        writer.empty("valueEvent", &[("date", date), ("value", value)], &event.properties)?;
    }
    if let Some(unit) = &own.unit {
        writer.text("unit", unit)?;
    }
    writer.foreign(&own.foreign)?;
    writer.end()
}
