"""What the lints share: which files the project has, and how a complaint is printed."""
import os
import subprocess
import sys

SKIPPED = 77  # ctest's SKIP_RETURN_CODE for these tests


def committed_files(root):
    """What git lists (ignored files left out), or None where root is no checkout or there is no git."""
    git = ["git", "-C", root, "-c", "safe.directory=*"]
    try:
        top = subprocess.run(git + ["rev-parse", "--show-toplevel"], capture_output=True, text=True, check=True)
        listed = subprocess.run(git + ["ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    same = os.path.realpath(top.stdout.strip()) == os.path.realpath(root)
    return listed.stdout.split("\0") if same else None


def project_files(root):
    """Paths relative to root of every file that is or would be committed; every file where git has no say."""
    names = committed_files(root)
    if names is not None:
        return sorted(name for name in names if name and os.path.isfile(os.path.join(root, name)))
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if f not in (".git", "out") and not f.startswith("build")]
        found += [os.path.relpath(os.path.join(folder, name), root) for name in names]
    return sorted(found)


def numbered_lines(root, path):
    with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
        return list(enumerate(file.read().splitlines(), start=1))


def finish(lint, complaints, checked):
    """Prints the complaints, or how much was looked at, and ends. Nothing looked at is a complaint, too."""
    if checked == 0:
        complaints = complaints + [f"{lint}: found nothing to check"]
    for complaint in complaints:
        print(complaint)
    print(f"{lint}: {checked} checked, {len(complaints)} complaints")
    sys.exit(1 if complaints else 0)
