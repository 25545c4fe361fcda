//! The part of Open Sound Control 1.0 that a receiver of poses needs: packets, messages, and their numbers and texts.

/// A packet of OSC.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum OscPacket<'a> {
    Message(OscMessage<'a>),
    /// The packets of a bundle; its time is not used.
    Bundle(Vec<OscPacket<'a>>),
}

/// A message with its arguments in order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OscMessage<'a> {
    pub address: &'a str,
    pub arguments: Vec<OscArgument<'a>>,
}

/// One argument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum OscArgument<'a> {
    Float(f32),
    Double(f64),
    Text(&'a str),
    /// A value of a kind that poses do not have, or an array.
    Other,
}

/// The bytes that are left of a packet. Its start and all that is taken are aligned to four bytes.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    /// A text up to its zero byte, with the padding behind it.
    fn text(&mut self) -> Option<&'a str> {
        let length = self.0.iter().position(|byte| *byte == 0)?;
        let text = self.take((length + 1).next_multiple_of(4))?;
        std::str::from_utf8(&text[..length]).ok()
    }

    fn argument(&mut self, tag: char) -> Option<OscArgument<'a>> {
        let bytes = match tag {
            'f' => return self.array().map(|b| OscArgument::Float(f32::from_be_bytes(b))),
            'd' => return self.array().map(|b| OscArgument::Double(f64::from_be_bytes(b))),
            's' => return self.text().map(OscArgument::Text),
            'b' => (u32::from_be_bytes(self.array()?) as usize).checked_next_multiple_of(4)?,
            'i' | 'c' | 'r' | 'm' => 4,
            'h' | 't' => 8,
            'T' | 'F' | 'N' | 'I' => 0,
            _ => return None,
        };
        self.take(bytes).map(|_| OscArgument::Other)
    }

    fn arguments(&mut self, tags: &str) -> Option<Vec<OscArgument<'a>>> {
        let mut arguments = Vec::new();
        let mut depth = 0_usize;
        for tag in tags.chars().skip(1) {
            let argument = match tag {
                '[' => {
                    depth += 1;
                    continue;
                }
                ']' => {
                    depth = depth.checked_sub(1)?;
                    OscArgument::Other
                }
                tag => self.argument(tag)?,
            };
            if depth == 0 {
                arguments.push(argument);
            }
        }
        Some(arguments)
    }
}

/// Reads a packet; none where the bytes are no OSC. It descends into bundles by recursion.
pub(super) fn decode(bytes: &[u8]) -> Option<OscPacket<'_>> {
    let mut rest = Rest(bytes);
    let address = rest.text()?;
    if address == "#bundle" {
        rest.take(8)?;
        let mut packets = Vec::new();
        while !rest.0.is_empty() {
            let size = u32::from_be_bytes(rest.array()?) as usize;
            packets.push(decode(rest.take(size)?)?);
        }
        return Some(OscPacket::Bundle(packets));
    }
    if !address.starts_with('/') {
        return None;
    }
    let tags = rest.text()?;
    let arguments = rest.arguments(tags)?;
    Some(OscPacket::Message(OscMessage { address, arguments }))
}

#[cfg(test)]
mod tests {
    use rosc::{OscArray, OscBundle, OscTime, OscType, encoder};

    use super::*;

    #[test]
    fn all_kinds_of_arguments_are_passed_over() {
        let time = OscTime { seconds: 1, fractional: 2 };
        let args = vec![
            OscType::Int(1),
            OscType::Blob(vec![1, 2, 3, 4, 5]),
            OscType::Array(OscArray { content: vec![OscType::Float(9.0)] }),
            OscType::Bool(true),
            OscType::Long(3),
            OscType::Time(time),
            OscType::Char('c'),
            OscType::Nil,
            OscType::Double(0.25),
            OscType::String("abcd".into()),
            OscType::Float(0.5),
        ];
        let message = rosc::OscPacket::Message(rosc::OscMessage { addr: "/a".into(), args });
        let bundle = OscBundle { timetag: time, content: vec![message] };
        let bytes = encoder::encode(&rosc::OscPacket::Bundle(bundle)).unwrap();
        let Some(OscPacket::Bundle(packets)) = decode(&bytes) else { panic!("a bundle") };
        let [OscPacket::Message(message)] = &packets[..] else { panic!("{packets:?}") };
        assert_eq!(message.address, "/a");
        let mut wanted = vec![OscArgument::Other; 8];
        wanted.extend([OscArgument::Double(0.25), OscArgument::Text("abcd"), OscArgument::Float(0.5)]);
        assert_eq!(message.arguments, wanted);
        // Cut off anywhere within its one element, it is refused.
        assert!((21..bytes.len()).all(|end| decode(&bytes[..end]).is_none()));
    }
}
