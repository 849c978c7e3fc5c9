"""What a vehicle is steered by where no mission is uploaded: which leg it flies, where it shall be, how fast; and whether it
has arrived."""
import math


class Waypoints:
    """The set point is the next waypoint; it counts as reached within the mission's cylinder."""

    def __init__(self, mission):
        self.points, self.accept, self.next, self.arrived = mission["waypoints_m"], mission["accept"], 1, False

    def follow(self, t, position):
        goal = self.points[self.next]
        level = math.hypot(goal[0] - position[0], goal[1] - position[1])
        if level <= self.accept["radius_m"] and abs(goal[2] - position[2]) <= self.accept["height_m"]:
            self.arrived = self.arrived or self.next == len(self.points) - 1
            self.next = min(self.next + 1, len(self.points) - 1)
        return self.next - 1, self.points[self.next], None


class Timed:
    """The set point is the mission's timed motion; a leg ends where that passes its waypoint."""

    def __init__(self, mission):
        self.timed, self.at, self.arrived = mission["timed"], 0, False
        self.end, self.accept = mission["waypoints_m"][-1], mission["accept_m"]
        self.passed, first = [], 0
        for point in mission["waypoints_m"][1:-1]:
            first = min(range(first, len(self.timed)), key=lambda i: math.dist(self.timed[i]["p_m"], point))
            self.passed.append(self.timed[first]["t_s"])

    def follow(self, t, position):
        while self.at + 1 < len(self.timed) - 1 and self.timed[self.at + 1]["t_s"] <= t:
            self.at += 1
        a, b = self.timed[self.at], self.timed[self.at + 1]
        share = min((t - a["t_s"]) / (b["t_s"] - a["t_s"]), 1.0)
        over = t >= b["t_s"]
        self.arrived = over and math.dist(position, self.end) <= self.accept
        velocity = [0.0, 0.0, 0.0] if over else [(1 - share) * u + share * v for u, v in zip(a["v_m_s"], b["v_m_s"])]
        leg = sum(t >= passed for passed in self.passed)
        return leg, [(1 - share) * p + share * q for p, q in zip(a["p_m"], b["p_m"])], velocity
