//! docs/c.md: its commands compile the examples in C and C++ with every warning an error and run them under valgrind,
//! which finds no wrong access and no leak. Where there is no valgrind, the compilers' own sanitizers look instead.

use std::fs;
use std::path::Path;
use std::process::Command;

const TOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[test]
fn the_examples_run_without_a_warning_and_without_a_leak() {
    let text = fs::read_to_string(Path::new(TOP).join("docs/c.md")).expect("the page");
    let blocks: String = text.split("```sh\n").skip(1).filter_map(|block| block.split("```").next()).collect();
    let watched = Command::new("valgrind").arg("--version").output().is_ok_and(|told| told.status.success());
    let script = if watched {
        blocks
    } else {
        eprintln!("no valgrind on the path: the examples run with -fsanitize=address");
        let lines = blocks.replace("-pedantic", "-pedantic -fsanitize=address").replace(" --leak-check=full", "");
        let lines = lines.replace(" --errors-for-leak-kinds=definite,indirect", "");
        lines.replace("valgrind --error-exitcode=9 ", "")
    };
    let place = tempfile::tempdir().expect("a folder");
    // The libraries lie beside the tests that are made with them.
    let library = std::env::current_exe().expect("a test").parent().expect("its folder").to_path_buf();
    let told = Command::new("sh")
        .args(["-e", "-x", "-c", &script])
        .current_dir(place.path())
        .env("HAIRPIN", TOP)
        .env("HAIRPIN_LIB", &library)
        .env("LD_LIBRARY_PATH", &library)
        .output()
        .expect("a shell");
    let (out, error) = (String::from_utf8_lossy(&told.stdout), String::from_utf8_lossy(&told.stderr));
    assert!(told.status.success(), "{out}{error}");
    for words in [
        "in the plane: status 0",
        "around a rock: status 0",
        "replayed: status 0",
        "refused: x = NaN",
        "58000 um, proven",
        "worst 0.80 m at 11.0 s on leg 1",
        "deviation 0.80, limit 0.50",
        "plane, bounded: 200 queries",
    ] {
        assert!(out.contains(words), "{words}\n{out}{error}");
    }
    if watched {
        assert_eq!(error.matches("ERROR SUMMARY: 0 errors").count(), 2, "{error}");
        assert!(error.contains("All heap blocks were freed"), "{error}");
    }
}
