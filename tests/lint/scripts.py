"""Checks the shell scripts with bash -n and shellcheck, and that they can be run.

usage: scripts.py PROJECT_FOLDER
"""
import os
import shutil
import subprocess
import sys

from project import SKIPPED, finish, numbered_lines, project_files


def shell_scripts(root):
    for path in project_files(root):
        if path.endswith(".sh"):
            yield path
        elif "." not in os.path.basename(path) or path == ".ci/run":
            first = numbered_lines(root, path)[:1]
            if first and first[0][1].startswith("#!") and first[0][1].endswith(("bash", "sh")):
                yield path


def main(root):
    checker = shutil.which("shellcheck")
    if not checker:
        print("skipped: shellcheck is not installed (tools/setup.sh --test installs it)")
        sys.exit(SKIPPED)
    complaints, checked = [], 0
    for path in shell_scripts(root):
        checked += 1
        full = os.path.join(root, path)
        is_library = path.startswith("tools/lib/")
        if not is_library and not os.access(full, os.X_OK):
            complaints.append(f"{path}: a script that people run needs its executable bit")
        for command in (["bash", "-n", full], [checker, "-x", "-P", "SCRIPTDIR", "--format=gcc", full]):
            found = subprocess.run(command, capture_output=True, text=True, check=False)
            if found.returncode != 0:
                complaints += (found.stdout + found.stderr).strip().replace(full, path).splitlines()
    finish("scripts", complaints, checked)


main(sys.argv[1])
