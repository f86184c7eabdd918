"""Every kind of bad input to the commands that take a scene or a run: one line that names the place, and nothing lost."""

import resource
import unittest

import h5py

from scene_test import BALL, CELL, SceneTest


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

    def test_refuses_a_drag_study_without_asters_before_it_starts(self):
        self.scene.write_text(CELL)
        self.expect_refusal("drag", self.scene, "-o", self.out, names=["[drag]", "fiber_counts", "[[aster]]"])
        self.assertFalse((self.out / "drag.csv").exists())

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


if __name__ == "__main__":
    unittest.main()
