//! Answers that a file has already, for whoever goes on behind them.

use std::io;

use super::answer::{COLUMNS, Status};

/// An answer that a file has already.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptAnswer {
    /// The query's.
    pub id: Box<str>,
    /// What came of it.
    pub status: Status,
    /// Solving alone.
    pub time_us: f64,
    /// Whether there is a drive.
    pub driven: bool,
}

/// The answers of a table as [`super::head`] and [`super::rows`] write it, in their order.
///
/// # Errors
/// It is none.
pub fn kept_answers(table: impl io::Read) -> io::Result<Vec<KeptAnswer>> {
    let mut reader = csv::Reader::from_reader(table);
    let refuse = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
    if !reader.headers()?.iter().eq(COLUMNS) {
        return Err(refuse("line 1: these are no columns of answers".into()));
    }
    let mut kept = Vec::new();
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row)? {
        let cell = |column: &str| COLUMNS.iter().position(|name| *name == column).and_then(|place| row.get(place));
        if cell("segment") != Some("0") {
            continue;
        }
        let line = row.position().map_or(0, csv::Position::line);
        let status = Status::ALL.into_iter().find(|status| cell("status") == Some(&status.to_string()));
        let status = status.ok_or_else(|| refuse(format!("line {line}: no status of an answer")))?;
        let time_us = cell("time_us").and_then(|text| text.parse().ok());
        let time_us = time_us.ok_or_else(|| refuse(format!("line {line}: time_us is no number")))?;
        let (id, driven) = (cell("id").unwrap_or_default().into(), cell("kind") != Some(""));
        kept.push(KeptAnswer { id, status, time_us, driven });
    }
    Ok(kept)
}

#[cfg(test)]
mod tests {
    use super::super::Frame;
    use super::super::answer::{Answer, Drive, Errors, Piece, head, rows};
    use super::*;

    #[test]
    fn what_a_file_has_already_is_read_back() {
        let arc = Piece::Arc { length_m: 1.0, curvature: [0.0; 6], direction: 1 };
        let errors = Errors { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0, curvature_1_m: 0.0 };
        let drive = Drive { pieces: vec![arc, arc], errors, max_curvature_1_m: 0.0 };
        let of = |id: &str, status, drive: Option<Drive>| Answer {
            id: id.into(),
            frame: Frame::Enu,
            status,
            iterations: 1,
            time_us: 2.5,
            drive,
            limit: None,
        };
        let answers = [of("a,\"\n", Status::Ok, Some(drive)), of("b", Status::TimeLimit, None)];
        let table = head() + &rows(&answers);
        let kept = kept_answers(table.as_bytes()).unwrap();
        let wanted = |id: &str, status, driven| KeptAnswer { id: id.into(), status, time_us: 2.5, driven };
        assert_eq!(kept, [wanted("a,\"\n", Status::Ok, true), wanted("b", Status::TimeLimit, false)]);
        assert!(kept_answers(&b"id,x\n"[..]).unwrap_err().to_string().contains("columns"));
        let broken = head() + "a,0,arc,1,fine" + &",".repeat(17) + "\n";
        assert!(kept_answers(broken.as_bytes()).unwrap_err().to_string().contains("line 2: no status"));
    }
}
