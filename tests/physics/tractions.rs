//! What cells do to what is around them is kept as the step has it: over each cell the forces from outside add up to nothing, and what
//! is told agrees with weights, loads and drags that are known, eq. (traction.1).

use crate::contact_scenes::Scene;
use pseudopod::Vec3;
use pseudopod::experiment::{Compiled, Document, compile};
use pseudopod::mechanics::Force;
use pseudopod::sim::{
    AtomBalance, Kind, Model, NewCell, State, Workspace, add_cells, begin_chemistry, remove_cells, step,
};
use pseudopod::simulation::Simulation;

/// What the sum over a cell may leave, over the sum of the sizes: contacts carry forces of seven digits.
const LEFT: f64 = 1e-6;

/// Two cells that press each other and the floor, with what holds them (`contact`) and a scheme.
fn pair(contact: &str, integrator: &str) -> String {
    format!(
        "title = \"two cells on glass\"\n[run]\nuntil = \"100 s\"\nintegrator = {{ {integrator} }}\n[output]\nevery = \"50 s\"\ntractions = true\n\
         [[planes]]\nname = \"glass\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n\
         [environment]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-1 um/s^2\"]\n\
         [cells.left]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"0 um\", \"0 um\", \"5.02 um\"]] }}\n\
         mechanics = {{ drag = \"40 pN s/um\", mass = \"2 mg\", shape_memory = {{ shape_modulus = \"10 pN/um\" }} }}\n\
         loads = [{{ name = \"push\", all = true, direction = [1, 0.2, -0.5], force = \"20 pN\" }}]\n\
         [cells.right]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"9.9 um\", \"0 um\", \"5.02 um\"]] }}\n\
         mechanics = {{ drag = \"30 pN s/um\", mass = \"2 mg\", shape_memory = {{ shape_modulus = \"10 pN/um\" }} }}\n\
         loads = [{{ name = \"push\", all = true, direction = [-1, 0, -0.7], force = \"15 pN\" }}]\n{contact}"
    )
}

/// A cell that crawls, as in `experiments/motility`, on a coarser mesh.
fn crawler(contact: &str) -> String {
    format!(
        "title = \"a cell crawls\"\nseed = 3\n[run]\nuntil = \"100 s\"\nintegrator = {{ max_step = \"0.5 s\" }}\n[output]\nevery = \"50 s\"\ntractions = true\n\
         [[planes]]\nname = \"glass\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.cell]\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"0 um\", \"0 um\", \"5.05 um\"]] }}\n\
         [cells.cell.mechanics]\ndrag = \"500 pN s/um\"\n\
         membrane = {{ law = \"skalak\", shear = \"5 pN/um\", area = \"10 pN/um\", bending = \"2 pN um\", tension = \"10 pN/um\" }}\n\
         [cells.cell.pseudopods]\npressure = \"15 Pa\"\ncontraction = \"60 pN\"\npause = \"1 s\"\nprotrusion = \"4 s\"\nretraction = \"3 s\"\n\
         split = 1\nangle = \"10 deg\"\nspread = \"0 deg\"\n{contact}"
    )
}

fn built(text: &str) -> (Model, State) {
    let folder = std::path::Path::new(".");
    let document = Document::parse("tractions.toml", text, folder, &[]).unwrap_or_else(|error| panic!("{error}"));
    let Compiled { model, state, .. } = compile(&document).unwrap_or_else(|error| panic!("{error}"));
    (model, state)
}

/// The atoms of each cell, cell after cell.
fn cells<'a>(model: &'a Model, state: &'a State) -> impl Iterator<Item = &'a [AtomBalance]> {
    model.kinds.iter().zip(&state.kinds).flat_map(|(kind, now)| now.balance.chunks(kind.atoms()))
}

fn sum(atoms: &[AtomBalance], of: impl Fn(&AtomBalance) -> [f64; 3]) -> Vec3 {
    atoms.iter().map(|atom| Vec3::from(of(atom))).sum()
}

/// The most that is left over a cell, over the sum of the sizes.
fn left(model: &Model, state: &State) -> f64 {
    let of_cell = |atoms: &[AtomBalance]| {
        let size: f64 = atoms.iter().map(AtomBalance::size).sum();
        let left: Vec3 = atoms.iter().map(AtomBalance::left).sum();
        // A cell at rest has the drag of round-off alone.
        if size > 1e-9 { left.norm() / size } else { 0.0 }
    };
    cells(model, state).map(of_cell).fold(0.0, f64::max)
}

