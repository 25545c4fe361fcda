//! Videos: frames encoded through ffmpeg where it is installed, or written as an animated PNG where it is not.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};

use crate::image::{self, Animation, Image, Size};

/// Why a video could not be made.
#[derive(Debug, thiserror::Error)]
pub enum VideoError {
    /// The name's ending says nothing that can be made.
    #[error("{0} does not say what kind of video to make; end its name in .mp4, .webm or .png")]
    Kind(PathBuf),
    /// A video codec takes pairs of pixels.
    #[error("a video of {0} cannot be made, since codecs take even sides; choose even width and height, or .png")]
    Odd(Size),
    /// A file could not be written.
    #[error("{path} cannot be written ({source}); choose a place that is writable and has room")]
    Write {
        /// Path of the video.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// ffmpeg ended badly.
    #[error(
        "ffmpeg could not make {path} ({message}); install one with libx264 and libvpx-vp9, or end the name in .png"
    )]
    Ffmpeg {
        /// Path of the video.
        path: PathBuf,
        /// The last that it said.
        message: String,
    },
    /// A frame of another size, or an animated PNG that cannot be written.
    #[error(transparent)]
    Image(#[from] image::Error),
}

/// A video that is being made.
pub struct VideoWriter {
    path: PathBuf,
    size: Size,
    pushed: u32,
    encoder: VideoEncoder,
}

enum VideoEncoder {
    Ffmpeg { child: Child, input: Option<ChildStdin> },
    Png(Box<Animation<BufWriter<File>>>),
}

/// The program that makes videos.
const FFMPEG: &str = "ffmpeg";

/// Whether ffmpeg is installed.
pub fn has_ffmpeg() -> bool {
    let mut asked = Command::new(FFMPEG);
    let asked = asked.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    asked.status().is_ok_and(|s| s.success())
}

/// Options of the codec that the ending of a name asks for; none for an animated PNG.
fn codec(path: &Path) -> Result<Option<&'static [&'static str]>, VideoError> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
    match ending.as_str() {
        "mp4" => Ok(Some(&["-c:v", "libx264", "-preset", "medium", "-crf", "18", "-movflags", "+faststart"])),
        "webm" => Ok(Some(&["-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0", "-row-mt", "1"])),
        "png" | "apng" => Ok(None),
        _ => Err(VideoError::Kind(path.to_owned())),
    }
}

impl VideoWriter {
    /// Begins a video of so many frames, shown `fps` a second. The ending of the name says what is made: `.mp4` (H.264) or
    /// `.webm` (VP9) by ffmpeg, `.png` animated. Without ffmpeg a video becomes an animated PNG beside it; [`VideoWriter::path`]
    /// says which.
    ///
    /// # Errors
    /// [`VideoError`].
    pub fn begin(path: &Path, size: Size, frames: u32, fps: u16) -> Result<Self, VideoError> {
        Self::begin_with(path, size, frames, fps, has_ffmpeg())
    }

    /// Checks that the ending of a name says what kind of video to make, before there is anything to show.
    ///
    /// # Errors
    /// [`VideoError::Kind`].
    pub fn check(path: &Path) -> Result<(), VideoError> {
        codec(path).map(drop)
    }

    fn begin_with(path: &Path, size: Size, frames: u32, fps: u16, ffmpeg: bool) -> Result<Self, VideoError> {
        let codec = codec(path)?;
        match codec {
            Some(_) if size.width % 2 + size.height % 2 > 0 => Err(VideoError::Odd(size)),
            Some(codec) if ffmpeg => Self::video(path, size, fps, codec),
            _ => {
                Self::png(if codec.is_some() { path.with_extension("png") } else { path.to_owned() }, size, frames, fps)
            }
        }
    }

    fn png(path: PathBuf, size: Size, frames: u32, fps: u16) -> Result<Self, VideoError> {
        let file = File::create(&path).map_err(|source| VideoError::Write { path: path.clone(), source })?;
        let animation = Animation::new(BufWriter::new(file), size, frames, fps)?;
        Ok(Self { path, size, pushed: 0, encoder: VideoEncoder::Png(Box::new(animation)) })
    }

    /// Frames go to ffmpeg's standard input as they come, so none is kept.
    fn video(path: &Path, size: Size, fps: u16, codec: &[&str]) -> Result<Self, VideoError> {
        let failed = |source| VideoError::Write { path: path.to_owned(), source };
        // A name that begins with a dash is not an option.
        let whole = if path.is_absolute() { path.to_owned() } else { Path::new(".").join(path) };
        let mut child = Command::new(FFMPEG)
            .args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24"])
            .args(["-video_size", &format!("{}x{}", size.width, size.height), "-framerate", &fps.to_string()])
            .args(["-i", "pipe:0", "-an"])
            .args(codec)
            .args(["-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p"])
            .args(["-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-colorspace", "bt709"])
            .args(["-color_range", "tv"])
            .arg(whole)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let input = child.stdin.take();
        Ok(Self { path: path.to_owned(), size, pushed: 0, encoder: VideoEncoder::Ffmpeg { child, input } })
    }

