"""A vehicle over MAVLink as the executors for PX4 and ArduPilot see it: commands with their answers, parameters, set points
and the upload of missions; what it says is in mavlink_link.py.
"""
import math
import struct
import time

from mavlink_link import HEARD_S, Link, Refused, mavlink, name_of


class Vehicle(Link):
    """Whose estimator knows where it is, within `ready_s`, and which says so `rate_hz` times a second."""

    def __init__(self, address, autopilot, link_s, ready_s, rate_hz, truth):
        super().__init__(address, autopilot, link_s, truth)
        interval = 1e6 / rate_hz
        wanted = [mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, mavlink.MAVLINK_MSG_ID_ATTITUDE_QUATERNION, *(autopilot.TRUTH if truth else [])]
        for message in wanted:
            self.must(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, f"message {message} at an interval", message, interval)
        for message, microseconds in ((mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE, 2e5), (mavlink.MAVLINK_MSG_ID_MISSION_CURRENT, 1e5)):
            self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, message, microseconds)
        # Estimators know the place only after a while.
        self.wait_for(lambda: self.place and self.attitude, ready_s, "no LOCAL_POSITION_NED and ATTITUDE_QUATERNION")
        begun = self.time
        while not self.origin:
            self.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN)
            self.wait(0.5)
            if not self.origin and self.time - begun > ready_s:
                raise Refused(f"no GPS_GLOBAL_ORIGIN{self.complaints()}")

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
        self.texts.clear()  # what it had against the mode is no reason for what comes after

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
