//! Filled bodies of an elastic material. What documents say of them, and the force that it means.

use super::compile::{Builder, Inside};
use super::region::{self, Region};
use crate::geometry::solid::pairs_within;
use crate::mechanics::Force;
use crate::mechanics::solid;
use crate::mechanics::solid::dilation::{Dilation, DilationLaw, Parts};
use crate::mechanics::solid::law::{Elastic, SolidLaw};
use crate::units::Stress;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An elastic material that fills the body, at rest in the shape of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// The law of its energy.
    pub law: Material,
    /// Young's modulus at small strain.
    #[schemars(extend("x-minimum" = 0))]
    pub young: Stress,
    /// Poisson's ratio at small strain, below 0.5. When absent the material resists changes of shape alone, and the rule of the volume keeps the
    /// volume of the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -0.99, max = 0.4999))]
    pub poisson: Option<f64>,
    /// What changes of volume are measured over; over single tetrahedra when absent, or for the neo-Hookean law over the cells that they were cut
    /// from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume_over: Option<VolumeOver>,
    /// The documents' penalty on changes of the volume of a tetrahedron, beside all else: a pressure of this times the square of the relative change.
    #[serde(default)]
    #[schemars(extend("x-minimum" = 0))]
    pub penalty: Stress,
    /// Parts of the body that are of another material, such as a nucleus.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<Region>,
}

/// The law of a material's energy; all have the same response at small strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Material {
    /// Linear in displacements: it takes a turn for a strain.
    Linear,
    /// Linear in the strain that is left once each tetrahedron is turned back.
    Corotational,
    /// St Venant and Kirchhoff: quadratic in Green's strain.
    StVenantKirchhoff,
    /// Neo-Hookean, as rubber and gels.
    NeoHookean,
}

/// What changes of volume are measured over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum VolumeOver {
    /// Each tetrahedron: stiff in bending where the material hardly changes its volume.
    Tetrahedra,
    /// The hexahedron, wedge or pyramid that tetrahedra were cut from.
    Cells,
    /// All tetrahedra around an atom.
    Atoms,
}

/// Who is whose neighbour in a filled body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Neighbours {
    /// Both ends of an edge of a cell: six around an atom of a lattice of hexahedra (von Neumann's).
    #[default]
    Edges,
    /// All atoms of a cell: 26 around an atom of a lattice of hexahedra (Moore's).
    Cells,
    /// Both ends of an edge of a tetrahedron.
    Tetrahedra,
}

impl Neighbours {
    /// The pairs of neighbours in the body of a type, as the document says at a key, or else as they are as a rule; none for a surface, where the key
    /// has no meaning.
    pub(super) fn pairs_of(own: Option<Self>, path: &str, to: &mut Builder) -> Option<Vec<[u32; 2]>> {
        let inside = to.inside();
        if own.is_some() && inside.is_none() {
            let found = "on a surface neighbours are those at the ends of an edge";
            let help = "remove `neighbours`, or take a filled mesh: shape = \"block\" or \"rod\", or a PML file with `filled = true`";
            to.fault(path, "not of a filled body", found, help);
        }
        inside.map(|inside| own.unwrap_or_default().pairs(inside))
    }

    /// The pairs of neighbours in a body, smaller first, sorted.
    fn pairs(self, inside: &Inside) -> Vec<[u32; 2]> {
        match self {
            Self::Edges => inside.edges.clone(),
            Self::Cells => pairs_within(&inside.tetrahedra, &inside.cells),
            Self::Tetrahedra => {
                let each: Vec<u32> = (0..=inside.tetrahedra.len() as u32).collect();
                pairs_within(&inside.tetrahedra, &each)
            }
        }
    }
}

impl Solid {
    /// Whether something resists changes of volume within the body.
    pub(super) fn has_bulk(&self) -> bool {
        self.poisson.is_some()
    }

    /// Adds its elasticity.
    pub(super) fn add(&self, to: &mut Builder) {
        let Some(inside) = to.inside() else {
            let found = "a material fills the body, and the mesh is a surface";
            let help = "take shape = \"block\" or \"rod\", or a PML file with `filled = true`";
            return to.fault("mechanics.solid", "nothing to fill", found, help);
        };
        let rest = &to.rest().positions;
        let law = match self.law {
            Material::Linear => SolidLaw::Linear,
            Material::Corotational => SolidLaw::Corotational,
            Material::StVenantKirchhoff => SolidLaw::StVenantKirchhoff,
            Material::NeoHookean => SolidLaw::NeoHookean,
        };
        let parts = match (self.volume_over, law) {
            (Some(VolumeOver::Tetrahedra), SolidLaw::NeoHookean) => Some(Parts::Tetrahedra),
            (Some(VolumeOver::Cells), _) | (None, SolidLaw::NeoHookean) => Some(Parts::Cells),
            (Some(VolumeOver::Atoms), _) => Some(Parts::Atoms),
            (Some(VolumeOver::Tetrahedra) | None, _) => None,
        };
        let of_cells = region::of_cells(&self.regions, inside, &to.plain().positions);
        region::check(&self.regions, &of_cells, to);
        let of_regions = self.regions.iter().zip(0..).map(|(region, number)| (Some(number), region.young.value()));
        for (region, young) in [(None, self.young.value())].into_iter().chain(of_regions) {
            let Inside { tetrahedra, cells, .. } = region::part(inside, &of_cells, region);
            if tetrahedra.is_empty() {
                continue;
            }
            // E = 3µ where volumes are kept.
            let shear = young / (2.0 * (1.0 + self.poisson.unwrap_or(0.5)));
            let bulk = self.poisson.map(|poisson| young / (3.0 * (1.0 - 2.0 * poisson)));
            let dilation = bulk
                .zip(parts)
                .map(|(bulk, parts)| Dilation::new(rest, &tetrahedra, &cells, DilationLaw::Bulk(bulk), parts));
            let lame = if parts.is_some() { 0.0 } else { bulk.unwrap_or(0.0) } - 2.0 / 3.0 * shear;
            let elastic = Elastic { law, shear, lame };
            to.forces.push(Force::Solid(solid::Solid::new(rest, &tetrahedra, elastic, dilation)));
        }
        if self.penalty.value() > 0.0 {
            let none = Elastic { law: SolidLaw::Linear, shear: 0.0, lame: 0.0 };
            let law = DilationLaw::Penalty(self.penalty.value());
            let penalty = Dilation::new(rest, &inside.tetrahedra, &inside.cells, law, Parts::Tetrahedra);
            to.forces.push(Force::Solid(solid::Solid::new(rest, &[], none, Some(penalty))));
        }
    }
}
