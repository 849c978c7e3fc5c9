//! Nonsense in, refusals out: states, controls and vehicles that cannot be, and problems without an answer.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::flat::{self, Control, Limit, Status as Flat};
use hairpin::feasibility::steering::shooting::rough::{self, Settings};
use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Query};
use hairpin::robot::rover::{FourWheel, RoverDescription, Suspension, Unsettled};
use hairpin::trajectory::drive::Planar;
use hairpin::world::terrain::Flat as Level;
use hairpin_formats::library;
use hairpin_formats::steering::{Piece, Status, Stored, parse, parse_stored, stored_text};
use hairpin_jobs::Problem;
use hairpin_jobs::steer::Vehicle;
use nalgebra::Vector3;

use super::check::{Check, Test};
use super::subject::{Subject, asked};
use crate::drives::BOUNDS;

const SOMEWHERE: Goal = Goal { x: 4.0, y: 1.0, yaw: 0.5, curvature: 0.0 };

/// Cases by name, and those that were not refused by the name of what is wrong with them.
#[derive(Default)]
struct Refusals {
    asked: usize,
    missed: Vec<String>,
}

impl Refusals {
    /// `found` is the field that was named, if the case was refused.
    fn take(&mut self, case: String, field: &str, found: Option<&str>) {
        self.asked += 1;
        if !found.is_some_and(|found| found.contains(field)) {
            self.missed.push(format!("{case}: {}", found.unwrap_or("accepted")));
        }
    }

    fn test(self, id: &'static str, requirement: &'static str, what: &str) -> Test {
        let refused = self.asked - self.missed.len();
        let missed = if self.missed.is_empty() { String::new() } else { format!("; not: {}", self.missed.join(", ")) };
        let measured = format!("{refused} of {} refused by the name of what is wrong{missed}", self.asked);
        Test::new(id, requirement, what, Check::new(measured, "all", self.missed.is_empty()))
    }
}

/// R16.
pub(super) fn states(subject: &Subject) -> Result<Test, Problem> {
    let mut refusals = Refusals::default();
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e7, -1e300] {
        for field in ["x", "y", "yaw", "k0", "kf"] {
            let mut goal = SOMEWHERE;
            let mut start_curvature = 0.0;
            match field {
                "x" => goal.x = value,
                "y" => goal.y = value,
                "yaw" => goal.yaw = value,
                "k0" => start_curvature = value,
                _ => goal.curvature = value,
            }
            let refused = Query::new(start_curvature, goal, &BOUNDS).err();
            refusals.take(format!("{field} = {value}"), field, refused.map(|refusal| refusal.field));
        }
    }
    // Curvatures beyond the vehicle's.
    for (field, start, end) in [("k0", 1.001, 0.0), ("kf", 0.0, -1.001)] {
        let refused = Query::new(start, Goal { curvature: end, ..SOMEWHERE }, &BOUNDS).err();
        refusals.take(format!("{field} beyond the vehicle"), field, refused.map(|refusal| refusal.field));
    }
    // In files, by column.
    let head = "id,sx,sy,syaw,x,y,yaw,k0,kf,v0,vf,direction,max_curvature,tolerance_m\n";
    for column in head.trim_end().split(',').skip(1) {
        for text in ["nan", "-inf", "one"] {
            let cells = head.trim_end().split(',').map(|name| if name == column { text } else { "0.1" });
            let row = cells.collect::<Vec<_>>().join(",");
            let queries = parse(format!("{head}{row}\n").as_bytes()).map_err(Problem::input)?;
            let wrong = queries.rows.first().and_then(|row| row.asked.as_ref().err());
            refusals.take(format!("column {column} = {text}"), column, wrong.map(|wrong| wrong.column.as_str()));
        }
    }
    // On the ground: states beside the map, and none at all.
    let vehicle = Vehicle::on(subject.rocky8.clone(), Some(subject.ground.clone()), None);
    let (low, high) = subject.ground.extent();
    let inside = Planar { x: 0.5 * (low[0] + high[0]), y: 0.5 * (low[1] + high[1]), ..Planar::default() };
    let goal = Planar { x: inside.x + 3.0, ..inside };
    let nowhere = Planar { x: f64::NAN, ..inside };
    for (case, start, goal, field) in [
        ("a start beside the map", Planar { x: high[0] + 10.0, ..inside }, goal, "map_edge"),
        ("a goal beside the map", inside, Planar { x: high[0] + 10.0, ..goal }, "map_edge"),
        ("a start at NaN", nowhere, goal, "x"),
        ("a start with no heading", Planar { yaw: f64::NAN, ..inside }, goal, "x"),
        ("a goal at NaN", inside, nowhere, "x"),
    ] {
        let answered = vehicle.answer(&asked(&start, &goal));
        let refused = matches!(answered.status, Status::Invalid | Status::Infeasible);
        refusals.take(case.into(), field, answered.limit.filter(|_| refused).map(|(limit, _)| limit));
    }
    Ok(refusals.test(
        "R16",
        "R-13",
        "states with NaN, infinities, nonsense, and beyond the vehicle's and the map's limits",
    ))
}

