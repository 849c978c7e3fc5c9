//! Arcs clocked on the controller.

use std::collections::BTreeSet;

use hairpin::trajectory::program::{JointTarget, NO_EXTERNAL, PoseTarget, Speed, Tool, WorkObject};
use nalgebra::Isometry3;

use super::super::{Clocking, LogError, Options, RapidError, arc_clock, read, read_log};
use super::assert_clear;

fn points(count: usize) -> Vec<PoseTarget> {
    (0..count).map(|i| PoseTarget::unnamed(Isometry3::translation(0.3 + 0.01 * i as f64, 0.0, 0.4))).collect()
}

fn clock(count: usize, arcs: &[(usize, usize)], start: usize) -> Result<super::super::Clocked, RapidError> {
    arc_clock(&Clocking {
        name: "ArcClock",
        tool: &Tool::flange(),
        work_object: &WorkObject::base(),
        points: &points(count),
        arcs,
        home: &JointTarget { name: Some("home".into()), joints: [0.0; 6], external: NO_EXTERNAL },
        start,
        configured: true,
        at_start: None,
        speed: &Speed::predefined("v1000").unwrap(),
        header: &[],
    })
}

/// Every arc in turn, on graphs with dead ends and parts of their own: only arcs are driven, all that can be are, and
/// the walk comes back.
#[test]
fn every_arc_is_driven_and_only_arcs_are() {
    let complete: Vec<_> = (0..6).flat_map(|a| (0..6).map(move |b| (a, b))).filter(|(a, b)| a != b).collect();
    let ring = vec![(0, 1), (1, 2), (2, 3), (3, 0), (1, 3), (4, 5), (5, 4), (2, 5)];
    for (arcs, start, lost) in [(complete, 2, 0), (ring, 0, 3), (vec![(0, 1)], 0, 1), (vec![], 3, 0)] {
        let clocked = clock(6, &arcs, start).unwrap();
        let walk = &clocked.walk;
        assert_eq!((walk[0], walk[walk.len() - 1], clocked.left_out.len()), (start, start, lost), "{arcs:?} {walk:?}");
        let driven: BTreeSet<_> = walk.windows(2).map(|pair| (pair[0], pair[1])).collect();
        let left_out: BTreeSet<_> = clocked.left_out.iter().copied().collect();
        assert!(driven.is_disjoint(&left_out));
        assert_eq!(driven.union(&left_out).copied().collect::<BTreeSet<_>>(), arcs.iter().copied().collect());
    }
    assert_eq!(clock(3, &[(0, 3)], 0), Err(RapidError::Point { index: 3, count: 3 }));
}

#[test]
fn the_module_drives_the_walk() {
    let clocked = clock(3, &[(0, 1), (1, 2), (2, 0), (1, 0)], 0).unwrap();
    let module = read(clocked.text.as_bytes(), &Options::default()).unwrap();
    assert_clear(&module);
    let moves = &module.program.moves;
    assert_eq!(moves.len(), clocked.walk.len() + 2);
    for (m, point) in moves[1..].iter().zip(&clocked.walk) {
        let x = m.motion.end().unwrap().pose.translation.x;
        assert!((x - (0.3 + 0.01 * *point as f64)).abs() < 1e-12);
        assert!(m.zone.fine);
    }
    assert!(clocked.text.contains("MoveL there, v1000, fine, tool0 \\WObj:=wobj0;\r\n"));
    assert!(clocked.text.is_ascii());
}

#[test]
fn the_log_becomes_the_table() {
    let times = read_log(b"arc_ms;3\r\n0;1;412.000\r\n1;2;300\r\n0;1;414\r\n\r\n").unwrap();
    assert_eq!(times.arcs[&(0, 1)], (413.0, 2));
    assert_eq!(times.csv(), ",413,\n,,300\n,,\n");
    for (log, error) in [
        (&b"ms;3\n"[..], LogError::Head { found: "ms;3".into() }),
        (b"", LogError::Head { found: String::new() }),
        (b"arc_ms;99999999999\n", LogError::Head { found: "arc_ms;99999999999".into() }),
        (b"arc_ms;3\n", LogError::Empty),
        (b"arc_ms;3\n0;1;2\n0;3;4\n", LogError::Line { line: 3, found: "0;3;4".into(), last: 2 }),
        (b"arc_ms;3\n0;1;NaN\n", LogError::Line { line: 2, found: "0;1;NaN".into(), last: 2 }),
        (b"arc_ms;3\n0;1\n", LogError::Line { line: 2, found: "0;1".into(), last: 2 }),
    ] {
        assert_eq!(read_log(log), Err(error));
    }
}
