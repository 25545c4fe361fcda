//! The fit map: how tight a garment sits at each place, in eight colours that a colour-blind reader can tell apart.

use glam::Vec3;
use toile_assets::sizes::Girth;
use toile_base::garment::Garment;
use toile_engine::cloth::{Cloth, step::measure};
use toile_engine::world::World;

use crate::{
    image::{Image, Size},
    text::{self, TextSize},
    tone_mapping,
};

/// The steps from loosest to tightest, sRGB bytes: blue, pale in the middle, red. Lightness peaks in the middle and falls
/// to both ends, and blue against orange survives red-green blindness.
pub const STEPS: [[u8; 3]; 8] = [
    [38, 62, 140],
    [66, 118, 186],
    [127, 178, 218],
    [200, 224, 232],
    [250, 232, 176],
    [250, 184, 98],
    [226, 108, 48],
    [156, 30, 30],
];

/// The ink of the legend's words.
const INK: [u8; 3] = [70, 68, 66];

/// The step (0 loosest .. 7 tightest) of a value in -1 (loose) .. 1 (tight); values beyond count as the ends, and NaN
/// has no step.
pub fn step(value: f32) -> Option<usize> {
    (!value.is_nan()).then(|| (((value + 1.0) * 4.0).max(0.0) as usize).min(STEPS.len() - 1))
}

/// The colour of a value in -1 (loose) .. 1 (tight), linear RGB; mid grey for NaN.
pub fn colour(value: f32) -> Vec3 {
    let bytes = step(value).map_or([128; 3], |i| STEPS[i]);
    Vec3::from_array(bytes.map(|b| tone_mapping::decode(f32::from(b) / 255.0)))
}

/// How far above and below a level the mean of a zone is taken (m).
const BAND_M: f32 = 0.04;

/// Beyond the highest and the lowest zone what a verdict says counts less, and so far off (m) nothing.
const FADES_M: f32 = 0.25;

/// How tight a garment sits at each particle, so that words and colours agree: around the level of each zone that was judged the mean
/// is what the verdict says, between two levels what is added goes from one to the other, and what differs from place to place
/// stays. `levels` are heights (m) and the verdicts' tightness there, from the top down; `heights` those of the particles (m).
pub fn agreed(local: &[f32], heights: &[f32], levels: &[(f32, f32)]) -> Vec<f32> {
    let shift = |(level, wanted): &(f32, f32)| {
        let near = local.iter().zip(heights).filter(|(v, y)| v.is_finite() && (**y - level).abs() < BAND_M);
        let (sum, count) = near.fold((0.0f64, 0u32), |(sum, n), (v, _)| (sum + f64::from(*v), n + 1));
        (count > 0).then(|| (*level, wanted - (sum / f64::from(count)) as f32))
    };
    let shifts: Vec<(f32, f32)> = levels.iter().filter_map(shift).collect();
    let at = |y: f32| -> f32 {
        let above = shifts.iter().rfind(|(level, _)| *level >= y);
        let below = shifts.iter().find(|(level, _)| *level < y);
        let fading = |(level, by): (f32, f32)| by * (1.0 - (y - level).abs() / FADES_M).max(0.0);
        match (above, below) {
            (Some((high, a)), Some((low, b))) => b + (a - b) * (y - low) / (high - low).max(1e-6),
            (Some(end), None) | (None, Some(end)) => fading(*end),
            (None, None) => 0.0,
        }
    };
    local.iter().zip(heights).map(|(v, y)| (v + at(*y)).clamp(-1.0, 1.0)).collect()
}

/// How tight a garment was judged, -1 (loose) .. 1 (tight), at the zones where it is known.
pub type JudgedTightness = Vec<(Girth, f32)>;

/// The fit map of each garment of a world: how tight it sits from place to place, in the mean as tight as it was judged
/// `[garments][particles]`.
pub fn of_world(world: &World, judged: &[JudgedTightness]) -> Vec<Vec<f32>> {
    let levels = &world.body().levels;
    let level = |zone: Girth| match zone {
        Girth::Chest => levels.chest,
        Girth::Waist => levels.waist,
        Girth::Hip => levels.hip,
    };
    let map = |((cloth, garment), judged): ((&Cloth, &Garment), &JudgedTightness)| {
        let local = measure::tightness(cloth, garment, world.colliders());
        let heights: Vec<f32> = garment.start.iter().map(|p| p.y).collect();
        let mut known: Vec<(f32, f32)> = judged.iter().map(|(zone, tight)| (level(*zone), *tight)).collect();
        known.sort_by(|a, b| b.0.total_cmp(&a.0));
        agreed(&local, &heights, &known)
    };
    world.cloths().iter().zip(world.garments()).zip(judged).map(map).collect()
}

