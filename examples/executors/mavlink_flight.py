"""What the executors for PX4 and ArduPilot share: a mission is flown over MAVLink, by set points or as an uploaded one,
and hairpin is told the poses. See px4_mavlink.py and ardupilot_mavlink.py, which have the options' meaning in their heads.
"""
import argparse
import json
import math
import os
import queue
import shlex
import signal
import subprocess
import sys
import threading

# What libraries print is not for hairpin: answers have a stream of their own, and stdout becomes stderr.
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)

from mavlink_frames import World  # noqa: E402
from mavlink_link import Refused, mavlink  # noqa: E402
from mavlink_setpoints import Timed, Waypoints  # noqa: E402
from mavlink_vehicle import Vehicle  # noqa: E402

BATCH, LINGER_S, APPROACH_S = 200, 2.0, 120.0


def say(**message):
    try:
        print(json.dumps(message, allow_nan=False), file=answers, flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), answers.fileno())
        sys.exit()


class Executor:
    def __init__(self, autopilot, options):
        self.autopilot, self.options = autopilot, options
        self.vehicle = self.program = None
        self.address, self.instance, self.lock = instance_of(options.connect, autopilot.PORT_STEP)

    # ---- the vehicle ----------------------------------------------------------------------------------------------
    def restart(self):
        """A fresh simulation, where `--start` says how."""
        self.part()
        self.end_program()
        words = shlex.split(self.options.start.replace("{instance}", str(self.instance)).replace("{port}", self.address.split(":")[-1]))
        environment = dict(os.environ, HAIRPIN_INSTANCE=str(self.instance), **self.autopilot.environment(self.options))
        while words and "=" in words[0]:
            name, value = words.pop(0).split("=", 1)
            environment[name] = value
        try:
            self.program = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=sys.stderr, stderr=sys.stderr, env=environment)
        except (OSError, IndexError) as cause:
            raise Refused(f"--start: {cause}") from cause

    def part(self):
        if self.vehicle:
            self.vehicle.close()
        self.vehicle = None

    def end_program(self):
        if self.program:
            self.program.terminate()
            try:
                self.program.wait(1)
            except subprocess.TimeoutExpired:
                self.program.kill()
                self.program.wait()
        self.program = None

    def meet(self):
        if self.vehicle is None:
            o = self.options
            self.vehicle = Vehicle(self.address, self.autopilot, o.link_timeout_s, o.arm_patience_s, o.rate_hz, o.truth)
            for name, value in o.param:
                self.vehicle.set_parameter([(name, 1.0)], value)
            self.autopilot.prepare(self.vehicle, o)
        return self.vehicle

    def idle(self):
        """Between missions it is listened to, so that nothing old lies in wait; what fails, fails the next mission."""
        try:
            self.vehicle.listen(0.02)
        except Refused as cause:
            print(f"{self.autopilot.NAME}: {cause}", file=sys.stderr, flush=True)
            self.part()

    # ---- a mission ------------------------------------------------------------------------------------------------
    def fly(self, mission, of):
        if len(mission["waypoints_m"]) < 2:
            raise Refused("a mission without waypoints")
        if self.options.start:
            self.restart()
        vehicle, world = self.meet(), World.of(mission)
        vehicle.texts.clear()
        if self.options.limits:
            for limit, names in self.autopilot.LIMITS.items():
                if limit in mission["limits"]:
                    vehicle.set_parameter(names, mission["limits"][limit])
        vehicle.set_parameter(self.autopilot.RADIUS, mission["accept"]["radius_m"])
        self.approach(vehicle, world, mission)
        vehicle.texts.clear()  # what it said on the way is no reason any more
        if self.options.mode == self.autopilot.UPLOADED:
            first = self.hand_over(vehicle, world, mission)
            mode, pilot = self.autopilot.MISSION, None
        else:
            mode = self.autopilot.STEERED
            timed = self.options.setpoints == "timed" and len(mission["timed"]) > 1
            pilot, first = Timed(mission) if timed else Waypoints(mission), None
            vehicle.samples.clear()
        reason = self.record(vehicle, world, mission, of, mode, pilot, first)
        say(type="end", reason=reason, **of)
        if not self.options.start:
            self.settle(vehicle)

    def settle(self, vehicle):
        """Waits for the next mission where it is. What was flown is told: what fails now, fails the next one."""
        try:
            self.autopilot.hold(vehicle)
        except Refused as cause:
            print(f"{self.autopilot.NAME}: {cause}", file=sys.stderr, flush=True)
            self.part()

    def approach(self, vehicle, world, mission):
        """To rest at the first waypoint, from the ground or from wherever the last mission ended."""
        start, heading = world.turned(mission["waypoints_m"][0]), world.compass(mission["yaw_rad"][0])
        climb = vehicle.landed is not False or not vehicle.armed
        self.autopilot.take_off(vehicle, -start[2], heading, self.options.arm_patience_s)
        near = min(0.5 * mission["accept"]["radius_m"], 0.5)
        if climb:  # straight up first
            up = (*vehicle.place[1][:2], start[2])
            self.go_to(vehicle, up, heading, 0.5)
        self.go_to(vehicle, start, heading, near)
        vehicle.wait(1.0)

    def go_to(self, vehicle, place, heading, near):
        vehicle.target = (place, None, heading)
        away = lambda: math.dist(vehicle.place[1], place)
        there = lambda: (away() <= near and math.hypot(*vehicle.place[2]) < 0.3) or vehicle.mode != self.autopilot.STEERED
        vehicle.wait_for(there, APPROACH_S, lambda: f"it does not come to the start: {away():.2f} m away")
        if vehicle.mode != self.autopilot.STEERED:
            raise Refused(f"on the way to the start it left {self.autopilot.STEERED} for {vehicle.mode}{vehicle.complaints()}")

    def hand_over(self, vehicle, world, mission):
        """Uploads the mission and starts it; gives the number of the item that is waypoint 0, its take-off."""
        radius, points = mission["accept"]["radius_m"], [world.turned(p) for p in mission["waypoints_m"]]
        headings = [math.degrees(world.compass(yaw)) % 360 for yaw in mission["yaw_rad"]]
        items = [(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, headings[0], *points[0])]
        items += [(mavlink.MAV_CMD_NAV_WAYPOINT, 0, radius, 0, heading, *p) for p, heading in zip(points[1:], headings[1:])]
        first = self.autopilot.HOME_ITEMS
        vehicle.upload([(mavlink.MAV_CMD_NAV_WAYPOINT, 0, 0, 0, 0, *points[0])] * first + items)
        vehicle.samples.clear()  # from here on they are the flight's
        vehicle.must(mavlink.MAV_CMD_MISSION_START, "mission start", 0, 0)
        wanted = self.autopilot.MISSION
        vehicle.wait_for(lambda: vehicle.mode == wanted, 5, f"the mission was started, but the mode is {vehicle.mode}")
        vehicle.target = None
        return first

    def record(self, vehicle, world, mission, of, mode, pilot, first):
        """Tells the poses until it is over; gives why."""
        legs, rows, zero, before, reached, leg = len(mission["waypoints_m"]) - 1, [], None, -1.0, None, 0
        while True:
            vehicle.wait_for(lambda: vehicle.samples, 5, "no poses")
            stamp, p_ned, v_ned, attitude = vehicle.samples.pop(0)
            zero = stamp if zero is None else zero
            t = stamp - zero
            if t <= before:
                continue
            before = t
            position, velocity, q = world.pose(p_ned, v_ned, attitude)
            if pilot:
                leg, goal, speed = pilot.follow(t, position)
                heading = world.compass(mission["yaw_rad"][min(leg + 1, legs)])
                vehicle.steer(world.turned(goal), speed and world.turned(speed), heading)
                arrived = pilot.arrived
            else:
                leg = min(max(leg, vehicle.current - first - 1, vehicle.reached - first, 0), legs - 1)
                arrived = vehicle.reached - first >= legs
            reached = t if reached is None and arrived else reached
            rows.append([t, *position, *q, *velocity, leg])
            over = "done" if reached is not None and t >= reached + LINGER_S else "time" if t >= mission["time_limit_s"] else None
            if not over and not (vehicle.armed and not vehicle.landed):
                print(f"{self.autopilot.NAME}: on the ground at t = {t:.2f} s{vehicle.complaints()}", file=sys.stderr, flush=True)
                over = "crash"
            if not over and reached is None:
                self.look_after(vehicle, mode, t)
            if over or len(rows) == BATCH:
                say(type="poses", poses=rows, **of)
                rows = []
            if over:
                return over

    def look_after(self, vehicle, mode, t):
        if vehicle.status >= mavlink.MAV_STATE_CRITICAL and vehicle.mode == mode:
            raise Refused(f"failsafe at t = {t:.2f} s{vehicle.complaints()}")
        if vehicle.mode != mode:
            raise Refused(f"at t = {t:.2f} s it left {mode} for {vehicle.mode}{vehicle.complaints()}")


