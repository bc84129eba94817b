//! Every force once or more on the same cell, and what is known of it.

use std::ops::Range;
use std::sync::LazyLock;

use nalgebra::DMatrix;
use pseudopod::Vec3;
use pseudopod::geometry::{Surface, Topology, icosphere};
use pseudopod::mechanics::angles::Angles;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::bending::{Bending, RestAngle};
use pseudopod::mechanics::control::Context;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::fibres::Fibres;
use pseudopod::mechanics::gravity::Gravity;
use pseudopod::mechanics::lanes::LANES;
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::membrane::{Membrane, MembraneLaw};
use pseudopod::mechanics::moved::Translation;
use pseudopod::mechanics::ordering::Ordering;
use pseudopod::mechanics::plate::{Bonded, Plate};
use pseudopod::mechanics::pressure::{Beyond, Pressure};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::mechanics::solid::Solid;
use pseudopod::mechanics::solid::dilation::{Dilation, DilationLaw, Parts};
use pseudopod::mechanics::solid::law::{Elastic, SolidLaw};
use pseudopod::mechanics::springs::{Spring, Springs};
use pseudopod::mechanics::stiffness::StiffnessMatrix;
use pseudopod::mechanics::sum::measure_forces;
use pseudopod::mechanics::tension::Tension;
use pseudopod::mechanics::torque::Torque;
use pseudopod::mechanics::trap::Trap;
use pseudopod::mechanics::{CONTROLLED, Force};

/// A force, and what is known of it.
pub struct Case {
    pub name: &'static str,
    pub force: Force,
    /// Whether it acts between the atoms of the cell alone: no net force, the same wherever the cell is and however it is turned.
    pub internal: bool,
    /// Whether it has no net torque either.
    pub turns_nothing: bool,
    /// Whether the rest shape is free of force.
    pub rests: bool,
    /// Whether its linear part alone keeps an implicit step stable at rest. Shape memory has its own linear part and test; others have
    /// no stiffness, or no balance at rest.
    pub bounded: bool,
    /// How far its atoms are moved about in the tests, in mean edges: enough to wake it, little enough to stay defined.
    pub shake: f64,
}

/// The mean edge of the cell, µm.
pub const EDGE: f64 = 1.75;

/// How many forces there are.
pub const FORCES: usize = 17;

/// A number below [`FORCES`] for each force: one that is new must be named here, counted above and given a case below.
pub fn number(force: &Force) -> usize {
    match force {
        Force::ShapeMemory(_) => 0,
        Force::Angles(_) => 1,
        Force::Membrane(_) => 2,
        Force::Tension(_) => 3,
        Force::Ordering(_) => 4,
        Force::Bending(_) => 5,
        Force::Springs(_) => 6,
        Force::Barrier(_) => 7,
        Force::Load(_) => 8,
        Force::Fibres(_) => 9,
        Force::Gravity(_) => 10,
        Force::Attraction(_) => 11,
        Force::Trap(_) => 12,
        Force::Pressure(_) => 13,
        Force::Solid(_) => 14,
        Force::Plate(_) => 15,
        Force::Torque(_) => 16,
    }
}

pub fn flat(positions: &[Vec3]) -> Vec<f64> {
    positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect()
}

/// A number between −1 and 1 that looks random and is always the same.
fn noise(index: usize) -> f64 {
    let x = (index as f64 * 12.9898 + 4.1414).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// The positions moved about by up to `size` (µm) along each axis.
pub fn shaken(positions: &[Vec3], size: f64, seed: usize) -> Vec<Vec3> {
    let part = |i: usize, axis: usize| size * noise(1000 * seed + 3 * i + axis);
    positions.iter().enumerate().map(|(i, p)| p + Vec3::new(part(i, 0), part(i, 1), part(i, 2))).collect()
}

/// A cell of 42 atoms that is not quite a sphere, so that nothing vanishes by symmetry.
pub fn cell() -> Surface {
    let mut surface = icosphere(3.0, 1);
    surface.positions = shaken(&surface.positions, 0.15, 7);
    surface
}

/// What is set of the first force with each handle, for each of as many cells as there are lanes.
static CONTROLS: LazyLock<Vec<Vec<Vec<f64>>>> =
    LazyLock::new(|| vec![vec![(0..LANES).map(|cell| 0.9 - 0.1 * cell as f64).collect()]; CONTROLLED.len()]);

/// What forces on some of these cells depend on beside positions.
pub fn context(cells: Range<usize>) -> Context<'static> {
    Context { time: 0.7, mass: 1.3, cells, stiffness: &[], controls: &CONTROLS }
}

/// Energy and forces of one cell, the first of its kind.
pub fn on(force: &Force, positions: &[Vec3]) -> (f64, Vec<Vec3>) {
    on_cell(force, 0, positions)
}