/// R17.
pub(super) fn controls() -> Test {
    let mut refusals = Refusals::default();
    let drive = |length_m: f64, a: [f64; 6]| Stored {
        start: [0.0; 4],
        goal: [SOMEWHERE.x, SOMEWHERE.y, SOMEWHERE.yaw, 0.0],
        reversals: false,
        pieces: vec![Piece::Arc { length_m, curvature: a, direction: 1 }, Piece::Turn { angle_rad: 0.5 }],
    };
    let bent = |a: f64| [0.1, a, 0.0, 0.0, 0.0, 0.2];
    let plausible = stored_text("", &[drive(2.0, bent(0.3))]);
    let read = |text: &str| parse_stored(text).err().map(|refused| refused.field);
    refusals.take("a plausible drive".into(), "none", Some(read(&plausible).unwrap_or("none")));
    for (case, text, field) in [
        ("a coefficient of NaN", stored_text("", &[drive(2.0, bent(f64::NAN))]), "curvature"),
        ("an infinite coefficient", stored_text("", &[drive(2.0, bent(f64::INFINITY))]), "curvature"),
        ("a coefficient of 1e7", stored_text("", &[drive(2.0, bent(1e7))]), "curvature"),
        ("a negative length", stored_text("", &[drive(-2.0, bent(0.3))]), "length"),
        ("an endless length", stored_text("", &[drive(f64::INFINITY, bent(0.3))]), "length"),
        ("seven coefficients", plausible.replace(" 0.2|", " 0.2 0.2|"), "segment"),
        ("no direction", plausible.replace("arc +1", "arc 0"), "direction"),
        ("an unknown control", plausible.replace("turn 0.5", "skip 0.5"), "segment"),
        ("a turn by nothing", plausible.replace("turn 0.5", "turn nan"), "turn"),
    ] {
        refusals.take(case.into(), field, read(&text));
    }
    // Controls that cannot do what is asked of them say which of it.
    let query = Query { start_curvature: 0.0, goal: SOMEWHERE };
    let with = |control, bounds: &Curvatures, query: &Query| {
        let settings = flat::Settings { control, ..flat::Settings::default() };
        match flat::forward(query, bounds, &settings).status {
            Flat::Ok => None,
            Flat::NotConverged { .. } => Some("residual"),
            Flat::Infeasible { limit: Limit::Curvature, .. } => Some("curvature"),
            Flat::Infeasible { limit: Limit::CurvatureRate, .. } => Some("curvature rate"),
            Flat::Infeasible { limit: Limit::Yaw, .. } => Some("yaw"),
            Flat::Infeasible { limit: Limit::EndCurvature, .. } => Some("end curvature"),
        }
    };
    refusals.take("a circle to a foreign heading".into(), "yaw", with(Control::Arc, &BOUNDS, &query));
    let behind = Query { goal: Goal { x: -3.0, y: 0.0, yaw: 0.0, curvature: 0.0 }, ..query };
    refusals.take("a circle straight backwards".into(), "residual", with(Control::Arc, &BOUNDS, &behind));
    for most in [f64::NAN, -1.0, 0.0] {
        let none = Curvatures { most, most_rate: most };
        refusals.take(format!("bounds of {most}"), "", with(Control::Quintic, &none, &query));
    }
    refusals.test(
        "R17",
        "R-14",
        "drives with NaN, infinities, negative lengths, unknown or too many controls; controls that cannot",
    )
}

/// What is wrong with a vehicle, what of the shipped rocky8's file is replaced by what, and the key that is to be
/// named.
type Broken = (&'static str, &'static str, &'static str, &'static str);

