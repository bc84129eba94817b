//! What a living cell does with mechanics and chemistry: it wanders, is drawn along, senses, secretes, and changes what
//! it is made of as its chemistry tells.
//!
//! Every behaviour is one file: its parameters, how it begins and how it goes on. [`Behaviour`] is the one list of them, and
//! [`BehaviourState`] of what they remember.

mod choices;
pub mod ends;
pub mod inhibition;
pub mod motility;
mod pods;
pub mod pseudopods;
pub mod turning;

use serde::{Deserialize, Serialize};

use crate::Vec3;
use motility::{BrownianMotility, Walk};
use pseudopods::{EndedPseudopod, PodState, Pseudopods, Told};

/// What a cell does by itself, step by step. It asks for a velocity, and the force that overcomes the drag of this velocity drives
/// the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Behaviour {
    /// Brownian persistence.
    Brownian(BrownianMotility),
    /// A velocity that chemistry sets.
    Bias,
    /// Pseudopods: they ask for no velocity, but push and draw the cell's own atoms.
    Pseudopods(Pseudopods),
}

/// What one cell remembers of a behaviour: part of the state.
#[allow(clippy::large_enum_variant)] // all cells of a type have the same variant, and a state that is copied must not allocate
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum BehaviourState {
    /// Where its walk is.
    Brownian(Walk),
    /// Nothing.
    Bias,
    /// Where its pseudopods are.
    Pseudopods(PodState),
}

impl BehaviourState {
    /// Whether all that a cell waits for is still to come: from clocks far below zero it would go through run after run without end.
    pub fn can_go_on(&self) -> bool {
        // What round-off may leave below zero, s.
        let is_left = |left: f64| left > -1e-6;
        match self {
            Self::Brownian(walk) => is_left(walk.left),
            Self::Bias => true,
            Self::Pseudopods(state) => state.clocks().all(is_left),
        }
    }
}

/// What came to an end in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ended {
    /// A motility run that lasted so long, s.
    Run(f64),
    /// A pseudopod's protrusion.
    Pseudopod(EndedPseudopod),
}

/// What behaviours of a cell depend on beside what they remember.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circumstances {
    /// Seed of the run.
    pub seed: u64,
    /// The cell, as random streams are addressed.
    pub cell: u64,
    /// The speed that is set, µm/s; none where the behaviour's own stands.
    pub speed: Option<f64>,
    /// The velocity that is set, µm/s.
    pub bias: [f64; 3],
    /// What its pseudopods are told.
    pub pseudopods: Told,
}

impl Behaviour {
    /// What a cell remembers where a run begins.
    pub fn start(&self, seed: u64, cell: u64) -> BehaviourState {
        match self {
            Self::Brownian(motility) => BehaviourState::Brownian(motility.start(seed, cell)),
            Self::Bias => BehaviourState::Bias,
            Self::Pseudopods(pods) => BehaviourState::Pseudopods(pods.start(seed, cell)),
        }
    }

    /// Whether it is its own that a cell remembers.
    pub fn owns(&self, state: &BehaviourState) -> bool {
        match self {
            Self::Brownian(_) => matches!(state, BehaviourState::Brownian(_)),
            Self::Bias => matches!(state, BehaviourState::Bias),
            Self::Pseudopods(_) => matches!(state, BehaviourState::Pseudopods(_)),
        }
    }

    /// Its own speed, µm/s, if it has one that may be set.
    pub fn speed(&self) -> Option<f64> {
        match self {
            Self::Brownian(motility) => Some(motility.speed),
            Self::Bias | Self::Pseudopods(_) => None,
        }
    }

