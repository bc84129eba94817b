//! What a step looks ahead for is not what touches.

use pseudopod::Simulation;

/// A sheet that slides over another one and over a floor, 0.4 µm above both, with what the `[contact]` table says.
fn sliding(contact: &str) -> Simulation {
    let sheet = |x: f64, z: f64| {
        format!(
            "mesh = {{ shape = \"sheet\", size = [\"10 um\", \"8 um\"], divisions = [5, 4] }}\n\
             placement = {{ at = [[\"{x} um\", \"0 um\", \"{z} um\"]] }}\n"
        )
    };
    let mechanics = "drag = \"20 pN s/um\"\nsprings = { stiffness = \"10 pN/um\" }\n";
    let text = format!(
        "title = \"What slides\"\n[run]\nuntil = \"2 s\"\nintegrator = {{ step = \"0.1 s\" }}\n\
         [environment]\ngravity = [\"9.81 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]\n\
         [[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n\
         [cells.lower]\n{}[cells.lower.mechanics]\n{mechanics}mass = \"1e-12 ng\"\n\
         [cells.upper]\n{}[cells.upper.mechanics]\n{mechanics}mass = \"1 ng\"\n\
         [cells.low]\n{}[cells.low.mechanics]\n{mechanics}mass = \"1 ng\"\n{contact}",
        sheet(0.0, 5.0),
        sheet(0.0, 5.4),
        sheet(40.0, 0.4)
    );
    let mut simulation = Simulation::from_text("sliding.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    simulation.run_until(2.0).unwrap_or_else(|error| panic!("{error}"));
    simulation
}

#[test]
fn what_is_looked_ahead_for_bears_no_shear_and_does_not_touch() {
    let laws = [
        (
            "model = \"adhesives\"\nstrength = \"1 Pa\"\nshear_strength = \"50 Pa\"\n",
            "strength = \"1 Pa\"\nshear_strength = \"50 Pa\"\n",
        ),
        ("strength = \"0 Pa\"\nshear_strength = \"50 Pa\"\n", "strength = \"0 Pa\"\nshear_strength = \"50 Pa\"\n"),
        ("model = \"virtual_adhesives\"\nkappa = \"0.1 um\"\n", "kappa = \"0.1 um\"\n"),
    ];
    for (law, on_floor) in laws {
        let slid = |distances: &str| {
            let pairs = format!("[[contact.between]]\ntypes = [\"low\", \"floor\"]\n{on_floor}");
            let simulation = sliding(&format!("[contact]\n{distances}{law}{pairs}"));
            let series = |name: &str| simulation.series(name).unwrap_or_else(|error| panic!("{error}"));
            (series("position_x"), series("contact_share"), series("contact.count"))
        };
        let (near, far, touching) = (
            slid("proximity = \"0.2 um\"\nprediction = \"0.2 um\"\n"),
            slid("proximity = \"0.2 um\"\nprediction = \"0.8 um\"\n"),
            slid("proximity = \"0.8 um\"\n"),
        );
        // Nothing holds the two that slide: mass times acceleration over drag, for two seconds.
        let free = 2.0 * 9.81 / 20.0;
        for ((x, shares, number), name) in [(&near, "near"), (&far, "far")] {
            let moved = [x[1], x[2] - 40.0];
            assert!(moved.iter().all(|moved| (moved - free).abs() < 1e-9), "{law}, {name}: {moved:?}, {free}");
            assert!(x[0].abs() < 1e-9 && shares.iter().all(|share| *share == 0.0) && number[0] == 0.0, "{law}, {name}");
        }
        let (x, shares, number) = &touching;
        assert!(x[2] - 40.0 < 0.1 * free && x[1] < 0.6 * free, "{law}: {x:?}");
        assert!(shares[..2] == [1.0, 1.0] && number[0] > 0.0, "{law}: {shares:?}");
    }
}
