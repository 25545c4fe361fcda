//! The relief of one repeat of a weave, as a slope map.
//!
//! Stored as slopes rather than normals, so that a coarser level of detail is the plain mean of the finer one (Mikkelsen
//! 2010, "Bump mapping unparametrized surfaces on the GPU", takes slopes).

use std::f32::consts::{PI, TAU};

use toile_base::fabric::Weave;

/// Texels of a map's side, a power of two.
pub const SIDE: u32 = 128;

/// Depth of the relief as a share of the distance between threads.
const RELIEF: f32 = 0.22;

/// How much darker the gaps between threads are.
const GAP: f32 = 0.38;

/// Greatest slope that a texel can hold.
pub const STEEPEST: f32 = 2.0;

/// Threads of one repeat, along both sides.
pub fn repeat(weave: Weave) -> u32 {
    match weave {
        Weave::Plain => 2,
        Weave::Twill => 4,
        Weave::Knit => 1,
    }
}

/// The relief of one repeat.
#[derive(Debug, Clone, Copy)]
pub struct WeaveRelief(pub Weave);

impl WeaveRelief {
    /// Height over the middle surface, 0 (deepest gap) .. 1 (top of a thread), at a place in the repeat; both
    /// coordinates in threads.
    fn height(self, x: f32, y: f32) -> f32 {
        match self.0 {
            Weave::Plain | Weave::Twill => self.woven(x, y),
            Weave::Knit => knitted(x, y),
        }
    }

    /// The higher of the two threads that cross here. Each is a rounded ridge that rises where it lies on top.
    fn woven(self, x: f32, y: f32) -> f32 {
        let (column, row) = (x.floor(), y.floor());
        let over = |column: f32, row: f32| {
            // Along the row one over one, or two over two.
            let step = if self.0 == Weave::Twill { 1.0 } else { 2.0 };
            if (step * (column + row)).rem_euclid(4.0) < 2.0 { 1.0 } else { 0.0 }
        };
        // How far up the warp (or the weft) lies here, eased towards the neighbours along its own run.
        let eased = |at: f32, here: f32, before: f32, after: f32| {
            let t = at.fract() - 0.5;
            let other = if t < 0.0 { before } else { after };
            let s = (t.abs() * PI).sin();
            here + (0.5 * (here + other) - here) * s * s
        };
        let warp_up = eased(y, over(column, row), over(column, row - 1.0), over(column, row + 1.0));
        let weft_up = 1.0 - eased(x, over(column, row), over(column - 1.0, row), over(column + 1.0, row));
        let ridge = |across: f32| (1.0 - (2.0 * across.fract() - 1.0).powi(2)).max(0.0).sqrt();
        (ridge(x) * (0.35 + 0.65 * warp_up)).max(ridge(y) * (0.35 + 0.65 * weft_up))
    }

    /// One repeat as texels `[SIDE x SIDE]`, rows from v = 0: slope along u, slope along v (both over the thread pitch,
    /// -[`STEEPEST`]..[`STEEPEST`]), and how open to light, each a byte; the fourth is unused.
    pub fn map(self) -> Vec<[u8; 4]> {
        let threads = repeat(self.0) as f32;
        let texel = threads / SIDE as f32;
        let height = |x: f32, y: f32| self.height(x.rem_euclid(threads), y.rem_euclid(threads));
        let slope = |rise: f32| ((rise * RELIEF / (2.0 * texel) / STEEPEST).clamp(-1.0, 1.0) * 127.0 + 128.0) as u8;
        let texel_at = |i: u32| {
            let (x, y) = (((i % SIDE) as f32 + 0.5) * texel, ((i / SIDE) as f32 + 0.5) * texel);
            let along_x = height(x + texel, y) - height(x - texel, y);
            let along_y = height(x, y + texel) - height(x, y - texel);
            let open = 1.0 - GAP * (1.0 - height(x, y).clamp(0.0, 1.0)).powi(2);
            [slope(along_x), slope(along_y), (open * 255.0) as u8, 255]
        };
        (0..SIDE * SIDE).map(texel_at).collect()
    }

