//! Runs the unit tests of the library, which has them within it (its feature `unit-tests`): what tests it and what is
//! tested with it have one library, compiled once.

use std::panic::catch_unwind;

use hairpin::unit_tests::{self, UnitTest};
use libtest_mimic::{Arguments, Failed, Trial};

fn main() {
    let mut arguments = Arguments::from_args();
    // As the standard harness has it.
    let threads = std::env::var("RUST_TEST_THREADS").ok().and_then(|text| text.parse().ok());
    arguments.test_threads = arguments.test_threads.or(threads);
    let tests = unit_tests::all();
    assert!(!tests.is_empty(), "the library was linked without its tests");
    libtest_mimic::run(&arguments, tests.into_iter().map(trial).collect()).exit();
}

fn trial(test: &'static UnitTest) -> Trial {
    let name = test.name.trim_start_matches("hairpin::");
    Trial::test(name, || run(test)).with_ignored_flag(test.ignored)
}

fn run(test: &UnitTest) -> Result<(), Failed> {
    let Some(text) = test.panics_with else {
        (test.run)();
        return Ok(());
    };
    let run = test.run;
    let Err(payload) = catch_unwind(run) else { return Err("it did not panic".into()) };
    let said = payload.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or_default();
    if said.contains(text) { Ok(()) } else { Err(format!("it panicked with {said:?}, not {text:?}").into()) }
}
