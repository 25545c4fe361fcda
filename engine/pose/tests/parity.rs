//! The network against LiteRT's results for the same pictures (`data/reference.py` wrote them), and its time.
//!
//! The network's files are no part of the repository: where they are not fetched, these tests say so and do not run.

use std::path::Path;
use std::time::Instant;

use toile_base::numeric::random::SplitMix64;
use toile_base::numeric::statistics::median_of;
use toile_pose::files::PoseFile;
use toile_pose::network::Network;

use crate::common::{network_folder, references};

const REFERENCE: &[u8] = include_bytes!("data/reference.bin");

/// Most that a number may differ from the reference's: shares of the picture's side, odds, metres.
const TOLERANCE: f32 = 1e-4;

const LANDMARKS: [&[usize]; 3] = [&[1, 195], &[1, 1], &[1, 117]];
const BOXES: [&[usize]; 2] = [&[1, 2254, 12], &[1, 2254, 1]];

/// Pictures of the reference: a person from the front and from the side, grey, noise; numbers of 0 to 1.
fn pictures(side: usize, people: [&[u8]; 2]) -> [Vec<f32>; 4] {
    let mut random = SplitMix64::new(1);
    let count = side * side * 3;
    let [front, back] = people.map(|png| {
        let person = image::load_from_memory(png).unwrap().to_rgb8();
        assert_eq!((person.width() as usize, person.height() as usize), (side, side));
        person.into_raw().into_iter().map(|b| f32::from(b) / 255.0).collect()
    });
    [front, back, vec![0.5; count], (0..count).map(|_| random.uniform()).collect()]
}

const NAMES: [&str; 4] = ["front", "side", "grey", "noise"];

struct Reference(Vec<f32>);

impl Reference {
    /// By the plain kernels, and by XNNPACK.
    fn both() -> (Self, Self) {
        let all: Vec<f32> = REFERENCE.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
        let (plain, xnnpack) = all.split_at(all.len() / 2);
        (Self(plain.to_vec()), Self(xnnpack.to_vec()))
    }

    fn take(&mut self, count: usize) -> Vec<f32> {
        self.0.drain(..count).collect()
    }
}

fn farthest(ours: &[f32], theirs: &[f32]) -> f32 {
    ours.iter().zip(theirs).map(|(a, b)| (a - b).abs()).fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}

fn timed(network: &mut Network) -> f32 {
    let times = (0..15).map(|_| {
        let begun = Instant::now();
        network.run();
        begun.elapsed().as_secs_f32() * 1e3
    });
    median_of(times).unwrap()
}

/// How far ours lies from the reference's plain kernels, and those of XNNPACK from them.
struct Distances {
    ours: f32,
    theirs: f32,
}

/// The network, its pictures, and what it gives of each in units in which one number is as good as the other.
struct Case<'a> {
    file: PoseFile,
    wanted: &'a [&'a [usize]],
    pictures: [Vec<f32>; 4],
    units: &'a dyn Fn(usize, f32) -> f32,
    /// Every so many numbers of an output were kept.
    every: usize,
}

fn compare(case: &Case<'_>, folder: &Path, plain: &mut Reference, xnnpack: &mut Reference) {
    let mut network = Network::load(&case.file.read(folder).unwrap(), case.wanted).unwrap();
    for (name, picture) in NAMES.iter().zip(&case.pictures) {
        network.input().copy_from_slice(picture);
        network.run();
        let mut most = Distances { ours: 0.0, theirs: 0.0 };
        for (i, shape) in case.wanted.iter().enumerate() {
            let each = if case.every == 1 { 1 } else { shape[2] };
            let kept = network.output(i).chunks_exact(each).step_by(case.every).flatten();
            let ours: Vec<f32> = kept.map(|x| (case.units)(i, *x)).collect();
            let of = |reference: &mut Reference| -> Vec<f32> {
                reference.take(ours.len()).iter().map(|x| (case.units)(i, *x)).collect()
            };
            let (plain, xnnpack) = (of(plain), of(xnnpack));
            most.ours = most.ours.max(farthest(&ours, &plain));
            most.theirs = most.theirs.max(farthest(&xnnpack, &plain));
        }
        println!("{} {name:<6} {:.1e}, XNNPACK {:.1e}", case.file, most.ours, most.theirs);
        // Noise is no picture of anything: rounding alone moves what the network says of it, in the reference as well.
        let tolerance = if *name == "noise" { most.theirs.max(TOLERANCE) } else { TOLERANCE };
        assert!(most.ours <= tolerance, "{} {name}: {:e}", case.file, most.ours);
    }
    let (ms, work) = (timed(&mut network), network.multiplications() as f64 * 1e-6);
    println!("{}: {work:.1} M multiply-adds in {ms:.2} ms, {} kB", case.file, network.bytes() / 1_000);
}

#[test]
fn landmarks_and_boxes_are_those_of_the_reference_runtime() {
    let Some(folder) = network_folder() else { return };
    let (mut plain, mut xnnpack) = Reference::both();
    let large: [&[u8]; 2] = [include_bytes!("data/front_256.png"), include_bytes!("data/side_256.png")];
    let small: [&[u8]; 2] = [include_bytes!("data/front_224.png"), include_bytes!("data/side_224.png")];
    for file in [PoseFile::Lite, PoseFile::Full] {
        // Shares of the picture's side, and metres.
        let units = |output, x: f32| if output == 0 { x / 256.0 } else { x };
        let case = Case { file, wanted: &LANDMARKS, pictures: pictures(256, large), units: &units, every: 1 };
        compare(&case, &folder, &mut plain, &mut xnnpack);
    }
    let pictures = pictures(224, small).map(|picture| picture.iter().map(|x| x * 2.0 - 1.0).collect());
    // A score counts after the logistic function.
    let units = |output, x: f32| if output == 1 { 1.0 / (1.0 + (-x).exp()) } else { x / 224.0 };
    let case = Case { file: PoseFile::Detector, wanted: &BOXES, pictures, units: &units, every: 8 };
    compare(&case, &folder, &mut plain, &mut xnnpack);
    assert!(plain.0.is_empty() && xnnpack.0.is_empty());
}

#[test]
fn the_fast_network_equals_its_scalar_reference() {
    let Some(folder) = network_folder() else { return };
    let wanted: [(PoseFile, &[&[usize]]); 2] = [(PoseFile::Lite, &LANDMARKS), (PoseFile::Detector, &BOXES)];
    for (file, wanted) in wanted {
        let mut network = Network::load(&file.read(&folder).unwrap(), wanted).unwrap();
        assert!(references::agree(&mut network, wanted.len()), "{file}");
    }
}

#[test]
fn a_network_that_is_cut_or_garbled_is_refused_or_runs() {
    let Some(folder) = network_folder() else { return };
    let bytes = PoseFile::Lite.read(&folder).unwrap();
    for len in (0..bytes.len()).step_by(100_003) {
        assert!(Network::load(&bytes[..len], &LANDMARKS).is_err(), "cut at {len}");
    }
    let mut random = SplitMix64::new(3);
    let mut refused = 0;
    for _ in 0..40 {
        let mut garbled = bytes.clone();
        // The tables lie at the end of the file, and the root's place in its first bytes.
        for _ in 0..20 {
            let at = garbled.len() - 1 - random.below(120_000);
            garbled[at] = random.next_u64() as u8;
        }
        refused += u32::from(Network::load(&garbled, &LANDMARKS).is_err());
    }
    println!("{refused} of 40 garbled files were refused");
    assert!(refused > 0);
}
