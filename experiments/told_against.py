"""The built-in flight simulator beside others: do both find the same missions hard, and is what a search finds on one hard on the other?

    python3 experiments/told_against.py [--only NAME …] [--out DIR] [--hairpin PROGRAM]

For each executor below: uniform feasible missions, flown by both; what the default search finds on the built-in simulator, flown by both; and what it finds
with the executor in the loop, flown by both. Prints the rows of EXPERIMENTS.md ("Told against other simulators"). Needs pyarrow and NumPy
beside the executors' packages (tests/python/requirements.txt has all of them). Folders that are there are not flown again.
"""
import argparse
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

ROOT = Path(__file__).resolve().parents[1]
UNIFORM, FOUND, SEED, RESAMPLES = 60, 20, 3201, 10_000
# No wind, no noise, one run: what differs is the simulator and the controller.
SETS = ["task.length=5", "execute.repeat=1", "vary={}", "world.obstacles=[]"]
HALL = ["world.size_m=[16, 16, 16]", "task.end_m=[9, 9, 7]"]
ROOM = [
    "world.size_m=[8, 8, 8]", "world.keep_in_margin_m=0.5", "task.start_m=[1, 1, 1]", "task.end_m=[6, 6, 6]", "execute.accept_m=0.3",
    "generate.limits.max_speed_m_s=2.0", "spec.deviation.corner_m=0.3",
]
# Name: robot, space, its nearest of kin among the built-in controllers, command, and what a search in its loop may cost: searches, cases, executions a case.
EXECUTORS = {
    "rotorpy": ("flightgoggles", HALL, "geometric", "rotorpy_executor.py", (1, 4, 16)),
    "mujoco": ("flightgoggles", HALL, "stable-waypoint", "mujoco_executor.py", (2, 4, 25)),
    "foundation-policy": ("x500", HALL, "stable-waypoint", "foundation_policy_executor.py", (3, 4, 25)),
    "drone-models": ("crazyflie", ROOM, "crazyflie-goto", "drone_models_executor.py", (1, 8, 100)),
    "skeleton": ("flightgoggles", HALL, "stable-waypoint", "skeleton.cpp", (1, 20, 200)),
    "firmware-full-state": ("crazyflie", ROOM, "geometric", "crazyflie_firmware.py --mode full_state", (1, 4, 25)),
    "firmware-go-to": ("crazyflie", ROOM, "crazyflie-goto", "crazyflie_firmware.py --mode go_to", (1, 4, 25)),
}
SIDES = ["uniform here", "uniform there", "found here", "found here, flown there", "found there", "found there, flown here"]
CONTROLLERS = ["geometric", "stable-waypoint", "px4-mission", "crazyflie-goto"]


def command_of(program, out):
    if program.endswith(".cpp"):
        built = out / Path(program).stem
        if not built.exists():
            subprocess.run(["g++", "-std=c++17", "-O2", "-o", str(built), str(ROOT / "examples/executors" / program)], check=True)
        return shlex.quote(str(built.resolve()))
    return shlex.join([sys.executable, *shlex.split(str(ROOT / "examples/executors") + "/" + program)])


def hairpin(program, out, *words, sets=()):
    """Runs a verb into `out`, unless it is there; a violation (1) is as good as none."""
    if not (out / "told.json").exists():
        words = [program, *map(str, words), "--out", str(out), "--force", "--threads", "1", "--json"]
        done = subprocess.run(words + [word for one in sets for word in ("--set", one)], capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"{shlex.join(words)}: exit code {done.returncode}\n{done.stderr}")
        if words[1] == "execute":
            subprocess.run([program, "judge", str(out)], capture_output=True)
        (out / "told.json").write_text(done.stdout)
    return out


def flown(folder, table):
    """Each case's largest deviation (NaN where it could not be flown) and how it ended."""
    rows = pq.read_table(folder / f"{table}.parquet", columns=["case", "max_deviation_m", "ended"]).to_pylist()
    rows.sort(key=lambda row: row["case"])
    return np.array([row["max_deviation_m"] or np.nan for row in rows], dtype=float), [row["ended"] for row in rows]


