"""Checks that the closing line of tools/test.sh tells the truth about what ctest 3.25 writes.

usage: summary_test.py PROJECT_FOLDER
"""
import os
import subprocess
import sys
import tempfile

GOOD = '<testcase name="A.Good" status="run"><system-out>fine</system-out></testcase>'
BAD = '<testcase name="A.Bad" status="fail"><failure message=""/><system-out>1 != 2</system-out></testcase>'
SKIPPED = ('<testcase name="A.Skipped" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>'
           "<system-out>[ RUN      ] A.Skipped\na.cpp:7: Skipped\nno shared\nfolder\n[  SKIPPED ] A.Skipped (0 ms)\n"
           "</system-out></testcase>")
TOOL = ('<testcase name="lint.tool" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>'
        "<system-out>skipped: no tool\n</system-out></testcase>")
NOT_BUILT = ('<testcase name="b_NOT_BUILT" status="notrun"><skipped message="Unable to find executable"/>'
             "<system-out>Unable to find executable: b_NOT_BUILT</system-out></testcase>")
OFF = '<testcase name="A.Off" status="disabled"><system-out>Disabled</system-out></testcase>'

# stages that were lost, the cases of each file, the closing line, the exit code, what else must be said
CASES = [
    ([], [[GOOD, GOOD], [GOOD]], "3 passed, 0 failed, 0 skipped", 0, ""),
    ([], [[GOOD, BAD]], "1 passed, 1 failed, 0 skipped", 1, "stage0: A.Bad"),
    ([], [[GOOD], [BAD]], "1 passed, 1 failed, 0 skipped", 1, "stage1: A.Bad"),
    ([], [[GOOD, NOT_BUILT]], "1 passed, 1 failed, 0 skipped", 1, "b_NOT_BUILT"),
    ([], [[GOOD, SKIPPED, TOOL, OFF]], "1 passed, 0 failed, 3 skipped", 0, "reason: no shared folder"),
    ([], [[GOOD, OFF]], "1 passed, 0 failed, 1 skipped", 0, "switched off in the source"),
    ([], [[SKIPPED]], "0 passed, 0 failed, 1 skipped", 1, "no test passed"),
    (["asan"], [[GOOD]], "1 passed, 1 failed, 0 skipped", 1, "asan: the stage itself"),
    (["dev"], [], "0 passed, 1 failed, 0 skipped", 1, "dev: the stage itself"),
    ([], [], "0 passed, 0 failed, 0 skipped", 1, "no test passed"),
]


def main(root):
    complaints = []
    for lost, stages, closing, code, said in CASES:
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-B", os.path.join(root, "tools/lib/summarise_tests.py")]
            for stage in lost:
                command += ["--failed", stage]
            for number, cases in enumerate(stages):
                path = os.path.join(folder, f"stage{number}", "tests.xml")
                os.makedirs(os.path.dirname(path))
                with open(path, "w", encoding="utf-8") as file:
                    file.write(f"<testsuite name='x'>{''.join(cases)}</testsuite>")
                command.append(path)
            found = subprocess.run(command, capture_output=True, text=True, check=False)
        if found.stdout.splitlines()[-1:] != [closing] or found.returncode != code or said not in found.stdout:
            complaints.append(f"expected '{closing}', '{said}' and exit code {code} of {lost}, {stages}; "
                              f"got {found.returncode}:\n{found.stdout}{found.stderr}")
    print("\n".join(complaints))
    print(f"summary: {len(CASES)} cases, {len(complaints)} complaints")
    sys.exit(1 if complaints else 0)


main(sys.argv[1])
