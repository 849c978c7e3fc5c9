"""Flies hairpin's missions in MuJoCo (PyPI), with a cascade of its own from waypoint to waypoint.

    hairpin stress quadrotor.toml --executor 'python3 examples/executors/mujoco_executor.py'

The body is the mission's robot: mass, inertia, and a thruster for each rotor. A velocity towards the waypoint is held by
tilting the thrust, attitude and rates by moments about the body's axes. Linear and quadratic drag act on the velocity
through the air; rotor lag, noise, gusts and obstacles are not simulated, and said so once on stderr.
"""
import json
import os
import sys

import mujoco
import numpy as np

STEP_S, SAMPLE_S, LINGER_S = 0.002, 0.01, 2.0
CRUISE_M_S, POSITION_1_S, VELOCITY_1_S, MOST_TILT = 3.0, 1.0, 2.5, 0.7
ATTITUDE_1_S2, RATES_1_S = 100.0, 20.0

# What libraries print is not for hairpin: answers have a stream of their own, and stdout becomes stderr.
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)


def say(**message):
    try:
        print(json.dumps(message, allow_nan=False), file=answers, flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), answers.fileno())
        sys.exit()


def model_of(robot):
    """A free body with a thruster at each rotor; spin +1 (clockwise from above) has its reaction along +z."""
    ratio = robot["moment_coefficient_n_m_s2"] / robot["thrust_coefficient_n_s2"]
    most = robot["thrust_coefficient_n_s2"] * robot["rotor_speed_rad_s"][1] ** 2
    rotors = list(enumerate(robot["rotors"]))
    sites = "".join(f'<site name="r{i}" pos="{r["x_m"]} {r["y_m"]} 0"/>' for i, r in rotors)
    motors = "".join(
        f'<motor site="r{i}" gear="0 0 1 0 0 {ratio * r["spin"]}" ctrlrange="0 {most}" ctrllimited="true"/>' for i, r in rotors
    )
    inertia = " ".join(map(str, robot["inertia_kg_m2"]))
    gravity = robot.get("gravity_m_s2", 9.81)
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler balanceinertia="true"/><option timestep="{STEP_S}" gravity="0 0 {-gravity}" integrator="RK4"/><worldbody><body name="body">'
        f'<freejoint/><inertial pos="0 0 0" mass="{robot["mass_kg"]}" diaginertia="{inertia}"/>{sites}'
        f"</body></worldbody><actuator>{motors}</actuator></mujoco>"
    )


def allocation(robot):
    """Rotor thrusts from collective thrust and moments about x, y, z."""
    ratio = robot["moment_coefficient_n_m_s2"] / robot["thrust_coefficient_n_s2"]
    wrench_of = np.array([[1.0, r["y_m"], -r["x_m"], ratio * r["spin"]] for r in robot["rotors"]]).T
    return np.linalg.inv(wrench_of)


class Cascade:
    def __init__(self, robot):
        self.mass, self.gravity = robot["mass_kg"], robot.get("gravity_m_s2", 9.81)
        self.inertia, self.allocation = np.array(robot["inertia_kg_m2"]), allocation(robot)

    def rotors(self, position, velocity, body, rates, target):
        """Thrusts, N; `body` is world_from_body."""
        wanted = POSITION_1_S * (target - position)
        wanted *= min(1.0, CRUISE_M_S / max(np.linalg.norm(wanted), 1e-9))
        force = VELOCITY_1_S * (wanted - velocity) + [0.0, 0.0, self.gravity]
        force[2] = max(force[2], 0.3 * self.gravity)
        side = np.linalg.norm(force[:2])
        force[:2] *= min(1.0, np.tan(MOST_TILT) * force[2] / max(side, 1e-9))
        z = force / np.linalg.norm(force)
        y = np.cross(z, [1.0, 0.0, 0.0])
        y /= np.linalg.norm(y)
        goal = np.column_stack([np.cross(y, z), y, z])
        error = goal.T @ body - body.T @ goal
        turn = -ATTITUDE_1_S2 * 0.5 * np.array([error[2, 1], error[0, 2], error[1, 0]]) - RATES_1_S * rates
        return self.allocation @ [self.mass * force @ body[:, 2], *(self.inertia * turn)]


def fly(mission, pilot):
    """`pilot.rotors` has the rotors' thrusts (N) every 2 ms."""
    robot, points = mission["robot"], np.array(mission["waypoints_m"])
    model = model_of(robot)
    data = mujoco.MjData(model)
    data.qpos[:3] = points[0]
    wind = np.array(mission["world"].get("wind_m_s") or [0.0, 0.0, 0.0])
    linear, quadratic = robot.get("drag_linear_n_s_m", 0.0), robot.get("drag_quadratic_n_s2_m2", 0.0)
    name = {"case": mission["case"], "run": mission["run"]}
    each, steps, following, reached, poses = round(SAMPLE_S / STEP_S), 0, 1, None, []
    while True:
        t = steps * STEP_S
        position, velocity, rates = data.qpos[:3].copy(), data.qvel[:3].copy(), data.qvel[3:6].copy()
        if following < len(points) and np.linalg.norm(points[following] - position) <= mission["accept_m"]:
            following += 1
            reached = t if following == len(points) else reached
        if steps % each == 0:
            leg = min(following, len(points) - 1) - 1
            poses.append([t, *position, *data.qpos[3:7], *velocity, leg])
        over = "done" if reached is not None and t >= reached + LINGER_S else None
        over = over or ("crash" if position[2] < 0.0 else "time" if t + STEP_S > mission["time_limit_s"] else None)
        if over or len(poses) == 1000:
            say(type="poses", poses=poses, **name)
            poses = []
        if over:
            return say(type="end", reason=over, **name)
        body = np.empty(9)
        mujoco.mju_quat2Mat(body, data.qpos[3:7])
        target = points[min(following, len(points) - 1)]
        data.ctrl[:] = pilot.rotors(position, velocity, body.reshape(3, 3), rates, target)
        air = velocity - wind
        data.xfrc_applied[1, :3] = -(linear + quadratic * np.linalg.norm(air)) * air
        mujoco.mj_step(model, data)
        steps += 1


def serve(name, version, pilot):
    """Answers missions, each flown by a fresh `pilot(robot)`."""
    print(f"{name} executor: rotor lag, noise, gusts and obstacles are not simulated", file=sys.stderr, flush=True)
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            say(type="ready", protocol=2, name=name, deterministic=True, version=version, timed=False)
        elif message["type"] == "reset":
            say(type="ready", case=message["case"], run=message["run"])
        elif message["type"] == "mission":
            fly(message, pilot(message["robot"]))
        elif message["type"] == "bye":
            break


if __name__ == "__main__":
    serve("mujoco", mujoco.__version__, Cascade)
