//! Answers as CSV: a row for each segment of each drive, in the frame of the query.

use std::fmt;

use serde::Serialize;

use super::Frame;

/// What came of a query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The drive ends in the goal within the tolerance and keeps every limit, by its replay.
    Ok,
    /// No drive keeps the limits; `limit` and `excess` say why.
    Infeasible,
    /// The solver found none.
    NotConverged,
    /// The time was over: the best so far.
    TimeLimit,
    /// The row is no query; `limit` names the column.
    Invalid,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ok => "ok",
            Self::Infeasible => "infeasible",
            Self::NotConverged => "not_converged",
            Self::TimeLimit => "time_limit",
            Self::Invalid => "invalid",
        })
    }
}

/// One segment, left positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// κ(s) = Σ aᵢ sⁱ, s from 0; ψ̇ = direction · v · κ.
    Arc {
        /// Metres.
        length_m: f64,
        /// a₀ … a₅, 1/m^(i+1).
        curvature: [f64; 6],
        /// +1 forward, −1 in reverse.
        direction: i8,
    },
    /// In place.
    Turn {
        /// Radians.
        angle_rad: f64,
    },
}

/// Where the replay ends less where it should, in the start's frame, left positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Forward, m.
    pub x_m: f64,
    /// Left, m.
    pub y_m: f64,
    /// Heading, rad.
    pub yaw_rad: f64,
    /// κ, 1/m.
    pub curvature_1_m: f64,
}

/// A drive with what its replay found.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Its segments.
    pub pieces: Vec<Piece>,
    /// Of the whole drive.
    pub errors: Errors,
    /// Largest |κ|, 1/m.
    pub max_curvature_1_m: f64,
}

/// The answer to one query.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The query's.
    pub id: String,
    /// The frame to answer in.
    pub frame: Frame,
    /// What came of it.
    pub status: Status,
    /// Of the solver.
    pub iterations: u32,
    /// Solving alone.
    pub time_us: f64,
    /// Nothing where nothing can be driven.
    pub drive: Option<Drive>,
    /// What stands in the way, and by how much it is exceeded, in its unit.
    pub limit: Option<(String, Option<f64>)>,
}

const COLUMNS: [&str; 22] = [
    "id",
    "segment",
    "kind",
    "direction",
    "status",
    "iterations",
    "time_us",
    "length_m",
    "turn_rad",
    "a0",
    "a1",
    "a2",
    "a3",
    "a4",
    "a5",
    "err_x_m",
    "err_y_m",
    "err_yaw_rad",
    "err_curvature_1_m",
    "max_curvature_1_m",
    "limit",
    "excess",
];

/// The table of `answers`, in their order.
///
/// # Errors
/// Memory that cannot be had.
pub fn table(answers: &[Answer]) -> csv::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(COLUMNS)?;
    for answer in answers {
        write_rows(&mut table, answer)?;
    }
    table.into_inner().map_err(|error| error.into_error().into())
}

/// The rows of one answer: one a segment, and one where there is none.
fn write_rows(table: &mut csv::Writer<Vec<u8>>, answer: &Answer) -> csv::Result<()> {
    let left = answer.frame.left();
    let pieces = answer.drive.as_ref().map_or(&[][..], |drive| &drive.pieces);
    let whole =
        |value: &dyn Fn(&Drive) -> f64| answer.drive.as_ref().map_or(String::new(), |drive| number(value(drive)));
    for segment in 0..pieces.len().max(1) {
        let (mut kind, mut direction, mut length, mut turn) = ("", String::new(), String::new(), String::new());
        let mut bends: [String; 6] = Default::default();
        match pieces.get(segment) {
            Some(Piece::Arc { length_m, curvature, direction: way }) => {
                (kind, direction, length, turn) = ("arc", way.to_string(), number(*length_m), number(0.0));
                bends = curvature.map(|a| number(left * a));
            }
            Some(Piece::Turn { angle_rad }) => {
                (kind, direction, length, turn) = ("turn", "1".into(), number(0.0), number(left * angle_rad));
                bends = [0.0; 6].map(number);
            }
            None => {}
        }
        let (status, iterations) = (answer.status.to_string(), answer.iterations.to_string());
        let time = format!("{:.3}", answer.time_us);
        let (limit, excess) = answer.limit.clone().map_or((String::new(), None), |(limit, excess)| (limit, excess));
        let begin =
            [answer.id.clone(), segment.to_string(), kind.into(), direction, status, iterations, time, length, turn];
        let end = [
            whole(&|drive| drive.errors.x_m),
            whole(&|drive| left * drive.errors.y_m),
            whole(&|drive| left * drive.errors.yaw_rad),
            whole(&|drive| left * drive.errors.curvature_1_m),
            whole(&|drive| drive.max_curvature_1_m),
            limit,
            excess.map_or(String::new(), number),
        ];
        table.write_record(begin.iter().chain(&bends).chain(&end))?;
    }
    Ok(())
}

