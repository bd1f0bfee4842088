"""What the tests share: where program and sources are, made motions, folders with them."""

import importlib.util
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

SOURCE = Path(os.environ["GLIDELAB_SOURCE"])
PROGRAM = os.environ["GLIDELAB_PROGRAM"]


def needs(*wanted: str):
    """Skips a test where an optional package, or a program ("mypy program"), is missing, and says so on a line of its own."""
    missing = [name for name in wanted if not (shutil.which(name.split()[0]) if name.endswith(" program") else
                                               importlib.util.find_spec(name))]
    if not missing:
        return lambda test: test
    reason = f"skipped: no {', '.join(missing)}" + ("" if missing[0].endswith(" program") else " for Python")
    print(reason, flush=True)
    return unittest.skip(reason)


def run(*arguments: object, status: int = 0) -> str:
    """What the program prints; it must end with `status`."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != status:
        raise AssertionError(f"status {done.returncode}: {done.stderr}")
    return done.stdout


def damped(k_1_s: float = 2.77, mu: float = 0.0071, alpha_deg: float = 4.3, v0_m_s: float = -1.2,
           rate_hz: float = 200.0, duration_s: float = 1.6, noise_m: float = 2e-5, seed: int = 1):
    """t, x of a glider thrown up a slope, by the closed form; it turns once.

    a = g sin(alpha) - mu g cos(alpha) sign(v) - k v, solved on either side of the turn.
    """
    g, alpha = 9.80665, np.radians(alpha_deg)
    up, down = g * (np.sin(alpha) + mu * np.cos(alpha)), g * (np.sin(alpha) - mu * np.cos(alpha))
    turn_s = np.log(1.0 - k_1_s * v0_m_s / up) / k_1_s

    def moved(a, v0, t):
        return a / k_1_s * t + (v0 - a / k_1_s) * (1.0 - np.exp(-k_1_s * t)) / k_1_s

    t = np.arange(0.0, duration_s, 1.0 / rate_hz)
    x = np.where(t < turn_s, moved(up, v0_m_s, t), moved(up, v0_m_s, turn_s) + moved(down, 0.0, t - turn_s))
    return t, x + np.random.default_rng(seed).normal(0.0, noise_m, len(t))


class InFolder(unittest.TestCase):
    """Each test has a folder of its own, which is gone afterwards."""

    def setUp(self) -> None:
        temp = tempfile.TemporaryDirectory()
        self.addCleanup(temp.cleanup)
        self.folder = Path(temp.name)

    def write_experiment(self, tracks, name: str = "made") -> Path:
        """An experiment folder with these tracks, as text that keeps every bit."""
        folder = self.folder / name
        folder.mkdir()
        lines = ["format = 1", f'name = "{name}"', "[track]", 'downhill = "+X"']
        for track in tracks:
            rows = [f"{t!r},{x!r}" for t, x in zip(map(float, track.t_s), map(float, track.x_m))]
            (folder / f"{track.name}.csv").write_text("t_s,x_m\n" + "\n".join(rows) + "\n")
            lines += ["[[clip]]", f'name = "{track.name}"', f'track = "{track.name}.csv"',
                      f"mass_kg = {track.mass_kg!r}", f"incline_deg = {float(track.incline_deg)!r}",
                      f'launched = "{track.launched}"']
            if track.incline_sd_deg is not None:
                lines.append(f"incline_sd_deg = {track.incline_sd_deg!r}")
        (folder / "experiment.toml").write_text("\n".join(lines) + "\n")
        return folder


def read_json(path: Path):
    """A file's document."""
    return json.loads(path.read_text())
