//! Recordings of the Azure Kinect (Matroska): the depth track alone, big-endian millimetres, and the lens from the
//! attached calibration. Colour, infrared and motion are not read.

use super::azure_calibration;
use super::camera::DepthCamera;
use super::ebml::{Element, Elements, number};
use super::sequence::Sequence;
use crate::error::{FilePlace, ReaderFault};
use crate::session::Session;

/// Names of the boxes, as Matroska's specification (RFC 9559) numbers them.
mod id {
    pub const SEGMENT: u32 = 0x1853_8067;
    pub const INFO: u32 = 0x1549_a966;
    pub const TIMESTAMP_SCALE: u32 = 0x2a_d7b1;
    pub const TRACKS: u32 = 0x1654_ae6b;
    pub const TRACK_ENTRY: u32 = 0xae;
    pub const TRACK_NUMBER: u32 = 0xd7;
    pub const NAME: u32 = 0x536e;
    pub const CODEC_PRIVATE: u32 = 0x63a2;
    pub const VIDEO: u32 = 0xe0;
    pub const PIXEL_WIDTH: u32 = 0xb0;
    pub const PIXEL_HEIGHT: u32 = 0xba;
    pub const ATTACHMENTS: u32 = 0x1941_a469;
    pub const ATTACHED_FILE: u32 = 0x61a7;
    pub const FILE_NAME: u32 = 0x466e;
    pub const FILE_DATA: u32 = 0x465c;
    pub const CLUSTER: u32 = 0x1f43_b675;
    pub const TIMESTAMP: u32 = 0xe7;
    pub const SIMPLE_BLOCK: u32 = 0xa3;
    pub const BLOCK_GROUP: u32 = 0xa0;
    pub const BLOCK: u32 = 0xa1;
}

/// Milliseconds, where a recording does not say (ns).
const DEFAULT_SCALE_NS: u64 = 1_000_000;

const CURE: &str = "record it again with k4arecorder";

/// Data of a recording that are read before its images.
struct Head<'a> {
    scale_ns: u64,
    track: Option<MkvTrack>,
    calibration: Option<Element<'a>>,
}

/// The depth track.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MkvTrack {
    number: u64,
    size: [u32; 2],
}

pub(super) fn read(bytes: &[u8], camera: Option<DepthCamera>) -> Result<Session, ReaderFault> {
    let segments = || Elements::of(bytes).filter(|e| e.id == id::SEGMENT);
    let mut head = Head { scale_ns: DEFAULT_SCALE_NS, track: None, calibration: None };
    segments().flat_map(|s| s.children()).for_each(|e| head.take(&e));
    let track = head.track.ok_or_else(|| {
        let problem = "no track of 16-bit depth named DEPTH (b16g) in this Matroska file";
        ReaderFault::new(
            FilePlace::Whole,
            problem,
            "record the depth camera with k4arecorder, or export it as 16-bit PNG",
        )
    })?;
    let camera = match camera {
        Some(camera) => camera,
        None => head.camera(&track)?,
    };
    let mut sequence = Sequence::new(camera, Vec::new())?;
    let k = sequence.sensor();
    if [k.width, k.height] != track.size {
        let problem = format!(
            "images of {} x {} pixels, and a camera of {} x {}",
            track.size[0], track.size[1], k.width, k.height
        );
        return Err(ReaderFault::new(FilePlace::Whole, problem, "give the camera JSON that fits, or none"));
    }
    let (mut broken, mut cut) = (0, false);
    for element in segments().flat_map(|s| s.children()) {
        cut |= element.cut;
        if element.id == id::CLUSTER {
            broken += cluster(&element, &track, head.scale_ns, &mut sequence)?;
        }
    }
    if broken > 0 {
        sequence.notes.push(format!("{broken} depth images were cut short or of another size, and were dropped"));
    }
    if cut {
        sequence.notes.push("the recording was cut off: what came before is left".to_owned());
    }
    sequence.finish()
}

