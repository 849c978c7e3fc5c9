"""RAPID modules as a controller takes them: checked line by line against the grammar of the subset, without a reader of ours.

The campaign is made by the binary $HAIRPIN_BIN.
"""

import math
import os
import re
import subprocess

import pytest

NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
NAME = r"[A-Za-z][A-Za-z0-9_]{0,31}"
SPEEDS = {f"v{v}" for v in (5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800)} | {
    f"v{v}" for v in (1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000)
} | {"vmax"}
ZONES = {"fine"} | {f"z{z}" for z in (0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200)}
DECLARED = re.compile(rf"(?:LOCAL |TASK )?(?:CONST|PERS|VAR) ([a-z]+) ({NAME})\s*(?::=\s*(.*))?;")
MOVE = re.compile(rf"(MoveAbsJ|MoveJ|MoveL) ({NAME}),\s*({NAME}),\s*({NAME}),\s*({NAME})((?:\s*\\{NAME}:={NAME})*);")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("rapid")
    small = ["--set", "task.points.count=6", "--set", "generate.search.programs=2", "--set", "execute.repeat=1"]
    for arguments in (["generate", "arm", "--out", "arm", *small], ["export", "arm", "--to", "rapid,arc-clock"]):
        done = subprocess.run([os.environ["HAIRPIN_BIN"], *arguments], cwd=place, capture_output=True, text=True)
        assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return place / "arm"


def module(path):
    """The lines of a module without comments, after what holds for all text."""
    raw = path.read_bytes()
    assert raw.isascii() and raw.count(b"\n") == raw.count(b"\r\n") and raw.endswith(b"\r\n")
    lines = [line.split("!")[0].strip() for line in raw.decode("ascii").split("\r\n")]
    lines = [line for line in lines if line]
    assert re.fullmatch(rf"MODULE {NAME}(?:\([A-Z,]+\))?", lines[0]) and lines[-1] == "ENDMODULE"
    return lines


def numbers(text):
    """The numbers of an aggregate, brackets balanced."""
    assert text.count("[") == text.count("]") and re.fullmatch(rf"[\[\],\s]*(?:{NUMBER}[\[\],\s]*)+", text), text
    return [float(number) for number in re.findall(NUMBER, text)]


def declarations(lines):
    found = {}
    for line in lines:
        declared = DECLARED.fullmatch(line)
        if declared:
            kind, name, value = declared.groups()
            assert name.lower() not in (known.lower() for known in found), name
            found[name] = (kind, value)
    return found


def test_programs_are_what_controllers_take(folder):
    for name in ("0000.mod", "0000_slow.mod", "0001.mod"):
        lines = module(folder / "export" / name)
        found = declarations(lines)
        for kind, value in found.values():
            if kind == "robtarget":
                x, y, z, q1, q2, q3, q4, *rest = numbers(value)
                assert max(abs(x), abs(y), abs(z)) < 2000 and abs(math.hypot(q1, q2, q3, q4) - 1) < 1e-5
                assert all(cf == int(cf) for cf in rest[:4]) and 0 <= rest[3] <= 7 and rest[4:] == [9e9] * 6
            elif kind == "jointtarget":
                assert len(numbers(value)) == 12
        moves = [MOVE.fullmatch(line) for line in lines if line.startswith("Move")]
        assert len(moves) >= 4 and all(moves), lines
        kinds = [move.group(1) for move in moves]
        # Home in joints at both ends; no straight move before the arm stands where one can begin.
        assert kinds[0] == kinds[-1] == "MoveAbsJ" and kinds[1] == "MoveJ"
        for move in moves:
            kind, target, speed, zone, tool, options = move.groups()
            assert found[target][0] == ("jointtarget" if kind == "MoveAbsJ" else "robtarget")
            assert speed in SPEEDS and zone in ZONES and found[tool][0] == "tooldata"
            for option, value in re.findall(rf"\\({NAME}):=({NAME})", options):
                assert option == "WObj" and found[value][0] == "wobjdata"
            if "slow" in name:
                assert speed != "vmax" and int(speed[1:]) <= 250
        procedures = [line for line in lines if re.match(r"(LOCAL )?PROC ", line)]
        assert len(procedures) == lines.count("ENDPROC") == 1


def test_a_program_file_names_its_module(folder):
    assert "<Module>0000.mod</Module>" in (folder / "export" / "0000.pgf").read_text()


def test_every_arc_is_clocked_between_standstills(folder):
    lines = module(folder / "export" / "arc_clock.mod")
    driven = [re.fullmatch(rf"clock_arc ([0-9]+),([0-9]+),({NAME});", line) for line in lines if line.startswith("clock_arc")]
    assert driven and all(driven)
    found = declarations(lines)
    walk = [(int(one.group(1)), int(one.group(2)), one.group(3)) for one in driven]
    assert all(before[1] == after[0] for before, after in zip(walk, walk[1:]))
    assert all(found[there][0] == "robtarget" for _, _, there in walk)
    rows = (folder / "graph.csv").read_text().splitlines()
    arcs = {(a, b) for a, row in enumerate(rows) for b, cell in enumerate(row.split(",")) if cell and a != b}
    assert {(a, b) for a, b, _ in walk} <= arcs
    inside = lines[lines.index("LOCAL PROC clock_arc(num a,num b,robtarget there)") :]
    assert sum(line.startswith("MoveL there,") and re.search(r",\s*fine,", line) is not None for line in inside) == 1
