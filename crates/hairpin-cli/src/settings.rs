//! From what was typed to the settings of jobs.

use std::sync::OnceLock;

use hairpin::campaign::CallersCode;
use hairpin::campaign::scenario::Record;
use hairpin::math::simd::Simd;
use hairpin_jobs::Problem;
use hairpin_jobs::consent::Consent;
use hairpin_jobs::sets::{self, Set};
use hairpin_jobs::work::{CampaignSettings, IfThere};

use crate::args::{Campaign, Commands, Keep, Kept, Kernels, Keys, Threads};

/// Takes the threads that were asked for.
pub(crate) fn take_threads(threads: &Threads) {
    if let Some(count) = threads.threads {
        // It fails only where the pool exists already: one command, one pool.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(count.into()).build_global();
    }
}

/// Of which runs the motion is kept, where that was asked for.
pub(crate) fn record(kept: &Kept) -> Option<Set> {
    let record = kept.keep.map(|keep| match keep {
        Keep::All => Record::All,
        Keep::Worst => Record::Worst,
        Keep::None => Record::None,
    });
    record.map(sets::record)
}

/// The version of the kernels that was asked for.
pub(crate) fn simd(kernels: &Kernels) -> Simd {
    if kernels.portable { Simd::Portable } else { Simd::Widest }
}

/// Code of whoever has the command line in a binary of his own.
static CODE: OnceLock<CallersCode> = OnceLock::new();

/// Takes the code that answers in place of files.
pub(crate) fn bring(code: CallersCode) {
    // It fails only where a command ran before in this process: its code stays.
    let _ = CODE.set(code);
}

/// What of a folder may run, as this user has it.
pub(crate) fn consent(commands: &Commands) -> Consent {
    let consent = Consent::of_user(commands.allow_commands, |name| std::env::var_os(name));
    Consent { code: CODE.get().cloned().unwrap_or_default(), ..consent }
}

/// What a campaign is begun with.
pub(crate) fn campaign(campaign: &Campaign, executor: Option<&str>) -> Result<CampaignSettings, Problem> {
    Ok(CampaignSettings {
        scenario: campaign.scenario.clone(),
        out: campaign.out.clone(),
        sets: keys(&campaign.keys, executor)?,
        if_there: if_there(campaign.resume, campaign.force),
        time_limit_s: campaign.time_limit,
        budget_s: None,
        simd: simd(&campaign.kernels),
        consent: consent(&campaign.commands),
    })
}

/// What happens to a campaign that is there already.
pub(crate) fn if_there(resume: bool, force: bool) -> IfThere {
    match (resume, force) {
        (true, _) => IfThere::Resume,
        (false, true) => IfThere::Replace,
        (false, false) => IfThere::Refuse,
    }
}

/// The keys that were typed, the seed and who executes after the others.
pub(crate) fn keys(keys: &Keys, executor: Option<&str>) -> Result<Vec<Set>, Problem> {
    let mut all = split(&keys.sets)?;
    all.extend(keys.seed.map(sets::seed));
    all.extend(executor.map(sets::executor));
    Ok(all)
}

/// `key=value` as typed; the value may hold further signs of equality.
pub(crate) fn split(sets: &[String]) -> Result<Vec<Set>, Problem> {
    let one = |set: &String| match set.split_once('=') {
        Some((key, value)) => Ok((key.trim().to_owned(), value.trim().to_owned())),
        None => Err(Problem::input(format!("--set {set}: must be KEY=VALUE, such as --set execute.repeat=5"))),
    };
    sets.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_split_at_the_first_sign_of_equality() {
        assert_eq!(split(&["a.b = c=d".into()]).unwrap(), [("a.b".to_owned(), "c=d".to_owned())]);
        assert!(split(&["a.b".into()]).is_err());
    }
}
