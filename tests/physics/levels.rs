//! A system of the scene, one of cells and a field that stand together: `eml/chamber.eml`, `eml/responder.eml`, `eml/response.eml`.

use crate::coupled_scene::scene;

#[test]
fn scene_cells_and_field_come_to_the_rest_that_their_equations_have_together() {
    let documents = ["chamber", "responder", "response"].map(|name| {
        let text = std::fs::read_to_string(format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR")));
        (name, text.expect("a document that ships"))
    });
    let documents: Vec<(&str, &str)> = documents.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let text = r#"
[run]
until = "3600 s"
integrator = { step = "7.5 s" }
[output]
every = "3600 s"
[cells.cell]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-10 um", "-10 um", "0 um"], ["10 um", "-10 um", "0 um"], ["-10 um", "10 um", "0 um"], ["10 um", "10 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
chemistry = ["responder"]
[chemistry.chamber]
document = "chamber.eml"
links = [{ from = "type[cell].chemistry[responder].uptake", to = "system.uptake" }]
[chemistry.responder]
document = "responder.eml"
[chemistry.response]
document = "response.eml"
size = ["40 um", "40 um", "0 um"]
"#;
    let mut scene = scene(&documents, text);
    scene.run();
    // Cells take up u = 0.3 N/(0.5 + N) a minute and release as much; on 1 600 um^2 with a decay of 0.4 a minute the mean signal of four cells that
    // cover 80 um^2 each is 4 * 80 u/(0.4 * 1600). N rises where more flows in than is taken up.
    let parts = |nutrient: f64| {
        let uptake = 0.3 * nutrient / (0.5 + nutrient);
        (uptake, 4.0 * 80.0 * uptake / (0.4 * 1600.0))
    };
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let nutrient = 0.5 * (low + high);
        let (uptake, signal) = parts(nutrient);
        let rises = 0.5 * (2.0 / (1.0 + signal) - nutrient) - 4.0 * 0.25 * uptake > 0.0;
        if rises { low = nutrient } else { high = nutrient }
    }
    let (uptake, signal) = parts(low);
    for (system, id, wanted) in
        [(0, "nutrient", low), (0, "signal", signal), (1, "uptake", uptake), (1, "store", uptake / 0.8)]
    {
        let found = scene.value(system, id, 0);
        assert!((found / wanted - 1.0).abs() < 1e-4, "{id}: {found} for {wanted}");
    }
}
