//! The outline of a mask, below the size of a pixel: the places where coverage passes through a half, and the outward direction.

use glam::DVec2;
use toile_sensors::masks::Mask;

/// Least length of the mean of a stretch's normals: a straight one has 1, a speckle next to nothing.
const STRAIGHT: f64 = 0.6;

/// Reach of the smoothing that gives normals (px), and its standard deviation.
const REACH: isize = 3;
const SMOOTH: f64 = 1.5;

/// A stretch of the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    /// Its middle (px).
    pub at: DVec2,
    /// Unit normal in the picture, away from the person.
    pub out: DVec2,
}

/// The outline in stretches of so many pixels. Where the picture's border cuts the person off there is none.
pub(super) fn outline(mask: &Mask, step: usize) -> Vec<Stretch> {
    let columns = mask.width.div_ceil(step);
    let mut sums = vec![(DVec2::ZERO, DVec2::ZERO, 0usize); columns * mask.height.div_ceil(step)];
    let mut cross = |x: usize, y: usize, to: (usize, usize)| {
        let (a, b) = (mask.coverage[y * mask.width + x], mask.coverage[to.1 * mask.width + to.0]);
        if (a >= 0.5) == (b >= 0.5) {
            return;
        }
        let share = f64::from((0.5 - a) / (b - a));
        let from = DVec2::new(x as f64, y as f64);
        let at = from + (DVec2::new(to.0 as f64, to.1 as f64) - from) * share;
        let out = normal(mask, at);
        let cell = (at.y as usize / step) * columns + at.x as usize / step;
        let sum = &mut sums[cell];
        *sum = (sum.0 + at, sum.1 + out, sum.2 + 1);
    };
    for y in 0..mask.height {
        for x in 0..mask.width {
            if x + 1 < mask.width {
                cross(x, y, (x + 1, y));
            }
            if y + 1 < mask.height {
                cross(x, y, (x, y + 1));
            }
        }
    }
    let stretch = |(at, out, count): (DVec2, DVec2, usize)| {
        let whole = 2 * count >= step && out.length() >= STRAIGHT * count as f64;
        whole.then(|| Stretch { at: at / count as f64, out: out.normalize() })
    };
    sums.into_iter().filter_map(stretch).collect()
}

/// The way out at a place: against the slope of the smoothed coverage.
fn normal(mask: &Mask, at: DVec2) -> DVec2 {
    let (cx, cy) = (at.x.round() as isize, at.y.round() as isize);
    let mut slope = DVec2::ZERO;
    for dy in -REACH..=REACH {
        for dx in -REACH..=REACH {
            let d = DVec2::new((cx + dx) as f64 - at.x, (cy + dy) as f64 - at.y);
            let weight = (-0.5 * d.length_squared() / (SMOOTH * SMOOTH)).exp();
            slope += d * (weight * f64::from(mask.at(cx + dx, cy + dy)));
        }
    }
    -slope.normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_of_a_disk_is_where_it_ends() {
        let (centre, radius) = (DVec2::new(80.3, 60.7), 41.4);
        let mask = |soft: bool| {
            let coverage = (0..160 * 120).map(|i| {
                let off = DVec2::new((i % 160) as f64, (i / 160) as f64).distance(centre) - radius;
                if soft { (0.5 - off).clamp(0.0, 1.0) as f32 } else { f32::from(u8::from(off < 0.0)) }
            });
            Mask { width: 160, height: 120, coverage: coverage.collect() }
        };
        for (soft, most) in [(true, 0.15), (false, 0.6)] {
            let found = outline(&mask(soft), 5);
            let off: Vec<f64> = found.iter().map(|s| s.at.distance(centre) - radius).collect();
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            let worst = off.iter().fold(0.0_f64, |m, o| m.max(o.abs()));
            assert!(found.len() > 40 && mean.abs() < 0.08 && worst < most, "{soft}: {mean} {worst}");
            assert!(found.iter().all(|s| s.out.dot((s.at - centre).normalize()) > 0.97));
        }
    }
}
