//! A scene that has everything: two types, contacts that stick by bonds that close and open, walks that turn, pseudopods with fibres and without that heed what they touch, membranes whose moduli chemistry sets, a plane, loads, fibres, a field that cells secrete into
//! and climb, noise at all levels, systems with events, links both ways, membranes that sense and push at every atom, a viscous one, an atom that is put somewhere and one that is moved on a course.

use pseudopod::experiment::{Compiled, Document, compile};
use pseudopod::geometry::icosphere;
use pseudopod::sim::{Model, State, Workspace, begin_chemistry, step};

/// The field.
const FIELD: &str = r#"<eml name="field"><grid dimension="2" spacing="4" origin="-40 -40" size="80 80"/>
    <field id="c" diffusion="30" decay="0.1" initial="2 + 0.02*x"><reaction>-0.02*c^2</reaction></field>
    <field id="n" range="free" diffusion="30" decay="0.1" initial="0" noise="0.1 + 0.01*c"/>
    <field id="m" diffusion="2 + 0.1*m" decay="0.1" initial="1">
        <advection x="0.5 + 0.1*sin(time)" y="0.01*x"/><taxis towards="c" sensitivity="1/(1 + c)^2"/>
        <source at="3 -7" strength="2 + cos(time)"/>
        <wall side="x-" kind="flux" value="0.1*(2 - m)"/><wall side="y+" kind="open" value="1 + 0.1*time"/></field>
        <field id="w" initial="1" diffusion="10"><reaction>0.2*(bath - w)</reaction></field><mean id="mean_w">w</mean>
        <variable id="bath" initial="2" rate="0.3*(1 - bath*mean_w)"/>
        <event every="0.1"><set id="w">1.01*w</set><set id="bath">bath + 0.01</set></event></eml>"#;

/// What each walker has.
const OWN: &str = r#"<eml name="own" level="cell"><parameter id="k" value="0.5"/><input id="c" default="0"/><input id="gx" default="0"/>
    <input id="speed" default="0"/><input id="share" default="0"/>
    <variable id="u" initial="1" rate="c - k*u" noise="0.02*u"/><variable id="w" initial="0" rate="u - w"/>
    <variable id="clock" initial="0" rate="1"/><variable id="pulses" initial="0" rate="0"/>
    <event id="pulse" when="clock ge 0.35"><set id="clock">0</set><set id="pulses">pulses + 1</set></event>
    <solver scheme="rk45" rtol="1e-6" noise_step="0.03"/>
    <algebraic id="sought" start="0">sought^3 + sought = u + time</algebraic>
    <link from="field[c]" to="system.c"/><link from="field[c].gradient.x" to="system.gx"/>
    <link from="cell.speed" to="system.speed"/><link from="cell.contact_share" to="system.share"/>
    <link from="system.gx" to="cell.motility.bias.x" gain="0.5"/><link from="system.gx" to="cell.pseudopods.cue.x" gain="20"/><link from="system.w" to="cell.secretion[c]" gain="2"/>
    <link from="system.u" to="cell.stiffness" transfer="1 + 0.2*tanh(value)"/>
    <link from="system.pulses" to="cell.adhesion" transfer="1 + 0.1*sin(value)"/>
    <link from="system.pulses" to="cell.load[push]" transfer="1 + 0.5*sin(value)"/>
    <link from="system.pulses" to="cell.fibre[trunk]" transfer="0.5 + 0.3*sin(value)"/>
    <link from="system.clock" to="cell.rest_volume_ratio" transfer="1 + 0.001*value"/>
    <link from="system.sought" to="cell.motility.bias.z" transfer="1e-3*value"/></eml>"#;

/// What is on the membranes of all.
const SKIN: &str = r#"<eml name="skin" level="membrane"><input id="c" default="0"/>
    <input id="here" default="0" level="membrane"/><input id="up" default="0" level="membrane"/><input id="bent" default="0" level="membrane"/>
    <input id="wide" default="0" level="membrane"/><input id="near" default="0" level="membrane"/><input id="low" default="0" level="membrane"/><input id="pull" default="0" level="membrane"/>
    <variable id="a" initial="1 + 0.05*x" diffusion="0.5" rate="0.3*inside - a*(0.2 + 0.1*a) + 0.01*(c + here) + 0.02*(near + low + up*bent + wide) + 0.01*tanh(pull)" noise="0.01*a"/>
    <variable id="h" initial="0.1" rate="a - h"/>
    <variable id="inside" initial="2" level="cell" rate="(lost - 0.3*inside*area)/volume" noise="0.01*front"/>
    <integral id="lost">0.2*a</integral><mean id="front">a*x</mean>
    <define id="push">0.05*max(a - low, 0)</define>
    <link from="field[c]" to="system.c"/><link from="cell.atoms.field[c]" to="system.here"/><link from="cell.atoms.normal.z" to="system.up"/>
    <link from="cell.atoms.curvature" to="system.bent"/><link from="cell.atoms.area_strain" to="system.wide" transfer="value + 0*inside"/>
    <link from="cell.atoms.in_contact" to="system.near"/><link from="cell.atoms.on_plane" to="system.low"/><link from="cell.atoms.traction" to="system.pull"/>
    <link from="system.push" to="cell.atoms.protrusion"/><link from="system.a" to="cell.atoms.tension" gain="0.2"/>
    <link from="system.h" to="cell.atoms.adhesion" transfer="1/(1 + value^2)"/><link from="system.a" to="cell.atoms.secretion[c]" gain="0.01"/>
    <link from="system.h" to="cell.atoms.elasticity" transfer="1 + 0.2*tanh(value)"/></eml>"#;

