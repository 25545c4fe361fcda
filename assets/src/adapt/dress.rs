//! A mesh of the user's own put on a shopper in a size, and baked.

use std::path::Path;

use super::wear::WornMesh;
use super::{AdaptError, MeshReport, OwnMesh};
use crate::sizes::{GarmentKind, Girth};
use toile_bake::bake;
use toile_base::body::Body;
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;

/// Fabric of a mesh that does not say what it is made of.
const FABRIC: &str = "cotton-lawn";

/// Layer of a mesh that does not say in which one it is worn: that of dresses and shirts.
const LAYER: u8 = 3;

/// The size of a mesh that says of none.
pub const UNKNOWN: &str = "unknown";

/// A mesh on a shopper, baked, and what became of it.
#[derive(Debug, Clone)]
pub struct DressedMesh {
    /// A garment for each layer of the mesh, the innermost first, ready to be stepped.
    pub garments: Vec<Garment>,
    /// The vertex of the repaired mesh that each vertex of a garment's shape is `[garments][vertices]`.
    pub vertices: Vec<Vec<u32>>,
    /// The repairs, and the use of each piece.
    pub report: MeshReport,
}

/// A mesh on a shopper before baking, with its fabric.
pub struct DraftedMesh {
    /// The mesh on the shopper.
    pub worn: WornMesh,
    /// Its fabric.
    pub fabric: Fabric,
}

/// Lays a mesh on a shopper in one of its sizes; none is as it was made.
///
/// # Errors
/// A size of a mesh that has none, a fabric that there is not.
pub fn draft(own: &OwnMesh, size: Option<&str>, shopper: &Body) -> Result<DraftedMesh, AdaptError> {
    let fabric = crate::fabric::built_in(own.measures.fabric.as_deref().unwrap_or(FABRIC))?;
    let worn = match (size, &own.sizes) {
        (Some(size), Some(sizes)) if size != sizes.made_in => {
            let graded = own.graded(sizes, size)?;
            own.wear_cut(&graded.mesh, &graded.body, shopper)
        }
        (Some(size), None) => return Err(AdaptError::NoSizes { path: own.path.clone(), size: size.into() }),
        _ => own.wear(shopper),
    };
    Ok(DraftedMesh { worn, fabric })
}

/// Lays a mesh on a shopper and bakes each of its layers.
///
/// # Errors
/// As [`draft`].
pub fn dress(own: &OwnMesh, size: Option<&str>, shopper: &Body) -> Result<DressedMesh, AdaptError> {
    dress_in(own, None, size, shopper)
}

/// The same in another fabric than its file of measures names.
///
/// # Errors
/// As [`draft`].
pub fn dress_in(
    own: &OwnMesh,
    fabric: Option<&Fabric>,
    size: Option<&str>,
    shopper: &Body,
) -> Result<DressedMesh, AdaptError> {
    let DraftedMesh { worn, fabric: named } = draft(own, size, shopper)?;
    let fabric = fabric.cloned().unwrap_or(named);
    let file = Path::new(&own.path).file_name().map(|name| name.to_string_lossy().into_owned());
    let name = own.measures.name.clone().or(file).unwrap_or_else(|| own.path.clone());
    let shapes = worn.shapes();
    let several = shapes.len() > 1;
    let garments = shapes.iter().enumerate().map(|(k, shape)| {
        let name = if several { format!("{name} ({})", k + 1) } else { name.clone() };
        let baked = bake(&name, size.unwrap_or(UNKNOWN), shape, &fabric);
        let mut garment = baked.map_err(|source| AdaptError::Cloth { path: own.path.clone(), source })?;
        garment.set_layer(own.measures.layer.unwrap_or(LAYER));
        Ok(garment)
    });
    let garments = garments.collect::<Result<_, AdaptError>>()?;
    Ok(DressedMesh { garments, vertices: worn.layers, report: worn.report })
}

/// The ease that a wearer finds good at each zone (m): by the mesh's file of measures, else that of its kind.
pub fn comfort(own: &OwnMesh, kind: GarmentKind) -> Vec<(Girth, [f32; 2])> {
    let usual = |zone: Girth| kind.comfort().iter().find(|(z, _)| *z == zone).map(|(_, range)| *range);
    let range = |zone: Girth| own.measures.comfort_mm.at(zone).or_else(|| usual(zone));
    Girth::ALL.into_iter().filter_map(|zone| range(zone).map(|r| (zone, r))).collect()
}
