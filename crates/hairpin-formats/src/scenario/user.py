# Scores legs, or measures runs, with the functions of a file: a line when they are there, then for every line of JSON with legs or
# runs a line with their numbers.
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


def main(path, alone, what):
    questions, answers = os.fdopen(os.dup(0), encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    # What the file prints is its log, and it has nothing to read.
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    sys.stdin, sys.stdout = open(0, encoding="utf-8", closefd=False), sys.stderr
    if not alone:
        sys.path.insert(0, os.path.dirname(os.path.abspath(path)))
    with open(path, encoding="utf-8-sig") as file:
        space = {"__name__": f"hairpin_{what}", "__file__": path}
        exec(compile(file.read(), path, "exec"), space)
    answer = {"score": scores, "target": targets}[what](space)
    print("ready", file=answers, flush=True)
    for line in questions:
        print(json.dumps([answer(asked) for asked in json.loads(line)]), file=answers, flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2] == "alone", sys.argv[3])
    except BaseException:
        lines = traceback.format_exc().strip().splitlines()
        # The place in the user's file, and what is wrong there.
        places = [line.strip() for line in lines if line.strip().startswith("File ")]
        sys.stderr.write((places[-1] + ": " if places else "") + lines[-1] + "\n")
        sys.exit(1)
