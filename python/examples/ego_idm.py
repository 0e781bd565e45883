#!/usr/bin/env python3
"""Drives by the Intelligent Driver Model behind whoever is on its way, and halts at red lights.

    sumo-gamma drive SCENARIO -o DIR --seeds 1..10 --ego unix:ego.sock &
    python3 python/examples/ego_idm.py unix:ego.sock
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from sumo_gamma_ego import Ego  # noqa: E402

HEADWAY, GAP, FASTER, BRAKING = 1.2, 2.0, 1.5, 2.0  # [s], [m], [m/s^2], [m/s^2]


def leader(seen):
    """Gap to whoever is first on the way, and its speed along it."""
    ego, best = seen["ego"], (math.inf, 0.0)
    for agent in seen["agents"]:
        for here, there in zip(seen["way"], seen["way"][1:]):
            ahead = [there["position"][k] - here["position"][k] for k in (0, 1)]
            length = math.hypot(*ahead) or 1.0
            off = [agent["position"][k] - here["position"][k] for k in (0, 1)]
            along = (off[0] * ahead[0] + off[1] * ahead[1]) / length
            aside = abs(off[0] * ahead[1] - off[1] * ahead[0]) / length
            if 0 <= along < length and aside < (ego["width"] + agent["width"]) / 2 + 0.3:
                gap = here["along"] + along - (ego["length"] + agent["length"]) / 2
                speed = (agent["velocity"][0] * ahead[0] + agent["velocity"][1] * ahead[1]) / length
                best = min(best, (gap, max(speed, 0.0)))
    if seen["light"] in ("red", "amber") and seen["to_light"] > 0:
        best = min(best, (seen["to_light"] + GAP - 1.0, 0.0))
    return best


def acceleration(seen, limits):
    speed = seen["ego"]["speed"]
    wish = max(min(limits["max_speed"], seen["way"][0]["limit"] if seen["way"] else 99.0), 0.1)
    gap, ahead = leader(seen)
    desired = GAP + max(0.0, speed * HEADWAY + speed * (speed - ahead) / (2 * math.sqrt(FASTER * BRAKING)))
    value = FASTER * (1 - (speed / wish) ** 4 - (desired / max(gap, 0.1)) ** 2)
    return max(value, -limits["max_deceleration"])


with Ego(sys.argv[1]) as env:
    while env.seeds:
        seen, info = env.reset()
        done = False
        while not done:
            seen, reward, terminated, truncated, info = env.step(acceleration(seen, env.limits))
            done = terminated or truncated
        print(f"seed {info['seed']}: {info['outcome']} after {seen['time']:.1f} s, {info['progress']:.1f} m")
