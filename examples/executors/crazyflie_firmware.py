"""Flies hairpin's missions with the Crazyflie firmware's own code, through its Python bindings, on a small plant of the example's.

    # once, in a clone of bitcraze/crazyflie-firmware: make cf2_defconfig && make bindings_python, then PYTHONPATH=…/build
    hairpin stress quadrotor.toml --set 'robot="crazyflie"' \\
        --executor 'python3 examples/executors/crazyflie_firmware.py --mode full_state'

`--mode go_to`       the high-level commander: `plan_go_to` to each waypoint in turn, as long as the plan's leg lasts
`--mode positions`   position set points: the next waypoint, once the one before is reached
`--mode full_state`  full-state set points: the mission's timed motion with velocity and acceleration

`--controller` is mellinger (the firmware's code, at 500 Hz) or pid. The body is the mission's robot, an X of four rotors
as the firmware's power distribution has them; a rotor's thrust is linear in its PWM, by the firmware's own `massThrust`,
and lags by the robot's time constant. States are true: no estimator, no noise, gusts or obstacles (said once on stderr).
"""
import argparse
import json
import math
import os
import sys

# What libraries print is not for hairpin: answers have a stream of their own, and stdout becomes stderr.
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)

import cffirmware as cf  # noqa: E402

STEP_S, PLANT_STEPS, SAMPLE_STEPS, LINGER_S, CRUISE_M_S = 0.002, 2, 5, 2.0, 1.5
PWM_PER_N = 4 * 132000.0  # massThrust: the PWM of all four rotors for a newton together
# Right, front and the reaction about z that the firmware's power distribution means by M1 … M4.
LAYOUT = [(1, 1, -1), (1, -1, 1), (-1, -1, -1), (-1, 1, 1)]


def say(**message):
    try:
        print(json.dumps(message, allow_nan=False), file=answers, flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), answers.fileno())
        sys.exit()


class Refused(Exception):
    """Why a mission cannot be flown."""


def motors_of(robot):
    """The robot's rotors in the firmware's order."""
    found = []
    for right, front, spin in LAYOUT:
        fits = [r for r in robot["rotors"] if r["y_m"] * right < 0 < r["x_m"] * front and r["spin"] * spin > 0]
        if len(fits) != 1 or len(robot["rotors"]) != 4:
            raise Refused(f"{robot.get('name', 'the robot')} is no X of four rotors that turn as a Crazyflie's do")
        found += fits
    return found


class Plant:
    """A rigid body with four lagging rotors; world z up, body x forward and y left; explicit steps of 1 ms."""

    def __init__(self, robot, world, start):
        self.mass, self.inertia, self.motors = robot["mass_kg"], robot["inertia_kg_m2"], motors_of(robot)
        self.gravity, self.lag = robot.get("gravity_m_s2", 9.81), robot.get("rotor_time_constant_s", 0.0)
        self.ratio = robot["moment_coefficient_n_m_s2"] / robot["thrust_coefficient_n_s2"]
        self.most = robot["thrust_coefficient_n_s2"] * robot["rotor_speed_rad_s"][1] ** 2
        self.drag = robot.get("drag_linear_n_s_m", 0.0), robot.get("drag_quadratic_n_s2_m2", 0.0)
        self.wind = world.get("wind_m_s") or [0.0] * 3
        self.p, self.v, self.q, self.w = list(start), [0.0] * 3, [1.0, 0.0, 0.0, 0.0], [0.0] * 3
        self.thrusts = [self.mass * self.gravity / 4] * 4

    def axes(self):
        w, x, y, z = self.q
        return ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
                (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
                (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))

    def step(self, wanted, dt):
        share = 1.0 - math.exp(-dt / self.lag) if self.lag > 0.0 else 1.0
        self.thrusts = [f + share * (min(max(g, 0.0), self.most) - f) for f, g in zip(self.thrusts, wanted)]
        moment = [0.0, 0.0, 0.0]
        for thrust, motor in zip(self.thrusts, self.motors):
            moment[0] += motor["y_m"] * thrust
            moment[1] -= motor["x_m"] * thrust
            moment[2] += motor["spin"] * self.ratio * thrust
        (wx, wy, wz), (ix, iy, iz) = self.w, self.inertia
        turn = [(moment[0] - (iz - iy) * wy * wz) / ix, (moment[1] - (ix - iz) * wz * wx) / iy, (moment[2] - (iy - ix) * wx * wy) / iz]
        self.w = [w + dt * a for w, a in zip(self.w, turn)]
        up, total = self.axes()[2], sum(self.thrusts) / self.mass
        air = [v - u for v, u in zip(self.v, self.wind)]
        drag = (self.drag[0] + self.drag[1] * math.hypot(*air)) / self.mass
        force = [total * u - drag * a for u, a in zip(up, air)]
        force[2] -= self.gravity
        self.v = [v + dt * a for v, a in zip(self.v, force)]
        self.p = [p + dt * v for p, v in zip(self.p, self.v)]
        (w, x, y, z), (a, b, c) = self.q, [dt / 2 * w for w in self.w]
        q = [w - a * x - b * y - c * z, x + a * w + c * y - b * z, y + b * w + a * z - c * x, z + c * w + b * x - a * y]
        norm = math.sqrt(sum(e * e for e in q))
        self.q = [e / norm for e in q]


