"""Runs clang-tidy-14 on sources of src/ and writes what it finds as ctest writes its results, one case a file.

usage: tidy.py BUILD_FOLDER changed|all

BUILD_FOLDER: has compile_commands.json; gets tests.xml. changed: the sources that differ, or whose headers do, from where the branch
left the main one, or from five commits ago on the main one itself, those of the last commits first; in a clone that shows no other
commit all of them, in an order that each commit draws anew. After TIDY_SECONDS (240; all: no end) no further file is begun, and how
many were left out is said, and counted as one test that was skipped. Ends with 1 where anything was found.
"""
import json
import multiprocessing.pool
import os
import random
import re
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

COMMITS = 5  # looked back on the main branch


def git(*arguments):
    """Lines of git's answer; none where it has none."""
    found = subprocess.run(["git", "-c", "safe.directory=*", *arguments], capture_output=True, text=True, check=False)
    return found.stdout.splitlines() if found.returncode == 0 else []


def base_commit():
    """What changes are counted from; None where nothing else is visible."""
    head = git("rev-parse", "HEAD")
    for branch in ("origin/HEAD", "origin/main", "main"):
        base = git("merge-base", "HEAD", branch)
        if base and base != head:
            return base[0]
    visible = git("rev-list", "--first-parent", f"--max-count={COMMITS + 1}", "HEAD")
    return visible[-1] if len(visible) > 1 else None


def sources_of(changed, sources):
    """The sources among the changed files in their order, and for a header the one of its name or else the first that includes it."""
    chosen = []
    for path in changed:
        own = path.rpartition(".")[0] + ".cpp"
        if own in sources:
            chosen.append(own)
        elif path.endswith(".h"):
            include = f'#include "{path.removeprefix("src/")}"'
            chosen += [source for source in sources if include in open(source, encoding="utf-8").read()][:1]
    return list(dict.fromkeys(chosen))


def choose(which, sources):
    if which == "all":
        return sources, "all sources"
    base = base_commit()
    if base is None:
        random.Random("".join(git("rev-parse", "HEAD"))).shuffle(sources)
        return sources, "no other commit to compare with: all sources, in an order of this commit's own"
    changed = (git("ls-files", "--others", "--exclude-standard", "--", "src") + git("diff", "--name-only", "HEAD", "--", "src") +
               git("log", "--first-parent", "-m", "--name-only", "--format=", f"{base}..HEAD", "--", "src"))
    return sources_of(changed, sources), f"sources that changed since {base[:12]}"


def look_at(source, folder, end):
    """(source, complaints); None for the complaints where the time is over."""
    if time.monotonic() > end:
        return source, None
    found = subprocess.run(["clang-tidy-14", "--quiet", "-p", folder, source], capture_output=True, text=True, check=False)
    root = os.getcwd() + "/"
    complaints = [line.replace(root, "") for line in found.stdout.splitlines() if re.search(r": (error|warning): ", line)]
    if found.returncode != 0 and not complaints:
        complaints = [f"{source}: clang-tidy ended with {found.returncode}: {found.stderr.strip()}"]
    return source, complaints


def write_results(results, file):
    suite = ElementTree.Element("testsuite", name="tidy")
    left = sum(complaints is None for _, complaints in results)
    for source, complaints in results:
        if complaints is not None:
            case = ElementTree.SubElement(suite, "testcase", name=source, status="fail" if complaints else "run")
            if complaints:
                ElementTree.SubElement(case, "failure", message="")
    if left:
        case = ElementTree.SubElement(suite, "testcase", name="sources left out", status="notrun")
        ElementTree.SubElement(case, "skipped", message="SKIP_RETURN_CODE=77")
        ElementTree.SubElement(case, "system-out").text = f"skipped: no time left to look at {left} sources (TIDY_SECONDS)"
    ElementTree.ElementTree(suite).write(file, encoding="utf-8")


def main(folder, which):
    limit = float(os.environ.get("TIDY_SECONDS", "inf" if which == "all" else "240"))
    with open(os.path.join(folder, "compile_commands.json"), encoding="utf-8") as file:
        commands = json.load(file)
    root = os.getcwd() + "/"
    paths = {os.path.normpath(os.path.join(c["directory"], c["file"])).removeprefix(root) for c in commands}
    chosen, words = choose(which, sorted(path for path in paths if path.startswith("src/")))
    print(f"{words}: {len(chosen)}", flush=True)
    end = time.monotonic() + limit
    results, found = [], set()
    with multiprocessing.pool.ThreadPool(int(os.environ.get("JOBS", os.cpu_count()))) as pool:
        for source, complaints in pool.imap(lambda source: look_at(source, folder, end), chosen):
            results.append((source, complaints))
            for line in sorted(set(complaints or []) - found):  # a header's are found with every source that includes it
                print(line, flush=True)
            found.update(complaints or [])
    print(f"clang-tidy: {len(found)} complaints")
    write_results(results, os.path.join(folder, "tests.xml"))
    sys.exit(1 if found else 0)


main(*sys.argv[1:])
