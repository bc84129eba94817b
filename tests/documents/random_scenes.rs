//! Random documents (shapes, mechanics over six decades of stiffness, walks, loads, contacts, fields, links) run, or say why not; what is
//! recorded keeps its volume, is finite, of a sane size, and cells are outside each other.
//!
//! One number makes a document. A failure prints it whole.

use std::fmt::Write as _;
use std::path::Path;

use pseudopod::error::Error;
use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};

use crate::chance::Chance;

const FIELD: &str = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-60 -60" size="120 120"/>
    <field id="c" diffusion="30" decay="0.1" initial="2 + 0.02*x"><reaction>-0.02*c^2</reaction></field></eml>"#;
const INSIDE: &str = r#"<eml name="inside" level="cell"><input id="c" default="0"/><input id="gx" default="0"/><parameter id="k" value="0.5"/>
    <variable id="u" initial="1" rate="c - k*u" noise="0.02*u"/>
    <link from="field[c]" to="system.c"/><link from="field[c].gradient.x" to="system.gx"/>
    <link from="system.u" to="cell.secretion[c]"/><link from="system.gx" to="cell.motility.bias.x" gain="0.5"/></eml>"#;

fn between(low: f64, high: f64, chance: &mut Chance) -> f64 {
    low + (high - low) * chance.share()
}

/// Equally likely in every decade.
fn decades(low: f64, high: f64, chance: &mut Chance) -> f64 {
    10_f64.powf(between(low.log10(), high.log10(), chance))
}

/// What a scene is made of, as far as its test must know.
struct Scene {
    document: String,
    /// Largest and smallest extent of a cell at rest, µm.
    sizes: [f64; 2],
}

/// A shape, its extents and its longest edge, µm.
fn shape(chance: &mut Chance) -> (String, [f64; 2], f64) {
    let radius = between(2.0, 6.0, chance);
    let sphere = |name: &str, fineness: usize, edge: f64| {
        let finer = if name == "icosphere" { "level" } else { "divisions" };
        let mesh = format!("{{ shape = \"{name}\", radius = \"{radius:.3} um\", {finer} = {fineness} }}");
        (mesh, [2.0 * radius, 1.6 * radius], edge * radius)
    };
    match chance.below(5) {
        0 => sphere("icosphere", 0, 1.06),
        1 | 2 => sphere("icosphere", 1, 0.63),
        3 => sphere("icosphere", 2, 0.33),
        _ => sphere("octasphere", 3, 0.75),
    }
}

fn mechanics(chance: &mut Chance) -> String {
    let mut text = format!("drag = \"{:.2} pN s/um\"\n", between(2.0, 40.0, chance));
    let modulus = decades(0.01, 10_000.0, chance);
    match chance.below(3) {
        0 => _ = writeln!(text, "shape_memory = {{ shape_modulus = \"{modulus:.4} pN/um\" }}"),
        1 => _ = writeln!(text, "springs = {{ stiffness = \"{modulus:.4} pN/um\" }}"),
        _ => {
            let law = ["skalak", "neo_hookean"][chance.below(2)];
            _ = writeln!(
                text,
                "membrane = {{ law = \"{law}\", shear = \"{modulus:.4} pN/um\", area = \"{:.4} pN/um\", bending = \"{:.4} pN um\" }}",
                2.0 * modulus,
                decades(0.01, 1.0, chance) * modulus
            );
        }
    }
    text
}

