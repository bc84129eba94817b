//! Events: what is set to what, when a condition comes true.

use super::build::{Builder, Use};
use super::vocabulary::with_article;
use super::xml::Element;
use crate::equations::expression::Unit;
use crate::equations::tree::{Event, Expr, QuantityId, Schedule};
use std::collections::HashSet;

impl Builder<'_, '_> {
    /// The events of the document.
    pub(super) fn events(&mut self, root: &Element) -> Vec<Event> {
        let elements = root.all("event").enumerate();
        elements.filter_map(|(index, element)| self.event(element, index)).collect()
    }

    fn event(&mut self, element: &Element, index: usize) -> Option<Event> {
        let time = self.known.time.clone();
        let schedule = self.schedule(element);
        let trigger = match &schedule {
            Some(schedule) => Some(schedule.trigger()),
            None => self.attribute(element, "when", Use::All, None),
        };
        let delay = self.attribute(element, "delay", Use::All, Some((&time, "the delay")));
        let priority = self.attribute(element, "priority", Use::All, Some((&Unit::plain(), "the priority")));
        // An event that holds at the start fires then, unless the document says that it has been true before.
        let fires_at_start = self.choice(element, "at_start", &["fire", "wait"]) == 0;
        let values_from_firing = self.choice(element, "values_from", &["firing", "execution"]) == 0;
        let persistent = self.choice(element, "persistent", &["true", "false"]) == 0;
        if element.all("set").next().is_none() {
            let help = "write <set id=\"…\">…</set> in the event";
            self.context.fault(element.at.clone(), "the event sets nothing", "without <set>", help);
        }
        let mut assignments: Vec<(QuantityId, Expr)> = Vec::new();
        let mut targets: HashSet<QuantityId> = HashSet::new();
        for set in element.all("set").filter(|set| set.attribute("id").is_some()) {
            let value = self.set(set);
            let target = value.as_ref().map(|(target, _)| *target);
            if target.is_some_and(|target| !targets.insert(target)) {
                let message = format!("the event sets `{}` twice", set.word("id"));
                self.context.fault(set.location("id"), &message, "a second time", "remove one of the two");
            }
            assignments.extend(value);
        }
        let id = if element.attribute("id").is_some() { element.word("id") } else { format!("event_{}", index + 1) };
        let true_before_start = !fires_at_start;
        let trigger = trigger?;
        Some(Event {
            id,
            trigger,
            true_before_start,
            delay,
            priority,
            values_from_firing,
            persistent,
            assignments,
            schedule,
        })
    }

    /// The schedule of an event that has one, and not a condition.
    fn schedule(&mut self, element: &Element) -> Option<Schedule> {
        let has = |name: &str| element.attribute(name).is_some();
        let fault = match (has("when"), has("every")) {
            (true, true) => Some(("every", "an event has a condition and a schedule", "remove `when` or `every`")),
            (false, false) => {
                Some(("id", "the event never fires", "write when=\"…\", or every=\"…\" for equal intervals"))
            }
            (true, false) if has("first") => {
                Some(("first", "an event with a condition has no first time", "remove it"))
            }
            (true, false) if has("until") => Some((
                "until",
                "an event with a condition has no last time",
                "write it into the condition: `and time le …`",
            )),
            (false, true) if has("persistent") => {
                Some(("persistent", "an event with a schedule has no condition that may turn false", "remove it"))
            }
            _ => None,
        };
        if let Some((attribute, message, help)) = fault {
            self.context.fault(element.location(attribute), message, "when?", help);
        }
        if !has("every") {
            return None;
        }
        let time = self.known.time.clone();
        let mut of = |name: &str| self.attribute(element, name, Use::Fixed, Some((&time, "a time of the schedule")));
        let (every, first, until) = (of("every"), of("first"), of("until"));
        let schedule = Schedule { first: first.unwrap_or(Expr::Number(0.0)), every: every?, until };
        self.schedules.push((schedule.every.clone(), element.location("every")));
        Some(schedule)
    }

    /// Tells schedules that do not go on.
    pub(super) fn check_schedules(&mut self, values: &[f64]) {
        for (every, at) in std::mem::take(&mut self.schedules) {
            let value = every.evaluate(0.0, &|quantity| values[quantity as usize]);
            if !(value > 0.0 && value.is_finite()) {
                let message = format!("`every` is {value}; a time above 0 was expected");
                self.context.fault(at, &message, "not above 0", "write the time from one to the next, such as 24");
            }
        }
    }

    fn set(&mut self, set: &Element) -> Option<(QuantityId, Expr)> {
        let id = set.word("id");
        let sort = self.known.sort(&id);
        let settable = matches!(sort, Some("variable" | "parameter" | "field"));
        if !settable {
            let (message, help) = match sort {
                Some(other) => (
                    format!("an event cannot set `{id}`, which is {}", with_article(other)),
                    format!("declare <variable id=\"{id}\" initial=\"…\" rate=\"0\"/>"),
                ),
                None => {
                    let near = self.context.meant(&id, self.known.ids());
                    let help =
                        near.map_or("declare it as a <variable>".to_owned(), |near| format!("did you mean `{near}`?"));
                    (format!("nothing has the identifier `{id}`"), help)
                }
            };
            self.context.fault(set.location("id"), &message, "set here", &help);
        }
        let unit = self.unit_of(&id);
        let what = format!("the new value of `{id}`");
        let value = self.expression(&set.text, Use::All, unit.as_ref().map(|unit| (unit, what.as_str())));
        let target = self.find(&id).filter(|_| settable);
        Some((target?, value?))
    }

    /// Which of some words an attribute holds; the first when it is absent.
    pub(super) fn choice(&mut self, element: &Element, attribute: &str, words: &[&str]) -> usize {
        let Some(text) = element.attribute(attribute) else { return 0 };
        let word = text.text.trim();
        if let Some(found) = words.iter().position(|known| *known == word) {
            return found;
        }
        let message = format!("`{attribute}` cannot be \"{word}\"");
        let help = match crate::error::words::meant(word, words.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => {
                format!("write {}", words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or "))
            }
        };
        self.context.fault(text.whole(), &message, "unknown word", &help);
        0
    }
}
