"""What the package needs: the numpy that the pybind11 of the build knows."""

import importlib.util
import subprocess
import sys
import unittest

from tests.python.support import SOURCE, needs


class Numpy(unittest.TestCase):
    @needs("setuptools")
    def test_numpy_2_is_allowed_where_pybind11_knows_it(self):
        spec = importlib.util.spec_from_file_location("setup_of_glidelab", SOURCE / "setup.py")
        setup = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(setup)
        for pybind11, numpy in (("2.10.3", "numpy>=1.24,<2"), ("2.11.1", "numpy>=1.24,<2"), ("2.12.0", "numpy>=1.24"),
                                ("2.13.6", "numpy>=1.24"), ("3.0.0", "numpy>=1.24")):
            self.assertEqual(setup.numpy_for(pybind11), numpy)

    def test_a_numpy_that_the_module_would_misread_is_refused(self):
        from glidelab import _glidelab
        from glidelab._checks import refuse_numpy
        refuse_numpy((2, 10), "1.26.4")
        refuse_numpy((2, 12), "2.1.0")
        with self.assertRaises(ImportError):
            refuse_numpy((2, 11), "2.1.0")
        done = subprocess.run([sys.executable, "-c", "import numpy; numpy.__version__ = '2.1.0'; import glidelab"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode != 0, _glidelab.pybind11_version < (2, 12))
        if done.returncode != 0:
            self.assertIn("install numpy<2", done.stderr)

    def test_no_source_uses_what_numpy_2_removed(self):
        import re
        gone = re.compile(r"\b(?:np|numpy)\.(?:float_|complex_|unicode_|string_|trapz|in1d|row_stack|product|cumproduct|"
                          r"alltrue|sometrue|Inf|Infinity|NaN|NAN|infty|PINF|NINF|asfarray|find_common_type|cast|"
                          r"msort|round_|core|bool8|safe_eval|sctypes|obj2sctype)\b|copy=False")
        for folder in ("python", "examples", "bench", "tools", "docs"):
            for path in sorted((SOURCE / folder).rglob("*")):
                if path.suffix in (".py", ".ipynb", ".md"):
                    self.assertEqual(gone.findall(path.read_text()), [], path)
