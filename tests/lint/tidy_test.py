"""Checks which sources tools/lib/tidy.py looks at, and that it tells what it found, with a clang-tidy that finds the word BAD.

usage: tidy_test.py PROJECT_FOLDER
"""
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

FINDER = """#!/bin/sh
for source; do :; done
grep -n BAD "$PWD/$source" | sed "s|^|$PWD/$source:|; s|BAD.*|1: error: bad [some-check]|"
! grep -q BAD "$PWD/$source"
"""
FILES = {"src/a.cpp": '#include "a.h"\n', "src/a.h": "int a();\n", "src/only.h": "int only();\n", "src/user.cpp": '#include "only.h"\n',
         "src/other.cpp": "int other();\n", "README.md": "about\n"}
ALL = ["src/a.cpp", "src/other.cpp", "src/user.cpp"]


def write(root, files):
    for name, text in files.items():
        path = os.path.join(root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)


def git(root, *arguments):
    subprocess.run(["git", "-C", root, "-c", "user.name=a", "-c", "user.email=a@b", *arguments], check=True, capture_output=True)


def tidy(root, project, which, seconds=""):
    """(exit code, output, {source: status of its case})"""
    environment = {**os.environ, "PATH": os.path.join(root, "bin") + ":" + os.environ["PATH"], "JOBS": "1"}
    environment.pop("TIDY_SECONDS", None)
    if seconds:
        environment["TIDY_SECONDS"] = seconds
    found = subprocess.run([sys.executable, "-B", os.path.join(project, "tools/lib/tidy.py"), "build", which], cwd=root,
                           env=environment, capture_output=True, text=True, check=False)
    cases = ElementTree.parse(os.path.join(root, "build/tests.xml")).getroot()
    return found.returncode, found.stdout + found.stderr, {case.get("name"): case.get("status") for case in cases}


def main(project):
    complaints, checked = [], 0

    def expect(what, got, code, statuses, said=""):
        nonlocal checked
        checked += 1
        if got[0] != code or got[2] != statuses or said not in got[1]:
            complaints.append(f"{what}: expected {code}, {statuses}, '{said}'; got {got}")

    with tempfile.TemporaryDirectory() as root:
        root = os.path.realpath(root)
        commands = [{"directory": os.path.join(root, "build"), "file": os.path.join(root, name)} for name in ALL + ["build/made.cpp"]]
        write(root, {**FILES, "bin/clang-tidy-14": FINDER, "build/compile_commands.json": json.dumps(commands), ".gitignore": "build\nbin\n"})
        os.chmod(os.path.join(root, "bin/clang-tidy-14"), 0o755)
        git(root, "init", "-q", "-b", "main")
        git(root, "add", ".")
        git(root, "commit", "-qm", "first")
        fine = {name: "run" for name in ALL}
        expect("a clone of one commit", tidy(root, project, "changed"), 0, fine, "no other commit")
        expect("no time", tidy(root, project, "changed", "0"), 0, {"sources left out": "notrun"}, "no other commit")
        git(root, "checkout", "-qb", "branch")
        write(root, {"src/a.h": "int a(int);\n", "README.md": "more\n"})
        git(root, "commit", "-qam", "second")
        expect("a header", tidy(root, project, "changed"), 0, {"src/a.cpp": "run"})
        write(root, {"src/only.h": "int only(int);\n", "src/other.cpp": "\nBAD\n"})
        expect("not committed, and bad", tidy(root, project, "changed"), 1,
               {"src/a.cpp": "run", "src/other.cpp": "fail", "src/user.cpp": "run"}, "\nsrc/other.cpp:2:1: error: bad [some-check]\n")
        git(root, "commit", "-qam", "third")
        git(root, "checkout", "-q", "main")
        git(root, "merge", "-q", "--no-ff", "-m", "merge", "branch")
        expect("the main branch", tidy(root, project, "changed"), 1, {"src/a.cpp": "run", "src/other.cpp": "fail", "src/user.cpp": "run"})
        expect("all", tidy(root, project, "all"), 1, {**fine, "src/other.cpp": "fail"})
        for number in range(21):
            write(root, {"README.md": f"{number}\n"})
            git(root, "commit", "-qam", "words")
        expect("long ago", tidy(root, project, "changed"), 0, {}, "clang-tidy: 0 complaints")
    print("\n".join(complaints))
    print(f"tidy: {checked} cases, {len(complaints)} complaints")
    sys.exit(1 if complaints else 0)


main(os.path.abspath(sys.argv[1]))
