#!/usr/bin/env python3
"""Learns how far people and vehicles are from where they are predicted and prints src/prediction/spread_table.h.

usage: train_spread.py --program build/dev/sumo-gamma RECORDING...
       ... --leave-one-out: instead, for each recording how often the regions learned on the others hold the truth
       ... --check RECORDING...: the same for further recordings, from what was learned on all of the first

Rows come from the program (predict --spread-rows): strict windows of protocol C, each by itself. By kind (on foot, on
wheels), band of speed and step: the scale along the motion and across, and a tail, so that 50 and 90 of a hundred
training windows lie in the regions of that name; by kind and step: the powers with which an agent's clues scale them
(spread_model.h). Places count alike in a cell, but those of few windows by their windows; recordings whose names begin
alike are one place. Wheels are learned from what is seen and, as a place of its own, from the same under 2 cm of noise.
Deterministic, standard library alone.
"""
import argparse
import math
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from linear_system import solve  # noqa: E402

KINDS, BANDS, STEPS = 2, 6, 12
USED = ((0, 1, 2), (0, 3))  # clues by kind, of CLUES: wheels are too few for more
CLUES = 4  # own, scene, mixture, speed
NOISE = "0.02"      # [m]
SMOOTHED = (("cross", 0),)  # people whose tracks were smoothed with their future teach nothing
RIDGE = 0.05
SCENE_PRIOR = 3.0   # as in spread_model.cpp, likewise the two below
MOST_CLUE = 3.0
CIRCLE, HALF = 2.145966, 1.177410  # radii that hold 90 and 50 % of a normal cloud
THINNED = 1000      # windows of a recording and kind that are looked at
FULL = 100          # windows in a cell from which on a recording counts in full
ENOUGH = 60         # weight of a cell below which it borrows from the bands beside it
LEAST = 1e-4        # [m] least scale
NEAR = 0.01         # [m] nearer misses tell the powers nothing more


def read(program, recordings, options):
    """{set: [(kind, band, (own, mixture, speed), sums, errors)]}: (sum, count) by band; (along, across) by step."""
    sets = {}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rows.csv")
        done = subprocess.run([program, "predict", *recordings, "--quiet", "--spread-rows", path, *options], check=False)
        if done.returncode not in (0, 1):  # 1: some were left out by name
            raise SystemExit(done.returncode)
        read_rows(path, sets)
    return sets


def read_rows(path, sets):
    with open(path, encoding="utf-8") as file:
        next(file)
        for line in file:
            name, kind, band, *fields = line.split(",")
            v = [float(x) for x in fields]
            pairs = list(zip(v[3::2], v[4::2]))
            sets.setdefault(name, []).append((int(kind), int(band), v[:3], pairs[:BANDS], pairs[BANDS:]))


