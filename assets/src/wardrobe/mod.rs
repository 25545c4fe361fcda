//! The wardrobe: the garments that are built in, and meshes that a user brings, dressed onto a shopper's body.

pub mod drape;
pub mod jacket;
pub mod own;
pub mod section;
pub mod style;
pub mod sun_dress;
pub mod t_shirt;
pub mod upper_body;
pub mod wide_trousers;

use thiserror::Error;

use crate::adapt::AdaptError;
use crate::body::BodyError;
use crate::fabric::FabricError;
use crate::sizes::{Girth, Population, SizeBody, SizeError, SizeTable};
use style::{Cut, Style};
use toile_bake::Shape;
use toile_bake::check::MeshError;
use toile_bake::{bake, weights};
use toile_base::body::{Body, Measures, Sex};
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;

/// The garments that are built in, first the one that is shown when none is asked for.
const BUILT_IN: [(&str, &str); 4] = [
    ("sun-dress", include_str!("../../data/garments/sun-dress.toml")),
    ("t-shirt", include_str!("../../data/garments/t-shirt.toml")),
    ("wide-trousers", include_str!("../../data/garments/wide-trousers.toml")),
    ("jacket", include_str!("../../data/garments/jacket.toml")),
];

/// What rises this far above the upper edge of a bodice is a strap (m).
const STRAP_RISE_M: f32 = 0.03;

/// Why a garment cannot be worn.
#[derive(Debug, Error)]
pub enum WardrobeError {
    /// No such garment, and no such file.
    #[error("there is no garment named {name}; choose one of {known}, or give the path of an OBJ file")]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A garment file that cannot be used.
    #[error("garment {name}: {reason}; compare it with a garment that is built in")]
    Style {
        /// Name of the garment.
        name: String,
        /// The fault of the file.
        reason: String,
    },
    /// A size given for a mesh that has none.
    #[error("{name} is a mesh in one size, so it has no size {size}; leave the size out")]
    NoSizes {
        /// Name of the garment or file.
        name: String,
        /// The size asked for.
        size: String,
    },
    /// A mesh that cannot be cloth.
    #[error("garment {name}: {source}")]
    Mesh {
        /// The garment or file.
        name: String,
        /// The fault of the mesh.
        source: MeshError,
    },
    /// A mesh of the user's own, or a file beside it, that cannot be used.
    #[error(transparent)]
    Own(#[from] AdaptError),
    /// A fabric that cannot be used.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// A size or size table that cannot be used.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// The body of its size.
    #[error("the body of size {size} cannot be made: {source}")]
    Body {
        /// Code of the size.
        size: String,
        /// Why the body cannot be built.
        source: BodyError,
    },
}

/// Names of the garments that are built in.
pub fn names() -> Vec<&'static str> {
    BUILT_IN.iter().map(|(name, _)| *name).collect()
}

/// The file of a garment that is built in, by its name.
pub fn text(name: &str) -> Option<&'static str> {
    BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// A garment that is built in, by its name.
pub fn style(name: &str) -> Result<Style, WardrobeError> {
    match BUILT_IN.iter().find(|(known, _)| *known == name) {
        Some((known, text)) => parse(known, text),
        None => Err(WardrobeError::Unknown { name: name.into(), known: names().join(", ") }),
    }
}

/// Reads a garment file; `name` stands in the error message.
pub fn parse(name: &str, text: &str) -> Result<Style, WardrobeError> {
    let wrong = |reason: String| WardrobeError::Style { name: name.into(), reason };
    let style: Style = toml::from_str(text).map_err(|e| wrong(e.message().replace('\n', " ")))?;
    if !(4.0..=60.0).contains(&style.spacing_mm) {
        return Err(wrong(format!("spacing_mm is {}, outside of 4 to 60", style.spacing_mm)));
    }
    if !(16..=512).contains(&style.columns) {
        return Err(wrong(format!("columns is {}, outside of 16 to 512", style.columns)));
    }
    if let Some(n) = style.substeps
        && !(1..=64).contains(&n)
    {
        return Err(wrong(format!("substeps is {n}, outside of 1 to 64")));
    }
    Ok(style)
}

impl Style {
    /// The size table.
    pub fn sizes(&self) -> Result<SizeTable, SizeError> {
        SizeTable::embedded(&self.table)
    }

    /// Girths of the finished garment in one size (m), at the zones that it reaches.
    pub fn finished(&self, size: &SizeBody) -> Vec<(Girth, f32)> {
        let body = |zone| match zone {
            Girth::Chest => size.chest_girth,
            Girth::Waist => size.waist_girth,
            Girth::Hip => size.hip_girth,
        };
        Girth::ALL.into_iter().filter_map(|z| self.ease_mm.at(z).map(|ease| (z, body(z) + ease))).collect()
    }

    /// Whose body the garment is cut for. Garments in unisex sizes come in two blocks; the wearer gets theirs.
    fn block(&self, wearer: Sex) -> Result<Sex, SizeError> {
        Ok(match self.sizes()?.population {
            Population::Women => Sex::Female,
            Population::Men => Sex::Male,
            Population::Mixed => wearer,
        })
    }

