//! A session read from MCAP bytes. What was cut off is lost, with a note; what is corrupt is refused.

use mcap::McapError;
use mcap::records::{Metadata, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::layout::{self, DEPTH_TOPIC, ENCODING, HANDS_TOPIC, JOINTS_TOPIC, METADATA, NOTES, VERSION};
use super::recording::{DepthRoom, Session, too_many};
use super::unpack::Zstd;
use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{MAX_CHANNELS, MAX_CHUNK_BYTES, MAX_DEPTH_FRAMES, MAX_JOINT_FRAMES};
use toile_base::frame::HandState;

const CURE: &str = "record it again, or restore the file from a copy";

/// Reads a session from the bytes of its recording, for example embedded ones; `name` appears in errors.
///
/// A recording that was cut off gives a shorter session with a note.
///
/// # Errors
/// If the bytes are not a Toile session, are of a newer version, or are corrupt.
pub fn read(name: &str, bytes: &[u8]) -> Result<Session, SourceError> {
    read_bytes(bytes).map_err(|fault| fault.at(name))
}

/// Properties of a channel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Topic {
    Joints,
    Depth,
    Hands,
    Other,
}

#[derive(Default)]
struct SessionReader {
    session: Session,
    /// Channel ids seen, and what they carry; a handful.
    topics: Vec<(u16, Topic)>,
    room: DepthRoom,
    /// Hand states and the times of the frames that they belong to (ns).
    hands: Vec<(u64, [HandState; 2])>,
    is_ours: bool,
    complete: bool,
}

fn read_bytes(bytes: &[u8]) -> Result<Session, ReaderFault> {
    if !bytes.starts_with(mcap::MAGIC) {
        let short = mcap::MAGIC.starts_with(bytes);
        let problem = if short { "the file ends within its magic number" } else { "not an MCAP file" };
        return Err(ReaderFault::new(FilePlace::Byte(0), problem, CURE));
    }
    let mut reading = SessionReader::default();
    let (end, cut) = records(bytes, |opcode, data| reading.take(opcode, data))?;
    if !reading.is_ours {
        let cure = "give a session that was recorded by Toile";
        let problem = if cut { "cut off before it says who recorded it" } else { "an MCAP file of another program" };
        return Err(ReaderFault::new(FilePlace::Byte(end), problem, cure));
    }
    let SessionReader { mut session, hands, complete, .. } = reading;
    for (time_ns, hands) in hands {
        if let Ok(frame) = session.joints.binary_search_by_key(&time_ns, |f| f.time_ns) {
            session.joints[frame].hands = hands;
        }
    }
    if session.joints.is_empty() && session.depth.is_empty() {
        return Err(ReaderFault::new(FilePlace::Byte(end), "cut off before the first frame, or empty", CURE));
    }
    if cut || !complete {
        let (joints, depth) = (session.joints.len(), session.depth.len());
        session
            .notes
            .push(format!("the recording was cut off: {joints} joint frames and {depth} depth frames are left"));
    }
    session.check()?;
    Ok(session)
}

/// Feeds every record, those within chunks too, to `take`. Gives the place of the end and whether the file is cut off.
/// A record that claims to be longer than the file, or than a chunk may be, is refused before memory is taken.
fn records(bytes: &[u8], mut take: impl FnMut(u8, &[u8]) -> Result<bool, String>) -> Result<(u64, bool), ReaderFault> {
    let options = LinearReaderOptions::default()
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(bytes.len().max(MAX_CHUNK_BYTES));
    let mut reader = LinearReader::new_with_options(options);
    reader.add_decompressor(Zstd::default()).map_err(|error| faulty(0, &error))?;
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
                let go_on = take(opcode, data)
                    .map_err(|problem| ReaderFault::new(FilePlace::Byte(at as u64), problem, CURE))?;
                if !go_on {
                    return Ok((at as u64, false));
                }
            }
            Err(McapError::UnexpectedEof) => return Ok((at as u64, true)),
            Err(error) => return Err(faulty(at, &error)),
        }
    }
    Ok((at as u64, false))
}

/// What is wrong with a file, in words of the file alone: a library's own would name its source.
fn faulty(at: usize, error: &McapError) -> ReaderFault {
    let (problem, cure) = match error {
        McapError::UnsupportedCompression(name) => {
            let name: String = name.chars().filter(|c| !c.is_control()).take(20).collect();
            let problem = format!("its chunks are compressed by `{name}`, and only those of zstd are read");
            (problem, "write it again without compression or with zstd")
        }
        McapError::DecompressionError(problem) => (problem.clone(), CURE),
        McapError::BadChunkCrc { .. } => ("corrupt: a chunk does not have the content of its checksum".into(), CURE),
        McapError::RecordTooLarge { len, .. } | McapError::ChunkTooLarge(len) => {
            (format!("corrupt: a record says that it has {len} bytes"), CURE)
        }
        _ => ("corrupt: a record is not as the MCAP format has it".into(), CURE),
    };
    ReaderFault::new(FilePlace::Byte(at as u64), problem, cure)
}

impl SessionReader {
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
        match mcap::parse_record(opcode, data).map_err(|e| faulty(0, &e).problem)? {
            Record::Channel(channel) => {
                let topic = match (channel.topic.as_str(), channel.message_encoding.as_str()) {
                    (JOINTS_TOPIC, ENCODING) => Topic::Joints,
                    (DEPTH_TOPIC, ENCODING) => Topic::Depth,
                    (HANDS_TOPIC, ENCODING) => Topic::Hands,
                    _ => Topic::Other,
                };
                if !self.topics.contains(&(channel.id, topic)) {
                    if self.topics.len() == MAX_CHANNELS {
                        return Err(format!("more than {MAX_CHANNELS} channels, of which a session has three"));
                    }
                    self.topics.push((channel.id, topic));
                }
            }
            Record::Message { header, data } => {
                let topic = self.topics.iter().find(|(id, _)| *id == header.channel_id);
                match topic.ok_or("a message of an unknown channel")?.1 {
                    Topic::Joints => self.session.joints.push(layout::decode_joints(&data)?),
                    Topic::Depth => self.session.depth.push(layout::decode_depth(&data, &mut self.room)?),
                    Topic::Hands => self.hands.push(layout::decode_hands(&data)?),
                    Topic::Other => {}
                }
                let (joints, depth) = (self.session.joints.len().max(self.hands.len()), self.session.depth.len());
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