/// Digits that read back to the same bits; no minus before zero.
fn number(value: f64) -> String {
    (value + 0.0).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(answers: &[Answer]) -> Vec<String> {
        String::from_utf8(table(answers).unwrap()).unwrap().lines().map(str::to_owned).collect()
    }

    #[test]
    fn a_row_a_segment_in_the_frame_of_the_query() {
        let errors = Errors { x_m: 1e-9, y_m: 2e-9, yaw_rad: -3e-9, curvature_1_m: 0.0 };
        let arc = Piece::Arc { length_m: 1.5, curvature: [0.25, -0.5, 0.0, 0.0, 0.0, 0.0], direction: -1 };
        let drive = Drive { pieces: vec![arc, Piece::Turn { angle_rad: 0.5 }], errors, max_curvature_1_m: 0.5 };
        let mut answer = Answer {
            id: "a,\"b\"".into(),
            frame: Frame::Enu,
            status: Status::Ok,
            iterations: 3,
            time_us: 1.25,
            drive: Some(drive),
            limit: None,
        };
        let enu = lines(std::slice::from_ref(&answer));
        assert_eq!(
            enu[0],
            "id,segment,kind,direction,status,iterations,time_us,length_m,turn_rad,a0,a1,a2,a3,a4,a5,\
             err_x_m,err_y_m,err_yaw_rad,err_curvature_1_m,max_curvature_1_m,limit,excess"
        );
        let errors = "0.000000001,0.000000002,-0.000000003,0,0.5,,";
        assert_eq!(enu[1], format!("\"a,\"\"b\"\"\",0,arc,-1,ok,3,1.250,1.5,0,0.25,-0.5,0,0,0,0,{errors}"));
        assert_eq!(enu[2], format!("\"a,\"\"b\"\"\",1,turn,1,ok,3,1.250,0,0.5,0,0,0,0,0,0,{errors}"));
        answer.frame = Frame::Ned;
        let ned = lines(&[answer]);
        assert!(ned[1].contains(",1.5,0,-0.25,0.5,0,0,0,0,0.000000001,-0.000000002,0.000000003,0,0.5,,"), "{}", ned[1]);
        assert!(ned[2].contains(",turn,1,ok,3,1.250,0,-0.5,"), "{}", ned[2]);
    }

    #[test]
    fn answers_without_a_drive_have_one_row() {
        let answer = Answer {
            id: "q".into(),
            frame: Frame::Enu,
            status: Status::Infeasible,
            iterations: 0,
            time_us: 0.0,
            drive: None,
            limit: Some(("curvature_1_m".into(), Some(0.5))),
        };
        assert_eq!(lines(&[answer])[1], "q,0,,,infeasible,0,0.000,,,,,,,,,,,,,,curvature_1_m,0.5");
        for status in [Status::NotConverged, Status::TimeLimit, Status::Invalid] {
            assert_eq!(serde_json::to_string(&status).unwrap(), format!("\"{status}\""));
        }
    }
}
