"""A score of one's own, of many legs at once, and a judge of one's own beside the folder's verdict."""

import tempfile

import numpy as np

import hairpin


@hairpin.vectorised
def sharp(legs):
    return legs["v_in_m_s"] * legs["turn_rad"] / np.maximum(legs["length_m"], 0.1)


def smooth(run):
    """Within, as long as no second of the flight is faster than 12 m/s."""
    step = np.maximum(np.diff(run.t_s), 1e-9)
    return 12.0 - float((np.linalg.norm(np.diff(run.p_m, axis=0), axis=1) / step).max())


values = {"generate.search.method": "beam", "generate.search.cases": 2, "execute.baseline": 0}
found = hairpin.stress("demo-quadrotor", score=sharp, out=tempfile.mkdtemp() + "/out", values=values)
print(found.verdict)
judged = found.judge_by(smooth)
print({key: round(margin, 2) for key, margin in judged.margins.items()}, "exit code", judged.exit_code)
