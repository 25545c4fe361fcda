//! `toile catalogue` as a shop meets it, and its packages in a try-on and in the kiosk.

use std::fs;
use std::path::Path;

use crate::common::{Scratch, sentence, stdout};
use serde_json::Value;

fn json(scratch: &Scratch, line: &[&str]) -> Value {
    let output = scratch.toile(line);
    assert_eq!(output.status.code(), Some(0), "{line:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object")
}

/// A folder of what one garment's package is made from.
fn garment(scratch: &Scratch, name: &str, manifest: &str) -> String {
    let folder = scratch.path().join(name);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("garment.toml"), manifest).unwrap();
    name.to_owned()
}

/// A shop with FreeSewing's circle skirt and a scarf under a name of its own: both are soon put on.
fn shop(scratch: &Scratch) {
    let skirt = "article = \"SK-1\"\ngarment = \"sandy.json\"\nname = { en = \"Circle skirt\", de = \"Tellerrock\" }\n\
                 price = \"49.90 EUR\"\nfabric = \"linen-twill\"\n";
    let skirt = garment(scratch, "skirt", skirt);
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let draft = assets.join("tests/data/freesewing/sandy34.json").display().to_string();
    let seams = assets.join("data/patterns/sandy.toml").display().to_string();
    let large = format!("42={}", assets.join("tests/data/freesewing/sandy42.json").display());
    let sized = ["--table", "freesewing-women", "--drafted-for", "34", "--draft", &large, "--spacing", "30"];
    let line = [&["tailor", &draft, "--seams", &seams, "--out", "skirt/sandy.json", "--json"][..], &sized].concat();
    json(scratch, &line);
    let scarf = "article = \"SD-2\"\ngarment = \"scarf\"\nname = { en = \"Our scarf\" }\nlayer = 6\n";
    let scarf = garment(scratch, "scarf", scarf);
    fs::create_dir_all(scratch.path().join("shop")).unwrap();
    for (folder, out) in [(skirt, "shop/skirt.toile"), (scarf, "shop/scarf.toile")] {
        json(scratch, &["catalogue", "pack", &folder, "--out", out, "--json"]);
    }
    fs::write(scratch.path().join("shop/catalogue.toml"), "shop = \"Corner shop\"\n").unwrap();
}

#[test]
fn a_shop_packs_checks_shows_and_tries_on_its_garments() {
    let scratch = Scratch::new("catalogue");
    shop(&scratch);
    fs::write(scratch.path().join("shop/broken.toile"), "nothing").unwrap();
    let checked = json(&scratch, &["catalogue", "check", "shop", "--json"]);
    assert_eq!((&checked["schema"], &checked["shop"]), (&"toile.catalogue/1".into(), &"Corner shop".into()));
    let [scarf, skirt] = checked["garments"].as_array().unwrap().as_slice() else { panic!("{checked}") };
    assert_eq!((&scarf["article"], &skirt["article"]), (&"SD-2".into(), &"SK-1".into()));
    assert_eq!(skirt["sizes"], serde_json::json!(["34", "36", "38", "40", "42"]));
    assert_eq!((&skirt["price"], &skirt["languages"]), (&"49.90 EUR".into(), &serde_json::json!(["de", "en"])));
    assert_eq!(checked["refused"][0]["package"], "broken.toile");
    assert!(checked["memory_bytes"].as_u64().unwrap() < 10_000);

    let drawn = json(&scratch, &["catalogue", "sheet", "shop", "--out", "sheet.png", "--json", "--quiet"]);
    assert_eq!(drawn["garments"].as_array().map(Vec::len), Some(2));
    let png = fs::read(scratch.path().join("sheet.png")).unwrap();
    let side = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    assert!(side(16) > 480 && side(20) > 400, "{} x {}", side(16), side(20));

    let line = ["try-on", "--garment", "shop/skirt.toile", "--no-pictures", "--json", "--quiet"];
    let worn = json(&scratch, &line);
    let fit = &worn["recommendation"];
    assert_eq!((&fit["garment"], &fit["size"]), (&"Circle skirt".into(), &"34".into()), "{fit}");
}

#[test]
fn a_kiosk_wears_what_its_catalogue_has() {
    let scratch = Scratch::new("catalogue-kiosk");
    shop(&scratch);
    fs::write(scratch.path().join("kiosk.toml"), "[wear]\ncatalogue = \"shop\"\ngarments = [\"SK-1\"]\n").unwrap();
    let line = ["kiosk", "--headless", "--seconds", "3", "--config", "kiosk.toml", "--instance", "catalogue", "--json"];
    let report = json(&scratch, &line);
    assert_eq!(report["schema"], "toile.kiosk/1", "{report}");
    let refused = |config: &str, word: &str| {
        fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
        let output = scratch.toile(&line);
        assert_eq!(output.status.code(), Some(4), "{config}");
        let message = sentence(&output);
        assert!(message.contains(word), "{config}: {message}");
    };
    refused("[wear]\ncatalogue = \"nowhere\"\n", "nowhere");
    refused("[wear]\ncatalogue = \"shop\"\ngarments = [\"SK-9\"]\n", "SK-9");
    refused("[wear]\ngarments = [\"absent.obj\"]\n", "absent.obj");
}

