//! A score of one's own that steers the search: `cargo run --example 05_own_score`.

use std::error::Error;
use std::sync::Arc;

use hairpin::campaign::attachments::Attached;
use hairpin::campaign::generate::Known;
use hairpin::campaign::user_score::{LegFacts, LegScorer};
use hairpin::campaign::{Case, OwnSimulator, Setup, Stop, UserCode, generate, vary};
use hairpin_formats::scenario::setup_for;

/// Legs that climb are worth what they climb, the faster the more.
struct Climb;

impl UserCode for Climb {
    fn trouble(&self) -> Option<String> {
        None
    }

    fn try_out(&self) -> Result<(), String> {
        Ok(())
    }

    fn stop(&self) {}
}

impl LegScorer for Climb {
    fn own_and_left(&self, legs: &[LegFacts]) -> Vec<[f64; 2]> {
        legs.iter().map(|leg| [leg.climb_m.max(0.0) * leg.v_in_m_s, 0.0]).collect()
    }
}

fn climbed(setup: &Setup) -> f64 {
    let mut cases: Vec<Case> = Vec::new();
    generate(setup, &Known::default(), &OwnSimulator, &Stop::never(), &mut |found, _| cases.extend_from_slice(found));
    let of = |case: &Case| case.waypoints.windows(2).map(|leg| (leg[1].z - leg[0].z).max(0.0)).sum::<f64>();
    cases.iter().map(of).sum::<f64>() / cases.len() as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let small = ("generate.search.cases".to_owned(), "5".to_owned());
    let mut setup = setup_for("demo-quadrotor", &[small])?;
    println!("by `{}`: {:.1} m of climb in the mean", setup.scenario.score(), climbed(&setup));
    let scenario = vary::apply(&setup.scenario, &[("generate.score".into(), "python:climb.py".into())])?;
    let climb: Arc<dyn LegScorer> = Arc::new(Climb);
    let (name, bytes) = ("climb.py".to_owned(), Vec::new().into());
    let attachments = Arc::make_mut(&mut setup.attachments);
    attachments.user_score = Some(Attached { read: climb, bytes, given: name.clone(), name });
    let own = setup.changed(scenario)?;
    println!("by climb times speed: {:.1} m of climb in the mean", climbed(&own));
    Ok(())
}
