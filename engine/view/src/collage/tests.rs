use toile_assets::catalogue::{CollageGarment, CollagePictures, Picture};
use toile_base::body::{Body, Measures, Sex};

use super::*;
use crate::figure::Appearance;
use crate::image::Size;

const SIZE: Size = Size::new(240, 400);

fn woman() -> Body {
    toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap()
}

/// A cloth of one colour on a picture of 200 x 200 whose middle half is covered; points 100 px apart at a quarter of the height.
fn cloth(colour: [u8; 3], distance: f32) -> CollagePictures {
    let pixel = |i: usize| {
        let (x, y) = (i % 200, i / 200);
        let inside = (50..150).contains(&x) && (50..150).contains(&y);
        if inside { [colour[0], colour[1], colour[2], 255] } else { [0; 4] }
    };
    let picture = Picture { width: 200, height: 200, pixels: (0..40_000).map(pixel).collect() };
    CollagePictures { picture, arms: Vec::new(), points: [[50.0, 50.0], [150.0, 50.0]], distance }
}

fn garment(name: &str, layer: &str, level: &str, more: &str) -> CollageGarment {
    let text = format!(
        "name = \"{name}\"\nlayer = \"{layer}\"\nlevel = \"{level}\"\n{more}\n[front]\npicture = \"f.png\"\npoints = [[50, 50], [150, 50]]\n\
         distance_mm = 300\n"
    );
    CollageGarment::parse(&text).unwrap()
}

#[test]
fn a_garment_hangs_at_its_level_as_large_as_it_is() {
    let body = woman();
    let layers = BodyLayers::new(&body, Appearance::default(), CollageSide::Front, SIZE);
    let skirt = garment("skirt", "scarves", "waist", "");
    let pictures = [Some(cloth([0, 0, 255], 0.3)), None, None];
    let worn = [WornPhotographs { garment: &skirt, pictures: &pictures }];
    let image = collage(&body, &layers, CollageSide::Front, &worn).unwrap();
    let blue: Vec<(u32, u32)> = (0..SIZE.width * SIZE.height)
        .map(|i| (i % SIZE.width, i / SIZE.width))
        .filter(|(x, y)| image.pixel(*x, *y).is_some_and(|[r, _, b]| b > 200 && r < 60))
        .collect();
    let (left, right) = blue.iter().fold((u32::MAX, 0), |(l, r), p| (l.min(p.0), r.max(p.0)));
    let top = blue.iter().map(|p| p.1).min().unwrap();
    let wide = (right - left + 1) as f32 / layers.per_metre;
    assert!((wide - 0.3).abs() < 0.012, "{wide} m wide");
    assert!((top as f32 - layers.row(body.levels.waist)).abs() < 1.6, "{top}");
}

#[test]
fn rows_are_stretched_to_the_body_within_limits_and_beyond_them_nothing_is_worn() {
    let body = woman();
    let layers = BodyLayers::new(&body, Appearance::default(), CollageSide::Front, SIZE);
    let row = layers.row(body.levels.waist - 0.03);
    let [left, right] = layers.trunk[row as usize].unwrap();
    // A little narrower than the body there.
    let distance = 0.93 * (right - left) / layers.per_metre;
    let pictures = [Some(cloth([0, 0, 255], distance)), None, None];
    let wide = |layer: &str, more: &str| {
        let g = garment("top", layer, "waist", more);
        let worn = [WornPhotographs { garment: &g, pictures: &pictures }];
        collage(&body, &layers, CollageSide::Front, &worn).map(|image| {
            (0..SIZE.width).filter(|x| image.pixel(*x, row as u32).is_some_and(|[r, _, b]| b > 150 && r < 110)).count()
                as f32
        })
    };
    let (own, stretched) = (wide("belts", "").unwrap(), wide("shirts", "").unwrap());
    assert!((own - 0.93 * (right - left)).abs() < 2.5, "{own} of {}", right - left);
    assert!(stretched >= right - left, "{stretched} of {}", right - left);
    let refused = wide("shirts", "stretches = { waist = [400, 500] }").unwrap_err();
    assert!(refused.to_string().contains("its waist is for girths of 400 to 500 mm"), "{refused}");
}

