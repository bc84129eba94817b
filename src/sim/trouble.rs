//! When the numbers fail: what, where and when.

use crate::ode::Reason;

/// Why a step could not be made. The state is the one before the step.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// A position is not a finite number.
    NotFinite {
        /// Type of the cell.
        kind: String,
        /// Number of the cell within its type.
        cell: usize,
        /// Number of the atom within the cell.
        atom: usize,
        /// End of the step, s.
        time: f64,
    },
    /// A tetrahedron of a filled body has no volume left, and its material has no energy there.
    InsideOut {
        /// Type of the cell.
        kind: String,
        /// Number of the cell within its type.
        cell: usize,
        /// Atoms of the tetrahedron.
        atoms: [u32; 4],
        /// End of the step, s.
        time: f64,
    },
    /// A volume could not be restored.
    Volume {
        /// Type of the cell.
        kind: String,
        /// Number of the cell within its type.
        cell: usize,
        /// Relative error left.
        error: f64,
        /// End of the step, s.
        time: f64,
    },
    /// A system of equations could not be advanced.
    System {
        /// Name of the system in the document.
        system: String,
        /// Type of the cell that has it and number of the cell within its type; none for the scene.
        owner: Option<(String, usize)>,
        /// Time of its last good state, s.
        time: f64,
        /// The variable that is worst, where one can be named.
        variable: Option<String>,
        /// What is wrong.
        reason: Reason,
        /// More words, or none.
        detail: String,
    },
    /// A field could not be advanced.
    Field {
        /// What is wrong, in which field, where and when.
        message: String,
    },
    /// A link carried a number that its target cannot be.
    Link {
        /// The link in the document's words.
        link: String,
        /// Type of the cell and number of the cell within its type; none for a number of the scene.
        owner: Option<(String, usize)>,
        /// The number.
        value: f64,
        /// What it should have been.
        expected: &'static str,
        /// When, s.
        time: f64,
    },
    /// Contacts and volumes could not be held together.
    Contact {
        /// Type and number of the two cells that moved most.
        cells: [(String, usize); 2],
        /// End of the step, s.
        time: f64,
        /// What the last sweep still moved, µm.
        left: f64,
        /// Sweeps made.
        sweeps: u32,
    },
    /// Two cells are deeper inside each other than contacts can mend.
    Pressed {
        /// Type and number of the two cells.
        cells: [(String, usize); 2],
        /// Start of the step, s.
        time: f64,
        /// How deep at least, µm.
        depth: f64,
    },
    /// A tool has come through a facet of a cell, between its edges.
    Pierced {
        /// Name of the tool.
        tool: String,
        /// Type of the cell, and its number within it.
        cell: (String, usize),
        /// End of the step, s.
        time: f64,
    },
    /// An atom moved farther in a fixed step than contacts allow.
    TooFast {
        /// End of the step, s.
        time: f64,
        /// How far over what is allowed.
        share: f64,
    },
    /// No step was small enough for the tolerance.
    StepTooSmall {
        /// Start of the step, s.
        time: f64,
        /// The smallest step tried, s.
        dt: f64,
    },
}

impl Trouble {
    /// What to do about it, where nothing is known but the trouble; [`help_at`](super::contact::help_at) looks at the cells, too.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => {
                "a step that is too large or a force that grows without bound does this: shorten run.integrator.step, \
                 or leave it out so that a stable step is chosen"
            }
            Self::InsideOut { .. } => {
                "the body is pressed further than its mesh can follow: load it less, mesh it finer there, take another law \
                 (corotational bodies come back from inside out), or shorten run.integrator.step if you set one"
            }
            Self::Volume { .. } => {
                "the free atoms of the cell cannot hold its volume: fix fewer atoms, load it more slowly, shorten \
                 run.integrator.step if you set one, or use volume = { rule = \"compressible\", … }"
            }
            Self::System { reason: Reason::EndlessEvents, .. } => {
                "let each event change what triggers it, so that its trigger no longer holds after it"
            }
            Self::System { .. } => {
                "check the signs and sizes of its rates with `pseudopod eml solve`, choose scheme = \"rosenbrock\" if it is \
                 stiff, or give it tighter tolerances"
            }
            Self::Field { .. } => {
                "check the signs and sizes of the reactions, or lower the tolerance of the fields and run.integrator.max_step"
            }
            Self::Link { .. } => {
                "bound the number in the link's transfer, such as transfer=\"max(value, 0)\", or mend the equations behind it"
            }
            Self::Contact { .. } | Self::Pressed { .. } => {
                "contacts could not keep these cells apart: look at their last state; weaker loads, stiffer cells or \
                 shorter steps (run.integrator: a smaller step where you set one, else max_step or tolerance) may help"
            }
            Self::Pierced { .. } => {
                "a cell lies on a tool by its atoms and edges: make its mesh finer than the tool is thin also where it is stretched, \
                 or load it less"
            }
            Self::TooFast { .. } => {
                "shorten run.integrator.step, or leave it out so that steps limit themselves; between cells, a larger \
                 contact.prediction lets them go farther in a step"
            }
            Self::StepTooSmall { .. } => {
                "the cell changes shape faster than any step can follow: look at its last state for folded or \
                 collapsed facets, lower the load, or raise run.integrator.tolerance"
            }
        }
    }
}

