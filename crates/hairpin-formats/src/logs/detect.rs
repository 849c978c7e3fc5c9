//! Which format a log is of, told by its first bytes; among texts by its name, then by its first line.

use super::error::Fault;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Tum,
    Csv,
}

/// Formats that are told apart, and what makes them readable.
const OTHERS: [(&[u8], &str); 3] = [
    (b"SQLite format 3\0", "a ROS 2 bag in SQLite; `ros2 bag convert` writes it as MCAP"),
    (b"#ROSBAG V2.0", "a ROS 1 bag; `mcap convert` or `rosbags-convert` writes it as MCAP, for ROS 2"),
    (b"PAR1", "a Parquet table; export it as CSV"),
];

const KNOWN: &str =
    "a log is read as TUM (`t x y z qx qy qz qw`) or CSV (a header such as `t_s,x_m,y_m,z_m,qw,qx,qy,qz`)";

impl Format {
    pub(super) fn of(bytes: &[u8], name: &str) -> Result<Self, Fault> {
        if let Some((_, what)) = OTHERS.iter().find(|(magic, _)| bytes.starts_with(magic)) {
            return Err(Fault::Unknown((*what).into()));
        }
        let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
        match ending.as_deref() {
            _ if bytes.contains(&0) => Err(Fault::Unknown(format!("no text, and of no format that is known; {KNOWN}"))),
            Some("tum") => Ok(Self::Tum),
            Some("csv") => Ok(Self::Csv),
            _ => Self::of_text(bytes).ok_or_else(|| Fault::Unknown(format!("of no format that is known; {KNOWN}"))),
        }
    }

    fn of_text(bytes: &[u8]) -> Option<Self> {
        let mut lines =
            bytes.split(|byte| *byte == b'\n').map(|line| String::from_utf8_lossy(&line[..line.len().min(2_000)]));
        let is_data = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
        let first = lines.clone().find(|line| !line.trim().is_empty())?;
        if first.contains([',', ';']) {
            return Some(Self::Csv);
        }
        let first = lines.find(|line| is_data(line))?;
        let numbers = first.split_whitespace().filter(|word| word.parse::<f64>().is_ok()).count();
        (numbers == 8).then_some(Self::Tum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_told_by_name_then_by_content() {
        for (text, name, format) in [
            ("# t x y z\n1 2 3 4 0 0 0 1\n", "a.txt", Some(Format::Tum)),
            ("1 2 3 4 0 0 0 1\n", "a.csv", Some(Format::Csv)),
            ("#timestamp, x [m]\n1,2\n", "a", Some(Format::Csv)),
            ("t_s;x_m\n", "a.log", Some(Format::Csv)),
            ("hello world\n", "a.log", None),
            ("", "a.log", None),
        ] {
            assert_eq!(Format::of(text.as_bytes(), name).ok(), format, "{text:?}");
        }
        assert!(
            matches!(Format::of(b"SQLite format 3\0...", "a.db3"), Err(Fault::Unknown(what)) if what.contains("convert"))
        );
        assert!(Format::of(b"a\0b", "a.csv").is_err());
    }
}
