//! Contacts in the step against what is known without them: forces of the right size, nothing gained, nothing lost.

use pseudopod::Vec3;
use pseudopod::contact::Reach;
use pseudopod::geometry::{Topology, icosphere, mean_edge_length};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::random::{Purpose, Stream};
use pseudopod::sim::contact::{ContactModel, Pull, Row, Strength, check_passed, help_at};
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{Kind, Model, State, Trouble, VolumeRule, Workspace, step};

/// Radius of the cells, µm.
const RADIUS: f64 = 5.0;

/// A cell of 42 atoms with the drag of 20 pN s/µm.
fn cell(name: &str, stiffness: f64) -> Kind {
    let rest = icosphere(RADIUS, 1);
    let topology = Topology::of(&rest);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let energy = stiffness * mean_edge_length(&rest).powi(2);
    let memory = ShapeMemory::new(&rest.positions, &rings, stiffness, Reaction::Exact);
    let barrier = Barrier::new(&rest.positions, &rest.facets, &topology.flaps, BarrierRules::with_energy(energy));
    let mut kind = Kind::new(name, rest, vec![Force::ShapeMemory(memory), Force::Barrier(barrier)]);
    kind.drag = 20.0 / 42.0;
    kind
}

/// A load on all atoms alike.
fn load(direction: Vec3, force: &[(f64, f64)]) -> Force {
    let atoms = (0..42).map(|atom| (atom, 1.0 / 42.0)).collect();
    let force = Course::through(force.to_vec()).expect("times that rise");
    Force::Load(Load::new("load", atoms, direction, force))
}

fn adaptive(largest: f64) -> Integrator {
    Integrator {
        method: Method::Implicit { order: Order::Second },
        size: StepSize::Adaptive { tolerance: 1e-3, largest },
    }
}

fn reach(edge: f64) -> Reach {
    let near = 0.1 * edge;
    Reach { proximity: near, prediction: near, depth: near, margin: near }
}

/// A model of these kinds in which all stick with a strength.
fn model(mut kinds: Vec<Kind>, integrator: Integrator, until: f64, strength: Strength) -> Model {
    for kind in &mut kinds {
        kind.largest_stiffness = kind.measure_largest_stiffness();
        kind.bound_stiffness();
    }
    let mut contact = ContactModel::new(&kinds, &[], reach(kinds[0].edge));
    (0..kinds.len()).for_each(|one| (0..kinds.len()).for_each(|other| contact.stick(one, other, strength)));
    Model { contact: Some(contact), ..Model::of(kinds, integrator, until) }
}

/// Cells of a kind at centres.
fn atoms_at(kind: &Kind, centres: &[Vec3]) -> Vec<Vec<Vec3>> {
    centres.iter().map(|centre| kind.rest.positions.iter().map(|x| x + centre).collect()).collect()
}

