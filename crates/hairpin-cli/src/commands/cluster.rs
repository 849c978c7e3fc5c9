//! `hairpin plan`, `run-shard` and `merge`: a campaign on several machines.

use std::path::PathBuf;

use hairpin_jobs::cluster::{Merged, PlanSettings, Ran, Shard, merge, plan, run_shard, shard_from_env};
use hairpin_jobs::work::CampaignSettings;
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use super::answer::Answer;
use crate::args::{Merge, Plan, RunShard};
use crate::exit::{DONE, EXECUTOR_FAILED};
use crate::{console, settings};

/// Divides a campaign.
pub(crate) fn run_plan(asked: &Plan, watch: &dyn Watch) -> Result<u8, Problem> {
    let mut sets = settings::keys(&asked.keys, asked.executor.as_deref())?;
    sets.extend(settings::record(&asked.kept));
    let campaign = CampaignSettings {
        scenario: asked.scenario.clone(),
        out: asked.out.clone(),
        sets,
        if_there: settings::if_there(asked.resume, asked.force),
        time_limit_s: None,
        budget_s: None,
        simd: settings::simd(&asked.kernels),
        consent: settings::consent(&asked.commands),
    };
    let (work, plan) = plan(&PlanSettings { campaign, cases: asked.cases, parts: asked.parts }, watch)?;
    let folder = work.folder.path();
    if asked.json {
        let mut object = json!(plan);
        object["exit_code"] = json!(DONE);
        object["paths"] = json!({ "folder": folder, "plan": work.folder.file("plan.json") });
        console::say(&object.to_string());
        return Ok(DONE);
    }
    let place = folder.display();
    console::say(&format!(
        "PLANNED {} cases in {} parts, seed {}, plan {:.12}",
        plan.cases, plan.parts, plan.seed, plan.hash
    ));
    console::say(&format!("hairpin run-shard I/N {place}, for each I from 1 to N; then hairpin merge {place}"));
    if let Some(told) = plan.told() {
        console::say(&told);
    }
    Ok(DONE)
}

/// Makes the parts of a shard.
pub(crate) fn run(asked: &RunShard, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let (shard, folder) = shard_of(asked)?;
    let Ran { parts, made, cases, failed, never_asked, of, told } =
        run_shard(&folder, shard, &settings::consent(&asked.commands), watch)?;
    // What a program failed at is data, as violations are. What none was asked for is not: a scheduler may try again.
    let code = if never_asked > 0 { EXECUTOR_FAILED } else { DONE };
    let again = (never_asked > 0).then(|| {
        format!(
            "{never_asked} of its runs were not flown, as no program could be started: the same command again flies them"
        )
    });
    if asked.json {
        let object = json!({
            "shard": shard.to_string(), "exit_code": code, "told": told.or(again), "paths": { "folder": folder },
            "parts": { "of": of, "own": parts, "made": made, "there": parts - made },
            "counts": { "cases": cases, "executor_failed": failed, "never_asked": never_asked },
        });
        console::say(&object.to_string());
        return Ok(code);
    }
    console::say(&told.unwrap_or_else(|| {
        format!("SHARD {shard}: {parts} of {of} parts with {cases} cases, {made} made and {} there", parts - made)
    }));
    if failed > never_asked {
        console::say(&format!(
            "{} of its runs failed: hairpin judge says why, once all is merged",
            failed - never_asked
        ));
    }
    if let Some(again) = again {
        console::say(&again);
    }
    Ok(code)
}

fn shard_of(asked: &RunShard) -> Result<(Shard, PathBuf), Problem> {
    let of = |text: &str| text.parse::<Shard>().map_err(Problem::input);
    match (asked.shard.as_deref(), &asked.words[..]) {
        (Some("from-env"), [folder]) => {
            Ok((shard_from_env(asked.shards, &|name| std::env::var(name).ok())?, folder.into()))
        }
        (Some(shard), [folder]) => Ok((of(shard)?, folder.into())),
        (None, [shard, folder]) => Ok((of(shard)?, folder.into())),
        (Some(_), _) => Err(Problem::input("--shard says the shard, so that only the folder of the plan follows")),
        (None, _) => Err(Problem::input("which shard? hairpin run-shard I/N DIR, or --shard from-env DIR")),
    }
}

/// Puts the parts together.
pub(crate) fn run_merge(asked: &Merge, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let Merged { stressed, parts, taken, content_hash } =
        merge(&asked.folder, &settings::consent(&asked.commands), watch)?;
    let work = &stressed.work;
    if asked.remove_parts {
        work.folder.forget_parts()?;
    }
    let runs = stressed.cases.len() * work.setup.scenario.executor().repeat as usize;
    if asked.json {
        let judged = Answer {
            work,
            cases: &stressed.cases,
            tally: &stressed.tally,
            judgement: &stressed.judgement,
            verdict: &stressed.verdict,
            replayed: &[],
            spent: None,
            junit: None,
            reported: true,
        };
        let judged = judged.object();
        let object = json!({
            "content_hash": content_hash, "exit_code": DONE, "parts": parts, "paths": judged["paths"],
            "counts": judged["counts"], "runs": { "taken": taken, "flown": runs.saturating_sub(taken) }, "judged": judged,
        });
        console::say(&object.to_string());
    } else {
        console::say(&format!("MERGED {} cases of {parts} parts, content {content_hash}", stressed.cases.len()));
        console::say(&format!("judged: {}", stressed.verdict.sentence));
    }
    Ok(DONE)
}
