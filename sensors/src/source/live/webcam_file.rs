//! Pictures of files in a webcam's place: what tests see through, and demonstrations without a camera.
//!
//! A folder of JPEG and PNG files plays in the order of their names; a file of JPEGs one after the other (`.mjpeg`), or of YUYV pictures,
//! whose size stands in its name (`people_640x480.yuyv`), plays from its begin to its end. All play at 30 Hz, again and again.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use super::colour_decode::{self as decode, JPEG, JPEG_END};
use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, LiveCamera};
use crate::limits::{MAX_FILE_BYTES, MAX_FOLDER_FILES};

/// Time between two pictures (ns): 30 Hz.
const PERIOD_NS: u64 = 33_333_333;

/// Content of a file or a folder.
enum Pictures {
    /// JPEG and PNG files, each read when it is due, so that a picture that is broken is one frame and no more.
    Files(Vec<PathBuf>),
    /// JPEGs in one file, each from a place to another.
    Jpegs(Vec<u8>, Vec<std::ops::Range<usize>>),
    /// YUYV pictures of one size.
    Yuyv(Vec<u8>, [usize; 2]),
}

/// Files that play as a webcam.
pub(super) struct WebcamFile {
    pictures: Pictures,
    info: CameraInfo,
    next: u64,
    begun: Instant,
    bytes: Vec<u8>,
    scratch: Vec<u8>,
}

fn refused(path: &Path, what: impl std::fmt::Display) -> CameraError {
    CameraError::Recording(format!(
        "{}: {what}; give a folder of JPEG or PNG files, a file of JPEGs (.mjpeg), or NAME_WxH.yuyv",
        path.display()
    ))
}

impl WebcamFile {
    pub fn open(path: &str, options: &CameraOptions) -> Result<Self, CameraError> {
        options.check_webcam()?;
        let path = Path::new(path);
        let pictures = Pictures::of(path)?;
        let mut camera = Self {
            pictures,
            info: CameraInfo::webcam(format!("webcam of {}", path.display()), [1, 1], 1e9 / PERIOD_NS as f32),
            next: 0,
            begun: Instant::now(),
            bytes: Vec::new(),
            scratch: Vec::new(),
        };
        let mut frame = CameraFrame::default();
        camera.picture(&mut frame).map_err(|what| refused(path, format!("its first picture: {what}")))?;
        camera.info.camera = CameraInfo::webcam(String::new(), [frame.colour.width, frame.colour.height], 30.0).camera;
        Ok(camera)
    }

    fn count(&self) -> u64 {
        (match &self.pictures {
            Pictures::Files(files) => files.len(),
            Pictures::Jpegs(_, places) => places.len(),
            Pictures::Yuyv(bytes, [w, h]) => bytes.len() / (2 * w * h),
        }) as u64
    }

    /// Makes the picture that is due red, green and blue.
    fn picture(&mut self, frame: &mut CameraFrame) -> Result<(), String> {
        let at = (self.next % self.count()) as usize;
        match &self.pictures {
            Pictures::Files(files) => {
                self.bytes =
                    fs::read(&files[at]).map_err(|e| format!("{} cannot be read ({e})", files[at].display()))?;
                decode::decode(&self.bytes, &mut self.scratch, &mut frame.colour)
            }
            Pictures::Jpegs(bytes, places) => {
                decode::decode(&bytes[places[at].clone()], &mut self.scratch, &mut frame.colour)
            }
            Pictures::Yuyv(bytes, [w, h]) => {
                let one = 2 * w * h;
                decode::yuyv(&bytes[at * one..][..one], [*w, *h, 2 * w], &mut frame.colour)
            }
        }
    }
}

impl Pictures {
    fn of(path: &Path) -> Result<Self, CameraError> {
        let unread = |e: std::io::Error| refused(path, format!("it cannot be read ({e})"));
        let about = fs::metadata(path).map_err(unread)?;
        if about.is_dir() {
            return Self::folder(path, fs::read_dir(path).map_err(unread)?);
        }
        if about.len() > MAX_FILE_BYTES {
            return Err(refused(path, format!("it has {} bytes, more than {MAX_FILE_BYTES}", about.len())));
        }
        let bytes = fs::read(path).map_err(unread)?;
        if bytes.starts_with(JPEG) {
            let places = jpegs(&bytes);
            return Ok(Self::Jpegs(bytes, places));
        }
        let size = size_in_name(path).ok_or_else(|| refused(path, "it is of no known kind"))?;
        decode::check_size(size[0], size[1]).map_err(|what| refused(path, what))?;
        let one = 2 * size[0] * size[1];
        if bytes.is_empty() || !bytes.len().is_multiple_of(one) {
            let what = format!("{} bytes are no whole pictures of {} x {} in YUYV", bytes.len(), size[0], size[1]);
            return Err(refused(path, what));
        }
        Ok(Self::Yuyv(bytes, size))
    }

