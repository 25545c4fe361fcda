//! The face mesh and the detector of faces against LiteRT's results for the same pictures (`data/reference.py` wrote them), and against their
//! scalar references.
//!
//! The network's file is no part of the repository: where it is not fetched, these tests say so and do not run.

use std::env;
use std::ops::Range;
use std::time::Instant;

use toile_base::numeric::random::SplitMix64;
use toile_pose::face_finder::{DETECTOR, MESH};
use toile_pose::files::{self, NetworkPackage, PoseFile};
use toile_pose::network::{Network, logistic};

use crate::common::references;

const REFERENCE: &[u8] = include_bytes!("data/face_reference.bin");
const FACES: [(&[u8], usize); 2] =
    [(include_bytes!("data/face_192.png"), 192), (include_bytes!("data/face_128.png"), 128)];

const POINTS: &[&[usize]] = &[&[1, 1, 1, 1_404], &[1, 1, 1, 1]];
const BOXES: &[&[usize]] = &[&[1, 896, 16], &[1, 896, 1]];

/// Most that a number may differ from the reference's: shares of the picture's side, odds.
const TOLERANCE: f32 = 1e-4;

/// The network's file; none, with a word, where it is not fetched. Where continuous integration names a folder, it must be there.
fn bytes() -> Option<Vec<u8>> {
    match NetworkPackage::Face.check(&files::folder()) {
        Ok(()) => PoseFile::Face.read(&files::folder()).ok(),
        Err(error) => {
            assert!(env::var_os(files::FOLDER_VARIABLE).is_none(), "{error}");
            eprintln!("skipped, did not run: {error}");
            None
        }
    }
}

/// A drawn face, grey, noise; numbers of 0 to 1.
fn pictures((png, side): (&[u8], usize)) -> [Vec<f32>; 3] {
    let mut random = SplitMix64::new(1);
    let face = image::load_from_memory(png).unwrap().to_rgb8();
    assert_eq!((face.width() as usize, face.height() as usize), (side, side));
    let count = side * side * 3;
    let face = face.into_raw().into_iter().map(|b| f32::from(b) / 255.0).collect();
    [face, vec![0.5; count], (0..count).map(|_| random.uniform()).collect()]
}

/// Numbers of the reference, taken one after the other.
struct Reference(Vec<f32>);

impl Reference {
    fn take(&mut self, count: usize) -> Vec<f32> {
        self.0.drain(..count).collect()
    }
}

fn farthest(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}

/// Holds a network to the reference. Of the detector every eighth box was kept.
fn compare(
    name: &str,
    (mut network, scale, every): (Network, [f32; 2], usize),
    pictures: &[Vec<f32>; 3],
    references: &mut [Reference; 2],
) {
    let side = network.input_shape().width as f32;
    for (picture, of) in pictures.iter().zip(["face", "grey", "noise"]) {
        let scaled = picture.iter().map(|x| scale[0] * x + scale[1]);
        network.input().iter_mut().zip(scaled).for_each(|(to, x)| *to = x);
        let begun = Instant::now();
        network.run();
        let ms = begun.elapsed().as_secs_f32() * 1e3;
        let mut off = [0.0_f32; 2];
        for output in 0..2 {
            let each = if every == 1 || output == 1 { 1 } else { 16 };
            let unit = |x: &f32| if output == 1 { logistic(*x) } else { x / side };
            let ours: Vec<f32> = network.output(output).chunks_exact(each).step_by(every).flatten().map(unit).collect();
            let [plain, xnnpack] =
                references.each_mut().map(|r| r.take(ours.len()).iter().map(unit).collect::<Vec<_>>());
            off = [off[0].max(farthest(&ours, &plain)), off[1].max(farthest(&xnnpack, &plain))];
        }
        println!("{name} {of:<5} {:.1e}, XNNPACK {:.1e}, {ms:.2} ms", off[0], off[1]);
        // Noise is no picture of anything: rounding alone moves what the network says of it, in the reference as well.
        let tolerance = if of == "noise" { off[1].max(TOLERANCE) } else { TOLERANCE };
        assert!(off[0] <= tolerance, "{name} {of}: {:e}", off[0]);
    }
    println!("{name}: {:.1} M multiply-adds, {} kB", network.multiplications() as f64 * 1e-6, network.bytes() / 1_000);
}

#[test]
fn points_and_boxes_are_those_of_the_reference_runtime() {
    let Some(file) = bytes() else { return };
    let all: Vec<f32> = REFERENCE.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    let (plain, xnnpack) = all.split_at(all.len() / 2);
    let mut references = [Reference(plain.to_vec()), Reference(xnnpack.to_vec())];
    let load = |range: Range<usize>, wanted: &[&[usize]]| Network::load(&file[range], wanted).unwrap();
    compare("mesh", (load(MESH, POINTS), [1.0, 0.0], 1), &pictures(FACES[0]), &mut references);
    compare("detector", (load(DETECTOR, BOXES), [2.0, -1.0], 8), &pictures(FACES[1]), &mut references);
    assert!(references.iter().all(|r| r.0.is_empty()));
}

#[test]
fn the_fast_networks_equal_their_scalar_references() {
    let Some(file) = bytes() else { return };
    for (name, range, wanted) in [("mesh", MESH, POINTS), ("detector", DETECTOR, BOXES)] {
        let mut network = Network::load(&file[range], wanted).unwrap();
        assert!(references::agree(&mut network, wanted.len()), "{name}");
        network.wipe();
        assert!(
            (0..wanted.len()).flat_map(|i| network.output(i)).all(|x| *x == 0.0)
                && network.input().iter().all(|x| *x == 0.0)
        );
    }
}
