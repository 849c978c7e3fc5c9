//! Which program executed: all that is executed of a campaign is one program's, or what is told of it would be told of
//! another.

use hairpin_formats::executor::Greeting;
use hairpin_formats::folder::CampaignFolder;

use crate::Problem;

/// A program by its own words: `` `sim`, version `2` ``.
pub(crate) fn words(greeting: &Greeting) -> String {
    match &greeting.version {
        Some(told) => format!("`{}`, version `{told}`", greeting.name),
        None => format!("`{}` without a version", greeting.name),
    }
}

/// The program that executed what the folders of `parts`, in their order, hold; `None` where none has.
///
/// # Errors
/// They were executed by several.
pub(crate) fn of_all(parts: &[CampaignFolder]) -> Result<Option<Greeting>, Problem> {
    let mut first: Option<(&CampaignFolder, Greeting)> = None;
    for part in parts {
        let Some(now) = part.read_executor()? else { continue };
        match &first {
            None => first = Some((part, now)),
            Some((_, program)) if program.is_of_same(&now) => {}
            Some((other, program)) => {
                return Err(Problem::input(format!(
                    "{} was executed by {}, and {} by {}: all runs of a campaign are one program's; remove the parts of the one \
                     and run their shards again with the other",
                    other.path().display(),
                    words(program),
                    part.path().display(),
                    words(&now)
                )));
            }
        }
    }
    Ok(first.map(|(_, program)| program))
}
