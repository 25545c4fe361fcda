//! The table by which images of a lens that bends straight lines become those of a pinhole.

use crate::lens::BrownConrady;
use toile_base::frame::Intrinsics;

/// A straightened image is at most so much wider or higher than the bent one, or narrower or lower: more bends no lens.
const LARGEST_GROWTH: f32 = 1.5;

/// Neighbours that differ by more than this fraction of their depth, and by more than [`EDGE_MM`], lie on two surfaces.
const EDGE: f32 = 0.02;
const EDGE_MM: f32 = 10.0;

/// Turns images of a bent lens into those of a pinhole of the same focal lengths, a little larger so that the middle of
/// each side stays in view.
#[derive(Debug, Clone)]
pub(super) struct Straighten {
    /// The camera of the images that go in.
    bent: Intrinsics,
    /// The camera of the images that come out.
    pub straight: Intrinsics,
    /// Where each pixel that comes out is seen in the image that goes in (px); NaN where it is not `[straight pixels]`.
    from: Box<[[f32; 2]]>,
}

impl Straighten {
    /// The table of a lens; `None` where no lens is like the model: folded from the middle on, or growing without end.
    pub fn new(bent: Intrinsics, lens: &BrownConrady) -> Option<Self> {
        let sound = lens.sound_radius();
        if sound <= 0.0 {
            return None;
        }
        let side = |axis: usize, size: u32, f: f32, c: f32| {
            let edge = |px: f32| unbend(lens, axis, (px - c) / f, sound) * f;
            let (first, last) = (edge(0.0).floor(), edge(size as f32 - 1.0).ceil());
            let pixels = last - first + 1.0;
            let sane =
                pixels.is_finite() && pixels >= size as f32 / LARGEST_GROWTH && pixels <= size as f32 * LARGEST_GROWTH;
            sane.then_some((pixels as u32, -first))
        };
        let (width, cx) = side(0, bent.width, bent.fx, bent.cx)?;
        let (height, cy) = side(1, bent.height, bent.fy, bent.cy)?;
        let straight = Intrinsics { width, height, cx, cy, ..bent };
        if straight.fault().is_some() {
            return None;
        }
        let from = table(&bent, &straight, lens, sound);
        Some(Self { bent, straight, from })
    }

    /// The straight image of a bent one (mm). Between four pixels of one surface depth is interpolated; at an edge the
    /// nearest pixel is taken, so that no depth is made up between two surfaces.
    pub fn apply_into(&self, bent: &[u16], straight: &mut Vec<u16>) {
        straight.clear();
        straight.extend(self.from.iter().map(|&[u, v]| if u.is_nan() { 0 } else { self.sample(bent, u, v) }));
    }

    fn sample(&self, bent: &[u16], u: f32, v: f32) -> u16 {
        let (w, h) = (self.bent.width as usize, self.bent.height as usize);
        let (u0, v0) = ((u as usize).min(w.saturating_sub(2)), (v as usize).min(h.saturating_sub(2)));
        let (right, below) = ((u0 + 1).min(w - 1), (v0 + 1).min(h - 1));
        let corners = [bent[v0 * w + u0], bent[v0 * w + right], bent[below * w + u0], bent[below * w + right]];
        let (low, high) = corners.iter().fold((u16::MAX, 0), |(l, h), d| (l.min(*d), h.max(*d)));
        let (a, b) = (u - u0 as f32, v - v0 as f32);
        if low == 0 || f32::from(high - low) > EDGE_MM.max(EDGE * f32::from(low)) {
            return corners[usize::from(a > 0.5) + 2 * usize::from(b > 0.5)];
        }
        let [p, q, r, s] = corners.map(f32::from);
        ((p + (q - p) * a) * (1.0 - b) + (r + (s - r) * a) * b).round() as u16
    }
}

