//! Systems with events in a run: the same as the document alone, window by window, with all that cells add.

use crate::coupled_scene::{Scene, crowd, one_cell, scene};
use crate::sbml_suite::{Case, Solved, suite};
use pseudopod::ode::{Reason, SolveOptions, solve};
use pseudopod::sim::{State, Trouble};

/// A run of systems of the scene without cells.
fn bare(until: &str, step: &str) -> String {
    format!("[run]\nuntil = \"{until}\"\nintegrator = {{ step = \"{step}\" }}\n[output]\nevery = \"{until}\"\n")
}

/// A run of one document alone, with its tolerance.
fn alone(eml: &str, until: &str, step: &str) -> Scene {
    let chemistry = "[chemistry.own]\ndocument = \"own.eml\"\nrtol = 1e-9\natol = 1e-12\n";
    scene(&[("own", eml)], &(bare(until, step) + chemistry))
}

/// The values of all quantities of the first system, in the order of its names.
fn values(scene: &Scene) -> Vec<f64> {
    let names = &scene.compiled.model.chemistry.reactors[0].program.names;
    names.iter().map(|name| scene.value(0, name, 0)).collect()
}

/// The values that the single solve of a document gives at times in its unit.
fn solved(eml: &str, times: &[f64]) -> Vec<Vec<f64>> {
    let source = pseudopod::error::Source { name: "own.eml".into(), text: eml.into() };
    let system = pseudopod::equations::read(source.into()).unwrap().document.system;
    let options = SolveOptions { relative: 1e-9, absolute: 1e-12, ..SolveOptions::default() };
    solve(&system, 0.0, times[times.len() - 1], times, &options).unwrap().values
}

const BALL: &str = r#"<eml name="own"><variable id="h" initial="1" rate="v"/><variable id="v" initial="0" rate="-9.81"/>
    <variable id="bounces" initial="0" rate="0"/>
    <event id="bounce" when="h lt 0"><set id="h">0</set><set id="v">-0.8*v</set><set id="bounces">bounces+1</set></event>
    </eml>"#;

/// Height, speed and number of bounces of the ball at a time.
fn ball(time: f64) -> [f64; 3] {
    let (mut begin, mut speed, mut bounces) = ((2.0 / 9.81_f64).sqrt(), 0.8 * (2.0 * 9.81_f64).sqrt(), 0.0);
    if time < begin {
        return [1.0 - 0.5 * 9.81 * time * time, -9.81 * time, 0.0];
    }
    loop {
        bounces += 1.0;
        let flown = time - begin;
        if flown < 2.0 * speed / 9.81 {
            return [speed * flown - 0.5 * 9.81 * flown * flown, speed - 9.81 * flown, bounces];
        }
        begin += 2.0 * speed / 9.81;
        speed *= 0.8;
    }
}

#[test]
fn a_ball_bounces_in_windows_of_any_length_when_it_should() {
    for step in ["0.0037 s", "0.037 s", "0.41 s", "3 s"] {
        let mut scene = alone(BALL, "3 s", step);
        let (times, rows): (Vec<f64>, Vec<_>) = scene.rows_until(3.0, values).into_iter().unzip();
        for ((time, row), single) in times.iter().zip(&rows).zip(solved(BALL, &times)) {
            for (index, exact) in ball(*time).into_iter().enumerate() {
                // Parabolas are exact for the method; only the times of the bounces have an error, of round-off.
                assert!((row[index] - exact).abs() < 1e-9, "{step}, {time}: {row:?} instead of {exact}");
                assert!((row[index] - single[index]).abs() < 1e-9, "{step}, {time}: {row:?} and alone {single:?}");
            }
        }
        assert_eq!(rows[rows.len() - 1][2], 6.0, "the sixth bounce is at 2.68 s");
    }
}

/// A dose is ordered every hour, and given a quarter of an hour later.
const DOSES: &str = r#"<eml name="own" time_unit="h"><variable id="drug" initial="0" rate="-k*drug"/>
    <parameter id="k" value="1.3"/><variable id="due" initial="0" rate="0"/><variable id="given" initial="0" rate="0"/>
    <event id="dose" when="time ge due" delay="0.25" values_from="execution">
    <set id="drug">drug+1</set><set id="due">due+1</set><set id="given">given+1</set></event></eml>"#;

fn drug(hours: f64) -> f64 {
    let given = (0..6).map(|n| f64::from(n) + 0.25).filter(|time| *time <= hours);
    given.map(|time| (-1.3 * (hours - time)).exp()).sum()
}