/// A run and what is asked after each step.
fn run<T>(model: &Model, state: &mut State, mut row: impl FnMut(&State, &Workspace) -> T) -> Vec<(f64, T)> {
    let mut ws = Workspace::new(model);
    let mut rows = Vec::new();
    while state.time < model.until {
        step(model, state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        rows.push((state.time, row(state, &ws)));
    }
    rows
}

/// Force of all contacts on the cells from atom `first` on, pN.
fn force_from(ws: &Workspace, first: u32) -> Vec3 {
    let of_row = |(row, pull): (&Row, &Pull)| -> Vec3 {
        let own = row.atoms.iter().zip(row.weights()).filter(|(atom, _)| **atom >= first);
        own.map(|(_, weight)| weight * pull.force()).sum()
    };
    ws.contact.rows.iter().zip(&ws.contact.pulls).map(of_row).sum()
}

const GLUE: Strength = Strength { tensile: 1e3, shear: 1e3, energy: 0.0 };

#[test]
fn a_cell_that_hangs_on_a_rigid_one_is_held_with_its_load_whatever_the_step() {
    // It is pressed on for 20 s and then pulled: the contacts must carry exactly the load, in every direction.
    for largest in [0.05, 0.4] {
        for direction in [Vec3::z(), Vec3::new(0.6, 0.0, 0.8)] {
            let mut rigid = cell("rigid", 5.0);
            (rigid.held, rigid.volume) = (vec![0.0; 126], VolumeRule::Free);
            let mut soft = cell("soft", 5.0);
            soft.forces.push(load(direction, &[(0.0, -8.0), (20.0, -8.0), (21.0, 8.0), (160.0, 8.0)]));
            let model = model(vec![rigid, soft], adaptive(largest), 160.0, GLUE);
            let centres = [Vec3::zeros(), Vec3::new(0.0, 0.0, 2.0 * RADIUS + 0.1)];
            let mut state = State::new(&model, &[0, 1].map(|i| atoms_at(&model.kinds[i], &centres[i..=i])));
            let rows = run(&model, &mut state, |_, ws| force_from(ws, 42));
            let (_, end) = rows.last().unwrap();
            assert!((end + 8.0 * direction).norm() < 8e-3, "{largest}: {end:?}");
        }
    }
}

/// A square sheet of 6 µm, its sides in so many parts, and its area an atom.
fn sheet(name: &str, side: f64, parts: u32) -> (Kind, Vec<f64>) {
    let rest = pseudopod::geometry::sheet(side, side, parts, parts);
    let areas = pseudopod::geometry::atom_areas(&rest);
    let topology = Topology::of(&rest);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let memory = ShapeMemory::new(&rest.positions, &rings, 5.0, Reaction::Exact);
    let mut kind = Kind::new(name, rest, vec![Force::ShapeMemory(memory)]);
    kind.drag = 0.5;
    (kind, areas)
}

/// The largest pull between two flat sheets that are drawn apart, pN; the sides of the rigid one have so many parts.
fn sheets_part_at(tensile: f64, largest: f64, parts: u32) -> f64 {
    let ((mut rigid, own), (mut soft, areas)) = (sheet("rigid", 6.0, parts), sheet("soft", 6.0, 6));
    rigid.held = vec![0.0; 3 * own.len()];
    let atoms = areas.iter().zip(0..).map(|(area, atom)| (atom, area / 36.0)).collect();
    let force = Course::through(vec![(0.0, 0.0), (100.0, 60.0)]).unwrap();
    soft.forces.push(Force::Load(Load::new("pull", atoms, Vec3::z(), force)));
    // At 1e-3 a rim may go 2 % early.
    let size = StepSize::Adaptive { tolerance: 2e-4, largest };
    let steps = Integrator { size, ..adaptive(largest) };
    let model = model(vec![rigid, soft], steps, 100.0, Strength { tensile, shear: 0.0, energy: 0.0 });
    let atoms_at = [(0, 0.0), (1, 0.02)].map(|(kind, height)| {
        let shifted = |x: &Vec3| x + Vec3::new(0.0, 0.0, height);
        vec![model.kinds[kind].rest.positions.iter().map(shifted).collect()]
    });
    let mut state = State::new(&model, &atoms_at);
    let rows = run(&model, &mut state, |_, ws| -force_from(ws, own.len() as u32).z);
    assert_eq!(rows.last().unwrap().1, 0.0, "they are apart in the end");
    rows.into_iter().map(|(_, force)| force).fold(0.0, f64::max)
}

#[test]
fn flat_sheets_part_at_strength_times_area_whatever_the_step() {
    for (tensile, largest, parts) in [(0.5, 0.5, 6), (0.5, 0.05, 6), (1.0, 0.5, 6), (0.5, 0.5, 4), (0.5, 0.5, 9)] {
        let pull = sheets_part_at(tensile, largest, parts);
        println!("{tensile} pN/um2, steps to {largest} s, {parts} parts: {pull} pN");
        // With another mesh the pull on the rigid sheet's atoms does not spread as the load does: the rim parts first.
        let share = if parts == 6 { 0.01 } else { 0.05 };
        assert!((pull - 36.0 * tensile).abs() < share * 36.0 * tensile, "{tensile}, {largest}, {parts}: {pull} pN");
    }
}

/// What sweeps leave puts atoms on the other side of a surface that has two, by next to nothing; they must not go on there.
#[test]
fn a_sheet_pressed_onto_another_stays_on_its_side() {
    for (is_first, parts) in [(false, 5), (true, 5), (false, 8), (false, 11)] {
        let ((mut rigid, own), (mut soft, areas)) = (sheet("rigid", 8.0, parts), sheet("soft", 6.0, 6));
        rigid.held = vec![0.0; 3 * own.len()];
        let atoms = areas.iter().zip(0..).map(|(area, atom)| (atom, area / 36.0)).collect();
        let force = Course::through(vec![(0.0, 0.0), (50.0, 60.0)]).unwrap();
        soft.forces.push(Force::Load(Load::new("press", atoms, -Vec3::z(), force)));
        let above: Vec<Vec3> = soft.rest.positions.iter().map(|x| x + Vec3::new(0.013, 0.007, 0.02)).collect();
        let (mut kinds, mut atoms_at) = (vec![rigid.clone(), soft], vec![vec![rigid.rest.positions], vec![above]]);
        if is_first {
            kinds.reverse();
            atoms_at.reverse();
        }
        let (model, number) = (model(kinds, adaptive(0.5), 50.0, Strength::default()), usize::from(!is_first));
        let mut state = State::new(&model, &atoms_at);
        let lowest = |state: &State| {
            let atoms = state.kinds[number].cell(&model.kinds[number], 0);
            atoms.iter().map(|x| x.z).fold(f64::INFINITY, f64::min)
        };
        let rows = run(&model, &mut state, |state, _| lowest(state));
        let worst = rows.iter().map(|(_, lowest)| *lowest).fold(f64::INFINITY, f64::min);
        println!("{parts} parts: {} steps, lowest {worst:.2e} um", rows.len());
        // They rest on the skin of each other, of a twentieth of the prediction: far more than sweeps leave.
        assert!(worst > 0.0, "{parts} parts: {worst} um below");
    }
}

/// The largest pull between two cells that were pressed together for 20 s and then drawn apart, pN, and what the
/// contacts could bear then by their tension.
fn parting(tensile: f64, shear: f64, largest: f64) -> (f64, f64) {
    let mut pair = [cell("left", 5.0), cell("right", 5.0)];
    let course = [(0.0, 10.0), (20.0, 10.0), (21.0, 0.0), (121.0, -50.0)];
    pair[0].forces.push(load(Vec3::x(), &course));
    pair[1].forces.push(load(-Vec3::x(), &course));
    let model = model(pair.into(), adaptive(largest), 121.0, Strength { tensile, shear, energy: 0.0 });
    let centres = [-1.0, 1.0].map(|side| Vec3::new(side * (RADIUS + 0.1), 0.0, 0.0));
    let mut state = State::new(&model, &[0, 1].map(|i| atoms_at(&model.kinds[i], &centres[i..=i])));
    let rows = run(&model, &mut state, |_, ws| {
        let bears: f64 = ws.contact.rows.iter().map(|row| f64::from(row.least) * row.normal().x.abs()).sum();
        (-force_from(ws, 42).x, -bears)
    });
    assert_eq!(rows.last().unwrap().1.0, 0.0, "they are apart in the end");
    rows.into_iter().map(|(_, row)| row).max_by(|one, other| one.0.total_cmp(&other.0)).unwrap()
}

#[test]
fn a_pair_parts_at_its_strength_and_not_at_its_step() {
    // What is left of the contact, once the cells that round up have peeled it off, bears all it can.
    let (weak, bears) = parting(0.2, 0.0, 0.1);
    for largest in [0.2, 0.025] {
        let (other, of) = parting(0.2, 0.0, largest);
        println!("steps to {largest} s: {other} of {of}, {weak} of {bears} pN with 0.1 s");
        assert!((other / of - 1.0).abs() < 0.01 && (other / weak - 1.0).abs() < 0.01, "{other} of {of}, {weak} pN");
    }
    let (strong, bears) = parting(0.6, 0.0, 0.1);
    println!("{strong} of {bears}");
    assert!(strong > 2.0 * weak, "{weak} and {strong} pN");
    // Contacts that are pulled askew bear by their shear strength, too, and how askew the last ones are hangs on the steps.
    for largest in [0.1, 0.025] {
        let (joined, bears) = parting(0.2, 0.2, largest);
        println!("with shear, steps to {largest} s: {joined} of {bears}");
        assert!(joined > 0.95 * bears && joined < 2f64.sqrt() * bears, "{joined} of {bears} pN");
    }
}

/// Two cells that were squeezed and pressed together, left alone.
fn squeezed_pair(strength: f64, largest: f64) -> (Model, State) {
    let kind = cell("cell", 5.0).for_cells(2);
    let model =
        model(vec![kind], adaptive(largest), 40.0, Strength { tensile: strength, shear: strength, energy: 0.0 });
    let squeeze = |x: &Vec3| Vec3::new(0.8 * x.x, 1.1 * x.y, 1.1 * x.z + 0.1 * x.x);
    let half = model.kinds[0].rest.positions.iter().map(|x| squeeze(x).x).fold(0.0, f64::max) + 0.05;
    let cells = [-1.0, 1.0].map(|side| {
        model.kinds[0].rest.positions.iter().map(|x| squeeze(x) + Vec3::new(side * half, 0.0, 0.0)).collect()
    });
    let state = State::new(&model, &[cells.into()]);
    (model, state)
}

#[test]
fn a_pair_left_alone_gains_neither_energy_nor_momentum() {
    for (strength, largest) in [(0.0, 0.5), (0.1, 0.5), (100.0, 0.5), (100.0, 0.05)] {
        let (model, mut state) = squeezed_pair(strength, largest);
        let rows = run(&model, &mut state, |state, _| {
            let cells = measure_cells(&model, state);
            let all = || cells.iter().flat_map(|cell| &cell.positions);
            let centre: Vec3 = all().sum::<Vec3>() / 84.0;
            (cells.iter().map(|cell| cell.energy).sum::<f64>() + state.contact.stored(), centre)
        });
        let start = rows[0].1;
        let mut worst: f64 = 0.0;
        // What the sweeps leave open is 1e-4 of an edge, or 2e-7 pN um in a spring of 5 pN/um: a few of them at most.
        // The first step restores the volumes, which the squeezing changed.
        for pair in rows.windows(2).skip(1) {
            let [(time, (before, _)), (_, (after, _))] = [pair[0], pair[1]];
            worst = worst.max((after - before) / start.0);
            assert!(after <= before + 1e-7 * start.0, "{strength}, {largest}: {before} to {after} at {time}");
        }
        println!(
            "{strength}, {largest}: energy {} to {}, rises by {worst:.1e} of it at most",
            start.0,
            rows.last().unwrap().1.0
        );
        let drift = (rows.last().unwrap().1.1 - start.1).norm();
        assert!(drift < 1e-11, "{strength}, {largest}: the pair drifts by {drift}");
    }
}

#[test]
fn a_fixed_step_in_which_a_pair_would_gain_energy_is_made_in_shorter_ones_that_end_where_it_would() {
    // They relax until no atom would go too far in a fixed step, which is still long beside what they relax in.
    let shortened: usize = [(0.75, 4.0), (1.5, 6.0), (4.0, 6.0), (4.0, 9.0)]
        .map(|(whole, from)| shortened_steps(squeezed_pair(0.5, 0.5), whole, from))
        .iter()
        .sum();
    assert!(shortened > 0, "a test of nothing");
}

#[test]
fn loads_that_are_zero_change_nothing_of_that() {
    let (mut model, state) = squeezed_pair(0.5, 0.5);
    model.kinds[0].forces.push(load(Vec3::x(), &[(0.0, 0.0), (40.0, 0.0)]));
    assert!(shortened_steps((model, state), 4.0, 6.0) > 0, "a test of nothing");
}

/// Lets a squeezed pair relax in fixed steps from a time on (s), none of which may gain energy; returns how many were made shorter.
fn shortened_steps((mut model, mut state): (Model, State), whole: f64, from: f64) -> usize {
    let mut ws = Workspace::new(&model);
    while state.time < from {
        step(&model, &mut state, &mut ws).unwrap();
    }
    let start = state.time;
    model.integrator.size = StepSize::Fixed(whole);
    state.next_step = 0.0;
    let (mut shortened, mut before) = (0, f64::INFINITY);
    while state.time < 30.0 {
        let report = step(&model, &mut state, &mut ws).unwrap();
        let energy = measure_cells(&model, &state).iter().map(|cell| cell.energy).sum::<f64>() + state.contact.stored();
        // A step may gain 1e-9 of the energy by round-off, and what its sweeps leave.
        assert!(energy <= before * (1.0 + 1e-8), "{before} to {energy} at {} s", state.time);
        before = energy;

        shortened += usize::from(report.limited && report.dt < whole);
        if report.dt == whole {
            let steps = (state.time - start) / whole;
            assert!((steps - steps.round()).abs() < 1e-9, "a whole step ends at {} s", state.time);
        }
    }
    shortened
}

/// Cells gathered by a pull to the middle, in a random start without overlaps.
fn gathered(seed: u64, cells: usize, pull: f64, strength: Strength) -> (Model, State) {
    let mut kind = cell("cell", 5.0);
    kind.forces.push(Force::Attraction(Attraction { to: Vec3::zeros(), stiffness: pull }));
    let model = model(vec![kind.for_cells(cells)], adaptive(1.0), f64::INFINITY, strength);
    let mut dice = Stream::new(seed, Purpose::Placement, 0, 0);
    let mut centres: Vec<Vec3> = Vec::new();
    while centres.len() < cells {
        let ([x, y], [z, _]) = (dice.uniform_pair(), dice.uniform_pair());
        let position = (Vec3::new(x, y, z) - Vec3::repeat(0.5)) * 40.0;
        if centres.iter().all(|other| (other - position).norm() > 2.0 * RADIUS + 0.3) {
            centres.push(position);
        }
    }
    let state = State::new(&model, &[atoms_at(&model.kinds[0], &centres)]);
    (model, state)
}

#[test]
fn packed_cells_keep_their_volumes_and_stay_out_of_each_other() {
    let strengths = [(0.0, 0.0), (0.1, 0.1), (5.0, 5.0), (5.0, 0.0)];
    for (seed, (tensile, shear)) in strengths.into_iter().enumerate() {
        let (mut model, mut state) = gathered(seed as u64 + 1, 12, 0.04, Strength { tensile, shear, energy: 0.0 });
        model.until = 60.0;
        let edge = model.kinds[0].edge;
        let mut deepest: f64 = 0.0;
        let mut ws = Workspace::new(&model);
        while state.time < model.until {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{tensile}, {shear}: {trouble}"));
            deepest = deepest.min(ws.contact.found.smallest_gap());
            for cell in measure_cells(&model, &state) {
                assert!(cell.volume_error.abs() < 1e-10, "{tensile}, {shear}: volume off by {}", cell.volume_error);
                // The barrier against collapse begins at 0.2 and is steep at half of that.
                assert!(cell.smallest_facet > 0.1, "{tensile}, {shear}: a facet shrinks to {}", cell.smallest_facet);
            }
        }
        println!(
            "{tensile}, {shear}: deepest {:.4} edges, {} steps, {} contacts",
            -deepest / edge,
            state.step,
            ws.contact.rows.len()
        );
        assert!(-deepest < 0.02 * edge, "{tensile}, {shear}: inside by {:.3} edges", -deepest / edge);
        assert!(ws.contact.found.atoms.len() > 60, "they did gather: {}", ws.contact.found.atoms.len());
    }
}

#[test]
fn contacts_are_state_and_nothing_else_is() {
    let run = |threads: usize, before: &(dyn Fn(&Model, &mut State, &mut Workspace) + Sync)| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (model, mut state) = gathered(3, 12, 0.04, Strength { tensile: 0.3, shear: 0.2, energy: 0.0 });
            let mut ws = Workspace::new(&model);
            for _ in 0..250 {
                before(&model, &mut state, &mut ws);
                step(&model, &mut state, &mut ws).unwrap();
            }
            assert!(state.contact.atoms.len() > 30);
            state
        })
    };
    let plain = run(1, &|_, _, _| ());
    assert_eq!(plain, run(2, &|_, _, _| ()), "threads");
    assert_eq!(plain, run(1, &|model, _, ws| ws.poison(model)), "scratch");
    let saved = run(2, &|model, state, ws| {
        let bytes = postcard::to_stdvec(&*state).unwrap();
        *state = postcard::from_bytes(&bytes).unwrap();
        *ws = Workspace::new(model);
    });
    assert_eq!(plain, saved, "checkpoints");
}

