//! Random scenes of contacts. One number makes a scene: shapes, materials, strengths, planes, forces, scheme and step.
#![allow(dead_code)]

use nalgebra::Rotation3;
use pseudopod::Vec3;
use pseudopod::cell::Behaviour;
use pseudopod::cell::motility::{BrownianMotility, Space};
use pseudopod::contact::Reach;
use pseudopod::geometry::{self, Surface, Topology};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::bending::{Bending, RestAngle};
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::gravity::Gravity;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::membrane::{Membrane, MembraneLaw};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::mechanics::springs::Springs;
use pseudopod::mechanics::stability::{Body, largest_stable_step};
use pseudopod::mechanics::sum;
use pseudopod::random::{Purpose, Stream};
use pseudopod::sim::contact::{ContactModel, Strength};
use pseudopod::sim::{Kind, Model, Obstacle, State, VolumeRule};

/// What a scene is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purposed {
    /// Two to twelve cells, planes, a sheet, forces from outside: everything.
    Mixed,
    /// Two deformed cells that touch and on which nothing acts from outside.
    Alone,
    /// Cells that swell in a closed box until it cannot hold them.
    Overfull,
}

/// A mesh, named by how it is made; lengths in µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mesh {
    Icosphere { radius: f64, level: u32 },
    Octasphere { radius: f64, divisions: u32 },
    Box { size: [f64; 3], divisions: [u32; 3] },
    RedCell { diameter: f64, level: u32 },
    Sheet { side: f64, parts: u32 },
}

/// What makes a surface elastic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Skin {
    ShapeMemory,
    Membrane,
}

/// What keeps a volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Volume {
    Free,
    Exact,
    /// The modulus, Pa.
    Compressible(f64),
}

/// Cells of one type.
#[derive(Debug, Clone, PartialEq)]
pub struct Type {
    pub mesh: Mesh,
    /// The mesh is stretched by these along its axes.
    pub stretch: [f64; 3],
    pub cells: usize,
    pub stiffness: f64,
    pub skin: Skin,
    pub volume: Volume,
    /// Drag of an atom, pN s/µm.
    pub drag: f64,
    /// Stiffness of the pull to the middle, pN/µm an atom.
    pub pull: f64,
    /// Speed of the walk, µm/s.
    pub speed: f64,
}

/// All that was drawn for a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    pub seed: u64,
    pub purpose: Purposed,
    pub types: Vec<Type>,
    /// Planes of a box around the cells: below, above, left, right, before, behind.
    pub planes: usize,
    /// Room between cells and planes, µm.
    pub spare: f64,
    /// Weight of an atom downwards, pN.
    pub weight: f64,
    /// Strengths between types: `[one][other]`, tensile and shear.
    pub between: Vec<Vec<[f64; 2]>>,
    /// Strengths between types and planes: `[type][plane]`.
    pub on_planes: Vec<Vec<[f64; 2]>>,
    /// Proximity over the smallest mean edge.
    pub proximity: f64,
    pub method: Method,
    pub size: StepSize,
    /// Pull of an atom to the middle for a while at the start of two cells that are then left alone, pN/µm.
    pub pressed: f64,
    /// Steps after which the scene ends.
    pub steps: u64,
    pub until: f64,
}

/// A source of random numbers.
pub struct Dice(Stream);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(Stream::new(seed, Purpose::Placement, 0, 0))
    }

    /// Uniform in [0, 1).
    pub fn roll(&mut self) -> f64 {
        self.0.uniform_pair()[0]
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    /// Uniform in the logarithm.
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.roll())
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        ((count as f64 * self.roll()) as usize).min(count - 1)
    }

    pub fn chance(&mut self, share: f64) -> bool {
        self.roll() < share
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::from_fn(|_, _| self.between(-1.0, 1.0));
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }

    pub fn turn(&mut self) -> Rotation3<f64> {
        Rotation3::from_scaled_axis(self.direction() * self.between(0.0, std::f64::consts::PI))
    }
}

