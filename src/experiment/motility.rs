//! How cells move by themselves: what documents say of it, and what it means.

use crate::cell::Behaviour;
use crate::cell::motility::BrownianMotility;
pub use crate::cell::motility::Space;
use crate::mechanics::Force;
use crate::mechanics::attraction;
use crate::units::{Length, LineStiffness, Speed, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How cells move by themselves; nothing of it is on unless it is given.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Motility {
    /// Straight runs of random direction and exponential duration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub brownian: Option<Brownian>,
    /// A pull of every atom towards one point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attraction: Option<Attraction>,
}

/// Brownian persistence: the cell keeps its direction for a random time, then takes another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Brownian {
    /// Speed during a run.
    #[schemars(extend("x-minimum" = 0))]
    pub speed: Speed,
    /// Mean duration of a run.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub persistence: Time,
    /// Whether directions lie in the plane of the substrate or anywhere in space.
    #[serde(default)]
    pub space: Space,
}

/// A pull of every atom towards a point, the stand-in for a diffusing attractant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attraction {
    /// The point.
    pub to: [Length; 3],
    /// Force on an atom over its distance from the point.
    #[schemars(extend("x-minimum" = 0))]
    pub stiffness: LineStiffness,
}

impl Motility {
    /// What cells do by themselves.
    pub(super) fn behaviours(&self) -> Vec<Behaviour> {
        let walk = self.brownian.as_ref().map(|brownian| BrownianMotility {
            speed: brownian.speed.value(),
            persistence: brownian.persistence.value(),
            space: brownian.space,
        });
        walk.map(Behaviour::Brownian).into_iter().collect()
    }
}

impl Attraction {
    /// The force.
    pub(super) fn force(&self) -> Force {
        let (to, stiffness) = (self.to.map(|x| x.value()).into(), self.stiffness.value());
        Force::Attraction(attraction::Attraction { to, stiffness })
    }
}
