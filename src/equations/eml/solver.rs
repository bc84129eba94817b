//! How a document asks to be solved.

use super::build::Builder;
use super::document::{Level, Scheme, SolverChoice};
use super::xml::Element;

/// Names of the schemes; those with a fixed step come last.
pub const SCHEMES: [(&str, Scheme); 6] = [
    ("rk45", Scheme::Rk45),
    ("rk65", Scheme::Rk65),
    ("rosenbrock", Scheme::Rosenbrock),
    ("bdf", Scheme::Bdf),
    ("rk4", Scheme::Rk4),
    ("euler", Scheme::Euler),
];

impl Builder<'_, '_> {
    /// The solver that the document asks for.
    pub(super) fn solver(&mut self, root: &Element) -> SolverChoice {
        let mut elements = root.all("solver");
        let Some(element) = elements.next() else { return SolverChoice::default() };
        if let Some(second) = elements.next() {
            self.context.fault(second.at.clone(), "there are two solvers", "a second one", "remove one of them");
        }
        let scheme = element.attribute("scheme").map(|_| {
            let words = SCHEMES.map(|(name, _)| name);
            SCHEMES[self.choice(element, "scheme", &words)].1
        });
        let choice = SolverChoice {
            scheme,
            rtol: self.positive(element, "rtol"),
            atol: self.positive(element, "atol"),
            step: self.positive(element, "step"),
            inner_step: self.positive(element, "inner_step"),
            noise_step: self.positive(element, "noise_step"),
        };
        let fixed = matches!(scheme, Some(Scheme::Rk4 | Scheme::Euler));
        if fixed && element.attribute("inner_step").is_none() {
            let help =
                "write inner_step=\"…\" in the unit of time, or take rk45, rk65, rosenbrock or bdf, which find it";
            let message = format!("the scheme {} has no inner step", element.word("scheme"));
            self.context.fault(element.location("scheme"), &message, "a fixed step", help);
        }
        if let (Level::Field, Some(Scheme::Bdf | Scheme::Euler)) = (self.known.level, scheme) {
            let message = format!("the reactions of fields cannot be taken with {}", element.word("scheme"));
            let help =
                "write \"rk4\", \"rk45\", \"rk65\" or, for stiff reactions, \"rosenbrock\", or leave the scheme out";
            self.context.fault(element.location("scheme"), &message, "this scheme", help);
        }
        if self.known.level == Level::Membrane {
            self.refuse_of_membrane(element);
        }
        if let (Some(step), Some(inner)) = (choice.step, choice.inner_step)
            && inner > step
        {
            let message = format!("the inner step {inner} is longer than the step {step}");
            self.context.fault(element.location("inner_step"), &message, "too long", "let it be a part of `step`");
        }
        choice
    }

    /// What a document of membranes cannot ask for.
    fn refuse_of_membrane(&mut self, element: &Element) {
        let words = [
            ("scheme", "membranes have a scheme of their own: it takes diffusion implicitly and finds its step"),
            ("step", "membranes exchange numbers with the cell in every step of the run"),
        ];
        for (name, why) in words.into_iter().filter(|(name, _)| element.attribute(name).is_some()) {
            let message = format!("`{name}` has no meaning in a document of level membrane");
            let help = format!("remove it: {why}; rtol, atol, inner_step (the longest step) and noise_step can be set");
            self.context.fault(element.location(name), &message, "not used", &help);
        }
    }
}