    /// Goes on by `dt` (s) and returns the mean velocity that it asks for meanwhile, µm/s. `ended(what, offset)` is told of what
    /// ends, `offset` seconds after the start. At `dt` zero the velocity of the moment is returned and nothing changes.
    ///
    /// # Panics
    /// When the state is of another behaviour; see [`Behaviour::owns`].
    pub fn advance(
        &self,
        dt: f64,
        now: &Circumstances,
        state: &mut BehaviourState,
        mut ended: impl FnMut(Ended, f64),
    ) -> Vec3 {
        match (self, state) {
            (Self::Brownian(motility), BehaviourState::Brownian(walk)) => {
                let motility = BrownianMotility { speed: now.speed.unwrap_or(motility.speed), ..*motility };
                motility.advance(now.seed, now.cell, walk, dt, |duration, offset| ended(Ended::Run(duration), offset))
            }
            (Self::Bias, BehaviourState::Bias) => now.bias.into(),
            (Self::Pseudopods(pods), BehaviourState::Pseudopods(state)) => {
                pods.advance(now.seed, now.cell, &now.pseudopods, state, dt, |pod, offset| {
                    ended(Ended::Pseudopod(pod), offset);
                });
                Vec3::zeros()
            }
            (behaviour, state) => panic!("{behaviour:?} cannot go on from {state:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::inhibition::{Inhibition, Touch};
    use super::motility::Space;
    use super::pseudopods::{Cycle, Several};
    use super::turning::Turning;
    use super::*;

    /// One of each; a new one must be added here, or the match does not compile.
    fn all() -> Vec<Behaviour> {
        let walk = BrownianMotility { speed: 0.2, persistence: 3.0, space: Space::Volume };
        let turning = Turning { split: 0.5, angle: 1.0, spread: 0.1, alternation: 0.7, space: Space::Plane };
        let pods = Pseudopods {
            pressure: 50.0,
            reach: f64::INFINITY,
            least_cosine: 0.7,
            contraction: 10.0,
            fibres: None,
            release: 1.0,
            cycle: Cycle { means: [1.0, 2.0, 3.0], variation: 0.5 },
            turning,
            several: Several { most: 3, rate: 0.5 },
            abandon: Some(0.3),
            inhibition: Some(Inhibition { share: 0.2, turn: 4.0, by: Touch::All }),
        };
        let all = vec![Behaviour::Brownian(walk), Behaviour::Bias, Behaviour::Pseudopods(pods)];
        for behaviour in &all {
            match behaviour {
                Behaviour::Brownian(_) | Behaviour::Bias | Behaviour::Pseudopods(_) => {}
            }
        }
        all
    }

    const NOW: Circumstances =
        Circumstances { seed: 5, cell: 7, speed: None, bias: [0.3, -0.1, 0.2], pseudopods: Told::NOTHING };

    #[test]
    fn every_behaviour_remembers_its_own_and_nothing_else() {
        for (number, behaviour) in all().iter().enumerate() {
            for (other, state) in all().iter().map(|behaviour| behaviour.start(5, 7)).enumerate() {
                assert_eq!(behaviour.owns(&state), number == other, "{behaviour:?} and {state:?}");
            }
        }
    }

    #[test]
    fn no_time_changes_nothing_and_the_same_cell_does_the_same() {
        for behaviour in all() {
            let (mut one, mut other) = (behaviour.start(5, 7), behaviour.start(5, 7));
            let first = behaviour.advance(0.0, &NOW, &mut one, |_, _| panic!("nothing can end"));
            assert_eq!(one, other, "{behaviour:?}");
            let pushes = matches!(behaviour, Behaviour::Pseudopods(_));
            assert!(pushes != (first.norm() > 0.0), "{behaviour:?} asks for a velocity or pushes");
            for _ in 0..20 {
                let velocities = [&mut one, &mut other].map(|state| behaviour.advance(1.7, &NOW, state, |_, _| ()));
                assert_eq!(velocities[0], velocities[1], "{behaviour:?}");
            }
            assert_eq!(one, other);
        }
    }

    #[test]
    fn a_speed_that_is_set_takes_the_place_of_the_own_one() {
        for behaviour in all().into_iter().filter(|behaviour| behaviour.speed().is_some()) {
            let mut state = behaviour.start(5, 7);
            let now = Circumstances { speed: Some(1.5), ..NOW };
            let velocity = behaviour.advance(0.0, &now, &mut state, |_, _| ());
            assert!((velocity.norm() - 1.5).abs() < 1e-15, "{velocity}");
        }
    }
}
