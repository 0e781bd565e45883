#!/usr/bin/env python3
"""Learns the coefficients of the regression of people on foot and prints src/prediction/walking_coefficients.h.

usage: train_walking_model.py --program build/dev/sumo-gamma RECORDING...
       ... --leave-one-out: instead, for each recording ADE/FDE of the coefficients learned on the others

Features and truth come from the program (predict --walking-rows). Every recording counts alike, but one of fewer than
600 windows by its windows; long ones are thinned. What is minimised is the mean distance at the steps 3, 6, 9 and 12
(least squares, reweighted by one over the distance), with a light ridge. Deterministic, standard library alone.
"""
import argparse
import math
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from linear_system import solve  # noqa: E402

STEPS = (3, 6, 9, 12)
FEATURES = 13
RIDGE = 1e-3
ROUNDS = 6
LEAST = 0.05   # [m] nearer misses weigh no more
THINNED = 1000  # windows of a recording that are looked at
FULL = 600     # windows from which on a recording counts in full


def read(program, recordings, options):
    """{set: [(truth [(x, y)] by step, features [(x, y)])]} of all recordings."""
    sets = {}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rows.csv")
        subprocess.run([program, "predict", *recordings, "--quiet", "--walking-rows", path, *options], check=True)
        with open(path, encoding="utf-8") as file:
            next(file)
            for line in file:
                name, *fields = line.split(",")
                v = [float(x) for x in fields]
                pairs = list(zip(v[0::2], v[1::2]))
                sets.setdefault(name, []).append((pairs[:len(STEPS)], pairs[len(STEPS):]))
    return sets


def thin(windows):
    return windows[::len(windows) // THINNED + 1]


def basis(step):
    return (step, step * step / 12.0)


def predicted(coefficients, features, step):
    g = basis(step)
    c = [a * g[0] + b * g[1] for a, b in coefficients]
    return (sum(w * f[0] for w, f in zip(c, features)), sum(w * f[1] for w, f in zip(c, features)))


def learn(sets):
    """Coefficients [(a, b)] by feature."""
    windows = [(w, min(1.0, FULL / len(all_windows)))
               for all_windows in map(thin, sets.values()) for w in all_windows]
    coefficients = None
    for _ in range(ROUNDS):
        gram = {s: [[0.0] * FEATURES for _ in range(FEATURES)] for s in STEPS}
        moment = {s: [0.0] * FEATURES for s in STEPS}
        for (truth, features), share in windows:
            products = [[fi[0] * fj[0] + fi[1] * fj[1] for fj in features[:i + 1]] for i, fi in enumerate(features)]
            for s, t in zip(STEPS, truth):
                weight = share
                if coefficients:
                    p = predicted(coefficients, features, s)
                    weight /= max(math.hypot(p[0] - t[0], p[1] - t[1]), LEAST)
                g, m = gram[s], moment[s]
                for i, f in enumerate(features):
                    m[i] += weight * (f[0] * t[0] + f[1] * t[1])
                    g[i][:i + 1] = [a + weight * b for a, b in zip(g[i], products[i])]
        size = 2 * FEATURES
        matrix, right = [[0.0] * size for _ in range(size)], [0.0] * size
        for s in STEPS:
            b = basis(s)
            for i in range(FEATURES):
                for p in range(2):
                    right[2 * i + p] += b[p] * moment[s][i]
                    for j in range(FEATURES):
                        for q in range(2):
                            matrix[2 * i + p][2 * j + q] += b[p] * b[q] * gram[s][max(i, j)][min(i, j)]
        for i in range(size):
            matrix[i][i] *= 1.0 + RIDGE
        x = solve(matrix, right)
        coefficients = list(zip(x[0::2], x[1::2]))
    return coefficients


def errors(coefficients, windows):
    """Mean distance over the four steps and at the last one."""
    total = final = 0.0
    for truth, features in windows:
        d = [math.dist(predicted(coefficients, features, s), t) for s, t in zip(STEPS, truth)]
        total += sum(d) / len(d)
        final += d[-1]
    return total / len(windows), final / len(windows)


def header(coefficients, names):
    """src/prediction/walking_coefficients.h as the format lint has it."""
    lines = ["#pragma once", "", "namespace sumogamma {", "",
             "/// Written by tools/train_walking_model.py on",
             *("/// " + ", ".join(names[k:k + 3]) + "," for k in range(0, len(names), 3)),
             "/// by feature: at step k it adds k times the first and k^2 / 12 times the second.",
             f"inline constexpr double kWalkingCoefficients[{FEATURES}][2] = {{"]
    lines += [f"    {{{a:.5g}, {b:.5g}}}," for a, b in coefficients]
    return "\n".join(lines + ["};", "", "}  // namespace sumogamma"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--program", required=True)
    parser.add_argument("--leave-one-out", action="store_true")
    parser.add_argument("--only", nargs="*", help="with --leave-one-out: leave out these alone")
    parser.add_argument("--options", nargs="*", default=[], help="passed on to the program")
    options = parser.parse_args()
    sets = read(options.program, options.recordings, options.options)
    if options.leave_one_out:
        for name in options.only or sets:
            learned = learn({other: w for other, w in sets.items() if other != name})
            print(f"{name}: {len(sets[name])} windows, steps 3 6 9 12: %.3f, last %.3f" % errors(learned, sets[name]),
                  flush=True)
        return
    print(header(learn(sets), sorted(sets)))


if __name__ == "__main__":
    main()