#[test]
fn cells_inside_each_other_are_seen_whatever_their_contacts_say() {
    let kind = cell("cell", 5.0).for_cells(3);
    let model = model(vec![kind], adaptive(0.1), 1.0, GLUE);
    let at = |x: f64| {
        let centres = [Vec3::zeros(), Vec3::new(30.0, 0.0, 0.0), Vec3::new(30.0 + x, 0.0, 0.0)];
        check_passed(&model, &State::new(&model, &[atoms_at(&model.kinds[0], &centres)]))
    };
    assert_eq!(at(2.0 * RADIUS), Ok(()), "side by side");
    // Far deeper than contacts are found.
    for x in [0.5 * RADIUS, 1.5 * RADIUS] {
        let Err(Trouble::Pressed { cells, depth, .. }) = at(x) else { panic!("{x} um apart is not seen") };
        assert_eq!(cells.map(|(_, cell)| cell), [1, 2]);
        assert!(depth > model.contact.as_ref().unwrap().reach.depth, "{depth}");
    }
}

#[test]
fn contacts_that_do_not_come_to_rest_end_a_run_name_the_cells_and_leave_the_state() {
    let mut pair = [cell("left", 5.0), cell("right", 5.0)];
    pair[0].forces.push(load(Vec3::x(), &[(0.0, 10.0), (10.0, 10.0)]));
    pair[1].forces.push(load(-Vec3::x(), &[(0.0, 10.0), (10.0, 10.0)]));
    let mut model = model(pair.into(), adaptive(0.1), 10.0, Strength::default());
    let centres = [-1.0, 1.0].map(|side| Vec3::new(side * (RADIUS + 0.1), 0.0, 0.0));
    let mut state = State::new(&model, &[0, 1].map(|i| atoms_at(&model.kinds[i], &centres[i..=i])));
    let mut ws = Workspace::new(&model);
    while state.time < 5.0 {
        step(&model, &mut state, &mut ws).unwrap();
    }
    // From here on a single sweep would have to find all forces, to the last digit.
    let contact = model.contact.as_mut().unwrap();
    (contact.most_sweeps, contact.tolerance) = (1, 0.0);
    let before = state.clone();
    let trouble = step(&model, &mut state, &mut ws).expect_err("no step can rest");
    assert_eq!(state, before, "the last good state is kept");
    let Trouble::Contact { cells, sweeps, left, .. } = &trouble else { panic!("{trouble}") };
    let mut named: Vec<&str> = cells.iter().map(|(kind, _)| kind.as_str()).collect();
    named.sort_unstable();
    assert_eq!((named, *sweeps), (vec!["left", "right"], 1));
    assert!(*left > 0.0);
    let help = help_at(&trouble, &model, &state);
    assert!(help.starts_with("nothing presses these cells together from around"), "two cells in the open: {help}");
    let cells = [("left", 0), ("right", 0)].map(|(kind, cell)| (kind.to_owned(), cell));
    let words = Trouble::Contact { cells, time: 1.5, left: 2e-4, sweeps: 200 }.to_string();
    let expected = "contacts and volumes do not come to rest at t = 1.500000 s: after 200 sweeps atoms of cell 0 of type `left` \
                    and of cell 0 of type `right`, which touch, still move by 2.0e-4 um";
    assert_eq!(words, expected);
}

