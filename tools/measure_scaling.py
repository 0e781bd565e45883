#!/usr/bin/env python3
"""How a run's cost grows with the agents there: a town by netgenerate, drives by randomTrips.py, one run a row.

    tools/measure_scaling.py PROGRAM OUT [--blocks 72] [--sizes 100,300,1000,3000,10000] [--runs traci:2,...] [--duration 80] [--step 0.05]

PROGRAM: sumo-gamma; OUT: for town, demands and scaling.csv. Rows that are there aren't measured again. All of a size
depart within the first minute, for ways of 1.5 km and more, so that few arrive. By both back ends, with one thread
and two, and by SUMO alone (`sumo -c`) with the same demand at the same step, less what it takes to load. Prints the
table; nothing else should run meanwhile.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import threading
import time

SUMO_HOME = os.environ.get("SUMO_HOME", "/usr/share/sumo")
COLUMNS = ["size", "driver", "threads", "alive", "steps", "wall_s", "cpu_s", "load_cpu_s", "own_mb", "sumo_mb", "observe", "context",
           "model", "track", "advance_sumo", "record"]
FILL = 60  # in which all depart [s]


def call(words, log):
    with open(log, "w", encoding="utf-8") as out:
        if subprocess.run(words, stdout=out, stderr=out, env={**os.environ, "SUMO_HOME": SUMO_HOME}, check=False).returncode:
            sys.exit(f"{words[0]} failed: see {log}")


def make_town(out, blocks):
    town, trips, routes, people = (out / name for name in ("town.net.xml", "cars.trips.xml", "cars.rou.xml", "people.rou.xml"))
    tool = f"{SUMO_HOME}/tools/randomTrips.py"
    if not town.exists():
        call(["netgenerate", "--grid", "--grid.number", str(blocks), "--grid.length", "120", "--default.lanenumber", "2",
              "--sidewalks.guess", "--crossings.guess", "--tls.guess", "--seed", "1", "-o", str(out / "part.xml")], out / "town.log")
        (out / "part.xml").rename(town)
    if not routes.exists():
        call([sys.executable, tool, "-n", str(town), "-o", str(trips), "-b", "0", "-e", str(FILL), "-p", "0.005",
              "--min-distance", "1500", "--seed", "1",
              "--trip-attributes", 'departLane="best" departSpeed="max" departPos="random"'], out / "trips.log")
        call(["duarouter", "-n", str(town), "-r", str(trips), "-o", str(out / "part.xml"), "--routing-algorithm", "CH",
              "--ignore-errors", "--no-warnings", "--no-step-log"], out / "routes.log")
        (out / "part.xml").rename(routes)
    if not people.exists():
        call([sys.executable, tool, "-n", str(town), "-o", str(out / "people.trips.xml"), "-r", str(out / "part.xml"),
              "-b", "0", "-e", str(FILL), "-p", "0.05", "--pedestrians", "--prefix", "p", "--max-distance", "1500", "--seed", "2"],
             out / "people.log")
        (out / "part.xml").rename(people)


def thin(source, target, tag, count):
    """Keeps so many of the elements, spread over the file."""
    every = re.findall(rf"<{tag}\b.*?</{tag}>", source.read_text(encoding="utf-8"), re.DOTALL)
    kept = [every[k * len(every) // count] for k in range(min(count, len(every)))]
    target.write_text("<routes>\n" + "\n".join(kept) + "\n</routes>\n", encoding="utf-8")


def make_scenario(out, size):
    folder = out / f"demand_{size}"
    folder.mkdir(exist_ok=True)
    on_foot = size // 10
    thin(out / "cars.rou.xml", folder / "cars.rou.xml", "vehicle", size - on_foot)
    thin(out / "people.rou.xml", folder / "people.rou.xml", "person", on_foot)
    config = folder / "scenario.sumocfg"
    config.write_text(f'<configuration><input><net-file value="../town.net.xml"/>'
                      f'<route-files value="cars.rou.xml,people.rou.xml"/></input>'
                      f'<time><begin value="0"/><end value="{2 * FILL}"/></time></configuration>\n', encoding="utf-8")
    return config


class Watch(threading.Thread):
    """The most memory that a process and the first of its children have held [MB], from /proc."""

    def __init__(self, pid):
        super().__init__(daemon=True)
        self.pid, self.own, self.child, self.ends = pid, 0.0, 0.0, False

    @staticmethod
    def peak(pid):
        try:
            text = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
        except OSError:
            return 0.0
        found = re.search(r"VmHWM:\s+(\d+) kB", text)
        return int(found.group(1)) / 1024 if found else 0.0

    def run(self):
        while not self.ends:
            self.own = max(self.own, self.peak(self.pid))
            try:
                children = pathlib.Path(f"/proc/{self.pid}/task/{self.pid}/children").read_text(encoding="utf-8").split()
            except OSError:
                children = []
            for child in children:
                self.child = max(self.child, self.peak(child))
            time.sleep(0.2)


def timed(words, log):
    """Wall and processor time [s], and the most memory of the process and of its child [MB]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    with open(log, "w", encoding="utf-8") as out, subprocess.Popen(words, stdout=out, stderr=out) as process:
        watch = Watch(process.pid)
        watch.start()
        code = process.wait()
        watch.ends = True
    if code:
        sys.exit(f"{' '.join(map(str, words))} failed: see {log}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.monotonic() - begin, cpu, watch.own, watch.child


def measure_sumo(options, config):
    words = ["sumo", "-c", str(config), "--step-length", str(options.step), "--no-step-log", "--no-warnings",
             "--xml-validation", "never"]
    load_wall, load_cpu, _, _ = timed([*words, "--end", "0"], options.out / "sumo.log")
    wall, cpu, memory, _ = timed([*words, "--end", str(options.duration)], options.out / "sumo.log")
    return {"wall_s": wall - load_wall, "cpu_s": cpu - load_cpu, "load_cpu_s": load_cpu, "own_mb": 0.0, "sumo_mb": memory}


def measure_gamma(options, config, backend, threads):
    run = options.out / "run"
    _, _, own, child = timed(
        [options.program, "run", str(config), "-o", str(run), "--force", "--duration", str(options.duration), "--step",
         str(options.step), "--seed", "1", "--threads", str(threads), "--backend", backend, "--trajectories", "none", "--quiet"],
        options.out / "run.log")
    results = json.loads((run / "results.json").read_text(encoding="utf-8"))
    timing, agents = results["timing"], results["agents"]
    return {"alive": agents["controlled_peak"], "steps": round(agents["controlled_mean"] * options.duration / options.step),
            "wall_s": timing["wall_s"], "cpu_s": timing["cpu_s"], "own_mb": own, "sumo_mb": child, **timing["share"]}


def read_rows(file):
    if not file.exists():
        return []
    with open(file, newline="", encoding="utf-8") as rows:
        return list(csv.DictReader(rows, restval=""))


def write_rows(file, rows):
    part = file.with_suffix(".part")
    with open(part, "w", newline="", encoding="utf-8") as out:
        writer = csv.DictWriter(out, COLUMNS, restval="", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    part.rename(file)


def print_table(rows, options):
    phases = COLUMNS[COLUMNS.index("observe"):]
    print("| departed | driven by | threads | alive, most | x real time | CPU an agent step [us] | wall | own memory, SUMO's [MB] | "
          + ", ".join(phases) + " [%] |\n|---:|---|---:|---:|---:|---:|---:|---:|---:|")
    steps = {row["size"]: float(row["steps"]) for row in rows if row["steps"]}
    load = {row["size"]: float(row["load_cpu_s"]) for row in rows if row["driver"] == "sumo"}
    for row in sorted(rows, key=lambda row: (int(row["size"]), row["driver"], row["threads"])):
        count = steps.get(row["size"], float("nan"))
        # the child's counts from its start on
        cpu = float(row["cpu_s"]) - (load.get(row["size"], 0.0) if row["driver"] == "traci" else 0.0)
        shares = ", ".join(f"{100 * float(row[key]):.0f}" for key in phases) if row["observe"] else ""
        print(f"| {row['size']} | {row['driver']} | {row['threads']} | {row['alive']} | {options.duration / float(row['wall_s']):.2f} | "
              f"{1e6 * cpu / count:.1f} | {1e6 * float(row['wall_s']) / count:.1f} | "
              f"{float(row['own_mb']):.0f}, {float(row['sumo_mb']):.0f} | {shares} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--blocks", type=int, default=72)
    parser.add_argument("--sizes", default="100,300,1000,3000,10000")
    parser.add_argument("--runs", default="sumo:1,traci:2,traci:1,libsumo:2,libsumo:1", help="by whom, in how many threads")
    parser.add_argument("--duration", type=float, default=FILL + 20)
    parser.add_argument("--step", type=float, default=0.05)
    options = parser.parse_args()
    options.program = str(pathlib.Path(options.program).resolve())
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    make_town(options.out, options.blocks)
    file = options.out / "scaling.csv"
    rows = read_rows(file)
    done = {(row["size"], row["driver"], row["threads"]) for row in rows}
    sizes = [int(size) for size in options.sizes.split(",")]
    for size in sizes:
        config = make_scenario(options.out, size)
        for run in options.runs.split(","):
            driver, threads = run.split(":")
            if (str(size), driver, threads) in done:
                continue
            found = measure_sumo(options, config) if driver == "sumo" else measure_gamma(options, config, driver, threads)
            rows.append({**dict.fromkeys(COLUMNS, ""), "size": str(size), "driver": driver, "threads": threads,
                         **{key: str(value) for key, value in found.items()}})
            write_rows(file, rows)
    print_table([row for row in rows if int(row["size"]) in sizes], options)


if __name__ == "__main__":
    main()
