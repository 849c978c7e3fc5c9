//! What a program loses where a language's writer bounds its speeds, in words for its head and for who exports it.

use hairpin::trajectory::program::{Motion, Program};

use crate::decimal::decimal;

/// Names of the speeds of straight moves and arcs that are above `most` m/s, each once, in the order of the program;
/// what has none is told by its number.
pub(crate) fn names(program: &Program, most: f64) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for one in program.moves.iter().filter(|one| matches!(one.motion, Motion::Linear(_) | Motion::Circular { .. })) {
        let speed = &one.speed;
        let name = speed.name.clone().unwrap_or_else(|| format!("{} mm/s", decimal(speed.tcp * 1000.0, 3)));
        // A move that is timed keeps its time.
        if speed.tcp > most && one.duration.is_none() && !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// That moves at speeds of these names are written at `most` m/s; `None` where there are none.
pub fn sentence(names: &[String], most: f64) -> Option<String> {
    let most = decimal(most, 3);
    (!names.is_empty()).then(|| {
        format!(
            "Not as programmed: straight moves and arcs at {} go at {most} m/s, the most that is written here",
            names.join(", ")
        )
    })
}
