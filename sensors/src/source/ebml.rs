//! EBML (RFC 8794): the nested elements of Matroska, read in place. Every length is checked against what
//! there is; what a box claims beyond that is cut off.

/// One box: its name, what it holds, and where that begins in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Element<'a> {
    pub id: u32,
    pub data: &'a [u8],
    /// Offset of `data` from the file's begin (bytes).
    pub at: usize,
    /// Whether the box claims more than there is.
    pub cut: bool,
}

impl<'a> Element<'a> {
    /// The boxes in this one.
    pub fn children(&self) -> Elements<'a> {
        Elements { data: self.data, at: self.at }
    }

    /// The number that this box holds; 0 for an empty one, `None` for one longer than 8 bytes.
    pub fn unsigned(&self) -> Option<u64> {
        (self.data.len() <= 8).then(|| self.data.iter().fold(0, |n, b| n << 8 | u64::from(*b)))
    }

    /// The text that this box holds, up to its first zero.
    pub fn text(&self) -> &'a [u8] {
        self.data.split(|b| *b == 0).next().unwrap_or_default()
    }
}

/// Boxes, one after the other.
#[derive(Debug, Clone)]
pub(super) struct Elements<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Elements<'a> {
    /// The boxes of a file.
    pub const fn of(file: &'a [u8]) -> Self {
        Self { data: file, at: 0 }
    }
}

impl<'a> Iterator for Elements<'a> {
    type Item = Element<'a>;

    /// The next box; none at the end and none where a name or length is broken, for nothing after it can be found.
    fn next(&mut self) -> Option<Element<'a>> {
        let (id, id_bytes) = number(self.data, 4, true)?;
        let (length, length_bytes) = number(&self.data[id_bytes..], 8, false)?;
        let head = id_bytes + length_bytes;
        let rest = &self.data[head..];
        // All ones say that the length was not known when the box was begun: it reaches to the end.
        let unknown = length == (1 << (7 * length_bytes)) - 1;
        let wanted = if unknown { rest.len() } else { usize::try_from(length).unwrap_or(usize::MAX) };
        let taken = wanted.min(rest.len());
        let (data, after) = rest.split_at(taken);
        let element = Element { id: u32::try_from(id).ok()?, data, at: self.at + head, cut: wanted > taken };
        self.at += head + taken;
        self.data = after;
        Some(element)
    }
}

/// A number of variable length, at most `longest` bytes, and its length: leading zeros of the first byte tell the bytes
/// that follow. The marking one is kept in names.
pub(super) fn number(bytes: &[u8], longest: usize, keep_mark: bool) -> Option<(u64, usize)> {
    let first = *bytes.first()?;
    let length = first.leading_zeros() as usize + 1;
    if length > longest || length > bytes.len() {
        return None;
    }
    let head = if keep_mark { u64::from(first) } else { u64::from(first) & ((1 << (8 - length)) - 1) };
    Some((bytes[1..length].iter().fold(head, |n, b| n << 8 | u64::from(*b)), length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_found_in_boxes() {
        let file = [0x1a, 0x45, 0xdf, 0xa3, 0x85, 0x42, 0x86, 0x82, 0x01, 0x02, 0xec, 0x40, 0x01, 0x07];
        let all: Vec<Element<'_>> = Elements::of(&file).collect();
        assert_eq!((all[0].id, all[0].at, all[1].id, all[1].data, all[1].at), (0x1a45_dfa3, 5, 0xec, &[7][..], 13));
        let inner: Vec<Element<'_>> = all[0].children().collect();
        assert_eq!((inner[0].id, inner[0].unsigned(), inner[0].at), (0x4286, Some(0x102), 8));
    }

    #[test]
    fn what_a_box_claims_beyond_the_file_is_cut_off() {
        let lying = [0xec, 0x08, 0xff, 0xff, 0xff, 0xff, 1, 2];
        let found: Vec<Element<'_>> = Elements::of(&lying).collect();
        assert!(found.len() == 1 && found[0].cut && found[0].data == [1, 2]);
        for broken in [&[][..], &[0x00], &[0xec], &[0xec, 0x00], &[0x0f, 1, 2, 3], &[0x1a, 0x45]] {
            assert_eq!(Elements::of(broken).next(), None, "{broken:?}");
        }
    }

    #[test]
    fn an_unknown_length_reaches_to_the_end() {
        let live = [0xec, 0xff, 1, 2, 3];
        let found = Elements::of(&live).next().unwrap();
        assert!(!found.cut && found.data == [1, 2, 3]);
    }
}
