#!/usr/bin/env python3
"""Fits how types drive to recordings, by SciPy's differential evolution, and says what each recording left out gains.

usage: calibrate.py PROGRAM TYPE FIELD=LOW..HIGH[,...] [--runs N] [--evaluations N] [--seed N]
                    [--ignore MEASURE[,...]] -o STATE.json -- RECORDING...
  TYPE       car, or several with commas: types of scenario.toml whose [types.TYPE] fields are fitted together
  FIELD      headway, max_acceleration, comfortable_deceleration, critical_gap, horizon, ... (docs/scenario.md)
  RECORDING  FILE[;OPTION[;OPTION...]] with the options that `score` wants for it: "k733.csv;--period;0.1;--map;k733.net.xml"

The loss of a recording is the mean of: what the kinematic likelihoods and that of the nearest distance lack of the log's
own, the Hellinger distances of speed, acceleration, yaw rate, nearest distance and time gap in windows of 8 s, each at most
1 (--ignore leaves out what a recording's noise spoils), and the relative error of progress; plus 10 times the share of
agents that collide anew. Rollouts have the same seeds for all parameters. The loss of several recordings is the mean.

With two recordings and more each is left out once: fitted on the others, and scored on it with other seeds, beside the
program's own values. Keep a parameter only where it gains there. Every evaluation is kept in STATE.json: a run that was
stopped goes on. Needs Debian's python3-scipy.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

HELLINGER = ("speed", "acceleration", "yaw_rate", "nearest", "time_gap")
FRESH_SEED = 1001  # of rollouts that nothing was fitted on


def parsed(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("types")
    parser.add_argument("fields")
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("-o", dest="state", required=True)
    parser.add_argument("--runs", type=int, default=8, help="rollouts of a window")
    parser.add_argument("--evaluations", type=int, default=150, help="of each fit")
    parser.add_argument("--seed", type=int, default=1, help="of the optimiser")
    parser.add_argument("--ignore", default="", help="measures whose distributions don't count")
    options = parser.parse_args(arguments)
    options.ignore = options.ignore.split(",")
    options.bounds = {}
    for part in options.fields.split(","):
        name, _, span = part.partition("=")
        low, _, high = span.partition("..")
        options.bounds[name] = (float(low), float(high))
    return options


def score(options, recording, values, seed):
    """What `score` says of GAMMA and the log on one recording."""
    file, *own = recording.split(";")
    with tempfile.TemporaryDirectory() as folder:
        command = [options.program, "score", file, *own, "--method", "log,gamma", "--seeds", str(options.runs), "--seed",
                   str(seed), "--quiet", "-o", os.path.join(folder, "out")]
        for kind in options.types.split(","):
            for name, value in values.items():
                command += ["--set", f"types.{kind}.{name}={value!r}"]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"calibrate.py: {' '.join(command)}: {done.stderr.strip()}")
        with open(os.path.join(folder, "out", "score.json"), encoding="utf-8") as stream:
            return json.load(stream)["recordings"][0]


def loss_of(recording, ignored):
    log, gamma = recording["methods"]
    parts = [max(0.0, log[name] - gamma[name]) for name in ("kinematic", "likelihood_nearest")]
    parts += [min(1.0, gamma["hellinger"][name]) for name in HELLINGER
              if name not in ignored and gamma["hellinger"][name] is not None]
    return sum(parts) / len(parts) + abs(gamma["progress"] - 1.0) / len(parts) + 10.0 * gamma["colliding_anew"]


class Losses:
    """Losses that were evaluated, kept in a file."""

    def __init__(self, options):
        self.options, self.known = options, {}
        if os.path.exists(options.state):
            with open(options.state, encoding="utf-8") as stream:
                self.known = json.load(stream)

    def __call__(self, recording, values, seed=1):
        key = json.dumps([recording, self.options.types, self.options.runs, self.options.ignore, seed, sorted(values.items())])
        if key not in self.known:
            self.known[key] = loss_of(score(self.options, recording, values, seed), self.options.ignore)
            part = self.options.state + ".part"
            with open(part, "w", encoding="utf-8") as stream:
                json.dump(self.known, stream)
            os.replace(part, self.options.state)
        return self.known[key]


def fitted(options, losses, recordings):
    """The best values on these recordings."""
    from scipy.optimize import differential_evolution
    names, bounds = list(options.bounds), list(options.bounds.values())

    def loss(point):
        values = {name: round(float(x), 4) for name, x in zip(names, point)}
        return sum(losses(one, values) for one in recordings) / len(recordings)

    size = max(4, options.evaluations // 10)
    found = differential_evolution(loss, bounds, popsize=max(1, math.ceil(size / len(names))), init="sobol",
                                   maxiter=max(1, options.evaluations // size - 1), polish=False, seed=options.seed)
    return {name: round(float(x), 4) for name, x in zip(names, found.x)}, float(found.fun)


def main(arguments):
    options = parsed(arguments)
    losses = Losses(options)
    own = {one: losses(one, {}) for one in options.recordings}
    best, loss = fitted(options, losses, options.recordings)
    print(f"all: {best}: loss {loss:.4f}, the program's own {sum(own.values()) / len(own):.4f}")
    if len(options.recordings) < 2:
        return 0
    print("\n| left out | fitted on the others | loss there | the program's own |\n|---|---|---|---|")
    for one in options.recordings:
        values, _ = fitted(options, losses, [other for other in options.recordings if other != one])
        name = os.path.basename(one.split(";")[0])
        print(f"| {name} | {values} | {losses(one, values, FRESH_SEED):.4f} | {losses(one, {}, FRESH_SEED):.4f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
