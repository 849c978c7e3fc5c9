//! One question: its drive in words, as JSON, as a picture.

use hairpin::feasibility::steering::shooting::flat::Status as ArcStatus;
use hairpin::feasibility::steering::shooting::solve::{Method, Solution};
use hairpin::verification::DriveReplay;
use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;
use hairpin_formats::steering::{Asked, Frame, Piece, Status, svg};
use hairpin_jobs::steer::{Answered, Question, Remedies, Vehicle, goal_in_the_map, in_frame, pieces, stretches};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use crate::args::{Steer, SteerFrame};
use crate::console;
use crate::exit::{DONE, INCONCLUSIVE, NOTHING_FEASIBLE};

pub(super) fn run(steer: &Steer, vehicle: &Vehicle, to: &str, watch: &dyn Watch) -> Result<u8, Problem> {
    let asked = question(steer, to)?.asked();
    let answered = vehicle.answer(&asked);
    let code = match answered.status {
        Status::Ok => DONE,
        Status::Infeasible => NOTHING_FEASIBLE,
        Status::NotConverged | Status::TimeLimit => INCONCLUSIVE,
        Status::Invalid => {
            let field = answered.limit.map_or("", |(limit, _)| limit);
            let speeds = ["speed", "v0", "vf", "cruise", "acceleration"];
            return Err(Problem::input(if speeds.contains(&field) {
                format!(
                    "--{field}: these speeds make no drive: v0 and vf go up to the cruising speed, and one must be more than 0"
                )
            } else {
                format!("--to {to}: `{field}` is beyond what can be planned (1e6 m, 1e6 rad)")
            }));
        }
    };
    if let (Some(plot), Some((solution, _))) = (&steer.plot, &answered.drive) {
        let picture = svg(&stretches(solution, &asked), &[[0.0; 3], asked.goal]).map_err(Problem::input)?;
        refuse_own(plot)?;
        atomic::write(plot, picture.as_bytes())?;
    }
    vehicle.write_states(&asked, &answered, [steer.path.as_deref(), steer.wheels.as_deref()], watch)?;
    let remedies = vehicle.remedies(&asked, &answered);
    if steer.json {
        let mut object = object(vehicle, &answered, &asked, code);
        add(&mut object, json!(vehicle.summary(&asked, &answered)));
        add_remedies(&mut object, &remedies, &asked);
        console::say(&object.to_string());
    } else {
        words(vehicle, &answered, &asked).iter().for_each(|line| console::say(line));
        in_words(&remedies, &asked).iter().for_each(|line| console::say(line));
    }
    Ok(code)
}

/// The question of the flags: `--from` and `--to` are poses of one map.
fn question(steer: &Steer, to: &str) -> Result<Question, Problem> {
    Ok(Question {
        from: steer.from.as_deref().map(|from| state("--from", from)).transpose()?,
        to: state("--to", to)?,
        free_end: to.split(',').count() == 3,
        frame: match steer.frame {
            SteerFrame::Enu => Frame::Enu,
            SteerFrame::Ned => Frame::Ned,
        },
        direction: steer.direction,
        direction_end: steer.direction_end,
        max_curvature: steer.max_curvature,
        tolerance_m: steer.tolerance_m,
    })
}

/// X,Y,YAW or X,Y,YAW,CURVATURE.
fn state(flag: &str, text: &str) -> Result<[f64; 4], Problem> {
    let refuse = || Problem::input(format!("{flag} {text}: must be X,Y,YAW or X,Y,YAW,CURVATURE in m, rad, 1/m"));
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|cell| cell.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    match numbers.ok_or_else(refuse)?[..] {
        [x, y, yaw] => Ok([x, y, yaw, 0.0]),
        [x, y, yaw, curvature] => Ok([x, y, yaw, curvature]),
        _ => Err(refuse()),
    }
}

/// Puts the keys of `more` behind those of `object`.
fn add(object: &mut Value, more: Value) {
    if let (Value::Object(object), Value::Object(more)) = (object, more) {
        object.extend(more);
    }
}

