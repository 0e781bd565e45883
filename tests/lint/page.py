"""Checks the scripts of the replay page with node --check: each of them alone, and all as the build joins them.

usage: page.py PROJECT_FOLDER
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

from project import SKIPPED, finish, project_files

FOLDER = "src/io/replay/"


def embedded_scripts(root):
    """The scripts in the order in which CMakeLists.txt joins them."""
    with open(os.path.join(root, "CMakeLists.txt"), encoding="utf-8") as file:
        listed = re.search(r"sumogamma_embed\(io kReplayPageJs\s+([^)]*)\)", file.read())
    return ["src/io/" + name for name in listed.group(1).split()] if listed else []


def complaints_of(node, name, body):
    """The page makes one function of its scripts: they may wait and return at its top."""
    with tempfile.NamedTemporaryFile("w", suffix=".js", encoding="utf-8") as file:
        # on one line, so that node's line numbers stay those of the file
        file.write("'use strict'; (async () => { " + body + "\n})();\n")
        file.flush()
        found = subprocess.run([node, "--check", file.name], capture_output=True, text=True, check=False)
        return found.stderr.strip().replace(file.name, name).splitlines() if found.returncode != 0 else []


def main(root):
    node = shutil.which("node")
    if not node:
        print("skipped: node is not installed, the replay page's scripts were NOT checked"
              " (tools/setup.sh --test installs it)")
        sys.exit(SKIPPED)
    there = [path for path in project_files(root) if path.startswith(FOLDER) and path.endswith(".js")]
    embedded = embedded_scripts(root)
    complaints = [f"{path}: not embedded by CMakeLists.txt" for path in there if path not in embedded]
    bodies = {}
    for path in there:
        with open(os.path.join(root, path), encoding="utf-8") as file:
            bodies[path] = file.read()
        complaints += complaints_of(node, path, bodies[path])
    if not complaints:
        complaints += complaints_of(node, FOLDER + "*.js", "".join(bodies.get(path, "") for path in embedded))
    finish("page", complaints, len(there))


main(sys.argv[1])
