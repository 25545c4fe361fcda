//! The woven or printed picture of a fabric: one repeat, drawn once at load.

use std::sync::Arc;

use glam::Vec2;
use toile_base::fabric::print::{Print, PrintPattern};
use toile_base::texture::Texture;

/// Texels along a side of a repeat.
const SIDE: u32 = 256;

/// Samples along both sides of a texel.
const SAMPLES: u32 = 3;

/// Accepted lengths of a repeat (mm): from a hair-line to a border print.
pub const REPEAT_MM: [f32; 2] = [0.5, 2_000.0];

/// Most colours of a print.
pub const MOST_COLOURS: usize = 8;

/// What is wrong with it, if anything: the key, and what it must be.
pub(super) fn flaw(print: &Print) -> Option<&'static str> {
    let length = |mm: &f32| (REPEAT_MM[0]..=REPEAT_MM[1]).contains(mm);
    let part = |c: &f32| (0.0..=1.0).contains(c);
    let pictured = print.pattern == PrintPattern::Picture;
    if !print.repeat_mm.iter().all(length) {
        Some("print.repeat_mm must be two lengths of .5 to 2000 mm")
    } else if !part(&print.share) {
        Some("print.share must be from 0 to 1")
    } else if !print.colours.iter().flatten().all(part) || print.colours.len() > MOST_COLOURS {
        Some("print.colours must be at most 8 colours of three numbers from 0 to 1")
    } else if !pictured && print.colours.is_empty() {
        Some("print.colours is empty; give one beside the fabric's own")
    } else if pictured != print.picture.is_some() {
        Some("print.picture belongs to the pattern \"picture\", and that needs it")
    } else {
        None
    }
}

/// Draws one repeat; none of a print that is a picture.
pub(super) fn draw(print: &Print) -> Option<Arc<Texture>> {
    if print.pattern == PrintPattern::Picture {
        return None;
    }
    let texel = |i: u32| {
        let (x, y) = (i % SIDE, SIDE - 1 - i / SIDE);
        let (mut sum, mut covered) = ([0.0f32; 3], 0.0f32);
        for k in 0..SAMPLES * SAMPLES {
            let inside = |part: u32| (part as f32 + 0.5) / SAMPLES as f32;
            let at = Vec2::new(x as f32 + inside(k % SAMPLES), y as f32 + inside(k / SAMPLES)) / SIDE as f32;
            if let Some((colour, cover)) = colour_at(print, at) {
                (0..3).for_each(|c| sum[c] += colour[c] * cover);
                covered += cover;
            }
        }
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
        let [r, g, b] = if covered > 0.0 { sum.map(|c| byte(c / covered)) } else { print.colours[0].map(byte) };
        [r, g, b, byte(covered / (SAMPLES * SAMPLES) as f32)]
    };
    Some(Arc::new(Texture { width: SIDE, height: SIDE, texels: (0..SIDE * SIDE).map(texel).collect() }))
}

/// Colour and how much of the ground it covers at a place of the repeat (0..1 along weft and warp).
fn colour_at(print: &Print, p: Vec2) -> Option<([f32; 3], f32)> {
    let full = |c: usize| Some((print.colours[c % print.colours.len()], 1.0));
    match print.pattern {
        PrintPattern::Stripes => band(print, p.x),
        PrintPattern::Hoops => band(print, p.y),
        PrintPattern::Gingham => {
            let threads = [p.x, p.y].into_iter().filter(|t| *t < print.share).count();
            (threads > 0).then(|| (print.colours[0], 0.5 * threads as f32))
        }
        PrintPattern::Windowpane => (p.x < print.share || p.y < print.share).then(|| full(0)).flatten(),
        PrintPattern::Houndstooth => {
            let (i, j) = ((p.x * 8.0) as i32, (p.y * 8.0) as i32);
            let warp_on_top = (i + j).rem_euclid(4) < 2;
            let dark = if warp_on_top { i < 4 } else { j < 4 };
            dark.then(|| full(0)).flatten()
        }
        PrintPattern::Herringbone => {
            let (i, j) = ((p.x * 16.0) as i32, (p.y * 4.0) as i32);
            let turned = if i < 8 { i + j } else { 15 - i + j };
            (turned.rem_euclid(4) < 2).then(|| full(0)).flatten()
        }
        PrintPattern::Dots => {
            let (at, number) = brick(p);
            // A share of the area: pi r2 twice in a repeat.
            let radius = (print.share / std::f32::consts::TAU).sqrt();
            (at.length() < radius).then(|| full(number)).flatten()
        }
        PrintPattern::Flowers => flower(print, p),
        PrintPattern::Picture => None,
    }
}

/// Bands of all colours, with as many of the ground between them.
fn band(print: &Print, t: f32) -> Option<([f32; 3], f32)> {
    let n = print.colours.len() as f32;
    let (band, inside) = ((t * n) as usize, (t * n).fract());
    (inside < print.share).then(|| (print.colours[band.min(print.colours.len() - 1)], 1.0))
}

