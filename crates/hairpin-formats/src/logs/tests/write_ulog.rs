//! ULogs as the file format's page describes them, byte by byte.

const SYNC: [u8; 8] = [0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];

/// A file that grows.
pub(crate) struct Ulog(pub(crate) Vec<u8>);

impl Ulog {
    /// Header and flags.
    pub(crate) fn new() -> Self {
        let mut log = Self([&b"ULog\x01\x12\x35\x01"[..], &1_000_u64.to_le_bytes()].concat());
        log.message(b'B', &[0; 40]);
        log
    }

    pub(crate) fn message(&mut self, kind: u8, body: &[u8]) {
        self.0.extend((body.len() as u16).to_le_bytes());
        self.0.push(kind);
        self.0.extend(body);
    }

    pub(crate) fn subscribe(&mut self, instance: u8, id: u16, name: &str) {
        self.message(b'A', &[&[instance], &id.to_le_bytes()[..], name.as_bytes()].concat());
    }

    pub(crate) fn data(&mut self, id: u16, parts: &[&[u8]]) {
        self.message(b'D', &[&id.to_le_bytes()[..], &parts.concat()].concat());
    }

    pub(crate) fn sync(&mut self) {
        self.message(b'S', &SYNC);
    }
}

pub(crate) fn singles<const N: usize>(numbers: [f32; N]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

pub(crate) const POSITION: &str = "vehicle_local_position:uint64_t timestamp;uint64_t timestamp_sample;double ref_lat;\
    double ref_lon;uint64_t ref_timestamp;float x;float y;float z;float[2] delta_xy;float delta_z;float vx;float vy;\
    float vz;float delta_heading;float ref_alt;float eph;float epv;bool xy_valid;bool z_valid;bool v_xy_valid;\
    bool v_z_valid;uint8_t xy_reset_counter;uint8_t z_reset_counter;uint8_t heading_reset_counter;bool xy_global;\
    bool z_global;bool dead_reckoning;uint8_t[4] _padding0;";

/// A sample of [`POSITION`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Position {
    pub(crate) t_us: u64,
    pub(crate) ned: [f32; 3],
    pub(crate) v: [f32; 3],
    pub(crate) delta: [f32; 4],
    pub(crate) counters: [u8; 3],
    pub(crate) reference: [f64; 3],
    pub(crate) accuracy: [f32; 2],
    pub(crate) valid: bool,
    pub(crate) global: bool,
    pub(crate) dead_reckoning: bool,
}

impl Position {
    pub(crate) const STILL: Self = Self {
        t_us: 0,
        ned: [0.0; 3],
        v: [0.0; 3],
        delta: [0.0; 4],
        counters: [0; 3],
        reference: [47.3977, 8.5456, 488.0],
        accuracy: [0.25, 0.5],
        valid: true,
        global: true,
        dead_reckoning: false,
    };

    /// Without the padding at the end, which writers leave out.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let flag = u8::from;
        let [lat, lon, alt] = self.reference;
        let [dx, dy, dz, turn] = self.delta;
        let [eph, epv] = self.accuracy;
        [
            &(self.t_us + 2_000).to_le_bytes()[..],
            &self.t_us.to_le_bytes(),
            &lat.to_le_bytes(),
            &lon.to_le_bytes(),
            &7_u64.to_le_bytes(),
            &singles(self.ned),
            &singles([dx, dy, dz]),
            &singles(self.v),
            &singles([turn, alt as f32, eph, epv]),
            &[flag(self.valid), flag(self.valid), flag(self.valid), flag(self.valid)],
            &self.counters,
            &[flag(self.global), flag(self.global), flag(self.dead_reckoning)],
        ]
        .concat()
    }
}

pub(crate) const ATTITUDE: &str = "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;float[4] delta_q_reset;uint8_t quat_reset_counter;\
     uint8_t[7] _padding0;";

pub(crate) fn attitude(t_us: u64, wxyz: [f32; 4]) -> Vec<u8> {
    [&(t_us + 1_000).to_le_bytes()[..], &t_us.to_le_bytes(), &singles(wxyz), &singles([1.0, 0.0, 0.0, 0.0]), &[0]]
        .concat()
}

