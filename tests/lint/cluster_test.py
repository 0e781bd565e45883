"""Checks which shards tools/batch.slurm and tools/Snakefile ask for, with a program that only writes down what it was told.

usage: cluster_test.py PROJECT_FOLDER
"""
import os
import shutil
import subprocess
import sys
import tempfile

from project import SKIPPED

PROGRAM = """#!/bin/bash
# arguments: batch STUDY -o FOLDER ...
printf '%s\\n' "$*" >> "$ASKED"
mkdir -p "$4"
touch "$4/study.sqlite"
[[ $* != *"--shard 1/2"* ]]  # exit code 1: runs of the first shard failed
"""


def asked(folder, command, **environment):
    """Exit code of the command, and the sorted lines of what it had the program do."""
    log = os.path.join(folder, "asked")
    open(log, "w", encoding="utf-8").close()
    words = {**os.environ, "ASKED": log, "HOME": folder, "XDG_CACHE_HOME": folder, **environment}
    done = subprocess.run(command, cwd=folder, env=words, capture_output=True, text=True, check=False)
    with open(log, encoding="utf-8") as file:
        return done.returncode, sorted(file.read().splitlines()), done.stderr


def main(root):
    root = os.path.abspath(root)
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "program")
        with open(program, "w", encoding="utf-8") as file:
            file.write(PROGRAM)
        os.chmod(program, 0o755)

        slurm = [os.path.join(root, "tools", "batch.slurm"), "study.toml", "out"]
        array = {"SUMO_GAMMA": program, "SLURM_ARRAY_TASK_ID": "6", "SLURM_ARRAY_TASK_MIN": "5", "SLURM_ARRAY_TASK_MAX": "7",
                 "SLURM_ARRAY_TASK_COUNT": "3", "SLURM_CPUS_PER_TASK": "2"}
        code, lines, told = asked(folder, slurm, **array)
        assert (code, lines) == (0, ["batch study.toml -o out --shard 2/3 --jobs 2 --quiet"]), (code, lines, told)
        code, lines, told = asked(folder, slurm, **{**array, "SLURM_ARRAY_TASK_COUNT": "2"})
        assert (code, lines) == (2, []) and "without gaps" in told, (code, lines, told)
        code, lines, told = asked(folder, slurm + ["merge"], SUMO_GAMMA=program)
        assert (code, lines) == (0, ["batch study.toml -o out --merge"]), (code, lines, told)
        code, lines, told = asked(folder, slurm[:1])
        assert (code, lines) == (2, []) and "sbatch --array" in told, (code, lines, told)

        if not shutil.which("snakemake"):
            print("skipped: snakemake is not installed; tools/batch.slurm was checked, tools/Snakefile was not")
            sys.exit(SKIPPED)
        code, lines, told = asked(folder, ["snakemake", "--snakefile", os.path.join(root, "tools", "Snakefile"), "--cores", "2", "--config",
                                           "study=a study.toml", "folder=snake", "shards=2", f"program={program}"])
        shards = [f"batch a study.toml -o snake/study --shard {part}/2 --quiet --jobs 2" for part in (1, 2)]
        assert (code, lines) == (0, ["batch a study.toml -o snake/study --merge", *shards]), (code, lines, told)
        assert os.path.isfile(os.path.join(folder, "snake", "study.sqlite"))
    print("cluster: both tools ask for the shards and for what they come to")


main(sys.argv[1])
