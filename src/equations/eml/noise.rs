//! Noise of variables: how strong it is, in which unit, and what cannot have any.

use super::build::{Builder, Use};
use super::declare::tell_at;
use super::document::{Level, MembraneDescription, NoiseDescription};
use super::membrane::{ON_SURFACE, first, micrometre};
use super::xml::Element;
use crate::equations::expression::Unit;

impl Builder<'_, '_> {
    /// The noise of all variables and fields, in the order of the text; `dimension` is that of the grid.
    pub(super) fn noise(&mut self, root: &Element, dimension: usize) -> Vec<NoiseDescription> {
        let noisy = |element: &&Element| element.attribute("noise").is_some() && element.attribute("id").is_some();
        let elements = root.all("variable").chain(root.all("field")).filter(noisy);
        elements.filter_map(|element| self.noise_of(element, dimension)).collect()
    }

    fn noise_of(&mut self, element: &Element, dimension: usize) -> Option<NoiseDescription> {
        let id = element.word("id");
        let own = self
            .unit_of(&id)
            .map(|unit| unit.times(&self.known.time.to_the(-0.5)).times(&self.spread(element, dimension)));
        let what = format!("the noise of `{id}`");
        let strength = self.attribute(element, "noise", Use::Now, own.as_ref().map(|unit| (unit, what.as_str())));
        if element.kind.name == "field" && element.word("range") != "free" {
            let message = format!("`{id}` is a concentration, which is kept from going below zero, and has noise");
            let help = "cut off at zero, noise would add substance: write range=\"free\" and a strength that vanishes at 0, such as \
                        noise=\"sqrt(2*q*max(c, 0))\"";
            tell_at(self.context, element, "noise", &message, "below zero, too", help);
        }
        let location = self.context.location(element.location("noise"), "this noise");
        Some(NoiseDescription { quantity: self.find(&id)?, strength: strength?, location })
    }

    /// The unit that a strength has more, since noise is white in space: the root of an area or a volume.
    fn spread(&self, element: &Element, dimension: usize) -> Unit {
        match self.known.level {
            Level::Field => self.known.length.to_the(0.5 * dimension as f64),
            Level::Membrane if element.word("level") != "cell" => micrometre(),
            _ => Unit::plain(),
        }
    }

    /// A scheme that cannot carry noise, and a step of noise where there is none.
    pub(super) fn check_noise(&mut self, root: &Element, noise: &[NoiseDescription]) {
        let Some(solver) = root.all("solver").next() else { return };
        let is_field = self.known.level == Level::Field;
        let noisy = root.children.iter().any(|child| child.attribute("noise").is_some());
        if solver.word("scheme") == "bdf" && noisy && !is_field {
            let message = "the scheme bdf cannot carry noise: it goes by where the system was before a kick";
            let help = "write \"rosenbrock\", which takes stiff systems too, or \"rk45\" or \"rk65\"";
            tell_at(self.context, solver, "scheme", message, "looks back", help);
        }
        if solver.attribute("noise_step").is_some() && !noisy {
            debug_assert!(noise.is_empty());
            let message = "`noise_step` is given, but no variable has noise";
            tell_at(
                self.context,
                solver,
                "noise_step",
                message,
                "not used",
                "write noise=\"…\" at a <variable>, or remove it",
            );
        }
    }

    /// Pools are kicked as a whole: their noise cannot differ from atom to atom.
    pub(super) fn check_noise_of_pools(&mut self, membrane: &MembraneDescription, noise: &[NoiseDescription]) {
        let is_local = |quantity: u32| membrane.local[quantity as usize];
        for noise in noise.iter().filter(|noise| !is_local(noise.quantity)) {
            let declared = &self.known.quantities[noise.quantity as usize];
            let Some(used) = first(&noise.strength, &is_local) else { continue };
            let (known, given) = (&self.known.quantities, &self.known.given);
            let used = known.get(used as usize).map_or_else(|| given[used as usize - known.len()].0, |used| &used.id);
            let message =
                format!("`{}` is one number of the cell, but its noise uses `{used}`, which {ON_SURFACE}", declared.id);
            let help = format!("use its mean or sum over the surface: <mean id=\"m\">{used}</mean> or <integral>");
            tell_at(self.context, declared.element, "noise", &message, "which atom's?", &help);
        }
    }
}