class Firmware:
    """Controller and power distribution."""

    def __init__(self, controller, mass):
        self.control, self.setpoint, self.state, self.sensors = cf.control_t(), cf.setpoint_t(), cf.state_t(), cf.sensorData_t()
        self.uncapped, self.pwm, self.step = cf.motors_thrust_uncapped_t(), cf.motors_thrust_pwm_t(), 0
        if controller == "mellinger":
            own = cf.controllerMellinger_t()
            cf.controllerMellingerInit(own)
            own.mass = mass
            self.run = lambda *arguments: cf.controllerMellinger(own, *arguments)
        else:
            cf.controllerPidInit()
            self.run = cf.controllerPid
        cf.powerDistributionInit()

    def thrusts(self, plant):
        """What it wants of the rotors, N."""
        state, gyro = self.state, self.sensors.gyro
        x_axis, y_axis, z_axis = plant.axes()
        state.position.x, state.position.y, state.position.z = plant.p
        state.velocity.x, state.velocity.y, state.velocity.z = plant.v
        q = state.attitudeQuaternion
        q.w, q.x, q.y, q.z = plant.q
        state.attitude.roll = math.degrees(math.atan2(y_axis[2], z_axis[2]))
        state.attitude.pitch = math.degrees(math.asin(max(-1.0, min(1.0, x_axis[2]))))  # nose up: its pitch is inverted
        state.attitude.yaw = math.degrees(math.atan2(x_axis[1], x_axis[0]))
        gyro.x, gyro.y, gyro.z = (math.degrees(w) for w in plant.w)
        self.run(self.control, self.setpoint, self.sensors, state, self.step)
        self.step += round(1000 * STEP_S)
        cf.powerDistribution(self.control, self.uncapped)
        cf.powerDistributionCap(self.uncapped, self.pwm)
        motors = self.pwm.motors
        return [pwm / PWM_PER_N for pwm in (motors.m1, motors.m2, motors.m3, motors.m4)]

    def wish(self, position, velocity=(0.0, 0.0, 0.0), acceleration=(0.0, 0.0, 0.0), yaw=0.0):
        """Position, velocity and acceleration in the world, the nose at `yaw`."""
        point = self.setpoint
        for mode in ("x", "y", "z", "yaw"):
            setattr(point.mode, mode, cf.modeAbs)
        for mode in ("roll", "pitch", "quat"):
            setattr(point.mode, mode, cf.modeDisable)
        for field, values in (("position", position), ("velocity", velocity), ("acceleration", acceleration)):
            vector = getattr(point, field)
            vector.x, vector.y, vector.z = values
        point.attitude.yaw = math.degrees(yaw)


class GoTo:
    """`plan_go_to` to each waypoint, in the time that the plan has for the leg, or at a cruise."""

    def __init__(self, mission):
        points = mission["waypoints_m"]
        passed = passages(mission)
        spans = [b - a for a, b in zip(passed, passed[1:])] or [math.dist(a, b) / CRUISE_M_S for a, b in zip(points, points[1:])]
        self.durations = [max(span, 0.3) for span in spans]
        self.points, self.yaws, self.leg, self.begun, self.plan = points, mission["yaw_rad"], -1, 0.0, cf.planner()
        cf.plan_init(self.plan)
        cf.plan_takeoff(self.plan, cf.mkvec(*points[0]), self.yaws[0], points[0][2], self.yaws[0], 0.01, 0.0)

    def follow(self, firmware, t, position):
        if self.leg + 1 < len(self.durations) and (self.leg < 0 or t - self.begun >= self.durations[self.leg]):
            self.leg, self.begun = self.leg + 1, t
            # From where its own plan is now, as the high-level commander does.
            goal = cf.mkvec(*self.points[self.leg + 1])
            cf.plan_go_to(self.plan, False, False, goal, self.yaws[self.leg + 1], self.durations[self.leg], t)
        now = cf.plan_current_goal(self.plan, t)
        of = lambda vector: (vector.x, vector.y, vector.z)
        firmware.wish(of(now.pos), of(now.vel), of(now.acc), now.yaw)
        return max(self.leg, 0), t >= self.begun + self.durations[self.leg] and self.leg + 1 == len(self.durations)


