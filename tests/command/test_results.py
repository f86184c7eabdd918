"""asterflow check, mobility, flow, export and observe: what they answer."""

import csv
import json
import math
import os
import resource
import unittest
from pathlib import Path

import h5py
import numpy as np

from scene_test import ASTER, BALL, CELL, SceneTest


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

    def test_check_says_what_repels(self):
        self.scene.write_text(ASTER + "[steric_repulsion]\nfiber_cortex = false\nfiber_body = true\nbody_cortex = false\n")
        self.assertIn("within 0.05 um: fibers and bodies\n", self.expect_done("check", self.scene, "--quick").stdout)

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