fn mesh(dice: &mut Dice, size: usize) -> Mesh {
    let radius = dice.between(3.0, 6.0);
    match dice.below(12) {
        0 => Mesh::Icosphere { radius, level: 0 },
        1..=4 => Mesh::Icosphere { radius, level: 1 },
        5 if size < 5 => Mesh::Icosphere { radius, level: 2 },
        6 | 7 => Mesh::Octasphere { radius, divisions: 2 + dice.below(3) as u32 },
        8 | 9 => Mesh::Box {
            size: [0; 3].map(|_| radius * dice.between(1.0, 2.0)),
            divisions: [0; 3].map(|_| 1 + dice.below(3) as u32),
        },
        10 | 11 => Mesh::RedCell { diameter: 1.6 * radius, level: if size < 4 { 2 } else { 1 } },
        _ => Mesh::Icosphere { radius, level: 1 },
    }
}

fn cells_of(dice: &mut Dice, purpose: Purposed, cells: usize) -> Type {
    let mesh = mesh(dice, cells);
    let is_stretched = dice.chance(0.35) && !matches!(mesh, Mesh::RedCell { .. });
    let stretch = if is_stretched { [0; 3].map(|_| dice.between(0.6, 1.5)) } else { [1.0; 3] };
    let (stiffness, drag) = (dice.decades(1.0, 32.0), dice.decades(0.2, 1.0));
    let volume = match dice.below(4) {
        _ if purpose == Purposed::Overfull => Volume::Exact,
        0 => Volume::Free,
        1 => Volume::Compressible(stiffness * dice.decades(0.02, 2.0)),
        _ => Volume::Exact,
    };
    let skin = if dice.chance(0.3) { Skin::Membrane } else { Skin::ShapeMemory };
    let is_pulled = purpose == Purposed::Mixed && dice.chance(0.9);
    let is_motile = purpose == Purposed::Mixed && dice.chance(0.3);
    Type {
        mesh,
        stretch,
        cells,
        stiffness,
        skin,
        volume,
        drag,
        pull: if is_pulled { stiffness * dice.decades(3e-3, 5e-2) } else { 0.0 },
        speed: if is_motile { dice.decades(3e-3, 0.1) * stiffness / drag } else { 0.0 },
    }
}

/// Nothing, little or much.
fn strength(dice: &mut Dice) -> [f64; 2] {
    let tensile = if dice.chance(0.3) { 0.0 } else { dice.decades(0.01, 100.0) };
    let shear = match dice.below(3) {
        0 => 0.0,
        1 => tensile,
        _ => dice.decades(0.01, 100.0),
    };
    [tensile, shear]
}

impl Scene {
    /// Draws a scene: one in ten is over-full, three are two cells left alone.
    pub fn draw(seed: u64) -> Self {
        let mut dice = Dice::new(seed);
        let dice = &mut dice;
        let purpose = match seed % 10 {
            3 => Purposed::Overfull,
            0 | 5 | 8 => Purposed::Alone,
            _ => Purposed::Mixed,
        };
        let cells = if purpose == Purposed::Alone { 2 } else { 2 + dice.below(11) };
        let first = if dice.chance(0.5) || purpose == Purposed::Overfull { cells } else { 1 + dice.below(cells - 1) };
        let mut types = vec![cells_of(dice, purpose, first)];
        if first < cells {
            types.push(cells_of(dice, purpose, cells - first));
        }
        if purpose == Purposed::Mixed && dice.chance(0.2) {
            let (side, parts) = (dice.between(15.0, 25.0), 4 + dice.below(4) as u32);
            let mut sheet = cells_of(dice, Purposed::Alone, 1);
            (sheet.mesh, sheet.stretch, sheet.volume) = (Mesh::Sheet { side, parts }, [1.0; 3], Volume::Free);
            types.push(sheet);
        }
        let planes = match purpose {
            Purposed::Alone => 0,
            Purposed::Overfull => 6,
            Purposed::Mixed if dice.chance(0.4) => 0,
            Purposed::Mixed => 1 + dice.below(6),
        };
        let has_weight = purpose == Purposed::Mixed && dice.chance(0.5);
        let softest = types.iter().map(|kind| kind.stiffness).fold(f64::INFINITY, f64::min);
        let weight = if has_weight { softest * dice.decades(3e-3, 0.1) } else { 0.0 };
        let mut between = vec![vec![[0.0; 2]; types.len()]; types.len()];
        for one in 0..types.len() {
            for other in one..types.len() {
                between[one][other] = strength(dice);
                between[other][one] = between[one][other];
            }
        }
        let on_planes = types.iter().map(|_| (0..planes).map(|_| strength(dice)).collect()).collect();
        // Steps and the run are measured by the time in which the quickest cell relaxes.
        let relaxes = types.iter().map(|kind| kind.drag / kind.stiffness).fold(f64::INFINITY, f64::min);
        let step = relaxes * dice.decades(0.3, 30.0);
        let adaptive = StepSize::Adaptive { tolerance: dice.decades(2e-4, 3e-3), largest: step };
        let (method, size) = match dice.below(8) {
            0 => (Method::Implicit { order: Order::First }, StepSize::Fixed(step)),
            1 => (Method::Implicit { order: Order::Second }, StepSize::Fixed(step)),
            2 => (Method::Explicit, StepSize::Fixed(step)),
            _ => (Method::Implicit { order: Order::Second }, adaptive),
        };
        Self {
            seed,
            purpose,
            types,
            planes,
            spare: if purpose == Purposed::Overfull { 0.1 } else { dice.decades(0.1, 4.0) },
            weight,
            between,
            on_planes,
            proximity: dice.decades(0.05, 0.5),
            method,
            size,
            pressed: if purpose == Purposed::Alone && dice.chance(0.7) {
                softest * dice.decades(3e-3, 5e-2)
            } else {
                0.0
            },
            steps: 100,
            until: match purpose {
                Purposed::Overfull => 60.0 * step,
                _ => relaxes * dice.decades(100.0, 2000.0),
            },
        }
    }

