//! Checks that need more than one key: what requires, excludes or names what.

use super::check::Reference;
use super::document::{Document, near_file};
use super::{CellType, Course, Linked, MeasureKind, Placement, Reduction, Selection, VolumeRule, When, words};
use crate::error::Fault;
use crate::units::{Dimension, pretty};
use std::path::Path;

/// Series of every cell that the result holds, besides those of the scene (`load.NAME`, `time`).
#[rustfmt::skip] // a table
const CELL_SERIES: [&str; 18] = [
    "position_x", "position_y", "position_z", "velocity_x", "velocity_y", "velocity_z", "speed", "volume",
    "volume_error", "area", "energy", "size_x", "size_y", "size_z", "principal_1", "principal_2", "principal_3",
    "smallest_facet",
];

struct Check<'a> {
    document: &'a Document,
    faults: Vec<Fault>,
}

/// Finds the faults that the keys of a well-formed document have together.
pub(super) fn check(document: &Document, references: &[Reference]) -> Vec<Fault> {
    let mut check = Check { document, faults: Vec::new() };
    for reference in references {
        check.reference(reference);
    }
    for (name, cell) in &document.experiment.cells {
        let path = format!("cells.{name}");
        check.drag_and_mass(&path, cell);
        check.places(&path, cell);
        check.volume(&path, cell);
        check.links(&path, cell);
        check.loads(&path, cell);
        if let Some(turn) = &cell.orientation {
            check.direction(&format!("{path}.orientation.axis"), turn.axis);
        }
    }
    check.scene();
    check.measures();
    check.faults
}

