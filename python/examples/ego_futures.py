#!/usr/bin/env python3
"""Speeds up where hardly any of the sampled futures meets somebody, else keeps its speed or brakes.

    sumo-gamma drive SCENARIO -o DIR --seeds 1..10 --ego unix:ego.sock &
    python3 python/examples/ego_futures.py unix:ego.sock
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from sumo_gamma_ego import Ego  # noqa: E402

SAMPLES, LEAST_GAP, MOST = 8, 0.5, 0.13  # samples, [m], share of the samples


def meets(env, acceleration, brake):
    """Share of the futures in which it comes too near somebody: this for two periods, then a stop."""
    futures = env.futures([acceleration, acceleration, brake], SAMPLES)
    return sum(min(one["gap"]) < LEAST_GAP for one in futures["samples"]) / SAMPLES


def choose(env):
    choices = sorted(env.limits["accelerations"], reverse=True)
    for acceleration in choices:
        if meets(env, acceleration, choices[-1]) <= MOST:
            return acceleration
    return choices[-1]


with Ego(sys.argv[1]) as env:
    while env.seeds:
        seen, info = env.reset()
        done = False
        while not done:
            seen, reward, terminated, truncated, info = env.step(choose(env))
            done = terminated or truncated
        print(f"seed {info['seed']}: {info['outcome']} after {seen['time']:.1f} s, {info['progress']:.1f} m")
