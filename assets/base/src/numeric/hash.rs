//! FNV-1a with 64 bits (Fowler, Noll and Vo): for state hashes and checks of files, not for anything secret.

/// The hash of what was added so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fnv1a(u64);

impl Default for Fnv1a {
    fn default() -> Self {
        Self(Self::OFFSET_BASIS)
    }
}

impl Fnv1a {
    /// The hash of nothing.
    pub const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

    const PRIME: u64 = 0x0100_0000_01b3;

    /// Adds a byte.
    pub const fn byte(&mut self, byte: u8) {
        self.0 = (self.0 ^ byte as u64).wrapping_mul(Self::PRIME);
    }

    /// Adds the bits of a number, lowest byte first.
    pub fn number(&mut self, number: f32) {
        number.to_bits().to_le_bytes().into_iter().for_each(|byte| self.byte(byte));
    }

    /// The hash of all bytes that were added.
    pub const fn finish(self) -> u64 {
        self.0
    }
}

/// The hash of bytes.
pub fn of_bytes(bytes: &[u8]) -> u64 {
    let mut hash = Fnv1a::default();
    bytes.iter().for_each(|&byte| hash.byte(byte));
    hash.finish()
}

/// The hash of numbers by their bits, each lowest byte first.
pub fn of_numbers(numbers: impl IntoIterator<Item = f32>) -> u64 {
    let mut hash = Fnv1a::default();
    numbers.into_iter().for_each(|number| hash.number(number));
    hash.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values_are_met() {
        assert_eq!(of_bytes(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(of_bytes(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(of_bytes(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn numbers_count_by_their_bits() {
        assert_eq!(of_numbers([1.0]), of_bytes(&1.0f32.to_le_bytes()));
        assert_ne!(of_numbers([0.0]), of_numbers([-0.0]));
    }
}
