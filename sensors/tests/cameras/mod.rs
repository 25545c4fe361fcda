//! Cameras without a device: what each library plays in a camera's place gives the same images, to the bit, as the file does.
//!
//! A library that is not installed is named, and its test does not run; those of Debian must be there in continuous integration.

mod azure_lens;
mod oni_writer;
mod orbbec_recorder;
mod people;
mod realsense_recorder;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use std::{env, fs};

use glam::{Affine3A, Vec3};
use toile_base::frame::DepthFrame;
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::session::Session;
use toile_sensors::source::live::{self, Arrival, CameraFrame, CameraKind, CameraOptions, CameraRecorder, LiveDepth};
use toile_sensors::source::{OpenOptions, open};

/// Longest that a camera is waited for.
const LONGEST: Duration = Duration::from_secs(20);

/// Folders in which Debian's package freenect puts the library that plays a recording in place of a Kinect.
const FAKENECT: [&str; 2] = ["/usr/lib/x86_64-linux-gnu/fakenect", "/usr/lib/aarch64-linux-gnu/fakenect"];

/// The folders in which a kind's library is found; none, with a word, where it is not installed.
fn installed(kind: CameraKind, folders: Vec<PathBuf>, must: bool) -> Option<CameraOptions> {
    match kind.installed(&folders) {
        Ok(_) => Some(CameraOptions { libraries: folders, ..CameraOptions::default() }),
        Err(error) => {
            assert!(!must || env::var("CI").as_deref() != Ok("true"), "{error}");
            eprintln!("skipped, did not run: {error}");
            None
        }
    }
}

