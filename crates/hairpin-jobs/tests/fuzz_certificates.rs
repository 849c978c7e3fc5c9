//! Certificates of heaviest paths, spoiled byte by byte: a finding or a refusal, soon and within bounds.

#[path = "../../hairpin-formats/tests/fuzz/mutate.rs"]
mod mutate;

use hairpin::search::heaviest::{HeaviestSettings, Method};
use hairpin_jobs::Unwatched;
use hairpin_jobs::max_load::{MaxLoadSettings, max_load, verify_certificate};

#[test]
fn certificates() {
    let place = tempfile::tempdir().unwrap();
    let (graph, file) = (place.path().join("costs.csv"), place.path().join("proof.json"));
    let cost = |i: usize, j: usize| if i == j { String::new() } else { ((7 * i + 11 * j * j) % 23 + 1).to_string() };
    let rows: Vec<String> = (0..7).map(|i| (0..7).map(|j| cost(i, j)).collect::<Vec<_>>().join(",")).collect();
    std::fs::write(&graph, rows.join("\n") + "\n").unwrap();
    let proof = |visits: usize| {
        let search = HeaviestSettings { method: Method::Branch, proof: true, ..HeaviestSettings::default() };
        let settings = MaxLoadSettings { graph: graph.clone(), visits, search, ..MaxLoadSettings::default() };
        max_load(&settings, &Unwatched).unwrap().write_certificate(&file).unwrap();
        std::fs::read(&file).unwrap()
    };
    let samples = [proof(1), proof(2)];
    mutate::fuzz("certificate.json", &samples, |bytes| {
        std::fs::write(&file, bytes).unwrap();
        drop(verify_certificate(&graph, &file));
    });
    // What made it end in an abort: a hundred megabytes of brackets.
    let read = |bytes: &[u8]| {
        std::fs::write(&file, bytes).unwrap();
        assert!(verify_certificate(&graph, &file).is_err());
    };
    mutate::stand(&read, &b"[],".repeat(33_400_000)).unwrap();
    mutate::stand(&read, &b"[],".repeat(3_340_000)).unwrap();
}
