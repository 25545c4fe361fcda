//! Video for Linux: the kernel's calls that a webcam needs, and its buffers.
//!
//! Structures and numbers are those of `linux/videodev2.h` on 64-bit machines; their sizes are checked when this is compiled.

#![expect(unsafe_code, reason = "calls of the kernel, and memory that it shares")]

use std::fs::{File, OpenOptions};
use std::io;
use std::num::NonZero;
use std::os::fd::AsFd;
use std::os::fd::AsRawFd;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::ptr::NonNull;
use std::time::Duration;

use nix::errno::Errno;
use nix::fcntl::OFlag;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::mman::{MapFlags, ProtFlags, mmap, munmap};

/// Pictures from a camera.
const CAPTURE: u32 = 1;
/// Memory that the kernel has and shares.
const MMAP: u32 = 1;
/// Whole pictures, no half ones.
const PROGRESSIVE: u32 = 1;
/// Abilities of a camera: pictures, streams, its own list of abilities.
const CAN_CAPTURE: u32 = 0x1;
const CAN_STREAM: u32 = 0x0400_0000;
const HAS_OWN_LIST: u32 = 0x8000_0000;
/// A buffer whose picture is broken.
const BROKEN: u32 = 0x40;

/// Buffers that are asked for: one is filled, one waits, and two are for a program that was late.
const BUFFERS: u32 = 4;

/// Most buffers that are taken, and the most bytes of one.
const MOST_BUFFERS: u32 = 32;
const MOST_BYTES: u32 = 1 << 26;

/// Name of a format of pictures.
pub(super) type FourCc = [u8; 4];
/// Brightness and colour of two pixels in four bytes.
pub(super) const YUYV: FourCc = *b"YUYV";
/// A JPEG a picture.
pub(super) const MJPG: FourCc = *b"MJPG";

#[repr(C)]
struct Capability {
    driver: [u8; 16],
    card: [u8; 32],
    bus: [u8; 32],
    version: u32,
    capabilities: u32,
    device_capabilities: u32,
    reserved: [u32; 3],
}

/// `v4l2_pix_format` within the union of `v4l2_format`, which begins at a multiple of 8.
#[repr(C, align(8))]
#[derive(Clone, Copy)]
struct PictureFormat {
    kind: u32,
    padding: u32,
    width: u32,
    height: u32,
    four_cc: FourCc,
    field: u32,
    bytes_per_line: u32,
    size: u32,
    rest: [u32; 44],
}

#[repr(C)]
struct RequestBuffers {
    count: u32,
    kind: u32,
    memory: u32,
    capabilities: u32,
    flags: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Default)]
struct VideoBuffer {
    index: u32,
    kind: u32,
    bytes_used: u32,
    flags: u32,
    field: u32,
    padding: u32,
    /// Seconds and microseconds.
    stamp: [i64; 2],
    time_code: [u32; 4],
    sequence: u32,
    memory: u32,
    /// Offset of the memory in the device's.
    offset: u64,
    length: u32,
    reserved: [u32; 2],
    end: u32,
}

/// `v4l2_captureparm` within the union of `v4l2_streamparm`.
#[repr(C)]
struct StreamParameters {
    kind: u32,
    capability: u32,
    mode: u32,
    /// Time of a frame: numerator and denominator (s).
    frame_time: [u32; 2],
    rest: [u32; 46],
}

const _: () =
    assert!(size_of::<Capability>() == 104 && size_of::<PictureFormat>() == 208 && size_of::<RequestBuffers>() == 20);
const _: () = assert!(size_of::<VideoBuffer>() == 88 && size_of::<StreamParameters>() == 204);

mod calls {
    use super::{Capability, PictureFormat, RequestBuffers, StreamParameters, VideoBuffer};
    nix::ioctl_read!(query_capability, b'V', 0, Capability);
    nix::ioctl_readwrite!(set_format, b'V', 5, PictureFormat);
    nix::ioctl_readwrite!(request_buffers, b'V', 8, RequestBuffers);
    nix::ioctl_readwrite!(query_buffer, b'V', 9, VideoBuffer);
    nix::ioctl_readwrite!(queue, b'V', 15, VideoBuffer);
    nix::ioctl_readwrite!(dequeue, b'V', 17, VideoBuffer);
    nix::ioctl_write_ptr!(start, b'V', 18, i32);
    nix::ioctl_write_ptr!(stop, b'V', 19, i32);
    nix::ioctl_readwrite!(set_parameters, b'V', 22, StreamParameters);
}

/// Memory of the kernel with a picture.
struct Mapped {
    at: NonNull<std::ffi::c_void>,
    length: usize,
}

// SAFETY: the memory belongs to the owner of this value, on any thread.
unsafe impl Send for Mapped {}

impl Drop for Mapped {
    fn drop(&mut self) {
        // SAFETY: it was mapped with this length, and nothing that is borrowed from it outlives it.
        let _ = unsafe { munmap(self.at, self.length) };
    }
}