/// Energy and forces of one cell.
pub fn on_cell(force: &Force, cell: usize, positions: &[Vec3]) -> (f64, Vec<Vec3>) {
    let x = flat(positions);
    let (mut f, mut energy) = (vec![0.0; x.len()], [0.0]);
    measure_forces(std::slice::from_ref(force), &context(cell..cell + 1), 1, &x, &mut f, &mut energy);
    (energy[0], f.chunks(3).map(|c| Vec3::new(c[0], c[1], c[2])).collect())
}

/// The linear part of a force in the rest shape.
pub fn stiffness(force: &Force, x: &[Vec3]) -> DMatrix<f64> {
    let atoms = x.len();
    let mut matrix = StiffnessMatrix::new(atoms);
    force.add_stiffness(x, x, &mut matrix);
    let mut dense = DMatrix::zeros(atoms, atoms);
    for i in 0..atoms {
        for (j, value) in matrix.row(i) {
            dense[(i, j)] = value;
        }
    }
    dense
}

pub fn largest(forces: &[Vec3]) -> f64 {
    forces.iter().map(Vec3::norm).fold(0.0, f64::max)
}

/// The largest difference between forces and the central difference of the energy over the largest force, and where.
pub fn gradient_error(force: &Force, positions: &[Vec3], forces: &[Vec3]) -> (f64, String) {
    let step = 1e-5;
    let energy_at = |i: usize, axis: usize, by: f64| {
        let mut moved = positions.to_vec();
        moved[i][axis] += by;
        on(force, &moved).0
    };
    let components = (0..positions.len()).flat_map(|i| (0..3).map(move |axis| (i, axis)));
    let errors = components.map(|(i, axis)| {
        let difference = (energy_at(i, axis, step) - energy_at(i, axis, -step)) / (2.0 * step);
        ((forces[i][axis] + difference).abs() / largest(forces), format!("atom {i}, axis {axis}"))
    });
    errors.fold((0.0, String::new()), |worst, next| if next.0 > worst.0 { next } else { worst })
}

/// All cases.
pub fn cases() -> Vec<Case> {
    elastic().into_iter().chain(driven()).collect()
}

fn case(name: &'static str, force: Force) -> Case {
    Case { name, force, internal: true, turns_nothing: true, rests: true, bounded: true, shake: 0.1 }
}

fn elastic() -> Vec<Case> {
    on_surfaces().into_iter().chain(filled()).collect()
}

/// The cell filled by tetrahedra between its first atom and all facets that this is not on.
fn filled() -> Vec<Case> {
    let Surface { positions, facets } = cell();
    let beyond = facets.iter().filter(|facet| !facet.contains(&0));
    let tetrahedra: Vec<[u32; 4]> = beyond.map(|&[a, b, c]| [0, a, b, c]).collect();
    // In cells of four.
    let starts: Vec<u32> =
        (0..=tetrahedra.len() as u32).filter(|start| start % 4 == 0).chain([tetrahedra.len() as u32]).collect();
    let solid = |law, dilation: Option<(DilationLaw, Parts)>| {
        let over = dilation.map(|(law, parts)| Dilation::new(&positions, &tetrahedra, &starts, law, parts));
        Force::Solid(Solid::new(&positions, &tetrahedra, Elastic { law, shear: 1.4, lame: 2.1 }, over))
    };
    let bulk = |parts| Some((DilationLaw::Bulk(3.0), parts));
    // It takes a turn for a strain.
    let linear = Case { internal: false, turns_nothing: false, ..case("solid, linear", solid(SolidLaw::Linear, None)) };
    let slight = |name, force| Case { shake: 0.03, ..case(name, force) };
    vec![
        linear,
        slight("solid, corotational", solid(SolidLaw::Corotational, None)),
        slight("solid, St Venant-Kirchhoff", solid(SolidLaw::StVenantKirchhoff, bulk(Parts::Cells))),
        slight("solid, neo-Hookean", solid(SolidLaw::NeoHookean, bulk(Parts::Tetrahedra))),
        slight("solid, volumes around atoms", solid(SolidLaw::NeoHookean, bulk(Parts::Atoms))),
        slight("solid, penalty", solid(SolidLaw::Corotational, Some((DilationLaw::Penalty(30.0), Parts::Tetrahedra)))),
    ]
}

