//! Catalogues and packages from unknown authors: accepted files, files left out, and one sentence for each fault.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use toile_assets::catalogue::package::pack;
use toile_assets::catalogue::{Catalogue, CatalogueError, GarmentPackage};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A folder of its own, removed when it is dropped.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("toile-catalogue-{name}-{}", std::process::id()));
        _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, content).unwrap();
        path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

fn manifest(article: &str, garment: &str) -> String {
    format!(
        "article = \"{article}\"\ngarment = \"{garment}\"\nname = {{ en = \"Skirt\", de = \"Rock\" }}\nprice = \"49.90 EUR\"\n"
    )
}

fn zipped(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for (name, bytes) in files {
        zip.start_file(*name, options).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// One sentence: what, where, and the cure.
fn sentence(error: &CatalogueError) -> String {
    let text = error.to_string();
    assert!(!text.contains('\n') && text.contains("; ") && text.len() < 600, "{text}");
    text
}

fn refused(bytes: Vec<u8>) -> String {
    let opened = GarmentPackage::of_bytes("skirt.toile", bytes).and_then(|mut package| package.manifest());
    sentence(&opened.unwrap_err())
}

/// A picture's head, of so many pixels.
/// A grey picture in PNG.
fn png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    image::GrayImage::new(width, height).write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    bytes
}

#[test]
fn what_is_packed_is_read_again() {
    let scratch = Scratch::new("pack");
    scratch.file("garment.toml", manifest("SK-1", "skirt.json") + "photographs = [\"front.png\"]\n");
    scratch.file("skirt.json", b"{\"parts\": {}}");
    scratch.file("front.png", png(800, 1200));
    let (bytes, packed) = pack(&scratch.0).unwrap();
    let mut package = GarmentPackage::of_bytes("skirt.toile", bytes).unwrap();
    assert_eq!(package.manifest().unwrap(), packed);
    assert_eq!(package.text("skirt.json", 100).unwrap(), "{\"parts\": {}}");
    let unpacked = package.unpack().unwrap();
    assert_eq!(fs::read(unpacked.path.join("front.png")).unwrap(), png(800, 1200));
    let folder = unpacked.path.clone();
    drop(unpacked);
    assert!(!folder.exists(), "what is unpacked is removed");
    // A mesh brings what goes by its name.
    scratch.file("garment.toml", manifest("CO-1", "coat.obj"));
    for name in ["coat.obj", "coat.mtl", "coat.toml", "coatrack.obj"] {
        scratch.file(name, name);
    }
    let (bytes, _) = pack(&scratch.0).unwrap();
    let mut package = GarmentPackage::of_bytes("coat.toile", bytes).unwrap();
    assert_eq!(package.text("coat.toml", 100).unwrap(), "coat.toml");
    assert!(package.text("coatrack.obj", 100).is_err());
}

#[test]
fn packages_that_are_none_are_refused_in_one_sentence() {
    let good = manifest("SK-1", "skirt.json");
    let whole: &[(&str, &[u8])] = &[("garment.toml", good.as_bytes()), ("skirt.json", b"{}")];
    GarmentPackage::of_bytes("skirt.toile", zipped(whole)).unwrap().manifest().unwrap();
    assert!(refused(b"no archive".to_vec()).contains("no garment package"));
    assert!(refused(zipped(&whole[1..])).contains("garment.toml"));
    assert!(refused(zipped(&whole[..1])).contains("skirt.json"));
    assert!(refused(zipped(&[whole[0], whole[1], ("../escape", b"x")])).contains("no plain file name"));
    assert!(refused(zipped(&[whole[0], whole[1], ("a/b", b"x")])).contains("no plain file name"));
    let many: Vec<String> = (0..80).map(|i| format!("{i}.png")).collect();
    let many: Vec<(&str, &[u8])> = many.iter().map(|name| (name.as_str(), &b"x"[..])).collect();
    assert!(refused(zipped(&many)).contains("80 files"));
    assert!(refused(zipped(&[("garment.toml", b"\xff\xfe"), whole[1]])).contains("UTF-8"));
    let huge = "x".repeat(400 << 10);
    assert!(refused(zipped(&[("garment.toml", huge.as_bytes()), whole[1]])).contains("unpacks to more"));
    let pictured = good.clone() + "photographs = [\"p.png\"]\n";
    let with = |picture: &[u8]| zipped(&[("garment.toml", pictured.as_bytes()), whole[1], ("p.png", picture)]);
    assert!(refused(with(&png(100_000, 100))).contains("100000 x 100 pixels"));
    assert!(refused(with(&png(800, 1_200)[..20])).contains("PNG or JPEG"));
    assert!(refused(with(b"GIF89a")).contains("PNG or JPEG"));
    assert!(refused(with(&png(8_000, 8_000))).contains("64000000 pixels"));
}

#[test]
fn a_bomb_is_refused_before_it_unpacks() {
    let zeros = vec![0u8; 64 << 20];
    let good = manifest("SK-1", "skirt.json");
    let bomb =
        zipped(&[("garment.toml", good.as_bytes()), ("skirt.json", &zeros), ("a.bin", &zeros), ("b.bin", &zeros)]);
    assert!(bomb.len() < 1 << 20);
    let start = std::time::Instant::now();
    assert!(refused(bomb).contains("unpack to"));
    println!("refused in {:?}", start.elapsed());
    // One that lies about its size is stopped where it is read.
    let mut lying = zipped(&[("garment.toml", &vec![b'#'; 4 << 20])]);
    let size = (4u32 << 20).to_le_bytes();
    while let Some(at) = lying.windows(4).position(|w| w == size) {
        lying[at..at + 4].copy_from_slice(&100u32.to_le_bytes());
    }
    refused(lying);
}

#[test]
fn packages_cut_short_and_garbled_are_refused_or_read_but_never_more() {
    let good = manifest("SK-1", "skirt.json") + "photographs = [\"p.png\"]\n";
    let whole =
        zipped(&[("garment.toml", good.as_bytes()), ("skirt.json", b"{\"parts\": {}}"), ("p.png", &png(40, 60))]);
    let read = |bytes: Vec<u8>| {
        let opened = GarmentPackage::of_bytes("skirt.toile", bytes);
        let read = opened.and_then(|mut package| Ok((package.manifest()?, package.text("skirt.json", 1 << 20)?)));
        if let Err(error) = read {
            sentence(&error);
        }
    };
    for length in 0..whole.len() {
        read(whole[..length].to_vec());
    }
    for at in 0..whole.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            read(bytes);
        }
    }
}

