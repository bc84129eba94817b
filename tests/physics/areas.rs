//! Areas of contact as they are recorded: of facets that face each other, whatever law acts.

use pseudopod::Simulation;

fn series(simulation: &Simulation, name: &str) -> Vec<f64> {
    simulation.series(name).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_box_on_a_floor_has_the_area_of_its_floor_under_strengths_and_penalties() {
    for rules in ["strength = \"1 pN/um^2\"", "model = \"penalty\"\npenalty = \"50 pN/um\""] {
        for parts in [4, 8] {
            let text = format!(
                "title = \"A box on a floor\"\n[run]\nuntil = \"1 s\"\n[[planes]]\nname = \"floor\"\n\
                 point = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.box]\n\
                 mesh = {{ shape = \"box\", size = [\"10 um\", \"10 um\", \"5 um\"], divisions = [{parts}, {parts}, 4] }}\n\
                 placement = {{ at = [[\"0 um\", \"0 um\", \"2.5 um\"]] }}\n[cells.box.mechanics]\ndrag = \"20 pN s/um\"\n\
                 shape_memory = {{ shape_modulus = \"200 pN/um\" }}\n[contact]\n{rules}\n"
            );
            let mut simulation = Simulation::from_text("box.toml", &text).unwrap_or_else(|error| panic!("{error}"));
            simulation.run_until(1.0).unwrap_or_else(|error| panic!("{error}"));
            let area = series(&simulation, "contact.area.box.floor")[0];
            assert!((area - 100.0).abs() < 5.0, "{rules}, {parts}: {area} um^2");
        }
    }
}

#[test]
fn what_is_nearer_than_the_length_of_the_document_is_in_contact_and_nothing_that_cells_do_depends_on_it() {
    let sheets = |within: &str| {
        let text = format!(
            "title = \"Two sheets\"\n[run]\nuntil = \"1 s\"\n[cells.sheet]\n\
             mesh = {{ shape = \"sheet\", size = [\"10 um\", \"8 um\"], divisions = [5, 4] }}\n\
             placement = {{ at = [[\"0 um\", \"0 um\", \"0 um\"], [\"0 um\", \"0 um\", \"0.4 um\"]] }}\n\
             mechanics = {{ drag = \"20 pN s/um\", springs = {{ stiffness = \"10 pN/um\" }} }}\n[contact]\n{within}\n"
        );
        let simulation = Simulation::from_text("sheets.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let of_pair = ["contact.area.sheet.sheet", "contact.pairs.sheet.sheet", "aggregates"];
        let checkpoint = simulation.checkpoint();
        (of_pair.map(|name| series(&simulation, name)[0]), checkpoint)
    };
    let (near, with_default) = sheets("");
    assert_eq!(near, [0.0, 0.0, 2.0]);
    let (far, checkpoint) = sheets("area_within = \"0.5 um\"");
    assert!((far[0] - 80.0).abs() < 1e-9 && far[1..] == [1.0, 1.0], "{far:?}");
    assert!(checkpoint == with_default, "a run may go on with another length");
}
