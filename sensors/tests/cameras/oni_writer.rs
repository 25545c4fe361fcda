//! An OpenNI 2 recording as its recorder writes it, uncompressed: a header, and records of one depth node. Sizes and orders are those of
//! a file that the library's own recorder wrote of its dummy device.

use std::fs;
use std::path::Path;

use toile_base::frame::DepthFrame;

const NODE_ADDED: u32 = 0x0d;
const INTEGER: u32 = 0x03;
const GENERAL: u32 = 0x06;
const READY: u32 = 0x09;
const DATA_BEGIN: u32 = 0x08;
const NEW_DATA: u32 = 0x0a;
const NODE_REMOVED: u32 = 0x07;
const SEEK_TABLE: u32 = 0x0e;
const END: u32 = 0x0b;

/// Type of a depth node, OpenNI's millimetres, and the image's format beneath them.
const DEPTH_NODE: u32 = 2;
const MILLIMETRES: u64 = 100;
const GREY_16: u64 = 4;

/// Bytes of a record's head: magic, type, node, two sizes, and the place of the record that it undoes.
const HEAD: usize = 28;

/// The file as it grows.
struct OniFile(Vec<u8>);

impl OniFile {
    /// Appends a record; gives its place.
    fn record(&mut self, kind: u32, node: u32, undoes: u64, fields: &[u8], payload: &[u8]) -> u64 {
        let at = self.0.len() as u64;
        self.0.extend(b"NIR\0");
        for number in [kind, node, (HEAD + fields.len()) as u32, payload.len() as u32] {
            self.0.extend(number.to_le_bytes());
        }
        self.0.extend(undoes.to_le_bytes());
        self.0.extend(fields);
        self.0.extend(payload);
        at
    }

    fn property(&mut self, kind: u32, name: &str, value: &[u8]) {
        let fields = [&text(name)[..], &(value.len() as u32).to_le_bytes(), value].concat();
        self.record(kind, 1, 0, &fields, &[]);
    }
}

fn text(name: &str) -> Vec<u8> {
    [&(name.len() as u32 + 1).to_le_bytes()[..], name.as_bytes(), b"\0"].concat()
}

/// Writes depth images of one camera.
pub fn write(file: &Path, frames: &[DepthFrame]) {
    let k = frames[0].intrinsics;
    let us = |frame: &DepthFrame| frame.time_ns / 1_000;
    let mut oni = OniFile([&b"NI10\x01\0\x01\0\0\0\0\0"[..], &[0xff; 8], &1u32.to_le_bytes()].concat());
    let mode: Vec<u8> = [k.width, k.height, 30].iter().flat_map(|n| n.to_le_bytes()).collect();
    let angle = |px: u32, f: f32| 2.0 * (f64::from(px) * 0.5 / f64::from(f)).atan();
    let view = [angle(k.width, k.fx), angle(k.height, k.fy)].map(f64::to_le_bytes).concat();
    let added = |table: u64| {
        let numbers = [&(frames.len() as u32).to_le_bytes()[..], &0u64.to_le_bytes()].concat();
        let last = us(frames.last().unwrap()).to_le_bytes();
        [&text("Depth")[..], &DEPTH_NODE.to_le_bytes(), b"NONE", &numbers, &last, &table.to_le_bytes()].concat()
    };
    let node = oni.record(NODE_ADDED, 1, 0, &added(0), &[]);
    oni.property(INTEGER, "oniRequiredFrameSize", &(k.pixels() as u64 * 2).to_le_bytes());
    oni.property(INTEGER, "xnIsGenerating", &1u64.to_le_bytes());
    oni.property(INTEGER, "xnDeviceMaxDepth", &10_000u64.to_le_bytes());
    oni.property(GENERAL, "xnCropping", &[0; 12]);
    oni.property(GENERAL, "xnFOV", &view);
    oni.property(INTEGER, "xnSupportedMapOutputModesCount", &1u64.to_le_bytes());
    oni.property(GENERAL, "xnSupportedMapOutputModes", &mode);
    oni.property(GENERAL, "xnMapOutputMode", &mode);
    oni.property(GENERAL, "xnSupportedPixelFormats", &8u32.to_le_bytes());
    oni.property(INTEGER, "xnPixelFormat", &GREY_16.to_le_bytes());
    oni.property(INTEGER, "oniPixelFormat", &MILLIMETRES.to_le_bytes());
    oni.record(READY, 1, 0, &[], &[]);
    oni.record(DATA_BEGIN, 1, 0, &[0xff; 12], &[]);
    let (mut table, mut before) = (vec![0; 20], 0);
    for (number, frame) in (1u32..).zip(frames) {
        let fields = [&us(frame).to_le_bytes()[..], &number.to_le_bytes()].concat();
        let image: Vec<u8> = frame.depth_mm.iter().flat_map(|d| d.to_le_bytes()).collect();
        before = oni.record(NEW_DATA, 1, before, &fields, &image);
        table.extend([&us(frame).to_le_bytes()[..], &0u32.to_le_bytes(), &before.to_le_bytes()].concat());
    }
    oni.record(NODE_REMOVED, 1, node, &[], &[]);
    let at = oni.record(SEEK_TABLE, 1, 0, &[], &table);
    oni.record(END, 0, 0, &[], &[]);
    // Where the table lies is known only now.
    let fields = added(at);
    oni.0[node as usize + HEAD..][..fields.len()].copy_from_slice(&fields);
    fs::write(file, oni.0).unwrap();
}
