//! A session written as MCAP.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use mcap::records::{MessageHeader, Metadata};
use mcap::{McapResult, WriteOptions, Writer};

use super::layout::{
    self, DEPTH_TOPIC, ENCODING, HANDS_TOPIC, JOINTS_TOPIC, METADATA, NOTES, SCHEMA_ENCODING, VERSION,
};
use super::recording::Session;
use crate::error::{FilePlace, ReaderFault, SourceError};

/// Size of a chunk (bytes): what a cut-off file loses at most.
const CHUNK_BYTES: u64 = 256 << 10;

/// Writes a session to a file, all of it or nothing: the bytes go to a neighbouring file that is then renamed.
///
/// # Errors
/// If the session breaks its own rules, or the path cannot be written.
pub fn write(path: &Path, session: &Session) -> Result<(), SourceError> {
    let shown = path.display().to_string();
    let bytes = to_bytes(session).map_err(|fault| fault.at(&shown))?;
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    let result = fs::write(&part, bytes).and_then(|()| fs::rename(&part, path));
    result.map_err(|error| {
        // What cannot be removed was never made.
        let _ = fs::remove_file(&part);
        SourceError::Io { path: shown, action: "written", error }
    })
}

impl Session {
    /// The bytes of the session's recording; the same session gives the same bytes.
    ///
    /// # Errors
    /// If the session breaks its own rules (order of time, finite numbers, sizes).
    pub fn to_bytes(&self) -> Result<Vec<u8>, SourceError> {
        to_bytes(self).map_err(|fault| fault.at(&self.name))
    }
}

/// A session as the bytes of an MCAP file; the same session gives the same bytes.
fn to_bytes(session: &Session) -> Result<Vec<u8>, ReaderFault> {
    session.check()?;
    let mut depth = Vec::with_capacity(session.depth.len());
    for (i, frame) in session.depth.iter().enumerate() {
        let cure = "record it again";
        let message =
            layout::encode_depth(frame).map_err(|problem| ReaderFault::new(FilePlace::Frame(i), problem, cure))?;
        depth.push((frame.time_ns, message));
    }
    encode(session, depth)
        .map_err(|e| ReaderFault::new(FilePlace::Whole, format!("MCAP: {e}"), "report this as a defect"))
}

fn encode(session: &Session, depth: Vec<(u64, Vec<u8>)>) -> McapResult<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    let options =
        WriteOptions::new().compression(None).profile("toile").library("toile-sensors").chunk_size(Some(CHUNK_BYTES));
    let mut writer = Writer::with_options(&mut file, options)?;
    writer.write_metadata(&description(session))?;
    writer.write_metadata(&notes(session))?;
    let messages = in_time(session, depth);
    // A session without hand states has the bytes that it had before there were any.
    let used = if messages.iter().any(|m| m.topic == 2) { 3 } else { 2 };
    let topics = [
        (JOINTS_TOPIC, "toile.joints/1", layout::JOINTS_LAYOUT),
        (DEPTH_TOPIC, "toile.depth/1", layout::DEPTH_LAYOUT),
        (HANDS_TOPIC, "toile.hands/1", layout::HANDS_LAYOUT),
    ];
    let mut channels = [0; 3];
    for (channel, (topic, name, text)) in channels.iter_mut().zip(topics).take(used) {
        let schema = writer.add_schema(name, SCHEMA_ENCODING, text.as_bytes())?;
        *channel = writer.add_channel(schema, topic, ENCODING, &BTreeMap::new())?;
    }
    for (sequence, message) in (0u32..).zip(messages) {
        let Message { topic, time_ns, bytes } = message;
        let header = MessageHeader { channel_id: channels[topic], sequence, log_time: time_ns, publish_time: time_ns };
        writer.write_to_known_channel(&header, &bytes)?;
    }
    writer.finish()?;
    drop(writer);
    Ok(file.into_inner())
}

struct Message {
    /// 0 joints, 1 depth, 2 hands.
    topic: usize,
    time_ns: u64,
    bytes: Vec<u8>,
}

/// All messages in order of time, so that a cut-off file holds all kinds up to the cut.
fn in_time(session: &Session, depth: Vec<(u64, Vec<u8>)>) -> Vec<Message> {
    let joints =
        session.joints.iter().map(|f| Message { topic: 0, time_ns: f.time_ns, bytes: layout::encode_joints(f) });
    let depth = depth.into_iter().map(|(time_ns, bytes)| Message { topic: 1, time_ns, bytes });
    let hands = session.joints.iter();
    let hands = hands.filter_map(|f| Some(Message { topic: 2, time_ns: f.time_ns, bytes: layout::encode_hands(f)? }));
    let mut all: Vec<Message> = joints.chain(depth).chain(hands).collect();
    all.sort_by_key(|m| m.time_ns);
    all
}

fn description(session: &Session) -> Metadata {
    let entries = [
        ("version", Cow::from(VERSION.to_string())),
        ("origin", Cow::from("toile")),
        ("name", Cow::from(session.name.as_str())),
        ("scale", Cow::from(if session.raw_scale_known { "known" } else { "assumed" })),
        ("joint_frames", Cow::from(session.joints.len().to_string())),
        ("depth_frames", Cow::from(session.depth.len().to_string())),
    ];
    let metadata = entries.into_iter().map(|(key, value)| (key.to_owned(), value.into_owned())).collect();
    Metadata { name: METADATA.to_owned(), metadata }
}

fn notes(session: &Session) -> Metadata {
    let metadata = session.notes.iter().enumerate().map(|(i, note)| (format!("{i:04}"), note.clone())).collect();
    Metadata { name: NOTES.to_owned(), metadata }
}