/// A flower of five petals, its middle, and two leaves.
fn flower(print: &Print, p: Vec2) -> Option<([f32; 3], f32)> {
    let (at, number) = brick(p);
    let size = 0.42 * print.share.sqrt();
    // Each turned its own way, or it would look stamped.
    let turned = Vec2::from_angle(1.1 + 2.4 * number as f32).rotate(at) / size;
    let colour = |c: usize| Some((print.colours[c % print.colours.len()], 1.0));
    let far = turned.length();
    if far < 0.24 {
        return colour(1);
    }
    let petal = 0.62 + 0.26 * (5.0 * turned.to_angle()).cos();
    if far < petal {
        return colour(0);
    }
    let leaf = |side: f32| {
        let own = Vec2::from_angle(side).rotate(turned) - Vec2::new(1.0, 0.0);
        (own / Vec2::new(0.34, 0.13)).length() < 1.0
    };
    (print.colours.len() > 2 && (leaf(0.5) || leaf(2.7))).then(|| colour(2)).flatten()
}

/// Where a place lies in its half of a repeat, from the middle: two cells, one above the other, the second shifted by half.
fn brick(p: Vec2) -> (Vec2, usize) {
    // The nearest of the middles (1/4, 1/4) and (3/4, 3/4), and of their repetitions.
    let from = |middle: Vec2| {
        let d = p - middle;
        d - d.round()
    };
    let [a, b] = [from(Vec2::splat(0.25)), from(Vec2::splat(0.75))];
    if a.length_squared() <= b.length_squared() { (a, 0) } else { (b, 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [PrintPattern; 8] = [
        PrintPattern::Stripes,
        PrintPattern::Hoops,
        PrintPattern::Gingham,
        PrintPattern::Windowpane,
        PrintPattern::Houndstooth,
        PrintPattern::Herringbone,
        PrintPattern::Dots,
        PrintPattern::Flowers,
    ];

    fn print(pattern: PrintPattern, share: f32) -> Print {
        let colours = vec![[0.1, 0.2, 0.5], [0.9, 0.8, 0.1], [0.2, 0.5, 0.2]];
        Print { pattern, colours, repeat_mm: [20.0; 2], share, picture: None }
    }

    fn covered(texture: &Texture) -> f32 {
        texture.texels.iter().map(|t| f32::from(t[3])).sum::<f32>() / (255.0 * texture.texels.len() as f32)
    }

    #[test]
    fn a_print_covers_the_share_that_it_states() {
        for (pattern, share) in [
            (PrintPattern::Stripes, 0.3),
            (PrintPattern::Hoops, 0.6),
            (PrintPattern::Gingham, 0.5),
            (PrintPattern::Dots, 0.2),
        ] {
            let found = covered(&draw(&print(pattern, share)).unwrap());
            assert!((found - share).abs() < 0.01, "{pattern:?}: {found}, stated {share}");
        }
        for pattern in [PrintPattern::Houndstooth, PrintPattern::Herringbone] {
            assert!((covered(&draw(&print(pattern, 0.5)).unwrap()) - 0.5).abs() < 0.01, "{pattern:?}");
        }
    }

    #[test]
    fn prints_repeat_without_a_seam() {
        for pattern in ALL {
            let print = print(pattern, 0.4);
            let jumps = (0..64).filter(|i| {
                let t = (*i as f32 + 0.37) / 64.0;
                let edge = |x: f32, y: f32| colour_at(&print, Vec2::new(x, y)).is_some();
                // A boundary of threads or stripes may lie at the edge of the repeat; one across must go on.
                edge(t, 1e-4) != edge(t, 1.0 - 1e-4) && edge(1e-4, t) != edge(1.0 - 1e-4, t)
            });
            let threads = matches!(
                pattern,
                PrintPattern::Stripes
                    | PrintPattern::Hoops
                    | PrintPattern::Gingham
                    | PrintPattern::Windowpane
                    | PrintPattern::Houndstooth
                    | PrintPattern::Herringbone
            );
            assert!(threads || jumps.count() == 0, "{pattern:?}");
        }
    }

    #[test]
    fn flaws_name_their_key() {
        assert_eq!(flaw(&print(PrintPattern::Dots, 0.4)), None);
        let none = Print { colours: Vec::new(), ..print(PrintPattern::Dots, 0.4) };
        assert!(flaw(&none).unwrap().contains("colours"));
        let long = Print { repeat_mm: [f32::NAN, 3.0], ..print(PrintPattern::Dots, 0.4) };
        assert!(flaw(&long).unwrap().contains("repeat_mm"));
        assert!(flaw(&print(PrintPattern::Picture, 0.4)).unwrap().contains("picture"));
        assert!(flaw(&print(PrintPattern::Dots, 1.4)).unwrap().contains("share"));
    }
}
