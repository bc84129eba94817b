//! Who touches whom: finding the atoms, facets and edges of cells, sheets and rigid bodies that are near each other or
//! inside each other. It knows shapes and positions only; what contacts do is for others.
//!
//! A [`Scene`] says what can touch and from how far, a [`Detector`] keeps pairs from step to step and writes
//! [`Contacts`]; [`find_overlaps`] and [`push_apart`] are for the start of a run, [`atom_meets_facet`] and [`edges_meet`] check a step.

mod apart;
mod atom_facet;
mod boxes;
mod closest;
mod collected;
mod depth;
mod detect;
mod edge_edge;
mod found;
mod groove;
mod inside;
pub(crate) mod lanes;
mod lists;
mod look;
mod motion;
mod near;
mod near_facets;
mod neighbours;
mod opening;
mod openings;
mod owners;
mod parts;
mod passages;
mod reference;
mod renew;
mod ridge;
mod round;
mod scene;
mod separation;
mod shape;
mod swept;
mod travel;
mod turned;
mod words;

pub use apart::{Yielding, push_apart};
pub use closest::{FacetPoint, Feature, closest_on_facet, closest_on_segments};
pub use depth::find_deeper;
pub use detect::{Detection, Detector};
pub use edge_edge::edges_still_touch;
pub use found::{AtomContact, Contacts, EdgeContact, Facing, Normal, ObstacleContact};
pub use groove::add_walls_of_grooves;
pub use inside::{Overlap, centre_is_inside, find_centre_inside, find_overlaps, find_overlaps_told, winding_number};
pub use near_facets::{Near, NearFacets};
pub use opening::{Opening, SURELY, opening_to_facet, opening_to_feature, opening_to_plane};
pub use openings::{Openings, PAIRS};
pub use passages::{Coverage, Pair, Passage};
pub use reference::detect_all_pairs;
pub use scene::{Body, Reach, Scene};
pub use shape::{Shape, Sides};
pub use swept::{atom_meets_facet, edges_meet};
pub use travel::{Itself, Stride, Travel};

#[cfg(test)]
mod analytic_tests;
#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod round_tests;
#[cfg(test)]
mod swept_tests;
#[cfg(test)]
pub(crate) mod test_scenes;
#[cfg(test)]
mod travel_tests;
