//! What a step looks ahead for is not what touches.

use crate::coupled_scene::scene;
use pseudopod::Simulation;

/// A sheet that slides over another one, and one over a floor, 0.4 µm above them, with what the `[contact]` table says.
fn sliding(contact: &str) -> Simulation {
    let sheet = |x: f64, z: f64| {
        format!(
            "mesh = {{ shape = \"sheet\", size = [\"10 um\", \"8 um\"], divisions = [5, 4] }}\n\
             placement = {{ at = [[\"{x} um\", \"0 um\", \"{z} um\"]] }}\n"
        )
    };
    let mechanics = "drag = \"20 pN s/um\"\nsprings = { stiffness = \"10 pN/um\" }\n";
    // A step for kappa, and none for springs, whose steps are found by their error.
    let step = if contact.contains("kappa") { "step" } else { "max_step" };
    let text = format!(
        "title = \"What slides\"\n[run]\nuntil = \"2 s\"\nintegrator = {{ {step} = \"0.1 s\" }}\n\
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
            Some("strength = \"1 Pa\"\nshear_strength = \"50 Pa\"\n"),
        ),
        (
            "strength = \"0 Pa\"\nshear_strength = \"50 Pa\"\n",
            Some("strength = \"0 Pa\"\nshear_strength = \"50 Pa\"\n"),
        ),
        ("model = \"virtual_adhesives\"\nkappa = \"0.1 um\"\n", Some("kappa = \"0.1 um\"\n")),
        // Links hold nothing to planes.
        ("model = \"links\"\nlink = \"10 pN/um\"\n", None),
    ];
    for (law, on_floor) in laws {
        let slid = |distances: &str| {
            let on_floor = on_floor.map(|law| format!("[[contact.between]]\ntypes = [\"low\", \"floor\"]\n{law}"));
            let pairs = on_floor.unwrap_or_default();
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
            // Round-off of a thousand sums.
            assert!(moved.iter().all(|moved| (moved - free).abs() < 1e-9), "{law}, {name}: {moved:?}, {free}");
            assert!(x[0].abs() < 1e-9 && shares.iter().all(|share| *share == 0.0) && number[0] == 0.0, "{law}, {name}");
        }
        // What touches bears more than the 9.8 pN that draw: the one stands on the floor, the other takes along what it lies on, at half the
        // speed; in the first steps they give way a little.
        let (x, shares, number) = &touching;
        assert!(on_floor.is_none() || x[2] - 40.0 < 0.1 * free, "{law}: {x:?}");
        assert!(x[1] < 0.6 * free, "{law}: {x:?}");
        assert!(shares[..2] == [1.0, 1.0] && number[0] > 0.0, "{law}: {shares:?}");
    }
}

#[test]
fn what_is_looked_ahead_for_is_no_neighbour_of_chemistry() {
    let own = r#"<eml name="own" level="cell"><input id="count" default="7"/><input id="share" default="7"/>
        <variable id="v" initial="3" rate="0"/><link from="cell.neighbours.count" to="system.count"/>
        <link from="cell.contact_share" to="system.share"/></eml>"#;
    let skin = r#"<eml name="skin" level="membrane"><input id="near" default="7" level="membrane"/>
        <variable id="a" initial="1" rate="0"/><define id="push">near*a</define>
        <link from="system.push" to="cell.atoms.protrusion"/><link from="cell.atoms.in_contact" to="system.near"/></eml>"#;
    // Two cells whose surfaces are 0.4 µm apart.
    let read = |distances: &str| {
        let text = format!(
            "[run]\nuntil = \"0.2 s\"\nintegrator = {{ step = \"0.1 s\" }}\n[output]\nevery = \"0.2 s\"\n[contact]\nstrength = \"1 Pa\"\n\
             model = \"adhesives\"\n{distances}[cells.cell]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\n\
             chemistry = [\"own\", \"skin\"]\nplacement = {{ at = [[\"-5.2 um\", \"0 um\", \"0 um\"], [\"5.2 um\", \"0 um\", \"0 um\"]] }}\n\
             mechanics = {{ drag = \"20 pN s/um\", shape_memory = {{ shape_modulus = \"10 pN/um\" }} }}\n\
             [chemistry.own]\ndocument = \"own.eml\"\n[chemistry.skin]\ndocument = \"skin.eml\"\n"
        );
        let mut scene = scene(&[("own", own), ("skin", skin)], &text);
        scene.begin();
        let atoms = &scene.state().chemistry.controls.of_atoms[0].protrusion;
        [scene.value(0, "count", 0), scene.value(0, "share", 0), atoms.iter().sum()]
    };
    assert_eq!(read("proximity = \"0.2 um\"\nprediction = \"0.7 um\"\n"), [0.0; 3]);
    let touching = read("proximity = \"0.7 um\"\n");
    assert!(touching[0] == 1.0 && touching[1] > 0.0 && touching[2] >= 2.0, "{touching:?}");
}
