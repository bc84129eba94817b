//! Ten problems of reaction and diffusion at the tolerance that a document has which names none, against the method of lines.

use std::sync::Arc;

use pseudopod::equations::eml;
use pseudopod::error::{Error, Fault, Source};
use pseudopod::field::{FieldSystem, Fields, Stepping};

/// A problem on a strip of 100 by 4 boxes between closed walls.
struct Problem {
    name: &'static str,
    /// The edge of a box, µm.
    spacing: f64,
    /// Until when, s.
    until: f64,
    parameters: &'static [(&'static str, f64)],
    /// Name, diffusion coefficient in µm²/s, start, reaction.
    fields: &'static [[&'static str; 4]],
    attributes: &'static str,
}

const BRUSSELATOR: [&str; 2] = ["A - (B + 1)*U + U^2*V", "B*U - U^2*V"];

const PROBLEMS: [Problem; 12] = [
    Problem {
        name: "Brusselator: a pattern out of a ripple without period",
        spacing: 1.0,
        until: 30.0,
        parameters: &[("A", 4.5), ("B", 7.0)],
        fields: &[
            ["U", "2", "A + 0.1*sin(12.9898*x + 78.233*x^2)", BRUSSELATOR[0]],
            ["V", "16", "B/A", BRUSSELATOR[1]],
        ],
        attributes: "",
    },
    Problem {
        name: "Brusselator: growth just above the threshold at 6.71",
        spacing: 1.0,
        until: 40.0,
        parameters: &[("A", 4.5), ("B", 6.8)],
        fields: &[["U", "2", "A + 0.01*cos(pi*x/100*29)", BRUSSELATOR[0]], ["V", "16", "B/A", BRUSSELATOR[1]]],
        attributes: "",
    },
    Problem {
        name: "Brusselator: decay just below it",
        spacing: 1.0,
        until: 40.0,
        parameters: &[("A", 4.5), ("B", 6.6)],
        fields: &[["U", "2", "A + 0.01*cos(pi*x/100*29)", BRUSSELATOR[0]], ["V", "16", "B/A", BRUSSELATOR[1]]],
        attributes: "",
    },
    Problem {
        name: "Brusselator: oscillations and waves",
        spacing: 0.5,
        until: 50.0,
        parameters: &[("A", 1.0), ("B", 3.0)],
        fields: &[["U", "1", "1 + exp(-(x - 10)^2/8)", BRUSSELATOR[0]], ["V", "0.5", "3", BRUSSELATOR[1]]],
        attributes: "",
    },
    Problem {
        name: "predator and prey (Rosenzweig and MacArthur 1963)",
        spacing: 1.0,
        until: 150.0,
        parameters: &[("half", 0.4), ("yield", 2.0), ("death", 0.6)],
        fields: &[
            ["N", "1", "0.6 + 0.2*exp(-(x - 20)^2/50)", "N*(1 - N) - N*P/(N + half)"],
            ["P", "1", "0.3 + 0.1*exp(-(x - 60)^2/200)", "yield*N*P/(N + half) - death*P"],
        ],
        attributes: "",
    },
    Problem {
        name: "Oregonator (Tyson and Fife 1980)",
        spacing: 0.5,
        until: 12.0,
        parameters: &[("eps", 0.04), ("q", 0.002), ("f", 1.4)],
        fields: &[
            ["U", "1", "0.01 + 0.8*exp(-(x - 5)^2/4)", "(U - U^2 - f*V*(U - q)/(U + q))/eps"],
            ["V", "0.6", "0.01", "U - V"],
        ],
        attributes: "",
    },
    Problem {
        name: "Gray and Scott: spots that split",
        spacing: 1.0,
        until: 2000.0,
        parameters: &[("F", 0.037), ("k", 0.06)],
        fields: &[
            ["U", "0.16", "1 - 0.5*exp(-(x - 50)^2/30)", "F*(1 - U) - U*V^2"],
            ["V", "0.08", "0.25*exp(-(x - 50)^2/30)", "U*V^2 - (F + k)*V"],
        ],
        attributes: "",
    },
    Problem {
        name: "FitzHugh and Nagumo: a pulse",
        spacing: 1.0,
        until: 100.0,
        parameters: &[],
        fields: &[
            ["U", "1", "-1.2 + 2.5*exp(-(x - 5)^2/20)", "U - U^3/3 - V"],
            ["V", "0", "-0.62", "0.08*(U + 0.7 - 0.8*V)"],
        ],
        attributes: "range=\"free\"",
    },
    Problem {
        name: "Schnakenberg: a pattern",
        spacing: 0.5,
        until: 60.0,
        parameters: &[],
        fields: &[
            ["U", "1", "1 + 0.02*sin(12.9898*x + 78.233*x^2)", "0.1 - U + U^2*V"],
            ["V", "20", "0.9", "0.9 - U^2*V"],
        ],
        attributes: "",
    },
    Problem {
        name: "three species that beat each other in a circle (May and Leonard 1975)",
        spacing: 1.0,
        until: 60.0,
        parameters: &[],
        fields: &[
            ["U", "1", "0.3 + 0.1*cos(0.1*x)", "U*(1 - U - V - W - 1.5*V)"],
            ["V", "1", "0.3 + 0.1*sin(0.13*x)", "V*(1 - U - V - W - 1.5*W)"],
            ["W", "1", "0.3 + 0.1*cos(0.07*x + 1)", "W*(1 - U - V - W - 1.5*U)"],
        ],
        attributes: "",
    },
    Problem {
        name: "Fisher's front",
        spacing: 0.5,
        until: 15.0,
        parameters: &[],
        fields: &[["U", "1", "exp(-x)", "U*(1 - U)"]],
        attributes: "",
    },
    Problem {
        name: "Nagumo's front",
        spacing: 0.5,
        until: 40.0,
        parameters: &[],
        fields: &[["U", "1", "1/(1 + exp((x - 10)/1.4))", "U*(1 - U)*(U - 0.3)"]],
        attributes: "",
    },
];