/// What would help, as JSON: goals as `--to` takes them.
fn add_remedies(object: &mut Value, remedies: &Remedies, asked: &Asked) {
    let metres = [
        ("detour", remedies.detour),
        ("with_reversals_m", remedies.with_reversals_m),
        ("with_turns_m", remedies.with_turns_m),
    ];
    for (key, value) in metres {
        if let Some(value) = value {
            object[key] = value.into();
        }
    }
    if let Some((after_m, at)) = &remedies.standstill {
        let [x, y, yaw] = in_frame(asked.frame, [at.x, at.y, at.yaw]);
        object["standstill"] = json!({ "after_m": after_m, "x": x, "y": y, "yaw": yaw });
    }
    for (key, goal) in [("nearest_goal", &remedies.nearest), ("goal_on_the_way", &remedies.on_the_way)] {
        if let Some(goal) = goal {
            let [x, y, yaw, kf] = goal_in_the_map(asked, goal);
            object[key] = json!({ "x": x, "y": y, "yaw": yaw, "kf": kf });
        }
    }
}

/// What would help, in words.
fn in_words(remedies: &Remedies, asked: &Asked) -> Vec<String> {
    let flags = [("--reversals", remedies.with_reversals_m), ("--turns", remedies.with_turns_m)];
    let mut lines: Vec<String> = flags
        .into_iter()
        .filter_map(|(flag, metres)| Some(format!("{flag} would do it in {:.3} m", metres?)))
        .collect();
    if let Some((after_m, at)) = &remedies.standstill {
        let [x, y, yaw] = in_frame(asked.frame, [at.x, at.y, at.yaw]);
        lines.push(format!("the ground ends the drive after {after_m:.3} m, at {x:.3},{y:.3},{yaw:.3}"));
    }
    let goals = [
        ("nearest goal that one arc leads to", &remedies.nearest),
        ("farthest feasible goal on the way there", &remedies.on_the_way),
    ];
    for (what, goal) in goals {
        if let Some(goal) = goal {
            let [x, y, yaw, kf] = goal_in_the_map(asked, goal);
            lines.push(format!("{what}: --to {x:.4},{y:.4},{yaw:.4},{kf:.4}"));
        }
    }
    lines
}

fn method(method: Method) -> &'static str {
    match method {
        Method::SingleArc => "single arc",
        Method::TurnDriveTurn => "turn, drive, turn",
        Method::Clothoids => "lines, arcs and clothoids",
    }
}

/// What a single arc would break, where something else had to do.
fn arc_lacks(solution: &Solution) -> Option<(&'static str, f64)> {
    match solution.arc {
        Some(ArcStatus::Infeasible { limit, excess }) if solution.method != Method::SingleArc => {
            Some((limit.name(), excess))
        }
        _ => None,
    }
}

