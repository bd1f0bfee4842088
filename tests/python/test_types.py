"""The package and its stubs are clean under mypy --strict."""

import os
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

@glidelab.estimator
def mine(tracks: list[glidelab.Track]) -> dict[str, float]:
    return {"mu": float(np.diff(tracks[0].x_m[::2]).mean())}

@glidelab.estimator
def other(tracks: Sequence[glidelab.Track]) -> dict[str, tuple[float, float]]:
    return {"mu": (0.0, 1.0)}

judged = glidelab.judge("scenario.toml", mine, other, noise_m=2e-5)
print(glidelab.explain(judged), glidelab.explain(glidelab.smooth(t, x, 0.02)))
''')
        done = subprocess.run(["mypy", "--strict", "--python-executable", sys.executable, "--cache-dir",
                               str(self.folder), str(mine)], capture_output=True, text=True, check=False,
                              env={**os.environ, "MYPYPATH": str(SOURCE / "python")})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_public_name_has_a_docstring(self):
        import glidelab
        for name in glidelab.__all__:
            self.assertTrue(getattr(glidelab, name).__doc__, name)
