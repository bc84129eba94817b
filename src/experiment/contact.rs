//! Contacts between cells: how near is a contact, and how strongly which surfaces stick.

use crate::units::{Length, LineStiffness, Stress};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Series of the scene that a run with contacts records, in the order of the result: sweeps of the last step over contacts,
/// the deepest penetration over the smallest mean edge, contacts, aggregates (a cell alone is one), cells of the largest, and
/// the energy of what contacts that hold have given way, pN·µm.
pub const CONTACT_SERIES: [&str; 6] =
    ["contact.sweeps", "contact.deepest", "contact.count", "aggregates", "largest_aggregate", "contact.energy"];

/// The series of the scene that a run with links records besides: links between facets.
pub const LINK_SERIES: &str = "contact.links";

/// The series of the scene that a run with virtual adhesives records besides: adhesives, atoms of the largest.
pub const ADHESIVE_SERIES: [&str; 2] = ["contact.adhesives", "contact.largest_adhesive"];

/// Names of the series that a result with contacts has for types of cells, by their order in the document, and planes:
/// areas and numbers of contacts by pair, shares and clusters.
pub fn pair_series<'a>(types: &[&'a str], planes: &[&'a str]) -> Vec<String> {
    let after = |one: usize| types[one..].iter().map(move |other| format!("{}.{other}", types[one]));
    let pairs = || (0..types.len()).flat_map(after);
    let on_planes = types.iter().flat_map(|kind| planes.iter().map(move |plane| format!("{kind}.{plane}")));
    let mut names: Vec<String> = pairs().chain(on_planes).map(|pair| format!("contact.area.{pair}")).collect();
    names.extend(pairs().map(|pair| format!("contact.pairs.{pair}")));
    names.extend(["contact.area_share", "contact.heterotypic_share", "contact.segregation"].map(str::to_owned));
    for stem in ["contact.clusters", "contact.largest_cluster"] {
        names.extend(types.iter().map(|kind| format!("{stem}.{kind}")));
    }
    names.extend(["births", "merges", "splits", "deaths"].map(|change| format!("contact.{change}")));
    names
}

/// What cells do that touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum ContactModel {
    /// Contacts bear any push, and a pull and a shear by `strength`.
    #[default]
    Adhesives,
    /// Contacts bear any push, and springs hold the atoms of facets that collided, by `link`; they break beyond `range`.
    Links,
    /// Contacts push by `penalty` times their depth, and pull within the proximity, by `strength`: to compare with.
    Penalty,
    /// Contacts bear any push, and atoms that touch move as one rigid body until a step would take one farther than `kappa` from it.
    VirtualAdhesives,
}

/// Which virtual adhesives merge where their atoms are neighbours on a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Zones {
    /// All.
    #[default]
    Merged,
    /// Those of the same two cells, or the same cell and plane; an atom that touches several belongs to the nearest.
    Pairs,
}

/// Contacts of cells with each other, with themselves and with planes. Without this table cells pass through each other.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Contact {
    /// What cells do that touch.
    pub model: ContactModel,
    /// Gap below which surfaces touch; a tenth of the smallest mean edge when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub proximity: Option<Length>,
    /// Pull over area of contact at which cells of any two types part; nothing sticks when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub strength: Option<Stress>,
    /// Shear over area of contact at which they slide; as `strength` when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub shear_strength: Option<Stress>,
    /// Energy that an area of contact releases, which spreads contacts against the tension of surfaces; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub energy: Option<LineStiffness>,
    /// Model links: stiffness of the springs between facets that collided, for any two types; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub link: Option<LineStiffness>,
    /// Model links: mean length of its springs above which a link breaks; the smallest mean edge when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub range: Option<Length>,
    /// Model penalty: push of a contact over its depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub penalty: Option<LineStiffness>,
    /// Model virtual_adhesives: what an atom's own displacement in a step may differ from that of its adhesive before it is
    /// released, for any two types; nothing sticks when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub kappa: Option<Length>,
    /// Model virtual_adhesives: which of them merge; "merged" when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zones: Option<Zones>,
    /// Strengths, links or kappas of single pairs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub between: Vec<Between>,
}

/// How strongly the cells of two types stick to each other, or those of a type to a plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Between {
    /// Two types of cells, or a type and a plane; the same type twice for its cells among themselves.
    pub types: [String; 2],
    /// Pull over area of contact at which they part; needed in the models adhesives and penalty.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub strength: Option<Stress>,
    /// Shear over area of contact at which they slide; as `strength` when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub shear_strength: Option<Stress>,
    /// Energy that an area of contact releases; none when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub energy: Option<LineStiffness>,
    /// Model links: stiffness of the springs between facets that collided; "0 pN/um" does not bind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub link: Option<LineStiffness>,
    /// Model virtual_adhesives: the difference of displacements at which an atom is released; "0 um" does not stick.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub kappa: Option<Length>,
}

/// What two names of a pair mean in an experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pair {
    /// Two types, by number, the smaller first.
    Types(usize, usize),
    /// A type and a plane.
    OnPlane(usize, usize),
}

impl Between {
    /// The meaning of the pair; none where a name is unknown or both are planes.
    pub(super) fn pair(&self, experiment: &super::Experiment) -> Option<Pair> {
        let kind = |name: &str| experiment.cells.get_index_of(name);
        let plane = |name: &str| experiment.planes.iter().position(|plane| plane.name == name);
        let [first, second] = &self.types;
        match (kind(first), kind(second)) {
            (Some(one), Some(other)) => Some(Pair::Types(one.min(other), one.max(other))),
            (Some(one), None) => plane(second).map(|plane| Pair::OnPlane(one, plane)),
            (None, Some(one)) => plane(first).map(|plane| Pair::OnPlane(one, plane)),
            (None, None) => None,
        }
    }
}
