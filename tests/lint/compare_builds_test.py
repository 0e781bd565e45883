"""Checks the arithmetic of tools/compare_builds.py on run folders whose sums and intervals are known.

usage: compare_builds_test.py PROJECT_FOLDER
"""
import json
import os
import subprocess
import sys
import tempfile

QUIET = {"arrived": 100, "deep_pairs": 0, "unique_pairs": 0, "stuck_agents": 0, "held_agents": 0, "wrong_way_s": 0.0,
         "sidewalk_by_vehicle_s": 0.0, "off_road_s": 0.0, "red_light_crossings": 0, "model_cpu_us_per_agent_step": 4.0}
GROUPS = {"agents": ["arrived"], "collisions": ["deep_pairs", "unique_pairs"], "flow": ["stuck_agents", "held_agents"],
          "rules": ["wrong_way_s", "sidewalk_by_vehicle_s", "off_road_s", "red_light_crossings"],
          "timing": ["model_cpu_us_per_agent_step"]}


def write_runs(out, runs):
    """runs: by (map, seed) what differs from a quiet run; "ended" and "metrics_version", too."""
    for (name, seed), different in runs.items():
        figures = {**QUIET, **different}
        results = {group: {key: figures[key] for key in keys} for group, keys in GROUPS.items()}
        results.update(ended=figures.get("ended", "done"), duration=600.0)
        if "metrics_version" in figures:
            results["metrics_version"] = figures["metrics_version"]
        os.makedirs(os.path.join(out, f"{name}-{seed}"))
        with open(os.path.join(out, f"{name}-{seed}", "results.json"), "w", encoding="utf-8") as file:
            json.dump(results, file)


def runs_of(figure, one, other=(0, 0, 0, 0)):
    """Of the maps "a" and "b-2", four seeds each, one value a seed."""
    runs = {("a", 101 + k): {figure: value} for k, value in enumerate(one)}
    return {**runs, **{("b-2", 101 + k): {figure: value} for k, value in enumerate(other)}}


def quiet(seeds=4):
    return {(name, 101 + k): {} for name in ("a", "b-2") for k in range(seeds)}


UNEVEN = {**quiet(), ("a", 101): {"ended": "interrupted"}}
# runs of before, of after, exit code, what must be said. Student's quantiles: 12.706, 4.303 and 3.182 of 1, 2 and 3 degrees
CASES = [
    (quiet(), quiet(), 0, ["2 maps, 4 seeds (101, 102, 103, 104)", "| arrived | 800 | 800 | +0 ± 0 | 1.000 ± 0.000 of before: within 2% |",
                           "| pairs | 0 | 0 | +0 ± 0 | not significantly more |", "| deep collisions | 0 | 0 | +0 ± 0 | 0 in all |",
                           "as good as before"]),
    # differences 1, 2, 3, 4: their deviation is 1.291, so 10 +- 3.182 * 1.291 * 2
    (quiet(), runs_of("unique_pairs", (1, 2, 3, 4)), 1, ["| pairs | 0 | 10 | +10 ± 8.2 | **significantly more** |", "worse than before"]),
    (runs_of("unique_pairs", (1, 2, 3, 4)), quiet(), 0, ["| pairs | 10 | 0 | -10 ± 8.2 | significantly less |"]),
    # pairing: what both have is no difference, and maps of a seed are summed before anything else
    (runs_of("stuck_agents", (9, 0, 5, 1), (0, 9, 4, 8)), runs_of("stuck_agents", (0, 9, 4, 8), (9, 0, 5, 1)), 0,
     ["| stuck | 36 | 36 | +0 ± 0 |"]),
    # one seed alone is never significant: 12 +- 3.182 * 6 * 2
    (quiet(), runs_of("wrong_way_s", (0, 0, 12.0, 0)), 0, ["| wrong way [s] | 0 | 12 | +12 ± 38.2 | not significantly more |"]),
    (quiet(), runs_of("deep_pairs", (0, 0, 1, 0)), 1, ["| deep collisions | 0 | 1 | +1 ± 3.2 | **not 0** |"]),
    # arrivals of a and b-2: 197 of 200 with every seed is a ratio without deviation, 195 is more than 2 % fewer
    (quiet(), runs_of("arrived", (97,) * 4, (100,) * 4), 0, ["| arrived | 800 | 788 | -12 ± 0 | 0.985 ± 0.000 of before: within 2% |"]),
    (quiet(), runs_of("arrived", (95,) * 4, (100,) * 4), 1, ["0.975 ± 0.000 of before: more than 2% fewer**"]),
    # residuals of 198, 199, 201, 202 about 200: 3.182 * sqrt(10 * 4 / 3) / 800
    (quiet(), runs_of("arrived", (98, 99, 101, 102), (100,) * 4), 0, ["1.000 ± 0.015 of before: within 2% |"]),
    (quiet(), runs_of("arrived", (94, 97, 103, 106), (100,) * 4), 0, ["1.000 ± 0.044 of before: within 2%, the interval isn't |"]),
    (quiet(), runs_of("arrived", (110,) * 4, (100,) * 4), 0, ["1.050 ± 0.000 of before: more |"]),
    # a seed counts where all maps have it, in both
    (UNEVEN, runs_of("unique_pairs", (50, 1, 2, 3)), 0, ["2 maps, 3 seeds (102, 103, 104)", "| pairs | 0 | 6 | +6 ± 7.5 |",
                                                        "not a finished run", "1 runs have no counterpart"]),
    (quiet(), {**quiet(), ("c", 101): {}}, 0, ["2 maps, 4 seeds", "c: run with one of the two programs alone"]),
    (quiet(1), runs_of("unique_pairs", (1,), (1,)), 0, ["| pairs | 0 | 2 | +2 ± ? | not significantly more |"]),
    (quiet(), {("a", 105): {}}, 1, ["no seed with which all maps were run"]),
    (quiet(), {key: {"metrics_version": 2} for key in quiet()}, 1, ["runs differ in metrics_version: 1, 2"]),
    # sums alone
    (None, runs_of("held_agents", (1, 2), (3, 4)), 0, ["2 maps, 2 seeds (101, 102)", "| held | 10 ± 25.4 |"]),
]


def main(root):
    complaints = []
    for before, after, code, said in CASES:
        with tempfile.TemporaryDirectory() as folder:
            outs = [os.path.join(folder, name) for name in ("after", "before")[:1 if before is None else 2]]
            for out, runs in zip(outs, (after, before)):
                write_runs(out, runs)
            command = [sys.executable, "-B", os.path.join(root, "tools/compare_builds.py"), *outs]
            found = subprocess.run(command, capture_output=True, text=True, check=False)
        missing = [text for text in said if text not in found.stdout + found.stderr]
        if missing or found.returncode != code:
            complaints.append(f"expected exit code {code} and {missing} of {before} and {after}; got {found.returncode}:\n"
                              f"{found.stdout}{found.stderr}")
    print("\n".join(complaints))
    print(f"compare_builds: {len(CASES)} cases, {len(complaints)} complaints")
    sys.exit(1 if complaints else 0)


main(sys.argv[1])