/// A strip with the eight steps and the words loose, good, tight, on the given paper (sRGB).
pub fn legend(width: u32, paper: [u8; 3]) -> Image {
    let (bar, gap) = (14, 5);
    let line = TextSize::Small.height();
    let mut image = Image::filled(Size::new(width, bar + gap + line), paper);
    let count = STEPS.len() as u32;
    for (i, &step) in (0..).zip(&STEPS) {
        let (from, to) = (width * i / count, width * (i + 1) / count);
        let size = Size::new((to - from).saturating_sub(u32::from(i + 1 < count) * 2), bar);
        image.fill(from as i32, 0, size, step);
    }
    let words = [("loose", 0.0), ("good", 0.5), ("tight", 1.0)];
    for (word, at) in words {
        let room = width as f32 - TextSize::Small.width(word) as f32;
        text::draw(&mut image, (room * at) as i32, (bar + gap) as i32, word, TextSize::Small, INK);
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Full deuteranopia and protanopia, linear RGB, row by row (Machado, Oliveira and Fernandes 2009, "A
    /// physiologically-based model for simulation of color vision deficiency", severity 1.0).
    const DEUTERANOPIA: [[f32; 3]; 3] =
        [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]];
    const PROTANOPIA: [[f32; 3]; 3] =
        [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]];
    const HEALTHY: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// Least CIELAB distance between two steps; about 2.3 is just noticeable side by side, and a legend is not.
    const DISTINCT: f32 = 12.0;

    #[test]
    fn colours_and_words_agree_at_every_zone_and_places_still_differ() {
        let heights: Vec<f32> = (0..=100).map(|i| 1.4 - 0.01 * i as f32).collect();
        // A local unevenness over a garment that looks loose everywhere.
        let local: Vec<f32> = (0..=100).map(|i| -0.6 + 0.1 * (i as f32 * 0.9).sin()).collect();
        let levels = [(1.25, 0.1), (1.05, -0.3), (0.85, 0.6)];
        let map = agreed(&local, &heights, &levels);
        for (level, wanted) in levels {
            let near: Vec<f32> =
                map.iter().zip(&heights).filter(|(_, y)| (**y - level).abs() < 0.04).map(|(v, _)| *v).collect();
            let mean = near.iter().sum::<f32>() / near.len() as f32;
            // Half a colour: what is added bends at the level.
            assert!((mean - wanted).abs() < 0.125, "{level}: {mean} {wanted}");
            assert!(near.iter().any(|v| (v - mean).abs() > 0.03), "places differ");
        }
        assert_eq!(map[100], local[100], "far below the lowest zone nothing is added");
        assert_eq!(agreed(&local, &heights, &[]), local);
        assert!(agreed(&[f32::NAN; 2], &[1.0, 1.0], &[(1.0, 0.5)]).iter().all(|v| v.is_nan()));
    }

    fn seen(matrix: &[[f32; 3]; 3], c: Vec3) -> Vec3 {
        Vec3::from_array(matrix.map(|row| Vec3::from_array(row).dot(c))).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Linear sRGB to CIELAB under D65.
    fn lab(c: Vec3) -> Vec3 {
        let x = Vec3::new(0.412_456, 0.357_576, 0.180_437).dot(c) / 0.950_47;
        let y = Vec3::new(0.212_673, 0.715_152, 0.072_175).dot(c);
        let z = Vec3::new(0.019_334, 0.119_192, 0.950_304).dot(c) / 1.088_83;
        let f = |t: f32| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
        Vec3::new(116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z)))
    }

    #[test]
    fn eight_steps_are_distinct_for_healthy_and_colour_blind_eyes() {
        for (name, matrix) in [("healthy", HEALTHY), ("deuteranopia", DEUTERANOPIA), ("protanopia", PROTANOPIA)] {
            let labs: Vec<_> = (0..8).map(|i| lab(seen(&matrix, colour((i as f32 - 3.5) / 4.0)))).collect();
            for i in 0..8 {
                for j in 0..i {
                    let apart = labs[i].distance(labs[j]);
                    assert!(apart > DISTINCT, "{name}: steps {j} and {i} are {apart} apart");
                }
            }
        }
    }

    #[test]
    fn lightness_rises_to_the_middle_and_falls_after_it() {
        let light: Vec<_> = (0..8).map(|i| lab(colour((i as f32 - 3.5) / 4.0)).x).collect();
        assert!(light[..4].is_sorted_by(|a, b| a < b) && light[4..].is_sorted_by(|a, b| a > b), "{light:?}");
    }

    #[test]
    fn values_fall_into_their_steps_and_odd_ones_do_not_panic() {
        assert_eq!(step(-1.0), Some(0));
        assert_eq!(step(-0.01), Some(3));
        assert_eq!(step(0.01), Some(4));
        assert_eq!(step(1.0), Some(7));
        assert_eq!(step(f32::INFINITY), Some(7));
        assert_eq!(step(f32::NEG_INFINITY), Some(0));
        assert_eq!(step(f32::NAN), None);
        assert!(colour(f32::NAN).is_finite());
    }

    #[test]
    fn the_legend_shows_every_step_from_loose_to_tight() {
        let legend = legend(320, [255; 3]);
        for (i, &step) in (0..).zip(&STEPS) {
            assert_eq!(legend.pixel(320 * i / 8 + 10, 7), Some(step));
        }
    }
}
