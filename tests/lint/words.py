"""Checks that nothing unfinished and no path of somebody's own machine is left in the project's text.

usage: words.py PROJECT_FOLDER
"""
import re
import sys

from project import finish, numbered_lines, project_files

CODE = (".cpp", ".h", ".py", ".sh", ".cmake", ".js", ".css", ".html", "CMakeLists.txt", ".ci/run")
TEXT = CODE + (".md", ".toml", ".json", ".xml", ".sumocfg", ".clang-tidy", ".supp")

# written in pieces, or this file would complain about itself
UNFINISHED = re.compile("|".join(["TO" + "DO", "FIX" + "ME", r"\bX" + r"XX\b", r"\bHA" + "CK", "not " + "implemented",
                                  "place" + "holder", r"\bst" + r"ub(s|bed)?\b"]), re.IGNORECASE)
MACHINE = re.compile("|".join(["(?<![\\w.])/" + folder + "/" for folder in ("work", "tmp", "home", "root", "Users")]))


def main(root):
    complaints, checked = [], 0
    for path in project_files(root):
        if not path.endswith(TEXT):
            continue
        checked += 1
        for number, line in numbered_lines(root, path):
            for pattern, of in ((UNFINISHED, CODE), (MACHINE, TEXT)):
                match = pattern.search(line)
                if match and path.endswith(of):
                    what = "unfinished" if pattern is UNFINISHED else "a path of one machine"
                    complaints.append(f"{path}:{number}: {what}: {match.group(0)}")
    finish("words", complaints, checked)


main(sys.argv[1])
