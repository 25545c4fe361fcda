//! Every capacity of the sensors: a named constant, its unit and its reason.

use toile_assets::file::FileKind;

/// Largest recording that is read (bytes), be it one file or a folder: ten minutes of raw 640x480 depth at 30 Hz would
/// be 11 GB; what a fitting needs is half a minute, and all of a file is held in memory.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// A recording, or one image of a folder of them.
pub const RECORDING: FileKind =
    FileKind { name: "a recording", max_bytes: MAX_FILE_BYTES, cure: "cut the recording into shorter pieces" };

/// A camera's JSON or the calibration of several cameras: a page of text.
pub const CAMERA: FileKind = FileKind {
    name: "a camera description",
    max_bytes: 1 << 20,
    cure: "give the description of one camera, or of those of one recording",
};

/// The people of one image, as JSON: a few kilobytes each.
pub const KEYPOINTS: FileKind =
    FileKind { name: "the keypoints of one image", max_bytes: 1 << 20, cure: "give one JSON file an image" };

/// Most joint frames of a session: half an hour of 120 Hz motion capture, 81 MB in memory.
pub const MAX_JOINT_FRAMES: usize = 216_000;

/// Most depth frames of a session: one minute at 30 Hz, 1.1 GB at 640x480.
pub const MAX_DEPTH_FRAMES: usize = 1_800;

/// Most memory that the depth images of a session may take (bytes): the minute above, and half as much again. A small
/// file of large, empty, well-packed images would otherwise unpack to 15 GB.
pub const MAX_DEPTH_BYTES: u64 = 5 << 28;

/// Most files of a folder that is read as a recording: a minute of colour, depth and motion at 30 Hz, with room to spare.
pub const MAX_FOLDER_FILES: usize = 20_000;

/// Most pixels of a colour picture: those of a camera of 4096 x 2160, and a third more.
pub const MAX_COLOUR_PIXELS: u64 = 12_000_000;

/// Most joints of a motion-capture skeleton: a full body with both hands has about 120.
pub const MAX_BVH_JOINTS: usize = 1_024;

/// Deepest nesting of a motion-capture skeleton: a finger tip lies at depth 12.
pub const MAX_BVH_DEPTH: usize = 64;

/// Longest recording (ns): two hours, in which a sensor of 30 Hz makes [`MAX_JOINT_FRAMES`]. Every second of it is
/// simulated, so that a clock that was set within a recording must not become a month of steps.
pub const MAX_DURATION_NS: u64 = 7_200 * toile_base::clock::SECOND_NS;

/// Longest time between two frames of a recording (ns): a minute, after which another person may stand there, and during
/// which the cloth is simulated although no person is seen.
pub const MAX_GAP_NS: u64 = 60 * toile_base::clock::SECOND_NS;

/// Largest chunk of a session, unpacked (bytes): writers make chunks of about a megabyte, and a depth image that does not
/// pack has 8.
pub const MAX_CHUNK_BYTES: usize = 64 << 20;

/// Most channels of a session file: it has three of its own, and each message's is looked up.
pub const MAX_CHANNELS: usize = 256;

/// Most cameras of a multi-view recording: any two of them are compared, and a room has eight corners.
pub const MAX_CAMERAS: usize = 8;

/// Most people of one view: any two of two views are compared.
pub const MAX_VIEW_PEOPLE: usize = 6;

/// Longest datagram of a motion stream that is read (bytes): senders keep to a network's 1500, some to three of them.
pub const MAX_PACKET_BYTES: usize = 4_096;

/// Most bundles in one datagram: the protocol puts messages into one, and a parser descends into each.
pub const MAX_OSC_BUNDLES: usize = 8;

/// Most datagrams that one call reads: a second of a sender that sends each of 60 bones by itself four times.
pub const MAX_PACKETS_A_POLL: usize = 256;