    /// The file that is made.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds the next frame.
    ///
    /// # Errors
    /// [`VideoError`]: another size, or a file or a program that fails.
    pub fn push(&mut self, image: &Image) -> Result<(), VideoError> {
        if image.size() != self.size {
            return Err(image::Error::FrameSize { index: self.pushed, got: image.size(), want: self.size }.into());
        }
        self.pushed += 1;
        match &mut self.encoder {
            VideoEncoder::Png(animation) => Ok(animation.push(image)?),
            VideoEncoder::Ffmpeg { input, .. } => {
                let written = input.as_mut().map_or(Ok(()), |i| i.write_all(image.bytes()));
                // A broken pipe means that ffmpeg has ended: its message gives the reason.
                if written.is_err() { self.end() } else { Ok(()) }
            }
        }
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`VideoError`]; what was begun of a video is removed then.
    pub fn finish(mut self) -> Result<PathBuf, VideoError> {
        self.end()?;
        let path = self.path.clone();
        match self.encoder {
            VideoEncoder::Png(animation) => animation.finish()?,
            VideoEncoder::Ffmpeg { .. } => {}
        }
        Ok(path)
    }

    /// Waits for ffmpeg, where it makes the video.
    fn end(&mut self) -> Result<(), VideoError> {
        let VideoEncoder::Ffmpeg { child, input } = &mut self.encoder else { return Ok(()) };
        drop(input.take());
        let mut message = String::new();
        if let Some(mut words) = child.stderr.take() {
            // What cannot be read is not said.
            let _ = words.read_to_string(&mut message);
        }
        if child.wait().is_ok_and(|s| s.success()) {
            return Ok(());
        }
        // An incomplete video is removed; where that fails too, the error below is reported all the same.
        let _ = fs::remove_file(&self.path);
        let last = message.trim().lines().last().unwrap_or("it said nothing").to_owned();
        Err(VideoError::Ffmpeg { path: self.path.clone(), message: last })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames() -> Vec<Image> {
        let frame = |i: i32| {
            let mut image = Image::filled(Size::new(64, 48), [200, 190, 180]);
            image.fill(4 * i, 8, Size::new(16, 16), [180, 40, 40]);
            image
        };
        (0..6).map(frame).collect()
    }

    fn make(name: &str, ffmpeg: bool) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("toile-video-{}-{ffmpeg}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let frames = frames();
        let mut video = VideoWriter::begin_with(&folder.join(name), Size::new(64, 48), 6, 12, ffmpeg).unwrap();
        frames.iter().for_each(|f| video.push(f).unwrap());
        video.finish().unwrap()
    }

    #[test]
    fn without_ffmpeg_a_video_becomes_an_animated_png_that_decodes() {
        let path = make("a.mp4", false);
        assert_eq!(path.extension().unwrap(), "png");
        let mut reader = png::Decoder::new(io::BufReader::new(File::open(&path).unwrap())).read_info().unwrap();
        assert_eq!(reader.info().animation_control().unwrap().num_frames, 6);
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        assert!(bytes == frames()[0].bytes());
        assert!((1..6).all(|_| reader.next_frame(&mut bytes).is_ok()));
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn ffmpeg_makes_videos_that_decode_to_the_same_frames() {
        if !has_ffmpeg() {
            println!("ffmpeg is not installed, so no video was made");
            return;
        }
        for name in ["b.mp4", "b.webm"] {
            let path = make(name, true);
            let decoded = Command::new(FFMPEG)
                .args(["-loglevel", "error", "-i"])
                .arg(&path)
                .args(["-f", "rawvideo", "-pix_fmt", "rgb24", "pipe:1"])
                .output()
                .unwrap();
            assert_eq!(decoded.stdout.len(), 6 * 64 * 48 * 3, "{name}");
            for (frame, got) in frames().iter().zip(decoded.stdout.chunks(64 * 48 * 3)) {
                let off: u64 = frame.bytes().iter().zip(got).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
                assert!(off / (got.len() as u64) < 6, "{name}: {off}");
            }
            fs::remove_file(path).unwrap();
        }
    }

    #[test]
    fn names_and_sizes_that_cannot_be_made_are_refused() {
        let begin =
            |name: &str, size| VideoWriter::begin_with(Path::new(name), size, 1, 1, true).err().map(|e| e.to_string());
        assert!(begin("video.gif", Size::new(2, 2)).unwrap().contains(".webm"));
        assert!(begin("video", Size::new(2, 2)).unwrap().contains(".mp4"));
        assert!(begin("video.mp4", Size::new(3, 2)).unwrap().contains("even"));
        let nowhere = std::env::temp_dir().join("toile-no-such-folder/video.png");
        assert!(begin(nowhere.to_str().unwrap(), Size::new(2, 2)).unwrap().contains("writable"));
    }

    #[test]
    fn ffmpeg_that_fails_says_why_and_leaves_nothing() {
        if !has_ffmpeg() {
            println!("ffmpeg is not installed, so it could not fail");
            return;
        }
        let path = std::env::temp_dir().join("toile-no-such-folder/video.mp4");
        let mut video = VideoWriter::begin_with(&path, Size::new(2, 2), 1, 1, true).unwrap();
        let wrong = video.push(&Image::filled(Size::new(4, 4), [0; 3]));
        assert!(matches!(wrong, Err(VideoError::Image(image::Error::FrameSize { .. }))));
        // The pipe may break before the end or at it.
        let pushed = video.push(&Image::filled(Size::new(2, 2), [9; 3]));
        let error = pushed.and_then(|()| video.finish()).unwrap_err();
        assert!(matches!(error, VideoError::Ffmpeg { .. }) && error.to_string().contains("install"), "{error}");
        assert!(!path.exists());
    }
}
