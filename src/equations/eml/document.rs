//! What an EML document says, checked.

use crate::equations::Range;
use crate::equations::tree::{Expr, QuantityId, System};
use crate::error::Location;

/// A document without fault.
#[derive(Debug, Clone)]
pub struct Document {
    /// Its name.
    pub name: String,
    /// What has the system: the scene, each cell or each point of a field.
    pub level: Level,
    /// The unit of time, as written.
    pub time_unit: String,
    /// Seconds in the unit of time.
    pub seconds: f64,
    /// The equations. In a document of fields, each field is a variable whose rate is its reaction (diffusion and decay
    /// are in [`FieldDescription`]) and the position is given by inputs `x`, `y`, `z` where it is used.
    pub system: System,
    /// Where each quantity of the system is declared.
    pub locations: Vec<Location>,
    /// The grid of the fields.
    pub grid: Option<GridDescription>,
    /// The fields.
    pub fields: Vec<FieldDescription>,
    /// What a document of fields has beside these; none where there are fields alone.
    pub scene: Option<SceneDescription>,
    /// What a document of membranes says beside its equations.
    pub membrane: Option<MembraneDescription>,
    /// The variables, pools and fields with noise.
    pub noise: Vec<NoiseDescription>,
    /// What joins the system to the model.
    pub links: Vec<LinkDescription>,
    /// How it asks to be solved.
    pub solver: SolverChoice,
}

/// What has the system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// One system for the whole scene.
    Scene,
    /// One for each cell of a type.
    Cell,
    /// Fields: one at each point.
    Field,
    /// One on each atom of the surfaces of cells, and what it exchanges with inside.
    Membrane,
}

impl Level {
    /// As documents write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Cell => "cell",
            Self::Field => "field",
            Self::Membrane => "membrane",
        }
    }
}

/// What a document of membranes says beside its equations. Its variables live on the surface or, as pools, once in each cell; the
/// position on the surface is given by inputs `x`, `y`, `z`, area and volume of the cell by inputs `area` and `volume`, and what is
/// summed over the surface is an input, too.
#[derive(Debug, Clone, Default)]
pub struct MembraneDescription {
    /// Variables on the surface.
    pub surface: Vec<SurfaceVariable>,
    /// Inputs that differ from atom to atom.
    pub given: Vec<QuantityId>,
    /// What is summed over the surface, in the order of its quantities.
    pub totals: Vec<Total>,
    /// Of each quantity, whether it differs from atom to atom.
    pub local: Vec<bool>,
}

/// What stands once in the scene beside the fields of a document: variables that are no fields, events, and what is summed over the grid,
/// which is an input of the system.
#[derive(Debug, Clone, Default)]
pub struct SceneDescription {
    /// What is summed over the grid, in the order of its quantities.
    pub totals: Vec<Total>,
    /// Of each quantity, whether it differs from point to point.
    pub local: Vec<bool>,
}

/// A variable on the surface.
#[derive(Debug, Clone)]
pub struct SurfaceVariable {
    /// Its variable in the system.
    pub quantity: QuantityId,
    /// Diffusion coefficient in µm² per unit of time, an expression of parameters.
    pub diffusion: Expr,
    /// Where it is declared.
    pub location: Location,
}

/// A number that is taken from the whole surface of a cell, or from the whole grid of fields.
#[derive(Debug, Clone)]
pub struct Total {
    /// The input that has it.
    pub quantity: QuantityId,
    /// How it is taken.
    pub taken: Taken,
    /// Of what.
    pub integrand: Expr,
    /// Where it is declared.
    pub location: Location,
}

/// How a number is taken from a surface or a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    /// The mean over the area, or over the grid.
    Mean,
    /// The integral over the area, µm² times the unit of what is summed; over a grid, its unit of length to the power of its dimension times that.
    Integral,
}

/// The noise of a variable, eq. (noise.1).
#[derive(Debug, Clone)]
pub struct NoiseDescription {
    /// The variable.
    pub quantity: QuantityId,
    /// Its strength: of a variable of the scene or of a cell in its unit per root of the unit of time, on a surface times µm, in a field times the unit of
    /// length of the grid (flat) or that to the power 3/2.
    pub strength: Expr,
    /// Where it is written.
    pub location: Location,
}