impl std::fmt::Display for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::NotFinite { kind, cell, atom, time } => {
                write!(
                    f,
                    "the position of atom {atom} of cell {cell} of type `{kind}` is not a number at t = {time:.6} s"
                )
            }
            Self::InsideOut { kind, cell, atoms, time } => write!(
                f,
                "the tetrahedron of atoms {atoms:?} of cell {cell} of type `{kind}` is turned inside out at t = {time:.6} s"
            ),
            Self::Volume { kind, cell, error, time } => write!(
                f,
                "the volume of cell {cell} of type `{kind}` is {error:.1e} (relative) off its target at t = {time:.6} s"
            ),
            Self::System { system, owner, time, variable, reason, detail } => {
                write!(f, "the system `{system}`")?;
                if let Some((kind, cell)) = owner {
                    write!(f, " of cell {cell} of type `{kind}`")?;
                }
                write!(f, " fails at t = {time:.6} s: {}", words_for(*reason))?;
                variable.as_ref().map_or(Ok(()), |variable| write!(f, " (worst variable: `{variable}`)"))?;
                if detail.is_empty() { Ok(()) } else { write!(f, " ({detail})") }
            }
            Self::Field { message } => f.write_str(message),
            Self::Link { link, owner, value, expected, time } => {
                write!(f, "the link {link} carries {value}")?;
                if let Some((kind, cell)) = owner {
                    write!(f, " for cell {cell} of type `{kind}`")?;
                }
                write!(f, " at t = {time:.6} s; {expected} was expected")
            }
            Self::Contact { cells: [(kind, cell), other], time, left, sweeps } => {
                write!(f, "contacts and volumes do not come to rest at t = {time:.6} s: after {sweeps} sweeps ")?;
                write!(f, "atoms of cell {cell} of type `{kind}`")?;
                if (kind, cell) != (&other.0, &other.1) {
                    write!(f, " and of cell {} of type `{}`, which touch,", other.1, other.0)?;
                }
                write!(f, " still move by {left:.1e} um")
            }
            Self::Pressed { cells: [one, other], time, depth } if one == other => {
                write!(f, "cell {} of type `{}` is at least {depth:.1e} um deep in itself ", one.1, one.0)?;
                write!(f, "or behind a plane at t = {time:.6} s, more than contacts can mend")
            }
            Self::Pressed { cells: [(kind, cell), other], time, depth } => {
                write!(f, "cell {cell} of type `{kind}` and cell {} of type `{}` are ", other.1, other.0)?;
                write!(f, "at least {depth:.1e} um deep in each other at t = {time:.6} s, more than contacts can mend")
            }
            Self::Pierced { tool, cell: (kind, cell), time } => {
                write!(
                    f,
                    "the tool `{tool}` has come through a facet of cell {cell} of type `{kind}` at t = {time:.6} s"
                )
            }
            Self::TooFast { time, share } => {
                write!(
                    f,
                    "an atom moves {share:.2} times as far as contacts or tools allow in the step to t = {time:.6} s"
                )
            }
            Self::StepTooSmall { time, dt } => {
                write!(f, "at t = {time:.6} s no step was small enough: {dt:.1e} s still misses the tolerance")
            }
        }
    }
}

impl std::error::Error for Trouble {}

/// What is wrong with a system, in words.
fn words_for(reason: Reason) -> &'static str {
    match reason {
        Reason::NotFinite => "a value is no longer a finite number",
        Reason::StepUnderflow => "no step is short enough for its tolerance",
        Reason::TooManySteps => "it takes too many steps",
        Reason::EndlessEvents => "events follow each other without end",
        Reason::TooManyTimes => "a schedule has too many times",
        Reason::RoundOff => "round-off has left no digit of a value",
        Reason::LooksAhead => "a delay is below 0",
        Reason::Solver => "the solver gave up",
    }
}
