//! A display of a test's own: Xvfb, driven by xdotool, looked at through the memory that Xvfb draws in.

#![allow(dead_code, reason = "each test file uses its part")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

/// What the tests need beside the program, by Debian's packages.
const NEEDED: [(&str, &str); 2] = [("Xvfb", "xvfb"), ("xdotool", "xdotool")];

/// Why windows cannot be tested here; none where they can. With CI=true that is a failure.
pub fn missing() -> Option<String> {
    let found = |name: &str| {
        std::env::var_os("PATH").is_some_and(|path| std::env::split_paths(&path).any(|dir| dir.join(name).is_file()))
    };
    let mut lacking: Vec<&str> = NEEDED.iter().filter(|(name, _)| !found(name)).map(|(_, package)| *package).collect();
    let drivers = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    if !drivers.iter().any(|dir| fs::read_dir(dir).is_ok_and(|mut entries| entries.next().is_some())) {
        lacking.push("mesa-vulkan-drivers");
    }
    if lacking.is_empty() {
        return None;
    }
    let why = format!("no window is tested: install {}", lacking.join(", "));
    assert!(std::env::var_os("CI").is_none_or(|ci| ci != "true"), "{why}");
    eprintln!("{why}");
    Some(why)
}

/// A picture, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub size: [usize; 2],
    /// `[height * width * 3]`.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// Mean difference of the channels from another (0 .. 255), within left, top, right and bottom (shares of width and height).
    pub fn differs(&self, other: &Self, [left, top, right, bottom]: [f64; 4]) -> f64 {
        if self.size != other.size {
            return 255.0;
        }
        let at = |share: f64, axis: usize| (self.size[axis] as f64 * share) as usize;
        let rows = (at(top, 1)..at(bottom, 1))
            .map(|y| 3 * (y * self.size[0] + at(left, 0))..3 * (y * self.size[0] + at(right, 0)));
        let pairs = rows.flat_map(|row| self.rgb[row.clone()].iter().zip(&other.rgb[row]));
        let (sum, count) = pairs.fold((0, 0), |(sum, count), (a, b)| (sum + u64::from(a.abs_diff(*b)), count + 1_u64));
        sum as f64 / count.max(1) as f64
    }

    /// Middle of what has this colour (pixels); none where nothing has.
    pub fn middle_of(&self, colour: [u8; 3]) -> Option<[i32; 2]> {
        let [width, _] = self.size;
        let close = |p: &[u8]| p.iter().zip(colour).all(|(a, b)| a.abs_diff(b) < 12);
        let found = self.rgb.chunks_exact(3).enumerate().filter(|(_, p)| close(p)).map(|(i, _)| (i % width, i / width));
        let bounds = found.fold(None, |b: Option<[usize; 4]>, (x, y)| {
            let [l, t, r, o] = b.unwrap_or([x, y, x, y]);
            Some([l.min(x), t.min(y), r.max(x), o.max(y)])
        });
        bounds.map(|[l, t, r, b]| [(l + r) as i32 / 2, (t + b) as i32 / 2])
    }

    pub fn read(path: &Path) -> Option<Self> {
        let mut reader = png::Decoder::new(BufReader::new(fs::File::open(path).ok()?)).read_info().ok()?;
        let mut rgb = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut rgb).ok()?;
        assert_eq!(info.color_type, png::ColorType::Rgb, "{}", path.display());
        Some(Self { size: [info.width as usize, info.height as usize], rgb })
    }

    pub fn write(&self, path: &Path) {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), self.size[0] as u32, self.size[1] as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::High);
        encoder.write_header().unwrap().write_image_data(&self.rgb).unwrap();
    }
}

/// An X server without a screen; it ends with the test.
pub struct Display {
    server: Child,
    name: String,
    memory: PathBuf,
    folder: PathBuf,
}

impl Display {
    /// One of this size, on a number that is free.
    pub fn start(size: [u32; 2]) -> Self {
        // Tests of one process run beside each other: each display has a folder of its own.
        static DISPLAYS: AtomicU32 = AtomicU32::new(0);
        let number = DISPLAYS.fetch_add(1, Relaxed);
        let folder = std::env::temp_dir().join(format!("toile-x-{}-{number}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0", &format!("{}x{}x24", size[0], size[1])])
            .arg("-fbdir")
            .arg(&folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        BufReader::new(server.stdout.as_mut().unwrap()).read_line(&mut number).unwrap();
        let name = format!(":{}", number.trim());
        assert!(name.len() > 1, "Xvfb gave no display");
        let memory = folder.join("Xvfb_screen0");
        Self { server, name, memory, folder }
    }

    /// What DISPLAY is to be.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What is on it.
    pub fn look(&self) -> Picture {
        Self::picture(&fs::read(&self.memory).unwrap())
    }

    /// The picture in the server's memory, which is an XWD file (X11's `XWDFile.h`): big-endian words of a header, colours, then pixels as
    /// the machine has them.
    fn picture(bytes: &[u8]) -> Picture {
        let word = |i: usize| u32::from_be_bytes(bytes[4 * i..4 * i + 4].try_into().unwrap()) as usize;
        let (header, width, height, stride, colours) = (word(0), word(4), word(5), word(12), word(19));
        let pixels = &bytes[header + 12 * colours..];
        let row = |y: usize| pixels[y * stride..y * stride + 4 * width].chunks_exact(4);
        let rgb = (0..height).flat_map(row).flat_map(|p| [p[2], p[1], p[0]]).collect();
        Picture { size: [width, height], rgb }
    }

    /// Waits until what is on it is as wanted; gives the last look otherwise.
    pub fn wait(&self, longest: Duration, wanted: impl Fn(&Picture) -> bool) -> Result<Picture, Picture> {
        let end = Instant::now() + longest;
        let mut before = Vec::new();
        loop {
            let bytes = fs::read(&self.memory).unwrap();
            // What has not changed is as unwanted as before; the driver that draws needs the processor.
            let is_new = bytes != before;
            if is_new || Instant::now() > end {
                let seen = Self::picture(&bytes);
                if is_new && wanted(&seen) {
                    return Ok(seen);
                }
                if Instant::now() > end {
                    return Err(seen);
                }
            }
            before = bytes;
            std::thread::sleep(Duration::from_millis(60));
        }
    }

    fn tool(&self, args: &[&str]) {
        let status = Command::new("xdotool").args(args).env("DISPLAY", &self.name).status();
        assert!(status.expect("xdotool starts").success(), "{args:?}");
    }

    /// The mouse presses at a place (pixels).
    pub fn click(&self, [x, y]: [i32; 2]) {
        self.tool(&[
            "mousemove",
            &x.to_string(),
            &y.to_string(),
            "sleep",
            "0.1",
            "mousedown",
            "1",
            "sleep",
            "0.1",
            "mouseup",
            "1",
        ]);
    }

    /// Gives a window the keys, as a window manager does; there is none here.
    pub fn give_keys(&self, title: &str) {
        self.tool(&["search", "--sync", "--name", title, "windowfocus"]);
    }

    /// A key, by its X name.
    pub fn key(&self, name: &str) {
        self.tool(&["key", name]);
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
        let _ = fs::remove_dir_all(&self.folder);
    }
}
