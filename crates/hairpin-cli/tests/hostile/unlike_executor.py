"""Flies each mission along its straight legs at 2 m/s, 50 poses a second, and tells what no robot does, by its argument:
`leap` leaves out nine tenths of the longest leg and the time for them, `some` does so in about half of the missions, `over` has its up axis down all the way, `flip`
on one leg, `held` tells each place for a second, `straight` nothing of it."""
import json, math, sys
MODE = sys.argv[1]
def say(**m): print(json.dumps(m), flush=True)
def fly(w):
    lengths = [math.dist(a, b) for a, b in zip(w, w[1:])]
    longest = lengths.index(max(lengths))
    rows, t, held = [], 0.0, None
    leaps = MODE == "leap" or MODE == "some" and round(1000 * sum(lengths)) % 2
    for leg, (a, b) in enumerate(zip(w, w[1:])):
        n = max(2, math.ceil(lengths[leg] / 2 / 0.02))
        for k in range(n):
            s = k / n
            if leaps and leg == longest and 0.05 < s < 0.95: continue
            rows.append((t, [u + (v - u) * s for u, v in zip(a, b)], leg))
            t += 0.02
    rows.append((t, w[-1], len(w) - 2))
    for i, (t, p, leg) in enumerate(rows):
        if MODE == "held" and i % 50 and i < len(rows) - 1: p = held
        held = p
        down = MODE == "over" or MODE == "flip" and leg == longest
        say(type="pose", t_s=t, p_m=p, q_wxyz=[0, 1, 0, 0] if down else [1, 0, 0, 0], leg=leg)
    say(type="end", reason="done")
for line in sys.stdin:
    m = json.loads(line)
    if m["type"] == "hello": say(type="ready", protocol=1, name="unlike")
    elif m["type"] == "mission": fly(m["waypoints_m"])
    else: break
