//! Modules as cells have them, programs as they are written, both ways, and what is no program at all.

mod arguments;
mod broken;
mod cells;
mod clocks;
mod predefined;
mod round_trip;
mod several;
mod unmodelled;
mod written;

use hairpin::trajectory::program::{Motion, Move, PoseTarget};

use super::{Options, read};
use crate::listing::{Class, Module};

/// Reads a module of which `body` is the inside.
fn inside(body: &str) -> Module {
    read(format!("MODULE M\n{body}\nENDMODULE\n").as_bytes(), &Options::default()).unwrap()
}

/// Reads a module whose `main` is `body`, with two targets and a tool.
fn main_of(body: &str) -> Module {
    inside(&format!(
        "CONST robtarget p10:=[[500,0,600],[0.707107,0,0.707107,0],[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST robtarget p20:=[[400,-200,500],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST jointtarget home:=[[0,-10,20,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         PROC main()\n{body}\nENDPROC"
    ))
}

/// Line of the first line of `main_of`'s body.
const FIRST: usize = 6;

fn pose(m: &Move) -> &PoseTarget {
    m.motion.end().unwrap()
}

/// Position of the end, whole micrometres.
fn place(m: &Move) -> [i64; 3] {
    let p = pose(m).pose.translation.vector * 1e6;
    [p.x.round() as i64, p.y.round() as i64, p.z.round() as i64]
}

/// All lines are understood or harmless.
fn assert_clear(module: &Module) {
    let unclear: Vec<_> = module.unclear().collect();
    assert!(unclear.is_empty() && module.mistakes.is_empty(), "{unclear:?} {:?}", module.mistakes);
    assert_eq!(module.certain, module.program.moves.len());
}

/// The one line that is not understood, and why.
fn unclear(module: &Module) -> (usize, &str) {
    let unclear: Vec<_> = module.unclear().collect();
    assert_eq!(unclear.len(), 1, "{unclear:?}");
    (unclear[0].0, &unclear[0].1.what)
}

fn is_linear(m: &Move) -> bool {
    matches!(m.motion, Motion::Linear(_))
}

fn classes(module: &Module, lines: impl IntoIterator<Item = usize>) -> Vec<Class> {
    lines.into_iter().map(|line| module.class(line)).collect()
}