def ranks(values):
    """Of each value; equal ones share their mean rank."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(count) - 0.5 * (count - 1))[place]


def interval(estimate, *groups, seed=1):
    """Percentile bootstrap, 95 %: each of `groups` is drawn again by itself, its rows whole."""
    random = np.random.default_rng(seed)
    drawn = [estimate(*(group[random.integers(0, len(group), len(group))] for group in groups)) for _ in range(RESAMPLES)]
    low, high = np.nanpercentile(drawn, [2.5, 97.5])
    return estimate(*groups), low, high


def rank_correlation(one, other):
    pairs = np.column_stack([one, other])
    pairs = pairs[np.isfinite(pairs).all(axis=1)]
    value, low, high = interval(lambda rows: np.corrcoef(ranks(rows[:, 0]), ranks(rows[:, 1]))[0, 1], pairs)
    return f"{value:.2f} ({low:.2f} to {high:.2f})"


def lift(found, uniform):
    """Ratio of geometric means − 1, in per cent."""
    found, uniform = (np.log(values[np.isfinite(values)]) for values in (found, uniform))
    value, low, high = (100 * (np.exp(x) - 1) for x in interval(lambda a, b: a.mean() - b.mean(), found, uniform))
    return f"{value:+.0f} ({low:.0f} to {high:.0f})"


def ends(ended):
    return f"{ended.count('crash')}, {ended.count('time')}" + (f", {ended.count(None)} not flown" if None in ended else "")


def tell(name, out, program):
    robot, space, controller, file, (searches, cases, executions) = EXECUTORS[name]
    out = out / name
    out.mkdir(parents=True, exist_ok=True)
    command = command_of(file, out)
    scenario = out / "quadrotor.toml"
    if not scenario.exists():
        subprocess.run([program, "new", "quadrotor"], cwd=out, check=True, capture_output=True)
    sets = [*SETS, *space, f'robot="{robot}"', f"execute.baseline={UNIFORM}"]
    ours = hairpin(program, out / "built-in", "stress", scenario, "--seed", SEED, sets=[*sets, f'execute.controller="{controller}"'])
    theirs = hairpin(program, out / "executor", "execute", ours, "--executor", command)
    uniform, uniform_there = flown(ours, "baseline"), flown(theirs, "baseline")
    found, found_there = flown(ours, "results"), flown(theirs, "results")
    rows = {"executor": f"{name} ({robot}; `{controller}`)"}
    for other in CONTROLLERS:
        folder = ours if other == controller else hairpin(
            program, out / other, "execute", ours, sets=[f'execute.controller="{other}"'])
        rows[other] = rank_correlation(flown(folder, "baseline")[0], uniform_there[0])
    looped, looped_here = ([], []), ([], [])
    for number in range(searches):
        seed = SEED + 10 + number
        search = f'generate.search={{ method = "worst", executions = {executions}, cases = {cases} }}'
        loop = hairpin(program, out / f"loop-{seed}", "stress", scenario, "--seed", seed, "--executor", command,
                       sets=[*sets, search, "execute.baseline=0"])
        back = hairpin(program, out / f"loop-{seed}-built-in", "execute", loop,
                       sets=[f'execute.controller="{controller}"'])
        for kept, folder in ((looped, loop), (looped_here, back)):
            for into, more in zip(kept, flown(folder, "results")):
                into.extend(more)
    rows["found here"] = lift(found[0], uniform[0])
    rows["found here, flown there"] = lift(found_there[0], uniform_there[0])
    rows["found there"] = lift(np.array(looped[0]), uniform_there[0])
    rows["found there, flown here"] = lift(np.array(looped_here[0]), uniform[0])
    for side, (deviations, ended) in zip(SIDES, [uniform, uniform_there, found, found_there, looped, looped_here]):
        mean = np.exp(np.nanmean(np.log(np.array(deviations, dtype=float))))
        rows[f"{side}, m"] = f"{mean:.3g} ({len(ended)}; {ends(ended)})"
    return rows


def table(rows, *columns):
    print("|", " | ".join(["executor", *columns]), "|\n|", " | ".join(["---"] * (1 + len(columns))), "|")
    for row in rows:
        print("|", " | ".join(row[column] for column in ("executor", *columns)), "|")
    print()


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    built = find_spec("cffirmware") is not None  # the firmware's own bindings: examples/executors/README.md
    arguments.add_argument("--only", nargs="+", choices=EXECUTORS, default=[name for name in EXECUTORS if built or "firmware" not in name])
    arguments.add_argument("--out", type=Path, default=ROOT / "out" / "told-against")
    arguments.add_argument("--hairpin", type=Path, default=ROOT / "target" / "release" / "hairpin")
    asked = arguments.parse_args()
    rows = [tell(name, asked.out, str(asked.hairpin.resolve())) for name in asked.only]
    print("Rank correlation (95 %) of uniform missions there with those here, under\n")
    table(rows, *CONTROLLERS)
    print("Lifts, % (95 %)\n")
    table(rows, "found here", "found here, flown there", "found there", "found there, flown here")
    print("Geometric means (cases; crashed, timed out)\n")
    table(rows, *(f"{side}, m" for side in SIDES))


if __name__ == "__main__":
    main()
