"""`import sumo_gamma` as users have it: functions, a loop of one's own, a loop over TraCI, faults, the examples.

usage: sumo_gamma_test.py SOURCE_FOLDER PROGRAM
"""
import ast
import gc
import inspect
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xml.dom.minidom

import numpy as np
import sumo_gamma

SOURCE, PROGRAM = sys.argv[1:3]
CROSSING = os.path.join(SOURCE, "sumo_scenarios/signalled_crossing")
CONFIG = os.path.join(CROSSING, "scenario.sumocfg")
STEPS = {"duration": 20, "quiet": True}


def drive_all(session, decide=None):
    while not session.finished:
        session.drive(decide)


class Functions(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name
        self.addCleanup(self.temporary.cleanup)

    def test_run_gives_what_the_program_gives(self):
        ours = sumo_gamma.run(CROSSING, os.path.join(self.folder, "ours"), duration=20, seed=3)
        path = os.path.join(self.folder, "program")
        subprocess.run([PROGRAM, "run", CROSSING, "-o", path, "--duration", "20", "--seed", "3", "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
        with open(os.path.join(path, "results.json"), encoding="utf-8") as stream:
            theirs = json.load(stream)
        self.assertEqual(ours["state_hash"], theirs["state_hash"])
        self.assertEqual(ours["agents"], theirs["agents"])
        self.assertTrue(ours["held"])

    def test_settings_are_a_mapping(self):
        results = [sumo_gamma.run(CROSSING, os.path.join(self.folder, name), **STEPS, set=settings)
                   for name, settings in (("a", {}), ("b", {"types.car.headway": 3.0}))]
        self.assertNotEqual(results[0]["state_hash"], results[1]["state_hash"])

    def test_import_map_makes_a_scenario(self):
        report = sumo_gamma.import_map(os.path.join(SOURCE, "tests/support/osm/signalled_crossing_right.osm"),
                                       os.path.join(self.folder, "map"), agents=5)
        self.assertTrue(os.path.exists(os.path.join(self.folder, "map", "net.net.xml")))
        self.assertGreater(report["built"]["edges"], 0)

    def test_scene_gives_figures(self):
        file = os.path.join(self.folder, "two.csv")
        with open(file, "w", encoding="utf-8") as stream:
            stream.write("id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed\n"
                         "0,People,0,0,0,1,20,0,1.3\n1,People,10,0.1,3.1416,1,-10,0,1.3\n")
        figures = sumo_gamma.scene(file, steps=50)
        self.assertEqual(figures["agents"], 2)
        self.assertEqual(figures["agents_overlapped_share"], 0)

    def test_predict_scores_a_recording(self):
        file = os.path.join(self.folder, "walk.csv")
        with open(file, "w", encoding="utf-8") as stream:
            stream.write("frame,agent_id,agent_type,x_m,y_m\n")
            stream.writelines(f"{frame},{agent},pedestrian,{0.5 * frame},{2 * agent}\n"
                              for frame in range(30) for agent in range(2))
        scores = sumo_gamma.predict(file, method=["cv"])
        self.assertTrue(scores)

    def test_what_is_wrong_comes_as_an_exception(self):
        with self.assertRaisesRegex(sumo_gamma.Error, "nowhere"):
            sumo_gamma.run("nowhere", self.folder)
        with self.assertRaisesRegex(sumo_gamma.Error, "--no-such-option"):
            sumo_gamma.run(CROSSING, self.folder, no_such_option=1)
        with self.assertRaisesRegex(sumo_gamma.Error, "agents"):
            sumo_gamma.run(CROSSING, self.folder, agents=-1)
        self.assertTrue(issubclass(sumo_gamma.SumoError, sumo_gamma.Error))

    def test_interrupt_ends_a_run_whose_files_are_whole(self):
        out = os.path.join(self.folder, "out")
        script = f"import sumo_gamma; sumo_gamma.run({CROSSING!r}, {out!r}, duration=100000)"
        child = subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True)
        limit = time.monotonic() + 60
        # once it has outputs it ticks
        while not os.path.exists(os.path.join(out, "trips.csv")) and time.monotonic() < limit:
            time.sleep(0.1)
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        with open(os.path.join(out, "results.json"), encoding="utf-8") as stream:
            self.assertEqual(json.load(stream)["ended"], "interrupted")

    def test_other_threads_go_on_while_it_runs(self):
        beats = []
        done = threading.Event()

        def beat():
            while not done.is_set():
                beats.append(time.monotonic())
                time.sleep(0.005)
        thread = threading.Thread(target=beat)
        thread.start()
        sumo_gamma.run(CROSSING, os.path.join(self.folder, "out"), **STEPS)
        done.set()
        thread.join()
        self.assertGreater(len(beats), 10)


class Loops(unittest.TestCase):
    def test_the_own_loop_gives_the_hash_of_the_run(self):
        with tempfile.TemporaryDirectory() as folder:
            expected = sumo_gamma.run(CROSSING, folder, **STEPS)["state_hash"]
        with sumo_gamma.Session(CROSSING, **STEPS) as session:
            drive_all(session)
            self.assertEqual(session.state_hash, expected)

    def test_output_is_written_where_it_is_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            with sumo_gamma.Session(CROSSING, output=folder, **STEPS) as session:
                drive_all(session)
                own = session.state_hash
            with open(os.path.join(folder, "results.json"), encoding="utf-8") as stream:
                results = json.load(stream)
        self.assertEqual(results["state_hash"], own)
        self.assertEqual(results["ended"], "done")

    def test_arrays_are_no_copies_and_stay_valid(self):
        with sumo_gamma.Session(CROSSING, duration=30, quiet=True) as session:
            while len(session) < 5:
                session.drive()
            session.observe()
            positions = session.positions
            self.assertEqual(positions.shape, (len(session), 2))
            self.assertTrue(np.shares_memory(positions, session.positions))
            self.assertTrue(np.shares_memory(positions[:, 0], session.positions))
            self.assertFalse(positions.flags.writeable)
            before = positions.copy()
            session.step()
            self.assertFalse(np.array_equal(before, positions), "an array in place shows the step")
            after = positions.copy()
            session.advance()
            drive_all(session)
            np.testing.assert_array_equal(after, positions)
        del session
        gc.collect()
        np.testing.assert_array_equal(after, positions)

    def test_a_rule_of_ones_own_holds(self):
        def crawl(session):
            np.minimum(session.allowed_speeds, 1.0, out=session.allowed_speeds)

        with sumo_gamma.Session(CROSSING, **STEPS) as session:
            while session.time < 12:
                session.drive()
            fastest = session.speeds.max()
            drive_all(session, crawl)
            driven = session.speeds[session.driven]
        self.assertGreater(fastest, 3.0)
        self.assertLess(driven.max(), 2.0)

    def test_a_preferred_velocity_of_ones_own_is_taken_and_forgotten(self):
        with sumo_gamma.Session(CROSSING, control="pedestrian", duration=100, quiet=True) as session:
            while not session.driven.any():
                session.drive()
            session.observe()
            row = int(np.flatnonzero(session.driven)[0])
            usual = session.velocity_space(row).preferred.copy()
            session.prefer(row, 0.0, 0.0)
            self.assertEqual(list(session.velocity_space(row).preferred), [0, 0])
            session.step()
            session.advance()
            session.observe()
            again = session.velocity_space(row).preferred
            self.assertGreater(np.linalg.norm(usual), 0.1)
            self.assertGreater(np.linalg.norm(again), 0.1)

    def test_the_chosen_velocity_lies_in_the_space(self):
        with sumo_gamma.Session(CROSSING, **STEPS) as session:
            while session.time < 15:
                session.drive()
            session.observe()
            for row in np.flatnonzero(session.driven):
                space = session.velocity_space(int(row))
                self.assertEqual(len(space.kinds), len(space.points))
                slack = ((space.chosen - space.points) * space.normals).sum(axis=1)
                self.assertGreater(slack[:space.hard].min(), -1e-6)
            np.testing.assert_allclose(np.linalg.norm(space.normals, axis=1), 1)

    def test_a_loop_out_of_order_is_refused(self):
        with sumo_gamma.Session(CROSSING, **STEPS) as session:
            with self.assertRaisesRegex(sumo_gamma.Error, "observe"):
                session.step()
            session.observe()
            with self.assertRaisesRegex(sumo_gamma.Error, "first"):
                session.observe()
            with self.assertRaisesRegex(sumo_gamma.Error, "no row"):
                session.prefer(10**6, 0, 0)
            with self.assertRaisesRegex(sumo_gamma.Error, "finite"):
                session.prefer(0, float("nan"), 0)
            with self.assertRaisesRegex(sumo_gamma.Error, "called"):
                session.take("car.0")
        with self.assertRaisesRegex(sumo_gamma.Error, "closed"):
            session.observe()

    def test_a_step_costs_what_it_costs_in_the_program(self):
        """Never asserted: a figure to read."""
        with sumo_gamma.Session(CROSSING, duration=60, quiet=True) as session:
            begin = time.perf_counter()
            drive_all(session)
            own = time.perf_counter() - begin
        with tempfile.TemporaryDirectory() as folder:
            wall = sumo_gamma.run(CROSSING, folder, duration=60)["timing"]["wall_s"]
        print(f"60 s: Python's loop {own:.2f} s, the program's own {wall:.2f} s, ratio {own / wall:.2f}")


class BesideTraci(unittest.TestCase):
    def setUp(self):
        import traci
        self.traci = traci
        traci.start(["sumo", "-c", CONFIG, "--step-length", "0.1", "--no-step-log", "true"])
        self.addCleanup(self.close)

    def close(self):
        try:
            self.traci.close()
        except Exception:  # a test has ended SUMO by itself
            pass

    def drive(self, gamma, until):
        while self.traci.simulation.getTime() < until - 1e-6:
            gamma.drive()
            self.traci.simulationStep()

    def test_agents_are_driven_by_gamma_where_traci_sees_them(self):
        gamma = sumo_gamma.attach(self.traci)
        self.drive(gamma, 20)
        gamma.observe()
        self.assertGreater(gamma.driven.sum(), 3)
        self.assertEqual(gamma.time, self.traci.simulation.getTime())
        for row, identifier in enumerate(gamma.ids):
            if gamma.types[row] in ("pedestrian",) or not gamma.driven[row]:
                continue
            front = np.array(self.traci.vehicle.getPosition(identifier))
            self.assertLess(np.linalg.norm(front - gamma.positions[row]), gamma.radii[row] + 0.1)
        gamma.close()

    def test_subscriptions_of_the_user_go_on(self):
        gamma = sumo_gamma.attach(self.traci)
        self.traci.simulation.subscribe([self.traci.constants.VAR_TIME])
        self.drive(gamma, 5)
        results = self.traci.simulation.getSubscriptionResults()
        self.assertAlmostEqual(results[self.traci.constants.VAR_TIME], 5.0)
        gamma.close()

    def test_a_part_is_handed_over_and_taken_back(self):
        gamma = sumo_gamma.attach(self.traci, control="called")
        self.drive(gamma, 10)
        gamma.observe()
        self.assertFalse(gamma.driven.any())
        vehicle = next(name for name, kind in zip(gamma.ids, gamma.types) if kind == "car")
        gamma.take(vehicle)
        gamma.step()
        gamma.advance()
        self.traci.simulationStep()
        self.drive(gamma, 12)
        row = gamma.ids.index(vehicle)
        self.assertTrue(gamma.driven[row])
        self.assertEqual(gamma.driven.sum(), 1)
        gamma.release(vehicle)
        limit = 60
        while gamma.driven.any() and self.traci.simulation.getTime() < limit:
            gamma.drive()
            self.traci.simulationStep()
        self.assertFalse(gamma.driven.any())
        gamma.close()

    def test_what_cannot_be_joined_is_refused(self):
        with self.assertRaisesRegex(sumo_gamma.Error, "steps"):
            sumo_gamma.attach(self.traci, step=0.05)
        other = os.path.join(SOURCE, "sumo_scenarios/zebra/zebra.sumocfg")
        with self.assertRaisesRegex(sumo_gamma.Error, "network"):
            sumo_gamma.attach(self.traci, scenario=other)
        with self.assertRaisesRegex(sumo_gamma.Error, "no connection"):
            sumo_gamma.attach(json)
        self.assertEqual(self.traci.simulation.getTime(), 0)

    def test_a_sumo_that_goes_away_is_an_exception(self):
        gamma = sumo_gamma.attach(self.traci)
        self.drive(gamma, 2)
        self.traci.close()
        with self.assertRaises(sumo_gamma.Error):
            gamma.drive()


class TypeHints(unittest.TestCase):
    def test_they_name_what_there_is(self):
        path = os.path.join(os.path.dirname(sumo_gamma.__file__), "__init__.pyi")
        with open(path, encoding="utf-8") as stream:
            tree = ast.parse(stream.read())
        told = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(told) | {"__version__"}, set(sumo_gamma.__all__))
        for name in ("Session", "VelocitySpace"):
            members = {node.name for node in told[name].body if isinstance(node, ast.FunctionDef)}
            there = {member for member, _ in inspect.getmembers(getattr(sumo_gamma, name))
                     if not member.startswith("_")}
            self.assertEqual({member for member in members if not member.startswith("_")}, there)


class Examples(unittest.TestCase):
    def run_example(self, name, *arguments):
        path = os.path.join(SOURCE, "examples/python", name)
        run = subprocess.run([sys.executable, path, *arguments], capture_output=True, text=True, timeout=300)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        print(run.stdout, end="")
        return run.stdout

    def test_user_loop(self):
        self.assertRegex(self.run_example("user_loop.py", CONFIG), r"[1-9]\d* of them GAMMA's then, \d at")

    def test_sweep(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(len(self.run_example("sweep.py", CROSSING, folder).splitlines()), 4)

    def test_velocity_space(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "space.svg")
            self.run_example("velocity_space.py", CROSSING, file)
            drawn = xml.dom.minidom.parse(file)
            self.assertGreater(len(drawn.getElementsByTagName("path")), 3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
