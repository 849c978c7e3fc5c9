//! Tables of queries, from memory or from a file that is read while they are answered. What is no such table is refused
//! as a whole.

use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::Path;

use super::blocks::{Blocks, Cursor};
use super::query::{BrokenFile, Columns, Row};
use crate::bounds::{self, TableCheck};

/// A table of queries.
#[derive(Debug, Clone, PartialEq)]
pub struct Queries {
    /// In their order.
    pub rows: Vec<Row>,
    /// Columns that mean nothing here.
    pub ignored: Vec<String>,
}

/// A file of queries that is read while they are answered.
#[derive(Debug)]
pub struct QueryFile {
    /// What its columns mean.
    pub columns: Columns,
    /// Its rows.
    pub blocks: Blocks<File>,
    /// How many they are.
    pub count: usize,
}

impl QueryFile {
    /// Opens the file at `path`, once it has been looked through.
    ///
    /// # Errors
    /// It cannot be read, or is no table of queries.
    pub fn at(path: &Path) -> Result<Self, BrokenFile> {
        let unreadable = |cause| BrokenFile::Unreadable { path: path.into(), cause };
        let file = bounds::open(path, bounds::MOST_BYTES).map_err(unreadable)?;
        let count = survey(&file).map_err(unreadable)?.ok_or(BrokenFile::Quotes)?;
        (&file).rewind().map_err(unreadable)?;
        let mut blocks = Blocks::new(file).map_err(unreadable)?;
        let head = blocks.take(1).map_err(unreadable)?;
        let columns = Columns::new(head.as_ref().map_or(&[][..], |head| &head.bytes))?;
        Ok(Self { columns, blocks, count: count.saturating_sub(1) })
    }
}

/// Counts the records of a table; `None` where its quotes do not pair up.
fn survey(mut file: &File) -> io::Result<Option<usize>> {
    let (mut check, mut cursor, mut records, mut quotes) = (TableCheck::default(), Cursor::default(), 0, 0);
    let mut piece = vec![0; 1 << 16];
    loop {
        let read = file.read(&mut piece)?;
        if read == 0 {
            return Ok((quotes % 2 == 0).then_some(records));
        }
        let bytes = &piece[..read];
        check.go_on(bytes).map_err(|what| io::Error::new(io::ErrorKind::InvalidData, what))?;
        for byte in bytes {
            quotes += usize::from(*byte == b'"');
            records += usize::from(cursor.begins(*byte));
        }
    }
}

