"""Checks the rules of the road (src/traffic): every column of what they remember has one writer, every tunable stands in one place, and
clocks are compared in one place, the grid of agents has one reader.

usage: traffic.py PROJECT_FOLDER

A column is a member of `struct TrafficState` in src/traffic/traffic_state.h that is a std::vector. Who writes it: the pair of .h and
.cpp that assigns to it or to an entry, changes its size, or binds it to a reference or pointer that isn't const. traffic_state.h and
.cpp themselves add and remove rows and don't count. An entry that is passed on by reference isn't seen: rules that only read take a
`const TrafficState&`, which the compiler holds.
A tunable is a named constant of src/traffic with a number of its own, but for those in src/traffic/parameters.h and .cpp, and for
epsilons, which are written as powers of ten (1e-4).
A clock tells for how long, or since when, something has lasted. Only src/traffic/patience.cpp compares one with seconds: a number other
than 0, a constant, or a parameter. Two clocks may be compared with each other, and one with 0. A clock is seen as a member (held.standing)
or under the name that a function gives it (const double standing = held.standing).
Who is around whom is asked of the grid once a row and tick, by src/traffic/perception; what a rule asks for beyond its row's reach is in FAR.
"""
import os
import re
import sys
from collections import defaultdict

from project import finish, numbered_lines, project_files

HEADER = "src/traffic/traffic_state.h"
PARAMETERS = r"src/traffic/parameters\.(h|cpp)"
PATIENCE = "src/traffic/patience.cpp"
CLOCK = r"(?:\.|->)(?:waiting_time|standing|blocked|keeps_clear|halted_at|stood_at)\b"
PERCEPTION = "src/traffic/perception"
FAR = {"src/traffic/longitudinal/leader.cpp": 1}  # calls of visit_storey by file
GRID = re.compile(r"\bvisit_(?:within|runs)\s*\(")
STOREY = re.compile(r"\bvisit_storey\s*\(")
CONSTANT = re.compile(r"\bconst(?:expr)?\s+(?:double|float|int|auto)\s+(?=k[A-Z]\w*\s*[={])([^;]*);")
PLACE = r"(?:\s*\[(?:[^\[\]]|\[[^\[\]]*\])*\])?"  # of an entry, whose index may be another's entry
CHANGERS = "assign|resize|push_back|emplace_back|clear|swap|insert|erase|reserve|fill"


def code(root, path):
    """The file without comments and what texts hold; lines stay where they are."""
    return "\n".join(re.sub(r"//.*", "", re.sub(r'"(\\.|[^"\\])*"', '""', line)) for _, line in numbered_lines(root, path))


def line_of(text, place):
    return text.count("\n", 0, place) + 1


def columns(text):
    """{column: line} of struct TrafficState."""
    struct = re.search(r"\bstruct TrafficState\b[^{;]*\{(.*?)\n\};", text, re.DOTALL)
    if not struct:
        return {}
    members = re.finditer(r"std::vector<[^;]*>\s*(\w+)\s*;", struct.group(1))
    return {member.group(1): line_of(text, struct.start(1) + member.start(1)) for member in members}


def writes(text, column):
    """Does a file's text change the column of some state?"""
    here = rf"(?<!\bcontext)(?:\.|->){column}\b"  # RoadContext says some of it on
    part = r"(?:\.\w+(?:\([^()]*\))?)*"  # a member of an entry, or .back()
    patterns = [rf"{here}{PLACE}{part}\s*(?:[-+*/|&^%]|<<|>>)?=(?!=)",
                rf"(?:\+\+|--)\s*[\w.\->()]*{here}", rf"{here}{PLACE}\s*(?:\+\+|--)",
                rf"{here}\s*\.\s*(?:{CHANGERS})\s*\(",
                rf"(?:^|[;{{}}(,])\s*(?!const\b)[\w:]+(?:<[^;=]*>)?\s*&+\s*(?:\w+|\[[^\]]*\])\s*[=:][^;]*{here}",  # a reference
                rf"(?<![&\w)\]])\s*&\s*[\w.\->()]*{here}"]  # an address
    return any(re.search(pattern, text, re.MULTILINE) for pattern in patterns)