/// What the ball has: it moves one of its atoms.
const PIN: &str = r#"<eml name="pin" level="cell"><variable id="t" initial="0" rate="1"/><input id="seen" default="0"/>
    <define id="wanted">BEGIN - 0.02*t</define>
    <link from="cell.position.x" to="system.seen"/><link from="system.wanted" to="cell.atom[4].y"/></eml>"#;

/// What the scene has.
const WHOLE: &str = r#"<eml name="whole"><input id="mean" default="0"/><variable id="sum" initial="0" rate="mean" noise="0.1"/>
    <link from="type[walker].chemistry[own].u" to="system.mean"/></eml>"#;

const TEXT: &str = r#"
title = "everything"
seed = 5
[run]
until = "100 s"
integrator = { INTEGRATOR }
[output]
every = "10 s"
tractions = true

[cells.walker]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["0 um", "0 um", "5.02 um"], ["9.9 um", "0 um", "5.02 um"], ["0 um", "9.9 um", "5.02 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" }, membrane = { law = "neo_hookean", shear = "4 pN/um", area = "4 pN/um" } }
motility = { brownian = { speed = "2 um/min", persistence = "PERSISTENCE" } }
pseudopods = { pressure = "0.5 Pa", fibres = { number = 3, stiffness = "0.02 pN/um" }, pause = "0.1 s", protrusion = "0.4 s", retraction = "0.4 s", contact_inhibition = { share = 0.1, turn = 1 } }
loads = [{ name = "push", all = true, direction = [0, 0, -1], force = "4 pN" }]
fibres = [{ name = "trunk", pairs = [[0, 20]], stiffness = "1 pN/um" }]
chemistry = ["own", "skin"]

[cells.ball]
mesh = { shape = "icosphere", radius = "4 um", level = 1 }
placement = { at = [["9 um", "9 um", "4.02 um"]] }
mechanics = { drag = "15 pN s/um", shape_memory = { shape_modulus = "10 pN/um" }, membrane = { law = "neo_hookean", shear = "4 pN/um", area = "4 pN/um" }, viscosity = { shear = "1 uN s/m", area = "2 uN s/m" } }
pseudopods = { pressure = "0.3 Pa", contraction = "1 pN", pause = "0.1 s", protrusion = "0.3 s", retraction = "0.3 s" }
moved = [{ name = "lift", atoms = [7], axes = ["z"], direction = [0, 0, 1], displacement = [["0 s", "0 um"], ["1.03 s", "0.05 um"], ["3 s", "0.02 um"]] }]
loads = [{ name = "press", all = true, direction = [-0.7, -0.7, -0.2], force = [["0 s", "8 pN"], ["3.05 s", "9 pN"]] }]
chemistry = ["pin", "skin"]

[[planes]]
name = "floor"
point = ["0 um", "0 um", "0 um"]
normal = [0, 0, 1]

[contact]
strength = "0.5 pN/um^2"
bonds = { density = "2 /um^2", on = "2 /s", off = "0.2 /s", force = "0.2 pN", catch = { off = "0.3 /s", force = "0.1 pN" }, start = 0.5 }

[chemistry.field]
document = "field.eml"
[chemistry.own]
document = "own.eml"
[chemistry.pin]
document = "pin.eml"
[chemistry.whole]
document = "whole.eml"
[chemistry.skin]
document = "skin.eml"
"#;

/// Model and start, with steps of one size ("0.05 s") or as long as the error allows; walks last this long at a mean ("0.3 s").
pub fn everything(step: Option<&str>, persistence: &str) -> (Model, State) {
    let folder = tempfile::tempdir().unwrap();
    // Where the atom of the ball begins.
    let pin = PIN.replace("BEGIN", &format!("{}", 9.0 + icosphere(4.0, 1).positions[4].y));
    for (name, eml) in [("field", FIELD), ("own", OWN), ("pin", &pin), ("whole", WHOLE), ("skin", SKIN)] {
        std::fs::write(folder.path().join(format!("{name}.eml")), eml).unwrap();
    }
    let integrator = step.map_or("max_step = \"0.1 s\"".to_owned(), |step| format!("step = \"{step}\""));
    let text = TEXT.replace("INTEGRATOR", &integrator).replace("PERSISTENCE", persistence);
    let document = Document::parse("test.toml", &text, folder.path(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let Compiled { model, state, .. } = compile(&document).unwrap_or_else(|error| panic!("{error}"));
    (model, state)
}

/// The scene some steps after its start, where cells touch each other and the floor.
pub fn after(model: &Model, mut state: State, steps: usize) -> (State, Workspace) {
    let mut ws = Workspace::new(model);
    begin_chemistry(model, &mut state, &mut ws).unwrap();
    for _ in 0..steps {
        step(model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    (state, ws)
}
