//! Tracks in the format of the TUM RGB-D benchmark: `t x y z qx qy qz qw`.

use nalgebra::Point3;

use super::super::error::Fault;
use super::super::log::{Clock, LogFrame, Logged, LoggedMotion, Sample, ToldTo};
use super::super::planned::source;
use super::super::samples::Budget;
use super::checks::{FARTHEST_M, after, attitude, step};
use crate::quote;

const COLUMNS: [&str; 8] = ["t", "x", "y", "z", "qx", "qy", "qz", "qw"];

pub(in super::super) fn read_tum(text: &str, name: &str) -> Result<Logged, Fault> {
    let mut budget = Budget::default();
    let (mut samples, mut told_to_m): (Vec<Sample>, Option<f64>) = (Vec::new(), None);
    for (line, content) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let content = content.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        budget.take()?;
        let [t_s, x, y, z, qx, qy, qz, qw] = numbers(content, line)?;
        let steps = content.split_whitespace().skip(1).take(3).map(step);
        told_to_m = steps.chain(told_to_m).reduce(f64::min);
        after(t_s, samples.last().map(|sample| sample.t_s), line)?;
        let attitude = Some(attitude(qw, [qx, qy, qz], line)?);
        samples.push(Sample { t_s, p_m: Point3::new(x, y, z), attitude, v_m_s: None, accuracy_m: None });
    }
    let told_to = told_to_m.map(ToldTo::Decimal);
    let motion = LoggedMotion { told_to, ..LoggedMotion::of(name, source(name), samples) };
    Ok(Logged {
        format: "TUM",
        clock: Clock::File,
        frame: LogFrame::Untold,
        motions: if motion.samples.is_empty() { Vec::new() } else { vec![motion] },
        joints: Vec::new(),
        progress: Vec::new(),
        events: Vec::new(),
        dropouts: Vec::new(),
        notes: Vec::new(),
    })
}

fn numbers(content: &str, line: usize) -> Result<[f64; 8], Fault> {
    let mut numbers = [0.0; 8];
    let mut words = content.split_whitespace();
    for (column, number) in COLUMNS.iter().zip(&mut numbers) {
        let word = words.next().ok_or_else(|| wrong_width(content, line))?;
        let parsed = word.parse::<f64>().ok().filter(|number| number.is_finite());
        *number = parsed.ok_or_else(|| {
            Fault::line(line, format!("{column} is `{}`, must be a finite number", quote::cell(word)))
        })?;
        if matches!(*column, "x" | "y" | "z") && number.abs() > FARTHEST_M {
            return Err(Fault::line(line, format!("{column} is {number} m, must be within {FARTHEST_M:e} m")));
        }
    }
    if words.next().is_some() { Err(wrong_width(content, line)) } else { Ok(numbers) }
}

fn wrong_width(content: &str, line: usize) -> Fault {
    let found = content.split_whitespace().count();
    Fault::line(line, format!("{found} numbers, must be the eight of `t x y z qx qy qz qw`"))
}