    /// A scene in one line.
    pub fn summary(&self) -> String {
        let kind = |kind: &Type| format!("{} x {:?} {:?} {:?}", kind.cells, kind.mesh, kind.skin, kind.volume);
        let kinds: Vec<String> = self.types.iter().map(kind).collect();
        format!(
            "{:?} {:?} {:?} proximity {:.2}, {} planes, {}",
            self.purpose,
            self.method,
            self.size,
            self.proximity,
            self.planes,
            kinds.join(", ")
        )
    }

    /// What the scene means and where it starts.
    pub fn build(&self) -> (Model, State) {
        let mut dice = Dice::new(self.seed ^ 0x5eed_0000_0000);
        let mut kinds: Vec<Kind> = Vec::new();
        for (number, of) in self.types.iter().enumerate() {
            kinds.push(self.kind(number, of).for_cells(of.cells));
        }
        let turn = dice.turn();
        let (centres, half) = match self.purpose {
            Purposed::Alone => (pair(&mut dice, self, &kinds), 0.0),
            _ => scatter(&mut dice, self, &kinds),
        };
        let centres: Vec<Vec<Vec<Vec3>>> = centres
            .iter()
            .map(|cells| cells.iter().map(|atoms| atoms.iter().map(|x| turn * x).collect()).collect())
            .collect();
        let sides = [Vec3::z(), -Vec3::z(), Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y()];
        let planes: Vec<Obstacle> = sides[..self.planes]
            .iter()
            .enumerate()
            .map(|(number, normal)| {
                let (point, name) = (turn * normal * -(half + self.spare), format!("plane {number}"));
                Obstacle::plane(&name, point, turn * normal)
            })
            .collect();
        if self.weight > 0.0 {
            let weight = Gravity { acceleration: turn * Vec3::new(0.0, 0.0, -self.weight) };
            for kind in &mut kinds {
                // Before the pull to the middle, as documents have it.
                let driven = kind.forces.iter().position(|force| !force.is_elastic());
                kind.forces.insert(driven.unwrap_or(kind.forces.len()), Force::Gravity(weight));
            }
        }
        let edge = kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
        let near = self.proximity * edge;
        // What sticks does so where it touches, however far off contacts are found.
        let reach = Reach { proximity: near.min(0.1 * edge), prediction: near, depth: near, margin: near };
        let mut contact = ContactModel::new(&kinds, &planes, reach);
        for (one, row) in self.between.iter().enumerate() {
            for (other, &[tensile, shear]) in row.iter().enumerate() {
                contact.stick(one, other, Strength { tensile, shear, energy: 0.0 });
            }
        }
        for (one, row) in self.on_planes.iter().enumerate() {
            for (plane, &[tensile, shear]) in row.iter().enumerate() {
                contact.stick_to_obstacle(one, plane, Strength { tensile, shear, energy: 0.0 });
            }
        }
        let size = match (self.method, self.size) {
            (Method::Explicit, StepSize::Fixed(step)) => StepSize::Fixed(step.min(0.5 * stable_step(&kinds))),
            (_, size) => size,
        };
        if let StepSize::Fixed(_) = size {
            // As documents allow it: a fixed step cannot be made shorter.
            contact = contact.suited_to(size);
        }
        let integrator = Integrator { method: self.method, size };
        let model = Model {
            seed: self.seed,
            contact: Some(contact),
            obstacles: planes,
            ..Model::of(kinds, integrator, self.until)
        };
        let state = State::new(&model, &centres);
        (model, state)
    }