#[test]
fn outer_layers_cover_inner_ones_arms_cover_both_and_sleeves_the_arms() {
    let body = woman();
    let layers = BodyLayers::new(&body, Appearance::default(), CollageSide::Side, SIZE);
    let of = |colour: [u8; 3], arms: u8| {
        let mut pictures = cloth(colour, 0.4);
        pictures.arms = vec![arms; 40_000];
        [None, Some(pictures), None]
    };
    let (shirt, coat) = (garment("shirt", "shirts", "bust", ""), garment("coat", "coats", "bust", ""));
    let (red, blue, sleeve) = (of([255, 0, 0], 0), of([0, 0, 255], 0), of([0, 255, 0], 255));
    let worn = |list: &[(&CollageGarment, &[Option<CollagePictures>; 3])]| {
        let worn: Vec<WornPhotographs> =
            list.iter().map(|(garment, pictures)| WornPhotographs { garment, pictures }).collect();
        collage(&body, &layers, CollageSide::Side, &worn).unwrap()
    };
    let arm = layers.arms.iter().position(|a| *a > 0.99).expect("an arm is before the trunk") as u32;
    let row = layers.row(body.levels.chest - 0.10) as u32;
    let bare = (0..SIZE.width)
        .find(|x| {
            layers.arms[(row * SIZE.width + x) as usize] == 0.0
                && layers.trunk[row as usize].is_some_and(|[l, r]| (l + 2.0..r - 2.0).contains(&(*x as f32)))
        })
        .expect("some of the trunk is not behind the arm");
    // The coat lies outside whatever the order in which they are given.
    for list in [[(&shirt, &red), (&coat, &blue)], [(&coat, &blue), (&shirt, &red)]] {
        let image = worn(&list);
        assert_eq!(image.pixel(bare, row), Some([0, 0, 255]));
        assert_eq!(
            image.pixel(arm % SIZE.width, arm / SIZE.width),
            layers.picture.pixel(arm % SIZE.width, arm / SIZE.width)
        );
    }
    let on_arm =
        (0..SIZE.width).find(|x| layers.arms[(row * SIZE.width + x) as usize] > 0.99).expect("the arm hangs there");
    assert_eq!(worn(&[(&shirt, &sleeve)]).pixel(on_arm, row), Some([0, 255, 0]));
    let nothing = [None, None, None];
    let none = WornPhotographs { garment: &shirt, pictures: &nothing };
    let refused = collage(&body, &layers, CollageSide::Side, &[none]).unwrap_err();
    assert_eq!(refused, CollageError::Unseen(CollageSide::Side));
}

#[test]
fn two_passes_keep_means_and_places() {
    // A ramp across, scaled to half its rows and to three parts of its columns.
    let pixels = (0..40 * 60).map(|i| [(i % 40) as f32 / 40.0, 0.5, 0.0, 1.0]).collect();
    let layer = Layer { width: 40, height: 60, pixels };
    let span = RowSpan { middle: 25.0, scale: 0.5, stretch: [1.5; 2], edges: [20.0; 2] };
    let spans = vec![span; 50];
    let out = scaled(&layer, [50, 50], (5.0, 0.5), 20.0, &spans);
    let at = |x: usize, y: usize| out.pixels[y * 50 + x];
    assert_eq!(at(25, 2)[3], 0.0);
    assert!((at(25, 20)[3] - 1.0).abs() < 1e-5 && at(8, 20)[3] == 0.0 && at(42, 20)[3] == 0.0);
    for x in 12..38 {
        let expected = ((x as f32 + 0.5 - 10.0) / 0.75 - 0.5) / 40.0;
        assert!((at(x, 20)[0] - expected).abs() < 0.01, "{x}: {} {expected}", at(x, 20)[0]);
    }
}

#[test]
fn what_lies_beyond_the_outline_goes_along_and_keeps_its_size() {
    // A trunk of 20 pixels with a sleeve of 10 on either side, stretched by a half: the sleeves lie 5 farther out, 10 wide.
    let pixels = (0..60 * 4)
        .map(|i| [f32::from((20..40).contains(&(i % 60))), 0.0, 0.0, f32::from((10..50).contains(&(i % 60)))]);
    let layer = Layer { width: 60, height: 4, pixels: pixels.collect() };
    let span = RowSpan { middle: 40.0, scale: 1.0, stretch: [1.5, 1.0], edges: [10.0; 2] };
    let out = scaled(&layer, [80, 4], (0.0, 1.0), 30.0, &[span; 4]);
    let row = &out.pixels[2 * 80..3 * 80];
    let covered: Vec<usize> = (0..80).filter(|x| row[*x][3] > 0.5).collect();
    let trunk: Vec<usize> = (0..80).filter(|x| row[*x][0] > 0.5).collect();
    assert_eq!((covered[0], covered[covered.len() - 1]), (15, 59));
    assert_eq!((trunk[0], trunk[trunk.len() - 1]), (25, 49));
}

#[test]
fn what_reaches_a_little_out_of_an_outer_garment_is_pressed_in_and_what_hangs_out_stays() {
    let body = woman();
    let layers = BodyLayers::new(&body, Appearance::default(), CollageSide::Front, SIZE);
    let (shirt, coat) = (garment("shirt", "shirts", "waist", ""), garment("coat", "coats", "waist", ""));
    let reds = |distance: f32| {
        let [red, blue] = [([255, 0, 0], distance), ([0, 0, 255], 0.36)].map(|(c, d)| [Some(cloth(c, d)), None, None]);
        let worn =
            [WornPhotographs { garment: &shirt, pictures: &red }, WornPhotographs { garment: &coat, pictures: &blue }];
        let image = collage(&body, &layers, CollageSide::Front, &worn).unwrap();
        let row = layers.row(body.levels.waist - 0.03) as u32;
        (0..SIZE.width).filter(|x| image.pixel(*x, row).is_some_and(|[r, _, b]| r > 200 && b < 60)).count()
    };
    assert_eq!(reds(0.44), 0);
    let hangs = (0.76 - 0.36) * layers.per_metre;
    assert!((reds(0.76) as f32 - hangs).abs() < 6.0, "{} of {hangs}", reds(0.76));
}