fn scene(number: u32) -> Scene {
    let mut chance = Chance::new(number, 2);
    let (floor, touch, chemistry) = ((chance.below(2) == 0), (chance.below(2) == 0), (chance.below(2) == 0));
    let mut text = format!(
        "title = \"scene {number}\"\nseed = {number}\n[run]\nuntil = \"3 s\"\nintegrator = {{ max_step = \"0.25 s\" }}\n[output]\nevery = \"0.5 s\"\nforces = {}\n",
        (chance.below(3) == 0)
    );
    let (mut sizes, mut edge) = ([0.0_f64, f64::INFINITY], 0.0_f64);
    for (kind, name) in ["a", "b"].iter().take(1 + chance.below(2)).enumerate() {
        let (mesh, [large, small], longest) = shape(&mut chance);
        (sizes, edge) = ([sizes[0].max(large), sizes[1].min(small)], edge.max(longest));
        // Types are side by side: rows of the largest cells there are, 12 um, and the second type above.
        let (spacing, height) = (large * between(1.02, 1.4, &mut chance), 8.0 + 14.0 * kind as f64);
        let side = 1 + chance.below(3);
        _ = write!(
            text,
            "[cells.{name}]\nmesh = {mesh}\nplacement = {{ grid = [{side}, {}, 1], spacing = \"{spacing:.3} um\", origin = [\"0 um\", \"0 um\", \"{height} um\"] }}\n",
            1 + chance.below(2),
        );
        if chance.below(2) == 0 {
            _ = writeln!(
                text,
                "motility = {{ brownian = {{ speed = \"{:.2} um/min\", persistence = \"2 s\" }} }}",
                between(0.0, 20.0, &mut chance)
            );
        } else if chemistry {
            _ = writeln!(text, "motility = {{ brownian = {{ speed = \"3 um/min\", persistence = \"2 s\" }} }}");
        }
        if chance.below(3) == 0 {
            _ = writeln!(
                text,
                "loads = [{{ name = \"push\", all = true, direction = [0, 0, -1], force = \"{:.2} pN\" }}]",
                between(0.0, 5.0, &mut chance)
            );
        }
        if chemistry {
            _ = writeln!(text, "chemistry = [\"inside\"]");
        }
        _ = write!(text, "[cells.{name}.mechanics]\n{}", mechanics(&mut chance));
    }
    if floor {
        text.push_str("[[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n");
    }
    if touch || floor {
        _ = write!(
            text,
            "[contact]\nstrength = \"{:.4} pN/um^2\"\nrange = \"{:.3} um\"\n",
            between(0.0, 0.3, &mut chance),
            edge
        );
    }
    if chemistry {
        text.push_str("[chemistry.field]\ndocument = \"field.eml\"\n[chemistry.inside]\ndocument = \"inside.eml\"\n");
    }
    Scene { document: text, sizes }
}

/// What is wrong with what was recorded.
fn wrong(result: &Path, scene: &Scene) -> Option<String> {
    let file = ResultFile::open(result).expect("what was recorded can be read");
    let series = |name: &str| file.cell_series(name).unwrap_or_else(|error| panic!("{error}"));
    for name in ["position_x", "velocity_z", "energy", "area", "volume_error", "size_x", "size_y", "size_z"] {
        if series(name).iter().any(|value| !value.is_finite()) {
            return Some(format!("{name} is not finite"));
        }
    }
    if let Some(error) = series("volume_error").iter().find(|error| error.abs() > 1e-10) {
        return Some(format!("a volume is {error} off"));
    }
    for name in ["size_x", "size_y", "size_z"] {
        let [large, small] = scene.sizes;
        // No load here draws a cell out to twice its length, or presses it to a quarter: what is beyond has blown up or folded away.
        if let Some(size) = series(name).iter().find(|size| **size > 3.0 * large || **size < 0.15 * small) {
            return Some(format!("a cell is {size} um wide"));
        }
    }
    let deepest = file.scene_series("contact.deepest").unwrap_or_default();
    // What the book promises of recorded states (docs/src/contacts.md).
    deepest.iter().find(|depth| **depth > 0.02).map(|depth| format!("a cell is {depth} of an edge in another"))
}

/// Plays scenes; how many of them ended early, with a message.
fn play(scenes: std::ops::Range<u32>) -> usize {
    let mut refused = 0;
    for number in scenes {
        let scene = scene(number);
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("field.eml", FIELD), ("inside.eml", INSIDE)] {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let told = |words: String| format!("scene {number}: {words}\n{}", scene.document);
        let document = Document::parse("scene.toml", &scene.document, folder.path(), &[]);
        let document = document.unwrap_or_else(|error| panic!("{}", told(format!("{error:?}"))));
        let result = folder.path().join("scene.h5");
        match run(&document, &RunOptions::new(&result), &mut Quiet) {
            Ok(_) => {}
            Err(Error::Numbers { kept: Some(_), message, .. }) => {
                refused += 1;
                eprintln!("scene {number}: {message}");
            }
            Err(other) => panic!("{}", told(format!("{other:?}"))),
        }
        if let Some(words) = wrong(&result, &scene) {
            panic!("{}", told(words));
        }
    }
    refused
}

#[test]
fn random_documents_run_or_say_why_not() {
    let refused = play(0..30);
    assert!(refused <= 6, "{refused} of 30 end early");
}

#[test]
#[ignore = "slow: five hundred random documents (2 min)"]
fn five_hundred_random_documents_run_or_say_why_not() {
    let refused = play(1000..1500);
    eprintln!("{refused} of 500 end early, with a message");
    assert!(refused <= 50, "{refused} of 500 end early");
}
