//! Whether a scenario says what its runs are judged by.

use std::path::Path;

use hairpin::campaign::Scenario;

use super::report::{Place, Report};

/// Refuses a scenario that asks for nothing without saying so: whatever flew would pass. `file` is its name.
///
/// # Errors
/// It has no limit, and not the word for none.
pub fn check_asked(scenario: &Scenario, file: &Path) -> Result<(), Report> {
    let Err(mistake) = scenario.check_asked() else { return Ok(()) };
    let mut report = Report::default();
    let source = report.add_source(file.display().to_string(), "");
    let (key, value, bound) = (&mistake.key, &mistake.value, format!("must be {}", mistake.bound));
    report.complain(&Place { source, span: 0..0 }, key, value, &bound, format!("`{key}` = {value}: {bound}"));
    Err(report)
}
