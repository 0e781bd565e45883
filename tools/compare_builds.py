#!/usr/bin/env python3
"""Says how the traffic of one program differs from that of another, from run folders named MAP-SEED.

    tools/compare_builds.py OUT             OUT: what tools/traffic_bench.sh wrote: its sums
    tools/compare_builds.py OUT BEFORE      BEFORE: likewise, by the program before. Exit code 1 where OUT drives worse

Sums over the maps, of the seeds with which all maps were run; with BEFORE of the pairs (map, seed) that both have. The seeds are
independent of one another, so a sum of n of them is n times their mean, and its 95 % interval is Student's over the seeds: of the
differences of pairs for counts and seconds, of the residuals (after - ratio * before) for ratios. Counts of rare events have wide
intervals: what happens in one seed alone is never significant.
"""
import filecmp
import math
import os
import pathlib
import statistics
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from runs import read_runs  # noqa: E402

WITHIN = 0.02  # of the arrivals of before
ARRIVED, DEEP, CPU = "arrived", "deep collisions", "model CPU [µs]"
FIGURES = {
    ARRIVED: lambda r: r["agents"]["arrived"],
    DEEP: lambda r: r["collisions"]["deep_pairs"],
    "pairs": lambda r: r["collisions"]["unique_pairs"],
    "stuck": lambda r: r["flow"]["stuck_agents"],
    "held": lambda r: r["flow"]["held_agents"],
    "wrong way [s]": lambda r: r["rules"]["wrong_way_s"],
    "sidewalk [s]": lambda r: r["rules"]["sidewalk_by_vehicle_s"],
    "off the road [s]": lambda r: r["rules"]["off_road_s"],
    "red lights": lambda r: r["rules"]["red_light_crossings"],
    CPU: lambda r: r["timing"]["model_cpu_us_per_agent_step"],  # depends on what else the machine does
}


def student_quantile(degrees, probability=0.975):
    """Of Student's distribution: bisection over its density, integrated by Simpson's rule."""
    scale = math.exp(math.lgamma((degrees + 1) / 2) - math.lgamma(degrees / 2)) / math.sqrt(degrees * math.pi)

    def density(x):
        return scale * (1 + x * x / degrees) ** (-(degrees + 1) / 2)

    def below(x, steps=400):
        width = x / steps
        inner = sum((4 if k % 2 else 2) * density(k * width) for k in range(1, steps))
        return 0.5 + width / 3 * (density(0) + inner + density(x))

    low, high = 0.0, 100.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if below(middle) < probability else (low, middle)
    return high


def sum_interval(values):
    """(sum, half of its 95 % interval) of one value a seed; infinite with fewer than two seeds."""
    if len(values) < 2:
        return sum(values), math.inf
    return sum(values), student_quantile(len(values) - 1) * statistics.stdev(values) * math.sqrt(len(values))


def ratio_interval(after, before):
    """(ratio of the sums, half of its 95 % interval) of one value a seed each."""
    if sum(before) <= 0:
        return math.nan, math.inf
    ratio = sum(after) / sum(before)
    if len(after) < 2:
        return ratio, math.inf
    residuals = [a - ratio * b for a, b in zip(after, before)]
    error = math.sqrt(sum(r * r for r in residuals) * len(after) / (len(after) - 1)) / sum(before)
    return ratio, student_quantile(len(after) - 1) * error


def verdict(name, after, before):
    """(is it as good as before, in words) of one value a seed each."""
    if name == DEEP:
        return sum(after) == 0, "0 in all" if sum(after) == 0 else "not 0"
    if name == CPU:
        ratio, half = ratio_interval(after, before)
        return True, f"{ratio:.3f} ± {half:.3f} of before"
    if name == ARRIVED:
        ratio, half = ratio_interval(after, before)
        figure = f"{ratio:.3f} ± {half:.3f} of before: "
        if not ratio >= 1 - WITHIN:
            return False, f"{figure}more than {WITHIN:.0%} fewer"
        if ratio - half < 1 - WITHIN:
            return True, f"{figure}within {WITHIN:.0%}, the interval isn't"
        return True, figure + (f"within {WITHIN:.0%}" if ratio <= 1 + WITHIN else "more")
    difference, half = sum_interval([a - b for a, b in zip(after, before)])
    if difference - half > 0:
        return False, "significantly more"
    return True, "significantly less" if difference + half < 0 else "not significantly more"


