"""What tests of a scene share: scenes, and a folder in which they run."""

import h5py

from program import CommandTest

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