/// What cells do to each other in sum, over the sum of the sizes: action and reaction.
fn unanswered(model: &Model, state: &State) -> f64 {
    let all = || cells(model, state).flatten().map(|atom| Vec3::from(atom.of_cells));
    let size: f64 = all().map(|force| force.norm()).sum();
    if size > 0.0 { all().sum::<Vec3>().norm() / size } else { 0.0 }
}

/// What steps have shown at most.
#[derive(Debug, Default)]
struct Most {
    left: f64,
    unanswered: f64,
    /// Sum of the sizes of the forces on planes and on other cells, pN.
    on_planes: f64,
    on_cells: f64,
}

fn run(text: &str, until: f64) -> Most {
    let (model, mut state) = built(text);
    let mut ws = Workspace::new(&model);
    let mut most = Most::default();
    begin_chemistry(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    while state.time < until {
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        most.left = most.left.max(left(&model, &state));
        most.unanswered = most.unanswered.max(unanswered(&model, &state));
        let size = |of: fn(&AtomBalance) -> [f64; 3]| -> f64 {
            cells(&model, &state).flatten().map(|atom| Vec3::from(of(atom)).norm()).sum()
        };
        most.on_planes = most.on_planes.max(size(|atom| atom.traction));
        most.on_cells = most.on_cells.max(size(|atom| atom.of_cells));
    }
    most
}

const COHESION: &str = "[contact]\nstrength = \"2 pN/um^2\"\n[[contact.between]]\ntypes = [\"left\", \"glass\"]\nstrength = \"2 pN/um^2\"\n";
const BONDS: &str = "[contact]\nstrength = \"2 pN/um^2\"\nbonds = { density = \"2 /um^2\", on = \"2 /s\", off = \"0.2 /s\", force = \"0.2 pN\", start = 1 }\n\
     [[contact.between]]\ntypes = [\"left\", \"glass\"]\nstrength = \"2 pN/um^2\"\nshear_strength = \"0 Pa\"\nfriction = \"1 pN s/um^3\"\n";
const ADHESIVES: &str = "[contact]\nmodel = \"adhesives\"\nstrength = \"2 pN/um^2\"\nenergy = \"0.2 pN/um\"\n[[contact.between]]\ntypes = [\"left\", \"glass\"]\nstrength = \"2 pN/um^2\"\n";
const LINKS: &str = "[contact]\nmodel = \"links\"\nlink = \"0.2 pN/um\"\n";
const PENALTY: &str = "[contact]\nmodel = \"penalty\"\npenalty = \"50 pN/um\"\nstrength = \"0.5 pN/um^2\"\n";
const VIRTUAL: &str = "[contact]\nmodel = \"virtual_adhesives\"\nkappa = \"0.01 um\"\n[[contact.between]]\ntypes = [\"left\", \"glass\"]\nkappa = \"0.01 um\"\n";

#[test]
fn over_each_cell_the_forces_from_outside_add_up_to_nothing_under_every_law() {
    let (adaptive, fixed) = ("max_step = \"0.1 s\"", "step = \"0.01 s\"");
    let laws = [
        ("no contacts", "", adaptive),
        ("cohesion", COHESION, adaptive),
        ("bonds and friction", BONDS, adaptive),
        ("cohesion, first order", COHESION, "order = 1, step = \"0.02 s\""),
        ("cohesion, explicit", COHESION, "method = \"explicit\""),
        ("adhesives", ADHESIVES, adaptive),
        ("links", LINKS, adaptive),
        ("penalty", PENALTY, adaptive),
        ("virtual adhesives", VIRTUAL, fixed),
    ];
    for (law, contact, integrator) in laws {
        let most = run(&pair(contact, integrator), 2.0);
        println!("{law}: {most:?}");
        assert!(most.left < LEFT, "{law}: {most:?}");
        let glued = contact == VIRTUAL;
        assert!(most.unanswered < LEFT || glued, "{law}: what cells do to each other is answered: {most:?}");
        // Each stands on the floor with its weight and the load at least, which pushes 35 pN down in all.
        assert!(most.on_planes > 10.0, "{law}: they press the floor: {most:?}");
        assert_eq!(most.on_cells > 1.0, !contact.is_empty(), "{law}: they press each other: {most:?}");
    }
}

#[test]
fn the_forces_on_a_crawling_cell_add_up_to_nothing() {
    let glass = |more: &str| format!("[contact]\n{more}[[contact.between]]\ntypes = [\"cell\", \"glass\"]\n");
    let bonds =
        "bonds = { density = \"20 /um^2\", on = \"0.05 /s\", off = \"0.001 /s\", force = \"10 pN\", start = 1 }\n";
    let cohesive = format!("{}energy = \"10 pN/um\"\nrange = \"1.5 um\"\nshear_strength = \"100 Pa\"\n", glass(""));
    let laws = [
        ("nothing to grip", String::new()),
        ("cohesion", cohesive.clone()),
        ("bonds", cohesive.clone() + bonds),
        ("adhesives", glass("model = \"adhesives\"\n") + "strength = \"5 pN/um^2\"\n"),
    ];
    for (law, contact) in laws {
        let most = run(&crawler(&contact), 10.0);
        println!("{law}: {most:?}");
        assert!(most.left < LEFT, "{law}: {most:?}");
    }
}

#[test]
fn what_drops_that_stick_firmly_do_to_each_other_adds_up_to_their_drag() {
    let drop = |name: &str, x: f64| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"{x} um\", \"0.1 um\", \"0 um\"]] }}\n\
             [cells.{name}.mechanics]\ndrag = \"200 pN s/um\"\n\
             membrane = {{ law = \"neo_hookean\", shear = \"0 uN/m\", area = \"0 uN/m\", tension = \"100 uN/m\", ordering = \"2 uN/m\" }}\n"
        )
    };
    // Their steps are coupled, and what conjugate gradients leave of that counts for nobody.
    for integrator in ["max_step = \"0.1 s\"", "order = 1, step = \"0.0015 s\""] {
        let text = format!(
            "title = \"two drops\"\n[run]\nuntil = \"10 s\"\nintegrator = {{ {integrator} }}\n[output]\nevery = \"5 s\"\ntractions = true\n{}{}\
             [contact]\nstrength = \"200 pN/um^2\"\nshear_strength = \"0 Pa\"\nenergy = \"150 uN/m\"\n",
            drop("left", -5.02),
            drop("right", 5.02)
        );
        let most = run(&text, 0.5);
        println!("{most:?}");
        assert!(most.left < LEFT && most.unanswered < LEFT, "{integrator}: {most:?}");
        assert!(most.on_cells > 100.0, "{integrator}: {most:?}");
    }
}

