//! Events, which mean in SBML what they mean in EML.

use super::Writer;
use super::element::Element;
use crate::equations::tree::Event;

impl Writer<'_> {
    /// The events of the model.
    pub(super) fn events(&mut self) -> Vec<Element> {
        let events = self.document.system.events.iter().enumerate();
        events.map(|(index, event)| self.event(event, index)).collect()
    }

    fn event(&mut self, event: &Event, index: usize) -> Element {
        let id = Some(&self.names.events[index]).filter(|id| !id.is_empty());
        let trigger = Element::new("trigger")
            .with_flag("initialValue", event.true_before_start)
            .with_flag("persistent", event.persistent)
            .child(self.formulas.condition(&event.trigger));
        let mut element = Element::new("event")
            .with_some("id", id)
            .with_flag("useValuesFromTriggerTime", event.values_from_firing)
            .child(trigger);
        if let Some(priority) = &event.priority {
            element = element.child(Element::new("priority").child(self.formulas.number(priority, None)));
        }
        if let Some(delay) = &event.delay {
            let unit = self.units.reference(&self.document.time_unit);
            element = element.child(Element::new("delay").child(self.formulas.number(delay, unit.as_deref())));
        }
        let assignments = event.assignments.iter().map(|(target, value)| {
            let unit = self.units.reference(&self.document.system.quantities[*target as usize].unit);
            Element::new("eventAssignment")
                .with("variable", &self.names.quantities[*target as usize])
                .child(self.formulas.number(value, unit.as_deref()))
        });
        let assignments = assignments.collect();
        element.list("listOfEventAssignments", assignments)
    }
}
