"""A vehicle over MAVLink as the executors for PX4 and ArduPilot see it: what it says of itself, commands with their
answers, parameters, and the upload of missions. `pip install pymavlink==2.4.50`.

Time is the vehicle's (`time_boot_ms`): simulations run faster or slower than the clock on the wall, which only says
whether anybody is there at all.
"""
import math
import os
import struct
import time

os.environ["MAVLINK20"] = "1"
from pymavlink import mavutil  # noqa: E402

mavlink = mavutil.mavlink
HEARD_S = 1.0  # on the wall: until what was sent is sent again
STREAM_S = 0.1
WARNING = mavlink.MAV_SEVERITY_WARNING


class Refused(Exception):
    """Why a mission cannot be flown."""


def name_of(enum, value):
    entry = mavlink.enums[enum].get(value)
    return entry.name if entry else f"{enum} {value}"


def closed():
    raise ConnectionError("the autopilot closed it")


def between(one, other, now):
    """The quaternion at `now`, straight between two stamped ones and of their length."""
    (t, a), (u, b) = one, other
    share = min(max((now - t) / (u - t), 0.0), 1.0)
    sign = math.copysign(1.0, sum(x * y for x, y in zip(a, b)))
    return tuple((1 - share) * x + sign * share * y for x, y in zip(a, b))