fn on_surfaces() -> Vec<Case> {
    let Surface { positions, facets } = cell();
    let topology = Topology::of(&Surface { positions: positions.clone(), facets: facets.clone() });
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let memory = |reaction| Force::ShapeMemory(ShapeMemory::new(&positions, &rings, 1.3, reaction));
    let skin = |law| Force::Membrane(Membrane::new(&positions, &facets, law));
    let tension = |tension, area| Force::Tension(Tension::new(&positions, &facets, tension, area));
    let links = (0..10).map(|i| Spring { from: i, to: 41 - i, rest_length: 2.0 + 0.3 * f64::from(i), stiffness: 0.7 });
    let bending = |angle| Force::Bending(Bending::new(&positions, &topology, 0.4, angle));
    let rules = BarrierRules { energy: 0.8, area_share: 0.7, fold_angle: 1.8 };
    let barrier = Force::Barrier(Barrier::new(&positions, &facets, &topology.flaps, rules));
    let unbalanced = |name, force| Case { rests: false, bounded: false, ..case(name, force) };
    let spread = Case { turns_nothing: false, ..case("shape memory, spread", memory(Reaction::Spread)) };
    let angles = Force::Angles(Angles::new(&positions, &rings, 1.2));
    vec![
        Case { bounded: false, ..case("shape memory", memory(Reaction::Exact)) },
        Case { bounded: false, ..spread },
        case("Skalak", skin(MembraneLaw::Skalak { shear: 2.5, area: 9.0 })),
        case("neo-Hookean", skin(MembraneLaw::NeoHookean { shear: 2.5, area: 9.0, hardening: 0.0 })),
        case("hardening", skin(MembraneLaw::NeoHookean { shear: 2.5, area: 9.0, hardening: 1.0 / 30.0 })),
        unbalanced("tension", tension(1.7, 0.0)),
        case("total area", tension(0.0, 5.0)),
        unbalanced("ordering", Force::Ordering(Ordering::new(positions.len(), &facets, 1.1))),
        case("bending, remembered", bending(RestAngle::Remembered)),
        unbalanced("bending, flat", bending(RestAngle::Flat)),
        Case { bounded: false, shake: 0.5, ..case("barrier", barrier) },
        case("springs", Force::Springs(Springs::on_edges(&positions, &topology.edges, 1.1))),
        unbalanced("links", Force::Springs(Springs::between(links.collect()))),
        Case { bounded: false, turns_nothing: false, ..case("angles", angles) },
    ]
}

/// Forces that do work on the cell; chemistry sets those that let it.
fn driven() -> Vec<Case> {
    let course = || Course::through(vec![(0.0, 0.4), (1.0, 1.4)]).expect("times that rise");
    let load = Force::Load(Load::new("pull", vec![(0, 0.5), (7, 0.3), (8, 0.2)], Vec3::new(0.6, 0.0, 0.8), course()));
    let pairs = (0..6).map(|i| [i, 40 - 3 * i]).chain([[0, 3]]).collect();
    let fibres = Force::Fibres(Fibres::new("trunk", pairs, 3.0, course()));
    let gravity = Force::Gravity(Gravity { acceleration: Vec3::new(0.3, -0.2, -9.0) });
    let attraction = Force::Attraction(Attraction { to: Vec3::new(4.0, -1.0, 0.5), stiffness: 0.6 });
    let displacement = Course::through(vec![(0.0, 1.0), (1.0, 2.0)]).expect("times rise");
    let translation = Some(Translation { direction: Vec3::new(0.0, 0.6, 0.8), displacement });
    let trap = Force::Trap(Trap { name: "trap".into(), stiffness: 3.0, at: Vec3::new(1.0, 2.0, -0.5), translation });
    let direction = Vec3::new(0.0, 0.6, 0.8);
    let bond = |(atom, stiffness): (u32, f64)| Bonded {
        atom,
        stiffness,
        offset: cell().positions[atom as usize].dot(&direction),
    };
    let plate = Force::Plate(Plate {
        name: "plate".into(),
        bonded: [(3, 20.0), (9, 30.0), (17, 25.0)].map(bond).into(),
        direction,
        stiffness: 4.0,
        at: 0.1,
        displacement: course(),
    });
    let above = Beyond { point: Vec3::new(0.0, 0.0, 1.3), direction: Vec3::new(0.6, 0.0, 0.8), radius: None };
    let shares = (0..10).map(|atom| (atom, 0.1)).collect();
    let axis = Vec3::new(0.6, 0.0, 0.8);
    let torque = Force::Torque(Torque::new("twist", shares, axis, course(), &cell().positions));
    let pressure = |beyond| {
        let facets = icosphere(5.0, 1).facets;
        Force::Pressure(Pressure { name: "pressure".into(), facets, pressure: course(), beyond, profile: None })
    };
    let outer = |name, force, bounded| Case {
        internal: false,
        turns_nothing: false,
        rests: false,
        bounded,
        ..case(name, force)
    };
    vec![
        Case { rests: false, ..case("fibres", fibres) },
        outer("load", load, false),
        outer("gravity", gravity, false),
        outer("attraction", attraction, true),
        outer("trap", trap, false),
        outer("plate", plate, true),
        outer("pressure", pressure(None), false),
        outer("pressure beyond a plane", pressure(Some(above)), false),
        outer("torque", torque, false),
        outer("pressure in a mouth", pressure(Some(Beyond { radius: Some(2.2), ..above })), false),
    ]
}
