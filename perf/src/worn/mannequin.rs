//! A mannequin of average measures, and garments of the wardrobe in the size nearest to it.

use toile_assets::drafting;
use toile_assets::draping::PatternPackage;
use toile_assets::sizes::{Population, SizeTable};
use toile_bake::Shape;
use toile_base::body::{Body, Measures, Sex};
use toile_base::fabric::Fabric;
use toile_engine::colliders::{Colliders, RestSphere};

use super::error::WornError;

/// A body of average measures.
#[derive(Debug)]
pub struct AverageBody {
    /// Measures that it was built to.
    pub measures: Measures,
    /// The body.
    pub body: Body,
}

impl AverageBody {
    /// The mannequin that a garment is made for: a man where its sizes are men's.
    ///
    /// # Errors
    /// Where the wardrobe has no such garment.
    pub fn of(garment: &str) -> Result<Self, WornError> {
        let population = drafting::package(garment)?.population()?;
        let sex = if population == Population::Men { Sex::Male } else { Sex::Female };
        let measures = Measures::average(sex);
        Ok(Self { body: toile_assets::body::build(sex, &measures)?, measures })
    }

    /// Its spheres and capsules, and the floor, before their first placement.
    ///
    /// # Errors
    /// Where the engine does not take them.
    pub fn colliders(&self) -> Result<Colliders, WornError> {
        let rig = toile_assets::rig::fit(&self.body);
        let sphere = |s: &toile_base::rig::Sphere| RestSphere::on_bone(&self.body.skeleton, s.bone, s.offset, s.radius);
        let spheres = rig.spheres.each_ref().map(sphere);
        Ok(Colliders::new(&spheres, &rig.capsules, true)?)
    }

    /// A garment in the size nearest to it: the size, the shape on this body, the fabric that it is made of.
    ///
    /// # Errors
    /// Where the wardrobe has no such garment, or cannot cut it.
    pub fn wear(&self, garment: &str) -> Result<(String, Shape, Fabric), WornError> {
        let package = drafting::package(garment)?;
        let size = nearest(&package, &self.measures)?;
        let fabric = toile_assets::fabric::built_in(&package.fabric)?;
        let shape = package.draft(&size, &self.body, &fabric)?;
        Ok((size, shape, fabric))
    }
}

/// The size of a garment whose body's girths are nearest to some measures.
fn nearest(package: &PatternPackage, to: &Measures) -> Result<String, WornError> {
    let Some(sizes) = &package.sizes else { return Ok(package.own_size().to_owned()) };
    let table = SizeTable::embedded(&sizes.table)?;
    let mut best = (f32::INFINITY, String::new());
    for code in sizes.girths.iter().map(|girths| &girths.size) {
        let body = table.size_body(code)?;
        let girths =
            [(body.chest_girth, to.chest_girth), (body.waist_girth, to.waist_girth), (body.hip_girth, to.hip_girth)];
        let off = girths.iter().map(|(a, b)| (a - b).abs()).sum::<f32>() + 0.1 * (body.stature - to.stature).abs();
        if off < best.0 {
            best = (off, code.clone());
        }
    }
    Ok(best.1)
}
