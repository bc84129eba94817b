//! Cells whose shear a constant stiffness overestimates a hundred times: they come to rest where, and as soon as, fine steps say.

use pseudopod::Simulation;

/// Red cells drawn out by a force (pN) that is let go after 1.5 s. They stand apart, in a row.
fn released(cells: usize, force: f64, integrator: &str) -> Simulation {
    let load = |name: &str, sign: i32| {
        format!(
            "[[cells.red.loads]]\nname = \"{name}\"\ncap = {{ direction = [{sign}, 0, 0], angle = \"34 deg\" }}\nspread = \"area\"\n\
             direction = [{sign}, 0, 0]\nforce = [[\"0 s\", \"0 pN\"], [\"0.5 s\", \"{force} pN\"], [\"1.5 s\", \"{force} pN\"], [\"1.51 s\", \"0 pN\"]]\n"
        )
    };
    let at: Vec<String> = (0..cells).map(|cell| format!("[\"0 um\", \"0 um\", \"{} um\"]", 8 * cell)).collect();
    let text = format!(
        "title = \"Release\"\n[run]\nuntil = \"1.61 s\"\nintegrator = {{ max_step = \"0.05 s\"{integrator} }}\n[cells.red]\n\
         mesh = {{ shape = \"red_cell\", diameter = \"7.82 um\", level = 2 }}\nplacement = {{ at = [{}] }}\n[cells.red.mechanics]\n\
         drag = \"1 pN s/um\"\n\
         membrane = {{ law = \"skalak\", shear = \"2.95 uN/m\", area = \"500 uN/m\", bending = \"0.2 pN um\" }}\n{}{}[output]\nevery = \"0.5 s\"\n",
        at.join(", "),
        load("pull", 1),
        load("hold", -1)
    );
    Simulation::from_text("release.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// The length of the first cell under the pull, and what is left of what it was drawn out 10, 30 and 100 ms after it was let go.
fn lengths(simulation: &mut Simulation) -> [f64; 4] {
    let mut length_at = |time: f64| {
        simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
        simulation.series("size_x").unwrap_or_else(|error| panic!("{error}"))[0]
    };
    let rest = length_at(0.0);
    let drawn = length_at(1.5);
    let [first, second, last] = [1.52, 1.54, 1.61].map(|time| (length_at(time) - rest) / (drawn - rest));
    [drawn, first, second, last]
}

#[test]
fn a_red_cell_that_is_let_go_comes_back_as_in_fine_steps() {
    let [drawn, first, second, last] = lengths(&mut released(1, 40.0, ""));
    let [fine_drawn, fine_first, fine_second, fine_last] = lengths(&mut released(1, 40.0, ", tolerance = 1e-5"));
    println!("{drawn} {first} {second} {last}, fine {fine_drawn} {fine_first} {fine_second} {fine_last}");
    assert!((drawn / fine_drawn - 1.0).abs() < 1e-4, "{drawn} and {fine_drawn}");
    assert!(fine_first > 0.2 && fine_last < 0.03, "the times are those in which it comes back");
    for (found, fine) in [(first, fine_first), (second, fine_second), (last, fine_last)] {
        assert!((found - fine).abs() < 0.1 * fine.max(0.1), "{found} and {fine}");
    }
}

#[test]
fn several_cells_come_back_as_one_does_in_as_many_steps() {
    let mut alone = released(1, 40.0, "");
    let [drawn, first, ..] = lengths(&mut alone);
    let mut nine = released(9, 40.0, "");
    let [of_nine, first_of_nine, ..] = lengths(&mut nine);
    assert!((of_nine / drawn - 1.0).abs() < 1e-4, "{of_nine} and {drawn}");
    assert!((first_of_nine - first).abs() < 0.05, "{first_of_nine} and {first}");
    let (alone, nine) = (alone.steps(), nine.steps());
    assert!(alone < 500 && nine < 500 && alone.abs_diff(nine) < alone / 4, "{alone} and {nine} steps");
}

#[test]
fn a_resumed_run_keeps_its_factor_and_comes_to_the_same_bits_with_any_number_of_threads() {
    for cells in [1, 9] {
        let positions = |simulation: &Simulation| {
            let mut positions = vec![[0.0; 3]; simulation.atom_count()];
            simulation.positions_into(&mut positions).unwrap();
            positions
        };
        let mut whole = released(cells, 40.0, "");
        whole.set_threads(1).unwrap();
        // Within the pull and within the release: factors of other shapes than at rest are in use at both.
        let mut taken = Vec::new();
        for time in [0.31, 1.515] {
            whole.run_until(time).unwrap();
            taken.push(whole.checkpoint());
        }
        whole.run_until(1.53).unwrap();
        for (bytes, threads) in taken.iter().zip([2, 3]) {
            let mut parts = released(cells, 40.0, "");
            parts.set_threads(threads).unwrap();
            parts.restore(bytes).unwrap();
            for time in [1.515, 1.53] {
                parts.run_until(time).unwrap();
            }
            assert_eq!(parts.steps(), whole.steps(), "{cells} cells");
            assert!(positions(&parts) == positions(&whole), "{cells} cells on {threads} threads");
        }
    }
}
