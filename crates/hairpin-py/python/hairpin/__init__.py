"""hairpin: searches feasible trajectories for stress, executes them in closed loop, and judges them against a spec.

    import hairpin

    found = hairpin.stress("quadrotor.toml", controller=my_controller)
    found.worst, found.verdict
    found.shrink()

Every job is the command of the same name, with the same settings, results and bytes. SI and radians; units are in the names.
A test generator: what it finds is stressful by design, and is no safety certificate.
"""

from hairpin._call import Progress
from hairpin._callables import Controller, ControllerLike
from hairpin._campaign import Campaign
from hairpin._errors import ExecutorError, InputError, Interrupted, WriteError
from hairpin._executors import adversary, dynamics
from hairpin._heaviest import MaxLoad, max_load
from hairpin._jobs import (
    Explanation,
    Model,
    compare,
    execute,
    explain,
    generate,
    learn,
    open_campaign,
    shrink,
    stress,
    verify,
)
from hairpin._judge import judge
from hairpin._judging import Judged
from hairpin._live import live
from hairpin._logs import Cut, JudgedLog, JudgedLogs
from hairpin._many import vectorised
from hairpin._native import __version__
from hairpin._results import Case, Comparison, Report, Run, Shrunk, Verification, Violation
from hairpin._scenario import Robot, Scenario, World
from hairpin._steering import STATUSES, Curvature, Drive, Drives, Segment, steer
from hairpin._tables import Table

__all__ = [
    "STATUSES",
    "Campaign",
    "Case",
    "Comparison",
    "Controller",
    "ControllerLike",
    "Curvature",
    "Cut",
    "Drive",
    "Drives",
    "ExecutorError",
    "Explanation",
    "InputError",
    "Interrupted",
    "Judged",
    "JudgedLog",
    "JudgedLogs",
    "MaxLoad",
    "Model",
    "Progress",
    "Report",
    "Robot",
    "Run",
    "Scenario",
    "Segment",
    "Shrunk",
    "Table",
    "Verification",
    "Violation",
    "World",
    "WriteError",
    "__version__",
    "adversary",
    "compare",
    "dynamics",
    "execute",
    "explain",
    "generate",
    "judge",
    "learn",
    "live",
    "max_load",
    "open_campaign",
    "shrink",
    "steer",
    "stress",
    "vectorised",
    "verify",
]