    fn kind(&self, number: usize, of: &Type) -> Kind {
        let mut rest = surface(of.mesh);
        for x in &mut rest.positions {
            *x = Vec3::from_fn(|axis, _| of.stretch[axis] * x[axis]);
        }
        let is_sheet = matches!(of.mesh, Mesh::Sheet { .. });
        let topology = Topology::of(&rest);
        let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
        let mut forces = Vec::new();
        if of.skin == Skin::ShapeMemory || is_sheet {
            let memory = ShapeMemory::new(&rest.positions, &rings, of.stiffness, Reaction::Exact);
            forces.push(Force::ShapeMemory(memory));
        }
        if of.skin == Skin::Membrane {
            let law = MembraneLaw::Skalak { shear: of.stiffness, area: 3.0 * of.stiffness };
            forces.push(Force::Membrane(Membrane::new(&rest.positions, &rest.facets, law)));
            let rigidity = 0.1 * of.stiffness * geometry::mean_edge_length(&rest).powi(2);
            let bending = Bending::new(&rest.positions, &topology, rigidity, RestAngle::Remembered);
            forces.push(Force::Bending(bending));
        }
        if is_sheet {
            forces.push(Force::Springs(Springs::on_edges(&rest.positions, &topology.edges, of.stiffness)));
        }
        let edge = geometry::mean_edge_length(&rest);
        let matrix = sum::stiffness(&forces, &rest.positions, &rest.positions);
        let stiffest = (0..rest.positions.len()).map(|atom| matrix.diagonal(atom)).fold(0.0, f64::max);
        let rules = BarrierRules::with_energy(0.1 * stiffest * edge * edge);
        forces.push(Force::Barrier(Barrier::new(&rest.positions, &rest.facets, &topology.flaps, rules)));
        let mut kind = Kind::new(&format!("type {number}"), rest, forces);
        kind.drag = of.drag;
        kind.volume = match of.volume {
            Volume::Free => VolumeRule::Free,
            Volume::Exact if self.purpose == Purposed::Overfull => {
                VolumeRule::Exact(Course::through(vec![(0.0, 1.0), (self.until, 40.0)]).unwrap())
            }
            Volume::Exact => VolumeRule::Exact(Course::constant(1.0)),
            Volume::Compressible(modulus) => VolumeRule::Compressible { modulus, course: Course::constant(1.0) },
        };
        if is_sheet {
            let mut held = vec![1.0; 3 * kind.atoms()];
            for [a, b] in topology.edges.iter().filter(|edge| is_rim(&kind.rest, edge)) {
                [a, b].iter().for_each(|atom| held[3 * **atom as usize..][..3].fill(0.0));
            }
            kind.held = held;
        }
        let pull = Force::Attraction(Attraction { to: Vec3::zeros(), stiffness: of.pull });
        kind.forces.extend((of.pull > 0.0).then_some(pull));
        let walk = BrownianMotility { speed: of.speed, persistence: 10.0, space: Space::Volume };
        kind.behaviours.extend((of.speed > 0.0).then_some(Behaviour::Brownian(walk)));
        kind.largest_stiffness = kind.measure_largest_stiffness();
        kind.bound_stiffness();
        kind
    }
}

/// Whether an edge has one facet only.
fn is_rim(surface: &Surface, edge: &[u32; 2]) -> bool {
    surface.facets.iter().filter(|facet| edge.iter().all(|atom| facet.contains(atom))).count() == 1
}

fn surface(mesh: Mesh) -> Surface {
    match mesh {
        Mesh::Icosphere { radius, level } => geometry::icosphere(radius, level),
        Mesh::Octasphere { radius, divisions } => geometry::octasphere(radius, divisions),
        Mesh::Box { size, divisions } => geometry::box_surface(size, divisions),
        Mesh::RedCell { diameter, level } => geometry::red_cell(diameter, level),
        Mesh::Sheet { side, parts } => geometry::sheet(side, side, parts, parts),
    }
}

