#!/usr/bin/env python3
"""Prints the tables of the paper's Fig. 8 (docs/planning.md) as Markdown from what tools/planner_drives.sh drove.

    tools/compare_planners.py OUT/ARM [PLANNER] [--all]      PLANNER: the one that others are held against (pomdp-gamma)

Seeds that all planners of a site have, and on which none was locked up. Intervals are 95 %: Wilson's of shares, the bootstrap's
(2,000 resamples of seeds within their sites) of means and of paired differences; p: McNemar's mid-p of collisions, the
bootstrap's of the others, Holm's adjustment over all comparisons of the table. With --all one table of every figure instead, a row
each, sites pooled: intervals of paired differences of shares are Newcombe's there, and p is adjusted for the three figures in bold.
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
# of --all: (title, value of a row, is it a share); the first three are those that are tested
EVERY_FIGURE = [("**collisions**, %", lambda r: int(r["contact"]), True),
                ("**time to goal**, at most 120 s [s]", lambda r: float(r["restricted_time_s"]), False),
                ("**speed change** [m/s per m]", lambda r: float(r["speed_change_per_m"]), False),
                ("collisions while moving, %", lambda r: int(r["contact_moving"]), True),
                ("collisions at fault, %", lambda r: int(r["contact_at_fault"]), True),
                ("goal reached, %", lambda r: int(r["outcome"] == "goal"), True),
                ("gap under 1 m, %", lambda r: int(r["near_miss"]), True),
                ("mean speed [m/s]", lambda r: float(r["mean_speed"]), False),
                ("mean acceleration, amount [m/s²]", lambda r: float(r["mean_acceleration"]), False),
                ("mean jerk, amount [m/s³]", lambda r: float(r["mean_jerk"]), False),
                ("periods with a drop of speed, %", lambda r: 100 * float(r["braking_share"]), False),
                ("hard braking of others for it [s]", lambda r: float(r["braking_of_others_s"]), False),
                ("delay of others by it [s]", lambda r: float(r["delay_of_others_s"]), False),
                ("time to collision never under 0.95 s, %", lambda r: int(float(r["time_to_collision"]) > 0), True),
                ("score without comfort", lambda r: float(r["score_without_comfort"]), False),
                ("score", lambda r: float(r["score"]), False)]


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
    return share, 0.0 if count == 0 else (middle - spread) / scale, 1.0 if count == n else (middle + spread) / scale


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


def newcombe(first, second):
    """Interval of the second share less the first's, paired: squares of Wilson's distances, less what the pairs have in common."""
    n = len(first)
    (p, low_p, high_p), (q, low_q, high_q) = wilson(sum(second), n), wilson(sum(first), n)
    both = sum(a and b for a, b in zip(first, second))
    neither = sum(not a and not b for a, b in zip(first, second))
    only_p, only_q = sum(second) - both, sum(first) - both
    product = sum(first) * sum(second) * (n - sum(first)) * (n - sum(second))
    phi = (both * neither - only_p * only_q) / math.sqrt(product) if product else 0.0
    below = math.sqrt(max(0.0, (p - low_p) ** 2 - 2 * phi * (p - low_p) * (high_q - q) + (high_q - q) ** 2))
    above = math.sqrt(max(0.0, (high_p - p) ** 2 - 2 * phi * (high_p - p) * (q - low_q) + (q - low_q) ** 2))
    return p - q, p - q - below, p - q + above


def share_cell(values):
    share, low, high = (100 * x for x in wilson(sum(values), len(values)))
    return f"{share:.1f} [{low:.1f}, {high:.1f}]"


def mean_cell(mean, low, high):
    return f"{mean:.3g} [{low:.3g}, {high:.3g}]"


def print_all(strata_of, planners, locked):
    """A row a figure: each planner's, and the others' differences from the first, sites pooled."""
    base = planners[0]
    n = sum(len(stratum) for stratum in strata_of(base))
    print(f"{n} seeds ({locked} locked up and left out)\n")
    print("| | " + " | ".join(planners) + " | " + " | ".join(f"{name} less {base}, p" for name in planners[1:]) + " |")
    print("|---" * (2 * len(planners)) + "|")
    lines, p = [], []
    for title, value, is_share in EVERY_FIGURE:
        of = {name: [[value(r) for r in stratum] for stratum in strata_of(name)] for name in planners}
        flat = {name: [v for stratum in of[name] for v in stratum] for name in planners}
        cells, differences = [], []
        for name in planners:
            cells.append(share_cell(flat[name]) if is_share else mean_cell(*bootstrap(of[name], 1)[:3]))
        for name in planners[1:]:
            if is_share:
                mean, low, high = (100 * x for x in newcombe(flat[base], flat[name]))
                text, chance = f"{mean:+.1f} [{low:+.1f}, {high:+.1f}]", mcnemar(flat[base], flat[name])
            else:
                pairs = [[b - a for a, b in zip(own, other)] for own, other in zip(of[base], of[name])]
                mean, low, high, chance = bootstrap(pairs, 2)
                text = f"{mean:+.3g} [{low:+.3g}, {high:+.3g}]"
                if all(d == 0 for stratum in pairs for d in stratum):
                    chance = 1.0
            differences.append(text)
            p.append(chance)
        lines.append((title, cells, differences))
    tested = 3 * (len(planners) - 1)
    p = holm(p[:tested]) + p[tested:]
    for title, cells, differences in lines:
        told = [f"{text}, {chance:.3f}" for text, chance in zip(differences, p)]
        p = p[len(told):]
        print(f"| {title} | " + " | ".join(cells + told) + " |")
    for title, count in (("collisions per 1,000 plans", lambda rows: sum(int(r["plans"]) for r in rows) / 1000),
                         ("collisions per km driven", lambda rows: sum(float(r["driven_m"]) for r in rows) / 1000)):
        cells = []
        for name in planners:
            rows = [r for stratum in strata_of(name) for r in stratum]
            units = count(rows)
            cells.append(f"{sum(int(r['contact']) for r in rows) / units:.2f}" if units > 0 else "–")
        print(f"| {title} | " + " | ".join(cells + [""] * (len(planners) - 1)) + " |")


def main():
    words = [word for word in sys.argv[1:] if word != "--all"]
    if len(words) not in (1, 2):
        sys.exit(__doc__)
    base, sites = words[1] if len(words) == 2 else "pomdp-gamma", read(words[0])
    if not sites:
        sys.exit(f"{words[0]}: no SITE/PLANNER/episodes.csv there; tools/planner_drives.sh writes them")
    seeds = {site: paired(drives) for site, drives in sites.items()}
    everybody = sorted(set.intersection(*(set(drives) for drives in sites.values())), key=lambda name: (name != base, name))

    def strata(names):
        return lambda planner: [[sites[site][planner][s] for s in seeds[site][0]] for site in names]

    if "--all" in sys.argv:
        print_all(strata(list(sites)), everybody, sum(locked for _, locked in seeds.values()))
        return
    groups = [([site], site) for site in sites] + ([(list(sites), "pooled")] if len(sites) > 1 else [])
    for names, title in groups:
        print_figures(title, strata(names), everybody, sum(seeds[site][1] for site in names))
    if base in everybody:
        for names, title in groups:
            print_differences(title, strata(names), [p for p in everybody if p != base], base)


if __name__ == "__main__":
    main()