class Vehicle:
    """`autopilot` says what differs: see px4_mavlink.py."""

    def __init__(self, address, autopilot, link_s, rate_hz, truth):
        self.autopilot, self.link_s, self.address, self.truth = autopilot, link_s, address, truth
        self.mode = self.armed = self.status = self.landed = self.time = self.origin = None
        self.place = self.attitude = self.acknowledged = self.parameter = None
        self.current = self.reached = -1
        # What it is steered by, sent again as long as nothing else is: a stream in the vehicle's own time.
        self.target, self.steered = None, -1.0
        self.waiting, self.samples = [], []
        self.texts, self.beat, self.beaten_s = [], None, None
        self.told = 0.0
        self.link = self.connect()
        self.heard = time.monotonic()
        self.wait_for(lambda: self.mode, link_s, f"no heartbeat at {address}")
        interval = 1e6 / rate_hz
        wanted = [(m, interval) for m in (autopilot.TRUTH if truth else [])]
        wanted += [(mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, interval), (mavlink.MAVLINK_MSG_ID_ATTITUDE_QUATERNION, interval)]
        wanted += [(mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE, 2e5), (mavlink.MAVLINK_MSG_ID_MISSION_CURRENT, 1e5)]
        for message, microseconds in wanted:
            self.must(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, f"message {message} at an interval", message, microseconds)
        self.wait_for(lambda: self.place and self.attitude, link_s, "no LOCAL_POSITION_NED and ATTITUDE_QUATERNION")
        self.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN)
        self.wait_for(lambda: self.origin, link_s, "no GPS_GLOBAL_ORIGIN")

    def connect(self):
        until = time.monotonic() + self.link_s
        while True:
            try:
                link = mavutil.mavlink_connection(self.address, source_system=255, source_component=190, retries=1)
                link.handle_eof = closed
                return link
            except OSError as cause:
                if time.monotonic() > until:
                    raise Refused(f"nobody listens at {self.address}: {cause}") from cause
                time.sleep(0.2)

    def close(self):
        self.link.close()

    # ---- what it says ---------------------------------------------------------------------------------------------
    def listen(self, patience_s=0.05):
        """Takes in one message, if one comes in time, and gives it."""
        now = time.monotonic()
        if now - self.told > 1.0 or self.beaten_s is None or (self.time or 0.0) - self.beaten_s > 1.0:
            self.told, self.beaten_s = now, self.time or 0.0
            self.link.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE)
        try:
            message = self.link.recv_msg()
            if message is None:
                self.link.select(patience_s)
                message = self.link.recv_msg()
        except OSError as cause:
            raise Refused(f"the link is lost: {cause}{self.complaints()}") from cause
        if message is None:
            if time.monotonic() - self.heard > self.link_s:
                lost = f"the link is lost: nothing was heard for {self.link_s:g} s" if self.mode else f"no heartbeat at {self.address}"
                raise Refused(lost + self.complaints())
            return None
        if message.get_srcComponent() != 1 or message.get_type() == "BAD_DATA":
            return None
        self.heard = time.monotonic()
        take = getattr(self, "take_" + message.get_type(), None)
        if take:
            take(message)
        if self.beat is not None and self.time is not None and self.time - self.beat > self.link_s:
            raise Refused(f"the link is lost: no HEARTBEAT for {self.time - self.beat:.1f} s of flight{self.complaints()}")
        return message

    def take_HEARTBEAT(self, message):
        self.link.target_system, self.link.target_component = message.get_srcSystem(), message.get_srcComponent()
        self.beat = self.time
        self.armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
        self.mode, self.status = self.autopilot.mode_name(message.custom_mode), message.system_status

    def take_LOCAL_POSITION_NED(self, message):
        self.tell_time(message.time_boot_ms / 1000)
        self.place = (message.time_boot_ms / 1000, (message.x, message.y, message.z), (message.vx, message.vy, message.vz))
        if not self.truth:
            self.waiting = [*self.waiting[-50:], self.place]
        if self.target and self.time - self.steered >= STREAM_S:
            self.steer(*self.target)

    def take_ATTITUDE_QUATERNION(self, message):
        """Positions and attitudes have stamps of their own: a position's attitude lies between the two about it."""
        before, self.attitude = self.attitude, (message.time_boot_ms / 1000, (message.q1, message.q2, message.q3, message.q4))
        if before and before[0] < self.attitude[0]:
            ready = [place for place in self.waiting if place[0] <= self.attitude[0]]
            self.waiting = self.waiting[len(ready):]
            self.samples += [(*place, between(before, self.attitude, place[0])) for place in ready]

    def take_HIL_STATE_QUATERNION(self, message):
        """PX4's own truth: mm, cm/s."""
        if self.truth and self.origin:
            now, velocity = message.time_usec / 1e6, (message.vx / 100, message.vy / 100, message.vz / 100)
            self.take_truth(now, message.lat / 1e7, message.lon / 1e7, message.alt / 1000, velocity, message.attitude_quaternion)

    def take_SIM_STATE(self, message):
        """ArduPilot's own truth. It has no time: that of the last message which had one."""
        if self.truth and self.origin and self.time is not None:
            lat, lon = (message.lat_int / 1e7, message.lon_int / 1e7) if message.lat_int else (message.lat, message.lon)
            velocity, q = (message.vn, message.ve, message.vd), (message.q1, message.q2, message.q3, message.q4)
            self.take_truth(self.time, lat, lon, message.alt, velocity, q)

    def take_truth(self, now, lat, lon, altitude, velocity, q):
        north, east = self.origin[0].metres(lat, lon)
        self.samples.append((now, (north, east, self.origin[1] - altitude), velocity, tuple(q)))

    def tell_time(self, now):
        if self.time is not None and now < self.time - 1.0:
            raise Refused(f"the autopilot began anew: its clock went from {self.time:.1f} s to {now:.1f} s")
        self.time = max(now, self.time or 0.0)
        self.beat = self.time if self.beat is None else self.beat

    def take_GPS_GLOBAL_ORIGIN(self, message):
        self.origin = (self.autopilot.PROJECTION(message.latitude / 1e7, message.longitude / 1e7), message.altitude / 1000)

    def take_EXTENDED_SYS_STATE(self, message):
        self.landed = message.landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND

    def take_MISSION_CURRENT(self, message):
        self.current = message.seq

    def take_MISSION_ITEM_REACHED(self, message):
        self.reached = max(self.reached, message.seq)

    def take_COMMAND_ACK(self, message):
        self.acknowledged = (message.command, message.result)

    def take_PARAM_VALUE(self, message):
        self.parameter = message

    def take_STATUSTEXT(self, message):
        text = message.text.rstrip("\0").strip()
        if message.chunk_seq and self.texts and self.texts[-1][1] == message.id:
            severity, number, before = self.texts[-1]
            self.texts[-1] = (severity, number, before + text)
        elif text:
            self.texts.append((message.severity, message.id, text))
        self.texts = self.texts[-50:]

    def complaints(self):
        """The last things that it complained of, in its own words."""
        texts = [text for severity, _, text in self.texts if severity <= WARNING]
        last = list(dict.fromkeys(reversed(texts)))[:3]
        return "; it says: " + " | ".join(reversed(last)) if last else ""

    # ---- waiting --------------------------------------------------------------------------------------------------
    def wait_for(self, happened, patience_s, otherwise):
        """Until it happened: at most so long by the vehicle's clock and, as long as that stands, by the wall's."""
        wall, begun, seen = time.monotonic(), self.time, self.time
        while not happened():
            self.listen()
            begun = self.time if begun is None else begun
            if self.time != seen:
                wall, seen = time.monotonic(), self.time
            if (self.time or 0.0) - (begun or 0.0) > patience_s or time.monotonic() - wall > max(patience_s, self.link_s):
                raise Refused((otherwise() if callable(otherwise) else otherwise) + self.complaints())

    def wait(self, seconds):
        until = self.time + seconds
        self.wait_for(lambda: self.time >= until, 2 * seconds + 1, "its clock stands")

    def hear(self, happened, send, tries=4):
        """Sends until it happened; whether it did. What is lost on the way is sent again."""
        for attempt in range(tries):
            send(attempt)
            until = time.monotonic() + HEARD_S
            while time.monotonic() < until:
                self.listen(0.02)
                if happened():
                    return True
        return False

    # ---- what it is told ------------------------------------------------------------------------------------------
    def command(self, command, *parameters):
        """The result (MAV_RESULT) of a command, None if it is never answered."""
        self.acknowledged = None
        values = [float(p) for p in parameters] + [0.0] * (7 - len(parameters))
        target = (self.link.target_system, self.link.target_component)
        answered = lambda: self.acknowledged and self.acknowledged[0] == command and self.acknowledged[1] != mavlink.MAV_RESULT_IN_PROGRESS
        heard = self.hear(answered, lambda attempt: self.link.mav.command_long_send(*target, command, attempt, *values))
        return self.acknowledged[1] if heard else None

    def must(self, command, what, *parameters):
        result = self.command(command, *parameters)
        if result != mavlink.MAV_RESULT_ACCEPTED:
            self.refuse(what, result)

    def refuse(self, what, result):
        for _ in range(10):  # its reasons may follow its answer
            self.listen(0.02)
        answer = "not answered" if result is None else f"refused with {name_of('MAV_RESULT', result)}"
        raise Refused(f"{what}: {answer}{self.complaints()}")

    def arm(self, patience_s):
        """Tries until the checks before flight pass: estimators take their time."""
        begun = self.time
        while not self.armed:
            result = self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
            if result == mavlink.MAV_RESULT_ACCEPTED:
                self.wait_for(lambda: self.armed, 5, "arming was accepted, but it is not armed")
            elif self.time - begun > patience_s:
                self.refuse("arming", result)
            else:
                self.wait(1.0)

    def set_mode(self, mode):
        number = self.autopilot.MODES[mode]
        self.must(mavlink.MAV_CMD_DO_SET_MODE, f"mode {mode}", mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *number)
        self.wait_for(lambda: self.mode == mode, 5, f"mode {mode} was accepted, but it is {self.mode}")

    def enter(self, mode, patience_s):
        """The same, tried until it is accepted: a stream may not be heard yet, an estimator not know the place."""
        begun = self.time
        while self.mode != mode:
            result = self.command(mavlink.MAV_CMD_DO_SET_MODE, mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *self.autopilot.MODES[mode])
            if result != mavlink.MAV_RESULT_ACCEPTED and self.time - begun > patience_s:
                self.refuse(f"mode {mode}", result)
            self.wait(1.0)

    def set_parameter(self, names, value):
        """`names` are pairs of a name and what the value is multiplied with: the first that it knows is set."""
        for name, factor in names:
            target = (self.link.target_system, self.link.target_component)
            known = lambda: self.parameter is not None and self.parameter.param_id == name
            self.parameter = None
            if not self.hear(known, lambda _: self.link.mav.param_request_read_send(*target, name.encode(), -1), tries=2):
                continue
            kind, wanted = self.parameter.param_type, value * factor
            sent = self.encoded(wanted, kind)
            is_set = lambda: known() and math.isclose(self.decoded(self.parameter.param_value, kind), wanted, rel_tol=1e-5, abs_tol=1e-6)
            self.parameter = None
            if not self.hear(is_set, lambda _: self.link.mav.param_set_send(*target, name.encode(), sent, kind), tries=2):
                raise Refused(f"parameter {name} does not become {wanted:g}{self.complaints()}")
            return
        raise Refused(f"no parameter {' or '.join(name for name, _ in names)}")

    def encoded(self, value, kind):
        """PX4 has whole numbers as bytes in a float's place, ArduPilot as floats."""
        if kind == mavlink.MAV_PARAM_TYPE_REAL32 or not self.autopilot.BYTEWISE:
            return value
        return struct.unpack("<f", struct.pack("<i", round(value)))[0]

    def decoded(self, value, kind):
        if kind == mavlink.MAV_PARAM_TYPE_REAL32 or not self.autopilot.BYTEWISE:
            return value
        return struct.unpack("<i", struct.pack("<f", value))[0]

    def upload(self, items):
        """Hands a mission over: (command, p1 … p4, north, east, down) each, as the vehicle asks for them."""
        target, asked = (self.link.target_system, self.link.target_component), -1
        until, answer, tries = 0.0, None, 0
        while answer is None:
            if asked < 0 and time.monotonic() > until:
                if tries == 4:
                    raise Refused(f"mission upload: not answered{self.complaints()}")
                tries, until = tries + 1, time.monotonic() + HEARD_S
                self.link.mav.mission_count_send(*target, len(items), mavlink.MAV_MISSION_TYPE_MISSION)
            message = self.listen(0.02)
            kind = message.get_type() if message else None
            if kind in ("MISSION_REQUEST_INT", "MISSION_REQUEST"):
                if not 0 <= message.seq < len(items):
                    raise Refused(f"mission upload: it asks for item {message.seq} of {len(items)}")
                asked, until = message.seq, time.monotonic() + self.link_s
                self.send_item(target, asked, items[asked])
            elif kind == "MISSION_ACK" and message.mission_type == mavlink.MAV_MISSION_TYPE_MISSION:
                answer = message.type
            elif asked >= 0 and time.monotonic() > until:
                raise Refused(f"mission upload: it asked for nothing after item {asked}{self.complaints()}")
        if answer != mavlink.MAV_MISSION_ACCEPTED:
            raise Refused(f"mission upload: refused with {name_of('MAV_MISSION_RESULT', answer)} at item {max(asked, 0)}{self.complaints()}")
        self.current = self.reached = -1

    def send_item(self, target, seq, item):
        command, p1, p2, p3, p4, north, east, down = item
        lat, lon = self.origin[0].degrees(north, east)
        # By altitude above the sea, as the origin of the local frame has it: home moves when the vehicle is armed.
        self.link.mav.mission_item_int_send(
            *target, seq, mavlink.MAV_FRAME_GLOBAL_INT, command, seq == 0, 1, p1, p2, p3, p4,
            round(lat * 1e7), round(lon * 1e7), self.origin[1] - down, mavlink.MAV_MISSION_TYPE_MISSION)

    def steer(self, p_ned, v_ned, heading):
        """A set point: where to be, how fast if that is given, and which way to look."""
        self.target, self.steered = (p_ned, v_ned, heading), self.time
        ignored = mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE
        ignored |= mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
        if v_ned is None:
            ignored |= mavlink.POSITION_TARGET_TYPEMASK_VX_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_VY_IGNORE
            ignored |= mavlink.POSITION_TARGET_TYPEMASK_VZ_IGNORE
        self.link.mav.set_position_target_local_ned_send(
            round(1000 * self.time), self.link.target_system, self.link.target_component, mavlink.MAV_FRAME_LOCAL_NED,
            ignored, *p_ned, *(v_ned or (0.0, 0.0, 0.0)), 0.0, 0.0, 0.0, heading, 0.0)
