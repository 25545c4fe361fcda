//! The shop's logo, drawn from strokes: a needle that sews a wave, and three letters.

/// Pixels.
const SIZE: [u32; 2] = [520, 180];

/// Places within a pixel that are looked at, along each side.
const SAMPLES: u32 = 4;

/// The words' colour and the thread's, sRGB.
const INK: [u8; 3] = [33, 41, 48];
const THREAD: [u8; 3] = [148, 51, 43];

/// Strokes of the letters H, E, M, in a square of 1.
const LETTERS: [&[[f32; 4]]; 3] = [
    &[[0.0, 0.0, 0.0, 1.0], [0.62, 0.0, 0.62, 1.0], [0.0, 0.5, 0.62, 0.5]],
    &[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.56, 0.0], [0.0, 0.5, 0.48, 0.5], [0.0, 1.0, 0.56, 1.0]],
    &[[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.42, 0.7], [0.42, 0.7, 0.84, 0.0], [0.84, 0.0, 0.84, 1.0]],
];

/// The thread from the needle's eye to the first stitch.
const HANGS: [[f32; 2]; 6] =
    [[104.0, 38.0], [126.0, 43.0], [142.0, 56.0], [150.0, 78.0], [152.0, 110.0], [152.0, 144.0]];

/// Distance of a point from a stroke.
fn stroke([x, y]: [f32; 2], [ax, ay, bx, by]: [f32; 4]) -> f32 {
    let (dx, dy) = (bx - ax, by - ay);
    let t = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (x - ax - t * dx).hypot(y - ay - t * dy)
}

/// The colour at a point (pixels); none where the logo is seen through.
fn at(point: [f32; 2]) -> Option<[u8; 3]> {
    let [x, y] = point;
    // The needle leans to the right, its eye at the upper end.
    let needle = stroke(point, [34.0, 158.0, 112.0, 24.0]);
    let along = ((158.0 - y) / 134.0).clamp(0.0, 1.0);
    let eye = stroke(point, [101.0, 43.0, 108.0, 31.0]);
    if eye > 2.2 && needle < 1.6 + 5.0 * along {
        return Some(INK);
    }
    // The thread comes through the eye, waves below the letters and ends in the hem.
    let wave = 152.0 + 9.0 * ((x - 60.0) * 0.046).sin();
    let hangs = HANGS.windows(2).map(|ends| stroke(point, [ends[0][0], ends[0][1], ends[1][0], ends[1][1]]));
    let sewn = (150.0..=500.0).contains(&x) && (y - wave).abs() < 3.0 && (x - 150.0) % 34.0 < 23.0;
    if sewn || hangs.fold(f32::INFINITY, f32::min) < 2.4 {
        return Some(THREAD);
    }
    let letter = LETTERS.iter().zip([196.0, 306.0, 408.0]).flat_map(|(strokes, left)| {
        strokes
            .iter()
            .map(move |[ax, ay, bx, by]| [left + 92.0 * ax, 26.0 + 92.0 * ay, left + 92.0 * bx, 26.0 + 92.0 * by])
    });
    letter.into_iter().any(|line| stroke(point, line) < 6.5).then_some(INK)
}

/// One pixel: the mean of its places, seen through where none of them has a colour.
fn pixel(x: u32, y: u32) -> [u8; 4] {
    let (mut sum, mut count) = ([0u32; 3], 0);
    for place in 0..SAMPLES * SAMPLES {
        let inside = |i: u32| (i as f32 + 0.5) / SAMPLES as f32;
        let point = [x as f32 + inside(place % SAMPLES), y as f32 + inside(place / SAMPLES)];
        if let Some(colour) = at(point) {
            count += 1;
            sum.iter_mut().zip(colour).for_each(|(sum, c)| *sum += u32::from(c));
        }
    }
    let [r, g, b] = sum.map(|sum| (sum / count.max(1)) as u8);
    [r, g, b, (count * 255 / (SAMPLES * SAMPLES)) as u8]
}

/// The logo as PNG.
pub fn png() -> Result<Vec<u8>, String> {
    let [width, height] = SIZE;
    let pixels: Vec<u8> = (0..width * height).flat_map(|i| pixel(i % width, i / width)).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
    writer.write_image_data(&pixels).map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(bytes)
}