/// Windows that a problem is cut into: so often a run might exchange with cells.
const WINDOWS: usize = 40;

impl Problem {
    fn system(&self) -> FieldSystem {
        let parameters =
            self.parameters.iter().map(|(id, value)| format!("<parameter id=\"{id}\" value=\"{value}\"/>"));
        let fields = self.fields.iter().map(|[id, diffusion, start, reaction]| {
            let attributes = self.attributes;
            format!(
                "<field id=\"{id}\" diffusion=\"{diffusion}\" initial=\"{start}\" {attributes}><reaction>{reaction}</reaction></field>"
            )
        });
        let text = format!(
            "<eml name=\"problem\" level=\"field\">{}<grid dimension=\"2\" spacing=\"{}\" origin=\"0 0\" size=\"{} {}\"/>{}</eml>",
            parameters.collect::<String>(),
            self.spacing,
            100.0 * self.spacing,
            4.0 * self.spacing,
            fields.collect::<String>()
        );
        let document = eml::read(Arc::new(Source { name: "problem.eml".into(), text }));
        FieldSystem::new(&document.expect("a good document"), None).expect("a good grid")
    }
}

/// The largest over all species of the root mean square of the difference over the range that the species has in the whole run.
fn off(found: &[Fields], exact: &[Fields]) -> f64 {
    let of = |species: usize| {
        let all = exact.iter().flat_map(|fields| fields.values(species));
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (x.min(low), x.max(high)));
        let pairs = found.iter().zip(exact).map(|(found, exact)| (found.values(species), exact.values(species)));
        let apart = pairs.map(|(found, exact)| {
            let squares = found.iter().zip(exact).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            (squares / found.len() as f64).sqrt()
        });
        apart.fold(0.0, f64::max) / (high - low)
    };
    (0..exact[0].species().len()).map(of).fold(0.0, f64::max)
}

/// What a problem comes to at a tolerance.
struct Outcome {
    /// Off the method of lines, over the range.
    off: f64,
    steps: u32,
    rejected: u32,
}

/// The fields of a system where they start.
fn start_of(system: &FieldSystem) -> Fields {
    let none = |_: &eml::Profile, _: &_| Err(Error::input(Fault::new("no file was expected")));
    system.start(&none).expect("good profiles")
}

/// Fields at a time, in equal windows at the default tolerance, with the steps that it took.
fn in_windows(system: &FieldSystem, start: &Fields, until: f64, windows: u32) -> (Fields, u32) {
    let (relative, absolute) = system.usual_tolerance();
    let (mut fields, mut steps) = (start.clone(), 0);
    for _ in 0..windows {
        let window = until / f64::from(windows);
        let report = system.advance(&mut fields, window, &[], Stepping::Adaptive { relative, absolute });
        steps += report.expect("a window").steps;
    }
    (fields, steps)
}

