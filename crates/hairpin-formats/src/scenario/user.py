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
# Letters of what went wrong: it stands in a sentence.
MOST_SAID = 1000


class Unheard(BaseException):
    """Nobody listens any more."""


def number(value, of):
    # float() takes words for what they say, truths for 0 and 1, and of complex numbers a part.
    kind = getattr(getattr(value, "dtype", None), "kind", "f")
    try:
        told = None if isinstance(value, (bool, str, bytes, bytearray)) or kind not in "iuf" else float(value)
    except (TypeError, ValueError):
        told = None
    if told is None:
        raise TypeError(f"{value!r} is no number, of {of}")
    if not abs(told) <= LARGEST:
        wanted = f"must be within ±{LARGEST:g}" if math.isfinite(told) else "is no finite number"
        raise ValueError(f"{value!r} {wanted}, of {of}")
    return told


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


def column(values):
    # A row for each run. What a run has not is NaN in its row; what none has is None.
    import numpy

    there = next((value for value in values if value is not None), None)
    gap = [math.nan] * len(there) if isinstance(there, list) else math.nan
    return None if there is None else numpy.array([gap if value is None else value for value in values])


def steer_many(control, questions, say):
    say("ready for many")
    missions = {}
    for line in questions:
        asked = json.loads(line)
        if asked["type"] == "join":
            missions[asked["run"]] = asked["mission"]
            continue
        missions = {run: missions[run] for run in asked["runs"]}
        state, reference = ({key: column(values) for key, values in asked[of].items()} for of in ("state", "reference"))
        reference["mission"] = list(missions.values())
        answer = control(column(asked["t_s"]), state, reference)
        if not isinstance(answer, dict):
            raise TypeError(f"{answer!r} is no dictionary, of control for {len(missions)} runs")
        text = json.dumps(answer, default=plain)
        # What is no number costs its own run alone.
        say(json.dumps(json.loads(text, parse_constant=lambda _: None)) if "NaN" in text or "Infinity" in text else text)


def steer(load, questions, say):
    space, fresh = load(), True
    if getattr(space["control"], "hairpin_vectorised", False):
        return steer_many(space["control"], questions, say)
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
        try:
            print(line, file=answers, flush=True)
        except BrokenPipeError:
            # What is left to say goes nowhere.
            os.dup2(os.open(os.devnull, os.O_WRONLY), answers.fileno())
            raise Unheard from None

    if what == "controller":
        return steer(load, questions, say)
    answer = {"score": scores, "target": targets}[what](load())
    say("ready")
    for line in questions:
        say(json.dumps([answer(asked) for asked in json.loads(line)]))


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2] == "alone", sys.argv[3])
    except Unheard:
        pass
    except BaseException as error:
        lines = traceback.format_exc().strip().splitlines()
        # The place in the user's file, and what is wrong there: its kind and all its lines in one. What is indented is
        # the place of a mistake of syntax.
        places = [line.strip() for line in lines if line.strip().startswith("File ")]
        words = [part for part in traceback.format_exception_only(type(error), error) if not part.startswith(" ")]
        said = " ".join("".join(words).split())
        sys.stderr.write((places[-1] + ": " if places else "") + said[:MOST_SAID] + "\n")
        sys.exit(1)