impl Check<'_> {
    /// A fault at the value of a key.
    fn fault(&mut self, path: &str, label: &str, message: String, help: impl Into<String>) {
        let mut fault = Fault::new(message).help(help);
        fault.place = self.document.place(path, label);
        self.faults.push(fault);
    }

    fn reference(&mut self, Reference { kind, path, text }: &Reference) {
        match kind.as_str() {
            "file" => self.file(path, text),
            "cell type" => self.cell_type(path, text),
            "series" => self.series(path, text),
            _ => {}
        }
    }

    fn file(&mut self, path: &str, text: &str) {
        let file = self.document.resolve(Path::new(text));
        if file.is_file() {
            return;
        }
        let (message, help) = match (file.is_dir(), near_file(&file)) {
            (true, _) => (format!("`{path}`: {text} is a folder"), "name a file in it".to_owned()),
            (false, Some(near)) => {
                let near = Path::new(text).with_file_name(near.file_name().unwrap_or_default());
                (format!("`{path}`: there is no file {text}"), format!("did you mean {}?", near.display()))
            }
            (false, None) => {
                let help = "paths start from the folder of the document".to_owned();
                (format!("`{path}`: there is no file {text}"), help)
            }
        };
        self.fault(path, "not found", message, help);
    }

    fn cell_type(&mut self, path: &str, text: &str) {
        let known = &self.document.experiment.cells;
        if known.contains_key(text) {
            return;
        }
        let meant = words::meant(text, known.keys().map(String::as_str));
        let label = meant.map_or("unknown type".to_owned(), |meant| format!("did you mean \"{meant}\"?"));
        let help = format!("types of cells here are {}", words::all_of(known.keys().map(String::as_str)));
        self.fault(path, &label, format!("`{path}`: there is no type of cells \"{text}\""), help);
    }

    fn series(&mut self, path: &str, text: &str) {
        let cells = self.document.experiment.cells.values();
        let loads: Vec<String> = cells.flat_map(|cell| &cell.loads).map(|load| format!("load.{}", load.name)).collect();
        let known = || CELL_SERIES.into_iter().chain(["time"]).chain(loads.iter().map(String::as_str));
        if known().any(|name| name == text) {
            return;
        }
        let label = words::meant(text, known()).map(|meant| format!("did you mean \"{meant}\"?"));
        let mut list: Vec<&str> = loads.iter().map(String::as_str).chain(["time"]).collect();
        list.extend(["volume", "area", "energy", "speed", "position_x", "velocity_x", "size_x", "principal_1"]);
        let help = format!("series are {} and the like", words::all_of(list));
        let message = format!("`{path}`: there is no series \"{text}\"");
        self.fault(path, label.as_deref().unwrap_or("unknown series"), message, help);
    }

    fn drag_and_mass(&mut self, path: &str, cell: &CellType) {
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

    fn places(&mut self, path: &str, cell: &CellType) {
        let number = cell.count();
        let placement = format!("{path}.placement");
        match &cell.placement {
            Some(Placement::At { at }) if at.len() != number || at.is_empty() => {
                let message = format!("`{placement}.at` has {} places for {number} cells", at.len());
                self.fault(
                    &format!("{placement}.at"),
                    "places",
                    message,
                    "give one place for each cell, or leave `number` out",
                );
            }
            Some(Placement::Grid { grid, .. }) => {
                let places = grid.iter().map(|n| *n as usize).fold(1, usize::saturating_mul);
                if places < number {
                    let message = format!("`{placement}.grid` has {places} places for {number} cells");
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

    fn volume(&mut self, path: &str, cell: &CellType) {
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
    fn course(&mut self, path: &str, points: &[(f64, f64)]) {
        if points.is_empty() {
            self.fault(path, "no points", format!("`{path}` has no points"), "give points [time, value], or one value");
        }
        if let Some(index) = points.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
            let at = format!("{path}[{}][0]", index + 1);
            let message = format!("`{at}` is not later than the time before it");
            self.fault(&at, "times must increase", message, "order the points by time");
        }
    }

    fn loads(&mut self, path: &str, cell: &CellType) {
        for (index, fixed) in cell.fixed.iter().enumerate() {
            self.selection(&format!("{path}.fixed[{index}]"), &fixed.selection);
        }
        for (index, load) in cell.loads.iter().enumerate() {
            let path = format!("{path}.loads[{index}]");
            self.selection(&path, &load.selection);
            self.direction(&format!("{path}.direction"), load.direction);
            self.course(&format!("{path}.force"), &load.force.points());
            if let Some(other) = cell.loads[..index].iter().position(|other| other.name == load.name) {
                let message = format!("`{path}.name` is the name of load {other} too");
                self.fault(&format!("{path}.name"), "taken", message, "names of loads differ within a type of cells");
            }
        }
    }

    fn selection(&mut self, path: &str, selection: &Selection) {
        match selection {
            Selection::Cap(cap) => self.direction(&format!("{path}.cap.direction"), cap.direction),
            Selection::Atoms(atoms) => {
                let twice = (1..atoms.len()).find(|index| atoms[..*index].contains(&atoms[*index]));
                if let Some(index) = twice {
                    let message = format!("`{path}.atoms` names atom {} twice", atoms[index]);
                    self.fault(&format!("{path}.atoms[{index}]"), "named before", message, "name every atom once");
                }
            }
            Selection::All(_) => {}
        }
    }

    fn direction(&mut self, path: &str, direction: [f64; 3]) {
        if direction.iter().all(|component| *component == 0.0) {
            let message = format!("`{path}` has no length and so no direction");
            self.fault(path, "is zero", message, "give at least one component, such as [1, 0, 0]");
        }
    }

    fn links(&mut self, path: &str, cell: &CellType) {
        for (index, link) in cell.links.iter().enumerate() {
            let path = format!("{path}.links[{index}]");
            if let Linked::Pairs(pairs) = &link.linked
                && let Some(pair) = pairs.iter().position(|[a, b]| a == b)
            {
                let at = format!("{path}.pairs[{pair}]");
                let message = format!("`{at}` links atom {} with itself", pairs[pair][0]);
                self.fault(&at, "the same atom", message, "name two different atoms");
            }
            if link.rest_length.is_some() && link.rest_ratio.is_some() {
                let message = format!("`{path}` has both `rest_length` and `rest_ratio`");
                self.fault(
                    &format!("{path}.rest_ratio"),
                    "only one of them may be given",
                    message,
                    "remove one of them",
                );
            }
        }
    }

    fn scene(&mut self) {
        let experiment = &self.document.experiment;
        for (index, plane) in experiment.planes.iter().enumerate() {
            self.direction(&format!("planes[{index}].normal"), plane.normal);
            if experiment.planes[..index].iter().any(|other| other.name == plane.name) {
                let message = format!("`planes[{index}].name` is the name of another plane too");
                self.fault(&format!("planes[{index}].name"), "taken", message, "give every plane its own name");
            }
        }
        for (index, plot) in experiment.plot.iter().enumerate() {
            if experiment.plot[..index].iter().any(|other| other.name == plot.name) {
                let message = format!("`plot[{index}].name` is the name of another plot too");
                let help = "give every plot its own name: it names its files";
                self.fault(&format!("plot[{index}].name"), "taken", message, help);
            }
        }
        let view = &experiment.picture.view;
        let (from, up) = (crate::Vec3::from(view.from), crate::Vec3::from(view.up));
        self.direction("picture.view.from", view.from);
        self.direction("picture.view.up", view.up);
        let parallel = from.norm() > 0.0 && up.norm() > 0.0 && from.cross(&up).norm() <= 1e-9 * from.norm() * up.norm();
        if parallel {
            let message = "`picture.view.up` is the direction of sight".to_owned();
            self.fault(
                "picture.view.up",
                "parallel to `from`",
                message,
                "choose another direction as up, such as [0, 1, 0]",
            );
        }
        if let When::At(time) = experiment.picture.time {
            self.instant("picture.time", time.value());
        }
    }

    /// An instant must lie within the run.
    fn instant(&mut self, path: &str, time: f64) {
        let until = self.document.experiment.run.until.value();
        if !(0.0..=until).contains(&time) {
            let (time, until) = (pretty(time, Dimension::TIME), pretty(until, Dimension::TIME));
            let message = format!("`{path}` is {time}, which the run does not reach");
            self.fault(path, "outside of the run", message, format!("give a time from 0 s to {until} (run.until)"));
        }
    }

    fn measures(&mut self) {
        for (name, measure) in &self.document.experiment.measure {
            let path = format!("measure.{name}");
            match &measure.kind {
                MeasureKind::Value { time: Reduction::At(time), .. } => {
                    self.instant(&format!("{path}.time"), time.value());
                }
                MeasureKind::Slope { x_from: Some(from), x_to: Some(to), .. }
                | MeasureKind::RSquared { x_from: Some(from), x_to: Some(to), .. }
                    if from >= to =>
                {
                    let message = format!("`{path}.x_to` is not above `x_from`");
                    self.fault(&format!("{path}.x_to"), "too small", message, "exchange the two");
                }
                MeasureKind::TableBars(table) if table.low_column.is_none() || table.high_column.is_none() => {
                    let message = format!("`{path}` lacks the columns of the bars");
                    self.fault(&path, "columns are missing here", message, "add `low_column` and `high_column`");
                }
                MeasureKind::MsdDeviation { lag_from, lag_to, .. } => {
                    if lag_from >= lag_to {
                        let message = format!("`{path}.lag_to` is not above `lag_from`");
                        self.fault(&format!("{path}.lag_to"), "too small", message, "exchange the two");
                    }
                    self.instant(&format!("{path}.lag_to"), lag_to.value());
                }
                _ => {}
            }
        }
    }
}

fn is_course<T>(course: &Course<T>) -> bool {
    matches!(course, Course::Points(_))
}
