//! What must hold of pseudopods beside other keys: a surface to push, contacts that grip, steps that no cycle fits into.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Check;
use crate::experiment::contact::ContactModel;
use crate::experiment::{CellType, Pseudopods};

impl Check<'_> {
    pub(super) fn pseudopods(&mut self, path: &str, cell: &CellType) {
        let Some(pods) = &cell.pseudopods else { return };
        let path = format!("{path}.pseudopods");
        if cell.mesh.is_open() {
            let message = format!("`{path}` needs a closed mesh; a sheet or a triangle has no inside that pushes out");
            self.fault(&path, "nothing to push from", message, "give a closed mesh, or remove the pseudopods");
        }
        self.angles_of_pseudopods(&path, pods);
        self.fibres_of_pseudopods(&path, cell, pods);
        self.several_pseudopods(&path, pods);
        self.steps_in_cycles(&path, pods);
        if pods.contact_inhibition.is_some() && self.document.experiment.contact.is_none() {
            let message = format!("`{path}.contact_inhibition` asks what cells touch, and there are no contacts");
            let help = "add a [contact] table, or remove it";
            self.fault(&format!("{path}.contact_inhibition"), "nothing is touched", message, help);
        }
    }

    /// Only some models of contact say what an atom bears along a surface.
    pub(super) fn grips(&mut self) {
        let experiment = &self.document.experiment;
        let Some((name, _)) = experiment.cells.iter().find(|(_, cell)| cell.pseudopods.is_some()) else { return };
        let (path, model) =
            (format!("cells.{name}.pseudopods"), experiment.contact.as_ref().map(|contact| contact.model));
        if let Some(ContactModel::Links | ContactModel::VirtualAdhesives | ContactModel::Penalty) = model {
            let message =
                format!("`{path}` needs contacts that say how much a cell grips, and `contact.model` has none");
            self.fault("contact.model", "not with pseudopods", message, "take the model \"cohesion\" or \"adhesives\"");
        }
    }

    /// Front and rear are drawn together in one way, by no more fibres than a cell may have.
    fn fibres_of_pseudopods(&mut self, path: &str, cell: &CellType, pods: &Pseudopods) {
        let Some(fibres) = &pods.fibres else { return };
        if pods.contraction.value() > 0.0 {
            let message = format!("`{path}` has both `contraction` and `fibres`");
            self.fault(&format!("{path}.fibres"), "excluded by `contraction`", message, "remove one of them");
        }
        if let Some(budget) = cell.fibre_budget.filter(|budget| *budget < pods.fibres_at_once()) {
            let key = format!("{}.fibre_budget", path.trim_end_matches(".pseudopods"));
            let (number, most) = (fibres.number, pods.most);
            let message = match most {
                1 => format!("`{key}` is {budget}, and a pseudopod makes {number} fibres"),
                _ => format!("`{key}` is {budget}, and {most} pseudopods make {number} fibres each"),
            };
            let help = "give a larger budget, leave it out, or let pseudopods make fewer fibres";
            self.fault(&key, "too small", message, help);
        }
    }

    /// Those beside begin at a rate, which one after the other have not.
    fn several_pseudopods(&mut self, path: &str, pods: &Pseudopods) {
        match (pods.most, pods.beside) {
            (2.., None) => {
                let message = format!("`{path}.most` is {}, and nothing says how often another begins", pods.most);
                let help = "add `beside`, the rate at which another begins while there is one: \"0.01 /s\", say";
                self.fault(&format!("{path}.most"), "needs `beside`", message, help);
            }
            (1, Some(_)) => {
                let message = format!("`{path}.beside` lets others begin, and there is one at a time");
                self.fault(&format!("{path}.beside"), "needs `most`", message, "add `most = 2`, or remove it");
            }
            _ => {}
        }
    }

    fn angles_of_pseudopods(&mut self, path: &str, pods: &Pseudopods) {
        for (key, angle, most, help) in [
            (
                "half_angle",
                pods.half_angle,
                FRAC_PI_2,
                "half the opening of the front is above 0 deg, up to 90 deg; 45 deg is usual",
            ),
            ("angle", pods.angle, PI, "an angle between two pseudopods is above 0 deg, up to 180 deg; 60 deg is usual"),
        ] {
            let path = format!("{path}.{key}");
            // Written in degrees, the largest may be larger by round-off.
            if !(angle.value() > 0.0 && angle.value() <= most * (1.0 + 1e-9)) {
                self.fault(&path, "out of range", format!("`{path}` is {:.4} deg", angle.value().to_degrees()), help);
            }
        }
        if pods.spread.value() < 0.0 {
            let path = format!("{path}.spread");
            self.fault(&path, "must not be below 0", format!("`{path}` is no deviation"), "give 0 deg or more");
        }
    }

    /// Of a step that holds several pseudopods no one would be seen.
    fn steps_in_cycles(&mut self, path: &str, pods: &Pseudopods) {
        let integrator = &self.document.experiment.run.integrator;
        let steps = [("step", integrator.step), ("max_step", integrator.max_step)];
        for (key, step) in steps.into_iter().filter_map(|(key, step)| Some((key, step?))) {
            if step.value() > pods.shortest_cycle() {
                let at = format!("run.integrator.{key}");
                let message =
                    format!("`{at}` is longer than the shortest cycle of `{path}`, {:.3} s", pods.shortest_cycle());
                let help = "let steps be shorter, or its times longer";
                self.fault(&at, "longer than a cycle", message, help);
            }
        }
    }
}
