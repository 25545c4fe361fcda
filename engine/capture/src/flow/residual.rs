//! The difference of the pictures over a triangle, its derivatives by the nine coordinates of its corners, and their sums.
//!
//! Residual of a sample with shares b, gain g and offset o: `r = g I(u, v) + o - T`, T the value seen there before. With the point
//! `p = R sum b_i X_i + t` in the camera's axes, `u = fx p.x / p.z + cx`, `v = fy p.y / p.z + cy` and equation 5.10:
//!
//! ```text
//! h = dr/dp = g (I_u fx / z, I_v fy / z, -(I_u fx x + I_v fy y) / z),   x = p.x / z, y = p.y / z
//! dr/dX_i = b_i R^T h
//! ```
//!
//! The normal equations of Gauss and Newton are `sum w b_i b_j h h^T` and `sum w r b_i h`, turned into the world a patch at a time.
//! A sample's weight falls with its residual (Geman and McClure): `w = (c^2 / (c^2 + r^2))^2`.

use glam::{DMat3, DVec2, DVec3, Vec2, Vec3};

use super::patches::LevelSamples;
use crate::plane::Plane;

/// Size of a residual beyond which it only says that something else is seen (of 255).
pub(super) const CLIPPED: f32 = 40.0;

/// A camera with the pictures of one level.
pub(super) struct LevelView<'a> {
    pub plane: &'a Plane,
    pub rotation: DMat3,
    pub translation: DVec3,
    /// Focal lengths and principal point in pixels of the level's plane.
    pub focal: DVec2,
    pub centre: DVec2,
}

/// Brightness of a triangle in a camera, over what it was: `g I + o` is compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tone {
    pub gain: f32,
    pub offset: f32,
}

impl Tone {
    pub const SAME: Self = Self { gain: 1.0, offset: 0.0 };
}

/// Sums over the samples of one triangle in one camera, in the camera's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PatchSums {
    /// Blocks of the corners (0,0) (0,1) (0,2) (1,1) (1,2) (2,2), each xx xy xz yy yz zz.
    pub normal: [[f32; 6]; 6],
    /// `sum w r b_i h` of each corner.
    pub right: [[f32; 3]; 3],
    /// The robust cost, `sum r^2 c^2 / (c^2 + r^2)`, of which the right hand side is the derivative.
    pub cost: f32,
    /// Sum of the residuals' sizes, none counted as more than [`CLIPPED`].
    pub absolute: f32,
    /// Samples that were seen.
    pub count: f32,
    /// Sums of I, T, I I, I T, T T, unweighted.
    pub moments: [f32; 5],
}

impl PatchSums {
    pub const NONE: Self =
        Self { normal: [[0.0; 6]; 6], right: [[0.0; 3]; 3], cost: 0.0, absolute: 0.0, count: 0.0, moments: [0.0; 5] };

    /// Correlation of what is seen with what was, and the standard deviation of what was.
    pub fn agreement(&self, channels: usize) -> (f32, f32) {
        let n = self.count * channels as f32;
        if n < 4.0 {
            return (0.0, 0.0);
        }
        let [i, t, ii, it, tt] = self.moments.map(|m| m / n);
        let (vi, vt) = ((ii - i * i).max(0.0), (tt - t * t).max(0.0));
        ((it - i * t) / (vi * vt).sqrt().max(1e-3), vt.sqrt())
    }

    /// The tone that brings the picture nearest to what was seen, drawn towards no change by how uncertain it is.
    pub fn tone(&self, channels: usize) -> Tone {
        const GAIN: f32 = 0.4;
        const OFFSET: f32 = 12.0;
        const NOISE: f32 = 4.0;
        let n = self.count * channels as f32;
        let [i, t, ii, it, _] = self.moments;
        let (a, b) = ((NOISE / GAIN).powi(2), (NOISE / OFFSET).powi(2));
        // (ii + a) g + i o = it + a, i g + (n + b) o = t.
        let (p, q, r) = (ii + a, i, n + b);
        let det = p * r - q * q;
        if n < 4.0 || det <= 0.0 {
            return Tone::SAME;
        }
        let gain = ((it + a) * r - q * t) / det;
        Tone { gain: gain.clamp(0.25, 4.0), offset: (p * t - q * (it + a)) / det }
    }
}

