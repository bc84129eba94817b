//! Viscous membranes and bodies. What documents say of them, and what it means.

use super::compile::Inside;
use super::region;
use super::solid::Solid;
use crate::geometry::Surface;
use crate::mechanics::viscosity;
use crate::units::{self, Drag};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a surface resists being deformed at a rate, beside its elasticity: surface viscosities, also in uN s/m.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Viscosity {
    /// Surface viscosity against shear; over the shear modulus it is the time in which a membrane recovers.
    #[schemars(extend("x-minimum" = 0))]
    pub shear: Drag,
    /// Surface viscosity against dilation.
    #[schemars(extend("x-minimum" = 0))]
    pub area: Drag,
    /// Viscosity against shear of what fills a body.
    #[schemars(extend("x-minimum" = 0))]
    pub inside: units::Viscosity,
}

impl Viscosity {
    /// Whether anything is viscous.
    pub(super) fn is_any(self) -> bool {
        self.shear.value() > 0.0 || self.area.value() > 0.0 || self.inside.value() > 0.0
    }

    /// What it means for cells with this surface, filled or not with a material; none where nothing is viscous.
    pub(super) fn compiled(
        self,
        surface: &Surface,
        inside: Option<&Inside>,
        solid: Option<&Solid>,
    ) -> Option<viscosity::Viscosity> {
        let (shear, area) = (self.shear.value(), self.area.value());
        let regions = solid.map_or(&[][..], |solid| &solid.regions);
        let filling = inside.and_then(|inside| {
            let shear = region::viscosities(self.inside.value(), regions, inside, &surface.positions)?;
            Some(viscosity::inside::Inside::new(&inside.tetrahedra, shear))
        });
        let own = viscosity::Viscosity::new(&surface.facets, shear, area);
        match filling {
            Some(filling) => Some(own.with_inside(filling)),
            None => (shear > 0.0 || area > 0.0).then_some(own),
        }
    }
}
