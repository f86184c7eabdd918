"""The studies of the paper's figures run, are resumed, and leave a picture and a record."""

import json
import subprocess
import sys
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from program import ASTERFLOW, CommandTest

STUDIES = Path(__file__).resolve().parents[2] / "studies"


class Studies(CommandTest):
    def study(self, figure, *options):
        """Records of a study, by quantity."""
        done = subprocess.run([sys.executable, STUDIES / f"{figure}.py", "--program", ASTERFLOW, "--output", self.folder,
                               "--quick", *map(str, options)], capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / f"{figure}.png").exists())
        records = json.loads((self.folder / f"{figure}.json").read_text())["records"]
        return {record["quantity"]: record["asterflow"] for record in records}

    def test_the_torque_instability_has_the_signs_of_figure_10(self):
        records = self.study("figure10")
        for law in ("free_sliding", "no_sliding"):
            signs = [word.strip()[0] for word in records[f"{law}: growth rates there over Omega_0"].split(",")]
            self.assertEqual(signs, ["+", "-", "+"])

    def test_a_mechanism_runs_and_goes_on(self):
        first = self.study("figure06", "--fibers", 6, "--end-time", 6)
        self.assertIn("not within 0.1 min", first["time to within 1 um of the centre"])
        longer = self.study("figure06", "--fibers", 6, "--end-time", 12)
        self.assertIn("not within 0.2 min", longer["time to within 1 um of the centre"])

    def test_bad_options_are_refused_in_one_line(self):
        def refusal(script, *options):
            done = subprocess.run([sys.executable, STUDIES / script, *options], capture_output=True, text=True, timeout=60)
            self.assertNotEqual(done.returncode, 0, options)
            self.assertNotIn("Traceback", done.stderr)
            return done.stderr.splitlines()[-1]

        def last_line(*options):
            return refusal("figure06.py", "--program", ASTERFLOW, "--output", self.folder, "--quick", *options)

        for options, words in ((("--program", "/nowhere/asterflow"), "/nowhere/asterflow is not a program"),
                               (("--output", "/proc/nowhere"), "--output: No such file or directory"),
                               (("--fibers", "0"), "--fibers: 0 is not a number from 2 on"),
                               (("--end-time", "nan"), "--end-time: nan is not a number from 0.1 on"),
                               (("--seeds", "-1"), "--seeds: -1 is not"),
                               (("--set", "accuracy"), "accuracy is not KEY=VALUE"),
                               (("--set", "run.colour=3"), 'unknown key "colour"'),
                               (("--drawing-only",), "has not been run: leave out --drawing-only")):
            self.assertIn(words, last_line(*options))
        self.assertIn("--minutes: -3 is not", refusal("straight_pushing.py", "--minutes", "-3"))
        self.assertIn("--sites: 0 is not", refusal("straight_pulling.py", "--sites", "0"))
        self.assertIn("is not the folder of a run", refusal("turning.py", self.folder))

    def test_a_plus_end_is_back_at_the_cortex_after_the_expected_time(self):
        sys.path.insert(0, str(STUDIES))
        from straight_pulling import return_time

        chance, gap, catastrophe, rescue, speed = np.random.default_rng(1), 15.0, 0.0625, 0.02, 0.5

        def walk():
            place, time, grows = gap, 0.0, False
            while True:
                path = speed * chance.exponential(1 / (catastrophe if grows else rescue))
                if grows and place + path >= gap:
                    return time + (gap - place) / speed
                path = path if grows else min(path, place)
                place, time, grows = place + (path if grows else -path), time + path / speed, not grows

        times = [walk() for _ in range(2000)]
        options = SimpleNamespace(growth=speed, shrinkage=speed, rescue=rescue)
        self.assertLess(abs(np.mean(times) - return_time(options, gap)), 4 * np.std(times) / len(times)**0.5)

    def test_an_exponential_turn_has_its_growth_rate(self):
        sys.path.insert(0, str(STUDIES))
        from turning import growth

        times = np.arange(0, 100, 0.1)
        rate, _, end = growth(times, 0.01 * np.exp(0.05 * times))
        self.assertAlmostEqual(rate, 0.05, delta=2e-4)  # forward differences: g dt / 2 of it
        self.assertAlmostEqual(end, np.log(60) / 0.05, delta=0.1)

    def test_straight_microtubules_push_the_complex_inwards(self):
        done = subprocess.run([sys.executable, STUDIES / "straight_pushing.py", "--translation", "100", "--minutes", "10",
                               "--law", "viscous", "--fibers", "200", "--seeds", "1"], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("2 um nan", done.stdout)


if __name__ == "__main__":
    unittest.main()