#[test]
fn the_help_for_contacts_that_fail_fits_what_the_cells_look_like() {
    let advice = |model: &Model, state: &State| {
        let cells = [("left".to_owned(), 0), ("right".to_owned(), 0)];
        help_at(&Trouble::Pressed { cells, time: 0.0, depth: 0.1 }, model, state)
    };
    let kinds = || vec![cell("left", 5.0), cell("right", 5.0)];
    let centres = [-1.0, 1.0].map(|side| Vec3::new(side * (RADIUS + 0.1), 0.0, 0.0));
    let model = model(kinds(), adaptive(0.1), 10.0, Strength::default());
    let apart = |centres: &[Vec3]| [0, 1].map(|i| atoms_at(&model.kinds[i], &centres[i..=i]));
    let open = advice(&model, &State::new(&model, &apart(&centres)));
    assert!(open.contains("move or yield faster than contacts follow"), "{open}");
    // An atom is pushed through to the other side of its cell.
    let mut folded = apart(&centres);
    folded[1][0][0] = 2.0 * centres[1] - folded[1][0][0];
    let folded = State::new(&model, &folded);
    let folded = advice(&model, &folded);
    assert!(folded.starts_with("the surface of one of these cells is folded"), "{folded}");
    // Nearly at the same place each has the other everywhere.
    let crowded = advice(&model, &State::new(&model, &apart(&[Vec3::zeros(), Vec3::new(0.05, 0.0, 0.0)])));
    assert!(crowded.starts_with("cells are pressed together harder than their volumes allow"), "{crowded}");
}

