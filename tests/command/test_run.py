"""asterflow run and resume: what is stored, exact resuming, and runs that stop."""

import math
import re
import subprocess
import time
import unittest

import h5py
import numpy as np

from program import ASTERFLOW
from scene_test import ASTER, BALL, CELL, SceneTest, contents


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

    def test_an_extended_run_that_is_interrupted_goes_on_to_its_new_end(self):
        self.run_scene(ASTER)
        whole = contents(self.trajectory)
        self.out = self.folder / "extended"
        self.run_scene(ASTER, "--set", "run.end_time=0.5")
        process = subprocess.Popen([ASTERFLOW, "resume", self.out, "--set", "run.end_time=3"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        before = (self.out / "trajectory.h5").stat().st_ino
        while (self.out / "trajectory.h5").stat().st_ino == before and process.poll() is None:
            time.sleep(0.001)
        process.kill()
        process.wait()
        self.expect_done("resume", self.out)
        parts = contents(self.out / "trajectory.h5")
        self.assertEqual(whole.keys(), parts.keys())
        for name in whole:
            self.assertEqual(np.asarray(whole[name]).tobytes(), np.asarray(parts[name]).tobytes(), name)

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


if __name__ == "__main__":
    unittest.main()
