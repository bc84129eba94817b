//! Bonds that close and open under the cohesive law: shares of surfaces that stand still, loads at which bonds let go, what load along the
//! surface and friction do to them, energy, and that threads and pauses change nothing.

use pseudopod::Simulation;
use pseudopod::sim::contact::{Faced, energy_of_law, find_contacts};
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{State, Workspace, step};

fn simulation(text: &str) -> Simulation {
    Simulation::from_text("bonds.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn run(simulation: &mut Simulation, until: f64) {
    simulation.run_until(until).unwrap_or_else(|error| panic!("{error}"));
}

fn value(simulation: &Simulation, name: &str) -> f64 {
    simulation.series(name).unwrap_or_else(|error| panic!("{error}"))[0]
}

const FLOOR: &str = "[[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n";

/// A sheet of 4 x 4 µm that is held at a height (µm) over a floor; σ = 2 pN/µm², δ = 2 µm, ten bonds a µm².
fn held(height: f64, step: f64, bonds: &str) -> String {
    format!(
        "title = \"A sheet over a floor\"\n[run]\nuntil = \"6 s\"\nintegrator = {{ step = \"{step} s\" }}\n{FLOOR}[cells.sheet]\n\
         mesh = {{ shape = \"sheet\", size = [\"4 um\", \"4 um\"], divisions = [3, 3] }}\n\
         placement = {{ at = [[\"0 um\", \"0 um\", \"{height} um\"]] }}\nfixed = [{{ all = true }}]\n[cells.sheet.mechanics]\n\
         drag = \"20 pN s/um\"\nmembrane = {{ law = \"skalak\", shear = \"20 pN/um\", area = \"40 pN/um\", bending = \"1 pN um\" }}\n\
         [contact]\nstrength = \"0 Pa\"\n[[contact.between]]\ntypes = [\"sheet\", \"floor\"]\nstrength = \"2 pN/um^2\"\nenergy = \"2 pN/um\"\n\
         bonds = {{ density = \"10 /um^2\", {bonds} }}\n[output]\nevery = \"1 s\"\n"
    )
}

#[test]
fn a_surface_that_stands_still_has_the_bonds_of_the_exponential_whatever_the_step() {
    const KINETICS: &str =
        "on = \"0.7 /s\", off = \"0.2 /s\", force = \"0.1 pN\", catch = { off = \"0.4 /s\", force = \"0.2 pN\" }";
    for height in [0.4, 1.0, 1.7] {
        // Each bond of σ/n0 = 0.2 pN at most bears its share by the tent.
        let load = 0.2 * 2.0 * f64::min(0.5 * height, 1.0 - 0.5 * height);
        let rate = 0.7 + 0.2 * (load / 0.1_f64).exp() + 0.4 * (-load / 0.2_f64).exp();
        for (step, start) in [(0.05, 0.0), (1.0, 0.0), (0.3, 1.0)] {
            let bonds = format!("{KINETICS}, start = {start:.1}");
            let mut simulation = simulation(&held(height, step, &bonds));
            for time in [0.0, 3.0, 6.0] {
                run(&mut simulation, time);
                let end = 0.7 / rate;
                let share = end + (start - end) * (-rate * time).exp();
                let found = value(&simulation, "contact.bonds") / (10.0 * 16.0);
                // Heights of recorded frames have seven digits.
                assert!((found - share).abs() < 1e-6, "{height} um, {step} s: {found} for {share} after {time} s");
                let energy = value(&simulation, "contact.energy");
                let t = 0.5 * height;
                let depth = if t < 0.5 { 1.0 - 2.0 * t * t } else { 2.0 * (1.0 - t) * (1.0 - t) };
                assert!((energy + 32.0 * depth * share).abs() < 1e-4, "{energy} pN um");
            }
        }
    }
}

#[test]
fn beyond_the_range_bonds_neither_close_nor_last() {
    let bonds = "on = \"5 /s\", off = \"0.1 /s\", force = \"1 pN\", start = 1.0";
    let mut simulation = simulation(&held(2.1, 0.5, bonds));
    run(&mut simulation, 6.0);
    assert_eq!(value(&simulation, "contact.bonds"), 0.0);
    assert!(simulation.state().contact.bonds.is_empty());
}

/// A stiff box of 10 x 10 µm on a floor that is pushed along a direction by a force in the course of time; σ = 1 pN/µm².
fn block(integrator: &str, direction: &str, force: &str, rules: &str) -> String {
    format!(
        "title = \"A box on a floor\"\n[run]\nuntil = \"400 s\"\nintegrator = {{ {integrator} }}\n{FLOOR}[cells.box]\n\
         mesh = {{ shape = \"box\", size = [\"10 um\", \"10 um\", \"5 um\"], divisions = [8, 8, 4] }}\n\
         placement = {{ at = [[\"0 um\", \"0 um\", \"2.5 um\"]] }}\n[cells.box.mechanics]\ndrag = \"20 pN s/um\"\n\
         shape_memory = {{ shape_modulus = \"200 pN/um\" }}\n[[cells.box.loads]]\nname = \"push\"\ncap = {{ direction = [0, 0, -1], number = 81 }}\ndirection = {direction}\n\
         force = {force}\n[contact]\nstrength = \"0 Pa\"\n[[contact.between]]\ntypes = [\"box\", \"floor\"]\n\
         strength = \"1 pN/um^2\"\nrange = \"1.5 um\"\n{rules}\n"
    )
}

/// The bonds of that box: five pN each at most, a fifth of a bond a µm².
const SLIP: &str = "shear_strength = \"0 Pa\"\nbonds = { density = \"0.2 /um^2\", on = \"0 /s\", off = \"0.01 /s\", force = \"1 pN\", start = 1 }";

/// The box under a pull that grows by so much a second (pN/s), up to 200 pN.
fn pulled(rate: f64, integrator: &str) -> String {
    let course = format!("[[\"0 s\", \"0 pN\"], [\"{} s\", \"200 pN\"]]", 200.0 / rate);
    block(integrator, "[0, 0, 1]", &course, SLIP)
}

/// The pull at which it lets go, pN.
fn lets_go(text: &str, rate: f64) -> f64 {
    let mut simulation = simulation(text);
    for part in 1..=400 {
        run(&mut simulation, f64::from(part) * 0.5 / rate);
        if value(&simulation, "position_z") > 2.5 + 1.5 {
            return f64::from(part) * 0.5;
        }
    }
    panic!("it holds")
}

/// What a rigid box does: its floor and, in strips of 0.025 µm, its walls, from which the floor is twice as far as it is below; their bonds
/// are followed in small steps.
fn lets_go_in_theory(rate: f64) -> f64 {
    // Area, how far above the floor of the box, and how often that is its opening.
    let walls = (0..30).map(|strip| (40.0 * 0.025, 0.025 * (f64::from(strip) + 0.5), 2.0));
    let parts: Vec<(f64, f64, f64)> = std::iter::once((100.0, 0.0, 1.0)).chain(walls).collect();
    let mut closed = vec![1.0; parts.len()];
    let (mut height, mut time, dt) = (0.0_f64, 0.0, 1e-3 / rate);
    while height < 1.5 {
        let traction = |(_, above, times): (f64, f64, f64)| {
            let t = times * (height + above) / 1.5;
            2.0 * t.min(1.0 - t).max(0.0)
        };
        let pulls = parts.iter().zip(&closed).map(|(part, closed)| part.2 * part.0 * closed * traction(*part));
        let moves = (rate * time - pulls.sum::<f64>()) / 20.0 * dt;
        closed
            .iter_mut()
            .zip(&parts)
            .for_each(|(closed, part)| *closed *= (-0.01 * (5.0 * traction(*part)).exp() * dt).exp());
        height = (height + moves).max(0.0);
        time += dt;
    }
    rate * time
}

#[test]
fn a_box_that_is_pulled_off_faster_holds_more_as_much_as_its_bonds_say() {
    let mut before = 0.0;
    for rate in [0.5, 5.0, 50.0] {
        let (found, theory) = (lets_go(&pulled(rate, "max_step = \"1 s\""), rate), lets_go_in_theory(rate));
        // Pulls are told apart by half a pN, and the box is looked at where all of it is beyond the range.
        assert!((found / theory - 1.0).abs() < 0.03, "{rate} pN/s: {found} pN where a rigid box has {theory}");
        assert!(found > 1.2 * before, "{rate} pN/s: {found} pN, {before} pN at a tenth of the rate");
        before = found;
    }
}

#[test]
fn a_box_stands_against_a_push_until_its_bonds_bear_no_more_and_slides_by_what_is_beyond() {
    // 0.2 pN/µm² of all bonds against 12 pN; what load does to these is nothing.
    let rules = |force: &str| {
        format!(
            "shear_strength = \"0.2 pN/um^2\"\nbonds = {{ density = \"0.2 /um^2\", on = \"0 /s\", off = \"0.05 /s\", force = \"{force}\", start = 1 }}"
        )
    };
    let moved_at = |force: &str, times: [f64; 3]| {
        let mut simulation = simulation(&block("max_step = \"0.5 s\"", "[1, 0, 0]", "\"12 pN\"", &rules(force)));
        times.map(|time| {
            run(&mut simulation, time);
            value(&simulation, "position_x")
        })
    };
    let slides_at = (20.0_f64 / 12.0).ln() / 0.05;
    let gone = |time: f64| (12.0 * time - 12.0 * (1.0 - (-0.05 * time).exp()) / 0.05) / 20.0;
    let [before, later, end] = moved_at("1e9 pN", [0.95, 1.5, 2.0].map(|time| time * slides_at));
    // Until then it gives way by what contacts yield.
    assert!(before < 0.02, "{before} um before it slides");
    assert!((later - before - gone(0.5 * slides_at)).abs() < 0.02, "{later} um");
    assert!((end - before - gone(slides_at)).abs() < 0.02, "{end} um");
    // Where load opens them it slides sooner: after 3.8 s by no less than with bonds that all bear the same.
    let (end, dt) = (0.368 * slides_at, 1e-4);
    let (mut closed, mut even, mut time): (f64, f64, f64) = (1.0, 0.0, 0.0);
    while time < end {
        let held = f64::min(12.0, 20.0 * closed);
        even += (12.0 - held) / 20.0 * dt;
        closed *= (-0.05 * (held / (20.0 * closed) / 0.6).exp() * dt).exp();
        time += dt;
    }
    let [_, sooner, _] = moved_at("0.6 pN", [0.1 * end, end, 1.1 * end]);
    assert!(even > 0.05 && sooner > even, "{sooner} um where bonds that bear the same let it slide by {even}");
}

#[test]
fn a_box_is_dragged_against_the_friction_of_the_bonds_that_are_closed() {
    // 40 pN s/µm³ of 20 bonds a µm², which bear 0.05 pN each at most across the surface.
    let rules = "friction = \"40 pN s/um^3\"\nbonds = { density = \"20 /um^2\", on = \"1 /s\", off = \"0.5 /s\", force = \"0.1 pN\" }";
    let (mut speed, mut closed): (f64, f64) = (0.0, 0.5);
    for _ in 0..2000 {
        speed = 70.0 / (20.0 + 40.0 * 100.0 * closed);
        closed = 0.99 * closed + 0.01 / (1.0 + 0.5 * (speed * 40.0 / 20.0 / 0.1_f64).exp());
    }
    // The force grows slowly: bonds that are not there yet would not close any more at the speed that it makes without them.
    let course = "[[\"0 s\", \"0 pN\"], [\"20 s\", \"70 pN\"], [\"400 s\", \"70 pN\"]]";
    let mut simulation = simulation(&block("max_step = \"1 s\"", "[1, 0, 0]", course, rules));
    run(&mut simulation, 40.0);
    let before = value(&simulation, "position_x");
    run(&mut simulation, 60.0);
    let found = (value(&simulation, "position_x") - before) / 20.0;
    assert!((found / speed - 1.0).abs() < 0.02, "{found} for {speed} um/s");
}

#[test]
fn bonds_of_boxes_whose_meshes_do_not_match_bear_what_rubs_where_no_atoms_touch() {
    let shape = |name: &str, width: f64, parts: u32, up: f64, more: &str| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"box\", size = [\"{width} um\", \"{width} um\", \"5 um\"], divisions = [{parts}, {parts}, 4] }}\n\
             placement = {{ at = [[\"0 um\", \"0 um\", \"{up} um\"]] }}\n{more}\n[cells.{name}.mechanics]\ndrag = \"20 pN s/um\"\n\
             shape_memory = {{ shape_modulus = \"200 pN/um\" }}\n"
        )
    };
    let push = "[[cells.upper.loads]]\nname = \"push\"\ncap = { direction = [0, 0, -1], number = 36 }\ndirection = [1, 0, 0]\n\
                force = [[\"0 s\", \"0 pN\"], [\"10 s\", \"30 pN\"], [\"40 s\", \"30 pN\"]]\n";
    let text = format!(
        "title = \"A box on a box\"\n[run]\nuntil = \"40 s\"\nintegrator = {{ max_step = \"1 s\" }}\n{}{push}{}[contact]\n\
         strength = \"1 pN/um^2\"\nenergy = \"0.5 pN/um\"\nfriction = \"20 pN s/um^3\"\n\
         bonds = {{ density = \"20 /um^2\", on = \"1 /s\", off = \"0.5 /s\", force = \"0.1 pN\" }}\n[output]\nevery = \"2 s\"\n",
        shape("upper", 6.0, 5, 7.501, ""),
        shape("lower", 10.0, 7, 2.5, "fixed = [{ all = true }]"),
    );
    let (mut speed, mut closed): (f64, f64) = (0.0, 0.5);
    for _ in 0..2000 {
        speed = 30.0 / (20.0 + 20.0 * 36.0 * closed);
        closed = 0.99 * closed + 0.01 / (1.0 + 0.5 * (speed / 0.1_f64).exp());
    }
    let mut simulation = simulation(&text);
    run(&mut simulation, 20.0);
    let before = value(&simulation, "position_x");
    run(&mut simulation, 35.0);
    let found = (value(&simulation, "position_x") - before) / 15.0;
    assert!((found / speed - 1.0).abs() < 0.05, "{found} for {speed} um/s");
}

