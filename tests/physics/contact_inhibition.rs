//! Contact inhibition of locomotion: cells that meet turn away, and others that do not go on into each other.

use pseudopod::simulation::Simulation;

/// A cell of the type `left` at x = −9 µm and one of `right` at 9 µm on glass, in a channel as wide as they are, each with a cue towards the other.
fn meeting(inhibition: &str) -> Simulation {
    let cell = |name: &str, x: f64, cue: f64| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"{x} um\", \"0 um\", \"5.05 um\"]] }}\nchemistry = [\"{name}\"]\n\
             [cells.{name}.mechanics]\ndrag = \"500 pN s/um\"\n\
             membrane = {{ law = \"skalak\", shear = \"10 pN/um\", area = \"20 pN/um\", bending = \"2 pN um\", tension = \"10 pN/um\" }}\n\
             [cells.{name}.pseudopods]\npressure = \"20 Pa\"\ncontraction = \"60 pN\"\npause = \"1 s\"\nprotrusion = \"8 s\"\nretraction = \"4 s\"\n\
             split = 0\n{inhibition}\n\
             [chemistry.{name}]\ndocument = \"none.eml\"\nlinks = [{{ from = \"system.one\", to = \"cell.pseudopods.cue.x\", gain = {cue} }}]\n"
        )
    };
    let text = format!(
        "title = \"Two cells meet\"\nseed = 7\n[run]\nuntil = \"60 s\"\nintegrator = {{ max_step = \"0.5 s\", tolerance = 0.01 }}\n\
         [[planes]]\nname = \"glass\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n\
         [[planes]]\nname = \"right_wall\"\npoint = [\"0 um\", \"-5.2 um\", \"0 um\"]\nnormal = [0, 1, 0]\n\
         [[planes]]\nname = \"left_wall\"\npoint = [\"0 um\", \"5.2 um\", \"0 um\"]\nnormal = [0, -1, 0]\n{}{}\
         [contact]\nstrength = \"0 Pa\"\n[[contact.between]]\ntypes = [\"left\", \"glass\"]\nenergy = \"10 pN/um\"\nrange = \"1.5 um\"\nshear_strength = \"100 Pa\"\n\
         [[contact.between]]\ntypes = [\"right\", \"glass\"]\nenergy = \"10 pN/um\"\nrange = \"1.5 um\"\nshear_strength = \"100 Pa\"\n",
        cell("left", -9.0, 3.0),
        cell("right", 9.0, -3.0)
    );
    let folder = tempfile::tempdir().expect("a folder");
    let eml =
        "<eml name=\"none\"><parameter id=\"one\" value=\"1\"/><variable id=\"a\" initial=\"0\" rate=\"0\"/></eml>";
    std::fs::write(folder.path().join("none.eml"), eml).expect("a file");
    let file = folder.path().join("meeting.toml");
    std::fs::write(&file, text).expect("a file");
    Simulation::from_file(&file).unwrap_or_else(|error| panic!("{error}"))
}

/// The share of their atoms that touch the other, mean of a minute, and the share of the pseudopods that led towards it and were given up.
fn meet(inhibition: &str) -> (f64, f64) {
    let mut simulation = meeting(inhibition);
    let mut touching = 0.0;
    while simulation.time() < 60.0 {
        let before = simulation.time();
        simulation.step().unwrap_or_else(|error| panic!("{error}"));
        let shares = simulation.series("contact_share").unwrap_or_else(|error| panic!("{error}"));
        touching += 0.5 * shares.iter().sum::<f64>() * (simulation.time() - before);
    }
    let ended = simulation.take_ended_pseudopods();
    let first = simulation.cells().next().expect("a cell");
    let towards = ended.iter().filter(|pod| pod.direction[0] * if pod.cell == first { 1.0 } else { -1.0 } > 0.5);
    let given_up = towards.clone().filter(|pod| pod.abandoned).count();
    (touching / 60.0, given_up as f64 / towards.count().max(1) as f64)
}

#[test]
fn cells_that_heed_each_other_part_again_and_others_press_on() {
    let without = meet("");
    assert!(without.0 > 0.03 && without.1 == 0.0, "without: {without:?}");
    let (touching, given_up) = meet("contact_inhibition = { by = \"other_types\", share = 0.2, turn = 8 }");
    assert!(touching < 0.3 * without.0 && given_up > 0.3, "with: {touching} of their atoms, {given_up} given up");
    // They are of two types.
    assert_eq!(meet("contact_inhibition = { by = \"own_type\", share = 0.2, turn = 8 }"), without);
}