def instance_of(address, step):
    """The first of the instances' addresses that no other executor here flies, its number, and the lock that says so."""
    import fcntl
    import tempfile

    head, port = address.rsplit(":", 1)
    for instance in range(64):
        here = f"{head}:{int(port) + instance * step}"
        lock = open(os.path.join(tempfile.gettempdir(), f"hairpin-mavlink-{int(port) + instance * step}.lock"), "w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return here, instance, lock
        except OSError:
            lock.close()
    raise SystemExit(f"all instances from {address} on are flown by other executors")


def parameter(text):
    name, _, value = text.partition("=")
    return name, float(value)


def options_of(autopilot):
    parser = argparse.ArgumentParser(description=autopilot.__doc__)
    parser.add_argument("--connect", default=autopilot.ADDRESS, help="of instance 0, as pymavlink writes it")
    parser.add_argument("--mode", choices=[autopilot.STEERED.lower(), autopilot.UPLOADED], default=autopilot.STEERED.lower())
    parser.add_argument("--setpoints", choices=["timed", "waypoints"], default="timed", help="what is streamed")
    parser.add_argument("--start", metavar="CMD", help="starts the simulation, anew for each mission; {instance}, {port}")
    parser.add_argument(autopilot.SPEED_OPTION, dest="speed", type=float, help="simulated seconds a second")
    parser.add_argument("--rate-hz", type=float, default=50.0, help="poses and set points a second of simulated time")
    parser.add_argument("--truth", action="store_true", help="poses of the simulation, not of the estimator")
    parser.add_argument("--limits", action="store_true", help="sets the parameters that are the mission's limits")
    parser.add_argument("--param", action="append", type=parameter, default=[], metavar="NAME=VALUE")
    parser.add_argument("--arm-patience-s", type=float, default=60.0, help="simulated time for its estimator and checks")
    parser.add_argument("--link-timeout-s", type=float, default=10.0)
    return parser.parse_args()


def serve(autopilot):
    executor = Executor(autopilot, options_of(autopilot))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    lines = queue.Queue()

    def read():
        for line in sys.stdin:
            lines.put(line)
        lines.put(None)

    threading.Thread(target=read, daemon=True).start()
    try:
        of = {}
        while True:
            while executor.vehicle and lines.empty():
                executor.idle()
            line = lines.get()
            message = json.loads(line) if line else {"type": "bye"}
            if message["type"] == "hello":
                say(type="ready", protocol=2, name=f"{autopilot.NAME} ({executor.options.mode})", deterministic=False)
            elif message["type"] == "reset":
                of = {"case": message["case"], "run": message["run"]}
                say(type="ready", **of)
            elif message["type"] == "mission":
                try:
                    executor.fly(message, of)
                except Refused as cause:
                    say(type="error", message=str(cause), **of)
                    executor.part()
            elif message["type"] == "bye":
                if executor.vehicle and not executor.options.start:
                    executor.autopilot.land(executor.vehicle)
                return
    finally:
        executor.end_program()
