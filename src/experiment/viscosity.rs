//! Viscous membranes. What documents say of them, and what it means.

use crate::mechanics::viscosity;
use crate::units::Drag;
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
}

impl Viscosity {
    /// Whether anything is viscous.
    pub(super) fn is_any(self) -> bool {
        self.shear.value() > 0.0 || self.area.value() > 0.0
    }

    /// What it means for cells with these facets; none where nothing is viscous.
    pub(super) fn compiled(self, facets: &[[u32; 3]]) -> Option<viscosity::Viscosity> {
        let (shear, area) = (self.shear.value(), self.area.value());
        self.is_any().then(|| viscosity::Viscosity::new(facets, shear, area))
    }
}
