# Scores legs, measures runs, or steers, with the functions of a file: a line when they are there, then for every line of JSON with
# legs or runs a line with their numbers, or for every turn of a controller a line with its command.
import sys

# Whatever lies where hairpin was started is none of its modules.
sys.path[:] = [place for place in sys.path if place]

import json
import math
import os
import traceback


# Sums over a trajectory stay finite.
LARGEST = 1e100


def number(value, of):
    if not abs(float(value)) <= LARGEST:
        wanted = f"must be within ±{LARGEST:g}" if math.isfinite(float(value)) else "is no finite number"
        raise ValueError(f"{value!r} {wanted}, of {of}")
    return float(value)


def scores(space):
    score, left = space.get("score"), space.get("left")
    if not callable(score):
        raise TypeError("it defines no function score(leg)")
    return lambda leg: [number(score(leg), f"the leg {leg}"), number(left(leg), f"the leg {leg}") if left else 0.0]


def targets(space):
    target = space.get("target")
    if not callable(target):
        raise TypeError("it defines no function target(run)")

    def measured(run):
        value = target(run)
        # None: it has nothing to say of this run.
        return None if value is None else number(value, f"the run over {run['waypoints_m']}")

    return measured


def plain(value):
    # Arrays and numbers of NumPy and the like.
    return value.tolist()


def steer(load, questions, say):
    space, fresh = load(), True
    say("ready")
    for line in questions:
        asked = json.loads(line)
        if asked["type"] == "reset":
            mission = asked["mission"]
            if callable(space.get("reset")):
                space["reset"](mission)
            elif not fresh:
                # What a run leaves in the file's variables is none of the next one's.
                space = load()
            fresh, control, waypoints = False, space["control"], mission["waypoints_m"]
            say("{}")
            continue
        t_s, reference = asked["t_s"], asked["reference"]
        reference["waypoints_m"] = waypoints
        answer = control(t_s, asked["state"], reference)
        if not isinstance(answer, dict):
            raise TypeError(f"{answer!r} is no dictionary, of control(t_s = {t_s})")
        try:
            say(json.dumps(answer, allow_nan=False, default=plain))
        except ValueError:
            raise ValueError(f"{answer!r} has numbers that are not finite, of control(t_s = {t_s})") from None


def main(path, alone, what):
    questions, answers = os.fdopen(os.dup(0), encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    # What the file prints is its log, and it has nothing to read.
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    sys.stdin, sys.stdout = open(0, encoding="utf-8", closefd=False), sys.stderr
    if not alone:
        sys.path.insert(0, os.path.dirname(os.path.abspath(path)))

    def load():
        with open(path, encoding="utf-8-sig") as file:
            space = {"__name__": f"hairpin_{what}", "__file__": path}
            exec(compile(file.read(), path, "exec"), space)
        if what == "controller" and not callable(space.get("control")):
            raise TypeError("it defines no function control(t_s, state, reference)")
        return space

    def say(line):
        print(line, file=answers, flush=True)

    if what == "controller":
        return steer(load, questions, say)
    answer = {"score": scores, "target": targets}[what](load())
    say("ready")
    for line in questions:
        say(json.dumps([answer(asked) for asked in json.loads(line)]))


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2] == "alone", sys.argv[3])
    except BaseException:
        lines = traceback.format_exc().strip().splitlines()
        # The place in the user's file, and what is wrong there.
        places = [line.strip() for line in lines if line.strip().startswith("File ")]
        sys.stderr.write((places[-1] + ": " if places else "") + lines[-1] + "\n")
        sys.exit(1)
