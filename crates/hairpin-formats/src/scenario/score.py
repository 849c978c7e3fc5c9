# Scores legs with the functions of a file: a line of JSON with legs in, a line with their scores out.
import json
import math
import os
import sys
import traceback


def number(value, leg):
    if not math.isfinite(float(value)):
        raise ValueError(f"{value!r} is no finite number, of the leg {leg}")
    return float(value)


def main(path):
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    # What the file prints is its log.
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    sys.path.insert(0, os.path.dirname(os.path.abspath(path)))
    with open(path, encoding="utf-8-sig") as file:
        space = {"__name__": "hairpin_score", "__file__": path}
        exec(compile(file.read(), path, "exec"), space)
    score, left = space.get("score"), space.get("left")
    if not callable(score):
        raise TypeError("it defines no function score(leg)")
    for line in sys.stdin:
        parts = [[number(score(leg), leg), number(left(leg), leg) if left else 0.0] for leg in json.loads(line)]
        print(json.dumps(parts), file=answers, flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except BaseException:
        lines = traceback.format_exc().strip().splitlines()
        # The place in the user's file, and what is wrong there.
        places = [line.strip() for line in lines if line.strip().startswith("File ")]
        sys.stderr.write((places[-1] + ": " if places else "") + lines[-1] + "\n")
        sys.exit(1)
