//! The library's unit tests: where `#[test]` registers them, and the executable that runs them finds them.

/// A test, as its attribute registered it.
pub struct UnitTest {
    /// Its path, with the crate.
    pub name: &'static str,
    /// Runs it; it fails by a panic.
    pub run: fn(),
    /// Whether it runs only where it is asked for.
    pub ignored: bool,
    /// What its panic has to contain, of a test that has to panic.
    pub panics_with: Option<&'static str>,
}

inventory::collect!(UnitTest);

/// All tests of this library, by name.
pub fn all() -> Vec<&'static UnitTest> {
    let mut tests: Vec<&'static UnitTest> = inventory::iter::<UnitTest>.into_iter().collect();
    tests.sort_by_key(|test| test.name);
    tests
}