/// How a document asks to be solved; what it leaves open is decided by the experiment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolverChoice {
    /// The scheme.
    pub scheme: Option<Scheme>,
    /// Relative tolerance.
    pub rtol: Option<f64>,
    /// Absolute tolerance, in the units of the variables.
    pub atol: Option<f64>,
    /// Time between two exchanges with the model, in the unit of time.
    pub step: Option<f64>,
    /// Step of a scheme with a fixed step, in the unit of time.
    pub inner_step: Option<f64>,
    /// Time between two kicks of noise, in the unit of time.
    pub noise_step: Option<f64>,
}

/// A scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Explicit Runge–Kutta of order 5 with error control.
    Rk45,
    /// Explicit Runge–Kutta of order 6 with error control.
    Rk65,
    /// Rosenbrock for stiff systems.
    Rosenbrock,
    /// Explicit Runge–Kutta of order 4, fixed step.
    Rk4,
    /// Explicit Euler, fixed step.
    Euler,
    /// Backward differentiation formulae of variable order.
    Bdf,
}

impl Scheme {
    /// What it is, for the book.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Rk45 => "An explicit method of Runge and Kutta of order 5 that finds its step.",
            Self::Rk65 => "The same of order 6, for tight tolerances.",
            Self::Rosenbrock => "A method of Rosenbrock for stiff systems that finds its step.",
            Self::Bdf => "Backward differentiation formulae of variable order, for long runs of one stiff system.",
            Self::Rk4 => "The classical method of order 4 with a fixed `inner_step`.",
            Self::Euler => "Explicit steps of order 1 with a fixed `inner_step`.",
        }
    }
}

/// The grid of a document's fields.
#[derive(Debug, Clone, PartialEq)]
pub struct GridDescription {
    /// 1 (on a line along x), 2 (on the substrate) or 3 (in the medium).
    pub dimension: usize,
    /// Distance of neighbouring points, in `unit`.
    pub spacing: f64,
    /// Lower corner, in `unit`; the experiment decides where it is open. In 2-D the third number is 0.
    pub origin: Option<[f64; 3]>,
    /// Lengths of the sides, in `unit`; as above.
    pub size: Option<[f64; 3]>,
    /// The unit of length, as written.
    pub unit: String,
    /// µm in the unit of length.
    pub micrometres: f64,
    /// Where it is written.
    pub location: Location,
}

/// A field.
#[derive(Debug, Clone)]
pub struct FieldDescription {
    /// Its identifier.
    pub id: String,
    /// Its variable in the system.
    pub quantity: QuantityId,
    /// Diffusion coefficient in length²/time of the document, an expression of parameters, the position, the time, inputs and fields.
    pub diffusion: Expr,
    /// Rate of decay per time, an expression of parameters.
    pub decay: Expr,
    /// The velocity that carries it, length/time of the document, of parameters, the position, the time and inputs.
    pub advection: Option<[Expr; 3]>,
    /// The fields whose gradients it follows.
    pub taxis: Vec<Taxis>,
    /// Where it comes from, at points and along lines.
    pub sources: Vec<FieldSource>,
    /// How it starts.
    pub initial: Profile,
    /// Which values it may take.
    pub range: Range,
    /// Walls at x-, x+, y-, y+, z-, z+.
    pub walls: [Wall; 6],
    /// Where it is declared.
    pub location: Location,
}

/// A field that another one moves up the gradient of.
#[derive(Debug, Clone)]
pub struct Taxis {
    /// The variable of the field that is followed.
    pub towards: QuantityId,
    /// The sensitivity χ in length²/time of the document for each unit of that field: the velocity over its gradient.
    pub sensitivity: Expr,
    /// Where it is written.
    pub location: Location,
}

/// A source of a field at a point, or spread evenly along a line.
#[derive(Debug, Clone)]
pub struct FieldSource {
    /// Both ends of the line, in the unit of the grid; the same for a point.
    pub ends: [[f64; 3]; 2],
    /// What comes from the whole of it: the field's unit times length, area or volume, over time of the document; of parameters, inputs and
    /// the time.
    pub strength: Expr,
    /// Where it is written.
    pub location: Location,
}

