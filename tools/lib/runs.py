"""Reads the run folders that tools/measure*.sh and tools/traffic_bench.sh leave."""
import json
import pathlib
import sys


def read_runs(out, parts):
    """Yields (parts of the name, results.json, folder) of every finished run in OUT, in order of names.

    parts: how many the folder's name has, separated by '-', the first of which may hold more of them."""
    for file in sorted(pathlib.Path(out).glob("*/results.json")):
        name = tuple(file.parent.name.rsplit("-", parts - 1))
        try:
            results = json.loads(file.read_text(encoding="utf-8"))
        except ValueError:
            results = {}
        if len(name) == parts and results.get("ended") == "done":
            yield name, results, file.parent
        else:
            print(f"{file}: not a finished run of this measurement, left out", file=sys.stderr)
