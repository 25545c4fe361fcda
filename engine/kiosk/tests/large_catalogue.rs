//! A catalogue of two hundred garments with patterns, textures and photographs, and a visitor who opens thirty of them: time and memory.
//!
//! `cargo test --release -p toile-kiosk --features window --test process large_catalogue -- --nocapture` prints the figures.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use toile_assets::catalogue::package;
use toile_fitting::dress::measured::ShopperFacts;
use toile_fitting::dress::session;
use toile_fitting::live::shopper_source::ShopperSource;
use toile_kiosk::service::config::Config;
use toile_kiosk::service::stock::Stock;
use toile_kiosk::visitor::dressing_worker::{
    DressingContext, DressingJob, DressingWorker, JobResult, MeasuredVisitor, MeasuringJob,
};
use toile_kiosk::visitor::photographs::{PHOTOGRAPH_BYTES, Photographs};
use toile_kiosk::visitor::screen::{Action, Control, ControlStyle, Screen};
use toile_kiosk::visitor::setup::VisitorSetup;
use toile_kiosk::visitor::wardrobe::{Wardrobe, WornItem};
use toile_view::figure::Appearance;

use crate::{ALONE, coarse};

const GARMENTS: usize = 200;

/// Garments that the visitor puts on; they see the photographs of all that hang between.
const OPENED: usize = 30;

/// A folder of the test's own.
struct Scratch(PathBuf);

impl Drop for Scratch {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

/// Memory of the process that is resident (kB).
fn resident_kb() -> i64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse().unwrap()
}

/// A picture that does not compress to nothing.
fn png(side: [u32; 2], seed: u32) -> Vec<u8> {
    let [width, height] = side;
    let pixel = |i: u32| {
        let (x, y) = (i % width, i / width);
        let noise = (x * 31 + y * 17 + seed * 101).wrapping_mul(2_654_435_761) >> 27;
        [(x * 255 / width) as u8, (y * 255 / height) as u8, (noise * 6) as u8]
    };
    let pixels: Vec<u8> = (0..width * height).flat_map(pixel).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    bytes
}

/// A shop of so many garments, each with a pattern in its sizes, a fabric with a printed picture and a photograph of its own.
fn shop(folder: &Path) {
    let source = folder.join("source");
    fs::create_dir_all(&source).unwrap();
    // Coarse, so that thirty of them are soon on.
    let patterns = ["tee", "strap-dress"].map(|name| coarse::package(name).text());
    // Each package holds its own; eight that differ are soon encoded.
    let pictures = [0, 1, 2, 3, 4, 5, 6, 7].map(|seed| [png([256, 256], seed), png([900, 1_200], seed)]);
    let fabric = "name = \"ours\"\ntitle = \"Ours\"\nbase = \"cotton-lawn\"\ncolour = [0.9, 0.9, 0.85]\n[print]\n\
                  pattern = \"picture\"\ncolours = []\nrepeat_mm = [120, 120]\nshare = 1.0\npicture = \"tile.png\"\n";
    fs::write(source.join("ours.toml"), fabric).unwrap();
    for i in 0..GARMENTS {
        let manifest = format!(
            "article = \"N-{i}\"\ngarment = \"pattern.json\"\nname = {{ en = \"Number {i}\" }}\nprice = \"{i}.50 EUR\"\n\
             fabric = \"ours.toml\"\nphotographs = [\"front.png\"]\n"
        );
        fs::write(source.join("garment.toml"), manifest).unwrap();
        fs::write(source.join("pattern.json"), &patterns[i % patterns.len()]).unwrap();
        let [tile, front] = &pictures[i % pictures.len()];
        fs::write(source.join("tile.png"), tile).unwrap();
        fs::write(source.join("front.png"), front).unwrap();
        fs::write(folder.join(format!("{i:03}.toile")), package::pack(&source).unwrap().0).unwrap();
    }
    fs::write(folder.join("catalogue.toml"), "shop = \"Department store\"\n").unwrap();
}

