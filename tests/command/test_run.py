"""asterflow run, resume, check, mobility, flow and export: results, exact resuming, and every kind of bad input."""

import csv
import json
import math
import os
import re
import resource
import subprocess
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from program import ASTERFLOW, CommandTest

BALL = """
[fluid]
viscosity = 2.0
[[body]]
name = "ball"
shape = "sphere"
radius = 1.5
position = [0.5, 0.0, 0.0]
force = [3.0, 0.0, 0.0]
[run]
interactions = "open"
accuracy = 1e-3
end_time = 2.0
[output]
interval = 0.5
picture = false
"""

# A body with fibers that grow and shrink.
ASTER = """
[[body]]
name = "core"
shape = "sphere"
radius = 1.0
force = [2.0, 0.0, 0.0]
[[aster]]
body = "core"
position = [0.0, 1.0, 0.0]
count = 5
length = 2.0
growing = true
[dynamic_instability]
catastrophe_rate = 1.0
[run]
interactions = "local"
accuracy = 1e-3
end_time = 3.0
[output]
interval = 0.25
picture = false
"""

CELL = BALL.replace('interactions = "open"', 'interactions = "confined"') + """
[periphery]
shape = "sphere"
radius = 4.0
"""


def contents(path):
    """All datasets of a trajectory but its header."""
    arrays = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: arrays.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return {name: array for name, array in arrays.items() if not name.startswith("header")}


class SceneTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.toml"
        self.out = self.folder / "out"
        self.trajectory = self.out / "trajectory.h5"

    def run_scene(self, text, *options, **more):
        self.scene.write_text(text)
        return self.expect_done("run", self.scene, "-o", self.out, *options, **more)

    def refused(self, text, *options, names=()):
        """Both check and run refuse the scene; nothing is written."""
        self.scene.write_text(text)
        self.expect_refusal("check", self.scene, *options, names=names)
        self.expect_refusal("run", self.scene, "-o", self.out, *options, names=names)
        self.assertFalse(self.out.exists())


