#!/usr/bin/env python3
"""How often what then happens lies where `futures` said that it might, and how long an answer takes.

    sumo-gamma drive SCENARIO -o DIR --seeds 1..40 --ego unix:ego.sock &
    python3 tools/measure_futures.py unix:ego.sock [QUESTIONS] [SAMPLES]

The ego's accelerations are set beforehand, so that the plan that is asked about is the one that is
driven. A region of 50 % (90 %) of an agent at a time is the disc about the samples' mean that holds
as many of the samples. Prints a line a time ahead: agents, coverage, mean error, mean radius.
"""

import math
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from sumo_gamma_ego import Ego  # noqa: E402

PLAN = [2.0] * 4 + [0.0] * 6 + [-1.0] * 4 + [0.0] * 4
STATES = {3: 1.0, 6: 2.0, 12: 4.0}  # number of the state: seconds ahead


def acceleration(step):
    return PLAN[step % len(PLAN)]


def regions(futures, state):
    """By agent but the ego: mean place, radius of half of the samples and of nine tenths."""
    found = {}
    for k, agent in enumerate(futures["agents"][1:], start=1):
        places = [sample["poses"][state - 1][k][:2] for sample in futures["samples"]]
        mean = [sum(place[axis] for place in places) / len(places) for axis in (0, 1)]
        off = sorted(math.dist(place, mean) for place in places)
        found[agent] = (mean, off[(len(off) - 1) // 2], off[math.ceil(0.9 * len(off)) - 1])
    return found


def main():
    questions = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    samples = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    sums = {state: [0, 0, 0, 0.0, 0.0] for state in STATES}
    asked, waited, stepped, steps = 0, 0.0, 0.0, 0
    with Ego(sys.argv[1]) as env:
        while env.seeds and asked < questions:
            seen, _ = env.reset()
            said, done, number = {}, False, 0
            while not done:
                if asked < questions:
                    begin = time.perf_counter()
                    futures = env.futures([acceleration(number + k) for k in range(12)], samples)
                    waited += time.perf_counter() - begin
                    asked += 1
                    for state in STATES:
                        said[number + state, state] = regions(futures, state)
                begin = time.perf_counter()
                seen, _, terminated, truncated, _ = env.step(acceleration(number))
                stepped += time.perf_counter() - begin
                steps += 1
                number += 1
                done = terminated or truncated
                for agent in seen["agents"] if not done else []:
                    for state in STATES:
                        region = said.get((number, state), {}).get(agent["id"])
                        if region is None:
                            continue
                        off = math.dist(agent["position"], region[0])
                        total = sums[state]
                        total[0] += 1
                        total[1] += off <= region[1]
                        total[2] += off <= region[2]
                        total[3] += off
                        total[4] += region[2]
    print(f"{asked} answers of {samples} samples: {1e3 * waited / max(asked, 1):.1f} ms each; "
          f"{steps} steps: {1e3 * stepped / max(steps, 1):.1f} ms each")
    for state, ahead in STATES.items():
        count, half, most, error, radius = sums[state]
        if count:
            print(f"{ahead:.0f} s: {count} agents, {100 * half / count:.0f} % in 50 %, "
                  f"{100 * most / count:.0f} % in 90 %, error {error / count:.2f} m, "
                  f"radius of 90 % {radius / count:.2f} m")


if __name__ == "__main__":
    main()