def by_seed(runs, maps):
    """Lists of one sum over maps a seed, by figure, of the seeds that all maps have; and these seeds."""
    seeds = sorted(set.intersection(*({s for m, s in runs if m == name} for name in maps)), key=lambda s: (len(s), s))
    return {name: [sum(figure(runs[m, s]) for m in maps) for s in seeds] for name, figure in FIGURES.items()}, seeds


def number(value, sign=""):
    return f"{value:{sign},.0f}" if abs(value) >= 100 or value == int(value) else f"{value:{sign}.1f}"


def interval(values, sign=""):
    total, half = sum_interval(values)
    return f"{number(total, sign)} ± {number(half) if math.isfinite(half) else '?'}"


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def print_sums(runs, maps):
    sums, seeds = by_seed(runs, maps)
    print(f"{len(maps)} maps, {len(seeds)} seeds ({', '.join(seeds)})\n")
    row("figure", "sum")
    row("---", "---:")
    for name in FIGURES:
        row(name, interval(sums[name]))


def print_comparison(after_runs, before_runs, maps):
    after, seeds = by_seed(after_runs, maps)
    before, _ = by_seed({key: before_runs[key] for key in after_runs}, maps)
    print(f"{len(maps)} maps, {len(seeds)} seeds ({', '.join(seeds)})\n")
    row("figure", "before", "after", "difference", "verdict")
    row("---", "---:", "---:", "---:", "---")
    good = True
    for name in FIGURES:
        difference = [a - b for a, b in zip(after[name], before[name])]
        fine, words = verdict(name, after[name], before[name])
        good = good and fine
        row(name, number(sum(before[name])), number(sum(after[name])), interval(difference, "+"), words if fine else f"**{words}**")
    shown = [name for name in FIGURES if name != CPU]
    print("\nBy map, before / after:\n")
    row("map", *shown)
    row("---", *["---:"] * len(shown))
    for name in maps:
        row(name, *(f"{number(sum(FIGURES[f](before_runs[name, s]) for s in seeds))} / "
                    f"{number(sum(FIGURES[f](after_runs[name, s]) for s in seeds))}" for f in shown))
    print("\nas good as before" if good else "\n**worse than before**")
    return good


def complain(text):
    print(text, file=sys.stderr)


def refuse_other_measures(after_runs, before_runs):
    """Figures of two definitions aren't compared."""
    versions = {str(r.get("metrics_version", 1)) for runs in (after_runs, before_runs) for r in runs.values()}
    durations = {r["duration"] for runs in (after_runs, before_runs) for r in runs.values()}
    for what, found in (("metrics_version", versions), ("duration", durations)):
        if len(found) > 1:
            sys.exit(f"runs differ in {what}: {', '.join(str(f) for f in sorted(found))}; measure again with one")


def warn_of_other_networks(out, before, maps):
    for name in maps:
        files = [pathlib.Path(folder) / "maps" / name / "net.net.xml" for folder in (out, before)]
        if all(file.exists() for file in files) and not filecmp.cmp(*files, shallow=False):
            complain(f"{name}: the two programs drove different networks")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    after = {name: results for name, results, _ in read_runs(sys.argv[1], 2)}
    before = {name: results for name, results, _ in read_runs(sys.argv[2], 2)} if len(sys.argv) == 3 else after
    refuse_other_measures(after, before)
    common = set(after) & set(before)
    maps = sorted({name for name, _ in common})
    for name in sorted({m for m, _ in after} ^ {m for m, _ in before}):
        complain(f"{name}: run with one of the two programs alone, left out")
    if not maps or not by_seed({key: after[key] for key in common}, maps)[1]:
        sys.exit("no seed with which all maps were run")
    alone = len(set(after) ^ set(before))
    if alone:
        complain(f"{alone} runs have no counterpart, left out")
    if len(sys.argv) == 2:
        print_sums(after, maps)
        return
    warn_of_other_networks(sys.argv[1], sys.argv[2], maps)
    if not print_comparison({key: after[key] for key in common}, before, maps):
        sys.exit(1)


if __name__ == "__main__":
    main()