/// The page of the garments around one.
fn page(first: &Screen, around: usize) -> Screen {
    let tile = |place: usize| Control {
        action: Action::Garment(place),
        label: String::new(),
        detail: None,
        is_detail_spare: false,
        style: ControlStyle::Tile([0.5; 3]),
        chosen: false,
        picture: None,
    };
    let begin = around / 6 * 6;
    Screen { controls: (begin..(begin + 6).min(GARMENTS)).map(tile).collect(), ..first.clone() }
}

/// Shows a page until all of its photographs are there; gives how many are.
fn look_at(photographs: &mut Photographs, screen: &mut Screen, wardrobe: &Wardrobe) -> usize {
    let begun = Instant::now();
    loop {
        assert_eq!(photographs.show(screen, wardrobe), None);
        let there = screen.controls.iter().filter(|control| control.picture.is_some()).count();
        if there == screen.controls.len() {
            return there;
        }
        assert!(begun.elapsed() < Duration::from_secs(120), "{there} photographs");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn done(worker: &mut DressingWorker, job: DressingJob) -> JobResult {
    worker.begin(1, job).unwrap();
    loop {
        match worker.poll().unwrap() {
            Some((_, done)) => return done,
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    }
}

#[test]
fn thirty_of_two_hundred_garments_are_opened_in_a_fixed_memory() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let scratch = Scratch(std::env::temp_dir().join(format!("toile-large-{}", std::process::id())));
    shop(&scratch.0);
    let on_disk: u64 = fs::read_dir(&scratch.0).unwrap().flatten().map(|e| e.metadata().unwrap().len()).sum();
    let mut config = Config::default();
    (config.wear.catalogue, config.wear.quality) = (Some(scratch.0.clone()), "draft".into());

    let (before, begun) = (resident_kb(), Instant::now());
    let stock = Stock::read(&config).unwrap();
    let manifests = begun.elapsed();
    let wardrobe = Arc::new(Wardrobe::of(&stock, None, &mut Vec::new()).unwrap());
    let (hung, hung_kb) = (begun.elapsed(), resident_kb() - before);
    assert_eq!(wardrobe.items.len(), GARMENTS);
    println!(
        "{GARMENTS} garments of {} MB: manifests in {manifests:.0?}, hung in {hung:.0?}, {hung_kb} kB",
        on_disk >> 20
    );

    let first = VisitorSetup::new(&config, &stock, 0).unwrap().first();
    let quality = config.request().quality;
    let context = DressingContext::new(
        wardrobe.clone(),
        stock.first.clone(),
        quality,
        ShopperFacts::default(),
        Appearance::default(),
    );
    let mut worker = DressingWorker::new(context);
    let recording = session::open(None, None).unwrap();
    let pose = session::standing(&recording).unwrap()[0];
    let source = ShopperSource::Joints(recording.joints.clone());
    let measuring = MeasuringJob { source, seated: false, until_ns: 0 };
    let JobResult::Measured(known) = done(&mut worker, DressingJob::Measure(measuring)) else { panic!("not measured") };
    let client = Box::new(MeasuredVisitor { known: *known, pose });

    let mut photographs = Photographs::default();
    let (mut grown, mut longest, mut seen) = ([0; 3], Duration::ZERO, 0);
    let start = resident_kb();
    for i in 0..OPENED {
        let place = i * GARMENTS / OPENED;
        let begun = Instant::now();
        seen += look_at(&mut photographs, &mut page(&first, place), &wardrobe);
        longest = longest.max(begun.elapsed());
        assert!(photographs.bytes() <= PHOTOGRAPH_BYTES);
        // About her own: 38.
        let size = wardrobe.items[place].sizes.len() / 4;
        let outfit = [WornItem { item: place, size, colour: 0 }].into_iter().collect();
        let dressed = done(&mut worker, DressingJob::Dress(client.clone(), outfit));
        assert!(matches!(dressed, JobResult::Dressed(_)), "{}", wardrobe.items[place].name);
        if (i + 1) % 10 == 0 {
            grown[i / 10] = resident_kb() - start;
        }
    }
    println!(
        "{OPENED} opened, {seen} photographs seen: resident memory grew by {grown:?} kB after 10, 20 and 30; a page of six \
         photographs took {longest:.0?} at most"
    );
    assert!(grown[2] - grown[1] < 12_000, "memory goes on growing: {grown:?} kB");
    assert!(grown[2] < 160_000, "{grown:?} kB");
}
