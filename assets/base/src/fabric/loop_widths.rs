//! Widths of a fabric's measured loops: what the friction of its threads keeps of a deformation.

/// How far the two branches of each measured loop lie apart, as the Kawabata system states them. 0 is a fabric without
/// friction, or one of which nothing was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(deny_unknown_fields, default))]
pub struct LoopWidths {
    /// 2HB of threads along the warp: moment for a width (mN m/m, which is mN).
    pub bend_warp_mn: f32,
    /// 2HB of threads along the weft (mN).
    pub bend_weft_mn: f32,
    /// 2HG: shear force for a width (N/m).
    pub shear_n_m: f32,
}

impl LoopWidths {
    /// Accepted figures, lowest and highest: an order of magnitude wider than what is published of apparel fabrics (2HB
    /// 0.0004 to 0.5 gf cm/cm, 2HG 0.1 to 10 gf/cm).
    pub const RANGES: [(&'static str, f32, f32); 3] = [
        ("hysteresis.bend_warp_mn", 0.0, 50.0),
        ("hysteresis.bend_weft_mn", 0.0, 50.0),
        ("hysteresis.shear_n_m", 0.0, 100.0),
    ];

    /// The figures of [`Self::RANGES`], in their order.
    pub fn figures(&self) -> [f32; 3] {
        [self.bend_warp_mn, self.bend_weft_mn, self.shear_n_m]
    }

    /// Curvature that a strip keeps when it is bent far and let go (1/m): half of the width over the rigidity, for a rigidity
    /// of threads along warp and weft (uN m). 0 where there is no rigidity to bend it back.
    pub fn residual_curvatures(&self, bend_un_m: [f32; 2]) -> [f32; 2] {
        let widths = [self.bend_warp_mn, self.bend_weft_mn];
        std::array::from_fn(|k| if bend_un_m[k] > 0.0 { 500.0 * widths[k] / bend_un_m[k] } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matsudaira et al. 2015: B (gf cm2/cm), 2HB (gf cm/cm), residual curvature (1/m).
    const PUBLISHED: [[f32; 3]; 3] = [[0.118, 0.124, 52.54], [0.067, 0.033, 24.63], [0.019, 0.007, 18.42]];

    #[test]
    fn published_loops_have_the_residual_curvature_that_is_published_with_them() {
        for [b, width, residual] in PUBLISHED {
            let loops = LoopWidths { bend_warp_mn: 9.80665 * width, ..LoopWidths::default() };
            let [warp, weft] = loops.residual_curvatures([98.0665 * b, 1.0]);
            assert!((warp / residual - 1.0).abs() < 1e-3 && weft == 0.0, "{warp} of {residual}");
        }
        assert_eq!(LoopWidths { bend_warp_mn: 1.0, ..LoopWidths::default() }.residual_curvatures([0.0; 2]), [0.0; 2]);
    }
}
