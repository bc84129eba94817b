//! Writes MML, in the order of the schema.

use super::super::cursor::INSTANCE;
use super::super::writer::{Value, Writer};
use super::{
    Attributes, Criterion, Method, MethodKind, Monitor, Monitoring, MonitoringIn, MonitoringOut, SingleCriterion,
    TimeParameter,
};
use std::io::{self, Write};

impl Monitoring {
    /// Writes the document. Numbers have as many digits as it takes to read the same numbers back.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut writer = Writer::new(out)?;
        match self {
            Self::In(own) => monitoring_in(&mut writer, own),
            Self::Out(own) => monitoring_out(&mut writer, own),
        }
    }
}

fn root<W: Write>(writer: &mut Writer<W>, name: &'static str, properties: &Attributes) -> io::Result<()> {
    let own = properties.get("xmlns:xsi").is_none().then_some(Value::Text(INSTANCE));
    writer.begin(name, &[("xmlns:xsi", own)], properties)
}

fn monitoring_in<W: Write>(writer: &mut Writer<W>, own: &MonitoringIn) -> io::Result<()> {
    root(writer, "monitoringIn", &own.properties)?;
    time(writer, "dt", own.dt.as_ref())?;
    time(writer, "refresh", own.refresh.as_ref())?;
    let texts = [
        ("pmlFile", &own.pml_file),
        ("simulatorFile", &own.simulator_file),
        ("lmlFile", &own.lml_file),
        ("simulator", &own.simulator),
    ];
    texts.into_iter().try_for_each(|(name, text)| optional_text(writer, name, text.as_deref()))?;
    stop(writer, own.stop.as_ref())?;
    if !(own.monitors.is_empty() && own.beside_monitors.is_empty()) {
        writer.begin("monitors", &[], &Attributes::default())?;
        own.monitors.iter().try_for_each(|own| monitor(writer, own))?;
        writer.foreign(&own.beside_monitors)?;
        writer.end()?;
    }
    writer.foreign(&own.foreign)?;
    writer.end()
}

fn monitoring_out<W: Write>(writer: &mut Writer<W>, own: &MonitoringOut) -> io::Result<()> {
    root(writer, "monitoringOut", &own.properties)?;
    optional_text(writer, "pmlFile", own.pml_file.as_deref())?;
    for step in &own.times {
        let (value, unit) = (Value::Number(step.time.value), Value::Text(&step.time.unit));
        writer.begin("time", &[("value", Some(value)), ("unit", Some(unit))], &step.time.properties)?;
        stop(writer, step.stop.as_ref())?;
        step.monitors.iter().try_for_each(|own| monitor(writer, own))?;
        writer.foreign(&step.foreign)?;
        writer.end()?;
    }
    writer.foreign(&own.foreign)?;
    writer.end()
}

fn optional_text<W: Write>(writer: &mut Writer<W>, name: &str, text: Option<&str>) -> io::Result<()> {
    text.map_or(Ok(()), |text| writer.text(name, text))
}

fn time<W: Write>(writer: &mut Writer<W>, name: &str, own: Option<&TimeParameter>) -> io::Result<()> {
    let Some(own) = own else { return Ok(()) };
    let (value, unit) = (Some(Value::Number(own.value)), Some(Value::Text(&own.unit)));
    writer.empty(name, &[("value", value), ("unit", unit)], &own.properties)
}

fn stop<W: Write>(writer: &mut Writer<W>, own: Option<&Criterion>) -> io::Result<()> {
    let Some(own) = own else { return Ok(()) };
    writer.begin("stoppingCriteria", &[], &Attributes::default())?;
    criterion(writer, own)?;
    writer.end()
}

fn criterion<W: Write>(writer: &mut Writer<W>, own: &Criterion) -> io::Result<()> {
    match own {
        Criterion::Single(own) => single(writer, own),
        Criterion::Multiple { operator, list, properties, foreign } => {
            writer.begin("multipleCriteria", &[("op", Some(Value::Text(operator.word())))], properties)?;
            list.iter().try_for_each(|own| criterion(writer, own))?;
            writer.foreign(foreign)?;
            writer.end()
        }
    }
}

fn single<W: Write>(writer: &mut Writer<W>, own: &SingleCriterion) -> io::Result<()> {
    let attributes = [
        ("xsi:type", Some(Value::Text(own.kind.word()))),
        ("unit", own.unit.as_deref().map(Value::Text)),
        ("target", own.target.as_deref().map(Value::Text)),
    ];
    writer.begin("criteria", &attributes, &own.properties)?;
    method(writer, &own.method)?;
    optional_text(writer, "data", own.data.as_deref())?;
    writer.foreign(&own.foreign)?;
    writer.end()
}

fn method<W: Write>(writer: &mut Writer<W>, own: &Method) -> io::Result<()> {
    let (word, max, min, iterations) = match own.kind {
        MethodKind::Threshold { max } => ("Threshold", Some(max), None, None),
        MethodKind::MinThreshold { min } => ("MinThreshold", None, Some(min), None),
        MethodKind::TimePeriodThreshold { min, iterations } => {
            ("TimePeriodThreshold", None, Some(min), Some(iterations))
        }
    };
    let attributes = [
        ("xsi:type", Some(Value::Text(word))),
        ("maxValue", max.map(Value::Number)),
        ("minValue", min.map(Value::Number)),
        ("iterations", iterations.map(|count| Value::Whole(count.into()))),
        ("scope", own.scope.map(|scope| Value::Text(scope.word()))),
    ];
    writer.empty("method", &attributes, &own.properties)
}

fn monitor<W: Write>(writer: &mut Writer<W>, own: &Monitor) -> io::Result<()> {
    let [dx, dy, dz] = own.offset.map(|shift| shift.map(Value::Number));
    let attributes = [
        ("type", Some(Value::Text(&own.kind))),
        ("index", Some(Value::Whole(own.index.into()))),
        ("target", Some(Value::Text(&own.target))),
        ("dx", dx),
        ("dy", dy),
        ("dz", dz),
    ];
    writer.begin("monitor", &attributes, &own.properties)?;
    time(writer, "startAt", own.start.as_ref())?;
    time(writer, "stopAt", own.stop.as_ref())?;
    for reference in &own.references {
        let attributes = [
            ("document", Some(Value::Text(&reference.document))),
            ("monitorIndex", reference.monitor_index.map(|index| Value::Whole(index.into()))),
            ("target", reference.target.as_deref().map(Value::Text)),
        ];
        writer.empty("reference", &attributes, &reference.properties)?;
    }
    optional_text(writer, "indexes", own.indexes.as_deref())?;
    optional_text(writer, "data", own.data.as_deref())?;
    writer.foreign(&own.foreign)?;
    writer.end()
}
