#!/usr/bin/env python3
"""Scores what `sumo-gamma predict --export FILE.csv` wrote, from the positions in it alone, and prints ADE and FDE.

usage: score_predictions.py FILE.csv [--protocol A] [--json]

A second opinion on the program's table: it shares no code with it. By set, memory and method: windows, ADE, FDE, share
of final errors over 2 m, and, with samples, the least ADE and FDE over them (each by itself). Under protocol A the
present counts as a first step without error.
"""
import argparse
import csv
import json
import math
from collections import defaultdict


def score(path, counts_present):
    """{(set, memory, method): figures}, from one pass over the rows."""
    distances = defaultdict(list)  # by forecast: distances in order of steps
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            key = (row["set"], row["memory"], row["method"], row["agent"], row["frame"], int(row["sample"]))
            distances[key].append(math.dist((float(row["x_m"]), float(row["y_m"])),
                                            (float(row["true_x_m"]), float(row["true_y_m"]))))
    windows = defaultdict(lambda: defaultdict(dict))
    for (name, memory, method, agent, frame, sample), d in distances.items():
        average = sum(d) / (len(d) + counts_present)
        windows[name, memory, method][agent, frame][sample] = (average, d[-1])
    result = {}
    for key, by_window in windows.items():
        n = len(by_window)
        figures = {"windows": n,
                   "ade": sum(w[0][0] for w in by_window.values()) / n,
                   "fde": sum(w[0][1] for w in by_window.values()) / n,
                   "miss_rate": sum(w[0][1] > 2.0 for w in by_window.values()) / n}
        if all(len(w) > 1 for w in by_window.values()):
            for k, figure in enumerate(("min_ade", "min_fde")):
                figures[figure] = sum(min(e[k] for s, e in w.items() if s > 0) for w in by_window.values()) / n
        result[key] = figures
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--protocol", choices="ABC", default="C")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    result = score(options.file, options.protocol == "A")
    if options.json:
        print(json.dumps([dict(zip(("set", "memory", "method"), k), **v) for k, v in result.items()]))
        return
    for key, figures in result.items():
        print(" ".join(key), " ".join(f"{k} {v:.4f}" if k != "windows" else f"{k} {v}" for k, v in figures.items()))


if __name__ == "__main__":
    main()
