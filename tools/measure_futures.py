#!/usr/bin/env python3
"""How far off `futures` are, how often what then happens lies where they said, how long an answer takes.

    sumo-gamma drive SCENARIO -o DIR --seeds 1..40 --ego unix:ego.sock &
    python3 tools/measure_futures.py unix:ego.sock [QUESTIONS] [SAMPLES] [true]      true: by everybody's own way

The ego's accelerations are set beforehand, so that the plan that is asked about is the one that is
driven. A region of 50 % (90 %) of an agent at a time is the disc about the samples' mean that holds
as many of the samples. Prints a line a kind of agent and time ahead; errors [m] are means over agents:
of all samples, of the best one, and of going on at the velocity seen.
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


class Said:
    """What was said of one agent at one time ahead."""

    def __init__(self, places, straight_on):
        self.places, self.straight_on = places, straight_on
        self.mean = [sum(place[axis] for place in places) / len(places) for axis in (0, 1)]
        off = sorted(math.dist(place, self.mean) for place in places)
        self.half, self.most = off[(len(off) - 1) // 2], off[math.ceil(0.9 * len(off)) - 1]

    def figures(self, place):
        """1, in 50 %, in 90 %, errors of the samples, the best, constant velocity; radius of 90 %."""
        off, errors = math.dist(place, self.mean), [math.dist(place, one) for one in self.places]
        return (1, off <= self.half, off <= self.most, sum(errors) / len(errors), min(errors),
                math.dist(place, self.straight_on), self.most)


def what_was_said(futures, seen, state):
    """By agent but the ego."""
    now = {agent["id"]: agent for agent in seen["agents"]}
    ahead, found = state * futures["step"], {}
    for k, name in enumerate(futures["agents"][1:], start=1):
        agent = now[name]
        straight_on = [agent["position"][axis] + ahead * agent["velocity"][axis] for axis in (0, 1)]
        found[name] = Said([sample["poses"][state - 1][k][:2] for sample in futures["samples"]], straight_on)
    return found


def main():
    questions = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    samples = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    ways = "true" if sys.argv[4:] == ["true"] else "believed"
    sums = {(kind, state): [0] * 7 for kind in ("vehicles", "people") for state in STATES}
    asked, waited, stepped, steps = 0, 0.0, 0.0, 0
    with Ego(sys.argv[1]) as env:
        while env.seeds and asked < questions:
            seen, _ = env.reset()
            said, done, number = {}, False, 0
            while not done:
                if asked < questions:
                    begin = time.perf_counter()
                    futures = env.futures([acceleration(number + k) for k in range(12)], samples, ways)
                    waited += time.perf_counter() - begin
                    asked += 1
                    for state in STATES:
                        said[number + state, state] = what_was_said(futures, seen, state)
                begin = time.perf_counter()
                seen, _, terminated, truncated, _ = env.step(acceleration(number))
                stepped += time.perf_counter() - begin
                steps += 1
                number += 1
                done = terminated or truncated
                for agent in seen["agents"] if not done else []:
                    kind = "people" if agent["type"] == "pedestrian" else "vehicles"
                    for state in STATES:
                        one = said.get((number, state), {}).get(agent["id"])
                        if one:
                            figures = one.figures(agent["position"])
                            sums[kind, state] = [a + b for a, b in zip(sums[kind, state], figures)]
    print(f"{asked} answers of {samples} samples: {1e3 * waited / max(asked, 1):.1f} ms each; "
          f"{steps} steps: {1e3 * stepped / max(steps, 1):.1f} ms each")
    for (kind, state), (count, half, most, samples_off, best, straight, radius) in sums.items():
        if count:
            print(f"{kind} {STATES[state]:.0f} s: {count}, {100 * half / count:.0f} % in 50 %, "
                  f"{100 * most / count:.0f} % in 90 %, errors {samples_off / count:.2f} {best / count:.2f} "
                  f"{straight / count:.2f} m, radius of 90 % {radius / count:.2f} m")


if __name__ == "__main__":
    main()