/// The samples of one triangle: shares, what was seen of it, and whether each is seen now (0 or 1).
pub(super) struct PatchSamples<'a> {
    pub shares: &'a [Vec3],
    pub seen: &'a [f32],
    pub mask: &'a [f32],
}

impl LevelView<'_> {
    /// A place of the world in the camera's axes.
    pub fn axes(&self, point: DVec3) -> Vec3 {
        (self.rotation * point + self.translation).as_vec3()
    }

    /// What is seen at a share of a triangle whose corners are given in the camera's axes; `None` outside of the pictures.
    pub fn values(&self, [a, b, c]: [Vec3; 3], share: Vec3) -> Option<[f32; 3]> {
        let p = a * share.x + b * share.y + c * share.z;
        let at = p.truncate() / p.z * self.focal.as_vec2() + self.centre.as_vec2();
        let cell = self.plane.cell(at.x, at.y)?;
        Some(std::array::from_fn(|c| if c < self.plane.channels { self.plane.sample(cell, c)[0] } else { 0.0 }))
    }

    /// Sums of one triangle whose corners are given in the camera's axes (m); `c2` is the square of the robust residual.
    #[inline(always)]
    pub fn sums<const C: usize>(&self, corners: [Vec3; 3], of: &PatchSamples, tone: Tone, c2: f32) -> PatchSums {
        let mut sums = PatchSums::NONE;
        let mut parts = SampleSums::NONE;
        let (focal, centre): (Vec2, Vec2) = (self.focal.as_vec2(), self.centre.as_vec2());
        let [pa, pb, pc] = corners;
        for (k, (share, mask)) in of.shares.iter().zip(of.mask).enumerate() {
            if *mask == 0.0 {
                continue;
            }
            let p = pa * share.x + pb * share.y + pc * share.z;
            let inverse = 1.0 / p.z;
            let (x, y) = (p.x * inverse, p.y * inverse);
            let Some(cell) = self.plane.cell(focal.x * x + centre.x, focal.y * y + centre.y) else { continue };
            sums.count += 1.0;
            for c in 0..C {
                let [value, du, dv] = self.plane.sample(cell, c);
                let was = of.seen[k * C + c];
                let m = &mut sums.moments;
                m[0] += value;
                m[1] += was;
                m[2] += value * value;
                m[3] += value * was;
                m[4] += was * was;
                let r = tone.gain * value + tone.offset - was;
                let part = c2 / (c2 + r * r);
                let w = part * part;
                let (gu, gv) = (tone.gain * du * focal.x * inverse, tone.gain * dv * focal.y * inverse);
                sums.absolute += r.abs().min(CLIPPED);
                sums.cost += part * r * r;
                parts.add([share.x, share.y, share.z], [gu, gv, -(gu * x + gv * y)], w, r);
            }
        }
        parts.put(&mut sums);
        sums
    }
}

/// The sums of [`PatchSums::normal`] and [`PatchSums::right`] while they are made: rows of eight and of four, of which the last places are
/// for nothing, so that a row is a vector.
struct SampleSums {
    normal: [[f32; 8]; 6],
    right: [[f32; 4]; 3],
}

impl SampleSums {
    const NONE: Self = Self { normal: [[0.0; 8]; 6], right: [[0.0; 4]; 3] };

