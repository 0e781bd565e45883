"""Checks every C++ file against .clang-format (clang-format 14: other versions differ in details).

usage: format.py PROJECT_FOLDER [--fix]
"""
import os
import re
import shutil
import subprocess
import sys

from project import SKIPPED, finish, project_files


def main(root, fix):
    program = shutil.which("clang-format-14")
    if not program:
        print("skipped: clang-format-14 is not installed (tools/setup.sh --test installs it)")
        sys.exit(SKIPPED)
    paths = [path for path in project_files(root) if path.endswith((".cpp", ".h"))]
    complaints = []
    if fix:
        subprocess.run([program, "-i"] + [os.path.join(root, path) for path in paths], check=True)
    elif paths:
        found = subprocess.run([program, "--dry-run", "-Werror"] + paths, cwd=root, capture_output=True, text=True,
                               check=False)
        lines_of = {}
        for line in found.stderr.splitlines():
            match = re.match(r"(.+):(\d+):\d+: error: code should be clang-formatted", line)
            if match:
                lines_of.setdefault(match.group(1), []).append(int(match.group(2)))
        for path, lines in sorted(lines_of.items()):
            complaints.append(f"{path}:{lines[0]}: not as clang-format-14 -i leaves it ({len(set(lines))} lines)")
        if found.returncode != 0 and not complaints:
            complaints.append(found.stderr.strip())
    finish("format", complaints, len(paths))


main(sys.argv[1], "--fix" in sys.argv)
