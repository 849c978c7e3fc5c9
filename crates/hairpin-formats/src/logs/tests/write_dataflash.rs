//! ArduPilot's logs as `LogStructure.h` describes them.

/// A log that grows.
pub(crate) struct Bin(pub(crate) Vec<u8>);

fn padded(text: &str, size: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(size, 0);
    bytes
}

impl Bin {
    pub(crate) fn new() -> Self {
        let mut log = Self(Vec::new());
        log.describe(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
        log
    }

    pub(crate) fn describe(&mut self, kind: u8, length: u8, name: &str, format: &str, labels: &str) {
        self.message(128, &[&[kind, length], &padded(name, 4)[..], &padded(format, 16), &padded(labels, 64)]);
    }

    pub(crate) fn message(&mut self, kind: u8, parts: &[&[u8]]) {
        self.0.extend([0xa3, 0x95, kind]);
        self.0.extend(parts.concat());
    }
}

fn degrees(value: f64) -> [u8; 4] {
    ((value * 1e7).round() as i32).to_le_bytes()
}

fn single(value: f32) -> [u8; 4] {
    value.to_le_bytes()
}

/// A copter that flies east at 2 m/s and climbs at 1, nose north and 30° up: to items 1 and 2, then home.
pub(crate) fn flight() -> Vec<u8> {
    let mut log = Bin::new();
    log.describe(1, 75, "MSG", "QZ", "TimeUS,Message");
    log.describe(2, 24, "ORGN", "QBLLf", "TimeUS,Type,Lat,Lng,Alt");
    log.describe(3, 31, "POS", "QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt");
    log.describe(4, 21, "ATT", "Qccccc", "TimeUS,DesRoll,Roll,Pitch,Yaw,DesYaw");
    log.describe(5, 46, "XKF1", "QBcccfffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD");
    log.describe(6, 14, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn");
    log.describe(7, 46, "CMD", "QHHHffffLLfB", "TimeUS,CTot,CNum,CId,Prm1,Prm2,Prm3,Prm4,Lat,Lng,Alt,Frame");
    log.describe(8, 12, "EV", "QB", "TimeUS,Id");
    log.describe(9, 13, "ERR", "QBB", "TimeUS,Subsys,ECode");
    log.describe(10, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
    let (lat, lng, alt) = (47.3977, 8.5456, 488.0_f32);
    let start = 10_000_000_u64;
    log.message(10, &[&start.to_le_bytes(), &[3], &padded("sDUmmm", 16), &padded("FGG000", 16)]);
    log.message(1, &[&start.to_le_bytes(), &padded("ArduCopter V4.5.7 (2a3dc4b7)", 64)]);
    for kind in [0, 1] {
        log.message(2, &[&start.to_le_bytes(), &[kind], &degrees(lat), &degrees(lng), &single(alt)]);
    }
    let command = |log: &mut Bin, t: u64, number: u16, east: f64| {
        let head = [4_u16, number, 16].map(u16::to_le_bytes).concat();
        let place = [degrees(lat), degrees(lng + east), single(12.0)].concat();
        log.message(7, &[&t.to_le_bytes(), &head, &[0; 16], &place, &[3]]);
    };
    (0..4).for_each(|number| command(&mut log, start + 100 * u64::from(number), number, 1e-4 * f64::from(number)));
    log.message(6, &[&start.to_le_bytes(), &[5, 5, 0]]);
    for step in 0..100_u64 {
        let t = start + 20_000 * step;
        let seconds = step as f64 * 0.02;
        let (east, up) = (2.0 * seconds, 1.0 * seconds);
        // A degree of longitude at 47.3977° and 488 m on WGS 84 is 75 495.6 m.
        let lng = degrees(lng + east / 75_495.57);
        log.message(
            3,
            &[&t.to_le_bytes(), &degrees(lat), &lng, &single(alt + up as f32), &single(up as f32), &single(up as f32)],
        );
        let angles = [0_i16, 0, 3000, 0, 0].map(i16::to_le_bytes).concat();
        log.message(4, &[&t.to_le_bytes(), &angles]);
        let turn = [0_i16, 3000, 0].map(i16::to_le_bytes).concat();
        let numbers = [0.0, 2.0, -1.0, 0.0, 0.5, east as f32, -up as f32].map(single).concat();
        log.message(5, &[&t.to_le_bytes(), &[0], &turn, &numbers]);
        match step {
            5 => {
                log.message(8, &[&t.to_le_bytes(), &[28]]);
                log.message(6, &[&t.to_le_bytes(), &[3, 3, 2]]);
                command(&mut log, t, 2, 2e-4);
            }
            50 => command(&mut log, t, 3, 3e-4),
            80 => {
                log.message(9, &[&t.to_le_bytes(), &[9, 1]]);
                log.message(6, &[&t.to_le_bytes(), &[6, 6, 10]]);
            }
            _ => {}
        }
    }
    log.message(8, &[&(start + 2_000_000).to_le_bytes(), &[18]]);
    log.0
}