fn stable_step(kinds: &[Kind]) -> f64 {
    let limit = |kind: &Kind| {
        let body = Body { mass: kind.mass, drag: kind.drag, largest_stiffness: kind.largest_stiffness };
        largest_stable_step(Method::Explicit, &body)
    };
    kinds.iter().map(limit).fold(f64::INFINITY, f64::min)
}

/// Two cells, each turned and squeezed without a change of its volume, that just touch.
fn pair(dice: &mut Dice, scene: &Scene, kinds: &[Kind]) -> Vec<Vec<Vec<Vec3>>> {
    let mut cells: Vec<Vec<Vec3>> = Vec::new();
    let of_types = kinds.iter().zip(&scene.types);
    for kind in of_types.flat_map(|(kind, of)| std::iter::repeat_n(kind, of.cells)) {
        let turn = dice.turn();
        let [a, b] = [0; 2].map(|_| dice.between(0.85, 1.15));
        let lean = dice.between(-0.1, 0.1);
        let squeeze = |x: &Vec3| Vec3::new(a * x.x, b * x.y, x.z / (a * b) + lean * x.x);
        let gap = dice.decades(1e-3, 0.1) * kind.edge;
        let mut atoms: Vec<Vec3> = kind.rest.positions.iter().map(|x| turn * squeeze(x)).collect();
        let side = cells.len() as f64;
        let end = atoms.iter().map(|x| (1.0 - 2.0 * side) * x.x).fold(f64::NEG_INFINITY, f64::max) + 0.5 * gap;
        let shift = Vec3::new((2.0 * side - 1.0) * end, 0.0, 0.0);
        atoms.iter_mut().for_each(|x| *x += shift);
        cells.push(atoms);
    }
    if kinds.len() == 2 { cells.into_iter().map(|cell| vec![cell]).collect() } else { vec![cells] }
}

/// Cells at random places without overlaps, sheets below them; and half of the side of a cube that holds all of them.
fn scatter(dice: &mut Dice, scene: &Scene, kinds: &[Kind]) -> (Vec<Vec<Vec<Vec3>>>, f64) {
    let radius = |kind: &Kind| kind.rest.positions.iter().map(|x| x.norm()).fold(0.0, f64::max);
    let is_sheet = |number: usize| matches!(scene.types[number].mesh, Mesh::Sheet { .. });
    let closed: Vec<usize> = (0..kinds.len()).filter(|number| !is_sheet(*number)).collect();
    let largest = closed.iter().map(|number| radius(&kinds[*number])).fold(0.0, f64::max);
    let filled: f64 =
        closed.iter().map(|number| scene.types[*number].cells as f64 * (2.0 * radius(&kinds[*number])).powi(3)).sum();
    let mut half = 0.5 * filled.cbrt();
    let mut taken: Vec<(Vec3, f64)> = Vec::new();
    let mut centres = vec![Vec::new(); kinds.len()];
    for &number in &closed {
        let (kind, own) = (&kinds[number], radius(&kinds[number]));
        for _ in 0..scene.types[number].cells {
            let centre = loop {
                let centre = Vec3::from_fn(|_, _| dice.between(-half, half));
                if taken.iter().all(|(other, its)| (centre - other).norm() > own + its + 0.02 * kind.edge) {
                    break centre;
                }
                half *= 1.01;
            };
            taken.push((centre, own));
            let turn = dice.turn();
            centres[number].push(kind.rest.positions.iter().map(|x| turn * x + centre).collect());
        }
    }
    let all = centres.iter().flatten().flatten();
    let half = all.clone().flat_map(|x: &Vec3| [x.x, x.y, x.z]).map(f64::abs).fold(0.0, f64::max);
    let lowest = all.map(|x| x.z).fold(f64::INFINITY, f64::min);
    let mut reach = half.max(largest);
    for number in (0..kinds.len()).filter(|number| is_sheet(*number)) {
        let below = Vec3::new(0.0, 0.0, lowest - 0.1 * kinds[number].edge);
        let sheet: Vec<Vec3> = kinds[number].rest.positions.iter().map(|x| x + below).collect();
        reach = sheet.iter().flat_map(|x| [x.x, x.y, x.z]).map(f64::abs).fold(reach, f64::max);
        centres[number].push(sheet);
    }
    (centres, reach)
}
