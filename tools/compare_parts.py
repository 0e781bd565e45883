#!/usr/bin/env python3
"""Prints what happened where GAMMA drove a part of the traffic as a Markdown table, from run folders named MAP-SEED-PART.

    tools/compare_parts.py OUT        OUT: what tools/measure_parts.sh wrote

One row a map, one column a part; sums over the seeds that all parts have. A pair is *between* the kinds where GAMMA drives by
type and one of the two is of a type that it drives. The bound is the mean of none's and all's pairs and a tenth more.
"""
import csv
import os
import sys
from collections import defaultdict

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from runs import read_runs  # noqa: E402

PARTS = ["none", "all", "cars", "light", "wheels", "half", "region", "circle"]
DRIVEN = {"cars": {"car"}, "light": {"bicycle", "pedestrian", "motorcycle"},
          "wheels": {"car", "van", "bus", "truck", "motorcycle", "bicycle"}}


def between(run, part):
    """Pairs between the kinds, and how many of them were deep; nothing where types don't tell."""
    if part not in DRIVEN:
        return None
    with open(run / "collisions.csv", newline="", encoding="utf-8") as file:
        pairs = [row for row in csv.DictReader(file) if (row["type"] in DRIVEN[part]) != (row["other_type"] in DRIVEN[part])]
    return len(pairs), sum(float(row["depth_m"]) > 0.1 for row in pairs)


def cell(runs, part):
    pairs = sum(r["collisions"]["unique_pairs"] for r, _ in runs)
    text = f"{pairs} pairs"
    kinds = [between(folder, part) for _, folder in runs]
    if kinds and kinds[0] is not None:
        text += f" ({sum(k[0] for k in kinds)} between, {sum(k[1] for k in kinds)} deep)"
    text += f", {sum(r['agents']['arrived'] for r, _ in runs)} arrived, {sum(r['flow']['stuck_agents'] for r, _ in runs)} stuck"
    back = sum(r["agents"]["handed_back"] for r, _ in runs)
    return text + (f", {back} given back" if back else "")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = defaultdict(dict)
    for (name, seed, part), results, folder in read_runs(sys.argv[1], 3):
        found[name][seed, part] = (results, folder)
    print("| map (seeds) | " + " | ".join(PARTS) + " | bound |")
    print("|---" * (len(PARTS) + 2) + "|")
    for name, runs in sorted(found.items()):
        parts = [p for p in PARTS if any(part == p for _, part in runs)]
        seeds = [s for s in sorted({s for s, _ in runs}) if all((s, p) in runs for p in parts)]
        cells = [cell([runs[s, p] for s in seeds], p) if p in parts else "–" for p in PARTS]
        sums = [sum(runs[s, p][0]["collisions"]["unique_pairs"] for s in seeds) for p in ("none", "all") if p in parts]
        bound = f"{1.1 * sum(sums) / 2:.1f}" if len(sums) == 2 else "–"
        print(f"| {name} ({len(seeds)}) | " + " | ".join(cells) + f" | {bound} |")


if __name__ == "__main__":
    main()
