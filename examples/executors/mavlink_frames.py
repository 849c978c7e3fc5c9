"""Between hairpin's world (x, y, z up; body x forward, y left, z up) and an autopilot's (north, east, down; forward, right, down).

Nothing else turns anything. The world's x axis has the compass heading of the mission's `world.origin`, 90° (east) where
it names none; its origin is the origin of the autopilot's local frame.
"""
import math


def multiplied(a, b):
    """The product of two quaternions, w first."""
    (aw, ax, ay, az), (bw, bx, by, bz) = a, b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


class World:
    def __init__(self, heading_deg=90.0):
        self.heading = math.radians(heading_deg)
        self.cosine, self.sine = math.cos(self.heading), math.sin(self.heading)
        # Half a turn about the level axis between north and x takes one frame into the other, either way.
        self.turn = (0.0, math.cos(self.heading / 2), math.sin(self.heading / 2), 0.0)

    @classmethod
    def of(cls, mission):
        return cls((mission["world"].get("origin") or {}).get("x_axis_heading_deg", 90.0))

    def turned(self, vector):
        """A vector of the world in north, east, down, or one of those in the world."""
        a, b, c = vector
        return (a * self.cosine + b * self.sine, a * self.sine - b * self.cosine, -c)

    def pose(self, p_ned, v_ned, q_ned_from_frd):
        """Position, velocity and `world_from_body` (w first, not negative)."""
        q = multiplied(multiplied(self.turn, q_ned_from_frd), (0.0, 1.0, 0.0, 0.0))
        norm = math.copysign(math.sqrt(sum(c * c for c in q)), q[0])
        return self.turned(p_ned), self.turned(v_ned), tuple(c / norm for c in q)

    def compass(self, yaw):
        """The heading (rad, from north to east) of a yaw in the world (from x to y)."""
        return math.remainder(self.heading - yaw, 2 * math.pi)


class Azimuthal:
    """Latitude and longitude as PX4 has them: azimuthal equidistant about the local frame's origin, on a ball."""

    RADIUS = 6371000.0

    def __init__(self, lat_deg, lon_deg):
        self.lat, self.lon = math.radians(lat_deg), math.radians(lon_deg)

    def degrees(self, north, east):
        x, y = north / self.RADIUS, east / self.RADIUS
        c = math.hypot(x, y)
        if c == 0.0:
            return math.degrees(self.lat), math.degrees(self.lon)
        lat = math.asin(math.cos(c) * math.sin(self.lat) + x * math.sin(c) * math.cos(self.lat) / c)
        lon = math.atan2(y * math.sin(c), c * math.cos(self.lat) * math.cos(c) - x * math.sin(self.lat) * math.sin(c))
        return math.degrees(lat), math.degrees(self.lon + lon)

    def metres(self, lat_deg, lon_deg):
        lat, lon = math.radians(lat_deg), math.radians(lon_deg) - self.lon
        level = math.cos(self.lat) * math.sin(lat) - math.sin(self.lat) * math.cos(lat) * math.cos(lon)
        side = math.cos(lat) * math.sin(lon)
        sine = math.hypot(level, side)
        scale = self.RADIUS * (math.asin(min(sine, 1.0)) / sine if sine else 1.0)
        return scale * level, scale * side


class Scaled:
    """Latitude and longitude as ArduPilot has them: metres by degrees, longitude by the cosine of the middle latitude."""

    METRES = 1e7 * 0.011131884502145034

    def __init__(self, lat_deg, lon_deg):
        self.lat, self.lon = lat_deg, lon_deg

    def degrees(self, north, east):
        lat = self.lat + north / self.METRES
        return lat, self.lon + east / (self.METRES * math.cos(math.radians((lat + self.lat) / 2)))

    def metres(self, lat_deg, lon_deg):
        scale = math.cos(math.radians((lat_deg + self.lat) / 2))
        return (lat_deg - self.lat) * self.METRES, (lon_deg - self.lon) * self.METRES * scale
