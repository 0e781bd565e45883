#!/usr/bin/env python3
"""Prints GAMMA beside plain SUMO as a Markdown table, from run folders named MAP-AGENTS-SEED-CONTROL.

    tools/compare_runs.py OUT [--spread]      OUT: what tools/measure.sh wrote

One row a map and number of agents: sums over the seeds, or means where a mean is asked for. GAMMA's figure stands first, plain SUMO's
(--control none) second. Travel time is the ratio over those who arrived in both runs of a seed. With --spread mean ± standard
deviation a run instead, of fewer figures; a seed is locked where more than half of those under way at its end have been stuck.
"""
import csv
import os
import statistics
import sys
from collections import defaultdict

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from runs import read_runs  # noqa: E402


def travel_times(run):
    """Seconds under way by agent, of those who arrived."""
    with open(run / "trips.csv", newline="", encoding="utf-8") as file:
        return {row["agent"]: float(row["travel_time_s"]) for row in csv.DictReader(file)}


def travel_ratio(both):
    """Travel time of those who arrived in both of a pair of runs, over plain SUMO's."""
    gamma = plain = 0.0
    for seed in set(both["all"]) & set(both["none"]):
        ours, theirs = travel_times(both["all"][seed]), travel_times(both["none"][seed])
        common = set(ours) & set(theirs)
        gamma += sum(ours[agent] for agent in common)
        plain += sum(theirs[agent] for agent in common)
    return gamma / plain if plain > 0 else float("nan")


def is_locked(run):
    return run["flow"]["stuck_agents"] > 0.5 * (run["agents"]["inserted"] - run["agents"]["arrived"])


def print_spread(runs):
    """Mean ± standard deviation over the seeds, a row a map and number of agents."""
    figures = [("arrived", lambda r: r["agents"]["arrived"]), ("colliding pairs", lambda r: r["collisions"]["unique_pairs"]),
               ("deep pairs", lambda r: r["collisions"]["deep_pairs"]), ("stuck", lambda r: r["flow"]["stuck_agents"]),
               ("longest standstill s", lambda r: r["flow"]["longest_standstill_s"]), ("mean speed m/s", lambda r: r["flow"]["mean_speed"])]

    def cell(found, figure):
        values = [figure(run) for run in found]
        return f"{statistics.mean(values):.1f} ± {statistics.stdev(values) if len(values) > 1 else 0:.1f}"

    columns = ["map", "agents", "seeds"] + [name for name, _ in figures] + ["seeds with somebody stuck", "locked"]
    print("| " + " | ".join(columns) + " |\n|---" + "|---:" * (len(columns) - 1) + "|")
    for (name, agents), both in sorted(runs.items()):
        sides = [both["all"], both["none"]]
        if not all(sides):
            continue
        cells = [name, str(agents), " / ".join(str(len(side)) for side in sides)]
        cells += [" / ".join(cell(side, figure) for side in sides) for _, figure in figures]
        cells.append(" / ".join(str(sum(run["flow"]["stuck_agents"] > 0 for run in side)) for side in sides))
        cells.append(" / ".join(str(sum(map(is_locked, side))) for side in sides))
        print("| " + " | ".join(cells) + " |")


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--spread"]):
        sys.exit(__doc__)
    runs = defaultdict(lambda: {"all": [], "none": []})
    folders = defaultdict(lambda: {"all": {}, "none": {}})
    for (name, agents, seed, control), results, folder in read_runs(sys.argv[1], 4):
        runs[name, int(agents)][control].append(results)
        folders[name, int(agents)][control][seed] = folder
    versions = {run.get("metrics_version") for both in runs.values() for control in both.values() for run in control}
    if len(versions) > 1:
        print("the runs were measured by different definitions (metrics_version): their figures can't be compared", file=sys.stderr)
    if len(sys.argv) == 3:
        print_spread(runs)
        return
    columns = ["map", "agents", "seeds", "arrived", "travel time", "colliding pairs (deep)", "pairs per agent-hour", "stuck", "red lights", "wrong way s",
               "sidewalk s", "mean speed m/s", "accel p95", "jerk p95", "real-time factor"]
    print("| " + " | ".join(columns) + " |")
    print("|---" + "|---:" * (len(columns) - 1) + "|")
    for (name, agents), both in sorted(runs.items(), key=lambda item: (item[0][1], item[0][0])):
        if not both["all"] or not both["none"]:
            continue

        def pair(figure, digits=0, mean=False):
            texts = []
            for control in ("all", "none"):
                values = [figure(run) for run in both[control]]
                if None in values:
                    texts.append("–")
                    continue
                value = sum(values) / (len(values) if mean else 1)
                texts.append(f"{value:.{digits}f}")
            return " / ".join(texts)

        gamma, plain = (sum(r["agents"]["arrived"] for r in both[c]) for c in ("all", "none"))
        pairs = [f"{sum(r['collisions']['unique_pairs'] for r in both[c])} ({sum(r['collisions']['deep_pairs'] for r in both[c])})"
                 for c in ("all", "none")]
        print("| " + " | ".join([
            name, str(agents), f"{len(both['all'])} / {len(both['none'])}",
            f"{gamma} / {plain} ({100 * gamma / max(plain, 1):.0f} %)", f"{travel_ratio(folders[name, agents]):.2f}", " / ".join(pairs),
            pair(lambda r: r["collisions"]["unique_pairs_per_agent_hour"], 2, True),
            pair(lambda r: r["flow"]["stuck_agents"]), pair(lambda r: r["rules"]["red_light_crossings"]),
            pair(lambda r: r["rules"]["wrong_way_s"]), pair(lambda r: r["rules"]["sidewalk_by_vehicle_s"]),
            pair(lambda r: r["flow"]["mean_speed"], 2, True), pair(lambda r: r["smoothness"]["by_type"]["car"]["accel_p95"], 1, True),
            pair(lambda r: r["smoothness"]["by_type"]["car"]["jerk_p95"], 1, True),
            pair(lambda r: r["timing"]["real_time_factor"], 0, True)]) + " |")


if __name__ == "__main__":
    main()