    /// Adds a sample of shares `b`, derivative `h`, weight and residual. No closure: it would be compiled for no width of its caller.
    #[inline(always)]
    fn add(&mut self, b: [f32; 3], h: [f32; 3], w: f32, r: f32) {
        let [x, y, z] = [w * h[0], w * h[1], w * h[2]];
        let hh = [x * h[0], x * h[1], x * h[2], y * h[1], y * h[2], z * h[2], 0.0, 0.0];
        let bb = [b[0] * b[0], b[0] * b[1], b[0] * b[2], b[1] * b[1], b[1] * b[2], b[2] * b[2]];
        for (row, bb) in self.normal.iter_mut().zip(bb) {
            for (sum, hh) in row.iter_mut().zip(hh) {
                *sum += bb * hh;
            }
        }
        let wh = [x, y, z, 0.0];
        for (row, b) in self.right.iter_mut().zip(b) {
            let rb = r * b;
            for (sum, wh) in row.iter_mut().zip(wh) {
                *sum += rb * wh;
            }
        }
    }

    fn put(&self, to: &mut PatchSums) {
        for (row, from) in to.normal.iter_mut().zip(&self.normal) {
            row.copy_from_slice(&from[..6]);
        }
        for (row, from) in to.right.iter_mut().zip(&self.right) {
            row.copy_from_slice(&from[..3]);
        }
    }
}

/// One triangle's part of the normal equations in the world, over all cameras, in units of the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TriangleTerm {
    /// Blocks of the corners, in the order of [`PatchSums::normal`].
    pub normal: [DMat3; 6],
    /// Downhill of each corner.
    pub right: [DVec3; 3],
    /// Cameras that place it.
    pub cameras: u32,
    /// Sum of the residuals' sizes in the cameras that place it, and their number.
    pub absolute: f64,
    pub count: f64,
}

impl TriangleTerm {
    pub const NONE: Self =
        Self { normal: [DMat3::ZERO; 6], right: [DVec3::ZERO; 3], cameras: 0, absolute: 0.0, count: 0.0 };

    /// Adds a camera's sums, turned into the world, with a weight.
    pub fn add(&mut self, sums: &PatchSums, rotation: &DMat3, weight: f64) {
        let back = rotation.transpose();
        for (block, s) in self.normal.iter_mut().zip(&sums.normal) {
            let [xx, xy, xz, yy, yz, zz] = s.map(f64::from);
            let m = DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz));
            *block += back * m * *rotation * weight;
        }
        for (right, s) in self.right.iter_mut().zip(&sums.right) {
            *right -= back * DVec3::from_array(s.map(f64::from)) * weight;
        }
        self.absolute += f64::from(sums.absolute);
        self.count += f64::from(sums.count);
    }
}

