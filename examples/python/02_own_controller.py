"""A controller of one's own on our plant, stressed beside one of ours: the twin of 02_own_controller.rs."""

import tempfile

import numpy as np

import hairpin


class Pd:
    """A spring to the next waypoint, which pulls no harder than what 4 m/s balance, and a damper."""

    stiffness, damping = 2.0, 2.5

    def control(self, t_s, state, reference):
        waypoints = np.asarray(reference["waypoints_m"])
        target = waypoints[min(reference["next"], len(waypoints) - 1)]
        pull = self.stiffness * (target - np.asarray(state["p_m"]))
        pull *= min(1.0, 4.0 * self.damping / max(np.linalg.norm(pull), 1e-9))
        return {"a_m_s2": pull - self.damping * np.asarray(state["v_m_s"])}


place = tempfile.mkdtemp()
cases = hairpin.generate(
    "demo-quadrotor", out=f"{place}/ours", values={"generate.search.cases": 3, "execute.repeat": 1, "execute.baseline": 0}
)
ours = cases.execute().judge()
own = cases.execute(controller=Pd, out=f"{place}/own").judge()
for campaign in (own, ours):
    print(f"{campaign.controller}: worst deviation {campaign.worst.max_deviation_m:.2f} m on {len(campaign)} trajectories")
print(ours.compare(own).verdict)
