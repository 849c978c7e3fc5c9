"""A stand-in for the Crazyflie firmware's Python bindings: the names that examples/executors/crazyflie_firmware.py uses, their units
and signs (pitch inverted, gyro in °/s, thrust in PWM), with a plain cascade of ours behind them. Nothing of the firmware's code.
`controllerPid` flies the same cascade with half the gain on positions."""
import math
from types import SimpleNamespace

modeDisable, modeAbs, modeVelocity = 0, 1, 2
MASS_THRUST, GRAVITY, INERTIA, ARM_PWM = 132000.0, 9.81, (1.43e-5, 1.43e-5, 2.89e-5), 4 * 132000.0


def mkvec(x, y, z):
    return SimpleNamespace(x=x, y=y, z=z)


def zero():
    return mkvec(0.0, 0.0, 0.0)


def of(vector):
    return [vector.x, vector.y, vector.z]


def control_t():
    return SimpleNamespace(roll=0, pitch=0, yaw=0, thrust=0.0)


def setpoint_t():
    angles = SimpleNamespace(roll=0.0, pitch=0.0, yaw=0.0)
    modes = SimpleNamespace(x=0, y=0, z=0, roll=0, pitch=0, yaw=0, quat=0)
    return SimpleNamespace(mode=modes, position=zero(), velocity=zero(), acceleration=zero(), attitude=angles)


def state_t():
    return SimpleNamespace(position=zero(), velocity=zero(), attitude=SimpleNamespace(roll=0.0, pitch=0.0, yaw=0.0),
                           attitudeQuaternion=SimpleNamespace(w=1.0, x=0.0, y=0.0, z=0.0))


def sensorData_t():
    return SimpleNamespace(gyro=zero())


def motors_thrust_uncapped_t():
    return SimpleNamespace(motors=SimpleNamespace(m1=0, m2=0, m3=0, m4=0))


motors_thrust_pwm_t = motors_thrust_uncapped_t


def controllerMellinger_t():
    return SimpleNamespace(mass=0.032, last=None)


def controllerMellingerInit(own):
    own.last = 0


def controllerPidInit():
    pid.last = 0


def controllerMellinger(own, control, setpoint, sensors, state, step):
    steer(own, control, setpoint, sensors, state, step, 6.0)


def controllerPid(control, setpoint, sensors, state, step):
    steer(pid, control, setpoint, sensors, state, step, 3.0)


pid = controllerMellinger_t()
pid.mass = 0.03


def steer(own, control, setpoint, sensors, state, step, gain):
    assert own.last is not None, "not initialised"
    assert step % 2 == 0 and step >= own.last, "ticks are milliseconds at 500 Hz"
    own.last = step
    assert setpoint.mode.x == setpoint.mode.y == setpoint.mode.z == setpoint.mode.yaw == modeAbs and setpoint.mode.quat == modeDisable
    q = state.attitudeQuaternion
    w, x, y, z = q.w, q.x, q.y, q.z
    up = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    # What is told twice agrees: angles in degrees, pitch inverted.
    assert abs(math.sin(math.radians(state.attitude.pitch)) - 2 * (x * z - w * y)) < 1e-6
    yaw = math.radians(state.attitude.yaw)
    terms = zip(of(setpoint.position), of(state.position), of(setpoint.velocity), of(state.velocity), of(setpoint.acceleration))
    wish = [max(-6.0, min(6.0, gain * (p - q) + 3.5 * (v - u))) + a for p, q, v, u, a in terms]
    wish[2] += GRAVITY
    size = math.hypot(*wish)
    goal = [c / size for c in wish]
    # The turn that takes the thrust to where it is wanted, in the body's axes.
    turn = [up[1] * goal[2] - up[2] * goal[1], up[2] * goal[0] - up[0] * goal[2], up[0] * goal[1] - up[1] * goal[0]]
    ahead = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    left = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)]
    error = [sum(a * b for a, b in zip(turn, axis)) for axis in (ahead, left)]
    error.append(math.remainder(math.radians(setpoint.attitude.yaw) - yaw, 2 * math.pi))
    rates = [math.radians(r) for r in of(sensors.gyro)]
    moment = [inertia * (60.0 * e - 12.0 * r) for inertia, e, r in zip(INERTIA, error, rates)]
    control.thrust = MASS_THRUST * own.mass * sum(a * b for a, b in zip(wish, up))
    # Two motors a side, at 3 cm; about z by the ratio of moment to thrust.
    control.roll = ARM_PWM * moment[0] / (2 * 0.0304)
    control.pitch = ARM_PWM * -moment[1] / (2 * 0.0304)  # inverted
    control.yaw = ARM_PWM * -moment[2] / (4 * 0.0339)


def powerDistributionInit():
    pass


def powerDistribution(control, uncapped):
    r, p, y, motors = control.roll / 2, control.pitch / 2, control.yaw, uncapped.motors
    motors.m1, motors.m2 = control.thrust - r + p + y, control.thrust - r - p - y
    motors.m3, motors.m4 = control.thrust + r - p + y, control.thrust + r + p - y


def powerDistributionCap(uncapped, pwm):
    for name, value in vars(uncapped.motors).items():
        setattr(pwm.motors, name, int(max(0, min(65535, value))))
    return False


def planner():
    return SimpleNamespace(piece=None)


def plan_init(plan):
    plan.piece = None


def plan_takeoff(plan, position, yaw, height, hover_yaw, duration, t):
    plan.piece = (of(position), [position.x, position.y, height], hover_yaw, duration, t)
    return 0


def plan_go_to(plan, relative, linear, position, yaw, duration, t):
    assert plan.piece is not None and not relative and not linear
    plan.piece = (of(plan_current_goal(plan, t).pos), of(position), yaw, duration, t)
    return 0


def plan_current_goal(plan, t):
    a, b, yaw, duration, begun = plan.piece
    s = min(max((t - begun) / duration, 0.0), 1.0)
    share, speed = s**3 * (10 - 15 * s + 6 * s * s), 30 * s * s * (1 - s) ** 2 / duration
    slope = 60 * s * (1 - s) * (1 - 2 * s) / duration**2
    span = [v - u for u, v in zip(a, b)]
    return SimpleNamespace(pos=mkvec(*(u + share * d for u, d in zip(a, span))), vel=mkvec(*(speed * d for d in span)),
                           acc=mkvec(*(slope * d for d in span)), yaw=yaw)
