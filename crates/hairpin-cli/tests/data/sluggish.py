"""A sluggish point that chases waypoint after waypoint, for tests: deterministic, and the worse the sharper it has to turn.

What it is asked is kept in the file FILE (`--log FILE`); `--sick KIND` makes a third of its missions, by their waypoints, go wrong: KIND is
`error`, `exit`, `nan` or `silent`; `--always` makes all of them, `--but N`
those that have N waypoints excepted.
"""
import argparse
import json
import math
import sys
import time

parser = argparse.ArgumentParser()
parser.add_argument("--log")
parser.add_argument("--sick")
parser.add_argument("--always", action="store_true")
parser.add_argument("--but", type=int, metavar="N")
options = parser.parse_args()


def say(**message):
    print(json.dumps(message), flush=True)


def fly(mission, step=0.05):
    points, of = mission["waypoints_m"], {"case": mission["case"], "run": mission["run"]}
    third = int(sum(abs(x) for p in points for x in p) * 1000) % 3 == 0
    if options.sick and (third or options.always) and len(points) != options.but:
        if options.sick == "error":
            return say(type="error", message="not today", **of)
        if options.sick == "exit":
            sys.exit("rotor 3 is gone")
        if options.sick == "nan":
            return say(type="pose", t_s=0.0, p_m=[math.nan, 0.0, 0.0], **of)
        time.sleep(600)
    place, velocity, leg, t, rows = list(points[0]), [0.0] * 3, 0, 0.0, []
    while t <= mission["time_limit_s"]:
        rows.append([t, *place, 1, 0, 0, 0, *velocity, leg])
        away = [b - a for a, b in zip(place, points[leg + 1])]
        far = math.sqrt(sum(x * x for x in away))
        if far < mission["accept_m"]:
            if leg == len(points) - 2:
                break
            leg += 1
            away = [b - a for a, b in zip(place, points[leg + 1])]
            far = math.sqrt(sum(x * x for x in away))
        pull = 4.0 / max(far, 4.0)
        velocity = [v + step * (1.5 * pull * a - 0.9 * v) for a, v in zip(away, velocity)]
        place = [p + step * v for p, v in zip(place, velocity)]
        t += step
    else:
        say(type="poses", poses=rows, **of)
        return say(type="end", reason="time", **of)
    say(type="poses", poses=rows, **of)
    say(type="end", reason="done", **of)


for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        say(type="ready", protocol=2, name="sluggish point")
    elif message["type"] == "reset":
        say(type="ready", case=message["case"], run=message["run"])
    elif message["type"] == "mission":
        if options.log:
            open(options.log, "a").write(line)
        fly(message)
    else:
        break