#[test]
fn doses_are_given_late_and_decay_as_in_a_single_solve() {
    for step in ["1.1 min", "7 min", "23 min", "2 h"] {
        let mut scene = alone(DOSES, "6 h", step);
        let rows = scene.rows_until(21600.0, |scene| scene.value(0, "drug", 0));
        let (times, rows): (Vec<f64>, Vec<f64>) = rows.into_iter().map(|(time, drug)| (time / 3600.0, drug)).unzip();
        assert_eq!(scene.value(0, "given", 0), 6.0, "{step}");
        let single = solved(DOSES, &times);
        for ((time, found), single) in times.iter().zip(&rows).zip(single) {
            // The tolerance asked is 1e-9; over 6 h its errors add.
            assert!((found - drug(*time)).abs() < 2e-8, "{step}, {time} h: {found} instead of {}", drug(*time));
            assert!((found - single[0]).abs() < 2e-8, "{step}, {time} h: {found} and alone {}", single[0]);
        }
    }
}

#[test]
fn what_waits_for_its_execution_goes_on_from_a_checkpoint_to_the_last_bit() {
    let whole = |stop: &dyn Fn(&mut Scene)| {
        let mut scene = alone(DOSES, "6 h", "7 min");
        while scene.state().time < 21600.0 {
            scene.step().unwrap();
            // Ordered at 60 min, given at 75 min.
            if (scene.state().time - 63.0 * 60.0).abs() < 1.0 {
                stop(&mut scene);
            }
        }
        scene.compiled.state
    };
    let plain = whole(&|_| ());
    assert_eq!(plain, whole(&Scene::stop_and_resume));
    let forgetful = whole(&|scene| {
        let fresh = alone(DOSES, "6 h", "7 min");
        scene.compiled.state.chemistry.events = fresh.compiled.state.chemistry.events;
    });
    assert_ne!(plain, forgetful, "something waits at the checkpoint");
}

#[test]
fn an_event_at_the_end_of_a_window_happens_once() {
    // Steps of 1/4 s end exactly at 1 s and 1.5 s.
    let eml = r#"<eml name="own"><variable id="x" initial="0" rate="1"/>
        <variable id="at" initial="0" rate="0"/><variable id="after" initial="0" rate="0"/>
        <variable id="late" initial="0" rate="0"/><variable id="level" initial="0" rate="0"/>
        <variable id="first" initial="0" rate="0"/><variable id="waits" initial="0" rate="0"/>
        <event when="time ge 1"><set id="at">at+1</set></event>
        <event when="time gt 1"><set id="after">after+1</set></event>
        <event when="time ge 1" delay="0.5" values_from="execution"><set id="late">late+1</set></event>
        <event when="x ge 1"><set id="level">level+1</set></event>
        <event when="x lt 1.25" at_start="fire"><set id="first">first+1</set></event>
        <event when="x lt 1.25" at_start="wait"><set id="waits">waits+1</set></event></eml>"#;
    for step in ["0.25 s", "0.5 s", "0.1 s", "2 s"] {
        let mut scene = alone(eml, "2 s", step);
        scene.begin();
        assert_eq!(scene.value(0, "first", 0), 1.0, "what happens at the start is there at the start");
        let quarters = step == "0.25 s" || step == "0.5 s";
        while scene.state().time < 2.0 {
            scene.step().unwrap();
            let time = scene.state().time;
            if quarters {
                assert_eq!(scene.value(0, "at", 0), if time >= 1.0 { 1.0 } else { 0.0 }, "{time}");
                assert_eq!(scene.value(0, "after", 0), if time > 1.0 { 1.0 } else { 0.0 }, "{time}");
                assert_eq!(scene.value(0, "late", 0), if time >= 1.5 { 1.0 } else { 0.0 }, "{time}");
            }
        }
        for (id, count) in [("at", 1.0), ("after", 1.0), ("late", 1.0), ("level", 1.0), ("first", 1.0), ("waits", 0.0)]
        {
            assert_eq!(scene.value(0, id, 0), count, "{step}: {id}");
        }
    }
}

#[test]
fn what_does_not_persist_is_dropped_windows_later() {
    for (persistent, count) in [("true", 1.0), ("false", 0.0)] {
        let eml = r#"<eml name="own"><variable id="x" initial="0" rate="1"/><variable id="n" initial="0" rate="0"/>
            <event when="x gt 2 and x lt 3" delay="2" persistent="YES"><set id="n">1</set></event></eml>"#;
        let mut scene = alone(&eml.replace("YES", persistent), "6 s", "0.3 s");
        scene.run();
        assert_eq!(scene.value(0, "n", 0), count, "persistent: {persistent}");
    }
}