const BROKEN: [Broken; 16] = [
    ("no name", "name = \"rocky8\"", "name = \" \"", "name"),
    ("a wheel of negative radius", "wheel_radius_m = 0.13", "wheel_radius_m = -0.13", "wheel_radius_m"),
    ("a wheel of no number", "wheel_radius_m = 0.13", "wheel_radius_m = nan", "wheel_radius_m"),
    ("left wheels on the right", "pivot_m = [0.2415, 0.40", "pivot_m = [0.2415, -0.40", "rocker_wheel_m"),
    ("a bogie before the rocker", "bogie_joint_m = [-0.2416", "bogie_joint_m = [0.2416", "rocker_wheel_m"),
    ("two bogie wheels in one place", "[-0.138, 0.0", "[0.138, 0.0", "bogie_wheels_m"),
    ("a joint at infinity", "bogie_joint_m = [-0.2416", "bogie_joint_m = [-inf", "bogie_joint_m"),
    ("a curvature of NaN", "curvature_1_m = 1.0", "curvature_1_m = nan", "curvature_1_m"),
    ("no curvature at all", "curvature_1_m = 1.0", "curvature_1_m = 0", "curvature_1_m"),
    ("an endless curvature rate", "curvature_rate_1_m2 = 1.0", "curvature_rate_1_m2 = inf", "curvature_rate_1_m2"),
    ("a negative tilt", "tilt_deg = 45", "tilt_deg = -1", "tilt_deg"),
    ("a negative speed", "speed_m_s = 0.3", "speed_m_s = -0.3", "speed_m_s"),
    ("commands before they are given", "[limits]", "[response]\nlatency_s = -0.1\n[limits]", "latency_s"),
    (
        "a lag of no number",
        "[limits]",
        "[response]\nsteering_time_constant_s = nan\n[limits]",
        "steering_time_constant_s",
    ),
    ("wheels that only slip", "\nslip_at_20_deg = 0", "\nslip_at_20_deg = 1.5", "slip_at_20_deg"),
    ("a limit that there is not", "tilt_deg = 45", "tild_deg = 45", "tild_deg"),
];

/// R18.
pub(super) fn vehicles() -> Test {
    let mut refusals = Refusals::default();
    let text = library::rovers().find(|rover| rover.name == "rocky8").map_or("", |rover| rover.text);
    let refused = |text: &str| match toml::from_str::<RoverDescription>(text) {
        Err(unread) => Some(unread.message().to_owned()),
        Ok(description) => description.build().err().map(|error| error.field),
    };
    let good = refused(text).unwrap_or_else(|| "none".into());
    refusals.take("the shipped vehicle".into(), "none", Some(&good));
    for (case, from, to, field) in BROKEN {
        // A file that the case does not fit would be the shipped one, which is accepted.
        refusals.take(case.into(), field, refused(&text.replacen(from, to, 1)).as_deref());
    }
    refusals.test("R18", "R-15", "vehicles with a bad suspension, bad limits, bad dynamics")
}

/// R19.
pub(super) fn convergence(subject: &Subject) -> Test {
    let mut refusals = Refusals::default();
    let hard = Query { start_curvature: 0.0, goal: Goal { x: 0.5, y: 2.0, yaw: 2.5, curvature: 0.0 } };
    let none = flat::Settings { iterations: 0, starts: 1, ..flat::Settings::default() };
    let status = flat::forward(&hard, &BOUNDS, &none).status;
    let said = matches!(status, Flat::NotConverged { residual } if residual > 0.0).then_some("residual");
    refusals.take("no iterations in the plane".into(), "residual", said);
    // Beside the start no forward cubic keeps the bounds.
    let aside = Query { goal: Goal { x: 0.0, y: 1.0, yaw: 0.0, curvature: 0.0 }, ..hard };
    let settings = flat::Settings { control: Control::Cubic, ..flat::Settings::default() };
    let status = flat::forward(&aside, &BOUNDS, &settings).status;
    refusals.take("a goal out of reach".into(), "said", (status != Flat::Ok).then_some("said"));
    let site = Site::straight(&subject.rocky8, &subject.ground);
    if let Ok(goals) = subject.goals(&subject.late, 1, 38) {
        let (start, goal) = &goals[0];
        let none = Settings { iterations: 0, ..Settings::default() };
        let status = site.drive(start, goal, &none).status;
        refusals.take("no iterations on the ground".into(), "said", (status != rough::Status::Ok).then_some("said"));
        let vehicle = Vehicle::on(subject.rocky8.clone(), Some(subject.ground.clone()), None);
        let away = Planar { x: start.x + 200.0, ..*goal };
        let answered = vehicle.answer(&asked(start, &away));
        let ended = answered.limit.filter(|_| answered.status != Status::Ok).map(|(limit, _)| limit);
        refusals.take("a goal far beside the map".into(), "", ended);
    }
    // A Jacobian that is singular: contacts that leave the pose undetermined.
    let at = Vector3::new(0.3, 0.0, -0.05);
    let pole = Suspension::FourWheel(FourWheel { wheels: [at; 4], wheel_radius: 0.1 });
    let singular = matches!(pole.settle_cold(&Level, [0.0; 3]), Err(Unsettled::Singular));
    refusals.take("four wheels in one place".into(), "singular", singular.then_some("singular"));
    refusals.test(
        "R19",
        "R-16",
        "iterations that end, goals out of reach, ground that ends, a singular Jacobian: said, never a drive",
    )
}