/// A folder of a test's own.
fn folder(name: &str) -> PathBuf {
    let folder = env::temp_dir().join(format!("toile-cameras-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Live images of a camera, placed in our world: so many.
fn seen_live(name: &str, options: &CameraOptions, count: usize) -> Vec<DepthFrame> {
    let (name, options) = (name.parse().unwrap(), options.clone());
    let begun = Instant::now();
    let now = move || begun.elapsed().as_nanos() as u64;
    let mut depth =
        LiveDepth::open(Box::new(move || live::open(&name, &options)), 0, 0).unwrap_or_else(|e| panic!("{e}"));
    let mut frames: Vec<DepthFrame> = Vec::new();
    while frames.len() < count && begun.elapsed() < LONGEST {
        let update = depth.poll(&now, Duration::from_millis(50));
        frames.extend(update.frame.map(|frame| (*frame).clone()));
    }
    println!("{}: {} images, {:?}", depth.info().device, frames.len(), depth.counts());
    println!("{}", depth.notes().join("\n"));
    assert!(frames.len() >= count, "only {} images came", frames.len());
    assert!(frames.windows(2).all(|w| w[0].time_ns < w[1].time_ns));
    frames
}

/// A session as `toile record --camera` makes it, of so many images.
fn recorded(name: &str, options: &CameraOptions, count: usize) -> Session {
    let mut camera = live::open(&name.parse().unwrap(), options).unwrap_or_else(|e| panic!("{e}"));
    let mut recorder = CameraRecorder::new(camera.info()).unwrap();
    let (mut frame, begun) = (CameraFrame::default(), Instant::now());
    while recorder.frames() < count && begun.elapsed() < LONGEST {
        match camera.read(&mut frame, Duration::from_millis(50)).unwrap_or_else(|e| panic!("{e}")) {
            Arrival::Frame => {
                recorder.take(&frame, begun.elapsed().as_nanos() as u64).unwrap();
            }
            Arrival::Nothing => {}
            Arrival::Ended => break,
        }
    }
    recorder.finish("recorded").unwrap_or_else(|e| panic!("{e}"))
}

/// Every live image is one of the file's, in its order, at the same place in the world, to the bit.
fn assert_same(live: &[DepthFrame], file: &[DepthFrame]) {
    let mut from = 0;
    for (i, frame) in live.iter().enumerate() {
        let at = file[from..].iter().position(|f| f.depth_mm == frame.depth_mm);
        let at = from + at.unwrap_or_else(|| panic!("live image {i} is not one of the file's from {from} on"));
        let same = &file[at];
        assert_eq!((frame.intrinsics, frame.camera_to_world), (same.intrinsics, same.camera_to_world), "image {i}");
        from = at + 1;
    }
}

fn both_ways(name: &str, path: &Path, options: &CameraOptions, count: usize) {
    let file = open(path, &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_same(&seen_live(name, options, count), &file.depth);
    // What is recorded next may begin later in the recording, by whose first images the camera would be placed otherwise.
    let mut recorded = recorded(name, options, count).depth;
    recorded.iter_mut().for_each(|frame| frame.camera_to_world = file.depth[0].camera_to_world);
    assert_same(&recorded, &file.depth);
}

#[test]
fn a_kinect_gives_what_its_recording_holds() {
    const MARK: &str = "TOILE_FAKENECT_CHILD";
    let folders = FAKENECT.map(PathBuf::from).to_vec();
    let Some(options) = installed(CameraKind::Kinect, folders, true) else { return };
    if let Some(recording) = env::var_os(MARK) {
        let options = CameraOptions { colour: true, ..options };
        return both_ways("kinect", Path::new(&recording), &options, 8);
    }
    // The library takes its recording from the environment of its process.
    let recording = folder("fakenect");
    people::write_fakenect(&recording, 40);
    let test = "cameras::a_kinect_gives_what_its_recording_holds";
    let mut child = Command::new(env::current_exe().unwrap());
    child.args(["--exact", test, "--nocapture"]).env("FAKENECT_PATH", &recording).env(MARK, &recording);
    let output = child.output().unwrap();
    fs::remove_dir_all(&recording).unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    println!("{printed}{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && printed.contains("1 passed"), "the test fails in its own process");
}

#[test]
fn a_camera_of_openni_gives_what_its_recording_holds() {
    let Some(options) = installed(CameraKind::OpenNi, live::folders(), true) else { return };
    let folder = folder("openni");
    let file = folder.join("session.oni");
    oni_writer::write(&file, &people::frames(12));
    let name = format!("openni:{}", file.display());
    both_ways(&name, &file, &options, 8);
    // The driver of files says nothing of a colour lens: the mannequin is shown.
    let camera = live::open(&name.parse().unwrap(), &CameraOptions { colour: true, ..options }).unwrap();
    assert_eq!(camera.info().colour_camera(Affine3A::IDENTITY), None);
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_recording_of_an_azure_kinect_is_the_same_live() {
    let Some(options) = installed(CameraKind::K4a, live::folders(), false) else { return };
    let Some(data) = env::var_os("TOILE_DATA") else {
        return eprintln!("skipped: TOILE_DATA does not name the recordings");
    };
    let file = PathBuf::from(data).join("depth/pyk4a-azure-mkv/recording.mkv");
    let options = CameraOptions { colour: true, ..options };
    both_ways(&format!("k4a:{}", file.display()), &file, &options, 1);
    azure_lens::assert_like_the_library(&options, &file, &file.with_file_name("calibration.json"));
}

#[test]
fn a_real_sense_gives_what_it_was_made_to_see() {
    let Some(options) = installed(CameraKind::RealSense, live::folders(), false) else { return };
    let folder = folder("realsense");
    let (file, frames) = (folder.join("session.db3"), people::frames(12));
    if realsense_recorder::record(&options.libraries, &file, &frames) {
        let name = format!("realsense:{}", file.display());
        let live = seen_live(&name, &options, 6);
        let written = people::placed(&frames);
        assert_same(&live, &written);
        let options = CameraOptions { colour: true, ..options };
        assert_colour_beside(&name, &options);
    }
    fs::remove_dir_all(&folder).unwrap();
}

/// The colour camera of the recording is where it was put, and its pictures come with the depth of their moment.
fn assert_colour_beside(name: &str, options: &CameraOptions) {
    let mut camera = live::open(&name.parse().unwrap(), options).unwrap_or_else(|e| panic!("{e}"));
    let colour = camera.info().colour_camera(Affine3A::IDENTITY).expect("its lens and place are recorded");
    let real = realsense_recorder::colour_camera();
    for point in [Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.7, -0.4, 2.5), Vec3::new(-0.5, 0.5, 1.2)] {
        let at = |c: &ColourCamera| c.project(c.camera_to_world.inverse().transform_point3(point)).unwrap();
        assert!(at(&colour).distance(at(&real)) < 0.01, "{point}: {} and not {}", at(&colour), at(&real));
    }
    let (mut frame, begun, mut pictures) = (CameraFrame::default(), Instant::now(), 0);
    while pictures < 4 && begun.elapsed() < LONGEST {
        match camera.read(&mut frame, Duration::from_millis(50)).unwrap_or_else(|e| panic!("{e}")) {
            Arrival::Frame if frame.colour.width > 0 => {
                assert_eq!(
                    realsense_recorder::number_of(&frame.colour),
                    realsense_recorder::number_at(frame.device_ns)
                );
                pictures += 1;
            }
            Arrival::Ended => break,
            _ => {}
        }
    }
    assert!(pictures >= 4, "{pictures} pictures came with their depth");
}

#[test]
fn a_camera_of_orbbec_gives_what_it_was_made_to_see() {
    let Some(options) = installed(CameraKind::Orbbec, live::folders(), false) else { return };
    let error = live::open(&"orbbec".parse().unwrap(), &options).err().expect("no camera is connected here");
    assert!(error.to_string().contains("no camera of OrbbecSDK is connected"), "{error}");
    orbbec_recorder::say_what_is_missing();
}

#[test]
fn a_camera_that_is_not_connected_is_named() {
    for kind in [CameraKind::K4a, CameraKind::RealSense, CameraKind::OpenNi, CameraKind::Kinect] {
        let Some(options) = installed(kind, live::folders(), false) else { continue };
        let Err(error) = live::open(&kind.name().parse().unwrap(), &options) else { continue };
        println!("{error}");
        assert!(error.to_string().contains(" is connected; "), "{error}");
        assert!(!error.is_input());
    }
}

#[test]
fn a_recording_plays_as_a_camera_where_it_stands() {
    let folder = folder("recording");
    let file = folder.join("session.mcap");
    let session = Session { depth: people::placed(&people::frames(6)), raw_scale_known: true, ..Session::default() };
    toile_sensors::session::write(&file, &session).unwrap();
    let live = seen_live(&format!("recording:{}", file.display()), &CameraOptions::default(), 6);
    fs::remove_dir_all(&folder).unwrap();
    assert_same(&live, &session.depth);
}