impl<'a> Head<'a> {
    fn take(&mut self, element: &Element<'a>) {
        match element.id {
            id::INFO => {
                let scale = element.children().find(|e| e.id == id::TIMESTAMP_SCALE).and_then(|e| e.unsigned());
                self.scale_ns = scale.unwrap_or(DEFAULT_SCALE_NS);
            }
            id::TRACKS => {
                let mut entries = element.children().filter(|e| e.id == id::TRACK_ENTRY);
                self.track = self.track.or_else(|| entries.find_map(|e| depth_track(&e)));
            }
            id::ATTACHMENTS => {
                let mut files = element.children().filter(|e| e.id == id::ATTACHED_FILE);
                self.calibration = self.calibration.or_else(|| files.find_map(|file| calibration_file(&file)));
            }
            _ => {}
        }
    }

    /// The depth camera that the attached calibration describes, in the track's mode.
    fn camera(&self, track: &MkvTrack) -> Result<DepthCamera, ReaderFault> {
        let file = self.calibration.as_ref().ok_or_else(|| {
            let cure = "give the depth camera as a camera JSON";
            ReaderFault::new(FilePlace::Whole, "no calibration.json is attached", cure)
        })?;
        let described = |problem| ReaderFault::new(FilePlace::Byte(file.at as u64), problem, CURE);
        azure_calibration::read(file.data, track.size).map_err(described)
    }
}

fn depth_track(entry: &Element<'_>) -> Option<MkvTrack> {
    let field = |id| entry.children().find(|e| e.id == id);
    let is_depth = field(id::NAME).is_some_and(|e| e.text() == b"DEPTH");
    // The four letters stand in a BITMAPINFOHEADER.
    let is_b16g = field(id::CODEC_PRIVATE).is_some_and(|e| e.data.get(16..20) == Some(b"b16g"));
    let video = field(id::VIDEO)?;
    let side = |id| video.children().find(|e| e.id == id).and_then(|e| u32::try_from(e.unsigned()?).ok());
    let track = MkvTrack {
        number: field(id::TRACK_NUMBER)?.unsigned()?,
        size: [side(id::PIXEL_WIDTH)?, side(id::PIXEL_HEIGHT)?],
    };
    (is_depth && is_b16g).then_some(track)
}

fn calibration_file<'a>(file: &Element<'a>) -> Option<Element<'a>> {
    let named = file.children().any(|e| e.id == id::FILE_NAME && e.text() == b"calibration.json");
    file.children().find(|e| named && e.id == id::FILE_DATA)
}

/// Takes the depth images of a cluster; gives the number of broken ones.
fn cluster(
    cluster: &Element<'_>,
    track: &MkvTrack,
    scale_ns: u64,
    sequence: &mut Sequence,
) -> Result<usize, ReaderFault> {
    let (mut begin, mut broken) = (0u64, 0);
    for element in cluster.children() {
        let block = match element.id {
            id::TIMESTAMP => {
                begin = element.unsigned().unwrap_or(0);
                continue;
            }
            id::SIMPLE_BLOCK => Some(element),
            id::BLOCK_GROUP => element.children().find(|e| e.id == id::BLOCK),
            _ => None,
        };
        let Some((number, offset, image)) = block.as_ref().and_then(parts) else { continue };
        if number != track.number {
            continue;
        }
        if image.len() != sequence.sensor().pixels() * 2 {
            broken += 1;
            continue;
        }
        let time = begin.saturating_add_signed(offset.into()).saturating_mul(scale_ns);
        sequence.push(time, image.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])))?;
    }
    Ok(broken)
}

/// Track, time after the cluster's and image of a block without lacing; the recorder never laces video.
fn parts<'a>(block: &Element<'a>) -> Option<(u64, i16, &'a [u8])> {
    const LACING: u8 = 0x06;
    let (track, length) = number(block.data, 8, false)?;
    let [high, low, flags] = *block.data.get(length..)?.first_chunk()?;
    (flags & LACING == 0).then(|| (track, i16::from_be_bytes([high, low]), &block.data[length + 3..]))
}
