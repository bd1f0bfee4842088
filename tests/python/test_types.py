"""The package and its stubs are clean under mypy --strict."""

import dataclasses
import inspect
import os
import re
import subprocess
import sys

import numpy as np

import glidelab
from tests.python.support import SOURCE, InFolder, needs


class Types(InFolder):
    def accepted(self, code):
        """mypy --strict finds nothing in a file that uses the package."""
        done = subprocess.run(["mypy", "--strict", "--python-executable", sys.executable, "--cache-dir",
                               str(self.folder), str(code)], capture_output=True, text=True, check=False,
                              env={**os.environ, "MYPYPATH": str(SOURCE / "python")})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    @needs("mypy program")
    def test_mypy_strict_finds_nothing(self):
        done = subprocess.run(["mypy", "--strict", "--python-executable", sys.executable, "--cache-dir",
                               str(self.folder), str(SOURCE / "python" / "glidelab")],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    @needs("mypy program")
    def test_what_a_user_writes_is_accepted(self):
        mine = self.folder / "mine.py"
        mine.write_text('''
from collections.abc import Sequence
import numpy as np
import glidelab

track = glidelab.simulate("scenario.toml").clips[0].track(noise_m=2e-5)
t, x = track.t_s, track.x_m
h = glidelab.choose_bandwidth(t[:100], x[:100])
glidelab.smooth(t, x, h)
glidelab.analyze(t, x, bandwidth=h)
glidelab.coverage("scenario.toml", bandwidth_s=h)
glidelab.certify("folder", bandwidth_s=h)
print(t.mean(), glidelab.Track([0.0, 1.0], [0.0, 1.0]).x_m.mean())

@glidelab.estimator
def mine(tracks: list[glidelab.Track]) -> dict[str, float]:
    return {"mu": float(np.diff(tracks[0].x_m[::2]).mean())}

@glidelab.estimator
def other(tracks: Sequence[glidelab.Track]) -> dict[str, tuple[float, float]]:
    return {"mu": (0.0, 1.0)}

@glidelab.estimator
def third(tracks: list[glidelab.Track]) -> dict[str, object]:
    return {"mu": {"value": 0.0, "sd": 1.0, "interval95": None}, "alpha_deg": None}

judged = glidelab.judge("scenario.toml", mine, other, third, noise_m=2e-5)
judged.write("folder")
glidelab.check(track).write("folder")
glidelab.certify(t, x, twins=20)
print(glidelab.explain(judged), glidelab.explain(glidelab.smooth(t, x, 0.02)))
''')
        self.accepted(mine)

    @needs("mypy program")
    def test_the_guide_s_own_code_is_accepted(self):
        text = (SOURCE / "docs" / "guide" / "python.md").read_text()
        code = self.folder / "guide.py"
        code.write_text("\n".join(re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)))
        self.assertIn("import glidelab", code.read_text())
        self.accepted(code)

    def test_a_track_of_any_array_like_holds_arrays(self):
        track = glidelab.Track([0, 1, 2], (0.0, 0.5, 1.0), force_n=range(3))
        for values in (track.t_s, track.x_m, track.force_n):
            self.assertEqual((type(values), values.dtype), (np.ndarray, np.dtype(float)))
        x = np.arange(3.0)
        self.assertIs(glidelab.Track(x, x).x_m, x)
        masked = glidelab.Track(x, np.ma.masked_greater(x, 1.0)).x_m
        self.assertEqual(masked.mask.tolist(), [False, False, True])
        self.assertEqual(dataclasses.replace(track, name="up").t_s.tolist(), [0.0, 1.0, 2.0])
        for wrong in (["one"] * 9, [[0.0], [0.0, 1.0]], None):  # made all the same, and refused where it is used
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.analyze(glidelab.Track(np.arange(9.0), wrong))
            self.assertEqual(caught.exception.key, "x_m")

    def test_every_name_without_an_underscore_is_public(self):
        names = {name for name, value in vars(glidelab).items() if not name.startswith("_") and not inspect.ismodule(value)}
        self.assertEqual(names, set(glidelab.__all__))

    def test_every_public_name_has_a_docstring(self):
        for name in glidelab.__all__:
            self.assertTrue(getattr(glidelab, name).__doc__, name)
