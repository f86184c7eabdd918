"""Every scene of the repository is valid and runs, shortened; so does the drag study."""

import csv
import resource
import unittest
from pathlib import Path

import h5py

from program import CommandTest

SCENES = Path(__file__).resolve().parents[2] / "scenes"


def shortened(scene, **settings):
    """--set options that make a scene run in seconds."""
    settings = {"run.accuracy": 1e-2, "run.end_time": 0.03, "output.interval": 0.02, "output.picture": "false"} | settings
    n_aster = scene.read_text().count("[[aster]]")
    settings |= {f"aster.{i}.count": 4 for i in range(n_aster)}
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


class Scenes(CommandTest):
    def test_every_scene_runs(self):
        scenes = sorted(SCENES.glob("*.toml"))
        self.assertGreater(len(scenes), 3)
        for scene in scenes:
            with self.subTest(scene.name):
                self.expect_done("check", scene, "--quick")
                out = self.folder / scene.stem
                self.expect_done("run", scene, "-o", out, *shortened(scene))
                with h5py.File(out / "trajectory.h5") as file:
                    self.assertEqual(len(file["time"]), 3)

    def test_the_drag_study_writes_a_table_and_a_picture(self):
        out = self.folder / "drag"
        scene = SCENES / "figure2.toml"
        study = {"drag.fiber_counts": "[0, 6]", "drag.settling_time": 0, "drag.duration": 0.02, "drag.samples": 1}
        words = [*shortened(scene), *[w for k, v in study.items() for w in ("--set", f"{k}={v}")]]
        self.expect_done("drag", scene, "-o", out, *words)
        with open(out / "drag.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["level"], row["fibers"]) for row in rows],
                         [(level, n) for level in ("local", "open", "confined") for n in ("0", "6")])
        drag = {(row["level"], row["fibers"]): float(row["translation_drag"]) for row in rows}
        self.assertAlmostEqual(drag["local", "0"], 1.0, delta=1e-3)
        self.assertAlmostEqual(drag["open", "0"], 1.0, delta=1e-2)
        self.assertGreater(drag["confined", "0"], 1.5)
        table = (out / "drag.csv").read_text()
        (out / "drag.csv").write_text("".join(table.splitlines(keepends=True)[:-1]))  # as if interrupted
        again = self.expect_done("drag", scene, "-o", out, *words).stderr
        self.assertEqual(again.count("translation"), 1)
        with open(out / "drag.csv", newline="") as file:
            self.assertEqual([row["translation_drag"] for row in csv.DictReader(file)], [row["translation_drag"] for row in rows])
        self.expect_refusal("drag", scene, "-o", out, names=["drag.csv", "is there already"])

    def test_the_drag_study_refuses_what_it_cannot_study(self):
        scene = SCENES / "sphere.toml"
        self.expect_refusal("drag", scene, "-o", self.folder / "drag", names=["[drag]", "periphery"])
        self.expect_refusal("drag", SCENES / "figure2.toml", "--set", "drag.body=pcn", names=["[drag]", "pcn", "pnc"])
        local = ("-o", self.folder / "drag", "--set", "drag.levels=['local']")
        self.expect_refusal("drag", scene, *local, "--set", "background.shear_rate=1", names=["[background]", "at rest"])
        driven = self.folder / "driven.toml"
        driven.write_text('[[body]]\nname = "ball"\nshape = "sphere"\nradius = 1\nmotion = "prescribed"\n')
        self.expect_refusal("drag", driven, *local, names=["ball", "motion", "free"])

    def test_the_torque_instability_writes_a_table_and_a_picture(self):
        out = self.folder / "torque"
        scene = SCENES / "torque_instability.toml"
        self.expect_refusal("torque", scene, "-o", out, "--angles", 5, names=["torque.csv", "cannot be written"],
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)))  # a full disk
        printed = self.expect_done("torque", scene, "-o", out, "--angles", 5).stdout
        self.assertEqual([line.split()[-1] for line in printed.splitlines()[:3]], ["unstable", "stable", "unstable"])
        with open(out / "torque.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["angle_degrees"]) for row in rows], [-90, -45, 0, 45, 90])
        self.assertTrue((out / "torque.png").exists())
        self.expect_refusal("torque", scene, "-o", out, names=["torque.csv", "is there already"])
        self.expect_refusal("torque", SCENES / "sphere.toml", "-o", self.folder / "none", names=["periphery"])


if __name__ == "__main__":
    unittest.main()