/// Formats of the topics that say what is flown, in the order of their numbers; 0 is [`POSITION`], 1 [`ATTITUDE`].
pub(crate) const STATE: [&str; 5] = [
    "mission_result:uint64_t timestamp;uint16_t seq_reached;uint16_t seq_current;bool finished;",
    "position_setpoint_triplet:uint64_t timestamp;position_setpoint previous;position_setpoint current;",
    "vehicle_status:uint64_t timestamp;uint8_t nav_state;uint8_t nav_state_user_intention;bool failsafe;",
    "geofence_result:uint64_t timestamp;bool geofence_max_alt_triggered;",
    "vehicle_land_detected:uint64_t timestamp;bool landed;",
];
pub(crate) const SETPOINT: &str = "position_setpoint:uint64_t timestamp;double lat;double lon;float alt;bool valid;uint8_t type;uint8_t[2] _padding0;";

/// Part of a [`STATE`] of `position_setpoint_triplet`.
pub(crate) fn setpoint(valid: bool, [lat, lon]: [f64; 2], alt: f32) -> Vec<u8> {
    let (valid, time) = (u8::from(valid), 0_u64.to_le_bytes());
    [&time[..], &lat.to_le_bytes(), &lon.to_le_bytes(), &alt.to_le_bytes(), &[valid, 0, 0, 0]].concat()
}

/// A short flight: north at 2 m/s and climbing at 1, nose up by 30°, to item 1 and then 2 of a mission, then home.
pub(crate) fn flight() -> Vec<u8> {
    let mut log = Ulog::new();
    let release = 0x010f_02ff_u32.to_le_bytes();
    log.message(b'I', &[&[23], &b"uint32_t ver_sw_release"[..], &release].concat());
    log.message(b'P', &[&[21], &b"int32_t SDLOG_PROFILE"[..], &1_i32.to_le_bytes()].concat());
    let [result, triplet, status, fence, land] = STATE;
    let load = "cpuload:uint64_t timestamp;float load;";
    for format in [POSITION, ATTITUDE, result, SETPOINT, triplet, status, fence, land, load] {
        log.message(b'F', format.as_bytes());
    }
    let names = [
        "vehicle_local_position",
        "vehicle_attitude",
        "mission_result",
        "position_setpoint_triplet",
        "vehicle_status",
        "geofence_result",
        "vehicle_land_detected",
        "cpuload",
    ];
    for (id, name) in (0..).zip(names) {
        log.subscribe(0, id, name);
    }
    let state = |log: &mut Ulog, t: u64, mode: u8, asked: u8, failsafe: u8| {
        log.data(4, &[&t.to_le_bytes(), &[mode, asked, failsafe]]);
    };
    let to = |lat: f64| setpoint(true, [lat, 8.5456], 500.0);
    let nowhere = setpoint(false, [0.0, 8.5456], 500.0);
    log.data(6, &[&10_000_000_u64.to_le_bytes(), &[1]]);
    state(&mut log, 10_000_000, 4, 4, 0);
    for step in 0..100_u64 {
        let t = 10_000_000 + 20_000 * step;
        let seconds = step as f32 * 0.02;
        let ned = [2.0 * seconds, 0.5, -seconds];
        let position = Position { t_us: t, ned, v: [2.0, 0.0, -1.0], ..Position::STILL };
        log.data(0, &[&position.bytes()]);
        let (sin, cos) = 15_f32.to_radians().sin_cos();
        log.data(1, &[&attitude(t, [cos, 0.0, sin, 0.0])]);
        match step {
            5 => {
                log.data(6, &[&t.to_le_bytes(), &[0]]);
                state(&mut log, t, 3, 3, 0);
                log.data(3, &[&t.to_le_bytes(), &nowhere, &to(47.3978)]);
                log.data(2, &[&(t + 50).to_le_bytes(), &0_u16.to_le_bytes(), &1_u16.to_le_bytes(), &[0]]);
                log.sync();
            }
            50 => {
                log.data(3, &[&t.to_le_bytes(), &nowhere, &to(47.3979)]);
                log.data(2, &[&(t + 50).to_le_bytes(), &1_u16.to_le_bytes(), &2_u16.to_le_bytes(), &[0]]);
                log.message(b'O', &120_u16.to_le_bytes());
                log.message(b'L', b"6\0\0\0\0\0\0\0\0hello");
                log.sync();
            }
            80 => {
                log.data(5, &[&t.to_le_bytes(), &[1]]);
                state(&mut log, t, 5, 3, 1);
                log.data(7, &[&t.to_le_bytes(), &singles([0.5])]);
            }
            _ => {}
        }
    }
    log.0
}
