"""The shortest way from two states to a drive, and ten thousand of them in one call: the twin of 01_steer_rover.rs."""

import numpy as np

import hairpin

# One metre ahead, one to the left, turned left by 45°, wheels straight at both ends.
drive = hairpin.steer("generic", x=1.0, y=1.0, yaw=0.785, k0=0.0, kf=0.0, reversals=True)
for segment in drive.segments:
    print(segment.kind, segment.direction, f"{segment.length_m:.3f} m", np.round(segment.curvature, 3))
off = np.hypot(drive.errors[0], drive.errors[1])
print(f"{drive.length_m:.3f} m; replayed, it ends {off:.1e} m and {abs(drive.errors[2]):.1e} rad from the goal")

random = np.random.default_rng(7)
goals = np.zeros((10_000, 5))
goals[:, 0] = random.uniform(2.0, 8.0, len(goals))
goals[:, 1] = random.uniform(-2.0, 2.0, len(goals))
goals[:, 2] = random.uniform(-1.0, 1.0, len(goals))
drives = hairpin.steer("generic", queries=goals)
print(drives, f"{drives.length_m[drives.ok].mean():.2f} m in the mean")
