#!/usr/bin/env python3
"""Prints the tables of the paper's Fig. 8 (docs/planning.md) as Markdown from what tools/planner_drives.sh drove.

    tools/compare_planners.py OUT/ARM [PLANNER]      PLANNER: the one that others are held against (pomdp-gamma)

Seeds that all planners of a site have, and on which none was locked up. Intervals are 95 %: Wilson's of shares, the bootstrap's
(2,000 resamples of seeds within their sites) of means and of paired differences; p: McNemar's mid-p of collisions, the
bootstrap's of the others, Holm's adjustment over all comparisons of the table.
"""
import csv
import math
import pathlib
import random
import sys

RESAMPLES = 2000
FIGURES = [("collisions", "contact"), ("time to goal [s]", "restricted_time_s"), ("speed change [m/s per m]", "speed_change_per_m"),
           ("mean speed [m/s]", "mean_speed"), ("score without comfort", "score_without_comfort")]
TESTED = FIGURES[:3]


def read(folder):
    """{site: {planner: {seed: row}}}"""
    sites = {}
    for file in sorted(pathlib.Path(folder).glob("*/*/episodes.csv")):
        with open(file, newline="", encoding="utf-8") as table:
            rows = {int(row["seed"]): row for row in csv.DictReader(table) if row["outcome"] != "client_failed"}
        sites.setdefault(file.parent.parent.name, {})[file.parent.name] = rows
    return sites


def paired(drives):
    """Seeds of a site that count, and how many were left out as locked up."""
    seeds = sorted(set.intersection(*(set(rows) for rows in drives.values())))
    locked = {s for s in seeds for rows in drives.values() if rows[s]["gridlock"] == "1"}
    return [s for s in seeds if s not in locked], len(locked)


def wilson(count, n, z=1.959964):
    if n == 0:
        return 0.0, 0.0, 1.0
    share, spread = count / n, z * math.sqrt(count / n * (1 - count / n) / n + z * z / (4 * n * n))
    middle, scale = share + z * z / (2 * n), 1 + z * z / n
    return share, (middle - spread) / scale, (middle + spread) / scale


def bootstrap(strata, key):
    """Mean over all values, its interval, and a two-sided p of its being 0; values are drawn again within their stratum."""
    values = [v for stratum in strata for v in stratum]
    mean, draw = sum(values) / len(values), random.Random(key)
    means = sorted(sum(sum(draw.choices(stratum, k=len(stratum))) for stratum in strata) / len(values) for _ in range(RESAMPLES))
    below, above = sum(m <= 0 for m in means), sum(m >= 0 for m in means)
    p = min(1.0, 2 * max(min(below, above), 1) / RESAMPLES)
    return mean, means[int(0.025 * RESAMPLES)], means[int(0.975 * RESAMPLES) - 1], p


def mcnemar(first, second):
    """Mid-p of the pairs of which one alone is 1."""
    alone = (sum(a > b for a, b in zip(first, second)), sum(b > a for a, b in zip(first, second)))
    n, least = sum(alone), min(alone)
    if n == 0:
        return 1.0
    tail = [math.comb(n, k) / 2**n for k in range(least + 1)]
    return min(1.0, 2 * (sum(tail) - tail[-1] / 2))


def holm(values):
    order, most, adjusted = sorted(range(len(values)), key=values.__getitem__), 0.0, [0.0] * len(values)
    for rank, i in enumerate(order):
        most = max(most, min(1.0, values[i] * (len(values) - rank)))
        adjusted[i] = most
    return adjusted


def cells(strata_of, planner):
    """One row: each figure over the strata [[row]]."""
    rows = [row for stratum in strata_of(planner) for row in stratum]
    contacts = sum(int(r["contact"]) for r in rows)
    share, low, high = wilson(contacts, len(rows))
    plans, way = sum(int(r["plans"]) for r in rows), sum(float(r["driven_m"]) for r in rows) / 1000
    text = [f"{100 * share:.1f} [{100 * low:.1f}, {100 * high:.1f}]", f"{1000 * contacts / max(plans, 1):.2f}",
            f"{contacts / max(way, 1e-9):.2f}", f"{sum(int(r['contact_at_fault']) for r in rows)}", f"{100 * sum(r['outcome'] == 'goal' for r in rows) / len(rows):.1f}"]
    for _, column in FIGURES[1:]:
        mean, low, high, _ = bootstrap([[float(r[column]) for r in stratum] for stratum in strata_of(planner)], 1)
        text.append(f"{mean:.2f} [{low:.2f}, {high:.2f}]")
    return text


def print_figures(name, strata_of, planners, locked):
    n = sum(len(stratum) for stratum in strata_of(planners[0]))
    print(f"\n**{name}**, {n} seeds ({locked} locked up and left out)\n")
    titles = ["planner", "collisions, %", "per 1,000 plans", "per km", "at fault", "goal, %"] + [title for title, _ in FIGURES[1:]]
    print("| " + " | ".join(titles) + " |\n" + "|---" * len(titles) + "|")
    for planner in planners:
        print(f"| {planner} | " + " | ".join(cells(strata_of, planner)) + " |")


def print_differences(name, strata_of, planners, base):
    """Each planner's figures less the base's."""
    found, p = [], []
    for planner in planners:
        for title, column in TESTED:
            pairs = [[(float(a[column]), float(b[column])) for a, b in zip(own, other)]
                     for own, other in zip(strata_of(base), strata_of(planner))]
            mean, low, high, value = bootstrap([[b - a for a, b in stratum] for stratum in pairs], 2)
            if column == "contact":
                flat = [pair for stratum in pairs for pair in stratum]
                value = mcnemar([a for a, _ in flat], [b for _, b in flat])
            of_base = sum(a for stratum in pairs for a, _ in stratum) / sum(len(stratum) for stratum in pairs)
            found.append((planner, title, mean, low, high, of_base))
            p.append(value)
    print(f"\n**{name}**: less {base}\n\n| planner | figure | difference | of {base}'s | p (Holm) | |\n|---|---|---|---|---|---|")
    for (planner, title, mean, low, high, of_base), value in zip(found, holm(p)):
        word = "not told apart" if value >= 0.05 else f"{base} is better" if mean > 0 else f"{base} is worse"
        scale, unit = (100, " points") if title == "collisions" else (1, "")
        share = f"{100 * mean / of_base:+.0f} %" if of_base > 0 and scale == 1 else "–"
        interval = f"[{scale * low:+.2f}, {scale * high:+.2f}]"
        print(f"| {planner} | {title} | {scale * mean:+.2f}{unit} {interval} | {share} | {value:.3f} | {word} |")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    base, sites = sys.argv[2] if len(sys.argv) == 3 else "pomdp-gamma", read(sys.argv[1])
    if not sites:
        sys.exit(f"{sys.argv[1]}: no SITE/PLANNER/episodes.csv there; tools/planner_drives.sh writes them")
    seeds = {site: paired(drives) for site, drives in sites.items()}
    everybody = sorted(set.intersection(*(set(drives) for drives in sites.values())), key=lambda name: (name != base, name))

    def strata(names):
        return lambda planner: [[sites[site][planner][s] for s in seeds[site][0]] for site in names]

    groups = [([site], site) for site in sites] + ([(list(sites), "pooled")] if len(sites) > 1 else [])
    for names, title in groups:
        print_figures(title, strata(names), everybody, sum(seeds[site][1] for site in names))
    if base in everybody:
        for names, title in groups:
            print_differences(title, strata(names), [p for p in everybody if p != base], base)


if __name__ == "__main__":
    main()
