//! The byte form: what was written is read, and what is damaged or of another version is refused by name.

use toile_base::garment::bytes::{MAGIC, VERSION};
use toile_base::garment::{BytesError, Garment};

use crate::cloth;

#[test]
fn a_garment_comes_back_from_its_bytes() {
    let garment = cloth();
    let bytes = garment.to_bytes();
    assert_eq!(bytes[..8], MAGIC);
    assert_eq!(Garment::from_bytes(&bytes).unwrap(), garment);
}

#[test]
fn other_versions_and_damage_are_refused_by_name() {
    let bytes = cloth().to_bytes();
    assert_eq!(Garment::from_bytes(b"a picture of a dress"), Err(BytesError::NotAGarment));
    let mut newer = bytes.clone();
    newer[8] = 200;
    assert_eq!(Garment::from_bytes(&newer), Err(BytesError::Version { found: 200 }));
    let words = BytesError::Version { found: 200 }.to_string();
    assert!(words.contains("version 200") && words.contains(&format!("version {VERSION}")), "{words}");
    let cut = Garment::from_bytes(&bytes[..bytes.len() - 3]);
    assert!(matches!(cut, Err(BytesError::Length { .. })), "{cut:?}");
    for at in [20, bytes.len() / 2, bytes.len() - 9] {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        let error = Garment::from_bytes(&damaged).unwrap_err();
        assert!(matches!(error, BytesError::Checksum { .. }), "{error}");
    }
    assert!(matches!(Garment::from_bytes(&[]), Err(BytesError::NotAGarment)));
}