impl FieldDescription {
    /// The expressions of what carries it and comes through its walls and from its sources.
    pub fn carriers(&self) -> impl Iterator<Item = &Expr> {
        let walls = self.walls.iter().filter_map(|wall| match wall {
            Wall::Fixed(value) | Wall::Flux(value) | Wall::Open(value) => Some(value),
            Wall::NoFlux | Wall::Periodic => None,
        });
        let flows = self.advection.iter().flatten().chain(self.taxis.iter().map(|taxis| &taxis.sensitivity));
        let sources = self.sources.iter().map(|source| &source.strength);
        std::iter::once(&self.diffusion).chain(flows).chain(sources).chain(walls)
    }

    /// Whether it is carried or changes at walls and sources in ways that one diffusion coefficient and walls that stay do not tell.
    pub fn is_carried(&self, system: &System) -> bool {
        let still = |expr: &Expr| super::reads::reads(expr, system).is_number();
        let plain = |wall: &Wall| match wall {
            Wall::NoFlux | Wall::Periodic => true,
            Wall::Fixed(value) => still(value),
            Wall::Flux(_) | Wall::Open(_) => false,
        };
        self.advection.is_some()
            || !self.taxis.is_empty()
            || !self.sources.is_empty()
            || !still(&self.diffusion)
            || !self.walls.iter().all(plain)
    }
}

/// How a field starts.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// An expression of `x`, `y`, `z` (and parameters).
    Expression(Expr),
    /// The brightness of an image, 0 black to 1 white, times `scale`.
    Image {
        /// The file, as written.
        file: String,
        /// The value of white.
        scale: f64,
        /// Where it is written.
        location: Location,
    },
    /// A dataset of an HDF5 file, times `scale`.
    Dataset {
        /// The file, as written.
        file: String,
        /// The dataset in the file, beginning with `/`.
        dataset: String,
        /// Factor of the values.
        scale: f64,
        /// Where it is written.
        location: Location,
    },
}

/// What holds at a side of the grid.
#[derive(Debug, Clone, PartialEq)]
pub enum Wall {
    /// Nothing passes.
    NoFlux,
    /// The field has this value there, an expression of parameters, the position, the time and inputs.
    Fixed(Expr),
    /// So much comes in, in the field's unit times length over time of the document: an expression of these and of the fields at the wall.
    Flux(Expr),
    /// What flows out leaves, what flows in has this value, as of a fixed wall; nothing passes by diffusion.
    Open(Expr),
    /// What leaves comes in at the opposite side.
    Periodic,
}

/// Names of the sides, in the order of [`FieldDescription::walls`].
pub const SIDES: [&str; 6] = ["x-", "x+", "y-", "y+", "z-", "z+"];

/// A link between the system and the model.
#[derive(Debug, Clone)]
pub struct LinkDescription {
    /// Its identifier, or empty.
    pub id: String,
    /// Where the value comes from.
    pub from: Endpoint,
    /// Where it goes.
    pub to: Endpoint,
    /// What is done to it: an expression of quantities of the system and of the value, which is
    /// `Expr::Quantity(LinkDescription::VALUE)`.
    pub transfer: Expr,
    /// Factor of what the transfer gives.
    pub gain: f64,
    /// Where it is written.
    pub location: Location,
}

impl LinkDescription {
    /// The number that stands for the value in a transfer.
    pub const VALUE: QuantityId = QuantityId::MAX;
}

/// One end of a link.
#[derive(Debug, Clone)]
pub struct Endpoint {
    /// What it belongs to.
    pub root: Root,
    /// The path from there; empty for the system, whose quantity is in the root.
    pub path: Vec<Step>,
    /// As written.
    pub text: String,
    /// Where it is written.
    pub location: Location,
}

/// What an end of a link belongs to.
#[derive(Debug, Clone, PartialEq)]
pub enum Root {
    /// A quantity of this document.
    System(QuantityId),
    /// The whole scene.
    Scene,
    /// The cell that has the system, or the one with this number or name.
    Cell(Option<Index>),
    /// All cells of a type.
    Type(Index),
    /// A field.
    Field(Index),
}

/// A step of a path: `atom[4]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The word.
    pub name: String,
    /// What stands in its brackets.
    pub index: Option<Index>,
}

/// What stands in brackets.
#[derive(Debug, Clone, PartialEq)]
pub enum Index {
    /// A number, from 0.
    Number(usize),
    /// A name.
    Name(String),
}