/// A cell of the speed 1 um/s along x, in a field that rises there.
fn swimmer(own: &str) -> Scene {
    let field = r#"<eml name="field"><grid dimension="2" spacing="4" origin="-60 -60" size="160 120"/>
        <field id="c" initial="200 + 2*x"/><field id="trace" initial="0"/></eml>"#;
    scene(&[("field", field), ("own", own)], &one_cell("20 s", "0.1 s"))
}

#[test]
fn a_cell_switches_when_the_field_that_it_senses_passes_a_threshold() {
    let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><parameter id="speed" value="1"/>
        <variable id="factor" initial="1" rate="0"/><variable id="rate" initial="0" rate="0"/>
        <variable id="when_on" initial="-1" rate="0"/>
        <event id="on" when="c gt 220.1"><set id="factor">4</set><set id="rate">3</set><set id="when_on">time</set></event>
        <event id="off" when="c gt 230.1"><set id="rate">0</set></event>
        <link from="field[c]" to="system.c"/><link from="system.speed" to="cell.motility.bias.x"/>
        <link from="system.factor" to="cell.stiffness"/><link from="system.rate" to="cell.secretion[trace]"/></eml>"#;
    let mut scene = swimmer(own);
    let mut switched = Vec::new();
    while scene.state().time < 20.0 {
        let before = scene.state().chemistry.controls.stiffness_of(0);
        scene.step().unwrap();
        let after = scene.state().chemistry.controls.stiffness_of(0);
        if before != after {
            switched.push((scene.state().time, before, after));
        }
    }
    // c = 200 + 2 t passes 220.1 in the step to 10.1 s; the links tell the system then, which acts at once, and the
    // cell is stiff at the end of the next step.
    assert_eq!(switched.len(), 1, "{switched:?}");
    let (time, before, after) = switched[0];
    assert!((time - 10.2).abs() < 1e-9 && (before, after) == (1.0, 4.0), "{switched:?}");
    assert!((scene.value(0, "when_on", 0) - 10.1).abs() < 1e-9, "{}", scene.value(0, "when_on", 0));
    // Secretion of 3 per second from 10.2 s until 15.2 s.
    let values = &scene.state().chemistry.fields[0].values;
    let trace = values[values.len() / 2..].iter().sum::<f64>() * 16.0;
    assert!((trace - 15.0).abs() < 1e-9, "{trace}");
}

#[test]
fn what_events_set_at_the_start_is_carried_at_the_start() {
    let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><variable id="factor" initial="1" rate="0"/>
        <event id="on" when="c gt 150"><set id="factor">4</set></event>
        <link from="field[c]" to="system.c"/><link from="system.factor" to="cell.stiffness"/></eml>"#;
    let mut scene = swimmer(own);
    scene.begin();
    assert_eq!(scene.state().chemistry.controls.stiffness_of(0), 4.0);
}

/// Cells at places of their own, whose clocks run and whose events come as their places say.
fn crowd_after(threads: usize, before: impl Fn(&mut Scene) + Sync) -> State {
    let own = r#"<eml name="own" level="cell"><input id="x" default="0"/><variable id="u" initial="0" rate="1+0.01*x-0.3*u"/>
        <variable id="n" initial="0" rate="0"/><variable id="w" initial="1" rate="0.2*n-w"/>
        <event id="reset" when="u gt 1.5" delay="0.4+0.003*x"><set id="u">0.1*u</set><set id="n">n+1</set></event>
        <event id="tick" when="time ge 3*(n+1)" priority="2"><set id="w">w+0.5</set></event>
        <link from="cell.position.x" to="system.x"/><link from="system.w" to="cell.motility.bias.y" gain="0.2"/></eml>"#;
    let scene = crowd(threads, &[("own", own)], 24, before);
    let counts: Vec<f64> = (0..37).map(|cell| scene.value(0, "n", cell)).collect();
    assert!(counts.iter().any(|n| *n > counts[0]) && counts.iter().all(|n| *n > 0.0), "{counts:?}");
    scene.compiled.state
}