#[test]
fn a_kiosk_reads_again_what_changes_while_it_runs() {
    let scratch = Scratch::new("catalogue-watched");
    shop(&scratch);
    let port = std::net::UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let config = format!(
        "[wear]\ncatalogue = \"shop\"\nquality = \"draft\"\n[sensor]\nsource = \"vmc\"\nvmc = \"127.0.0.1:{port}\"\n[health]\nevery_s = 0.5\n"
    );
    fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
    let line = ["kiosk", "--headless", "--seconds", "24", "--config", "kiosk.toml", "--instance", "watched", "--json"];
    let running = std::thread::scope(|scope| {
        let running = scope.spawn(|| scratch.toile(&line));
        std::thread::sleep(std::time::Duration::from_secs(5));
        // Half of a package in place, the one that is worn first gone, and then a catalogue that is none.
        let folder = scratch.path().join("shop");
        let skirt = fs::read(folder.join("skirt.toile")).unwrap();
        fs::write(folder.join("half.toile"), &skirt[..skirt.len() / 2]).unwrap();
        fs::remove_file(folder.join("scarf.toile")).unwrap();
        std::thread::sleep(std::time::Duration::from_secs(11));
        fs::write(folder.join("catalogue.toml"), "shop = 3\n").unwrap();
        running.join().unwrap()
    });
    let lines = String::from_utf8_lossy(&running.stderr).into_owned();
    assert_eq!(running.status.code(), Some(0), "{lines}");
    let said = |words: &str| lines.lines().filter(|line| line.contains(words)).count();
    assert_eq!(said("left out of the catalogue: "), 1, "{lines}");
    assert!(said("catalogue of 2 garments, read again 0 times") > 0, "{lines}");
    assert!(said("catalogue of 1 garments, read again 1 times, left out: half.toile") > 0, "{lines}");
    assert_eq!(said("the catalogue stays as it was: "), 1, "{lines}");
    assert!(said("as it was before a change that cannot be used") > 0, "{lines}");
    let report: Value = serde_json::from_slice(&running.stdout).unwrap();
    assert_eq!((&report["nonfinite"], &report["states"]), (&0.into(), &serde_json::json!(["attract"])));
}

#[test]
fn a_theme_is_checked_and_one_that_cannot_be_read_is_refused() {
    let scratch = Scratch::new("catalogue-theme");
    fs::create_dir_all(scratch.path().join("shop")).unwrap();
    let catalogue = |text: &str| fs::write(scratch.path().join("shop/catalogue.toml"), text).unwrap();
    fs::write(scratch.path().join("shop/logo.png"), include_bytes!("screens/1-attract.png")).unwrap();
    catalogue("shop = \"A\"\n[theme]\nlogo = \"logo.png\"\nground = [1.0, 1.0, 1.0]\ntext = [0.0, 0.0, 0.0]\n");
    let checked = json(&scratch, &["catalogue", "check", "shop", "--json"]);
    assert_eq!(checked["theme"], serde_json::json!({"logo": [288, 512], "font_bytes": null, "contrast": 21.0}));
    for (text, word) in [
        ("ground = [1.0, 1.0, 1.0]", "contrast of 1.1:1"),
        ("logo = \"gone.png\"", "gone.png"),
        ("font = \"logo.png\"", "no font"),
        ("colour = [1.0, 0.0, 0.0]", "line 3"),
    ] {
        catalogue(&format!("shop = \"A\"\n[theme]\n{text}\n"));
        let output = scratch.toile(&["catalogue", "check", "shop"]);
        assert_eq!(output.status.code(), Some(4), "{text}");
        let message = sentence(&output);
        assert!(message.contains(word) && message.contains("; "), "{text}: {message}");
    }
}

#[test]
fn what_cannot_be_packed_is_refused_in_one_sentence() {
    let scratch = Scratch::new("catalogue-bad");
    garment(&scratch, "empty", "article = \"A\"\ngarment = \"gone.json\"\nname = { en = \"Gone\" }\n");
    garment(&scratch, "unnamed", "article = \"A\"\ngarment = \"strap-dress\"\n");
    garment(&scratch, "wrong", "article = \"A\"\ngarment = \"p.json\"\nname = { en = \"Wrong\" }\n");
    fs::write(scratch.path().join("wrong/p.json"), "{}").unwrap();
    let refused: [(&[&str], &str); 5] = [
        (&["catalogue", "pack", "empty", "--out", "a.toile"], "gone.json"),
        (&["catalogue", "pack", "unnamed", "--out", "a.toile"], "name"),
        (&["catalogue", "pack", "wrong", "--out", "a.toile"], "p.json"),
        (&["catalogue", "pack", "empty", "--out", "a.zip"], ".toile"),
        (&["catalogue", "check", "empty"], "catalogue.toml"),
    ];
    for (line, word) in refused {
        let output = scratch.toile(line);
        assert_eq!(output.status.code(), Some(4), "{line:?}");
        let message = sentence(&output);
        assert!(message.contains(word) && message.contains("; "), "{line:?}: {message}");
    }
}
