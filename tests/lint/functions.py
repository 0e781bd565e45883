"""Checks that functions stay within 60 lines and 6 parameters (the same measure as clang-tidy's readability-function-size).

usage: functions.py PROJECT_FOLDER [--list]
"""
import re
import sys
from collections import Counter

from project import finish, numbered_lines, project_files

MOST_LINES, MOST_PARAMETERS = 60, 6
# by module, how many functions are still over it: a number that only gets smaller
STILL = {"model": 6, "prediction": 1, "scene": 1, "simulation": 2, "traffic": 0}


def without_texts(line):
    """The line without what comments and texts hold."""
    return re.sub(r"//.*", "", re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])*\'', '""', line))


def parameters(head):
    """Number of parameters of the function whose head this is: commas between its outermost brackets."""
    head = re.sub(r"\boperator\(\)", "operator", head)
    begin = head.find("(")
    depth, count, seen = 0, 0, False
    for letter in head[begin:].replace("->", "  "):
        if letter in "([{<":
            depth += 1
        elif letter in ")]}>":
            depth -= 1
            if depth == 0:
                break
        elif depth == 1 and letter == ",":
            count += 1
        seen = seen or (depth >= 1 and letter not in "( ")
    return count + 1 if seen else 0


def functions(lines):
    """(line, name, lines of the body, parameters) of every function outside of classes: as clang-format leaves them, their heads
    begin in the first column and their bodies end with a brace there."""
    head, begin = [], 0
    for number, raw in lines:
        line = without_texts(raw)
        if begin:
            if line.rstrip() == "}":
                name = re.search(r"([\w:~]+|operator\S+)\s*\(", " ".join(head))
                yield head_line, name.group(1) if name else "?", number - begin, parameters(" ".join(head))
                head, begin = [], 0
            continue
        if not line.strip() or re.match(r"\s*#|\}|(namespace|struct|class|enum|union|using|extern|concept)\b|template\b[^;{]*$", line):
            head = []
            continue
        if not head:
            if line[0].isspace():
                continue
            head_line = number
        head.append(line.strip())
        if line.rstrip().endswith((";", "}")):
            head = []
        elif line.rstrip().endswith("{"):
            begin = number if "(" in " ".join(head) else 0
            head = head if begin else []


def main(root, shown):
    complaints, over, checked = [], Counter(), 0
    for path in project_files(root):
        if not path.startswith("src/") or not path.endswith((".h", ".cpp")):
            continue
        for number, name, length, count in functions(numbered_lines(root, path)):
            checked += 1
            for what, much, most in (("lines", length, MOST_LINES), ("parameters", count, MOST_PARAMETERS)):
                if much > most:
                    over[path.split("/")[1]] += 1
                    complaints.append(f"{path}:{number}: {name} has {much} {what}, {most} at the most")
    if shown:
        print("\n".join(complaints))
    held = [c for c in complaints if over[c.split("/")[1]] > STILL.get(c.split("/")[1], 0)]
    for module, most in STILL.items():
        if over[module] < most:
            print(f"STILL says {most} of {module}, now {over[module]} are over it: lower it")
    finish("functions", held, checked)


main(sys.argv[1], "--list" in sys.argv)