/// The samples of a triangle in a camera.
pub(super) fn samples<'a>(
    level: &'a LevelSamples,
    mask: &'a [f32],
    camera: usize,
    triangle: usize,
    channels: usize,
) -> PatchSamples<'a> {
    let (from, to) = (level.starts[triangle], level.starts[triangle + 1]);
    PatchSamples {
        shares: &level.shares[from..to],
        seen: &level.seen[camera][from * channels..to * channels],
        mask: &mask[from..to],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(channels: usize) -> Plane {
        // Linear within a cell of 40 pixels would be exact everywhere; a smooth picture keeps bilinear samples near it.
        let value = |x: usize, y: usize, c: usize| {
            120.0 + 50.0 * (x as f32 * 0.11 + c as f32).sin() + 40.0 * (y as f32 * 0.09).cos() + 0.3 * x as f32
        };
        let values =
            (0..120 * 120 * channels).map(|i| value(i / channels % 120, i / channels / 120, i % channels)).collect();
        Plane { width: 120, height: 120, channels, values }
    }

    /// The summed gradient is the change of the cost with each coordinate, by central differences, and the blocks are the
    /// products of the single samples' derivatives.
    fn check<const C: usize>() {
        let plane = plane(C);
        let view = LevelView {
            plane: &plane,
            rotation: DMat3::from_rotation_y(0.3) * DMat3::from_rotation_x(0.2),
            translation: DVec3::new(0.02, -0.01, 1.1),
            focal: DVec2::new(150.0, 160.0),
            centre: DVec2::new(58.0, 61.0),
        };
        let level = LevelSamples::new(&[30.0], 2.0, 1, C);
        let seen: Vec<f32> = (0..level.shares.len() * C).map(|i| 110.0 + ((i * 37) % 23) as f32).collect();
        let mask = vec![1.0; level.shares.len()];
        let of = PatchSamples { shares: &level.shares, seen: &seen, mask: &mask };
        let tone = Tone { gain: 1.1, offset: -4.0 };
        let corners = [DVec3::new(-0.15, -0.1, 0.05), DVec3::new(0.2, -0.05, -0.04), DVec3::new(0.0, 0.2, 0.0)];
        // Without the robust weight, whose derivative Gauss and Newton leave out.
        let plain = 1e12;
        let at = |corners: [DVec3; 3]| view.sums::<C>(corners.map(|p| view.axes(p)), &of, tone, plain);
        let mut term = TriangleTerm::NONE;
        term.add(&at(corners), &view.rotation, 1.0);
        let by = 2e-4;
        for i in 0..3 {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let moved = |by: f64| {
                    let mut c = corners;
                    c[i] += axis * by;
                    f64::from(at(c).cost)
                };
                let change = (moved(by) - moved(-by)) / (2.0 * by);
                let gradient = -2.0 * term.right[i].dot(axis);
                let scale = term.right.iter().map(|r| r.length()).fold(0.0, f64::max) * 2.0;
                assert!((change - gradient).abs() < 0.01 * scale, "corner {i} {axis}: {change} {gradient}");
            }
        }
        for (k, [i, j]) in [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]].into_iter().enumerate() {
            let mut wanted = DMat3::ZERO;
            for s in 0..level.shares.len() {
                let one =
                    PatchSamples { shares: &level.shares[s..=s], seen: &seen[s * C..(s + 1) * C], mask: &mask[s..=s] };
                for c in 0..C {
                    // A sample's own derivative, with its residual shifted to 1 through what was seen.
                    let mut was = one.seen.to_vec();
                    let value = view.plane.sample(cell(&view, corners, one.shares[0]), c)[0];
                    was.fill(f32::MAX);
                    was[c] = tone.gain * value + tone.offset - 1.0;
                    let only = PatchSamples { seen: &was, ..one };
                    let sums = view.sums::<C>(corners.map(|p| view.axes(p)), &only, tone, 1e6);
                    let d = sums.right.map(|r| view.rotation.transpose() * DVec3::from_array(r.map(f64::from)));
                    wanted += DMat3::from_cols(d[i] * d[j].x, d[i] * d[j].y, d[i] * d[j].z);
                }
            }
            let off = (term.normal[k] - wanted).to_cols_array().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let size = wanted.to_cols_array().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            assert!(off < 2e-3 * size, "block {i}{j}: {off} of {size}");
        }
    }

    fn cell(view: &LevelView, corners: [DVec3; 3], share: Vec3) -> (usize, f32, f32) {
        let [a, b, c] = corners.map(|p| view.axes(p));
        let p = a * share.x + b * share.y + c * share.z;
        let at = p.truncate() / p.z * view.focal.as_vec2() + view.centre.as_vec2();
        view.plane.cell(at.x, at.y).unwrap()
    }

    #[test]
    fn analytic_gradients_are_those_of_finite_differences() {
        check::<1>();
        check::<3>();
    }

    #[test]
    fn a_tone_undoes_a_shadow() {
        let mut sums = PatchSums { count: 200.0, ..PatchSums::NONE };
        for i in 0..200 {
            let was = 90.0 + 30.0 * (i as f32 * 0.7).sin();
            let value = 0.6 * was + 5.0;
            for (m, v) in sums.moments.iter_mut().zip([value, was, value * value, value * was, was * was]) {
                *m += v;
            }
        }
        let tone = sums.tone(1);
        assert!((tone.gain - 1.0 / 0.6).abs() < 0.03, "{tone:?}");
        assert!(sums.agreement(1).0 > 0.999);
        assert_eq!(PatchSums::NONE.tone(1), Tone::SAME);
    }
}