#[test]
fn a_catalogue_leaves_out_what_cannot_be_used_and_names_it() {
    let scratch = Scratch::new("shop");
    let package = |name: &str, article: &str| {
        let text = manifest(article, "strap-dress");
        scratch.file(name, zipped(&[("garment.toml", text.as_bytes())]))
    };
    package("a.toile", "A-1");
    package("b.toile", "B-1");
    package("c.toile", "A-1");
    scratch.file("d.toile", b"nothing");
    scratch.file("notes.txt", b"not a package");
    scratch.file("catalogue.toml", "shop = \"Corner shop\"\n");
    let read = Catalogue::read(&scratch.0).unwrap();
    assert_eq!(read.shop, "Corner shop");
    let names: Vec<_> = read.items.iter().map(|item| item.path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["a.toile", "b.toile"]);
    let why: Vec<&str> = read.refused.iter().map(|r| r.why.as_str()).collect();
    assert!(why[0].contains("c.toile") && why[0].contains("article number A-1 is that of a.toile"), "{why:?}");
    assert!(why[1].contains("d.toile") && why.len() == 2, "{why:?}");
    assert!(read.bytes() > 200 && read.bytes() < 10_000, "{}", read.bytes());

    // The shop's own order; a package that has gone since is left out, and so is a path out of the folder.
    scratch.file(
        "catalogue.toml",
        "shop = \"Corner shop\"\ngarments = [\"b.toile\", \"gone.toile\", \"../a.toile\", \"a.toile\"]\n",
    );
    let read = Catalogue::read(&scratch.0).unwrap();
    assert_eq!(read.items.iter().map(|i| i.manifest.article.as_str()).collect::<Vec<_>>(), ["B-1", "A-1"]);
    assert_eq!(read.refused.len(), 2);
}

#[test]
fn a_folder_that_is_no_catalogue_is_refused() {
    let scratch = Scratch::new("none");
    assert!(sentence(&Catalogue::read(&scratch.0).unwrap_err()).contains("catalogue.toml"));
    assert!(sentence(&Catalogue::read(Path::new("/no/such/folder")).unwrap_err()).contains("no folder"));
    scratch.file("catalogue.toml", "shop = 3\n");
    assert!(sentence(&Catalogue::read(&scratch.0).unwrap_err()).contains("line 1"));
    scratch.file("catalogue.toml", "shop = \"A\"\nlogo = \"x\"\n");
    assert!(sentence(&Catalogue::read(&scratch.0).unwrap_err()).contains("line 2"));
}