def check_columns(root, paths):
    """Complaints, and how many columns were checked."""
    if HEADER not in paths:
        print(f"there is no {HEADER}, so no column was checked")
        return [], 0
    writers = defaultdict(set)
    found = columns(code(root, HEADER))
    for path in paths:
        unit = path.rsplit(".", 1)[0]
        if unit == HEADER.rsplit(".", 1)[0]:
            continue
        text = code(root, path)
        for column in found:
            if writes(text, column):
                writers[column].add(unit)
    complaints = [f"{HEADER}:{found[column]}: {column} has {len(units)} writers, one at the most: {', '.join(sorted(units))}"
                  for column, units in sorted(writers.items()) if len(units) > 1]
    if not found:
        complaints.append(f"{HEADER}: no struct TrafficState with std::vector columns")
    return complaints, len(found)


def queries(root, paths):
    """Complaints about who asks the grid besides perception."""
    asked = 0
    for path in paths:
        text = code(root, path)
        own = path.rsplit(".", 1)[0] == PERCEPTION
        for call in GRID.finditer(text):
            asked += own
            if not own or asked > 1:
                yield f"{path}:{line_of(text, call.start())}: a neighbour query of its own, which {PERCEPTION} makes once a row and tick"
        for k, call in enumerate(STOREY.finditer(text), 1):
            if not own and k > FAR.get(path, 0):
                yield f"{path}:{line_of(text, call.start())}: visit_storey asks the grid again, visit_near reads what is known"


def tunables(root, paths):
    """Where a named constant with a number stands outside parameters: its file, line and name."""
    for path in paths:
        if re.fullmatch(PARAMETERS, path):
            continue
        text = code(root, path)
        for statement in CONSTANT.finditer(text):
            for one in re.finditer(r"(k[A-Z]\w*)\s*[={]([^,]*)", statement.group(1)):
                if re.search(r"(?<![\w.])\d", re.sub(r"\b\d+e-\d+", "", one.group(2))):
                    yield path, line_of(text, statement.start(1) + one.start()), one.group(1)


def is_seconds(text):
    """Does one side of a comparison have seconds of its own?"""
    return bool(re.search(r"\bparameters\b|\bk[A-Z]\w*|(?<![\w.])\d*[1-9]|(?<![\w.])0\.0*[1-9]", text)) and not re.search(CLOCK, text)


def compared_clocks(root, paths):
    """Where a clock is compared with seconds outside patience.cpp: file and line."""
    for path in paths:
        if path == PATIENCE:
            continue
        for function in re.finditer(r".+?(?:^\}|\Z)", code(root, path), re.DOTALL | re.MULTILINE):
            text, begin = function.group(), line_of(function.string, function.start()) - 1
            names = re.findall(rf"\b(\w+)\s*=(?!=)[^,;=<>]*{CLOCK}{PLACE}\s*[,;]", text)
            clock = "|".join([CLOCK + PLACE] + [rf"(?<![\w.>]){name}\b" for name in names])
            side = r"(?:[^;&|?{}<>=]|->)*"
            places = {found.start() for found in re.finditer(rf"(?:{clock})\s*(?:[<>]=?|[!=]=)({side})", text) if is_seconds(found.group(1))}
            places |= {found.start(2) for found in re.finditer(rf"({side})(?:(?<!-)>=?|<=?|[!=]=)\s*[\w.\->\[\]()]*?({clock})", text)
                       if is_seconds(found.group(1).rsplit("(", 1)[-1])}
            for place in sorted(places):
                yield path, begin + line_of(text, place)


def check_clocks(root, paths):
    return [f"{path}:{number}: a clock is compared with seconds, which is for {PATIENCE}" for path, number in compared_clocks(root, paths)]


def main(root):
    paths = [p for p in project_files(root) if p.startswith("src/traffic/") and p.endswith((".h", ".cpp"))]
    complaints, checked = check_columns(root, paths)
    complaints += [f"{path}:{number}: {name} belongs into src/traffic/parameters.h" for path, number, name in tunables(root, paths)]
    complaints += check_clocks(root, paths)
    complaints += queries(root, paths)
    finish("traffic", complaints, checked + len(paths))


main(sys.argv[1])
