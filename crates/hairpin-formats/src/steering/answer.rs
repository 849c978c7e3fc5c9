//! Answers as CSV: a row for each segment of each drive, in the frame of the query.

use std::borrow::Cow;
use std::fmt::{self, Write as _};

use serde::Serialize;
use serde_json::Value;

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

impl Status {
    /// All of them, the good one first.
    pub const ALL: [Self; 5] = [Self::Ok, Self::Infeasible, Self::NotConverged, Self::TimeLimit, Self::Invalid];
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

pub(super) const COLUMNS: [&str; 22] = [
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

/// The line of columns that a table begins with.
pub fn head() -> String {
    COLUMNS.join(",") + "\n"
}

/// The rows of `answers`, in their order: one a segment, and one where there is none.
pub fn rows(answers: &[Answer]) -> String {
    let mut table = String::new();
    answers.iter().for_each(|answer| add_rows(&mut table, answer));
    table
}

/// The rows of a table that [`head`] and [`rows`] wrote, each with its cells by column: numbers as such, null where
/// there is none.
pub fn objects(table: &str) -> Vec<Value> {
    /// The columns that are words, whatever they look like.
    const WORDS: [&str; 4] = ["id", "kind", "status", "limit"];
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let of = |(column, cell): (&str, &str)| {
        let value = match cell {
            "" => Value::Null,
            _ if WORDS.contains(&column) => cell.into(),
            // Whole numbers as such; of others the bits that were written.
            _ => cell.parse::<i64>().map_or_else(|_| cell.parse::<f64>().ok().into(), Value::from),
        };
        (column.to_owned(), value)
    };
    let all = reader.records().map_while(Result::ok);
    all.map(|row| COLUMNS.into_iter().zip(&row).map(of).collect::<serde_json::Map<_, _>>().into()).collect()
}

fn add_rows(table: &mut String, answer: &Answer) {
    let left = answer.frame.left();
    let pieces = answer.drive.as_ref().map_or(&[][..], |drive| &drive.pieces);
    let id = quoted(&answer.id);
    // What all rows of the answer have in their middle, and what they end in.
    let (mut middle, mut end) = (String::new(), String::new());
    // Writing to a string does not fail.
    let _ = write!(middle, ",{},{},{:.3}", answer.status, answer.iterations, answer.time_us);
    match &answer.drive {
        Some(Drive { errors, max_curvature_1_m, .. }) => {
            let turned = [errors.y_m, errors.yaw_rad, errors.curvature_1_m].map(|error| left * error);
            [errors.x_m]
                .iter()
                .chain(&turned)
                .chain([max_curvature_1_m])
                .for_each(|number| add_number(&mut end, *number));
        }
        None => end.push_str(",,,,,"),
    }
    let (limit, excess) = answer.limit.as_ref().map_or(("", None), |(limit, excess)| (limit, *excess));
    end.push(',');
    end.push_str(&quoted(limit));
    match excess {
        Some(excess) => add_number(&mut end, excess),
        None => end.push(','),
    }
    for segment in 0..pieces.len().max(1) {
        let _ = write!(table, "{id},{segment},");
        let numbers = match pieces.get(segment) {
            Some(Piece::Arc { length_m, curvature, direction }) => {
                let _ = write!(table, "arc,{direction}");
                Some((*length_m, 0.0, curvature.map(|a| left * a)))
            }
            Some(Piece::Turn { angle_rad }) => {
                table.push_str("turn,1");
                Some((0.0, left * angle_rad, [0.0; 6]))
            }
            None => {
                table.push(',');
                None
            }
        };
        table.push_str(&middle);
        match numbers {
            Some((length, turn, bends)) => {
                [length, turn].iter().chain(&bends).for_each(|number| add_number(table, *number));
            }
            None => table.push_str(",,,,,,,,"),
        }
        table.push_str(&end);
        table.push('\n');
    }
}

/// A comma, and digits that read back to the same bits; no minus before zero.
fn add_number(text: &mut String, number: f64) {
    if number == 0.0 {
        text.push_str(",0");
    } else {
        let _ = write!(text, ",{number}");
    }
}

/// A cell as tables have it: in quotes where it would be more than one, or begin a line.
fn quoted(cell: &str) -> Cow<'_, str> {
    if cell.contains(['"', ',', '\r', '\n']) {
        format!("\"{}\"", cell.replace('"', "\"\"")).into()
    } else {
        cell.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(answers: &[Answer]) -> Vec<String> {
        (head() + &rows(answers)).lines().map(str::to_owned).collect()
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
    fn rows_become_objects_with_the_same_fields() {
        let arc = Piece::Arc { length_m: 0.1, curvature: [1.0 / 3.0, 0.0, 0.0, 0.0, 0.0, 0.0], direction: -1 };
        let errors = Errors { x_m: 1e-19, y_m: 0.0, yaw_rad: 0.0, curvature_1_m: 0.0 };
        let of = |id: &str, status, drive, limit: Option<(String, Option<f64>)>| Answer {
            id: id.into(),
            frame: Frame::Enu,
            status,
            iterations: 3,
            time_us: 1.25,
            drive,
            limit,
        };
        let drive = Drive { pieces: vec![arc], errors, max_curvature_1_m: 0.5 };
        let limit = Some(("x".to_owned(), None));
        let answers = [of("7", Status::Ok, Some(drive), None), of("a,\n\"b\"", Status::Invalid, None, limit)];
        let found = objects(&(head() + &rows(&answers)));
        assert_eq!(found.len(), 2);
        let fields: Vec<&str> = found[0].as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(fields.len(), COLUMNS.len());
        assert!(COLUMNS.iter().all(|column| fields.contains(column)));
        assert_eq!((&found[0]["id"], &found[0]["direction"]), (&"7".into(), &(-1).into()));
        assert_eq!((found[0]["a0"].as_f64(), found[0]["err_x_m"].as_f64()), (Some(1.0 / 3.0), Some(1e-19)));
        assert_eq!((&found[1]["id"], &found[1]["limit"]), (&"a,\n\"b\"".into(), &"x".into()));
        assert!(found[1]["length_m"].is_null() && found[1]["kind"].is_null() && found[1]["time_us"] == 1.25);
        assert!(objects(&head()).is_empty());
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
