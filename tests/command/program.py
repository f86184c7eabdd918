"""Runs the asterflow program for the tests of its commands; its path is in the environment variable ASTERFLOW."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ASTERFLOW = os.environ["ASTERFLOW"]


def asterflow(*arguments, **options):
    """Result with returncode, stdout, stderr of `asterflow arguments...`."""
    return subprocess.run([ASTERFLOW, *map(str, arguments)], capture_output=True, text=True, timeout=600, **options)


class CommandTest(unittest.TestCase):
    """A test with an empty folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def expect_done(self, *arguments, **options):
        result = asterflow(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def expect_refusal(self, *arguments, names=(), **options):
        """Exit code 1 and one line on stderr that contains every string of `names`."""
        result = asterflow(*arguments, **options)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for name in names:
            self.assertIn(str(name), result.stderr)
        return result
