"""Tests the wheel that pip makes in the source tree: it works alone, without the variable that names a library.

PYTHONPATH: models/library/python; PALPATE_LIBRARY: the library."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

import install


class Wheel(unittest.TestCase):
    def test_has_package_and_library(self):
        with tempfile.TemporaryDirectory() as folder:
            wheel = install.build_wheel(folder)
            with zipfile.ZipFile(pathlib.Path(folder) / wheel) as archive:
                archive.extractall(folder)
            bare = {key: value for key, value in os.environ.items() if key != "PALPATE_LIBRARY"}
            code = "import palpate; print(palpate.__file__, palpate.Limiter().force(1, 1e-3))"
            done = subprocess.run([sys.executable, "-c", code], env={**bare, "PYTHONPATH": folder},
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertIn(folder, done.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "--quiet"])