#[test]
fn threads_scratch_and_checkpoints_do_not_matter_to_cells_with_events() {
    let plain = crowd_after(1, |_| ());
    assert_eq!(plain, crowd_after(2, |_| ()), "threads");
    assert_eq!(plain, crowd_after(3, |_| ()), "threads");
    assert_eq!(plain, crowd_after(1, |scene| scene.ws.poison(&scene.compiled.model)), "scratch");
    assert_eq!(plain, crowd_after(2, Scene::stop_and_resume), "checkpoints");
}

#[test]
fn events_without_end_are_trouble_of_a_cell_and_the_state_stays() {
    let own = r#"<eml name="own" level="cell"><input id="x" default="0"/><variable id="t" initial="0" rate="1"/>
        <variable id="y" initial="0" rate="0"/><link from="cell.position.x" to="system.x"/>
        <event id="up" when="t gt 1.23 and x gt 5 and y lt 0.5"><set id="y">1</set></event>
        <event id="down" when="y gt 0.5"><set id="y">0</set></event></eml>"#;
    let text = one_cell("4 s", "0.5 s")
        + "placement = { at = [[\"0 um\", \"0 um\", \"0 um\"], [\"30 um\", \"0 um\", \"0 um\"]] }\n";
    let mut scene = scene(&[("own", own)], &text);
    let trouble = scene.until_trouble();
    let text = trouble.to_string();
    let Trouble::System { system, owner, time, reason, .. } = trouble else { panic!("{text}") };
    assert_eq!((system.as_str(), owner, reason), ("own", Some(("cell".to_owned(), 1)), Reason::EndlessEvents));
    assert!((time - 1.23).abs() < 1e-9, "{time}");
    assert!(text.contains("event 'up'") || text.contains("event 'down'"), "{text}");
}

#[test]
fn what_an_event_of_a_model_sets_is_recorded_and_stays_set() {
    let sbml = r#"<?xml version="1.0" encoding="UTF-8"?>
        <sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1"><model id="m">
        <listOfParameters><parameter id="x" value="0" constant="false"/><parameter id="k" value="1" constant="false"/>
        <parameter id="a" value="2" constant="true"/></listOfParameters>
        <listOfRules><rateRule variable="x"><math xmlns="http://www.w3.org/1998/Math/MathML"><ci>k</ci></math></rateRule></listOfRules>
        <listOfEvents><event id="e" useValuesFromTriggerTime="true"><trigger initialValue="true" persistent="true">
        <math xmlns="http://www.w3.org/1998/Math/MathML"><apply><gt/><ci>x</ci><cn>1</cn></apply></math></trigger>
        <listOfEventAssignments><eventAssignment variable="k"><math xmlns="http://www.w3.org/1998/Math/MathML"><cn>3</cn></math>
        </eventAssignment></listOfEventAssignments></event></listOfEvents></model></sbml>"#;
    let mut scene = alone(sbml, "4 s", "0.3 s");
    let recorded: Vec<&str> =
        scene.compiled.model.chemistry.reactors[0].recorded.iter().map(|(_, id, _)| id.as_str()).collect();
    assert_eq!(recorded, ["x", "k"]);
    scene.run();
    assert_eq!(scene.value(0, "k", 0), 3.0);
    assert!((scene.value(0, "x", 0) - 10.0).abs() < 1e-9, "1 + 3·3, not {}", scene.value(0, "x", 0));
}

#[test]
fn the_suites_events_agree_by_its_own_rule_in_windows() {
    // Windows of a fraction of the time between two results, and one that divides it.
    for share in [0.37, 0.25] {
        suite("events", 10, &|case| in_windows(case, share));
    }
}

/// A case of the suite as a system of the scene, in windows of a share of the time between its results.
fn in_windows(case: &Case, share: f64) -> Solved {
    let (times, last) = (&case.times, case.times[case.times.len() - 1]);
    let (step, absolute) = (share * (times[1] - times[0]), 1e-6 * case.absolute.min(1e-6));
    let chemistry = format!("[chemistry.own]\ndocument = \"own.eml\"\nrtol = 1e-8\natol = {absolute:e}\n");
    let text = bare(&format!("{last} s"), &format!("{step} s")) + &chemistry;
    let mut scene = scene(&[("own", &std::fs::read_to_string(&case.file).unwrap())], &text);
    scene.compiled.model.kinks.extend(times);
    scene.begin();
    let mut rows = Vec::new();
    for &time in times {
        while scene.state().time < time - 1e-9 {
            scene.step().map_err(|trouble| trouble.to_string())?;
        }
        rows.push(values(&scene));
    }
    Ok(rows)
}
