"""The trajectory survives a kill at any instant and a full disk."""

import fcntl
import os
import random
import resource
import shutil
import subprocess
import time
import unittest

import h5py

from program import CommandTest

APPEND_STATES = os.environ["APPEND_STATES"]


class Trajectory(CommandTest):
    def setUp(self):
        super().setUp()
        self.run_folder = self.folder / "run"

    def start(self, count, **options):
        return subprocess.Popen([APPEND_STATES, self.run_folder, str(count)], stderr=subprocess.PIPE, text=True, **options)

    def finish(self, count, **options):
        process = self.start(count, **options)
        _, errors = process.communicate(timeout=120)
        return process.returncode, errors

    def seconds_of_a_first_run(self):
        begun = time.monotonic()
        self.assertEqual(self.finish(1), (0, ""))
        shutil.rmtree(self.run_folder)
        return time.monotonic() - begun

    def check_whole(self):
        """Every state is there and right; returns how many there are."""
        with h5py.File(self.run_folder / "trajectory.h5") as file:
            self.assertEqual(file["header/scene"][()].decode(), "[fluid]\n")
            n = len(file["time"]) if "time" in file else 0
            self.assertEqual(len(file["frames"]) if n else 0, n)
            for i in range(n):
                x = file[f"frames/{i:06}/fiber/position"]
                self.assertEqual((x.attrs["unit"], x.shape), (b"um", (50 + i * 37 % 400, 3)))
                self.assertTrue((x[:] == [i, 2, 3]).all())
                self.assertEqual(file["time"][i], 0.5 * i)
            if n:
                self.assertEqual(file["restart/index"][0], n - 1)
                self.assertTrue((file["restart/fiber/state"][:, 0] == n - 1).all())
            return n

    def test_a_kill_at_any_instant_leaves_a_whole_file_that_goes_on(self):
        chance = random.Random(1)
        start_up = self.seconds_of_a_first_run()
        stored = 0
        for _ in range(60):
            process = self.start(10**6)
            time.sleep(start_up * (0.3 + 2 * chance.random()))  # before, during and after the first append
            process.kill()
            process.communicate()
            if not (self.run_folder / "trajectory.h5").exists():
                continue  # killed before the first file was complete
            now = self.check_whole()
            self.assertGreaterEqual(now, stored)
            stored = now
        self.assertGreater(stored, 0)
        self.assertEqual(self.finish(stored + 3), (0, ""))
        self.assertEqual(self.check_whole(), stored + 3)
        self.assertEqual(sorted(p.name for p in self.run_folder.iterdir()), ["trajectory.h5"])

    def test_a_full_disk_loses_nothing_that_was_stored(self):
        def limit_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, 400_000))

        code, errors = self.finish(1000, preexec_fn=limit_files)
        self.assertEqual(code, 1)
        self.assertEqual(len(errors.strip().splitlines()), 1, errors)
        self.assertIn("asterflow resume", errors)
        stored = self.check_whole()
        self.assertGreater(stored, 3)
        self.assertEqual(self.finish(stored + 5), (0, ""))
        self.assertEqual(self.check_whole(), stored + 5)

    def test_reading_does_not_disturb_the_writer(self):
        process = self.start(300)
        while not (self.run_folder / "trajectory.h5").exists():
            time.sleep(0.01)
        while process.poll() is None:
            self.check_whole()
        self.assertEqual(process.communicate()[1], "")
        self.assertEqual(self.check_whole(), 300)

    def test_refuses_two_writers_at_once(self):
        process = self.start(10**6)
        while not (self.run_folder / "trajectory.h5").exists():
            time.sleep(0.01)
        code, errors = self.finish(5)
        process.kill()
        process.communicate()
        self.assertEqual(code, 1)
        self.assertIn("another asterflow", errors)

    def test_leaves_alone_a_run_that_has_no_state_yet(self):
        self.run_folder.mkdir()
        second_copy = self.run_folder / "trajectory-next.h5"
        second_copy.write_text("being written")
        folder = os.open(self.run_folder, os.O_RDONLY)
        fcntl.flock(folder, fcntl.LOCK_EX)
        code, errors = self.finish(5)
        os.close(folder)
        self.assertEqual(code, 1)
        self.assertIn("another asterflow", errors)
        self.assertEqual(second_copy.read_text(), "being written")

    def test_a_run_without_states_shows_nothing(self):
        self.assertEqual(self.finish(0), (0, ""))
        for command in ("flow", "observe", "export"):
            self.expect_refusal(command, self.run_folder, names=["holds no states", f"asterflow resume {self.run_folder}"])
        self.assertEqual(sorted(p.name for p in self.run_folder.iterdir()), ["trajectory.h5"])

    def test_refuses_a_folder_with_other_things_in_it(self):
        self.run_folder.mkdir()
        (self.run_folder / "thesis.txt").write_text("precious")
        code, errors = self.finish(5)
        self.assertEqual(code, 1)
        self.assertIn("is not empty", errors)
        self.assertEqual((self.run_folder / "thesis.txt").read_text(), "precious")

    def test_refuses_a_folder_that_cannot_be_made(self):
        (self.folder / "run").write_text("a file")
        code, errors = self.finish(5)
        self.assertEqual((code, "is a file" in errors), (1, True), errors)

    def test_refuses_a_truncated_or_foreign_trajectory(self):
        self.assertEqual(self.finish(5), (0, ""))
        path = self.run_folder / "trajectory.h5"
        whole = path.read_bytes()
        for content in (whole[: len(whole) // 2], whole[:10], b"", b"text"):
            path.write_bytes(content)
            code, errors = self.finish(10)
            self.assertEqual((code, len(errors.strip().splitlines())), (1, 1), errors)
            self.assertEqual(path.read_bytes(), content)
        path.unlink()
        with h5py.File(path, "w") as file:
            file["something"] = 1
        code, errors = self.finish(10)
        self.assertEqual((code, "is not a trajectory" in errors), (1, True), errors)


if __name__ == "__main__":
    unittest.main()