    /// The body that a size is cut for; `wearer` chooses the block of a garment in unisex sizes.
    pub fn body(&self, size: &str, wearer: Sex) -> Result<Body, WardrobeError> {
        let measures = Measures::from(self.sizes()?.size_body(size)?);
        crate::body::build(self.block(wearer)?, &measures)
            .map_err(|source| WardrobeError::Body { size: size.into(), source })
    }

    /// Cuts the garment in a size and lays it on a shopper.
    pub fn draft(&self, size: &str, shopper: &Body) -> Result<Shape, WardrobeError> {
        let cut = self.body(size, shopper.sex)?;
        let mut shape = match self.cut {
            Cut::SunDress { .. } => sun_dress::draft(self, &cut, shopper),
            Cut::TShirt { .. } => t_shirt::draft(self, &cut, shopper),
            Cut::Jacket { .. } => jacket::draft(self, &cut, shopper),
            Cut::WideTrousers { .. } => wide_trousers::draft(self, &cut, shopper),
        };
        // Below this height (m) a garment hangs on the trunk alone; above it, on the shoulders too.
        let shoulders_from = match self.cut {
            Cut::SunDress { neckline_mm, .. } => shopper.levels.chest + neckline_mm * 1e-3 + STRAP_RISE_M,
            Cut::TShirt { .. } | Cut::Jacket { .. } => f32::NEG_INFINITY,
            Cut::WideTrousers { .. } => f32::INFINITY,
        };
        let carries = |p: glam::Vec3, bone| weights::trunk(bone) || (p.y > shoulders_from && weights::shoulders(bone));
        shape.weights = weights::transfer(shopper, &shape.worn, carries);
        shape.solver = self.solver;
        Ok(shape)
    }

    /// The garment in a size on a shopper, baked.
    pub fn dress(&self, size: &str, shopper: &Body) -> Result<Garment, WardrobeError> {
        self.dress_in(&crate::fabric::built_in(&self.fabric)?, size, shopper)
    }

    /// The same in another fabric.
    ///
    /// # Errors
    /// A size that there is not, a garment that cannot be baked.
    pub fn dress_in(&self, fabric: &Fabric, size: &str, shopper: &Body) -> Result<Garment, WardrobeError> {
        let shape = self.draft(size, shopper)?;
        let mut garment = bake(&self.name, size, &shape, fabric)
            .map_err(|source| WardrobeError::Mesh { name: self.name.clone(), source })?;
        garment.substeps = self.substeps.unwrap_or(garment.substeps);
        garment.layer = self.layer;
        Ok(garment)
    }
}
#[cfg(test)]
mod gather_tests {
    use toile_base::body::{Measures, Sex};
    use toile_base::garment::gather::WIDENS_M;
    use toile_base::garment::tuck::SLIPS_M;
    use toile_base::garment::{Garment, Tuck};

    use super::style;

    #[test]
    fn what_is_tucked_in_gets_the_width_at_which_it_lies_and_the_rest_keeps_its_own() {
        let shopper = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
        let shirt = style("t-shirt").unwrap().dress("M", &shopper).unwrap();
        let mut same = shirt.clone();
        same.gather();
        assert_eq!(same, shirt, "nothing is tucked in");
        let band = shopper.levels.waist - 0.05;
        let mut tucked = shirt.clone();
        let particles: Box<[bool]> = shirt.start.iter().map(|p| p.y < band).collect();
        let free = |[a, b]: [u32; 2]| [a, b].iter().all(|&v| shirt.start[v as usize].y > band + SLIPS_M + WIDENS_M);
        tucked.start.iter_mut().zip(&particles).filter(|(_, inside)| **inside).for_each(|(p, _)| {
            (p.x, p.z) = (0.8 * p.x, 0.8 * p.z);
        });
        tucked.tuck = Some(Tuck { into: 0, band, particles: particles.clone() });
        tucked.gather();
        // The shirt starts a little wider or narrower than it is cut, because this shopper is not of its size.
        let as_cut = |garment: &Garment| {
            let of = |within: bool| {
                let links = garment.hoop_edges.iter().filter(|(ends, _)| free(*ends) == within);
                links.map(|(_, rest)| *rest).sum::<f32>()
            };
            [of(false), of(true)]
        };
        let ([before, rest], [after, kept]) = (as_cut(&shirt), as_cut(&tucked));
        assert!((0.7..0.95).contains(&(after / before)) && rest == kept, "{before} {after} {rest} {kept}");
        // The layout has them too: as many links, each as long as before or shorter.
        let lengths = |garment: &Garment| {
            let mut all = Vec::new();
            let links = &garment.layout().weft;
            links.tuples.for_each(|at, ends| all.push((ends, links.rest[at], links.compliance[at])));
            all
        };
        let (old, new) = (lengths(&shirt), lengths(&tucked));
        assert_eq!(old.len(), new.len());
        for ((ends, was, soft), (same_ends, is, same_soft)) in old.into_iter().zip(new) {
            assert_eq!((ends, soft), (same_ends, same_soft));
            assert!(is <= was && (!free(ends) || is == was), "{ends:?}: {was} became {is}");
        }
    }
}
