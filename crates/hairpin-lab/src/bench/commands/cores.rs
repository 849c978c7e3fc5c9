//! Two cores beside one: the same commands with one thread and with two, by the clock on the wall. Each takes five
//! seconds or more with one.

use super::campaigns::{BEAM, CAMPAIGN, QUADROTOR, flown};
use super::line::Line;
use super::row::{Figure, Row};

pub(super) fn rows() -> Vec<Row> {
    let plans = Line::new("hairpin generate campaign.toml --set generate.search.cases=4000 --out plans --json");
    let proofs = Line::new("hairpin generate quadrotor.toml --set generate.search.cases=500 --out proofs --json");
    vec![
        Row {
            lines: both("generate beam.toml --set generate.search.cases=10000 --out beam", Some("beam")),
            ..twice("generate").reading([BEAM])
        },
        Row { lines: both("execute plans", None), ..twice("execute").reading([CAMPAIGN]).after(plans.making("plans")) },
        Row {
            lines: [1, 2].into_iter().flat_map(judged).collect(),
            ..twice("judge").reading([CAMPAIGN]).after(flown(4000, "flown-4000"))
        },
        Row {
            lines: both("verify proofs", None),
            ..twice("verify").reading([QUADROTOR]).after(proofs.making("proofs"))
        },
        Row {
            lines: both(
                "steer generic --queries anywhere-100000.csv --reversals --out answers.csv",
                Some("answers.csv"),
            ),
            ..twice("steer").reading(["anywhere-100000.csv"]).long()
        },
    ]
}

/// Each from another reference than the one before: what was measured then is no answer, and rows are read.
fn judged(threads: u32) -> [Line; 2] {
    ["nearest-leg", "leg"]
        .map(|from| line(&format!("judge flown-4000 --set spec.deviation.from={from}"), None, threads))
}

/// One thread, then two.
fn both(typed: &str, makes: Option<&'static str>) -> Vec<Line> {
    [1, 2].map(|threads| line(typed, makes, threads)).to_vec()
}

fn line(typed: &str, makes: Option<&'static str>, threads: u32) -> Line {
    Line { makes, ..Line::new(format!("hairpin {typed} --threads {threads} --json")) }
}

/// The first half of its lines has one thread, the second half the same with two.
fn twice(verb: &str) -> Row {
    let row = Row::new(format!("twice-{verb}"), format!("{verb} on two cores"), Vec::new(), |seen| {
        let (one, two) = seen.lines.split_at(seen.lines.len() / 2);
        let [one, two] = [one, two].map(|lines| lines.iter().map(|line| line.wall_s).sum::<f64>());
        Ok(vec![Figure::new("as fast as on one", "×", one / two).at_least(1.85)])
    });
    Row { cores: 2, ..row }
}