    /// The map and its coarser levels, each half as wide, down to one texel.
    pub fn levels(self) -> Vec<Vec<[u8; 4]>> {
        let mut levels = vec![self.map()];
        let mut side = SIDE as usize;
        while side > 1 {
            let finer = &levels[levels.len() - 1];
            let half = side / 2;
            let mean = |i: usize| {
                let (x, y) = (i % half * 2, i / half * 2);
                let four = [y * side + x, y * side + x + 1, (y + 1) * side + x, (y + 1) * side + x + 1];
                std::array::from_fn(|c| (four.iter().map(|&at| u32::from(finer[at][c])).sum::<u32>() / 4) as u8)
            };
            levels.push((0..half * half).map(mean).collect());
            side = half;
        }
        levels
    }
}

/// One stitch: two legs that lean together downwards, with the loop above tucked behind.
fn knitted(x: f32, y: f32) -> f32 {
    let lean = 0.16 * (y * TAU).cos();
    let leg = |middle: f32| {
        let across = (x - middle) / 0.27;
        (1.0 - across * across).max(0.0).sqrt() * (0.7 + 0.3 * (y * TAU + 0.9).sin())
    };
    leg(0.27 + lean * 0.6).max(leg(0.73 - lean * 0.6))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_weave_has_relief_that_averages_to_nothing() {
        for weave in [Weave::Plain, Weave::Twill, Weave::Knit] {
            let map = WeaveRelief(weave).map();
            let mean = |c: usize| map.iter().map(|t| f32::from(t[c]) - 128.0).sum::<f32>() / map.len() as f32;
            let rough = map.iter().filter(|t| t[0].abs_diff(128) > 12 || t[1].abs_diff(128) > 12).count();
            assert!(mean(0).abs() < 4.0 && mean(1).abs() < 4.0, "{weave:?} leans: {} {}", mean(0), mean(1));
            assert!(rough > map.len() / 4, "{weave:?} is smooth: {rough}");
        }
    }

    #[test]
    fn weaves_repeat_without_a_seam() {
        for weave in [Weave::Plain, Weave::Twill, Weave::Knit] {
            let threads = repeat(weave) as f32;
            for i in 0..40 {
                let at = i as f32 * threads / 40.0;
                let (left, right) =
                    (WeaveRelief(weave).height(1e-4, at), WeaveRelief(weave).height(threads - 1e-4, at));
                assert!((left - right).abs() < 0.06, "{weave:?} at {at}: {left} {right}");
            }
        }
    }

    #[test]
    fn levels_halve_down_to_one_flat_texel() {
        let levels = WeaveRelief(Weave::Twill).levels();
        assert_eq!(levels.len(), SIDE.ilog2() as usize + 1);
        assert!(levels.iter().enumerate().all(|(i, l)| l.len() == (SIDE as usize >> i).pow(2)));
        let last = levels[levels.len() - 1][0];
        assert!(last[0].abs_diff(128) < 6 && last[1].abs_diff(128) < 6 && last[2] > 150, "{last:?}");
    }

    #[test]
    fn twill_runs_diagonally_and_plain_does_not() {
        // Shifted by one thread along both, a twill looks as before; a plain weave too, but not along one alone.
        for (x, y) in [(0.3, 0.4), (1.6, 2.2), (2.5, 3.7)] {
            let twill = |x: f32, y: f32| WeaveRelief(Weave::Twill).height(x % 4.0, y % 4.0);
            assert!((twill(x, y) - twill(x + 1.0, y + 3.0)).abs() < 1e-5);
        }
        let plain = |x: f32, y: f32| WeaveRelief(Weave::Plain).height(x % 2.0, y % 2.0);
        assert!((plain(0.5, 0.8) - plain(1.5, 0.8)).abs() > 0.01);
    }
}