/// A whole picture of one colour.
#[test]
fn a_theme_is_read_and_what_is_wrong_with_it_is_one_sentence() {
    let scratch = Scratch::new("theme");
    let font = include_bytes!("../../engine/kiosk/fonts/NotoSans-Regular.ttf");
    scratch.file("logo.png", png(1_000, 400));
    scratch.file("shop.ttf", font);
    let whole = "shop = \"A\"\n[theme]\nlogo = \"logo.png\"\nfont = \"shop.ttf\"\nground = [0.96, 0.94, 0.9]\n\
                 text = [0.1, 0.1, 0.12]\naccent = [0.6, 0.2, 0.2]\n";
    scratch.file("catalogue.toml", whole);
    let theme = Catalogue::read(&scratch.0).unwrap().theme.unwrap();
    let logo = theme.logo.as_ref().unwrap();
    assert_eq!((logo.width, logo.height), (512, 205), "as large as it is shown");
    assert_eq!(theme.font.as_ref().map(|bytes| bytes.len()), Some(font.len()));
    assert_eq!((theme.colours.ground, theme.colours.accent), ([0.96, 0.94, 0.9], [0.6, 0.2, 0.2]));
    for (from, to, word) in [
        ("[0.1, 0.1, 0.12]", "[0.7, 0.7, 0.7]", "contrast of 1.9:1"),
        ("[0.6, 0.2, 0.2]", "[153, 51, 51]", "theme.accent"),
        ("[0.6, 0.2, 0.2]", "[0.6, 0.2]", "line 7"),
        ("accent", "akzent", "line 7"),
        ("logo.png", "gone.png", "gone.png"),
        ("logo.png", "../logo.png", "no plain file name"),
        ("logo.png", "shop.ttf", "no picture in PNG or JPEG"),
        ("logo.png", "wide.png", "3000 x 2 pixels"),
        ("logo.png", "half.png", "half.png"),
        ("shop.ttf", "logo.png", "no font in TrueType or OpenType"),
        ("shop.ttf", "cut.ttf", "cut.ttf"),
        ("shop.ttf", "large.ttf", "at most 8388608 bytes"),
    ] {
        scratch.file("wide.png", png(3_000, 2));
        let logo = png(60, 60);
        scratch.file("half.png", &logo[..logo.len() / 2]);
        scratch.file("cut.ttf", &font[..300]);
        scratch.file("large.ttf", vec![0; 9 << 20]);
        scratch.file("catalogue.toml", whole.replace(from, to));
        let refused = sentence(&Catalogue::read(&scratch.0).unwrap_err());
        assert!(refused.contains(word), "{to}: {refused}");
    }
}

#[test]
fn a_package_that_is_still_the_same_is_not_read_again() {
    let scratch = Scratch::new("again");
    scratch.file("catalogue.toml", "shop = \"A\"\n");
    let package = |article: &str| zipped(&[("garment.toml", manifest(article, "strap-dress").as_bytes())]);
    scratch.file("a.toile", package("A-1"));
    scratch.file("b.toile", package("B-1"));
    let before = Catalogue::read(&scratch.0).unwrap();
    assert_eq!(Catalogue::read_after(&scratch.0, Some(&before)).unwrap(), before);
    scratch.file("b.toile", package("B-22"));
    let after = Catalogue::read_after(&scratch.0, Some(&before)).unwrap();
    assert_eq!(after.items[0], before.items[0]);
    assert_eq!(after.items[1].manifest.article, "B-22");
    assert_ne!(after.items[1].stamp, before.items[1].stamp);
}

#[test]
fn two_hundred_garments_are_read_in_little_memory() {
    let scratch = Scratch::new("many");
    scratch.file("catalogue.toml", "shop = \"Department store\"\n");
    for i in 0..200 {
        let text = manifest(&format!("N-{i}"), "tee");
        scratch.file(&format!("{i:03}.toile"), zipped(&[("garment.toml", text.as_bytes())]));
    }
    let start = std::time::Instant::now();
    let read = Catalogue::read(&scratch.0).unwrap();
    println!("{} garments, {} bytes, {:?}", read.items.len(), read.bytes(), start.elapsed());
    assert_eq!((read.items.len(), read.refused.len()), (200, 0));
    assert!(read.bytes() < 200 * 2_048, "{}", read.bytes());
}
