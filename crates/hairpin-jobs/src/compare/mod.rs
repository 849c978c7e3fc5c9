//! Two judged campaigns, paired by case and seed: in numbers, as a page, and for a build server.

mod campaigns;
mod junit;
mod page;

pub use campaigns::{Compared, compare, unpaired};
pub use junit::junit_text;
pub use page::{of_spec, write_page};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::generate::generate;
    use crate::testing::{executed, small, violating};

    #[test]
    fn a_campaign_is_equal_to_itself() {
        let (_place, folder) = violating();
        let compared = compare(&folder, &folder, 1e-6).unwrap();
        assert_eq!((compared.comparison.pairs, compared.differences.len()), (2, 0));
        assert!(!compared.comparison.regresses() && compared.comparison.newly_failing.is_empty());
        let file = folder.with_file_name("compared.html");
        write_page(&folder, &folder, &compared, &file).unwrap();
        let page = std::fs::read_to_string(file).unwrap();
        assert!(page.contains("A, before") && page.contains("A: fail, "), "both runs of each case");
        // What failed before is known: no failure.
        let text = junit_text(&folder, &folder, &compared, false).unwrap();
        assert!(text.contains("tests=\"2\" failures=\"0\"") && text.contains("fails in A as well: A "), "{text}");
    }

    #[test]
    fn what_is_not_judged_is_refused() {
        let (_place, folder) = executed();
        let refused = compare(&folder, &folder, 0.0).unwrap_err();
        assert!(refused.to_string().starts_with("not judged yet"), "{refused}");
    }

    #[test]
    fn where_nothing_is_feasible_nothing_is_compared() {
        let place = tempfile::tempdir().unwrap();
        let mut settings = small(&place);
        settings.sets.push(("generate.limits.max_speed_m_s".to_owned(), "0.01".to_owned()));
        let folder = generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned();
        let refused = compare(&folder, &folder, 0.0).unwrap_err().to_string();
        assert!(refused.contains("has no case: there is nothing to compare"), "{refused}");
    }
}
