//! Cells with a stiffness of their own that touch: what contacts move of them is what their steps do, so that they come to rest as fine
//! steps say, and nothing is gained or lost.

use std::path::Path;

use pseudopod::Vec3;
use pseudopod::experiment::{Document, compile};
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{Model, State, Workspace, step};

/// When the cells are let go, s.
const LET_GO: f64 = 1.51;

/// What sticks, as a document says it.
const STRENGTHS: &str = "model = \"adhesives\"\nstrength = \"0.5 pN/um^2\"\n";

/// Two red cells that lie on each other, drawn out together and let go.
fn pair(integrator: &str, contact: &str) -> (Model, State) {
    let load = |name: &str, sign: i32| {
        format!(
            "[[cells.red.loads]]\nname = \"{name}\"\ncap = {{ direction = [{sign}, 0, 0], angle = \"34 deg\" }}\nspread = \"area\"\n\
             direction = [{sign}, 0, 0]\nforce = [[\"0 s\", \"0 pN\"], [\"0.5 s\", \"40 pN\"], [\"1.5 s\", \"40 pN\"], [\"1.51 s\", \"0 pN\"]]\n"
        )
    };
    let text = format!(
        "title = \"Pair\"\n[run]\nuntil = \"1.61 s\"\nintegrator = {{ max_step = \"0.01 s\"{integrator} }}\n[cells.red]\n\
         mesh = {{ shape = \"red_cell\", diameter = \"7.82 um\", level = 2 }}\n\
         placement = {{ at = [[0, 0, 0], [\"0.3 um\", \"0.2 um\", \"2.62 um\"]] }}\n[cells.red.mechanics]\ndrag = \"1 pN s/um\"\n\
         membrane = {{ law = \"skalak\", shear = \"2.95 uN/m\", area = \"500 uN/m\", bending = \"0.2 pN um\" }}\n{}{}[contact]\n{contact}",
        load("pull", 1),
        load("hold", -1)
    );
    let document = Document::parse("pair.toml", &text, Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let compiled = compile(&document).unwrap_or_else(|error| panic!("{error}"));
    assert!(compiled.model.kinds[0].tangent.is_some(), "a test of something else");
    (compiled.model, compiled.state)
}

/// Makes steps until a time (s), each looked at; the last one ends there.
fn go(
    (model, state): (&Model, &mut State),
    ws: &mut Workspace,
    until: f64,
    mut look: impl FnMut(&State, &mut Workspace),
) {
    while state.time < until {
        step(model, state, ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        look(state, ws);
    }
}

/// The first time at or after each of some at which a step ends, and what is left there of how far both cells were drawn out, in mean.
fn left(integrator: &str, contact: &str) -> ([(f64, f64); 3], u64) {
    let (model, mut state) = pair(integrator, contact);
    let length = |state: &State| measure_cells(&model, state).iter().map(|cell| cell.size.x).sum::<f64>() / 2.0;
    let mut ws = Workspace::new(&model);
    let rest = length(&state);
    let nothing = |_: &State, _: &mut Workspace| ();
    go((&model, &mut state), &mut ws, 1.5, nothing);
    let drawn = length(&state);
    let mut found = [(0.0, 0.0); 3];
    for (found, time) in found.iter_mut().zip([1.52, 1.54, 1.61]) {
        let mut before = (state.time, length(&state));
        while state.time < time {
            before = (state.time, length(&state));
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        assert!(!ws.contact.rows.is_empty(), "they touch at {time} s");
        // Between the ends of steps as on a line.
        let part = (time - before.0) / (state.time - before.0);
        let there = before.1 + part * (length(&state) - before.1);
        *found = (time, (there - rest) / (drawn - rest));
    }
    (found, state.step)
}

#[test]
fn two_red_cells_that_stick_together_come_back_as_in_fine_steps() {
    for contact in [STRENGTHS, "strength = \"0.5 pN/um^2\"\nshear_strength = \"0 Pa\"\n"] {
        let (found, steps) = left("", contact);
        let (fine, fine_steps) = left(", tolerance = 1e-4", contact);
        println!("{found:?} in {steps} steps, fine {fine:?} in {fine_steps}");
        // Surfaces that attract each other hold the pair a little longer than each cell is at rest.
        assert!(fine[0].1 > 0.15 && fine[2].1 < 0.07, "the times are those in which they come back: {fine:?}");
        for ((time, found), (_, fine)) in found.into_iter().zip(fine) {
            assert!((found - fine).abs() < 0.1 * fine.max(0.1), "{found} and {fine} at {time} s");
        }
        assert!(steps < fine_steps / 2, "{steps} and {fine_steps} steps");
    }
}

#[test]
fn they_keep_their_volumes_and_their_middle_stay_out_of_each_other_and_gain_nothing() {
    for contact in [STRENGTHS, ""] {
        let (model, mut state) = pair("", contact);
        let centre = |state: &State| {
            let cells = measure_cells(&model, state);
            let sum: Vec3 = cells.iter().flat_map(|cell| &cell.positions).sum();
            sum / (2 * model.kinds[0].atoms()) as f64
        };
        let (start, mut ws) = (centre(&state), Workspace::new(&model));
        let (mut deepest, mut off, mut touching): (f64, f64, usize) = (0.0, 0.0, 0);
        let (mut before, mut worst) = (f64::INFINITY, f64::NEG_INFINITY);
        go((&model, &mut state), &mut ws, model.until, |state, ws| {
            deepest = deepest.max(-ws.contact.found.smallest_gap());
            touching += usize::from(!ws.contact.rows.is_empty());
            let cells = measure_cells(&model, state);
            off = cells.iter().map(|cell| cell.volume_error.abs()).fold(off, f64::max);
            let energy = cells.iter().map(|cell| cell.energy).sum::<f64>() + state.contact.stored();
            // Under the cohesive law the surfaces have an energy, too, which is not among these; without strength they have none.
            if state.time > LET_GO {
                worst = worst.max((energy - before) / energy);
                before = energy;
            }
        });
        let drift = (centre(&state) - start).norm();
        println!(
            "deepest {:.4} edges, volumes off {off:.1e}, drift {drift:.1e}, energy rises {worst:.1e}, touching {touching} of {} steps",
            deepest / model.kinds[0].edge,
            state.step
        );
        assert!(touching > 100, "a test of nothing");
        assert!(deepest < 0.02 * model.kinds[0].edge, "{deepest}");
        assert!(off < 1e-10, "{off}");
        // Round-off of some hundred steps.
        assert!(drift < 1e-11, "{drift}");
        // What is left by sweeps, as for other cells.
        assert!(worst < 1e-7, "{worst}");
    }
}

#[test]
fn their_columns_are_scratch_and_the_same_on_any_number_of_threads() {
    let run = |threads: usize, before: &(dyn Fn(&Model, &mut State, &mut Workspace) + Sync)| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (model, mut state) = pair("", STRENGTHS);
            let mut ws = Workspace::new(&model);
            for _ in 0..120 {
                before(&model, &mut state, &mut ws);
                step(&model, &mut state, &mut ws).unwrap();
            }
            assert!(!ws.contact.rows.is_empty(), "a test of nothing");
            state
        })
    };
    let plain = run(1, &|_, _, _| ());
    assert!(plain == run(2, &|_, _, _| ()), "threads");
    assert!(plain == run(1, &|model, _, ws| ws.poison(model)), "scratch");
    let saved = run(2, &|model, state, ws| {
        let bytes = postcard::to_stdvec(&*state).unwrap();
        *state = postcard::from_bytes(&bytes).unwrap();
        *ws = Workspace::new(model);
    });
    assert!(plain == saved, "checkpoints");
}