class Run(SceneTest):
    def test_a_sphere_moves_as_stokes_says(self):
        self.run_scene(BALL)
        with h5py.File(self.trajectory) as file:
            np.testing.assert_allclose(file["time"], [0, 0.5, 1, 1.5, 2])
            moved = file["frames/000004/body/position"][0, 0] - 0.5
            self.assertEqual(file["header/scene"][()].decode(), BALL)
        self.assertAlmostEqual(moved, 2.0 * 3.0 / (6 * math.pi * 2.0 * 1.5), delta=1e-5)

    def test_overrides_count(self):
        self.run_scene(BALL, "--set", "body.ball.force=[0, 6, 0]", "--set", "run.end_time=0.5")
        with h5py.File(self.trajectory) as file:
            self.assertEqual(file["frames/000001/body/position"][0, 0], 0.5)
            self.assertGreater(file["frames/000001/body/position"][0, 1], 0.01)
            self.assertIn("run.end_time=0.5", file["header/overrides"][()].decode())

    def check_resuming(self, scene, middle, end):
        self.run_scene(scene, "--set", f"run.end_time={end}")
        whole = contents(self.trajectory)
        self.out = self.folder / "parts"
        self.run_scene(scene, "--set", f"run.end_time={middle}")
        self.expect_done("resume", self.out, "--set", f"run.end_time={end}")
        parts = contents(self.out / "trajectory.h5")
        self.assertEqual(whole.keys(), parts.keys())
        for name in whole:
            self.assertEqual(np.asarray(whole[name]).tobytes(), np.asarray(parts[name]).tobytes(), name)

    def test_a_resumed_run_equals_one_without_interruption(self):
        self.check_resuming(ASTER, 1, 3)

    def test_so_does_a_resumed_run_with_all_interactions(self):
        confined = ASTER.replace('"local"', '"confined"').replace("1e-3", "1e-2")
        self.check_resuming(confined + "[periphery]\nshape = 'sphere'\nradius = 6\n", 0.5, 1)

    def test_a_killed_run_goes_on_exactly(self):
        self.run_scene(ASTER)
        whole = contents(self.trajectory)
        self.out = self.folder / "killed"
        process = subprocess.Popen([ASTERFLOW, "run", self.scene, "-o", self.out], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        while not (self.out / "trajectory.h5").exists() and process.poll() is None:
            time.sleep(0.002)
        time.sleep(0.1)
        process.kill()
        process.wait()
        self.expect_done("resume", self.out)
        parts = contents(self.out / "trajectory.h5")
        for name in whole:
            self.assertEqual(np.asarray(whole[name]).tobytes(), np.asarray(parts[name]).tobytes(), name)

    def test_an_interrupted_run_closes_its_file_and_goes_on(self):
        self.scene.write_text(ASTER)
        process = subprocess.Popen([ASTERFLOW, "run", self.scene, "-o", self.out, "--set", "run.end_time=1000"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while not self.trajectory.exists() and process.poll() is None:
            time.sleep(0.01)
        time.sleep(0.5)
        process.terminate()
        self.assertIn("asterflow resume", process.communicate(timeout=60)[1])
        self.assertEqual([path.name for path in self.out.iterdir()], ["trajectory.h5"])

    def test_a_complete_run_is_left_alone(self):
        self.run_scene(BALL, "--set", "run.end_time=0.5")
        before = self.trajectory.read_bytes()
        self.assertIn("complete", self.expect_done("resume", self.out).stderr)
        self.assertEqual(self.trajectory.read_bytes(), before)

    def test_a_failed_solve_stores_the_last_state(self):
        self.scene.write_text(CELL)
        result = subprocess.run([ASTERFLOW, "run", self.scene, "-o", self.out, "--set", "run.gmres_max_iterations=1",
                                 "--set", "run.gmres_tolerance=1e-12"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("GMRES", result.stderr)
        with h5py.File(self.trajectory) as file:
            self.assertGreaterEqual(len(file["time"]), 1)
        way_to_look = re.search(r"look at it with: asterflow (.*)", result.stderr)[1]
        self.expect_done(*way_to_look.split())

    def stopped_by(self, scene, *names):
        """Text of a run that what it names has stopped; the state just before is stored."""
        self.scene.write_text(scene)
        result = subprocess.run([ASTERFLOW, "run", self.scene, "-o", self.out], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2, result.stderr)
        for name in names:
            self.assertIn(name, result.stderr)
        stopped = float(re.search(r"t = ([\d.e-]+) s", result.stderr)[1])
        with h5py.File(self.trajectory) as file:
            self.assertGreater(stopped, 0.0)
            self.assertAlmostEqual(float(file["time"][-1]), stopped, delta=1e-5 * stopped)  # the message has 6 digits
            frames = file["frames"]
            return frames[sorted(frames)[-1]]["body/position"][0, 0]

    def test_a_fiber_pushed_through_the_cortex_is_named_and_the_state_kept(self):
        fiber = """
[[fiber]]
body = "ball"
position = [2.0, 0.0, 0.0]
length = 1.9
minus_end = "clamped"
"""
        x = self.stopped_by(CELL.replace("3.0, 0.0", "300.0, 0.0").replace("1e-3", "1e-2\nmin_time_step = 1e-4") + fiber,
                            '[[fiber]] #1 on body "ball" reaches outside the periphery')
        self.assertAlmostEqual(x, 0.6, delta=0.02)  # its plus end is then at the cortex

    def test_a_body_that_touches_the_cortex_is_named_and_the_state_kept(self):
        scene = CELL.replace("confined", "local").replace("3.0, 0.0", "300.0, 0.0")
        self.assertAlmostEqual(self.stopped_by(scene, 'body "ball" touches the periphery'), 2.5, delta=1e-3)


class Observe(SceneTest):
    def table(self, name):
        with open(self.out / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_observables_of_a_run_are_the_same_after_resuming(self):
        self.run_scene(ASTER.replace("local", "open"))
        self.expect_done("observe", self.out)
        whole = self.table("observables.csv")
        self.assertEqual(len(whole), 13)
        self.assertLess(float(whole[-1]["force_imbalance"]), 1e-3)
        self.assertAlmostEqual(sum(float(f) for name, f in self.table("lengths.csv")[-1].items() if name != "time"), 1, 5)
        self.assertTrue((self.out / "observables.png").exists())
        self.out = self.folder / "parts"
        self.run_scene(ASTER.replace("local", "open"), "--set", "run.end_time=1.5")
        self.expect_done("resume", self.out, "--set", "run.end_time=3")
        self.expect_done("observe", self.out)
        for before, after in zip(whole[:7], self.table("observables.csv")):
            self.assertEqual(before, after)

    def test_observing_without_flow_or_trajectory(self):
        self.run_scene(ASTER)
        self.expect_done("observe", self.out, "--every", 5, "--no-flow", "-o", self.folder / "quick")
        with open(self.folder / "quick" / "observables.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["time"]) for row in rows], [0, 1.25, 2.5])
        self.assertNotIn("net_force_x", rows[0])
        self.expect_refusal("observe", self.folder / "nowhere", names=["nowhere"])


class BadRun(SceneTest):
    def test_refuses_a_missing_scene(self):
        for command in ("run", "check", "mobility", "drag"):
            self.expect_refusal(command, self.scene, names=[self.scene, "No such file"])

    def test_refuses_what_is_not_toml(self):
        self.refused("[fluid\nviscosity = 1", names=["scene.toml", "line 1"])

    def test_refuses_bad_values_by_place(self):
        cases = {
            "body.0.radius=-1": ["[[body]] #1", "radius = -1", "must be positive (um)"],
            "body.0.radius=nan": ["radius", "finite"],
            "body.0.radius=1e-300": ["radius", "must be from 1e-50 to 1e50 (um)"],
            "body.0.radius='big'": ["radius", "must be a number"],
            "body.0.raduis=1": ["unknown key", "did you mean", "radius"],
            "fluid.viscosity=0": ["[fluid]", "viscosity = 0", "must be positive"],
            "body.0.order=3": ["order = 3", "from 4 to 96"],
            "body.0.name='a,b'": ["name = 'a,b'", "comma"],
            "body.0.shape=cube": ["shape", "sphere, ellipsoid, revolution"],
            "fiber.0.nodes=1000": ["[[fiber]] #1", "nodes = 1000"],
            "fiber.0.length=-2": ["length = -2"],
            "runn.accuracy=1": ["unknown key", "run"],
            "run.interactions=confined": ["needs a [periphery]"],
            "run.evaluator=magic": ["evaluator", "auto"],
            "run.seed=-1": ["seed"],
            "fiber.0.nonlocal=1": ["nonlocal", "true or false"],
        }
        for override, names in cases.items():
            with self.subTest(override):
                self.refused(BALL, "--set", override, names=["scene.toml", *names])

    def test_refuses_things_in_wrong_places(self):
        self.refused(CELL, "--set", "body.0.position=[3, 0, 0]", names=["[[body]] #1", "outside the periphery"])
        fiber = '[[fiber]]\nposition = [0, 0, 3]\ndirection = [0, 0, 1]\nlength = 2\n'
        self.refused(CELL + fiber, names=["[[fiber]] #1", "outside the periphery"])
        nonlocal_fiber = fiber.replace("length = 2", "length = 0.5\nnonlocal = true")
        self.refused(BALL + nonlocal_fiber, "--set", "run.interactions=local", names=["nonlocal", "open"])
        other = '[[body]]\nshape = "sphere"\nradius = 1\nposition = [2, 0, 0]\n'
        self.refused(BALL + other, names=["[[body]] #2", "overlaps", "ball"])

    def test_refuses_output_that_cannot_be_written(self):
        self.scene.write_text(BALL)
        self.expect_refusal("run", self.scene, "-o", "/proc/asterflow", names=["/proc/asterflow"])
        (self.folder / "file").write_text("precious")
        self.expect_refusal("run", self.scene, "-o", self.folder / "file", names=["is a file"])
        self.expect_refusal("run", self.scene, "-o", self.folder, names=["is not empty"])
        self.assertEqual((self.folder / "file").read_text(), "precious")

    def test_refuses_to_overwrite_a_trajectory(self):
        self.run_scene(BALL, "--set", "run.end_time=0.5")
        before = self.trajectory.read_bytes()
        self.expect_refusal("run", self.scene, "-o", self.out, names=["asterflow resume"])
        self.assertEqual(self.trajectory.read_bytes(), before)

    def test_refuses_to_resume_a_changed_scene(self):
        self.run_scene(BALL, "--set", "run.end_time=0.5")
        before = self.trajectory.read_bytes()
        self.scene.write_text(BALL.replace("radius = 1.5", "radius = 1.6"))
        extend = ("--set", "run.end_time=1")
        self.expect_refusal("resume", self.out, *extend, names=["scene.toml", "has changed"])
        self.expect_refusal("resume", self.out, "--set", "body.0.radius=2", names=["body.0.radius=2", "run.end_time"])
        self.assertEqual(self.trajectory.read_bytes(), before)
        self.scene.unlink()
        self.expect_done("resume", self.out, *extend)

    def test_refuses_to_resume_what_is_not_a_trajectory(self):
        self.expect_refusal("resume", self.folder, names=["trajectory.h5"])
        (self.folder / "trajectory.h5").write_text("text")
        self.expect_refusal("resume", self.folder, names=["trajectory.h5", "not an HDF5 file"])
        with h5py.File(self.folder / "trajectory.h5", "w") as file:
            file["something"] = [1, 2, 3]
        for command in ("resume", "flow", "observe", "export"):
            self.expect_refusal(command, self.folder, names=["trajectory.h5"])
        with h5py.File(self.folder / "trajectory.h5") as file:
            self.assertEqual(list(file), ["something"])

    def test_refuses_a_truncated_trajectory(self):
        self.run_scene(BALL, "--set", "run.end_time=0.5")
        whole = self.trajectory.read_bytes()
        for part in (0, 100, len(whole) // 2, len(whole) - 10):
            self.trajectory.write_bytes(whole[:part])
            for command in ("resume", "flow", "observe", "export"):
                self.expect_refusal(command, self.out, names=["trajectory.h5"])
            self.assertEqual(self.trajectory.read_bytes(), whole[:part])

    def test_a_full_disk_is_one_line(self):
        self.scene.write_text(BALL)

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, 150_000))

        self.expect_refusal("run", self.scene, "-o", self.out, "--set", "output.interval=0.01", preexec_fn=limit,
                            names=["cannot be written", "asterflow resume"])
        self.expect_done("resume", self.out)


class Results(SceneTest):
    def test_mobility_of_a_sphere(self):
        self.scene.write_text(BALL)
        result = json.loads(self.expect_done("mobility", self.scene).stdout)
        body = result["bodies"][0]
        self.assertEqual(body["name"], "ball")
        drag, torque = 6 * math.pi * 2 * 1.5, 8 * math.pi * 2 * 1.5**3
        exact = np.diag([drag] * 3 + [torque] * 3)
        np.testing.assert_allclose(body["resistance"], exact, atol=1e-5 * drag)
        np.testing.assert_allclose(body["mobility"], np.linalg.inv(exact), atol=1e-5 / drag)

    def test_check_says_what_will_be_modelled(self):
        self.scene.write_text(ASTER)
        text = self.expect_done("check", self.scene).stdout
        for word in ("valid", "core", "fibers", "5", "interactions", "local", "unknowns", "evaluators", "first step", "memory"):
            self.assertIn(word, text)

    def test_check_warns_of_what_the_nodes_cannot_resolve(self):
        self.scene.write_text(CELL)
        self.assertNotIn("note", self.expect_done("check", self.scene, "--quick").stdout)
        text = self.expect_done("check", self.scene, "--quick", "--set", "body.0.order=6").stdout
        self.assertIn('"ball": order 6 resolves flows to about', text)
        self.assertNotIn("periphery: order", text)

    def test_flow_around_a_sphere_in_a_cell(self):
        self.run_scene(CELL, "--set", "run.end_time=0.5")
        result = self.expect_done("flow", self.out, "--plane", "z=0", "--grid", "21x11", "--window", "-4", "4", "-2", "2")
        written = result.stdout.split()
        with h5py.File(written[0]) as file:
            velocity = file["velocity"][:]
            self.assertEqual(velocity.shape, (11, 21, 3))
            inside = file["body_distance"][:] < 0
            speed = 3 / (6 * math.pi * 2 * 1.5)
            self.assertTrue((velocity[inside][:, 0] < speed).all())  # the cell holds it back
            self.assertTrue((velocity[inside][:, 0] > 0.1 * speed).all())
            fluid = (file["body_distance"][:] > 0) & (file["periphery_distance"][:] < 0)
            self.assertTrue((np.linalg.norm(velocity[fluid], axis=1) < speed).all())
        self.assertTrue(written[1].endswith(".vts"))
        self.assertEqual(self.expect_done("flow", self.out, "--plane", "z=2.9", "--grid", "11x11").stderr, "")  # no body there

    def test_a_full_disk_leaves_the_flow_of_before(self):
        self.run_scene(CELL, "--set", "run.end_time=0.5")
        numbers = Path(self.expect_done("flow", self.out, "--grid", "11x11").stdout.split()[0])
        before = numbers.read_bytes()

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) // 2, len(before) // 2))

        self.expect_refusal("flow", self.out, "--grid", "11x11", preexec_fn=limit, names=["cannot be written"])
        self.assertEqual(numbers.read_bytes(), before)
        self.assertEqual(list(self.out.glob("*.part")), [])

    def test_pictures_need_python_but_numbers_do_not(self):
        self.run_scene(CELL, "--set", "run.end_time=0.5")
        without = os.environ | {"ASTERFLOW_PYTHON": "/absent/python3"}
        result = self.expect_done("flow", self.out, "--grid", "11x11", env=without)
        self.assertIn("no picture", result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1)

    def test_flow_refuses_what_it_does_not_know(self):
        self.run_scene(BALL, "--set", "run.end_time=0.5")
        self.expect_refusal("flow", self.out, "--plane", "w=0", names=["--plane", "z=VALUE"])
        self.expect_refusal("flow", self.out, "--grid", "10", names=["--grid"])
        self.expect_refusal("flow", self.out, "--time", "0", names=["later --time"])
        self.expect_refusal("flow", self.out, "--time", "nan", names=["--time"])
        self.expect_refusal("flow", self.out, "--window", "0", "inf", "0", "1", names=["--window"])
        self.expect_refusal("flow", self.folder / "absent", names=["trajectory.h5"])

    def test_export_writes_every_state(self):
        self.run_scene(ASTER, "--set", "run.end_time=0.5")
        collection = self.expect_done("export", self.out).stdout.strip()
        text = Path(collection).read_text()
        self.assertEqual(text.count("fibers_"), 3)
        self.assertEqual(text.count("bodies_"), 3)
        self.assertIn(b"Lines", (self.out / "paraview" / "fibers_000000.vtp").read_bytes())


if __name__ == "__main__":
    unittest.main()
