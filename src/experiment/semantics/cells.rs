//! What must hold within a type of cells.

use super::Check;
use crate::experiment::{CellType, ContactModel, Course, Linked, Method, Placement, Selection, VolumeRule};
use std::collections::HashSet;

impl Check<'_> {
    pub(super) fn drag_and_mass(&mut self, path: &str, cell: &CellType) {
        let experiment = &self.document.experiment;
        let method = experiment.run.integrator.method;
        let mechanics = format!("{path}.mechanics");
        if cell.mechanics.drag.is_none() && !method.is_inertial() {
            let help = "add `drag = \"20 pN s/um\"`, or choose a method with mass in [run.integrator]";
            let message = format!("`{mechanics}` lacks `drag`, which motion without inertia needs");
            self.fault(&mechanics, "`drag` is missing here", message, help);
        }
        let falls = experiment.environment.gravity.is_some_and(|gravity| gravity.iter().any(|g| g.value() != 0.0));
        if cell.mechanics.mass.is_none() && (method.is_inertial() || falls) {
            let reason = if method.is_inertial() { "the inertial method" } else { "gravity" };
            let message = format!("`{mechanics}` lacks `mass`, which {reason} needs");
            self.fault(
                &mechanics,
                "`mass` is missing here",
                message,
                "add `mass = \"1 mg\"`: the mass of the whole cell",
            );
        }
    }

    /// Only the implicit scheme moves atoms on courses.
    pub(super) fn moved_by_scheme(&mut self, path: &str, cell: &CellType) {
        let method = self.document.experiment.run.integrator.method;
        if !cell.applied.moved.is_empty() && method != Method::Implicit {
            let message = format!("`{path}.moved` needs the implicit scheme");
            let help = "remove run.integrator.method; in other schemes atoms can be fixed, and pulled by loads";
            self.fault("run.integrator.method", "moves no atoms on courses", message, help);
        }
    }

    /// Only the matrix of the implicit step knows what is viscous, and only contacts that move cells by it.
    pub(super) fn viscosity(&mut self, path: &str, cell: &CellType) {
        if !cell.mechanics.is_viscous() {
            return;
        }
        let (experiment, key) = (&self.document.experiment, format!("{path}.mechanics.viscosity"));
        let inside = cell.mechanics.viscosity.map_or(0.0, |viscosity| viscosity.inside.value());
        if inside > 0.0 && !cell.mesh.is_filled() {
            let message = format!("`{key}.inside` is of what fills a body, and the mesh is a surface");
            let help = "take shape = \"block\" or \"rod\", or a PML file with `filled = true`; or give the surface `shear` and `area`";
            self.fault(&format!("{key}.inside"), "nothing to fill", message, help);
        }
        if experiment.run.integrator.method != Method::Implicit {
            let message = format!("`{key}` needs the implicit scheme");
            self.fault("run.integrator.method", "knows no viscosity", message, "remove run.integrator.method");
        }
        self.not_by_drag_alone(&key, "knows no viscosity");
    }

    /// What has a stiffness of its own cannot be moved by contacts that know the drag of its atoms alone.
    pub(super) fn not_by_drag_alone(&mut self, key: &str, label: &str) {
        let model = self.document.experiment.contact.as_ref().map(|contact| contact.model);
        if let Some(ContactModel::VirtualAdhesives | ContactModel::Penalty) = model {
            let message = format!("`{key}`: this model of contacts moves atoms by their drag alone");
            let help = "use another model of contacts, such as model = \"cohesion\"";
            self.fault("contact.model", label, message, help);
        }
    }

    /// What must hold of bodies that are filled, and of what fills them.
    pub(super) fn filling(&mut self, path: &str, cell: &CellType) {
        let (mechanics, key) = (&cell.mechanics, format!("{path}.mechanics.solid"));
        let holds = mechanics.solid.is_some() || mechanics.springs.is_some() || mechanics.shape_memory.is_some();
        if cell.mesh.is_filled() && !holds && mechanics.rigid.is_none() {
            let message = format!("nothing holds the atoms inside `{path}`");
            let help = "give its mechanics a `solid`, `springs` or `shape_memory`, or make it `rigid`";
            self.fault(&format!("{path}.mesh"), "has atoms inside", message, help);
        }
        let Some(solid) = &mechanics.solid else { return };
        self.not_by_drag_alone(&key, "knows no filled bodies");
        if solid.poisson.is_none() && solid.volume_over.is_some() {
            let message = format!("`{key}.volume_over` has no meaning where the material has no Poisson's ratio");
            let help = "add `poisson`, below 0.5, or remove it: then the volume of the whole is kept exactly";
            self.fault(&format!("{key}.volume_over"), "not used", message, help);
        }
        if solid.poisson.is_none() && mechanics.volume.rule == Some(VolumeRule::Free) {
            let message = format!("nothing resists changes of the volume of `{path}`");
            let help = "add `poisson` to the solid, or remove the rule: then the volume of the whole is kept exactly";
            self.fault(&format!("{path}.mechanics.volume.rule"), "nor does the material", message, help);
        }
    }

    pub(super) fn placements(&mut self, path: &str, cell: &CellType) {
        let placement = format!("{path}.placement");
        if cell.count() > 0 || cell.added.is_empty() {
            self.placement(&placement, cell.count(), cell.placement.as_ref());
        }
        for (index, added) in cell.added.iter().enumerate() {
            let path = format!("{path}.added[{index}]");
            self.within_run(&path, added.time.value());
            self.placement(&format!("{path}.placement"), added.count(), Some(&added.placement));
        }
        for (index, removed) in cell.removed.iter().enumerate() {
            let path = format!("{path}.removed[{index}]");
            self.within_run(&path, removed.time.value());
            if removed.share.is_some() && removed.number.is_some() {
                let message = format!("`{path}` has both `share` and `number`");
                self.fault(&format!("{path}.number"), "only one of them may be given", message, "remove one of them");
            }
        }
        if cell.number == Some(0) && cell.added.is_empty() {
            let (number, message) = (format!("{path}.number"), format!("`{path}` has no cells"));
            let help = "give a number above 0, or cells that come later: added = [{ time = \"10 s\", … }]";
            self.fault(&number, "none, and none comes", message, help);
        }
    }

    /// What happens to the cells must happen before the run ends.
    fn within_run(&mut self, path: &str, time: f64) {
        let until = self.document.experiment.run.until;
        if time > until.value() {
            let (time, message) =
                (format!("{path}.time"), format!("`{path}.time` is behind the end of the run, {until}"));
            self.fault(&time, "never comes", message, "let it be earlier, or the run longer");
        }
    }

    fn placement(&mut self, placement: &str, number: usize, given: Option<&Placement>) {
        match given {
            Some(Placement::At { at }) if at.len() != number || at.is_empty() => {
                let points = if at.len() == 1 { "1 position".to_owned() } else { format!("{} positions", at.len()) };
                let message = format!("`{placement}.at` has {points} for {number} cells");
                self.fault(
                    &format!("{placement}.at"),
                    "not one for each cell",
                    message,
                    "give one position for each cell, or leave `number` out",
                );
            }
            Some(Placement::Grid { grid, .. }) => {
                let points = grid.iter().map(|n| *n as usize).fold(1, usize::saturating_mul);
                if points < number {
                    let message = format!("`{placement}.grid` has {points} positions for {number} cells");
                    self.fault(
                        &format!("{placement}.grid"),
                        "too small",
                        message,
                        "make the grid larger, or `number` smaller",
                    );
                }
            }
            Some(Placement::Random { random_from, random_to }) => {
                let crossed = (0..3).find(|axis| random_from[*axis] > random_to[*axis]);
                if let Some(axis) = crossed {
                    let axis = ["x", "y", "z"][axis];
                    let message = format!("`{placement}.random_to` lies below `random_from` along {axis}");
                    self.fault(&format!("{placement}.random_to"), "too small", message, "exchange the two corners");
                }
            }
            _ => {}
        }
    }

    pub(super) fn volume(&mut self, path: &str, cell: &CellType) {
        let (control, path) = (&cell.mechanics.volume, format!("{path}.mechanics.volume"));
        let compressible = control.rule == Some(VolumeRule::Compressible);
        if compressible && control.modulus.is_none() {
            let message = format!("`{path}` lacks `modulus`, which the compressible rule needs");
            self.fault(&path, "`modulus` is missing here", message, "add `modulus = \"1 kPa\"`");
        }
        if !compressible && control.modulus.is_some() {
            let message = format!("`{path}.modulus` has no meaning unless the rule is compressible");
            self.fault(
                &format!("{path}.modulus"),
                "not used",
                message,
                "add `rule = \"compressible\"`, or remove the modulus",
            );
        }
        if control.target.is_some() && control.ratio.is_some() {
            let message = format!("`{path}` has both `target` and `ratio`");
            self.fault(&format!("{path}.ratio"), "only one of them may be given", message, "remove one of them");
        }
        let driven = control.target.is_some() || control.ratio.is_some();
        let free = control.rule == Some(VolumeRule::Free) || cell.mesh.is_open();
        if driven && free {
            let key = if control.target.is_some() { "target" } else { "ratio" };
            let message = format!("`{path}.{key}` has no meaning for a volume that nothing keeps");
            let help = "remove it, or give a closed mesh and the rule exact or compressible";
            self.fault(&format!("{path}.{key}"), "not used", message, help);
        }
        if cell.mesh.is_open() && control.rule.is_some_and(|rule| rule != VolumeRule::Free) {
            let message = format!("`{path}.rule` needs a closed mesh; a sheet or a triangle encloses no volume");
            self.fault(&format!("{path}.rule"), "no volume to keep", message, "remove the rule, or write \"free\"");
        }
        let points = control.target.as_ref().map(|course| ("target", course.points(), is_course(course)));
        let points = points.or(control.ratio.as_ref().map(|course| ("ratio", course.points(), is_course(course))));
        if let Some((key, points, several)) = points {
            let path = format!("{path}.{key}");
            self.course(&path, &points);
            if let Some(index) = points.iter().position(|(_, volume)| *volume <= 0.0) {
                let at = if several { format!("{path}[{index}][1]") } else { path.clone() };
                self.fault(&at, "must be more than 0", format!("`{at}` is not a volume"), "give a volume above 0");
            }
        }
    }

    /// Times of a course must increase.
    pub(in crate::experiment) fn course(&mut self, path: &str, points: &[(f64, f64)]) {
        if points.is_empty() {
            self.fault(path, "no points", format!("`{path}` has no points"), "give points [time, value], or one value");
        }
        if let Some(index) = points.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
            let at = format!("{path}[{}][0]", index + 1);
            let message = format!("`{at}` is not later than the time before it");
            self.fault(&at, "times must increase", message, "order the points by time");
        }
    }

    pub(super) fn remembering_atoms(&mut self, path: &str, cell: &CellType) {
        if let Some(only) = cell.mechanics.shape_memory.as_ref().and_then(|memory| memory.only.as_ref()) {
            self.selection(&format!("{path}.mechanics.shape_memory.only"), only);
        }
    }

    pub(in crate::experiment) fn selection(&mut self, path: &str, selection: &Selection) {
        match selection {
            Selection::Cap(cap) => self.direction(&format!("{path}.cap.direction"), cap.direction),
            Selection::Atoms(atoms) => {
                let mut named = HashSet::with_capacity(atoms.len());
                if let Some(index) = atoms.iter().position(|atom| !named.insert(*atom)) {
                    let message = format!("`{path}.atoms` names atom {} twice", atoms[index]);
                    self.fault(&format!("{path}.atoms[{index}]"), "named before", message, "name every atom once");
                }
            }
            Selection::All(_) => {}
        }
    }

    pub(in crate::experiment) fn pairs(&mut self, path: &str, linked: &Linked) {
        if let Linked::Pairs(pairs) = linked
            && let Some(pair) = pairs.iter().position(|[a, b]| a == b)
        {
            let at = format!("{path}.pairs[{pair}]");
            let message = format!("`{at}` links atom {} with itself", pairs[pair][0]);
            self.fault(&at, "the same atom", message, "name two different atoms");
        }
    }
}

fn is_course<T>(course: &Course<T>) -> bool {
    matches!(course, Course::Points(_))
}
