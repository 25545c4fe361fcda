//! A session read from MCAP bytes. What was cut off is lost and said; what is corrupt is refused.

use mcap::McapError;
use mcap::records::{Metadata, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::{DEPTH_TOPIC, DepthRoom, ENCODING, JOINTS_TOPIC, METADATA, NOTES, Session, VERSION, layout, too_many};
use crate::error::{Fault, Place, SourceError};
use crate::limits::{MAX_DEPTH_FRAMES, MAX_JOINT_FRAMES};

const CURE: &str = "record it again, or restore the file from a copy";

/// Reads a session from the bytes of its recording, for example embedded ones; `name` appears in errors.
///
/// A recording that was cut off gives a shorter session with a note.
///
/// # Errors
/// Where the bytes are not a Toile session, are of a newer version, or are corrupt.
pub fn read(name: &str, bytes: &[u8]) -> Result<Session, SourceError> {
    read_bytes(bytes).map_err(|fault| fault.at(name))
}

/// What is known of a channel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Topic {
    Joints,
    Depth,
    Other,
}

#[derive(Default)]
struct Reading {
    session: Session,
    /// Channel ids seen, and what they carry; a handful.
    topics: Vec<(u16, Topic)>,
    room: DepthRoom,
    is_ours: bool,
    complete: bool,
}

fn read_bytes(bytes: &[u8]) -> Result<Session, Fault> {
    if !bytes.starts_with(mcap::MAGIC) {
        let short = mcap::MAGIC.starts_with(bytes);
        let problem = if short { "the file ends within its magic number" } else { "not an MCAP file" };
        return Err(Fault::new(Place::Byte(0), problem, CURE));
    }
    let mut reading = Reading::default();
    let (end, cut) = records(bytes, |opcode, data| reading.take(opcode, data))?;
    if !reading.is_ours {
        let cure = "give a session that was recorded by Toile";
        let problem = if cut { "cut off before it says who recorded it" } else { "an MCAP file of another program" };
        return Err(Fault::new(Place::Byte(end), problem, cure));
    }
    let mut session = reading.session;
    if session.joints.is_empty() && session.depth.is_empty() {
        return Err(Fault::new(Place::Byte(end), "cut off before the first frame, or empty", CURE));
    }
    if cut || !reading.complete {
        let (joints, depth) = (session.joints.len(), session.depth.len());
        session
            .notes
            .push(format!("the recording was cut off: {joints} joint frames and {depth} depth frames are left"));
    }
    session.check()?;
    Ok(session)
}

/// Feeds every record, those within chunks too, to `take`. Gives the place of the end and whether the file is cut off.
/// A record that claims to be longer than the file is refused before memory is taken.
fn records(bytes: &[u8], mut take: impl FnMut(u8, &[u8]) -> Result<bool, String>) -> Result<(u64, bool), Fault> {
    let options = LinearReaderOptions::default()
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(bytes.len());
    let mut reader = LinearReader::new_with_options(options);
    let mut at = 0;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let count = wanted.min(bytes.len() - at);
                reader.insert(count).copy_from_slice(&bytes[at..at + count]);
                reader.notify_read(count);
                at += count;
            }
            Ok(LinearReadEvent::Record { data, opcode }) => {
                let go_on = take(opcode, data).map_err(|problem| Fault::new(Place::Byte(at as u64), problem, CURE))?;
                if !go_on {
                    return Ok((at as u64, false));
                }
            }
            Err(McapError::UnexpectedEof) => return Ok((at as u64, true)),
            Err(error) => return Err(Fault::new(Place::Byte(at as u64), format!("corrupt: {error}"), CURE)),
        }
    }
    Ok((at as u64, false))
}

impl Reading {
    /// Takes one record; false where the recording ends. Only the kinds that a session holds are parsed.
    fn take(&mut self, opcode: u8, data: &[u8]) -> Result<bool, String> {
        match opcode {
            op::CHANNEL | op::MESSAGE | op::METADATA => {}
            op::DATA_END => {
                self.complete = true;
                return Ok(false);
            }
            _ => return Ok(true),
        }
        match mcap::parse_record(opcode, data).map_err(|e| format!("corrupt: {e}"))? {
            Record::Channel(channel) => {
                let topic = match (channel.topic.as_str(), channel.message_encoding.as_str()) {
                    (JOINTS_TOPIC, ENCODING) => Topic::Joints,
                    (DEPTH_TOPIC, ENCODING) => Topic::Depth,
                    _ => Topic::Other,
                };
                if !self.topics.contains(&(channel.id, topic)) {
                    self.topics.push((channel.id, topic));
                }
            }
            Record::Message { header, data } => {
                let topic = self.topics.iter().find(|(id, _)| *id == header.channel_id);
                match topic.ok_or("a message of an unknown channel")?.1 {
                    Topic::Joints => self.session.joints.push(layout::decode_joints(&data)?),
                    Topic::Depth => self.session.depth.push(layout::decode_depth(&data, &mut self.room)?),
                    Topic::Other => {}
                }
                let (joints, depth) = (self.session.joints.len(), self.session.depth.len());
                if joints > MAX_JOINT_FRAMES || depth > MAX_DEPTH_FRAMES {
                    return Err(too_many(joints.max(depth)).problem);
                }
            }
            Record::Metadata(metadata) => self.describe(metadata)?,
            _ => {}
        }
        Ok(true)
    }

    fn describe(&mut self, metadata: Metadata) -> Result<(), String> {
        let Metadata { name, metadata: mut entries } = metadata;
        if name == METADATA {
            let version = entries.get("version").and_then(|v| v.parse::<u32>().ok()).ok_or("no version is given")?;
            if version != VERSION {
                return Err(format!("version {version} of the session format, of which {VERSION} is read here"));
            }
            self.is_ours = true;
            self.session.name = entries.remove("name").unwrap_or_default();
            self.session.raw_scale_known = entries.get("scale").is_some_and(|s| s == "known");
        } else if name == NOTES {
            self.session.notes.extend(entries.into_values());
        }
        Ok(())
    }
}
