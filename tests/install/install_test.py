"""Installs the build into a prefix of its own and uses it as others do: the program, a project of one's own against the
library, Python.

usage: install_test.py SOURCE_FOLDER BUILD_FOLDER CMAKE CXX_COMPILER PYTHON|none
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD, CMAKE, COMPILER, PYTHON = sys.argv[1:6]
CROSSING = os.path.join(SOURCE, "sumo_scenarios/signalled_crossing")
EXAMPLE = os.path.join(SOURCE, "examples/own_loop")
OPTIONS = ["--duration", "20", "--quiet"]


def call(*words, **more):
    run = subprocess.run(words, capture_output=True, text=True, timeout=600, **more)
    if run.returncode != 0:
        raise AssertionError(f"{words} ended with {run.returncode}\n{run.stdout}{run.stderr}")
    return run.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.prefix = os.path.join(cls.temporary.name, "prefix")
        call(CMAKE, "--install", BUILD, "--prefix", cls.prefix)
        cls.program = os.path.join(cls.prefix, "bin/sumo-gamma")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def results(self, name, *options):
        folder = os.path.join(self.temporary.name, name)
        call(self.program, "run", CROSSING, "-o", folder, *OPTIONS, *options)
        with open(os.path.join(folder, "results.json"), encoding="utf-8") as stream:
            return json.load(stream)

    def test_the_program_finds_its_libsumo_module(self):
        self.assertEqual(self.results("libsumo", "--backend", "libsumo")["backend"], "libsumo")

    def test_the_public_headers_are_few_and_need_nothing(self):
        folder = os.path.join(self.prefix, "include")
        found = [os.path.relpath(os.path.join(place, name), folder)
                 for place, _, names in os.walk(folder) for name in names]
        self.assertEqual(sorted(found), ["sumo_gamma/base/error.h", "sumo_gamma/program.h", "sumo_gamma/session.h"])
        for header in found:
            call(COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow",
                 "-Werror", "-I", folder, "-x", "c++", "-", input=f"#include <{header}>\n#include <{header}>\n")

    def test_a_project_of_ones_own_builds_and_runs(self):
        build = os.path.join(self.temporary.name, "example")
        call(CMAKE, "-S", EXAMPLE, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        call(CMAKE, "--build", build)
        told = call(os.path.join(build, "own_loop"), CROSSING, *OPTIONS)
        self.assertIn(self.results("program")["state_hash"], told)
        told = call(os.path.join(build, "own_rules"), CROSSING, "--duration", "60", "--quiet")
        print(told, end="")
        self.assertLess(float(told.split(": ")[1].split()[0]), 6.0)
        run = subprocess.run([os.path.join(build, "own_loop"), "nowhere"], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 2)
        self.assertIn("nowhere", run.stderr)

    @unittest.skipIf(PYTHON == "none", "the Python module was not made: pybind11 is missing")
    def test_python_finds_the_library(self):
        path = os.path.join(self.prefix, "lib/python3/dist-packages")
        script = ("import sumo_gamma, sumo_gamma_ego\n"
                  f"with sumo_gamma.Session({CROSSING!r}, duration=20, quiet=True) as session:\n"
                  "    while not session.finished: session.drive()\n"
                  "    print(session.state_hash)\n")
        told = call(PYTHON, "-c", script, env={**os.environ, "PYTHONPATH": path}, cwd=self.temporary.name)
        self.assertEqual(told.strip(), self.results("python")["state_hash"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
