"""The package and its stubs are clean under mypy --strict."""

import subprocess
import sys

from tests.python.support import SOURCE, InFolder, needs


class Types(InFolder):
    @needs("mypy program")
    def test_mypy_strict_finds_nothing(self):
        done = subprocess.run(["mypy", "--strict", "--python-executable", sys.executable, "--cache-dir",
                               str(self.folder), str(SOURCE / "python" / "glidelab")],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_public_name_has_a_docstring(self):
        import glidelab
        for name in glidelab.__all__:
            self.assertTrue(getattr(glidelab, name).__doc__, name)
