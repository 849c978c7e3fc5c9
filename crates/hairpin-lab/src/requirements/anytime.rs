//! Limits of time: what is there when it is over, and that it is said.

use std::time::Duration;

use hairpin::trajectory::drive::Planar;
use hairpin_formats::steering::Status;
use hairpin_jobs::steer::Vehicle;

use super::check::{Check, Test};
use super::subject::{Subject, asked, missing};

/// The source's limit, ms.
const LIMIT_MS: f64 = 50.0;
/// Limits that few or none can keep, ms.
const TIGHT_MS: [f64; 4] = [0.0, 0.02, 0.1, 0.5];
/// Looks at a query that overran: the least counts, since machines pause as they like.
const LOOKS: usize = 3;
/// What a limit may be overrun by, ms.
const OVERRUN_MS: f64 = 1.0;
/// Goals.
const GOALS: usize = 30;

/// What came of all goals under one limit.
#[derive(Default)]
struct Under {
    asked: usize,
    solved: usize,
    /// Stopped, and said so.
    limited: usize,
    /// Over the limit, neither solved nor said to be stopped.
    unsaid: usize,
    /// A drive came back that ends nearer to the goal than the start is.
    nearer: usize,
    overrun_ms: f64,
}

/// R14 and R15.
pub(super) fn within(subject: &Subject) -> [Test; 2] {
    let goals = subject.goals(&subject.late, GOALS, 37).unwrap_or_default();
    let usual = under(subject, &goals, LIMIT_MS);
    let tight = TIGHT_MS.map(|limit| (limit, under(subject, &goals, limit)));
    let near_optimal = Check::new(
        format!(
            "at {LIMIT_MS} ms {} of {} met, {} end nearer than they began; {}",
            usual.solved,
            usual.asked,
            usual.nearer,
            tight.each_ref().map(|(limit, under)| format!("at {limit} ms {} nearer", under.nearer)).join(", ")
        ),
        "all nearer at 50 ms",
        !goals.is_empty() && usual.nearer == usual.asked,
    );
    let overrun = tight.iter().map(|(_, under)| under.overrun_ms).fold(usual.overrun_ms, f64::max);
    let limited: usize = tight.iter().map(|(_, under)| under.limited).sum();
    let unsaid: usize = tight.iter().map(|(_, under)| under.unsaid).sum::<usize>() + usual.unsaid;
    let said = Check::new(
        format!(
            "{}; {unsaid} ran over it unsaid; a limit is overrun by {overrun:.2} ms at most",
            tight
                .each_ref()
                .map(|(limit, under)| format!(
                    "at {limit} ms {} say time_limit, {} were solved",
                    under.limited, under.solved
                ))
                .join(", ")
        ),
        format!("all that run over it say so, within {OVERRUN_MS} ms"),
        limited > 0 && unsaid == 0 && overrun <= OVERRUN_MS,
    );
    [
        Test::new("R14", "R-2", "rough ground with dynamics, 50 ms and less: the best drive so far", near_optimal),
        Test::new("R15", "R-17", "time that is over is reported", said),
    ]
}

fn under(subject: &Subject, goals: &[(Planar, Planar)], limit_ms: f64) -> Under {
    let limit = Duration::from_secs_f64(limit_ms * 1e-3);
    let vehicle = Vehicle::on(subject.late.clone(), Some(subject.ground.clone()), Some(limit));
    let mut found = Under { asked: goals.len(), ..Under::default() };
    for (start, goal) in goals {
        let asked = asked(start, goal);
        let mut answered = vehicle.answer(&asked);
        for _ in 1..LOOKS {
            if answered.solving <= limit {
                break;
            }
            let again = vehicle.answer(&asked);
            if again.solving < answered.solving {
                answered = again;
            }
        }
        let over_ms = 1e3 * answered.solving.as_secs_f64() - limit_ms;
        found.overrun_ms = found.overrun_ms.max(over_ms);
        match answered.status {
            Status::Ok => found.solved += 1,
            Status::TimeLimit => found.limited += 1,
            _ => found.unsaid += usize::from(answered.solving > limit),
        }
        if let Some((_, replay)) = &answered.drive {
            let [x, y, yaw] = replay.error;
            found.nearer += usize::from(libm::hypot(x, y) + yaw.abs() < missing(start, goal));
        }
    }
    found
}