/// How pictures come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PictureMode {
    pub four_cc: FourCc,
    pub width: u32,
    pub height: u32,
    /// Bytes from one row to the next.
    pub stride: u32,
    /// Frames a second (Hz).
    pub rate_hz: u32,
}

/// One picture, still in the kernel's memory.
pub(super) struct RawPicture<'a> {
    /// When it was taken, by the system's monotonic clock (ns).
    pub stamp_ns: u64,
    /// Its bytes; empty where the camera says that it is broken.
    pub bytes: &'a [u8],
}

/// A camera that streams.
pub(super) struct VideoStream {
    // Before the file, so that the memory is given back first.
    buffers: Vec<Mapped>,
    file: File,
    /// The buffer whose picture was handed out.
    shown: Option<u32>,
    pub mode: PictureMode,
    /// The camera's own name.
    pub card: String,
}

fn io_error(errno: Errno) -> io::Error {
    io::Error::from(errno)
}

impl VideoStream {
    /// Opens a camera in the first of these modes that it takes, and starts it.
    pub fn open(path: &Path, wanted: &[(FourCc, u32, u32)], rate_hz: u32) -> io::Result<Self> {
        let flags = (OFlag::O_NONBLOCK | OFlag::O_CLOEXEC).bits();
        let file = OpenOptions::new().read(true).write(true).custom_flags(flags).open(path)?;
        let card = capable(&file)?;
        let format = wanted.iter().find_map(|wanted| format(&file, *wanted));
        let format = format.ok_or_else(|| io::Error::other("it gives neither YUYV nor MJPEG"))?;
        let rate_hz = rate(&file, rate_hz);
        let mode = PictureMode {
            four_cc: format.four_cc,
            width: format.width,
            height: format.height,
            stride: format.bytes_per_line,
            rate_hz,
        };
        let mut stream = Self { buffers: Vec::new(), file, shown: None, mode, card };
        stream.map()?;
        let fd = stream.file.as_raw_fd();
        (0..stream.buffers.len() as u32).try_for_each(|index| stream.give(index))?;
        // SAFETY: the call reads one number, the kind of buffers.
        unsafe { calls::start(fd, &(CAPTURE as i32)) }.map_err(io_error)?;
        Ok(stream)
    }

    fn map(&mut self) -> io::Result<()> {
        let fd = self.file.as_raw_fd();
        let mut asked = RequestBuffers { count: BUFFERS, kind: CAPTURE, memory: MMAP, capabilities: 0, flags: 0 };
        // SAFETY: the structure is the call's own.
        unsafe { calls::request_buffers(fd, &raw mut asked) }.map_err(io_error)?;
        for index in 0..asked.count.min(MOST_BUFFERS) {
            let mut buffer = VideoBuffer { index, kind: CAPTURE, memory: MMAP, ..VideoBuffer::default() };
            // SAFETY: the structure is the call's own, and the kernel writes no more than its size.
            unsafe { calls::query_buffer(fd, &raw mut buffer) }.map_err(io_error)?;
            let length = NonZero::new(buffer.length as usize).filter(|_| buffer.length <= MOST_BYTES);
            let length = length.ok_or_else(|| io::Error::other(format!("a buffer of {} bytes", buffer.length)))?;
            // SAFETY: new memory at a place of the kernel's choice, of the length that the camera says.
            let at = unsafe {
                mmap(None, length, ProtFlags::PROT_READ, MapFlags::MAP_SHARED, &self.file, buffer.offset as i64)
            };
            self.buffers.push(Mapped { at: at.map_err(io_error)?, length: length.get() });
        }
        if self.buffers.len() < 2 { Err(io::Error::other("it has fewer than two buffers")) } else { Ok(()) }
    }

    /// Gives a buffer to the camera to be filled.
    fn give(&mut self, index: u32) -> io::Result<()> {
        let mut buffer = VideoBuffer { index, kind: CAPTURE, memory: MMAP, ..VideoBuffer::default() };
        // SAFETY: the structure is the call's own; nothing is borrowed from this buffer's memory, since `next` borrows all of it.
        unsafe { calls::queue(self.file.as_raw_fd(), &raw mut buffer) }.map_err(io_error).map(|_| ())
    }