/// The straight coordinate along one axis whose bent one is `wanted`, both from the middle, within the sound radius.
fn unbend(lens: &BrownConrady, axis: usize, wanted: f32, sound: f32) -> f32 {
    let at = |t: f32| {
        let mut p = [0.0; 2];
        p[axis] = t;
        lens.bend(p)[axis]
    };
    let (mut low, mut high) = if wanted < 0.0 { (-sound, 0.0) } else { (0.0, sound) };
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if at(middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn table(bent: &Intrinsics, straight: &Intrinsics, lens: &BrownConrady, sound: f32) -> Box<[[f32; 2]]> {
    let [right, bottom] = [bent.width as f32 - 1.0, bent.height as f32 - 1.0];
    let mut from = Vec::with_capacity(straight.pixels());
    for v in 0..straight.height {
        for u in 0..straight.width {
            let ray = [(u as f32 - straight.cx) / straight.fx, (v as f32 - straight.cy) / straight.fy];
            let r = (ray[0] - lens.centre[0]).hypot(ray[1] - lens.centre[1]);
            let [x, y] = lens.bend(ray);
            let (u, v) = (bent.cx + bent.fx * x, bent.cy + bent.fy * y);
            let seen = r <= sound && (0.0..=right).contains(&u) && (0.0..=bottom).contains(&v);
            from.push(if seen { [u, v] } else { [f32::NAN; 2] });
        }
    }
    from.into_boxed_slice()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn applied(table: &Straighten, bent: &[u16]) -> Vec<u16> {
        let mut straight = Vec::new();
        table.apply_into(bent, &mut straight);
        straight
    }

    const CAMERA: Intrinsics = Intrinsics { width: 160, height: 120, fx: 120.0, fy: 120.0, cx: 80.0, cy: 58.0 };

    /// Bends as strongly as the lens of an Azure Kinect.
    const LENS: BrownConrady = BrownConrady {
        k: [0.548, -0.021, -0.0027, 0.89, 0.086, -0.0139],
        p: [-7.2e-5, 2.1e-5],
        centre: [0.0; 2],
        widest: 1.74,
    };

    #[test]
    fn a_plane_that_a_bent_lens_saw_is_flat_again() {
        // Depth along z of a slanted plane z = 2000 / (1 - 0.3 x), as the bent lens sees it, found by search.
        let straight = Straighten::new(CAMERA, &LENS).unwrap();
        let plane = |x: f32| 2000.0 / (1.0 - 0.3 * x);
        let unbent = |u: f32, v: f32| {
            let wanted = [(u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy];
            let mut ray = wanted;
            for _ in 0..50 {
                let bent = LENS.bend(ray);
                ray = [ray[0] + wanted[0] - bent[0], ray[1] + wanted[1] - bent[1]];
            }
            ray
        };
        let image: Vec<u16> =
            (0..CAMERA.pixels()).map(|i| plane(unbent((i % 160) as f32, (i / 160) as f32)[0]).round() as u16).collect();
        let out = applied(&straight, &image);
        let k = straight.straight;
        assert!(k.width > 160 && k.height > 120, "{k:?}");
        let (mut worst, mut seen) = (0.0f32, 0);
        for (i, d) in out.iter().enumerate().filter(|(_, d)| **d != 0) {
            let x = ((i % k.width as usize) as f32 - k.cx) / k.fx;
            worst = worst.max((f32::from(*d) - plane(x)).abs());
            seen += 1;
        }
        assert!(worst <= 1.5, "{worst} mm");
        assert!(seen > 160 * 120, "{seen}");
        // Taken as it is, the image is wrong by far more: the table does something.
        let naive = (f32::from(image[58 * 160 + 2]) - plane((2.0 - 80.0) / 120.0)).abs();
        assert!(naive > 15.0, "{naive} mm");
    }

    #[test]
    fn no_depth_is_made_up_at_an_edge() {
        let straight = Straighten::new(CAMERA, &LENS).unwrap();
        let image: Vec<u16> = (0..CAMERA.pixels()).map(|i| if i % 160 < 61 { 1000 } else { 2000 }).collect();
        assert!(applied(&straight, &image).iter().all(|d| [0, 1000, 2000].contains(d)));
    }

    #[test]
    fn models_of_no_lens_are_refused() {
        let with = |k| Straighten::new(CAMERA, &BrownConrady { k, ..LENS });
        assert!(with([-1e9, 0.0, 0.0, 0.0, 0.0, 0.0]).is_none());
        assert!(with([f32::NAN; 6]).is_none());
        assert!(with([0.0, 0.0, 0.0, 1e6, 0.0, 0.0]).is_none());
        let same = with([0.0; 6]).unwrap();
        assert!(same.straight.width <= CAMERA.width + 2, "{:?}", same.straight);
    }
}
