//! Lenses of a RealSense and how its cameras stand to each other, laid out as in `rs_types.h`.

use std::ffi::c_int;

use glam::{Mat3, Vec3};

use crate::colour_camera::ColourCamera;
use crate::lens::BrownConrady;
use toile_base::frame::Intrinsics;

const DISTORTION_NONE: c_int = 0;
/// Models by Brown and Conrady. The first two bend points sideways by their place after the radial part and not before it, which for
/// the lenses of these cameras is a twentieth of a pixel.
const DISTORTION_MODIFIED_BROWN_CONRADY: c_int = 1;
const DISTORTION_INVERSE_BROWN_CONRADY: c_int = 2;
const DISTORTION_BROWN_CONRADY: c_int = 4;

/// A lens.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RsIntrinsics {
    width: c_int,
    height: c_int,
    ppx: f32,
    ppy: f32,
    fx: f32,
    fy: f32,
    model: c_int,
    coefficients: [f32; 5],
}

/// From one stream's axes to another's: a matrix column by column, and m.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RsExtrinsics {
    rotation: [f32; 9],
    translation: [f32; 3],
}

impl RsIntrinsics {
    /// Size, focal lengths and centre (px).
    pub fn intrinsics(&self) -> Intrinsics {
        Intrinsics {
            width: u32::try_from(self.width).unwrap_or(0),
            height: u32::try_from(self.height).unwrap_or(0),
            fx: self.fx,
            fy: self.fy,
            cx: self.ppx,
            cy: self.ppy,
        }
    }

    fn is_brown_conrady(&self) -> bool {
        matches!(
            self.model,
            DISTORTION_MODIFIED_BROWN_CONRADY | DISTORTION_INVERSE_BROWN_CONRADY | DISTORTION_BROWN_CONRADY
        )
    }

    /// Whether it is known how the lens bends: a fisheye's is not.
    fn is_known(&self) -> bool {
        self.is_brown_conrady() || self.model == DISTORTION_NONE || self.coefficients == [0.0; 5]
    }

    /// The colour camera of this lens, in the axes of the depth camera from which it stands so; none where its lens is not known here.
    pub fn beside(&self, place: &RsExtrinsics) -> Option<ColourCamera> {
        self.is_known().then(|| {
            let (rotation, translation) = (Mat3::from_cols_array(&place.rotation), Vec3::from_array(place.translation));
            ColourCamera::beside(self.intrinsics(), self.lens(), rotation, translation)
        })
    }

    /// The lens, where it bends by a model that is known here. Depth of a stereo camera is rectified and has none.
    pub fn lens(&self) -> Option<BrownConrady> {
        let [k1, k2, p1, p2, k3] = self.coefficients;
        let bends = self.is_brown_conrady() && self.coefficients.iter().any(|c| *c != 0.0);
        bends.then_some(BrownConrady {
            k: [k1, k2, k3, 0.0, 0.0, 0.0],
            p: [p1, p2],
            centre: [0.0; 2],
            widest: f32::INFINITY,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intrinsics_are_laid_out_as_in_the_header() {
        assert_eq!((size_of::<RsIntrinsics>(), std::mem::offset_of!(RsIntrinsics, coefficients)), (48, 28));
        assert_eq!(size_of::<RsExtrinsics>(), 48);
    }

    #[test]
    fn a_fisheyes_lens_is_not_known() {
        let lens = |model, k1| RsIntrinsics { model, coefficients: [k1, 0.0, 0.0, 0.0, 0.0], ..Default::default() };
        for model in 0..=5 {
            let brown = [1, 2, 4].contains(&model);
            assert_eq!((lens(model, 0.1).is_known(), lens(model, 0.1).lens().is_some()), (brown || model == 0, brown));
            assert!(lens(model, 0.0).is_known() && lens(model, 0.0).lens().is_none());
        }
    }
}
