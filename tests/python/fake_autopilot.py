"""A stand-in for PX4 and for ArduPilot's Copter on loopback: it answers over MAVLink as their documentation says, and
refuses what they refuse; what flies is a point that leans into its acceleration. Of theirs it has no code.

    python fake_autopilot.py px4 14540            sends to UDP port 14540, as PX4 does
    python fake_autopilot.py ardupilot 5760       listens at TCP port 5760, as ArduPilot's SITL does

`--trouble` makes it what a test needs: arming-denied (and PX4's first request for OFFBOARD), upload-refused, stall; and a
second into the flight failsafe, crash, silent, no-heartbeat, gone.
Its local frame begins at ORIGIN; home lies 2 m higher, so that whoever mixes the two up flies 2 m off.
"""
import argparse
import math
import os
import select
import struct
import time

os.environ["MAVLINK20"] = "1"
from pymavlink import mavutil  # noqa: E402

m = mavutil.mavlink
STEP_S, RADIUS_M, GRAVITY = 0.02, 6371000.0, 9.81
ORIGIN = (47.397742, 8.545594, 488.0)
HOME_ABOVE_M = 2.0
READY_S = 3.0  # after its start: until then its estimator is not
REAL, WHOLE = m.MAV_PARAM_TYPE_REAL32, m.MAV_PARAM_TYPE_INT32
ACCEPTED, REJECTED, DENIED, UNSUPPORTED, FAILED = 0, 1, 2, 3, 4


class Px4:
    BYTEWISE, HOME_ITEMS, AUTOPILOT = True, 0, m.MAV_AUTOPILOT_PX4
    MODES = {"POSCTL": 3 << 16, "OFFBOARD": 6 << 16, "LOITER": 4 << 16 | 3 << 24, "MISSION": 4 << 16 | 4 << 24,
             "RTL": 4 << 16 | 5 << 24, "LAND": 4 << 16 | 6 << 24}
    BEGIN, STEERED, MISSION, AFTER = "POSCTL", "OFFBOARD", "MISSION", "LOITER"
    PARAMETERS = {"MPC_XY_VEL_MAX": (12.0, REAL), "MPC_TILTMAX_AIR": (45.0, REAL), "NAV_ACC_RAD": (2.0, REAL), "COM_RC_IN_MODE": (1, WHOLE)}
    FRAMES = (0, 3, 5, 6)

    @staticmethod
    def mode_number(p1, p2, p3):
        return int(p2) << 16 | int(p3) << 24


class ArduPilot:
    BYTEWISE, HOME_ITEMS, AUTOPILOT = False, 1, m.MAV_AUTOPILOT_ARDUPILOTMEGA
    MODES = {"STABILIZE": 0, "GUIDED": 4, "AUTO": 3, "LAND": 9, "RTL": 6}
    BEGIN, STEERED, MISSION, AFTER = "STABILIZE", "GUIDED", "AUTO", "AUTO"
    PARAMETERS = {"WPNAV_SPEED": (1000.0, REAL), "ANGLE_MAX": (4500.0, m.MAV_PARAM_TYPE_INT16), "WPNAV_RADIUS": (200.0, REAL),
                  "WP_YAW_BEHAVIOR": (2, m.MAV_PARAM_TYPE_INT8), "MIS_RESTART": (0, m.MAV_PARAM_TYPE_INT8), "SIM_SPEEDUP": (1.0, REAL)}
    FRAMES = (0, 3, 5, 6, 10, 11)

    @staticmethod
    def mode_number(p1, p2, p3):
        return int(p2)


def attitude(acceleration, heading):
    """The quaternion (from body to north, east, down) of thrust that gives this acceleration, nose at the heading."""
    force = [acceleration[0], acceleration[1], acceleration[2] - GRAVITY]
    size = math.sqrt(sum(f * f for f in force))
    z = [-f / size for f in force]
    ahead = [math.cos(heading), math.sin(heading), 0.0]
    y = [z[1] * ahead[2] - z[2] * ahead[1], z[2] * ahead[0] - z[0] * ahead[2], z[0] * ahead[1] - z[1] * ahead[0]]
    size = math.sqrt(sum(c * c for c in y))
    y = [c / size for c in y]
    x = [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]]
    w = math.sqrt(max(1.0 + x[0] + y[1] + z[2], 1e-12)) / 2
    return [w, (y[2] - z[1]) / (4 * w), (z[0] - x[2]) / (4 * w), (x[1] - y[0]) / (4 * w)]


