"""A confined scene gives the same trajectory whoever sums the pairs."""

import unittest

import h5py
import numpy as np

from program import CommandTest

SCENE = """
[periphery]
shape = "ellipsoid"
semi_axes = [25.0, 15.0, 15.0]

[[body]]
name = "pnc"
shape = "sphere"
radius = 5.0
position = [10.0, 0.0, 0.0]
force = [-10.0, 0.0, 0.0]

[[aster]]
body = "pnc"
position = [0.0, 5.0, 0.0]
centrosome_radius = 1.0
arrangement = "even"
count = 60
nodes = 32
length = 6.0

[run]
accuracy = 1e-4
adaptive = false
time_step = 0.01
end_time = 0.02

[output]
picture = false
"""


class Evaluators(CommandTest):
    def final_state(self, evaluator):
        scene = self.folder / "scene.toml"
        scene.write_text(SCENE)
        run = self.folder / evaluator
        self.expect_done("run", scene, "-o", run, "--set", f"run.evaluator={evaluator}")
        with h5py.File(run / "trajectory.h5") as file:
            last = file["frames"][max(file["frames"])]
            return {name: last[name][:] for name in ("body/velocity", "fiber/position", "fiber/tension")}

    def test_direct_and_fast_sums_give_the_same_trajectory(self):
        direct, fast = (self.final_state(evaluator) for evaluator in ("direct", "fast"))
        for name, array in direct.items():
            self.assertLess(np.abs(fast[name] - array).max(), 1e-4 * np.abs(array).max(), name)


if __name__ == "__main__":
    unittest.main()