#[test]
fn a_cell_too_deep_in_itself_is_told_once() {
    let cells = ["cell", "cell"].map(|name| (name.to_owned(), 3));
    let words = Trouble::Pressed { cells, time: 1.5, depth: 0.25 }.to_string();
    let expected = "cell 3 of type `cell` is at least 2.5e-1 um deep in itself or behind a plane at t = 1.500000 s, more than contacts can mend";
    assert_eq!(words, expected);
}

#[test]
fn explicit_steps_press_as_implicit_ones_do() {
    let (mut rigid, mut soft) = (cell("rigid", 5.0), cell("soft", 5.0));
    (rigid.held, rigid.volume) = (vec![0.0; 126], VolumeRule::Free);
    soft.forces.push(load(-Vec3::z(), &[(0.0, 8.0), (160.0, 8.0)]));
    let integrator = Integrator { method: Method::Explicit, size: StepSize::Fixed(5e-3) };
    let model = model(vec![rigid, soft], integrator, 160.0, GLUE);
    let centres = [Vec3::zeros(), Vec3::new(0.0, 0.0, 2.0 * RADIUS + 0.1)];
    let mut state = State::new(&model, &[0, 1].map(|i| atoms_at(&model.kinds[i], &centres[i..=i])));
    let (_, end) = *run(&model, &mut state, |_, ws| force_from(ws, 42)).last().unwrap();
    // Sweeps end when they move nothing by more than 1e-4 edges; in a step so short that is this force on an atom.
    let open = 1e-4 * model.kinds[1].edge * model.kinds[1].drag / 5e-3;
    assert!((end - 8.0 * Vec3::z()).norm() < open, "{end:?}");
}
