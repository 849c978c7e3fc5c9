# Scores legs with the functions of a file: a line when they are there, then for every line of JSON with legs a line with their scores.
import sys

# Whatever lies where hairpin was started is none of its modules.
sys.path[:] = [place for place in sys.path if place]

import json
import math
import os
import traceback


# Sums over a trajectory stay finite.
LARGEST = 1e100


def number(value, leg):
    if not abs(float(value)) <= LARGEST:
        wanted = f"must be within ±{LARGEST:g}" if math.isfinite(float(value)) else "is no finite number"
        raise ValueError(f"{value!r} {wanted}, of the leg {leg}")
    return float(value)


def main(path, alone):
    questions, answers = os.fdopen(os.dup(0), encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    # What the file prints is its log, and it has nothing to read.
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    sys.stdin, sys.stdout = open(0, encoding="utf-8", closefd=False), sys.stderr
    if not alone:
        sys.path.insert(0, os.path.dirname(os.path.abspath(path)))
    with open(path, encoding="utf-8-sig") as file:
        space = {"__name__": "hairpin_score", "__file__": path}
        exec(compile(file.read(), path, "exec"), space)
    score, left = space.get("score"), space.get("left")
    if not callable(score):
        raise TypeError("it defines no function score(leg)")
    print("ready", file=answers, flush=True)
    for line in questions:
        parts = [[number(score(leg), leg), number(left(leg), leg) if left else 0.0] for leg in json.loads(line)]
        print(json.dumps(parts), file=answers, flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2] == "alone")
    except BaseException:
        lines = traceback.format_exc().strip().splitlines()
        # The place in the user's file, and what is wrong there.
        places = [line.strip() for line in lines if line.strip().startswith("File ")]
        sys.stderr.write((places[-1] + ": " if places else "") + lines[-1] + "\n")
        sys.exit(1)