class Fake:
    def __init__(self, kind, port, factor, trouble):
        self.kind, self.factor, self.trouble = kind, factor, trouble
        where = f"udpout:127.0.0.1:{port}" if kind is Px4 else f"tcpin:127.0.0.1:{port}"
        self.link = mavutil.mavlink_connection(where, source_system=1, source_component=1)
        self.send = self.link.mav
        self.t, self.p, self.v, self.a, self.heading = 60.0, [0.0] * 3, [0.0] * 3, [0.0] * 3, 0.0
        self.mode, self.armed, self.status, self.home = kind.BEGIN, False, m.MAV_STATE_STANDBY, [0.0, 0.0]
        self.setpoints, self.setpoint, self.ground_station, self.rising = [], None, -9.0, None
        self.asked = False  # for OFFBOARD, before
        self.items, self.incoming, self.expected, self.current, self.entered = [], None, 0, 0, None
        self.parameters = {name: list(value) for name, value in kind.PARAMETERS.items()}
        self.intervals, self.due, self.texts = {0: 1.0}, {}, 0

    def run(self):
        due = time.monotonic()
        while True:
            if self.kind is ArduPilot:
                self.factor = max(self.factor, self.parameters["SIM_SPEEDUP"][0])
            self.hear(max(due - time.monotonic(), 0.0))
            # A busy machine is no failsafe: set points that are late on the wall are waited for.
            until = time.monotonic() + 2.0
            while self.mode == "OFFBOARD" and self.t - self.setpoints[-1] > 0.4 and time.monotonic() < until:
                self.hear(0.02)
            if due <= time.monotonic():
                due = time.monotonic() + STEP_S / self.factor
                self.step()
                if not (self.trouble == "silent" and self.entered is not None and self.t > self.entered + 1.0):
                    self.tell()

    def hear(self, patience_s):
        select.select([self.link.fd] if isinstance(self.link.fd, int) and self.link.fd >= 0 else [], [], [], patience_s)
        message = self.link.recv_msg()
        while message is not None:
            handle = getattr(self, "on_" + message.get_type(), None)
            if handle:
                handle(message)
            message = self.link.recv_msg()

    # ---- flight ---------------------------------------------------------------------------------------------------
    def goal(self):
        if self.rising is not None:
            return [*self.p[:2], -self.rising], [0.0] * 3
        if self.mode == self.kind.STEERED and self.setpoint:
            return self.setpoint
        if self.mode == self.kind.MISSION and self.items:
            return self.fly_mission(), [0.0] * 3
        if self.mode == "LAND":
            return [*self.p[:2], 0.5], [0.0] * 3
        return list(self.p), [0.0] * 3

    def fly_mission(self):
        number = min(self.current, len(self.items) - 1)
        item = self.items[number]
        goal = local(item)
        if self.trouble == "stall" and number == self.kind.HOME_ITEMS + 2:
            return list(self.p)
        takeoff = item.command == m.MAV_CMD_NAV_TAKEOFF
        radius = (item.param2 or self.parameters["NAV_ACC_RAD"][0]) if self.kind is Px4 else self.parameters["WPNAV_RADIUS"][0] / 100
        if takeoff:
            goal[:2] = self.p[:2]
        if math.dist(self.p[:2], goal[:2]) <= radius and abs(self.p[2] - goal[2]) <= min(radius, 0.8) and self.current < len(self.items):
            self.send.mission_item_reached_send(self.current)
            self.current += 1
            if self.current == len(self.items):
                self.mode = self.kind.AFTER
        return goal

    def step(self):
        self.t += STEP_S
        px4 = self.kind is Px4
        if px4 and self.mode == "OFFBOARD" and self.t - self.setpoints[-1] > 1.0:
            self.fail("LOITER", "Failsafe activated: no offboard control")
        if self.entered is not None and self.t > self.entered + 1.0:
            if self.trouble == "failsafe" and self.mode != "RTL":
                self.fail("RTL", "Failsafe: battery low, returning")
            if self.trouble == "gone":
                raise SystemExit
            if self.trouble == "crash" and self.armed:
                self.armed = False
                self.text(m.MAV_SEVERITY_CRITICAL, "Crash: Disarming: AngErr=72>30, Accel=1.2<3.0")
        if not self.armed:
            falling = self.p[2] < -0.01
            self.a, self.v = [0.0, 0.0, 0.0], [0.0, 0.0, 5.0 if falling else 0.0]
            self.p[2] = min(self.p[2] + STEP_S * self.v[2], 0.0)
            return
        goal, ahead = self.goal()
        top = self.parameters["MPC_XY_VEL_MAX"][0] if px4 else self.parameters["WPNAV_SPEED"][0] / 100
        wanted = [1.5 * (g - p) + v for g, p, v in zip(goal, self.p, ahead)]
        share = min(1.0, top / max(math.hypot(*wanted), 1e-9))
        self.a = [max(-5.0, min(5.0, 4.0 * (share * w - v))) for w, v in zip(wanted, self.v)]
        for i in range(3):
            self.v[i] += STEP_S * self.a[i]
            self.p[i] += STEP_S * self.v[i]
        if self.p[2] > 0.0:
            self.p[2], self.v = 0.0, [0.0] * 3
            self.armed = self.mode != "LAND"
        if self.rising is not None and -self.p[2] > 0.95 * self.rising:
            self.rising = None

    def fail(self, mode, words):
        self.mode, self.status = mode, m.MAV_STATE_CRITICAL
        self.text(m.MAV_SEVERITY_CRITICAL, words)

    def landed(self):
        return self.p[2] > -0.05 and abs(self.v[2]) < 0.05

    # ---- what it says ---------------------------------------------------------------------------------------------
    def text(self, severity, words):
        """A message has room for fifty bytes: longer texts come in pieces."""
        self.texts += 1
        pieces = [words[i:i + 50] for i in range(0, len(words), 50)]
        for number, piece in enumerate(pieces):
            self.send.statustext_send(severity, piece.encode(), self.texts if len(pieces) > 1 else 0, number)

    def tell(self):
        for number, interval in self.intervals.items():
            if self.t >= self.due.get(number, 0.0):
                self.due[number] = max(self.due.get(number, self.t) + interval, self.t)
                self.one(number)

    def one(self, number):
        stamp = round(1000 * self.t)
        if number == 0 and not (self.trouble == "no-heartbeat" and self.entered is not None):
            armed = m.MAV_MODE_FLAG_SAFETY_ARMED if self.armed else 0
            self.send.heartbeat_send(m.MAV_TYPE_QUADROTOR, self.kind.AUTOPILOT, m.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | armed,
                                     self.kind.MODES[self.mode], self.status)
        elif number == m.MAVLINK_MSG_ID_LOCAL_POSITION_NED and self.t >= 60.0 + READY_S - 1.0:
            self.send.local_position_ned_send(stamp, *self.p, *self.v)
        elif number == m.MAVLINK_MSG_ID_ATTITUDE_QUATERNION:
            # A little later than the position, as other tasks have it.
            self.send.attitude_quaternion_send(stamp + 4, *attitude(self.a, self.heading), 0.0, 0.0, 0.0)
        elif number == m.MAVLINK_MSG_ID_EXTENDED_SYS_STATE:
            self.send.extended_sys_state_send(0, m.MAV_LANDED_STATE_ON_GROUND if self.landed() else m.MAV_LANDED_STATE_IN_AIR)
        elif number == m.MAVLINK_MSG_ID_MISSION_CURRENT:
            self.send.mission_current_send(min(self.current, max(len(self.items) - 1, 0)))
        elif number == m.MAVLINK_MSG_ID_HIL_STATE_QUATERNION and self.kind is Px4:
            lat, lon = degrees(*self.p[:2])
            v = [round(100 * c) for c in self.v]
            self.send.hil_state_quaternion_send(round(1e6 * self.t), attitude(self.a, self.heading), 0, 0, 0, round(lat * 1e7), round(lon * 1e7),
                                                round(1000 * (ORIGIN[2] - self.p[2])), *v, 0, 0, 0, 0, 0)
        elif number == m.MAVLINK_MSG_ID_SIM_STATE and self.kind is ArduPilot:
            lat, lon = degrees(*self.p[:2])
            self.send.sim_state_send(*attitude(self.a, self.heading), 0, 0, 0, 0, 0, 0, 0, 0, 0, lat, lon, ORIGIN[2] - self.p[2], 0, 0, *self.v,
                                     round(lat * 1e7), round(lon * 1e7))

    # ---- what it is told ------------------------------------------------------------------------------------------
    def on_HEARTBEAT(self, message):
        if message.type == m.MAV_TYPE_GCS:
            self.ground_station = self.t

    def on_COMMAND_LONG(self, message):
        if message.target_system == 1:
            self.send.command_ack_send(message.command, self.obey(message))

    def obey(self, c):
        if c.command == m.MAV_CMD_SET_MESSAGE_INTERVAL:
            self.intervals[int(c.param1)] = c.param2 / 1e6
            return ACCEPTED
        if c.command == m.MAV_CMD_REQUEST_MESSAGE and int(c.param1) == m.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN:
            if self.t < 60.0 + READY_S:
                return FAILED
            self.send.gps_global_origin_send(round(ORIGIN[0] * 1e7), round(ORIGIN[1] * 1e7), round(ORIGIN[2] * 1000))
            return ACCEPTED
        if c.command == m.MAV_CMD_COMPONENT_ARM_DISARM:
            return self.arm(c.param1 == 1.0)
        if c.command == m.MAV_CMD_DO_SET_MODE:
            return self.change(self.kind.mode_number(c.param1, c.param2, c.param3))
        if c.command == m.MAV_CMD_NAV_TAKEOFF and self.kind is ArduPilot:
            if self.mode != "GUIDED" or not self.armed:
                return FAILED
            self.rising = c.param7 + HOME_ABOVE_M
            return ACCEPTED
        if c.command == m.MAV_CMD_NAV_LAND:
            self.mode = "LAND"
            return ACCEPTED
        if c.command == m.MAV_CMD_MISSION_START:
            return self.start()
        return UNSUPPORTED

    def arm(self, on):
        px4 = self.kind is Px4
        words = None
        if self.t < 60.0 + READY_S:
            words = "Preflight Fail: ekf2 missing data" if px4 else "PreArm: EKF attitude is bad"
        elif self.t - self.ground_station > 3.0:
            words = "Preflight Fail: No connection to the GCS" if px4 else "PreArm: GCS failsafe on"
        elif self.trouble == "arming-denied":
            words = "Arming denied: Resolve system health failures first" if px4 else "Arm: Compass not healthy"
        elif self.kind is ArduPilot and self.mode in ("AUTO", "RTL", "LAND"):
            words = f"Arm: {self.mode} mode not armable"
        if on and words:
            self.text(m.MAV_SEVERITY_CRITICAL, words)
            return REJECTED if px4 else FAILED
        self.armed, self.status = on, m.MAV_STATE_ACTIVE if on else m.MAV_STATE_STANDBY
        return ACCEPTED

    def change(self, number):
        mode = next((name for name, of in self.kind.MODES.items() if of == number), None)
        if mode is None:
            return UNSUPPORTED
        if self.kind is Px4 and mode == "OFFBOARD":
            # A stream of 2 Hz and more for a second.
            recent = [s for s in self.setpoints if s > self.t - 1.2]
            gaps = [b - a for a, b in zip(recent, recent[1:] + [self.t])]
            first, self.asked = not self.asked, True
            if not recent or self.t - recent[0] < 1.0 or max(gaps) > 0.5 or (first and self.trouble == "arming-denied"):
                self.text(m.MAV_SEVERITY_CRITICAL, "Switching to Offboard is currently not available")
                return REJECTED
        if self.kind is ArduPilot and self.t < 60.0 + READY_S and mode == "GUIDED":
            self.text(m.MAV_SEVERITY_WARNING, "Mode change to GUIDED failed: requires position")
            return FAILED
        if mode == self.kind.MISSION:
            return self.start()
        self.mode, self.rising = mode, None
        return ACCEPTED

    def start(self):
        """Into the mission: PX4 wants a valid one, ArduPilot to be armed, and on the ground a take-off first."""
        first = self.items[self.kind.HOME_ITEMS:]
        if self.kind is ArduPilot and not self.armed:
            return FAILED
        if not first or (first[0].command != m.MAV_CMD_NAV_TAKEOFF and (self.kind is Px4 or self.landed())):
            words = "Mission rejected: Takeoff waypoint required" if self.kind is Px4 else "Auto: Missing Takeoff Cmd"
            self.text(m.MAV_SEVERITY_CRITICAL, words)
            return DENIED if self.kind is Px4 else FAILED
        if self.kind is Px4 and not self.armed and self.arm(True) != ACCEPTED:
            return REJECTED
        self.mode, self.current, self.entered = self.kind.MISSION, self.kind.HOME_ITEMS, self.t
        return ACCEPTED

    def on_SET_POSITION_TARGET_LOCAL_NED(self, s):
        if s.coordinate_frame != m.MAV_FRAME_LOCAL_NED:
            return
        self.setpoints = [*self.setpoints[-200:], self.t]
        moving = not s.type_mask & m.POSITION_TARGET_TYPEMASK_VX_IGNORE
        self.setpoint = ([s.x, s.y, s.z], [s.vx, s.vy, s.vz] if moving else [0.0] * 3)
        if self.mode == self.kind.STEERED:
            self.heading = s.yaw
            if moving and self.entered is None:
                self.entered = self.t

    def parameter(self, name):
        value, kind = self.parameters[name]
        if self.kind.BYTEWISE and kind != REAL:
            value = struct.unpack("<f", struct.pack("<i", int(value)))[0]
        self.send.param_value_send(name.encode(), value, kind, len(self.parameters), list(self.parameters).index(name))

    def on_PARAM_REQUEST_READ(self, message):
        if message.param_id in self.parameters:
            self.parameter(message.param_id)

    def on_PARAM_SET(self, message):
        if message.param_id in self.parameters and self.parameters[message.param_id][1] == message.param_type:
            value = message.param_value
            if self.kind.BYTEWISE and message.param_type != REAL:
                value = struct.unpack("<i", struct.pack("<f", value))[0]
            self.parameters[message.param_id][0] = value
            self.parameter(message.param_id)

    # ---- missions -------------------------------------------------------------------------------------------------
    def acknowledge(self, message, result):
        self.incoming = None
        self.send.mission_ack_send(message.get_srcSystem(), message.get_srcComponent(), result, m.MAV_MISSION_TYPE_MISSION)

    def on_MISSION_COUNT(self, message):
        if self.trouble == "upload-refused" or message.count > 500:
            self.text(m.MAV_SEVERITY_CRITICAL, "Mission: Storage failure")
            return self.acknowledge(message, m.MAV_MISSION_NO_SPACE)
        self.incoming, self.expected = [None] * message.count, 0
        self.send.mission_request_int_send(message.get_srcSystem(), message.get_srcComponent(), 0, m.MAV_MISSION_TYPE_MISSION)

    def on_MISSION_ITEM_INT(self, message):
        if self.incoming is None:
            return self.acknowledge(message, m.MAV_MISSION_ERROR)
        if message.seq != self.expected:
            return self.acknowledge(message, m.MAV_MISSION_INVALID_SEQUENCE)
        if message.frame not in self.kind.FRAMES:
            return self.acknowledge(message, m.MAV_MISSION_UNSUPPORTED_FRAME)
        self.incoming[message.seq] = message
        self.expected += 1
        if self.expected < len(self.incoming):
            number = self.expected
            return self.send.mission_request_int_send(message.get_srcSystem(), message.get_srcComponent(), number, m.MAV_MISSION_TYPE_MISSION)
        self.items, self.current = self.incoming, 0
        self.acknowledge(message, m.MAV_MISSION_ACCEPTED)


def degrees(north, east):
    lat = ORIGIN[0] + math.degrees(north / RADIUS_M)
    return lat, ORIGIN[1] + math.degrees(east / RADIUS_M / math.cos(math.radians(ORIGIN[0])))


def local(item):
    """North, east, down of an item: its altitude is above the sea, or above home."""
    above = ORIGIN[2] if item.frame in (0, 5) else -HOME_ABOVE_M
    north = math.radians(item.x / 1e7 - ORIGIN[0]) * RADIUS_M
    return [north, math.radians(item.y / 1e7 - ORIGIN[1]) * RADIUS_M * math.cos(math.radians(ORIGIN[0])), above - item.z]


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("kind", choices=["px4", "ardupilot"])
    parser.add_argument("port", type=int)
    parser.add_argument("--trouble", default="")
    parser.add_argument("--factor", type=float, default=float(os.environ.get("PX4_SIM_SPEED_FACTOR", 1)))
    given = parser.parse_args()
    Fake({"px4": Px4, "ardupilot": ArduPilot}[given.kind], given.port, given.factor, given.trouble).run()
