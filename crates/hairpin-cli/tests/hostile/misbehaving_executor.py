"""Flies missions along their straight legs in protocol 2, and does one thing wrong: `misbehaving_executor.py KIND`; `sound` does none."""
import json, math, os, random, sys, time

KIND = sys.argv[1] if len(sys.argv) > 1 else "sound"
of = {}


def say(**message):
    print(json.dumps(message), flush=True)


def rows(points, step=0.05, speed=4.0):
    t, out = 0.0, []
    for leg, (a, b) in enumerate(zip(points, points[1:])):
        n = max(1, math.ceil(math.dist(a, b) / speed / step))
        v = [(q - p) / (n * step) for p, q in zip(a, b)]
        for k in range(n + (leg == len(points) - 2)):
            out.append([t, *(p + u * k * step for p, u in zip(a, v)), 1, 0, 0, 0, *v, leg])
            t += step
    return out


def fly(m):
    if not m["waypoints_m"]:
        return say(type="error", message="no waypoints", **of)
    poses = rows(m["waypoints_m"])
    if KIND == "hang":
        time.sleep(600)
    if KIND == "slow":
        for row in poses:
            say(type="poses", poses=[row], **of)
            time.sleep(0.2)
    if KIND == "flood":
        while True:
            say(type="poses", poses=[[poses[0][0]] + row[1:] for row in poses] * 10, **of)
    if KIND == "nan":
        poses[3][1] = math.nan
    if KIND == "ned":
        for row in poses:
            row[1], row[2], row[3] = row[2], row[1], -row[3]
    if KIND == "falling-leg":
        poses[-1][11] = 0
    if KIND == "mixed-leg":
        poses[-1][11] = None
    if KIND == "exit":
        say(type="poses", poses=poses[:3], **of)
        sys.exit("rotor 3 is gone")
    if KIND == "fork" and os.fork() == 0:
        time.sleep(0.03)  # and answers as well
    if KIND == "noise":
        poses = [row[:1] + [x + random.uniform(-1e-3, 1e-3) for x in row[1:4]] + row[4:] for row in poses]
    if KIND == "short":
        poses = poses[: len(poses) // 2]
    say(type="poses", poses=poses, **of)
    say(type="end", reason="done", **of)
    if KIND == "twice":
        say(type="poses", poses=poses, **of)
        say(type="end", reason="done", **of)


for line in sys.stdin:
    m = json.loads(line)
    if m["type"] == "hello":
        if KIND == "banner":
            print("Simulator 3.1, copyright everybody", flush=True)
        say(type="ready", protocol=2, name="straight line", version=3, deterministic=KIND != "stays")
    elif m["type"] == "reset":
        of = {"case": m["case"], "run": m["run"]}
        say(type="ready", **of)
    elif m["type"] == "mission":
        fly(m)
    elif KIND == "stays":
        time.sleep(600)
    else:
        break
