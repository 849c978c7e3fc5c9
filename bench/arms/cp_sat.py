"""CP-SAT as a process of its own: it brings a HiGHS whose names clash with those of highspy.

A question a line on stdin: {"n": points, "arcs": [[from, to, cost] ...], "met": [points], "limit": seconds}, point n is the depot. An answer
a line on stdout: {"path": [...] or null, "proven": ..., "seconds": ...}, processor time of the solver.
"""

import json
import sys
import time

from ortools.sat.python import cp_model


def solve(question):
    """The heaviest circuit through the depot; a loop at each point that may be left out."""
    model = cp_model.CpModel()
    arcs = [(a, b, model.new_bool_var("")) for a, b, _ in question["arcs"]]
    loops = [(i, i, model.new_bool_var("")) for i in range(question["n"]) if i not in question["met"]]
    model.add_circuit(arcs + loops)
    model.maximize(sum(cost * arc[2] for arc, (_, _, cost) in zip(arcs, question["arcs"]) if cost))
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.max_time_in_seconds = question["limit"]
    begun = time.process_time()
    status = solver.solve(model)
    seconds = time.process_time() - begun
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return {"path": None, "proven": False, "seconds": seconds}
    after = {a: b for a, b, literal in arcs if solver.boolean_value(literal)}
    path, at = [], after[question["n"]]
    while at != question["n"]:
        path.append(at)
        at = after[at]
    return {"path": path, "proven": status == cp_model.OPTIMAL, "seconds": seconds}


for line in sys.stdin:
    print(json.dumps(solve(json.loads(line))), flush=True)