fn words(vehicle: &Vehicle, answered: &Answered, asked: &Asked) -> Vec<String> {
    let left = asked.frame.left();
    let mut lines = Vec::new();
    let status = answered.status;
    let limit = answered.limit.map_or(String::new(), |(limit, excess)| {
        excess.map_or(format!(": {limit}"), |excess| format!(": {limit} exceeded by {excess:.6}"))
    });
    let place = answered
        .near
        .as_ref()
        .map_or(String::new(), |near| format!(" m ({}, after {:.3} m)", near.place, near.after_m));
    let spare = answered.near.as_ref().and_then(|near| near.spare);
    let family = vehicle.pace.control.name();
    let place = place
        + &spare.map_or(String::new(), |spare| format!("; {family} has {spare} parameters to spare for a way around"));
    let limit = limit + &place;
    let name = &vehicle.rover.name;
    let Some((solution, replay)) = &answered.drive else {
        lines.push(format!("{status} ({name}){limit}"));
        if let Some([k0, kf]) = answered.nearest {
            lines.push(format!(
                "nearest that is feasible: curvature {} at the start, {} at the goal",
                left * k0,
                left * kf
            ));
        }
        return lines;
    };
    let mut table =
        vec![["segment", "kind", "direction", "length_m", "turn_rad", "curvature"].map(str::to_owned).to_vec()];
    for (number, piece) in pieces(solution, asked.k0).iter().enumerate() {
        table.push(match piece {
            Piece::Arc { length_m, curvature, direction } => {
                let most = curvature.iter().rposition(|a| *a != 0.0).unwrap_or(0);
                let bends: Vec<String> = curvature[..=most].iter().map(|a| format!("{:.6}", left * a)).collect();
                vec![
                    number.to_string(),
                    "arc".into(),
                    format!("{direction:+}"),
                    format!("{length_m:.6}"),
                    "–".into(),
                    bends.join(" "),
                ]
            }
            Piece::Turn { angle_rad } => {
                let angle = format!("{:.6}", left * angle_rad);
                vec![number.to_string(), "turn".into(), "–".into(), "–".into(), angle, "–".into()]
            }
        });
    }
    lines.extend(console::table(&table).lines().map(str::to_owned));
    let DriveReplay { error: [.., yaw], error_curvature, max_curvature, max_curvature_rate, length, reversals, .. } =
        replay;
    lines.push(format!(
        "{status} ({name}, {}){limit}: {length:.3} m, {reversals} reversals, |κ| ≤ {max_curvature:.4} 1/m, |κ'| ≤ {max_curvature_rate:.4} 1/m²; \
         replayed: {:.1e} m, {:.1e} rad, {:.1e} 1/m off; {:.1} µs, {} iterations",
        method(solution.method),
        answered.missed_m().unwrap_or_default(),
        yaw.abs(),
        error_curvature.abs(),
        answered.solving.as_secs_f64() * 1e6,
        solution.iterations
    ));
    if let Some((limit, excess)) = arc_lacks(solution) {
        lines.push(format!("a single arc would exceed {limit} by {excess:.4}"));
    }
    lines
}

fn object(vehicle: &Vehicle, answered: &Answered, asked: &Asked, code: u8) -> Value {
    let left = asked.frame.left();
    let (limit, excess) = answered.limit.map_or((None, None), |(limit, excess)| (Some(limit), excess));
    let mut object = json!({
        "robot": vehicle.rover.name,
        "status": answered.status,
        "limit": limit,
        "excess": excess,
        "bounds": { "curvature_1_m": answered.bounds.most, "curvature_rate_1_m2": answered.bounds.most_rate },
        "time_us": answered.solving.as_secs_f64() * 1e6,
        "exit_code": code,
    });
    if let Some(near) = &answered.near {
        object["keep_out"] = json!({ "place": near.place, "depth_m": near.depth, "after_m": near.after_m });
        if let Some(spare) = near.spare {
            object["keep_out"]["spare_parameters"] = spare.into();
        }
    }
    if let Some([k0, kf]) = answered.nearest {
        object["nearest"] = json!({ "k0": left * k0, "kf": left * kf });
    }
    let Some((solution, replay)) = &answered.drive else { return object };
    let segments: Vec<Value> = pieces(solution, asked.k0)
        .iter()
        .map(|piece| match piece {
            Piece::Arc { length_m, curvature, direction } => {
                json!({ "kind": "arc", "direction": direction, "length_m": length_m, "curvature": curvature.map(|a| left * a) })
            }
            Piece::Turn { angle_rad } => json!({ "kind": "turn", "turn_rad": left * angle_rad }),
        })
        .collect();
    let [x, y, yaw] = replay.error;
    object["method"] = method(solution.method).into();
    object["iterations"] = solution.iterations.into();
    object["length_m"] = replay.length.into();
    object["reversals"] = replay.reversals.into();
    object["segments"] = segments.into();
    object["errors"] =
        json!({ "x_m": x, "y_m": left * y, "yaw_rad": left * yaw, "curvature_1_m": left * replay.error_curvature });
    object["max_curvature_1_m"] = replay.max_curvature.into();
    object["max_curvature_rate_1_m2"] = replay.max_curvature_rate.into();
    object["replay_steps"] = replay.steps.into();
    object["replay_left_out_m"] = replay.left_out.into();
    if let Some((limit, excess)) = arc_lacks(solution) {
        object["single_arc"] = json!({ "limit": limit, "excess": excess });
    }
    object
}
