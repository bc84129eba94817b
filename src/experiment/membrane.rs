//! Elastic membranes: what documents say of them, and the forces that they mean.

use super::compile::Builder;
use crate::mechanics::bending::{Bending, RestAngle};
use crate::mechanics::membrane::MembraneLaw;
use crate::mechanics::ordering::Ordering;
use crate::mechanics::tension::Tension;
use crate::mechanics::{self, Force};
use crate::units::{Energy, LineStiffness};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An elastic membrane at the surface, at rest in the shape of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// The law of its energy.
    pub law: Law,
    /// Shear modulus µ at small strain.
    #[schemars(extend("x-minimum" = 0))]
    pub shear: LineStiffness,
    /// Modulus K of local area at small strain.
    #[schemars(extend("x-minimum" = 0))]
    pub area: LineStiffness,
    /// Strain hardening of the neo-Hookean law: cubic term over shear modulus.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub hardening: f64,
    /// Modulus of the total area, within which lipids flow.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub total_area: LineStiffness,
    /// Bending rigidity κ.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub bending: Energy,
    /// The shape without bending energy.
    #[serde(default)]
    pub bending_rest: BendingRest,
    /// Surface tension.
    #[serde(default)]
    pub tension: LineStiffness,
    /// Stiffness with which an atom is drawn along the surface to each neighbour, so that a surface without shear keeps its
    /// mesh in order; its shape is left alone. For closed meshes.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub ordering: LineStiffness,
}

impl Membrane {
    /// A membrane of this law with shear and area moduli, without bending, tension and hardening.
    pub fn new(law: Law, shear: LineStiffness, area: LineStiffness) -> Self {
        let (none, bending_rest) = (LineStiffness::ZERO, BendingRest::Shape);
        let (hardening, bending) = (0.0, Energy::ZERO);
        Self { law, shear, area, hardening, total_area: none, bending, bending_rest, tension: none, ordering: none }
    }
}

/// The law of a membrane's energy; both have the same response at small strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Law {
    /// Skalak (1973): hardens with the area.
    Skalak,
    /// Neo-Hookean, as rubber.
    NeoHookean,
}

/// The shape without bending energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum BendingRest {
    /// The mesh at rest.
    #[default]
    Shape,
    /// A plane.
    Flat,
}

impl Membrane {
    /// Adds its elasticity, tension, ordering and bending, those that there are.
    pub(super) fn add(&self, to: &mut Builder) {
        let rest = to.rest();
        let (shear, area) = (self.shear.value(), self.area.value());
        let law = match self.law {
            Law::Skalak => MembraneLaw::Skalak { shear, area },
            Law::NeoHookean => MembraneLaw::NeoHookean { shear, area, hardening: self.hardening },
        };
        if self.law == Law::Skalak && area < shear {
            let found = "Skalak's law needs an area modulus of at least the shear modulus";
            let help = "raise `area`, or use law = \"neo_hookean\"";
            to.fault("mechanics.membrane.area", "below the shear modulus", found, help);
        }
        if shear > 0.0 || area > 0.0 {
            let membrane = mechanics::membrane::Membrane::new(&rest.positions, &rest.facets, law);
            to.forces.push(Force::Membrane(membrane));
        }
        let (tension, total) = (self.tension.value(), self.total_area.value());
        if tension != 0.0 || total != 0.0 {
            to.forces.push(Force::Tension(Tension::new(&rest.positions, &rest.facets, tension, total)));
        }
        self.add_ordering(to);
        if self.bending.value() > 0.0 {
            let angle = match self.bending_rest {
                BendingRest::Shape => RestAngle::Remembered,
                BendingRest::Flat => RestAngle::Flat,
            };
            let bending = Bending::new(&rest.positions, &to.topology, self.bending.value(), angle);
            to.forces.push(Force::Bending(bending));
        }
    }

    fn add_ordering(&self, to: &mut Builder) {
        if self.ordering.value() > 0.0 && to.topology.is_closed() {
            let ordering = Ordering::new(to.rest().positions.len(), &to.rest().facets, self.ordering.value());
            to.forces.push(Force::Ordering(ordering));
        } else if self.ordering.value() > 0.0 {
            let found = "a surface with a border cannot be ordered: its border would be drawn inwards";
            let help = "take `ordering` out, or give the membrane a small `shear` and `area`";
            to.fault("mechanics.membrane.ordering", "on an open mesh", found, help);
        }
    }
}