#[test]
fn a_cell_at_rest_presses_the_plane_with_its_weight() {
    for contact in ["", "[contact]\n"] {
        let text = pair(contact, "max_step = \"1 s\"").replace("force = \"20 pN\"", "force = \"0 pN\"");
        let (model, mut state) =
            built(&text.replace("force = \"15 pN\"", "force = \"0 pN\"").replace("9.9 um", "30 um"));
        let mut ws = Workspace::new(&model);
        while state.time < 60.0 {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        for atoms in cells(&model, &state) {
            let (traction, drag) = (sum(atoms, |atom| atom.traction), sum(atoms, |atom| atom.drag));
            // 2 mg at 1 µm/s² are 2 pN.
            let weight = Vec3::new(0.0, 0.0, -2.0);
            assert!((sum(atoms, |atom| atom.outer) - weight).norm() < 1e-12, "it weighs 2 pN");
            // What it has not sunk yet is the drag, which is told apart.
            assert!((traction - weight - drag).norm() < LEFT * 2.0, "{contact}: {traction:?} {drag:?}");
            assert!(drag.norm() < 0.02 * weight.norm(), "{contact}: it rests: {drag:?}");
        }
    }
}

/// Torques about the middle of a cell, over the sum of the sizes of forces times arms: those of forces from outside.
fn twisted(kind: &Kind, positions: &[Vec3], atoms: &[AtomBalance]) -> f64 {
    let middle = positions.iter().sum::<Vec3>() / kind.atoms() as f64;
    let (mut torque, mut size) = (Vec3::zeros(), 0.0);
    for (x, atom) in positions.iter().zip(atoms) {
        torque += (x - middle).cross(&atom.left());
        size += (x - middle).norm() * atom.size();
    }
    torque.norm() / size
}

#[test]
fn the_forces_on_cells_at_rest_have_no_torque_so_that_each_is_told_where_it_acts() {
    // Pushed at each other and held by what they stick to. What a cell does to itself has no torque either, where it stands still.
    for (law, contact) in [("cohesion", COHESION), ("adhesives", ADHESIVES), ("penalty", PENALTY)] {
        let (model, mut state) = built(&pair(contact, "max_step = \"1 s\""));
        let mut ws = Workspace::new(&model);
        while state.time < 99.0 {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            let drag: f64 = now.balance.iter().map(|atom| Vec3::from(atom.drag).norm()).sum();
            let size: f64 = now.balance.iter().map(AtomBalance::size).sum();
            let twisted = twisted(kind, &now.cell(kind, 0), &now.balance);
            println!("{law}: torque {twisted}, drag {} of all forces", drag / size);
            // What still moves: the implicit step answers as much of the forces as the drag takes, by a stiffness that knows no turns.
            assert!(twisted < LEFT + drag / size, "{law}: {twisted}, drag {}", drag / size);
        }
    }
}

#[test]
fn a_cell_that_is_pulled_through_the_medium_feels_its_drag_and_nothing_else() {
    let text = pair("", "max_step = \"0.1 s\"").replace("5.02 um", "50 um").replace("-1 um/s^2", "0 um/s^2");
    let (model, mut state) = built(&text);
    let mut ws = Workspace::new(&model);
    for _ in 0..5 {
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    let (atoms, kind) = (&state.kinds[0].balance, &model.kinds[0]);
    let load = 20.0 * Vec3::new(1.0, 0.2, -0.5).normalize();
    assert!((sum(atoms, |atom| atom.outer) - load).norm() < 1e-12 * load.norm());
    assert!((sum(atoms, |atom| atom.drag) + load).norm() < 1e-9 * load.norm());
    // Stokes: the drag of all atoms over the speed.
    let drag = kind.drag * kind.atoms() as f64 * Vec3::from(state.kinds[0].mean_velocities[0]);
    assert!((drag - load).norm() < 1e-9 * load.norm(), "{drag:?}");
    assert!(atoms.iter().all(|atom| atom.traction == [0.0; 3] && atom.of_cells == [0.0; 3]));
}

#[test]
fn masses_have_inertia_in_the_balance() {
    for method in ["euler", "semi_implicit_euler", "verlet", "runge_kutta_4"] {
        let integrator = format!("method = \"{method}\", step = \"2 ms\"");
        let free = pair("", &integrator).replace("5.02 um", "50 um");
        let most = run(&free, 0.1);
        println!("{method}, free: {most:?}");
        assert!(most.left < LEFT, "{method}: {most:?}");
        let (model, mut state) = built(&free);
        step(&model, &mut state, &mut Workspace::new(&model)).unwrap_or_else(|trouble| panic!("{trouble}"));
        // At first there is no drag but what the step itself brings, by dt·ζ/m: all is inertia.
        let atoms = &state.kinds[0].balance;
        let (outer, inertia) = (sum(atoms, |atom| atom.outer), sum(atoms, |atom| atom.inertia));
        let share = 2e-3 * model.kinds[0].drag / model.kinds[0].mass;
        assert!((outer - inertia).norm() <= share * outer.norm(), "{method}: {outer:?} {inertia:?}");
        let most = run(&pair("", &integrator), 0.4);
        println!("{method}, on the floor: {most:?}");
        assert!(most.left < LEFT && most.on_planes > 1.0, "{method}: {most:?}");
    }
}

#[test]
fn keeping_tractions_changes_no_bit() {
    let with = pair(BONDS, "max_step = \"0.1 s\"");
    let ends = [with.clone(), with.replace("tractions = true\n", "")].map(|text| {
        let (model, mut state) = built(&text);
        let mut ws = Workspace::new(&model);
        for _ in 0..20 {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        assert_eq!(state.kinds[0].balance.is_empty(), !model.keeps_tractions);
        state.kinds.iter_mut().for_each(|now| now.balance.clear());
        state
    });
    assert!(ends[0] == ends[1]);
}

#[test]
fn tractions_go_with_their_cells() {
    let (model, mut state) = built(&pair(COHESION, "max_step = \"0.1 s\""));
    let mut ws = Workspace::new(&model);
    for _ in 0..5 {
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    let before = state.clone();
    let positions = model.kinds[0].rest.positions.iter().map(|x| x + Vec3::new(0.0, 40.0, 6.0)).collect();
    let new = NewCell { positions, parent: None };
    let ids = add_cells(&model, &mut state, &mut ws, 0, &[new]).unwrap_or_else(|trouble| panic!("{trouble}"));
    let atoms = model.kinds[0].atoms();
    assert_eq!(state.kinds[0].balance[..atoms], before.kinds[0].balance[..]);
    assert!(state.kinds[0].balance[atoms..].iter().all(|atom| *atom == AtomBalance::NONE), "it did nothing yet");
    step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    assert!(left(&model, &state) < LEFT);
    let of_new = state.kinds[0].balance[atoms..].to_vec();
    remove_cells(&model, &mut state, &mut ws, &[0]).unwrap_or_else(|trouble| panic!("{trouble}"));
    assert_eq!((state.kinds[0].balance.clone(), ids), (of_new, vec![2]));
    step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    assert!(left(&model, &state) < LEFT);
}

#[test]
fn the_forces_of_random_scenes_add_up_to_nothing() {
    let (mut looked, mut most): (usize, f64) = (0, 0.0);
    for seed in 0..40 {
        let (mut model, mut state) = Scene::draw(seed).build();
        model.keeps_tractions = true;
        // What an attraction takes back of what contacts move in a step is not told; and what holds atoms is told so that the sum is nothing.
        let attracts = |force: &Force| matches!(force, Force::Attraction(_));
        let is_told = |kind: &Kind| !kind.is_held() && !kind.forces.iter().any(attracts);
        if !model.kinds.iter().all(is_told) || model.integrator.method.is_inertial() {
            continue;
        }
        let mut ws = Workspace::new(&model);
        for _ in 0..30 {
            if step(&model, &mut state, &mut ws).is_err() {
                break;
            }
            let left = left(&model, &state);
            most = most.max(left);
            assert!(left < LEFT, "seed {seed}: {left}");
            looked += 1;
        }
    }
    println!("{looked} steps, {most}");
    assert!(looked > 300, "{looked}");
}

#[test]
fn a_membrane_reads_what_its_atoms_do() {
    let folder = tempfile::tempdir().unwrap();
    let skin = r#"<eml name="skin" level="membrane"><input id="pull" default="0" level="membrane"/><variable id="a" initial="1" rate="0"/>
        <integral id="all">pull</integral><link from="cell.atoms.traction" to="system.pull"/></eml>"#;
    std::fs::write(folder.path().join("skin.eml"), skin).unwrap();
    let text = pair("", "max_step = \"0.1 s\"").replace("tractions = true\n", "");
    let text = text.replace("[cells.left]\n", "[cells.left]\nchemistry = [\"skin\"]\n")
        + "[chemistry.skin]\ndocument = \"skin.eml\"\n";
    let path = folder.path().join("pair.toml");
    std::fs::write(&path, text).unwrap();
    let mut simulation = Simulation::from_file(&path).unwrap_or_else(|error| panic!("{error}"));
    let series =
        |simulation: &Simulation, name: &str| simulation.series(name).unwrap_or_else(|error| panic!("{error}"))[0];
    assert_eq!(series(&simulation, "skin.all"), 0.0, "nothing before the first step");
    // Until shapes stand still: an integral is as old as the step that it was taken in, and tractions are read where that ends.
    simulation.run_until(40.0).unwrap_or_else(|error| panic!("{error}"));
    let [read, total] = ["skin.all", "traction_total"].map(|name| series(&simulation, name));
    // The area of an atom is that of the surface that the integral is over.
    assert!(total > 1.0 && (read - total).abs() < 1e-6 * total, "{read} {total}");
    let down = series(&simulation, "traction_z");
    assert!(down < -1.0, "it presses the floor: {down}");
}