    fn folder(path: &Path, entries: fs::ReadDir) -> Result<Self, CameraError> {
        let is_picture = |path: &PathBuf| {
            let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
            matches!(ending.as_deref(), Some("jpg" | "jpeg" | "png"))
        };
        let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_picture).collect();
        files.sort();
        if files.is_empty() || files.len() > MAX_FOLDER_FILES {
            return Err(refused(path, format!("it holds {} pictures instead of 1 to {MAX_FOLDER_FILES}", files.len())));
        }
        Ok(Self::Files(files))
    }
}

/// Where each JPEG of a file lies: from its begin to the next one's.
fn jpegs(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut begins = vec![0];
    let seam = [JPEG_END, JPEG].concat();
    begins.extend(bytes.windows(seam.len()).enumerate().filter(|(_, w)| *w == seam).map(|(at, _)| at + JPEG_END.len()));
    let ends = begins.iter().skip(1).copied().chain([bytes.len()]);
    begins.iter().zip(ends).map(|(begin, end)| *begin..end).collect()
}

/// Width and height of `NAME_640x480.yuyv`.
fn size_in_name(path: &Path) -> Option<[usize; 2]> {
    let ending = path.extension()?.to_str()?;
    let (_, size) = path.file_stem()?.to_str()?.rsplit_once('_')?;
    let (width, height) = size.split_once('x')?;
    (ending.eq_ignore_ascii_case("yuyv")).then_some([width.parse().ok()?, height.parse().ok()?])
}

impl LiveCamera for WebcamFile {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let due_ns = self.next * PERIOD_NS;
        let wait = Duration::from_nanos(due_ns).saturating_sub(self.begun.elapsed());
        thread::sleep(wait.min(patience));
        if wait > patience {
            return Ok(Arrival::Nothing);
        }
        frame.device_ns = due_ns;
        // A picture that is broken stays empty, and counts as half a frame.
        if self.picture(frame).is_err() {
            decode::clear(&mut frame.colour);
        }
        self.next += 1;
        Ok(Arrival::Frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn picture(width: u32, light: u8, format: image::ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image::RgbImage::from_pixel(width, 16, image::Rgb([light; 3])).write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    /// Sizes and brightness of the first pictures that come.
    fn seen(path: &Path, count: usize) -> Vec<(u32, u8)> {
        let mut camera = WebcamFile::open(path.to_str().unwrap(), &CameraOptions::default()).unwrap();
        let (mut frame, mut all) = (CameraFrame::default(), Vec::new());
        while all.len() < count {
            if camera.read(&mut frame, Duration::from_millis(50)).unwrap() == Arrival::Frame {
                all.push((frame.colour.width, frame.colour.rgb.first().copied().unwrap_or(0)));
            }
        }
        all
    }

    #[test]
    fn folders_and_files_of_pictures_play_again_and_again() {
        let folder = std::env::temp_dir().join(format!("toile-webcam-file-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("pictures")).unwrap();
        let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).unwrap();
        // A picture that is broken is one empty frame; one of another size has its own.
        write("pictures/1.png", &picture(32, 200, image::ImageFormat::Png));
        write("pictures/2.jpg", &picture(32, 100, image::ImageFormat::Jpeg)[..300]);
        write("pictures/3.PNG", &picture(48, 50, image::ImageFormat::Png));
        write("pictures/notes.txt", b"no picture");
        assert_eq!(seen(&folder.join("pictures"), 4), [(32, 200), (0, 0), (48, 50), (32, 200)]);
        let two = [picture(32, 200, image::ImageFormat::Jpeg), picture(32, 100, image::ImageFormat::Jpeg)].concat();
        write("two.mjpeg", &two);
        assert_eq!(seen(&folder.join("two.mjpeg"), 3), [(32, 200), (32, 100), (32, 200)]);
        let grey = [[126, 128, 126, 128], [16, 128, 16, 128]].concat();
        write("grey_2x1.yuyv", &grey);
        assert_eq!(seen(&folder.join("grey_2x1.yuyv"), 3), [(2, 128), (2, 0), (2, 128)]);
        let refused = |name: &str, bytes: &[u8], why: &str| {
            write(name, bytes);
            let error = WebcamFile::open(folder.join(name).to_str().unwrap(), &CameraOptions::default()).err().unwrap();
            assert!(error.is_input() && error.to_string().contains(why), "{error}");
        };
        refused("cut_2x1.yuyv", &grey[..7], "7 bytes are no whole pictures of 2 x 1");
        refused("large_16000x16000.yuyv", &grey, "a picture of 16000 x 16000 pixels is outside of");
        refused("odd.gif", b"GIF89a", "it is of no known kind");
        refused("broken.mjpeg", &two[..200], "its first picture: the JPEG is broken");
        fs::remove_dir_all(&folder).unwrap();
        assert!(WebcamFile::open("no/such", &CameraOptions::default()).is_err_and(|e| e.is_input()));
    }
}
