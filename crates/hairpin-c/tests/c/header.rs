//! The header that is committed is the one that the source makes.

use std::fs;
use std::path::Path;

/// The crate.
const HERE: &str = env!("CARGO_MANIFEST_DIR");
/// What C sees, in the order in which the header has it; the others hold nothing for C.
const SOURCES: &[&str] = &[
    "refusal", "version", "rover", "map", "settings", "drive", "steer", "clear", "follow", "max_load", "measures",
    "track", "judge",
];
const NOTHING_FOR_C: &[&str] = &["lib", "memory", "asked", "plane", "ground", "confirm", "held"];

fn made() -> String {
    let place = Path::new(HERE);
    let config = cbindgen::Config::from_file(place.join("cbindgen.toml")).expect("a configuration");
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in SOURCES {
        builder = builder.with_src(place.join(format!("src/{source}.rs")));
    }
    let mut text = Vec::new();
    builder.generate().expect("sources that cbindgen reads").write(&mut text);
    String::from_utf8(text).expect("a header is text")
}

#[test]
fn the_header_is_made_of_the_source() {
    let every = fs::read_dir(Path::new(HERE).join("src")).expect("sources").count();
    assert_eq!(every, SOURCES.len() + NOTHING_FOR_C.len(), "a source is on neither list");
    let (place, made) = (Path::new(HERE).join("include/hairpin.h"), made());
    if std::env::var_os("HAIRPIN_WRITE_HEADER").is_some() {
        fs::write(&place, &made).expect("the header is written");
    }
    let committed = fs::read_to_string(&place).unwrap_or_default();
    assert!(committed == made, "include/hairpin.h is not of these sources: HAIRPIN_WRITE_HEADER=1 writes it");
}
