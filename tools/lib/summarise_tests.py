"""Adds up ctest's JUnit files: names what failed, says why what was skipped was, and closes with one line.

usage: summarise_tests.py [--failed STAGE]... [FILE...]    FILE: build/STAGE/tests.xml
Ends with 1 where anything failed, a stage did not get as far as its tests, or no test passed.
"""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree


def skip_reason(output):
    """What GTEST_SKIP() or a lint printed: the line(s) after 'Skipped', or the last line that tells."""
    match = re.search(r": Skipped\n(.*?)\n*(?:\[  SKIPPED \]|$)", output, re.DOTALL)
    if match and match.group(1).strip():
        return " ".join(match.group(1).split())
    for line in output.splitlines():
        if line.startswith("skipped"):
            return line
    return "gave no reason"


def read_stage(path):
    """(passed, [failed names], [(skipped name, reason)]) of one file."""
    passed, failed, skipped = 0, [], []
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        name, status = case.get("name"), case.get("status")
        message = next((child.get("message", "") for child in case.iter("skipped")), "")
        # ctest writes a program that was never built as skipped, too: that is a failure
        chosen = "SKIP_REGULAR_EXPRESSION" in message or "SKIP_RETURN_CODE" in message
        if status == "run":
            passed += 1
        elif status == "notrun" and chosen:
            skipped.append((name, skip_reason(case.findtext("system-out") or "")))
        elif status == "disabled":
            skipped.append((name, "switched off in the source"))
        else:
            failed.append(name)
    return passed, failed, skipped


def main(arguments):
    passed, failed, reasons, files = 0, [], {}, []
    while arguments:
        argument = arguments.pop(0)
        if argument == "--failed":
            failed.append(arguments.pop(0) + ": the stage itself (see above)")
        else:
            files.append(argument)
    for path in files:
        stage = os.path.basename(os.path.dirname(path))
        stage_passed, stage_failed, stage_skipped = read_stage(path)
        passed += stage_passed
        failed += [f"{stage}: {name}" for name in stage_failed]
        for name, reason in stage_skipped:
            reasons.setdefault(reason, []).append(f"{stage}: {name}")
        print(f"{stage:8} {stage_passed} passed, {len(stage_failed)} failed, {len(stage_skipped)} skipped ({path})")
    skipped = sum(len(names) for names in reasons.values())
    for reason, names in sorted(reasons.items()):
        print(f"\nSKIPPED, {len(names)} for this reason: {reason}")
        print("\n".join("  " + name for name in names))
    if failed:
        print("\nFAILED:\n" + "\n".join("  " + name for name in failed))
    if passed == 0 and not failed:
        print("\nno test passed, so nothing was tested")
    print(f"\n{passed} passed, {len(failed)} failed, {skipped} skipped")
    return 1 if failed or passed == 0 else 0


sys.exit(main(sys.argv[1:]))
