"""A log of a real flight, judged by the limits of a campaign (the twin of 04_judge_a_track.rs): nothing is aligned, cuts are told.

The log is one that this example makes itself, of a case that it flew, with the motion capture lost for half a second.
"""

import tempfile
from pathlib import Path

import numpy as np

import hairpin

place = Path(tempfile.mkdtemp())
found = hairpin.stress(
    "demo-quadrotor", out=place / "out", values={"generate.search.cases": 2, "execute.repeat": 1, "execute.baseline": 0}
)

flown = found.execution("0000")
t_s = np.arange(flown["t_s"][0], flown["t_s"][-1], 0.01)
columns = [np.interp(t_s, flown["t_s"], flown[name]) for name in ("x_m", "y_m", "z_m")]
lost = (t_s > 2.0) & (t_s < 2.5)
np.savetxt(place / "log.csv", np.stack([t_s, *columns], axis=1)[~lost], delimiter=",", header="t_s,x_m,y_m,z_m", comments="")

judged = hairpin.judge(place / "log.csv", {"spec.deviation.max_m": 9.0}, campaign=found)
print(judged)
log = judged.logs[0]
print(log.case, log.status, [(cut.what, round(cut.lost_s, 2)) for cut in log.cuts])
assert log.case == "0000" and log.status == "invalid" and log.cuts[0].what