#[test]
fn the_height_of_a_pulled_box_converges_with_the_step_and_the_tolerance() {
    let height = |integrator: &str| {
        let course = "[[\"0 s\", \"0 pN\"], [\"2 s\", \"40 pN\"], [\"400 s\", \"40 pN\"]]";
        let mut simulation = simulation(&block(integrator, "[0, 0, 1]", course, SLIP));
        run(&mut simulation, 8.0);
        value(&simulation, "position_z") - 2.5
    };
    let of_step = |step: f64| height(&format!("step = \"{step} s\""));
    let finest = of_step(0.00625);
    let errors = [0.1, 0.05, 0.025].map(|step| (of_step(step) - finest).abs());
    // Halves are what a first order has.
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2], "{errors:?}");
    for (tolerance, most) in [(3e-3, 0.01), (1e-4, 0.001)] {
        let error = (height(&format!("tolerance = {tolerance}")) - finest).abs();
        assert!(error < most, "{error} um at {tolerance}");
    }
}

/// Two elastic cells that touch, with a strength of 1.333 pN/µm² and bonds; what is said of them stands last.
fn pair(bonds: &str, more: &str) -> String {
    let cell = |name: &str, x: f64, turn: &str| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\n\
             placement = {{ at = [[\"{x} um\", \"0 um\", \"0 um\"]] }}\n{turn}\n[cells.{name}.mechanics]\ndrag = \"20 pN s/um\"\n\
             shape_memory = {{ shape_modulus = \"5 pN/um\" }}\n"
        )
    };
    let turn = "orientation = { axis = [0.3, 0.7, 0.72], angle = \"37 deg\" }";
    let (left, right) = (cell("left", -5.02, ""), cell("right", 5.02, turn));
    format!(
        "title = \"Two cells that touch\"\n[run]\nuntil = \"40 s\"\nintegrator = {{ max_step = \"0.5 s\" }}\n{left}{right}\
         [contact]\nstrength = \"1.333 pN/um^2\"\nrange = \"1.5 um\"\nshear_strength = \"0 Pa\"\n{bonds}\n{more}\n[output]\nevery = \"1 s\"\n"
    )
}

#[test]
fn a_pair_whose_bonds_only_open_gains_no_energy_but_what_opens_them_and_gets_round_again() {
    let bonds = "bonds = { density = \"10 /um^2\", on = \"0 /s\", off = \"0.3 /s\", force = \"0.1 pN\", start = 1 }";
    let (model, mut state) = simulation(&pair(bonds, "")).into_parts();
    let mut ws = Workspace::new(&model);
    let elastic = |state: &State| measure_cells(&model, state).iter().map(|cell| cell.energy).sum::<f64>();
    let (mut most, mut opened, mut rise) = (0.0_f64, 0.0, 0.0_f64);
    let mut after = None;
    while state.time < 40.0 {
        find_contacts(&model, &state, &mut ws);
        let law = energy_of_law(&model, &state.kinds, &mut ws.contact);
        let before = elastic(&state) + state.contact.stored() + law;
        if let Some(after) = after {
            // At the same shape fewer bonds hold less.
            assert!(law > after - 1e-9, "{law} for {after} pN um");
            opened += law - after;
        }
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        let law = energy_of_law(&model, &state.kinds, &mut ws.contact);
        after = Some(law);
        rise = rise.max(elastic(&state) + state.contact.stored() + law - before);
        most = most.max(elastic(&state));
    }
    assert!(rise < 1e-7 * most, "a step gains {rise} pN um");
    assert!(most > 0.5 && opened > 5.0, "{most} pN um of deformation, {opened} of opening");
    assert!(elastic(&state) < 1e-6 * most, "{} pN um are left", elastic(&state));
    assert!(state.contact.bonds.iter().all(|bonds| bonds.closed < 1e-4));
}

#[test]
fn bonds_that_all_are_closed_and_stay_so_are_no_bonds_to_the_last_bit() {
    let still = "bonds = { density = \"1 /um^2\", on = \"0 /s\", off = \"0 /s\", force = \"1 pN\", start = 1 }";
    let bits = |rules: &str| {
        let course = "[[\"0 s\", \"0 pN\"], [\"20 s\", \"90 pN\"]]";
        let mut simulation = simulation(&block("max_step = \"0.5 s\"", "[0, 0.1, 1]", course, rules));
        run(&mut simulation, 15.0);
        (positions(&simulation), simulation.steps(), value(&simulation, "contact.energy").to_bits())
    };
    let rules = "shear_strength = \"0.2 pN/um^2\"\nfriction = \"0.1 pN s/um^3\"\n";
    assert!(bits(rules) == bits(&format!("{rules}{still}")));
}

#[test]
fn a_cell_spreads_on_a_floor_as_fast_as_its_bonds_close() {
    let areas = |bonds: &str| {
        let text = format!(
            "title = \"A cell settles\"\n[run]\nuntil = \"60 s\"\n{FLOOR}[cells.cell]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\n\
             placement = {{ at = [[\"0 um\", \"0 um\", \"5.1 um\"]] }}\n[cells.cell.mechanics]\ndrag = \"20 pN s/um\"\n\
             shape_memory = {{ shape_modulus = \"5 pN/um\" }}\n[contact]\nstrength = \"0 Pa\"\n[[contact.between]]\ntypes = [\"cell\", \"floor\"]\n\
             strength = \"2 pN/um^2\"\nrange = \"1.5 um\"\nshear_strength = \"0 Pa\"\n{bonds}\n"
        );
        let mut simulation = simulation(&text);
        [1.0, 5.0, 60.0].map(|time| {
            run(&mut simulation, time);
            value(&simulation, "contact.area.cell.floor")
        })
    };
    let closing = |on: &str| {
        areas(&format!("bonds = {{ density = \"10 /um^2\", on = \"{on}\", off = \"0 /s\", force = \"1 pN\" }}"))
    };
    let (slow, usual, fast, whole) = (closing("0.1 /s"), closing("1 /s"), closing("100 /s"), areas(""));
    assert!(
        slow[0] < 0.7 * usual[0] && usual[0] < 0.8 * fast[0],
        "{} {} {} um^2 after 1 s",
        slow[0],
        usual[0],
        fast[0]
    );
    assert!(slow[1] < 0.7 * usual[1], "{} {} um^2 after 5 s", slow[1], usual[1]);
    for (area, whole) in fast.iter().zip(whole) {
        assert!((area / whole - 1.0).abs() < 0.01, "bonds that close at once: {area} for {whole} um^2");
    }
    assert!((slow[2] / whole[2] - 1.0).abs() < 0.01, "in the end: {} for {} um^2", slow[2], whole[2]);
}

fn positions(simulation: &Simulation) -> Vec<u64> {
    let mut positions = vec![[0.0; 3]; simulation.atom_count()];
    simulation.positions_into(&mut positions).unwrap_or_else(|error| panic!("{error}"));
    positions.into_iter().flatten().map(f64::to_bits).collect()
}

fn bits(simulation: &Simulation) -> Vec<u64> {
    let bonds = simulation.state().contact.bonds.iter().map(|bonds| bonds.closed.to_bits());
    positions(simulation).into_iter().chain(bonds).collect()
}

#[test]
fn threads_and_a_pause_leave_every_bit_of_cells_with_bonds() {
    let bonds = "friction = \"0.2 pN s/um^3\"\nbonds = { density = \"5 /um^2\", on = \"1 /s\", off = \"0.3 /s\", force = \"0.2 pN\", \
                 catch = { off = \"0.5 /s\", force = \"0.1 pN\" }, start = 0.4 }";
    let pull = "[[cells.left.loads]]\nname = \"pull\"\nall = true\ndirection = [-1, 0.5, 0]\nforce = \"4 pN\"\n";
    let text = pair(bonds, pull).replace("shear_strength = \"0 Pa\"", "shear_strength = \"0.1 pN/um^2\"");
    let on = |threads: usize| {
        let mut simulation = simulation(&text);
        simulation.set_threads(threads).unwrap_or_else(|error| panic!("{error}"));
        run(&mut simulation, 4.0);
        simulation
    };
    let mut whole = on(1);
    assert!(whole.state().contact.bonds.len() > 20);
    let checkpoint = whole.checkpoint();
    for threads in [2, 3] {
        assert!(bits(&on(threads)) == bits(&whole), "{threads} threads");
    }
    run(&mut whole, 8.0);
    let mut again = simulation(&text);
    again.restore(&checkpoint).unwrap_or_else(|error| panic!("{error}"));
    run(&mut again, 8.0);
    assert!(bits(&again) == bits(&whole));
}

#[test]
fn bonds_stay_with_the_cells_that_stay() {
    let third = "[cells.third]\nmesh = { shape = \"icosphere\", radius = \"5 um\", level = 1 }\n\
                 placement = { at = [[\"-5.02 um\", \"10.2 um\", \"0 um\"]] }\n[cells.third.mechanics]\ndrag = \"20 pN s/um\"\n\
                 shape_memory = { shape_modulus = \"5 pN/um\" }\n";
    let bonds = "bonds = { density = \"5 /um^2\", on = \"1 /s\", off = \"0.3 /s\", force = \"0.2 pN\" }";
    // The third stands before the others.
    let text = pair(bonds, "").replace("[cells.left]", &format!("{third}[cells.left]"));
    let mut simulation = simulation(&text);
    run(&mut simulation, 2.0);
    let ids: Vec<_> = simulation.cells().collect();
    let facets = 80;
    let of = |simulation: &Simulation, cells: [u32; 2]| -> Vec<(u32, u32, u64)> {
        let bonds = simulation.state().contact.bonds.iter();
        let own = bonds.filter(|bonds| {
            let (cell, other) = (bonds.facet / facets, bonds.other);
            cells.contains(&cell) && cells.iter().any(|one| other == Faced::Body(*one))
        });
        own.map(|bonds| (bonds.facet - facets * cells[0], bonds.point, bonds.closed.to_bits())).collect()
    };
    let before = of(&simulation, [1, 2]);
    assert!(before.len() > 20 && before.len() < simulation.state().contact.bonds.len());
    simulation.remove_cells(&ids[..1]).unwrap_or_else(|error| panic!("{error}"));
    assert!(of(&simulation, [0, 1]) == before && simulation.state().contact.bonds.len() == before.len());
    run(&mut simulation, 2.5);
    assert!(of(&simulation, [0, 1]).len() > 20);
}
