"""A whole campaign from code, watched: the twin of 07_campaign.rs."""

import tempfile
from collections import Counter

import hairpin

seen = Counter()


def progress(what, done, of):
    """A graphical program would draw it; KeyboardInterrupt ends the campaign and keeps what it has."""
    seen[what] = max(seen[what], done)


campaign = hairpin.stress(
    "demo-quadrotor",
    out=tempfile.mkdtemp() + "/out",
    values={"generate.search.cases": 4, "execute.repeat": 2, "execute.baseline": 0},
    budget_s=60,
    progress=progress,
)
print(campaign.verdict)
print(f"exit code {campaign.exit_code}; {seen['execute']} runs landed")
for case in campaign:
    print(f"case {case.id}: {case.status}, {case.max_deviation_m:.2f} m")