    /// Waits for the next picture for about so long; of several that wait, the newest.
    pub fn next(&mut self, patience: Duration) -> io::Result<Option<RawPicture<'_>>> {
        if let Some(shown) = self.shown.take() {
            self.give(shown)?;
        }
        let timeout = PollTimeout::try_from(patience).unwrap_or(PollTimeout::MAX);
        let mut waits = [PollFd::new(self.file.as_fd(), PollFlags::POLLIN)];
        match poll(&mut waits, timeout) {
            Ok(0) | Err(Errno::EINTR) => return Ok(None),
            Ok(_) => {}
            Err(errno) => return Err(io_error(errno)),
        }
        let mut newest = None;
        while let Some(buffer) = self.take()? {
            if let Some(VideoBuffer { index, .. }) = newest.replace(buffer) {
                self.give(index)?;
            }
        }
        let Some(buffer) = newest else { return Ok(None) };
        self.shown = Some(buffer.index);
        let mapped =
            self.buffers.get(buffer.index as usize).ok_or_else(|| io::Error::other("a buffer of no number"))?;
        let length = if buffer.flags & BROKEN != 0 { 0 } else { mapped.length.min(buffer.bytes_used as usize) };
        // SAFETY: the kernel does not write to a buffer that it was not given back, which happens at the next call of this function,
        // when nothing is borrowed any more; the length is not more than what is mapped.
        let bytes = unsafe { std::slice::from_raw_parts(mapped.at.as_ptr().cast::<u8>(), length) };
        let [seconds, micros] = buffer.stamp.map(|n| u64::try_from(n).unwrap_or(0));
        let stamp_ns = seconds.saturating_mul(1_000_000_000).saturating_add(micros.saturating_mul(1_000));
        Ok(Some(RawPicture { stamp_ns, bytes }))
    }

    /// A filled buffer, if there is one.
    fn take(&mut self) -> io::Result<Option<VideoBuffer>> {
        let mut buffer = VideoBuffer { kind: CAPTURE, memory: MMAP, ..VideoBuffer::default() };
        // SAFETY: the structure is the call's own.
        match unsafe { calls::dequeue(self.file.as_raw_fd(), &raw mut buffer) } {
            Ok(_) => Ok(Some(buffer)),
            Err(Errno::EAGAIN) => Ok(None),
            Err(errno) => Err(io_error(errno)),
        }
    }
}

impl Drop for VideoStream {
    fn drop(&mut self) {
        // SAFETY: the call reads one number. Whether it works makes no difference: the file is closed next.
        let _ = unsafe { calls::stop(self.file.as_raw_fd(), &(CAPTURE as i32)) };
    }
}

/// The camera's name, where this is one that streams pictures.
fn capable(file: &File) -> io::Result<String> {
    // SAFETY: all of its bytes may be 0.
    let mut found: Capability = unsafe { std::mem::zeroed() };
    // SAFETY: the structure is the call's own.
    unsafe { calls::query_capability(file.as_raw_fd(), &raw mut found) }.map_err(io_error)?;
    let own = found.capabilities & HAS_OWN_LIST != 0;
    let can = if own { found.device_capabilities } else { found.capabilities };
    if can & CAN_CAPTURE == 0 || can & CAN_STREAM == 0 {
        return Err(io::Error::other("it streams no pictures; another /dev/video may be the camera's picture"));
    }
    let name: Vec<u8> = found.card.iter().copied().take_while(|b| *b != 0).collect();
    Ok(String::from_utf8_lossy(&name).trim().to_owned())
}

/// Sets a format; none where the camera has another in mind.
fn format(file: &File, (four_cc, width, height): (FourCc, u32, u32)) -> Option<PictureFormat> {
    let mut format = PictureFormat {
        kind: CAPTURE,
        padding: 0,
        width,
        height,
        four_cc,
        field: PROGRESSIVE,
        bytes_per_line: 0,
        size: 0,
        rest: [0; 44],
    };
    // SAFETY: the structure is the call's own.
    unsafe { calls::set_format(file.as_raw_fd(), &raw mut format) }.ok()?;
    (format.four_cc == four_cc
        && super::colour_decode::check_size(format.width as usize, format.height as usize).is_ok())
    .then_some(format)
}

/// Asks for a rate (Hz) and gives the one that comes; what was asked for where the camera does not say.
fn rate(file: &File, rate_hz: u32) -> u32 {
    let mut parameters =
        StreamParameters { kind: CAPTURE, capability: 0, mode: 0, frame_time: [1, rate_hz], rest: [0; 46] };
    // SAFETY: the structure is the call's own.
    let set = unsafe { calls::set_parameters(file.as_raw_fd(), &raw mut parameters) };
    let [numerator, denominator] = parameters.frame_time;
    match set {
        Ok(_) if numerator > 0 && denominator >= numerator => denominator / numerator,
        _ => rate_hz,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_camera_is_refused() {
        let wanted = [(YUYV, 640, 480)];
        let refused = |path: &str| VideoStream::open(Path::new(path), &wanted, 30).err().map(|e| e.raw_os_error());
        assert_eq!(refused("/dev/null"), Some(Some(Errno::ENOTTY as i32)));
        assert_eq!(refused("/dev/no-such-video"), Some(Some(Errno::ENOENT as i32)));
    }

    #[test]
    fn fields_lie_where_the_kernel_has_them() {
        assert_eq!((std::mem::offset_of!(PictureFormat, width), std::mem::offset_of!(PictureFormat, size)), (8, 28));
        assert_eq!(std::mem::offset_of!(StreamParameters, frame_time), 12);
        let places = [
            std::mem::offset_of!(VideoBuffer, stamp),
            std::mem::offset_of!(VideoBuffer, sequence),
            std::mem::offset_of!(VideoBuffer, memory),
            std::mem::offset_of!(VideoBuffer, offset),
            std::mem::offset_of!(VideoBuffer, length),
        ];
        assert_eq!(places, [24, 56, 60, 64, 72]);
    }
}
