//! Styles: garment files of the wardrobe, and the numbers that a size gives them.

use serde::Deserialize;

use crate::sizes::{GarmentKind, Girth};
use toile_bake::overrides::Overrides;

/// A garment file: what is cut, from which fabric, in which sizes, with how much ease.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Style {
    /// Name by which it is asked for.
    pub name: String,
    /// Name for shoppers.
    pub title: String,
    /// Its kind; decides its primary measures.
    pub kind: GarmentKind,
    /// Name of the size table.
    pub table: String,
    /// Name of the fabric.
    pub fabric: String,
    /// Which layer it is worn in: 1 underwear, 2 skirts and trousers, 3 what is worn over them, 4 jackets, 5 coats (the
    /// wearing order of Ugur 2008). A garment stays outside of those in lower layers, and of those in its own that are put
    /// on before it.
    pub layer: u8,
    /// Distance between neighbouring particles along the warp (mm).
    pub spacing_mm: f32,
    /// Particles around the body.
    pub columns: usize,
    /// Ease over the body of its size (mm).
    pub ease_mm: Ease,
    /// The ease that a wearer finds good, least and most (mm): outside of it a zone is tight or loose.
    pub comfort_mm: Comfort,
    /// Substeps of a step at the quality `shop`, where it was tried that as many do; left out, the bake counts them by the mesh.
    #[serde(default)]
    pub substeps: Option<u32>,
    /// Pattern of the garment with its measures.
    pub cut: Cut,
    /// Solvers that are not left to the bake.
    #[serde(default)]
    pub solver: Overrides,
}

/// Ease by zone (mm); a zone that the garment does not reach is left out.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ease {
    /// At the chest.
    pub chest: Option<f32>,
    /// At the waist.
    pub waist: Option<f32>,
    /// At the hip.
    pub hip: Option<f32>,
}

/// Comfortable ease by zone (mm), least and most.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Comfort {
    /// At the chest.
    pub chest: Option<[f32; 2]>,
    /// At the waist.
    pub waist: Option<[f32; 2]>,
    /// At the hip.
    pub hip: Option<[f32; 2]>,
}

impl Ease {
    /// Ease at one zone (m).
    pub fn at(&self, zone: Girth) -> Option<f32> {
        match zone {
            Girth::Chest => self.chest,
            Girth::Waist => self.waist,
            Girth::Hip => self.hip,
        }
        .map(|mm| mm * 1e-3)
    }
}

impl Comfort {
    /// Comfortable ease at one zone (m).
    pub fn at(&self, zone: Girth) -> Option<[f32; 2]> {
        match zone {
            Girth::Chest => self.chest,
            Girth::Waist => self.waist,
            Girth::Hip => self.hip,
        }
        .map(|r| r.map(|mm| mm * 1e-3))
    }
}

/// Lengths and widths that the sizes do not change (mm).
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(tag = "pattern", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Cut {
    /// A fitted bodice on two straps, a flared skirt from the waist.
    SunDress {
        /// Upper edge of the bodice above the chest level.
        neckline_mm: f32,
        /// Waist to hem along the side.
        skirt_mm: f32,
        /// Girth of the hem.
        hem_mm: f32,
        /// Width of a strap.
        strap_mm: f32,
    },
    /// A straight body with set-in short sleeves and a round neck.
    TShirt {
        /// Length from waist to hem (mm).
        below_waist_mm: f32,
        /// Length of the sleeve from the shoulder point.
        sleeve_mm: f32,
        /// Ease of the sleeve over the arm.
        sleeve_ease_mm: f32,
        /// Half the width of the neck opening.
        neck_mm: f32,
        /// Depth of the front neckline below the side of the neck.
        front_neck_mm: f32,
    },
    /// A jacket that is open in front, with long set-in sleeves and no collar.
    Jacket {
        /// Length from waist to hem (mm).
        below_waist_mm: f32,
        /// Length of the sleeve from the shoulder point.
        sleeve_mm: f32,
        /// Ease of the sleeve's hem over the wrist.
        sleeve_ease_mm: f32,
        /// Half the width of the neck opening.
        neck_mm: f32,
        /// Depth of the front neckline below the side of the neck.
        front_neck_mm: f32,
        /// How far apart the front edges lie when it is put on.
        opening_mm: f32,
    },
    /// Trousers that fall straight and wide from the hip.
    WideTrousers {
        /// Height of the upper edge above the waist level.
        waistband_mm: f32,
        /// Length from crotch to hem (mm).
        inseam_mm: f32,
        /// Girth of a leg at the hem.
        hem_mm: f32,
        /// How far the crotch hangs below the body's.
        crotch_drop_mm: f32,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wardrobe;
    use toile_bake::overrides::SolverRegion;
    use toile_base::garment::Direction;
    use toile_base::garment::Solver;

    #[test]
    fn a_garment_file_may_name_its_substeps_within_reason() {
        let text = include_str!("../../data/garments/sun-dress.toml");
        assert_eq!(wardrobe::parse("dress", text).unwrap().substeps, None);
        assert_eq!(wardrobe::parse("dress", &format!("substeps = 6\n{text}")).unwrap().substeps, Some(6));
        for wrong in ["0", "65"] {
            let message = wardrobe::parse("dress", &format!("substeps = {wrong}\n{text}")).unwrap_err().to_string();
            assert!(message.contains("substeps is") && message.contains("1 to 64"), "{message}");
        }
    }

    #[test]
    fn a_garment_file_names_solvers_and_is_told_which_there_are() {
        let text = include_str!("../../data/garments/wide-trousers.toml");
        assert_eq!(wardrobe::parse("trousers", text).unwrap().solver, Overrides::default());
        let with = |table: &str| wardrobe::parse("trousers", &format!("{text}\n[solver]\n{table}\n"));
        let style = with("weft = \"semi-implicit\"\nwaistband = \"zero-stretch\"").unwrap();
        assert_eq!(style.solver.of(Direction::Weft, None), Some(Solver::SemiImplicit));
        assert_eq!(style.solver.of(Direction::Weft, Some(SolverRegion::Waistband)), Some(Solver::ZeroStretch));
        assert_eq!(style.solver.of(Direction::Warp, None), None);
        for (table, word) in [("weft = \"magic\"", "semi-implicit"), ("sleeve = \"zero-stretch\"", "waistband")] {
            let message = with(table).unwrap_err().to_string();
            assert!(message.contains(word) && message.contains("trousers") && !message.contains('\n'), "{message}");
        }
    }
}
