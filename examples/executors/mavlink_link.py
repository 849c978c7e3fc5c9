"""What a vehicle says of itself over MAVLink, and waiting for it to happen. `pip install pymavlink==2.4.50`.

Time is the vehicle's (`time_boot_ms`): simulations run faster or slower than the clock on the wall, which only says
whether anybody is there at all.
"""
import math
import os
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


class Link:
    """The last that was heard of everything; `steer`, which keeps a set point flowing, is the vehicle's. `autopilot` says what differs: see px4_mavlink.py."""

    def __init__(self, address, autopilot, link_s, truth):
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
        self.tell_time(message.time_boot_ms / 1000)
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
