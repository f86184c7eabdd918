"""asterflow sum: results against numpy, and every kind of bad input."""

import json
import os
import resource
import unittest

import h5py
import numpy as np

from program import CommandTest, asterflow


def stokeslet(sources, targets, strengths, viscosity):
    r = targets[:, None, :] - sources[None, :, :]
    distance = np.linalg.norm(r, axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = np.where(distance > 0, 1 / distance, 0)
    along = np.einsum("mnk,nk->mn", r, strengths)
    return (np.einsum("mn,nk->mk", s, strengths) + np.einsum("mn,mnk->mk", along * s**3, r)) / (8 * np.pi * viscosity)


class Sum(CommandTest):
    def setUp(self):
        super().setUp()
        self.input = self.folder / "points.h5"
        self.output = self.folder / "u.h5"
        random = np.random.default_rng(1)
        self.points = {
            "sources": random.random((300, 3)),
            "targets": random.random((50, 3)),
            "strengths": random.standard_normal((300, 3)),
            "normals": random.standard_normal((300, 3)),
        }

    def write(self, **changed):
        with h5py.File(self.input, "w") as file:
            for name, array in (self.points | changed).items():
                if array is not None:
                    file[name] = array

    def sum(self, *options, **how):
        return self.expect_done("sum", "-i", self.input, "-o", self.output, *options, **how)

    def refused(self, *options, names=()):
        result = self.expect_refusal("sum", "-i", self.input, "-o", self.output, *options, names=names)
        self.assertFalse(self.output.exists())
        return result

    def velocity(self):
        with h5py.File(self.output) as file:
            return file["velocity"][:]

    def test_agrees_with_numpy_at_any_viscosity(self):
        self.write()
        self.sum("--kernel", "stokeslet", "--accuracy", "1e-12", "--viscosity", "2.5")
        exact = stokeslet(self.points["sources"], self.points["targets"], self.points["strengths"], 2.5)
        self.assertLess(np.linalg.norm(self.velocity() - exact), 1e-11 * np.linalg.norm(exact))

    def test_sources_are_the_targets_when_none_are_given(self):
        self.write(targets=None)
        self.sum("--accuracy", "1e-12")
        sources = self.points["sources"]
        exact = stokeslet(sources, sources, self.points["strengths"], 1.0)
        self.assertLess(np.linalg.norm(self.velocity() - exact), 1e-11 * np.linalg.norm(exact))

    def test_stresslet_is_linear_in_the_normal_and_free_of_viscosity(self):
        self.write()
        self.sum("--kernel", "stresslet", "--accuracy", "1e-12")
        plain = self.velocity()
        self.write(normals=3 * self.points["normals"])
        self.sum("--kernel", "stresslet", "--accuracy", "1e-12", "--viscosity", "7")
        self.assertLess(np.linalg.norm(self.velocity() - 3 * plain), 1e-11 * np.linalg.norm(plain))

    def test_writes_the_gradient_of_the_velocity(self):
        self.write()
        self.sum("--accuracy", "1e-9", "--gradient", "--viscosity", "2")
        with h5py.File(self.output) as file:
            gradient = file["gradient"][:]
        step = 1e-5
        for axis in range(3):
            moved = [self.points["targets"] + side * step * np.eye(3)[axis] for side in (-1, 1)]
            low, high = (stokeslet(self.points["sources"], x, self.points["strengths"], 2.0) for x in moved)
            difference = (high - low) / (2 * step)
            # second order in the step over the distance of the closest pair
            self.assertLess(np.linalg.norm(gradient[:, :, axis] - difference), 1e-4 * np.linalg.norm(difference))

    def test_writes_the_pressure(self):
        def pressure(*options):
            self.sum("--accuracy", "1e-9", "--pressure", "--viscosity", "2", *options)
            with h5py.File(self.output) as file:
                return file["pressure"][:]

        self.write()
        r = self.points["targets"][:, None, :] - self.points["sources"][None, :, :]
        s = 1 / np.linalg.norm(r, axis=2)
        q, n = self.points["strengths"], self.points["normals"]
        rq, rn = (np.einsum("mnk,nk->mn", r, v) for v in (q, n))
        exact = (rq * s**3).sum(axis=1) / (4 * np.pi)
        self.assertLess(np.linalg.norm(pressure() - exact), 1e-9 * np.linalg.norm(exact))
        exact = -2 / (2 * np.pi) * (3 * rq * rn * s**5 - (q * n).sum(axis=1) * s**3).sum(axis=1)
        self.assertLess(np.linalg.norm(pressure("--kernel", "stresslet") - exact), 1e-9 * np.linalg.norm(exact))
        np.testing.assert_array_equal(pressure("--kernel", "rotlet"), 0)

    def test_sums_pressures_beside_velocities_only(self):
        self.write()
        self.refused("--kernel", "stokeslet_pressure", names=["stokeslet, stresslet, rotlet"])

    def test_does_not_depend_on_the_number_of_threads(self):
        random = np.random.default_rng(2)
        self.write(sources=random.random((5000, 3)), targets=None, strengths=random.standard_normal((5000, 3)))
        for backend in ("direct", "fast"):
            results = []
            for threads in ("1", "2", "2"):
                self.sum("--backend", backend, env=os.environ | {"OMP_NUM_THREADS": threads})
                results.append(self.velocity())
            np.testing.assert_array_equal(results[1], results[2])
            np.testing.assert_allclose(results[0], results[1], rtol=0, atol=1e-13 * np.abs(results[0]).max())

    def test_prints_one_line_of_json(self):
        self.write()
        line = json.loads(self.sum("--reference-error", "--repeat", "2").stdout)
        self.assertEqual((line["n"], line["m"], line["kernel"]), (300, 50, "stokeslet"))
        self.assertLess(line["error"], 1e-6)
        self.assertGreater(line["pairs_per_second"], 0)
        for size in (1e-250, 1e250):  # whose squares are beyond what numbers hold
            self.write(strengths=size * self.points["strengths"], normals=self.points["normals"] / size)
            for kernel in ("stokeslet", "stresslet"):
                line = json.loads(self.sum("--kernel", kernel, "--reference-error").stdout)
                self.assertLess(line["error"], 1e-6)

    def test_prints_json_whatever_the_output_is_called(self):
        self.write()
        self.output = self.folder / 'a "b" \\c.h5'
        self.assertEqual(json.loads(self.sum().stdout)["output"], str(self.output))

    def test_accepts_single_precision_and_whole_numbers(self):
        self.write(sources=np.arange(900).reshape(300, 3), strengths=self.points["strengths"].astype("f4"))
        self.sum()

    def test_no_sources_give_no_velocity(self):
        self.write(sources=np.zeros((0, 3)), strengths=np.zeros((0, 3)))
        self.sum()
        self.assertEqual(np.abs(self.velocity()).max(), 0)

    def test_refuses_a_missing_file(self):
        self.refused(names=[self.input, "no such file"])

    def test_refuses_a_folder(self):
        self.input.mkdir()
        self.refused(names=[self.input, "is a folder"])

    def test_refuses_a_foreign_file(self):
        self.input.write_text("sources\n1 2 3\n")
        self.refused(names=[self.input, "not an HDF5 file"])

    def test_refuses_a_truncated_file(self):
        self.write()
        whole = self.input.read_bytes()
        self.input.write_bytes(whole[: len(whole) // 2])
        self.refused(names=[self.input, "truncated"])

    def test_refuses_a_missing_dataset(self):
        self.write(strengths=None)
        self.refused(names=[self.input, '"strengths"', "is missing"])

    def test_refuses_a_stresslet_without_normals(self):
        self.write(normals=None)
        self.refused("--kernel", "stresslet", names=['"normals"', "is missing"])

    def test_refuses_a_wrong_shape(self):
        self.write(sources=np.zeros((300, 2)))
        self.refused(names=['"sources"', "[300, 2]", "must be [n, 3]"])

    def test_refuses_a_wrong_number_of_strengths(self):
        self.write(strengths=np.zeros((299, 3)))
        self.refused(names=['"strengths"', "299", "300"])

    def test_refuses_words_and_groups(self):
        self.write(sources=np.array([b"a", b"b"]))
        self.refused(names=['"sources"', "must hold numbers"])
        with h5py.File(self.input, "w") as file:
            file.create_group("sources")
        self.refused(names=['"sources"', "is not a dataset"])

    def test_reads_gzip_and_names_compression_that_it_cannot_read(self):
        self.write(strengths=None)
        with h5py.File(self.input, "a") as file:
            file.create_dataset("strengths", data=self.points["strengths"], chunks=(7, 2), compression="gzip", shuffle=True)
        self.sum()
        self.output.unlink()
        self.write(strengths=None)
        with h5py.File(self.input, "a") as file:
            file.create_dataset("strengths", data=self.points["strengths"], compression="lzf")  # h5py's own
        self.refused(names=['"strengths"', "compressed"])

    def test_refuses_numbers_that_are_not_finite(self):
        sources = self.points["sources"].copy()
        sources[7, 1] = np.nan
        self.write(sources=sources)
        self.refused(names=['"sources"', "row 7", "nan"])

    def test_refuses_unknown_names_and_ranges(self):
        self.write()
        self.refused("--kernel", "magic", names=["magic", "stokeslet"])
        self.refused("--backend", "magic", names=["magic", "reference"])
        self.refused("--accuracy", "0", names=["accuracy"])
        self.refused("--accuracy", "nan", names=["accuracy"])
        for viscosity in ("-1", "nan", "inf"):
            self.refused("--viscosity", viscosity, names=["viscosity", "positive and finite"])
        self.refused("--repeat", "0", names=["repeat"])
        self.refused("--magic", names=["--magic"])

    def test_refuses_points_that_need_more_memory_than_there_is(self):
        random = np.random.default_rng(3)
        self.write(sources=random.random((400000, 3)), targets=None, strengths=np.ones((400000, 3)))
        for backend, limit in ("fast", 300 << 20), ("direct", 100 << 20):  # bytes: enough to start and to read the points
            how = {
                "env": os.environ | {"OMP_NUM_THREADS": "1"},
                "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
            }
            if asterflow("--help", **how).returncode != 0:
                self.skipTest("a program built with sanitizers takes more to start")
            self.expect_refusal("sum", "-i", self.input, "-o", self.output, "--backend", backend, "--accuracy", "1e-9",
                                names=["not enough memory"], **how)

    def test_refuses_an_output_that_cannot_be_written(self):
        self.write()
        self.expect_refusal("sum", "-i", self.input, "-o", self.folder / "absent" / "u.h5", names=["does not exist"])
        self.expect_refusal("sum", "-i", self.input, "-o", self.folder, names=["is a folder"])
        before = self.input.read_bytes()
        self.expect_refusal("sum", "-i", self.input, "-o", self.input, names=["is the input file"])
        self.assertEqual(self.input.read_bytes(), before)
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        self.expect_refusal("sum", "-i", self.input, "-o", pipe, names=["is a device"])
        self.assertTrue(pipe.is_fifo())


class Program(CommandTest):
    def test_explains_itself(self):
        self.assertIn("sum", self.expect_done("--help").stdout)
        self.assertIn("Examples", self.expect_done("sum", "--help").stdout)

    def test_refuses_an_unknown_command(self):
        self.expect_refusal("magic", names=["magic", "--help"])
        self.expect_refusal(names=["--help"])


if __name__ == "__main__":
    unittest.main()