def places(sets, noisy):
    """{place: windows}: what is learned from."""
    result = {}
    for source, suffix in ((sets, ""), (noisy, " noisy")):
        for name, windows in source.items():
            place = re.match("[a-z_]*[a-z]", name).group() + suffix
            for kind in range(KINDS):
                mine = [w for w in windows if w[0] == kind]
                if (name, kind) not in SMOOTHED and (kind == 1 or not suffix):
                    result.setdefault(place, []).extend(mine[::len(mine) // THINNED + 1])
    return result


def weighted(learned, kind, band):
    """[(weight, window)] of a cell."""
    cell = []
    for windows in learned.values():
        mine = [w for w in windows if w[0] == kind and w[1] == band]
        weight = min(1.0, FULL / max(len(mine), 1))
        cell += [(weight, w) for w in mine]
    return cell


def quantile(pairs, share):
    """Of (value, weight) pairs."""
    pairs = sorted(pairs)
    wanted, total = share * sum(w for _, w in pairs), 0.0
    for value, weight in pairs:
        total += weight
        if total >= wanted:
            return value
    return pairs[-1][0]


class Model:
    def __init__(self, sets, noisy):
        learned = places(sets, noisy)
        cells = [[weighted(learned, kind, band) for band in range(BANDS)] for kind in range(KINDS)]
        self.usual = [self.usual_of(cells[kind]) for kind in range(KINDS)]
        self.powers = [[self.learn_powers(cells[kind], kind, step) for step in range(STEPS)] for kind in range(KINDS)]
        self.table = [[[self.learn_entry(self.borrowed(cells[kind], band), step) for step in range(STEPS)]
                       for band in range(BANDS)] for kind in range(KINDS)]

    @staticmethod
    def borrowed(cells, band):
        """A cell with what the bands beside it lend where it is thin."""
        cell = list(cells[band])
        for far in range(1, BANDS):
            lack = ENOUGH - sum(w for w, _ in cell)
            if lack <= 0:
                break
            lent = [p for near in (band - far, band + far) if 0 <= near < BANDS for p in cells[near]]
            total = sum(w for w, _ in lent)
            cell += [(w * min(1.0, lack / total), window) for w, window in lent]
        return cell

    def usual_of(self, cells):
        usual = []
        for band in range(BANDS):
            cell = self.borrowed(cells, band)
            usual.append(sum(w * x[2][0] for w, x in cell) / max(sum(w for w, _ in cell), 1e-9))
        return usual

    def clues(self, window):
        kind, band, (own, mixture, speed), sums, _ = window
        usual = self.usual[kind]
        odd = sum(s - n * u for (s, n), u in zip(sums, usual))
        return (max(-MOST_CLUE, min(MOST_CLUE, own - usual[band])), odd / (sum(n for _, n in sums) + SCENE_PRIOR),
                mixture, speed)

    def learn_powers(self, cells, kind, step):
        """Least squares of the logarithm of the distance on the clues, each cell with a mean of its own."""
        used = USED[kind]
        size = len(used)
        matrix, right = [[0.0] * size for _ in range(size)], [0.0] * size
        for cell in cells:
            total = sum(w for w, _ in cell)
            if total < 5:
                continue
            rows = []
            for w, x in cell:
                clues = self.clues(x)
                rows.append((w, [clues[c] for c in used] + [math.log(max(math.hypot(*x[4][step]), NEAR))]))
            mean = [sum(w * v[k] for w, v in rows) / total for k in range(size + 1)]
            for w, v in rows:
                off = [a - m for a, m in zip(v, mean)]
                for i in range(size):
                    right[i] += w * off[i] * off[size]
                    matrix[i] = [m + w * off[i] * o for m, o in zip(matrix[i], off)]
        for i in range(size):
            matrix[i][i] *= 1.0 + RIDGE
            matrix[i][i] += 1e-6
        powers = [0.0] * CLUES
        for c, value in zip(used, solve(matrix, right)):
            powers[c] = value
        return powers

    def scale(self, window, step):
        return math.exp(sum(p * c for p, c in zip(self.powers[window[0]][step], self.clues(window))))

    def learn_entry(self, cell, step):
        if not cell:
            return (0.1, 0.1, 1.0)
        rows = [(w, *(abs(e) / self.scale(x, step) for e in x[4][step])) for w, x in cell]
        total = sum(r[0] for r in rows)
        along, across = (max(sum(r[0] * r[k] for r in rows) / total, LEAST) for k in (1, 2))
        far = [(math.hypot(a / along, b / across), w) for w, a, b in rows]
        half, most = max(quantile(far, 0.5), 1e-3), max(quantile(far, 0.9), 2e-3)
        tail = max(0.5, math.log(half / most) / math.log(HALF / CIRCLE))
        return (along * most / CIRCLE, across * most / CIRCLE, tail)

    def radius(self, window, step):
        """In deviations of a normal cloud."""
        along, across, tail = self.table[window[0]][window[1]][step]
        scale = self.scale(window, step)
        a, b = window[4][step]
        return CIRCLE * (math.hypot(a / along, b / across) / scale / CIRCLE) ** (1.0 / tail)


def report(name, windows, model):
    for kind in range(KINDS):
        for label, bands in (("under 0.5", (0, 1)), ("0.5 to 1.5", (2, 3)), ("1.5 to 3", (4,)), ("3 and more", (5,))):
            mine = [w for w in windows if w[0] == kind and w[1] in bands]
            if len(mine) < 20:
                continue
            text = f"{name:36} {('on foot', 'wheels')[kind]:8} {label:11} {len(mine):5}"
            for region in (HALF, CIRCLE):
                text += "  in %d:" % (50 if region == HALF else 90)
                for step in (0, 2, 5, 8, 11):
                    text += " %4.0f" % (100.0 * sum(model.radius(w, step) <= region for w in mine) / len(mine))
            print(text, flush=True)


def header(model, names):
    """src/prediction/spread_table.h."""
    def braces(values):
        return "{" + ", ".join("%.4g" % v for v in values) + "}"
    lines = ["#pragma once", "", "namespace sumogamma {", "",
             "/// One cell: scales along the motion and across [m], and the tail of spread_model.h.",
             "struct SpreadEntry {", "  double along, across, tail;", "};",
             "/// Powers of the clues of spread_model.h.",
             "struct SpreadPower {", "  double own, scene, mixture, speed;", "};", "",
             "// written by tools/train_spread.py on",
             *("// " + ", ".join(names[k:k + 3]) + "," for k in range(0, len(names), 3)),
             "// by kind (on foot, on wheels), band of speed and step", "",
             "/// Logarithm of the unsteadiness that is usual, by kind and band.",
             f"inline constexpr double kSpreadUsual[{KINDS}][{BANDS}] = {{"]
    lines += ["    " + braces(row) + "," for row in model.usual]
    lines += ["};", f"inline constexpr SpreadPower kSpreadPowers[{KINDS}][{STEPS}] = {{"]
    for kind in range(KINDS):
        lines += ["    {" + ", ".join(braces(p) for p in model.powers[kind]) + "},"]
    lines += ["};", f"inline constexpr SpreadEntry kSpreadTable[{KINDS}][{BANDS}][{STEPS}] = {{"]
    for kind in range(KINDS):
        lines += ["    {"]
        lines += ["        {" + ", ".join(braces(e) for e in row) + "}," for row in model.table[kind]]
        lines += ["    },"]
    return "\n".join(lines + ["};", "", "}  // namespace sumogamma"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="*")
    parser.add_argument("--program", required=True)
    parser.add_argument("--leave-one-out", action="store_true")
    parser.add_argument("--check", nargs="*", default=[])
    parser.add_argument("--check-options", default="", help="passed on to the program with --check, --fps=9.99, say")
    options = parser.parse_args()
    sets = read(options.program, options.recordings, [])
    noisy = read(options.program, options.recordings, ["--noise", NOISE])
    if options.leave_one_out:
        for name in sets:
            report(name, sets[name], Model(*({other: w for other, w in source.items() if other != name}
                                             for source in (sets, noisy))))
        return
    model = Model(sets, noisy)
    if options.check:
        for name, windows in read(options.program, options.check, options.check_options.split()).items():
            report(name, windows, model)
        return
    print(header(model, sorted(sets)))


if __name__ == "__main__":
    main()
