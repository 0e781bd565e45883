"""Checks every #include of src/ against the modules' DEPENDS in CMakeLists.txt, and that the edges stay thin.

A source includes its own header first, so that compiling it shows that the header stands alone. Two headers declare no type
of one name in one namespace: whoever includes both does not compile, and whoever links both has undefined behaviour.

usage: layers.py PROJECT_FOLDER
"""
import os
import re
import sys

from project import finish, numbered_lines, project_files

# who alone may include a library whose headers begin so
EDGES = {
    "osmium/": r"src/osm/.*",
    "protozero/": r"src/osm/.*",
    "proj.h": r"src/osm/.*",
    "libsumo/": r"src/sumo/libsumo_backend\.cpp",
    "libtraci/": r"nowhere: its client dies with SUMO",
    "CLI/": r"src/app/.*",
    "toml++/": r"src/io/.*",
    "sqlite3.h": r"src/io/study_database\.cpp",
    "httplib.h": r"src/io/live_page\.cpp",
}
# this one prints which version of each library it was built with, and calls nothing
VERSION_FILE = "src/app/version_command.cpp"
VERSION_HEADERS = {"osmium/version.hpp", "proj.h", "toml++/toml.h"}
# results must not depend on the standard library's generators, which differ between libraries
NOWHERE = {"random": "draws come from base/random.h"}
# nothing from a scenario can reach a shell that nobody starts
SHELL = re.compile(r"(?<![\w.>])(popen|system)\s*\(|/bin/(ba)?sh\b")
INCLUDE = re.compile(r'\s*#\s*include\s*(["<])([^">]+)[">]')
NAMESPACE = re.compile(r"namespace ([\w:]+) \{")
TYPE = re.compile(r"(?:struct|class|enum class|enum) (\w+)[^;]*\{|using (\w+) =")
# these have never heard of a file, a terminal, a thread or a clock
PURE_MODULES = {"geometry", "scene", "model", "inference"}
IMPURE = {"fstream", "filesystem", "iostream", "cstdio", "stdio.h", "chrono", "thread", "mutex", "atomic"}


def declared_modules(root):
    """{module: modules it may include}, closed over dependencies, from CMakeLists.txt; and complaints."""
    direct, complaints = {}, []
    for number, line in numbered_lines(root, "CMakeLists.txt"):
        match = re.match(r"\s*sumogamma_(module|program)\(([^)]*)\)", line)
        if not match:
            continue
        names = match.group(2).split()
        own, wanted = names[:1], names[1:]
        if match.group(1) == "program":
            own, wanted = names[1:2], names[2:]
        if not own or (wanted and wanted[0] != "DEPENDS"):
            complaints.append(f"CMakeLists.txt:{number}: not understood: {line.strip()}")
            continue
        for other in wanted[1:]:
            if other not in direct:
                complaints.append(f"CMakeLists.txt:{number}: {own[0]} depends on {other}, which is not declared above it")
        direct[own[0]] = set(wanted[1:])
    closed = {}
    for module, others in direct.items():  # declared in order, so what it needs is closed already
        closed[module] = {module} | others
        for other in others:
            closed[module] |= closed.get(other, set())
    return closed, complaints


def check_include(path, module, allowed, header):
    """What is wrong with `#include header` in path, or None."""
    if path == VERSION_FILE and header in VERSION_HEADERS:
        return None
    for prefix, owner in EDGES.items():
        if header.startswith(prefix) and not re.fullmatch(owner, path):
            return f"{header} belongs to {owner} alone"
    if header in NOWHERE:
        return f"<{header}> is not used here: {NOWHERE[header]}"
    if module in PURE_MODULES and header in IMPURE:
        return f"module {module} does without <{header}>"
    target = header.split("/")[0]
    if "/" in header and target in allowed and target not in allowed[module]:
        return f"module {module} may not know {target} (it may: {', '.join(sorted(allowed[module]))})"
    return None


def check_order(root, path):
    """What is wrong with the head of the file, or None."""
    lines = [line for _, line in numbered_lines(root, path)]
    if path.endswith(".h"):
        return None if "#pragma once" in lines else "a header begins with #pragma once"
    own = path.removesuffix(".cpp") + ".h"
    first = next((found.group(2) for found in map(INCLUDE.match, lines) if found), None)
    if os.path.isfile(os.path.join(root, own)) and "src/" + str(first) != own:
        return f"its own header {os.path.basename(own)} comes first, to show that it stands alone"
    return None


def declared_types(root, path):
    """(line number, type with its namespaces) of what a header declares for all."""
    outer = []
    for number, line in numbered_lines(root, path):
        opens = NAMESPACE.match(line)
        if opens:
            outer.append(opens.group(1))
        elif line.startswith("}  // namespace"):
            outer = outer[:-1]
        found = TYPE.match(line)
        if found:
            yield number, "::".join([*outer, found.group(1) or found.group(2)])


def main(root):
    allowed, complaints = declared_modules(root)
    types = {}
    checked = 0
    for path in project_files(root):
        parts = path.split("/")
        if parts[0] != "src" or not path.endswith((".h", ".cpp")):
            continue
        module = parts[1]
        if module not in allowed or len(parts) < 3:
            complaints.append(f"{path}: folder {module} is no module of CMakeLists.txt")
            continue
        checked += 1
        wrong = check_order(root, path)
        if wrong:
            complaints.append(f"{path}: {wrong}")
        for number, name in declared_types(root, path) if path.endswith(".h") else ():
            if types.setdefault(name, path) != path:
                complaints.append(f"{path}:{number}: {name} is a type of {types[name]}, too")
        for number, line in numbered_lines(root, path):
            shell = SHELL.search(line.split("//")[0])
            if shell:
                complaints.append(f"{path}:{number}: no shell is started, see src/base/subprocess.h: {shell.group(0)}")
            match = INCLUDE.match(line)
            if not match:
                continue
            header = match.group(2)
            wrong = check_include(path, module, allowed, header)
            if match.group(1) == '"' and not wrong and not os.path.isfile(os.path.join(root, "src", header)):
                wrong = f'"{header}" is no file under src/ (own headers are named from src/, others in <>)'
            if wrong:
                complaints.append(f"{path}:{number}: {wrong}")
    finish("layers", complaints, checked)


main(sys.argv[1])
