//! `toile live`: shows a camera's data, on the terminal and as pictures.

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use clap::value_parser;
use serde::Serialize;
use toile_assets::put_line;
use toile_base::body::Sex;
use toile_base::frame::DepthFrame;
use toile_cli::arguments::Printing;
use toile_cli::camera::{self, CameraUse, MountArgs};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Words};
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::sensor_thread::{FrameSource, SourceFrame};
use toile_fitting::live::camera_start::StartedCamera;
use toile_fitting::live::depth_camera::{CameraFeed, CameraFigures, CameraHandle};
use toile_fitting::live::report::Quantiles;
use toile_sensors::source::live::{CameraName, CameraState, ColourImage};
use toile_view::image::{Image, Size};

/// Longest look (s): a day.
const MOST_SECONDS: i64 = 86_400;

/// Time between two lines about the camera.
const EVERY: Duration = Duration::from_secs(1);

/// Depth that is drawn white and black (mm).
const SHOWN_MM: [f32; 2] = [500.0, 4_500.0];

/// Show what a live camera gives: size, rates, losses, latency, people.
///
/// Opens the camera through its own library, which is loaded while the program runs, follows the person before it, and says once a
/// second what came. Nothing is stored but the pictures that --out asks for.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: see ten seconds of the first Kinect, with a picture of its depth\n  toile live --camera kinect \
                        --seconds 10 --out look"
)]
pub struct LiveArgs {
    /// Camera: kinect, openni, k4a, realsense, orbbec or webcam, which one after a colon (kinect:SERIAL, webcam:/dev/video2), or a
    /// recording in its place (k4a:F.mkv, recording:F, webcam-file:DIR)
    #[arg(long, value_name = "C", value_parser = camera::name, default_value = "kinect")]
    pub camera: CameraName,
    /// Length of the look
    #[arg(long, value_name = "S", value_parser = value_parser!(u32).range(1..=MOST_SECONDS), default_value = "10")]
    pub seconds: u32,
    /// How it is mounted
    #[command(flatten)]
    pub mount: MountArgs,
    /// Folder for pictures of the last depth and colour; they show the people in view
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

/// Rates of what came (Hz).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LiveRates {
    /// Depth images.
    pub depth: f64,
    /// Colour images.
    pub colour: f64,
    /// Frames in which a person was followed.
    pub joints: f64,
}

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LiveReport {
    /// The camera's own name.
    pub device: String,
    /// Width and height of its images, those of depth straightened (px).
    pub size: [u32; 2],
    /// From the start until the camera was open (ms).
    pub opened_ms: f64,
    /// How it stood at the end.
    pub state: &'static str,
    /// Frames that came.
    pub frames: u64,
    /// Frames that did not come, or were of no use.
    pub dropped: u64,
    /// Of these: cut short, the same again, of a covered lens.
    pub unusable: [u64; 3],
    /// Jumps of its clock, and times that it was lost or opened anew.
    pub clock_jumps: u64,
    /// Times that it was lost, frozen or covered.
    pub lost: u64,
    /// Times that it was opened anew.
    pub reopened: u64,
    /// Rates of what came.
    pub rates_hz: LiveRates,
    /// From a frame's arrival until the body was fitted to it, while a person is followed (us).
    pub latency_us: Quantiles,
    /// The same where a person is found for the first time, or none is (us).
    pub finding_us: Quantiles,
    /// Most people who were seen at once.
    pub people: u32,
    /// What was assumed.
    pub notes: Vec<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// What was seen while it ran.
#[derive(Default)]
struct Looked {
    people: u32,
    depth: Option<DepthFrame>,
}

/// Runs `toile live`.
///
/// # Errors
/// A camera that cannot be opened, a folder that cannot be written, a closed stdout.
pub fn run(args: &LiveArgs) -> Result<(), AppError> {
    let out = args.out.as_deref().map(OutputFolder::prepare).transpose()?;
    let begun = Instant::now();
    let watched = camera::watch(
        &args.camera,
        &args.mount,
        CameraUse { colour: true, own_picture: false },
        Sex::Female,
        RealClock::default(),
    )?;
    let opened_ms = (begun.elapsed().as_secs_f64() * 1e4).round() / 10.0;
    let StartedCamera { device, size, mut feed, handle, .. } = watched;
    let gives = if args.camera.kind.is_colour() { "colour" } else { "depth" };
    let words = args.printing.words();
    words.print_line(&format!("{device}: {gives} of {} x {} pixels, open after {opened_ms:.0} ms", size[0], size[1]));
    let looked = look(&mut feed, &handle, Duration::from_secs(args.seconds.into()), words);
    let (figures, colour) = (handle.figures(), handle.colour());
    let meters = feed.end();
    let files = match out {
        Some(out) => draw(out, &looked, &colour)?,
        None => Vec::new(),
    };
    let seconds = f64::from(args.seconds);
    let counts = figures.counts;
    let unusable = [counts.half, counts.repeated, counts.empty];
    let rate = |n: u64| (n as f64 / seconds * 100.0).round() / 100.0;
    let report = LiveReport {
        device,
        size,
        opened_ms,
        state: figures.state.name(),
        frames: counts.frames,
        dropped: counts.missing + unusable.iter().sum::<u64>(),
        unusable,
        clock_jumps: counts.clock_jumps,
        lost: counts.lost,
        reopened: counts.reopened,
        rates_hz: LiveRates {
            depth: if args.camera.kind.is_colour() { 0.0 } else { rate(counts.frames) },
            colour: rate(figures.colours),
            joints: rate(figures.tracked[1]),
        },
        latency_us: Quantiles::of(&meters.followed),
        finding_us: Quantiles::of(&meters.found),
        people: looked.people,
        notes: handle.notes(),
        files,
    };
    if args.printing.json {
        return terminal::print_json(&Document::new("live", report));
    }
    terminal::print(&summary(&report))
}

/// Looks for so long, and says what comes.
fn look(feed: &mut CameraFeed, handle: &CameraHandle, length: Duration, words: Words) -> Looked {
    let (clock, begun) = (RealClock::default(), Instant::now());
    let (mut looked, mut last, mut next) = (Looked::default(), handle.figures(), EVERY);
    while begun.elapsed() < length {
        clock.sleep_until(clock.now_ns() + 4_000_000);
        if let Some(SourceFrame { joints, depth, others, .. }) = feed.read() {
            let present = toile_fitting::dress::session::is_present(&joints);
            looked.people = looked.people.max(u32::from(present) + u32::from(others.0));
            looked.depth = depth.map(|image| image.frame().clone()).or(looked.depth);
        }
        if begun.elapsed() >= next {
            let now = handle.figures();
            words.print_line(&line(&last, &now));
            (last, next) = (now, next + EVERY);
        }
        thread::yield_now();
    }
    looked
}

/// What came in the last second.
fn line(last: &CameraFigures, now: &CameraFigures) -> String {
    let (a, b) = (&last.counts, &now.counts);
    let bad = (b.half + b.repeated + b.empty) - (a.half + a.repeated + a.empty);
    let who = if now.tracked[1] > last.tracked[1] { "a person is followed" } else { "no person is followed" };
    let state = if now.state == CameraState::Seeing { String::new() } else { format!(", {}", now.state) };
    format!(
        "{} frames, {} colour, {} missing, {bad} unusable{state}; {who}",
        b.frames - a.frames,
        now.colours - last.colours,
        b.missing - a.missing
    )
}

/// Writes the last depth and the last colour.
fn draw(mut out: OutputFolder, looked: &Looked, colour: &ColourImage) -> Result<Vec<PathBuf>, AppError> {
    if let Some(frame) = &looked.depth {
        let [near, far] = SHOWN_MM;
        let shade = |mm: &u16| {
            let light = 1.0 - ((f32::from(*mm) - near) / (far - near)).clamp(0.0, 1.0);
            if *mm == 0 { [24, 24, 64] } else { [(40.0 + 215.0 * light) as u8; 3] }
        };
        let size = Size::new(frame.intrinsics.width, frame.intrinsics.height);
        let mut image = Image::filled(size, [0; 3]);
        image.pixels_mut().zip(&frame.depth_mm).for_each(|(to, mm)| *to = shade(mm));
        write_png(&mut out, "depth.png", &image)?;
    }
    if colour.width > 0 {
        let mut image = Image::filled(Size::new(colour.width, colour.height), [0; 3]);
        image.pixels_mut().zip(colour.rgb.as_chunks().0).for_each(|(to, rgb)| *to = *rgb);
        write_png(&mut out, "colour.png", &image)?;
    }
    Ok(out.commit()?)
}

/// The same for a person.
fn summary(report: &LiveReport) -> String {
    let mut text = String::new();
    let LiveRates { depth, colour, joints } = report.rates_hz;
    put_line!(text, "{}: {}, {} frames, {} dropped", report.device, report.state, report.frames, report.dropped);
    put_line!(text, "  depth {depth:.1} Hz, colour {colour:.1} Hz, joints {joints:.1} Hz");
    let (followed, found) = (report.latency_us, report.finding_us);
    put_line!(
        text,
        "  from a frame's arrival to the body: {:.1} ms (p50), {:.1} ms (p99) followed; {:.1} ms (longest) found",
        followed.p50 * 1e-3,
        followed.p99 * 1e-3,
        found.max * 1e-3
    );
    put_line!(
        text,
        "  people: {}; lost {} times, clock jumped {} times",
        report.people,
        report.lost,
        report.clock_jumps
    );
    report.notes.iter().for_each(|note| put_line!(text, "  {note}"));
    report.files.iter().for_each(|file| put_line!(text, "  {}", file.display()));
    text
}
