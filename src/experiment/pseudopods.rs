//! Pseudopods: what documents say of them, and what it means.

use crate::cell::Behaviour;
use crate::cell::inhibition::{Inhibition, Touch};
use crate::cell::motility::Space;
use crate::cell::pseudopods::{self as cell, Cycle, Several};
use crate::cell::turning::Turning;
use crate::units::{Angle, Force, Frequency, Length, LineStiffness, Stress, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pseudopods: the cell waits, pushes its surface out towards one side, and draws itself after while its rear lets go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pseudopods {
    /// Pressure on the surface at the axis of a pseudopod, outward.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub pressure: Stress,
    /// Half the opening of the cone, seen from the middle of the cell, in which the surface is pushed; the pressure falls to 0 at its border.
    #[serde(default = "default_half_angle")]
    pub half_angle: Angle,
    /// How far the front may get ahead of where the surface of a ball with the cell's volume would be: there the pressure is gone. Without it
    /// the pressure stays.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub reach: Option<Length>,
    /// Tension with which front and rear are drawn together while the pseudopod retracts.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub contraction: Force,
    /// Fibres that draw front and rear together meanwhile, in place of `contraction`: made where the pseudopod begins to retract, gone where
    /// that ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fibres: Option<PodFibres>,
    /// What of its adhesion the rear lets go meanwhile.
    #[serde(default = "default_release")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub release: f64,
    /// Mean time before the surface is pushed out again.
    #[schemars(extend("x-minimum" = 0))]
    pub pause: Time,
    /// Mean time for which it is pushed.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub protrusion: Time,
    /// Mean time for which front and rear are drawn together.
    #[schemars(extend("x-minimum" = 0))]
    pub retraction: Time,
    /// How far these times vary, over their mean, both ways.
    #[serde(default = "default_variation")]
    #[schemars(range(min = 0.0, max = 0.9))]
    pub variation: f64,
    /// Share of pseudopods that split off from the last; the others start anew in any direction.
    #[serde(default = "default_split")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub split: f64,
    /// Angle between a pseudopod that splits off and the last.
    #[serde(default = "default_angle")]
    pub angle: Angle,
    /// Standard deviation of that angle.
    #[serde(default = "default_spread")]
    pub spread: Angle,
    /// Share of those that go to the other side than the last did.
    #[serde(default = "default_alternation")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub alternation: f64,
    /// Whether pseudopods lie in the plane of the substrate or anywhere in space.
    #[serde(default)]
    pub space: Space,
    /// How many there are at once at most.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 4))]
    pub most: u32,
    /// How often another begins while there are some and fewer than `most`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub beside: Option<Frequency>,
    /// Share of pseudopods that are given up when their protrusion ends: they are drawn in while their own front lets go. Where there are
    /// several, those that go less well with the cue are given up besides. None are when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub abandon: Option<f64>,
    /// What the cell makes of meeting other cells: a front that touches them is given up, and the next ones lead away. Nothing when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_inhibition: Option<ContactInhibition>,
}

/// Contact inhibition of locomotion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactInhibition {
    /// Share of the front that touches others at which the pseudopod is given up.
    #[serde(default = "default_share")]
    #[schemars(range(max = 1.0), extend("exclusiveMinimum" = 0))]
    pub share: f64,
    /// How much directions away from where the cell is touched are likelier.
    #[serde(default = "default_turn")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub turn: f64,
    /// Whose touch counts.
    #[serde(default)]
    pub by: InhibitedBy,
}

/// Whose touch counts for contact inhibition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum InhibitedBy {
    /// That of every other cell.
    #[default]
    All,
    /// That of other cells of the same type.
    OwnType,
    /// That of cells of other types.
    OtherTypes,
}

/// Fibres between front and rear of a pseudopod.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PodFibres {
    /// How many each pseudopod makes. Each has an atom of its own at both ends.
    #[schemars(range(min = 1, max = 10_000))]
    pub number: u32,
    /// Stiffness of each at full activation: it pulls with that times its length.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub stiffness: LineStiffness,
}

const fn default_share() -> f64 {
    0.2
}

const fn default_turn() -> f64 {
    4.0
}

const fn one() -> u32 {
    1
}

fn degrees(degrees: f64) -> Angle {
    Angle::new(degrees.to_radians())
}

fn default_half_angle() -> Angle {
    degrees(45.0)
}

const fn default_release() -> f64 {
    1.0
}

const fn default_variation() -> f64 {
    0.5
}

/// Of those that start off the last one, and how often they alternate: Bosgraaf and van Haastert 2009.
const fn default_split() -> f64 {
    0.7
}

fn default_angle() -> Angle {
    degrees(60.0)
}

fn default_spread() -> Angle {
    degrees(15.0)
}

const fn default_alternation() -> f64 {
    0.75
}

impl Pseudopods {
    /// The shortest that a cycle may be, s.
    pub(super) fn shortest_cycle(&self) -> f64 {
        let whole: f64 = [self.pause, self.protrusion, self.retraction].iter().map(|time| time.value()).sum();
        (1.0 - self.variation) * whole
    }

    /// The most fibres that all pseudopods of a cell make together.
    pub(super) fn fibres_at_once(&self) -> u32 {
        self.most * self.fibres.as_ref().map_or(0, |fibres| fibres.number)
    }

    /// What cells do by themselves.
    pub(super) fn behaviour(&self) -> Behaviour {
        let times = [self.pause, self.protrusion, self.retraction];
        Behaviour::Pseudopods(cell::Pseudopods {
            pressure: self.pressure.value(),
            least_cosine: self.half_angle.value().cos(),
            reach: self.reach.map_or(f64::INFINITY, |reach| reach.value()),
            contraction: self.contraction.value(),
            fibres: self
                .fibres
                .as_ref()
                .map(|fibres| cell::PodFibres { number: fibres.number as usize, stiffness: fibres.stiffness.value() }),
            release: self.release,
            cycle: Cycle { means: times.map(|time| time.value()), variation: self.variation },
            turning: Turning {
                split: self.split,
                angle: self.angle.value(),
                spread: self.spread.value(),
                alternation: self.alternation,
                space: self.space,
            },
            several: Several {
                most: self.most as usize,
                rate: self.beside.filter(|_| self.most > 1).map_or(0.0, |rate| rate.value()),
            },
            abandon: self.abandon,
            inhibition: self.contact_inhibition.as_ref().map(ContactInhibition::meaning),
        })
    }
}

impl ContactInhibition {
    /// What it makes of meeting others.
    fn meaning(&self) -> Inhibition {
        let by = match self.by {
            InhibitedBy::All => Touch::All,
            InhibitedBy::OwnType => Touch::Own,
            InhibitedBy::OtherTypes => Touch::Others,
        };
        Inhibition { share: self.share, turn: self.turn, by }
    }
}
