//! Which format a log is of, told by its first bytes; among texts by its name, then by its first line.

use super::error::Fault;
use super::{bag, dataflash, ulog};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Ulog,
    Mcap,
    DataFlash,
    Tum,
    Csv,
}

/// Formats that are told apart, and what makes them readable.
const OTHERS: [(&[u8], &str); 3] = [
    (b"SQLite format 3\0", "a ROS 2 bag in SQLite; `ros2 bag convert` writes it as MCAP"),
    (b"#ROSBAG V2.0", "a ROS 1 bag; `mcap convert` or `rosbags-convert` writes it as MCAP, for ROS 2"),
    (b"PAR1", "a Parquet table; export it as CSV"),
];

const KNOWN: &str = "a log is read as PX4 ULog (.ulg), ArduPilot DataFlash (.bin), ROS 2 MCAP (.mcap), TUM (`t x y z qx qy qz qw`) or CSV (a header such as `t_s,x_m,y_m,z_m,qw,qx,qy,qz`)";

/// What ArduPilot's users have beside the vehicle's own log: that log as text, and telemetry that a ground station
/// recorded, whose packets have a stamp before them (µs since 1970, highest byte first) and begin with 0xFE or 0xFD.
fn of_ardupilot(bytes: &[u8], name: &str) -> Option<String> {
    let is_stamp = |stamp: u64| (900_000_000_000_000..5_000_000_000_000_000).contains(&stamp);
    let is_telemetry = bytes.first_chunk().copied().is_some_and(|stamp| is_stamp(u64::from_be_bytes(stamp)))
        && bytes.get(8).is_some_and(|first| matches!(first, 0xfe | 0xfd));
    let (what, has) = match () {
        () if is_telemetry => ("telemetry that a ground station recorded (MAVLink, .tlog)", "LOCAL_POSITION_NED"),
        () if bytes.starts_with(b"FMT,") => ("an ArduPilot log as text", "XKF1"),
        () => return None,
    };
    let file = shlex::try_quote(name).map_or_else(|_| "LOG".to_owned(), |quoted| quoted.into_owned());
    Some(format!(
        "{what}; the vehicle's own log, .bin, is read. Without it `mavlogdump.py --types {has} --format csv {file}` \
         writes its positions as a table, of which one with `t_s,x_m,y_m,z_m` (east, north, up) is read"
    ))
}

impl Format {
    pub(super) fn of(bytes: &[u8], name: &str) -> Result<Self, Fault> {
        if let Some((_, what)) = OTHERS.iter().find(|(magic, _)| bytes.starts_with(magic)) {
            return Err(Fault::Unknown((*what).into()));
        }
        if let Some(what) = of_ardupilot(bytes, name) {
            return Err(Fault::Unknown(what));
        }
        if bytes.starts_with(dataflash::MAGIC) {
            return Ok(Self::DataFlash);
        }
        if bytes.starts_with(ulog::MAGIC) {
            return Ok(Self::Ulog);
        }
        if bytes.starts_with(bag::MAGIC) {
            return Ok(Self::Mcap);
        }
        if bytes.contains(&0) {
            return Err(Fault::Unknown(format!("no text, and of no format that is known; {KNOWN}")));
        }
        let name = name.to_ascii_lowercase();
        match () {
            () if name.ends_with(".tum") => Ok(Self::Tum),
            () if name.ends_with(".csv") => Ok(Self::Csv),
            () => Self::of_text(bytes).ok_or_else(|| Fault::Unknown(format!("of no format that is known; {KNOWN}"))),
        }
    }

    fn of_text(bytes: &[u8]) -> Option<Self> {
        let mut lines =
            bytes.split(|byte| *byte == b'\n').map(|line| String::from_utf8_lossy(&line[..line.len().min(2_000)]));
        let is_data = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
        let first = lines.clone().find(|line| !line.trim().is_empty())?;
        // Numbers between tabs may be a TUM log's; names are a table's.
        let names = |line: &str| line.split('\t').all(|word| word.trim().parse::<f64>().is_err());
        if first.contains([',', ';']) || first.contains('\t') && is_data(&first) && names(&first) {
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
            ("t_s\tx_m\n", "a.log", Some(Format::Csv)),
            ("1\t2\t3\t4\t0\t0\t0\t1\n", "a.log", Some(Format::Tum)),
            ("hello world\n", "a.log", None),
            ("", "a.log", None),
        ] {
            assert_eq!(Format::of(text.as_bytes(), name).ok(), format, "{text:?}");
        }
        assert!(
            matches!(Format::of(b"SQLite format 3\0...", "a.db3"), Err(Fault::Unknown(what)) if what.contains("convert"))
        );
        assert!(Format::of(b"a\0b", "a.csv").is_err());
        let packet = [&1_700_000_000_000_000_u64.to_be_bytes()[..], &[0xfd, 28, 0, 0]].concat();
        for (bytes, name, words) in [
            (&packet[..], "a b.tlog", "mavlogdump.py --types LOCAL_POSITION_NED --format csv 'a b.tlog'"),
            (
                &b"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name\n"[..],
                "a.log",
                "an ArduPilot log as text; the vehicle's own",
            ),
        ] {
            let Err(Fault::Unknown(what)) = Format::of(bytes, name) else { panic!("{name}") };
            assert!(what.contains(words) && what.contains(".bin, is read"), "{what}");
        }
    }
}
