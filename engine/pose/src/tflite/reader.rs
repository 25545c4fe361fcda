//! FlatBuffers, as far as a file of a network needs them: tables with optional fields, vectors, numbers.
//!
//! A table begins with the distance back to its list of fields, which says where in the table each field lies; a field that is not in
//! the list has its default. No value of a file is trusted: every place is checked before it is read.
//!
//! Source: <https://flatbuffers.dev/internals>.

use super::NetworkFault;

/// Bytes of a file, and where each thing in it is.
#[derive(Debug, Clone, Copy)]
pub struct Bytes<'a>(&'a [u8]);

/// One table of a FlatBuffers file.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    bytes: Bytes<'a>,
    at: usize,
    /// Places of its fields, relative to `at`, two bytes each.
    fields: &'a [u8],
}

fn cut(what: &str, at: usize) -> NetworkFault {
    NetworkFault::new(format!("{what} at byte {at} lies outside of the file: it is cut or garbled"))
}

impl<'a> Bytes<'a> {
    /// The root table of a file with this identifier.
    pub fn root(bytes: &'a [u8], identifier: &[u8; 4]) -> Result<Table<'a>, NetworkFault> {
        let all = Self(bytes);
        if bytes.get(4..8) != Some(identifier) {
            return Err(NetworkFault::new("it is no TensorFlow Lite file".to_owned()));
        }
        all.table(all.offset(0)?)
    }

    fn slice(self, at: usize, len: usize, what: &str) -> Result<&'a [u8], NetworkFault> {
        let end = at.checked_add(len).ok_or_else(|| cut(what, at))?;
        self.0.get(at..end).ok_or_else(|| cut(what, at))
    }

    fn array<const N: usize>(self, at: usize, what: &str) -> Result<[u8; N], NetworkFault> {
        Ok(self.slice(at, N, what)?.try_into().unwrap_or([0; N]))
    }

    /// The place to which the offset at a place leads.
    fn offset(self, at: usize) -> Result<usize, NetworkFault> {
        let distance = u32::from_le_bytes(self.array(at, "an offset")?) as usize;
        at.checked_add(distance).ok_or_else(|| cut("an offset", at))
    }

    fn table(self, at: usize) -> Result<Table<'a>, NetworkFault> {
        let back = i64::from(i32::from_le_bytes(self.array(at, "a table")?));
        let list = usize::try_from(at as i64 - back).map_err(|_| cut("a table", at))?;
        let length = usize::from(u16::from_le_bytes(self.array(list, "a list of fields")?));
        let fields = self.slice(list, length, "a list of fields")?.get(4..).unwrap_or_default();
        Ok(Table { bytes: self, at, fields })
    }

    /// The length of the vector at a place, and where its elements of so many bytes begin.
    fn vector(self, at: usize, size: usize) -> Result<&'a [u8], NetworkFault> {
        let count = u32::from_le_bytes(self.array(at, "a vector")?) as usize;
        let len = count.checked_mul(size).ok_or_else(|| cut("a vector", at))?;
        self.slice(at + 4, len, "a vector")
    }
}

impl<'a> Table<'a> {
    /// Where a field lies; none where it has its default.
    fn field(&self, number: usize) -> Result<Option<usize>, NetworkFault> {
        let Some([low, high]) = self.fields.get(2 * number..2 * number + 2) else { return Ok(None) };
        match usize::from(u16::from_le_bytes([*low, *high])) {
            0 => Ok(None),
            offset => self.at.checked_add(offset).map(Some).ok_or_else(|| cut("a field", self.at)),
        }
    }

    fn number<const N: usize>(&self, number: usize) -> Result<Option<[u8; N]>, NetworkFault> {
        self.field(number)?.map(|at| self.bytes.array(at, "a number")).transpose()
    }

    /// A byte, or its default.
    pub fn byte(&self, number: usize, default: u8) -> Result<u8, NetworkFault> {
        Ok(self.number::<1>(number)?.map_or(default, |[b]| b))
    }

    /// A whole number of 32 bits, or its default.
    pub fn int(&self, number: usize, default: i32) -> Result<i32, NetworkFault> {
        Ok(self.number(number)?.map_or(default, i32::from_le_bytes))
    }

    /// A table within this one.
    pub fn table(&self, number: usize) -> Result<Option<Table<'a>>, NetworkFault> {
        let Some(at) = self.field(number)? else { return Ok(None) };
        self.bytes.table(self.bytes.offset(at)?).map(Some)
    }

    /// The bytes of a vector of elements of so many bytes; empty where it is not there.
    pub fn bytes(&self, number: usize, size: usize) -> Result<&'a [u8], NetworkFault> {
        let Some(at) = self.field(number)? else { return Ok(&[]) };
        self.bytes.vector(self.bytes.offset(at)?, size)
    }

    /// A vector of whole numbers.
    pub fn ints(&self, number: usize) -> Result<Vec<i32>, NetworkFault> {
        Ok(self.bytes(number, 4)?.as_chunks().0.iter().map(|b| i32::from_le_bytes(*b)).collect())
    }

    /// A vector of at most so many tables.
    pub fn tables(&self, number: usize, most: usize, what: &str) -> Result<Vec<Table<'a>>, NetworkFault> {
        let Some(at) = self.field(number)? else { return Ok(Vec::new()) };
        let at = self.bytes.offset(at)?;
        let count = self.bytes.vector(at, 4)?.len() / 4;
        if count > most {
            return Err(NetworkFault::new(format!("it has {count} {what}, more than {most}")));
        }
        (0..count).map(|i| self.bytes.table(self.bytes.offset(at + 4 + 4 * i)?)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with one table of two fields, the second absent, the third a vector of bytes.
    fn file() -> Vec<u8> {
        let mut file = vec![20, 0, 0, 0];
        file.extend(b"TST1");
        // List of fields at 8: its length, the table's, three places.
        file.extend([10, 0, 12, 0, 4, 0, 0, 0, 8, 0, 0, 0]);
        // Table at 20: back 12, a number, an offset to 32.
        file.extend([12, 0, 0, 0, 7, 0, 0, 0, 4, 0, 0, 0]);
        file.extend([3, 0, 0, 0, 1, 2, 3]);
        file
    }

    #[test]
    fn fields_are_found_and_absent_ones_have_their_default() {
        let file = file();
        let table = Bytes::root(&file, b"TST1").unwrap();
        assert_eq!((table.int(0, 5), table.int(1, 5), table.int(9, 5)), (Ok(7), Ok(5), Ok(5)));
        assert_eq!(table.bytes(2, 1), Ok(&[1, 2, 3][..]));
        assert_eq!(table.bytes(1, 1), Ok(&[][..]));
    }

    #[test]
    fn a_file_that_is_cut_anywhere_is_refused() {
        let file = file();
        for len in 0..file.len() {
            let read = Bytes::root(&file[..len], b"TST1").and_then(|table| table.bytes(2, 1).map(<[u8]>::len));
            assert!(read.is_err(), "cut at {len}: {read:?}");
        }
    }
}