class Positions:
    """Position set points from waypoint to waypoint."""

    def __init__(self, mission):
        self.points, self.yaws, self.accept, self.next, self.over = mission["waypoints_m"], mission["yaw_rad"], mission["accept"], 1, False

    def follow(self, firmware, t, position):
        goal = self.points[self.next]
        level = math.hypot(goal[0] - position[0], goal[1] - position[1])
        if level <= self.accept["radius_m"] and abs(goal[2] - position[2]) <= self.accept["height_m"]:
            self.over = self.over or self.next == len(self.points) - 1
            self.next = min(self.next + 1, len(self.points) - 1)
        firmware.wish(self.points[self.next], yaw=self.yaws[self.next])
        return self.next - 1, self.over


class FullState:
    """The timed motion; its acceleration is the velocity's slope."""

    def __init__(self, mission):
        if len(mission["timed"]) < 2:
            raise Refused("--mode full_state needs a timed motion: witness legs, or `generate.timing`")
        self.timed, self.at, self.yaws = mission["timed"], 0, mission["yaw_rad"]
        self.passed = passages(mission)[1:-1]

    def follow(self, firmware, t, position):
        while self.at + 2 < len(self.timed) and self.timed[self.at + 1]["t_s"] <= t:
            self.at += 1
        a, b = self.timed[self.at], self.timed[self.at + 1]
        span = b["t_s"] - a["t_s"]
        share, over = min((t - a["t_s"]) / span, 1.0), t >= b["t_s"]
        mix = lambda field: [(1 - share) * u + share * v for u, v in zip(a[field], b[field])]
        slope = [0.0 if over else (v - u) / span for u, v in zip(a["v_m_s"], b["v_m_s"])]
        leg = sum(t >= passed for passed in self.passed)
        firmware.wish(mix("p_m"), [0.0] * 3 if over else mix("v_m_s"), slope, self.yaws[leg + 1])
        return leg, over


def passages(mission):
    """When the timed motion passes each waypoint; nothing without one."""
    timed, first, times = mission["timed"], 0, []
    for point in mission["waypoints_m"] if len(timed) > 1 else []:
        first = min(range(first, len(timed)), key=lambda i: math.dist(timed[i]["p_m"], point))
        times.append(timed[first]["t_s"])
    return times


MODES = {"go_to": GoTo, "positions": Positions, "full_state": FullState}


def fly(mission, of, options):
    points = mission["waypoints_m"]
    if len(points) < 2:
        raise Refused("a mission without waypoints")
    plant, pilot = Plant(mission["robot"], mission["world"], points[0]), MODES[options.mode](mission)
    firmware = Firmware(options.controller, plant.mass)
    steps, reached, rows, end, accept = 0, None, [], points[-1], mission["accept_m"]
    while True:
        t = steps * STEP_S
        leg, over = pilot.follow(firmware, t, plant.p)
        if reached is None and over and math.dist(plant.p, end) <= accept:
            reached = t
        reason = "done" if reached is not None and t >= reached + LINGER_S else None
        reason = reason or ("crash" if plant.p[2] < 0.0 else "time" if t + STEP_S > mission["time_limit_s"] else None)
        if steps % SAMPLE_STEPS == 0 or reason:
            rows.append([t, *plant.p, *plant.q, *plant.v, leg])
        if reason or len(rows) == 1000:
            say(type="poses", poses=rows, **of)
            rows = []
        if reason:
            return say(type="end", reason=reason, **of)
        wanted = firmware.thrusts(plant)
        for _ in range(PLANT_STEPS):
            plant.step(wanted, STEP_S / PLANT_STEPS)
        steps += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mode", choices=MODES, default="full_state")
    parser.add_argument("--controller", choices=["mellinger", "pid"], default="mellinger")
    options = parser.parse_args()
    print("crazyflie firmware executor: the estimator, noise, gusts and obstacles are not simulated", file=sys.stderr, flush=True)
    of = {}
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            say(type="ready", protocol=2, name=f"crazyflie firmware ({options.controller}, {options.mode})", deterministic=True)
        elif message["type"] == "reset":
            of = {"case": message["case"], "run": message["run"]}
            say(type="ready", **of)
        elif message["type"] == "mission":
            try:
                fly(message, of, options)
            except Refused as cause:
                say(type="error", message=str(cause), **of)
        elif message["type"] == "bye":
            break


if __name__ == "__main__":
    main()