/// The courses of a problem, windows apart: by the method of lines, and at some tolerances with what they came to.
fn outcomes(problem: &Problem, tolerances: &[(f64, f64)]) -> Vec<Outcome> {
    let system = problem.system();
    let start = start_of(&system);
    let window = problem.until / WINDOWS as f64;
    let mut exact = vec![start.clone()];
    for _ in 0..WINDOWS {
        let last = exact.last().expect("a start");
        exact.push(system.reference(last, window, &[], 1e-9, 1e-12).expect("the method of lines"));
    }
    let outcome = |&(relative, absolute): &(f64, f64)| {
        let (mut found, mut steps, mut rejected) = (vec![start.clone()], 0, 0);
        for _ in 0..WINDOWS {
            let mut next = found.last().expect("a start").clone();
            let report = system.advance(&mut next, window, &[], Stepping::Adaptive { relative, absolute });
            let report = report.expect("a window");
            (steps, rejected) = (steps + report.steps, rejected + report.rejected);
            found.push(next);
        }
        Outcome { off: off(&found, &exact), steps, rejected }
    };
    tolerances.iter().map(outcome).collect()
}

#[test]
fn ten_problems_and_more_are_within_a_hundredth_of_their_range_at_the_default_tolerance() {
    for problem in &PROBLEMS {
        let Outcome { off, steps, rejected } = outcomes(problem, &[problem.system().usual_tolerance()])[0];
        println!("{}: {:.3} % off, {steps} steps, {rejected} rejected", problem.name, 100.0 * off);
        assert!(off < 0.01, "{}: {off}", problem.name);
    }
}

/// What begins at nothing is wrong by the same part of itself in the first step, however short that is, and does not end the run.
#[test]
fn what_begins_at_nothing_with_whole_and_broken_powers_is_made() {
    let problem = Problem {
        name: "a cascade",
        spacing: 1.0,
        until: 5.0,
        parameters: &[],
        fields: &[
            ["U", "1", "0", "1"],
            ["V", "1", "0", "U^4/(1 + U^4)"],
            ["W", "1", "0", "sqrt(U)"],
            ["X", "0.1", "0", "V^1.1/(1 + V^1.1)"],
        ],
        attributes: "",
    };
    let system = problem.system();
    let start = start_of(&system);
    let exact = system.reference(&start, 5.0, &[], 1e-10, 1e-13).expect("the method of lines");
    let (relative, _) = system.usual_tolerance();
    for windows in [1, 9] {
        let (fields, steps) = in_windows(&system, &start, 5.0, windows);
        let off = |species: usize| (fields.values(species)[0] / exact.values(species)[0] - 1.0).abs();
        println!("{windows} windows, {steps} steps: {:?} off", [0, 1, 2, 3].map(off));
        // One tolerance: the errors of its steps do not add up beyond it.
        assert!((0..4).all(|species| off(species) < relative) && steps < 200, "{steps} {:?}", [0, 1, 2, 3].map(off));
    }
}

/// Where a rate jumps no step is as wrong as its length to a power: it is passed in short steps, and does not end the run.
#[test]
fn a_rate_that_jumps_in_all_boxes_at_once_is_passed() {
    let problem = Problem {
        name: "a switch",
        spacing: 1.0,
        until: 2.0,
        parameters: &[],
        fields: &[["U", "1", "0.001", "piecewise(1, U lt 0.5, 0.1)"]],
        attributes: "",
    };
    let system = problem.system();
    let (start, (relative, _)) = (start_of(&system), system.usual_tolerance());
    for windows in [1, 7, 1000] {
        let (fields, steps) = in_windows(&system, &start, 2.0, windows);
        // At 0.499 s it is 0.5, and rises at a tenth of the rate from then on.
        let off = fields.values(0).iter().map(|u| (u - (0.5 + 0.1 * (2.0 - 0.499))).abs()).fold(0.0, f64::max);
        println!("{windows} windows: {off:e} off, {steps} steps");
        // The step in which it jumps is wrong by a hundredth of the tolerance.
        assert!(off < 0.01 * relative && steps < windows + 200, "{windows}: {off:e}, {steps} steps");
    }
}

#[test]
#[ignore = "slow: a minute; prints the table by which the default tolerance of fields is chosen"]
fn the_default_tolerance_is_chosen_by_a_table() {
    let tolerances = [3e-2, 1e-2, 3e-3, 1e-3].map(|relative| (relative, 0.0));
    for problem in &PROBLEMS {
        let row = outcomes(problem, &tolerances);
        let cell = |outcome: &Outcome| format!("| {:.3} %, {} ", 100.0 * outcome.off, outcome.steps);
        println!("| {} {}|", problem.name, row.iter().map(cell).collect::<String>());
        assert!(row[3].off < 0.01, "{}", problem.name);
    }
}