/// Reads a table: a byte order mark, any line ends, quoted cells, blanks around cells, columns in any order.
///
/// # Errors
/// Columns are missing or named twice; quotes do not pair up.
pub fn parse(bytes: &[u8]) -> Result<Queries, BrokenFile> {
    if bytes.iter().filter(|byte| **byte == b'"').count() % 2 == 1 {
        return Err(BrokenFile::Quotes);
    }
    let unreadable = |cause| BrokenFile::Table(csv::Error::from(cause));
    let mut blocks = Blocks::new(bytes).map_err(unreadable)?;
    let head = blocks.take(1).map_err(unreadable)?;
    let columns = Columns::new(head.as_ref().map_or(&[][..], |head| &head.bytes))?;
    let rows = blocks.take(usize::MAX - bytes.len()).map_err(unreadable)?;
    let rows = rows.map_or(Ok(Vec::new()), |block| columns.rows(&block))?;
    Ok(Queries { rows, ignored: columns.ignored })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::super::query::Frame;
    use super::*;

    fn rows(text: &str) -> Vec<Row> {
        parse(text.as_bytes()).unwrap().rows
    }

    #[test]
    fn plain_quoted_and_foreign_line_ends() {
        let plain = rows("id,x,y,yaw,k0,kf\na,1,2,0.5,-0.1,0.2\n");
        let foreign =
            rows("\u{feff}kf,\"id\",note,yaw,\"y\",x,k0\r\n0.2,\"a\",\"say \"\"no\"\", please\",0.5, 2 ,1,-0.1\r\n");
        assert_eq!(plain[0].asked, foreign[0].asked);
        assert_eq!((plain[0].id.as_str(), foreign[0].id.as_str(), plain[0].line), ("a", "a", 2));
        let asked = plain[0].asked.clone().unwrap();
        assert_eq!((asked.goal, asked.k0, asked.kf, asked.start), ([1.0, 2.0, 0.5], -0.1, 0.2, None));
        assert_eq!(parse(b"id,x,y,yaw,k0,kf,colour\n").unwrap().ignored, ["colour"]);
        assert!(rows("id,x,y,yaw,k0,kf\n").is_empty());
        assert_eq!(rows("id,x,y,yaw,k0,kf\r\n\r\n\na,1,2,0.5,-0.1,0.2\n")[0].line, 4);
    }

    #[test]
    fn optional_columns_may_be_empty() {
        let head = "id,sx,sy,syaw,x,y,yaw,k0,kf,v0,vf,direction,frame,max_curvature,tolerance_m\n";
        let all = rows(&format!("{head}q,10,20,1,1,2,3,0,0,0.5,1,0.1,enu,0.8,0.02\nr,0,0,0,1,2,3,0,0,,,,,,\n"));
        let full = all[0].asked.clone().unwrap();
        assert_eq!(
            (full.start, full.v0, full.vf, full.direction),
            (Some([10.0, 20.0, 1.0]), Some(0.5), Some(1.0), 0.1)
        );
        assert_eq!((full.max_curvature, full.tolerance_m), (Some(0.8), Some(0.02)));
        let empty = all[1].asked.clone().unwrap();
        assert_eq!((empty.v0, empty.direction, empty.frame, empty.max_curvature), (None, 0.0, Frame::Enu, None));
    }

    #[test]
    fn ned_is_turned_over_once() {
        let head = "id,sx,sy,syaw,x,y,yaw,k0,kf,direction,frame\n";
        let asked = rows(&format!("{head}q,100,7,0,3,1,0.5,0.1,-0.2,0.3,ned\n"))[0].asked.clone().unwrap();
        // 100 m north and 7 m east, heading north; the goal is to the right, which is not left.
        assert_eq!(asked.start.map(|[x, y, _]| [x, y]), Some([7.0, 100.0]));
        assert!((asked.start.unwrap()[2] - FRAC_PI_2).abs() < 1e-15);
        assert_eq!((asked.goal, asked.k0, asked.kf, asked.direction), ([3.0, -1.0, -0.5], -0.1, 0.2, -0.3));
    }

    #[test]
    fn wrong_rows_are_told_and_their_neighbours_stand() {
        let head = "id,x,y,yaw,k0,kf,frame,max_curvature,v0\n";
        let text = "a,1,2,0,0,0,enu,,\nb,one,2,0,0,0,,,\nc,1,NaN,0,0,0,,,\nd,1,2,inf,0,0,,,\ne,1,2,0,,0,,,\nf,1,2,0,0,0,map,,\n\
                    g,1,2,0,0,0,,-1,\nh,1,2,0,0,0,,,-1\ni,1,2,0\n,1,2,0,0,0,,,\nz,1,2,0,0,0,,,\n";
        let found: Vec<String> = rows(&format!("{head}{text}"))
            .iter()
            .map(|row| row.asked.as_ref().map_or_else(|wrong| wrong.column.clone(), |_| "good".into()))
            .collect();
        assert_eq!(found, ["good", "x", "y", "yaw", "k0", "frame", "max_curvature", "v0", "row", "id", "good"]);
        let latin = parse(b"id,x,y,yaw,k0,kf\n\xe9,1,2,0,0,\xff\n").unwrap();
        assert_eq!(latin.rows[0].asked.as_ref().unwrap_err().column, "kf");
    }

    #[test]
    fn broken_files_are_refused() {
        for (text, told) in [
            ("", "no column `id`"),
            ("id,x,y,yaw,k0\n", "no column `kf`"),
            ("id,x,y,yaw,k0,kf,x\n", "twice"),
            ("id,sx,x,y,yaw,k0,kf\n", "belong together"),
            ("id,x,y,yaw,k0,kf\n\"a,1,2,0,0,0\nb,1,2,0,0,0\n", "quotes"),
            ("{\"id\": 1}\n", "no column"),
            ("id;x;y;yaw;k0;kf\na;1;2;0;0;0\n", "no column `id`: its cells stand between semicolons"),
            ("id\tx\ty\tyaw\tk0\tkf\n", "no column `id`: its cells stand between tabs"),
        ] {
            let found = parse(text.as_bytes()).unwrap_err().to_string();
            assert!(found.contains(told), "{text:?}: {found}");
        }
        assert!(QueryFile::at(Path::new("no-such.csv")).unwrap_err().to_string().contains("no-such.csv"));
    }
}
