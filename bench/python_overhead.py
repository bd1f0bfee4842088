#!/usr/bin/env python3
"""What the Python module costs beside the program: a diagnosis of 12 clips from arrays, and one call of the smoother.

usage: PYTHONPATH=build/release/python bench/python_overhead.py build/release/app/glidelab [REPEATS]

Times are processor time of all threads, the least of the repeats: on a machine that does other things as well, that is
what repeats best. The program's contains its start and its file; the module's the conversion of arrays and results.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import glidelab
from glidelab import _glidelab

ROOT = Path(__file__).resolve().parent.parent


def processor_s(work) -> float:
    """Of this process and its children, while `work` runs."""
    before = os.times()
    work()
    after = os.times()
    return sum(after[:4]) - sum(before[:4])


def twelve_tracks():
    """The paper's twelve clips with white noise."""
    tracks = []
    for scenario in ("level", "inclined"):
        for clip in glidelab.simulate(ROOT / "scenarios" / "paper" / f"{scenario}.toml").clips:
            tracks.append(clip.track(noise_m=2e-5, seed=len(tracks), mass_kg=0.335 + 0.1 * (len(tracks) // 2 % 3),
                                     incline_deg=0.0 if scenario == "level" else 4.0,
                                     name=f"{scenario}-{clip.name}"))
    return tracks


def write(folder: Path, tracks) -> None:
    """As an experiment folder."""
    lines = ["format = 1", 'name = "made"', "[track]", 'downhill = "+X"']
    for track in tracks:
        rows = [f"{t!r},{x!r}" for t, x in zip(map(float, track.t_s), map(float, track.x_m))]
        (folder / f"{track.name}.csv").write_text("t_s,x_m\n" + "\n".join(rows) + "\n")
        lines += ["[[clip]]", f'name = "{track.name}"', f'track = "{track.name}.csv"', f"mass_kg = {track.mass_kg!r}",
                  f"incline_deg = {track.incline_deg!r}", f'launched = "{track.launched}"']
    (folder / "experiment.toml").write_text("\n".join(lines) + "\n")


def main() -> None:
    """Prints both."""
    program, repeats = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
    tracks = [glidelab.Track(**{**vars(track), "launched": "up" if track.name.endswith("-up") else "down"})
              for track in twelve_tracks()]
    with tempfile.TemporaryDirectory() as temp:
        folder = Path(temp) / "made"
        folder.mkdir()
        write(folder, tracks)
        command = [program, "diagnose", str(folder), "-q", "--no-page", "--jobs", "1", "-o", str(Path(temp) / "out")]
        by_command = min(processor_s(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL))
                         for _ in range(repeats))
        by_module = min(processor_s(lambda: glidelab.diagnose(tracks, name="made", jobs=1)) for _ in range(repeats))
        same = glidelab.diagnose(tracks, name="made").to_json() == (Path(temp) / "out" / "diagnosis.json").read_text()
    print(f"diagnose, {len(tracks)} clips, {sum(len(track.t_s) for track in tracks)} positions: command {by_command:.2f} s, "
          f"module {by_module:.2f} s ({100.0 * (by_module / by_command - 1.0):+.1f} %), the same bits: {same}")

    t = np.arange(1000) / 200.0
    x = np.sin(t)
    for steps in range(2, 13):
        bandwidth_s = steps / 200.0
        whole = least_s(lambda: glidelab.smooth(t, x, bandwidth_s))
        inside = least_s(lambda: _glidelab.smooth(t, x, bandwidth_s, 3, "gaussian", None))
        print(f"smooth, 1000 points, h of {steps} steps: {1e6 * whole:.0f} µs, of these {1e6 * (whole - inside):.1f} µs in Python")
    print_by_kind()


def print_by_kind() -> None:
    """The smoother with standard deviations, and over uneven times, whose points have weights of their own."""
    even = np.arange(1000) / 200.0
    uneven = even + np.random.default_rng(1).uniform(-0.002, 0.002, len(even))
    for steps in (3, 6, 12):
        h = steps / 200.0
        found = [1e6 * least_s(lambda t=t, x=np.sin(t), noise_m=noise_m: glidelab.smooth(t, x, h, noise_m=noise_m), calls)
                 for t, calls in ((even, 2000), (uneven, 200)) for noise_m in (None, 2e-5)]
        print(f"smooth, 1000 points, h of {steps} steps, without and with noise_m: even times {found[0]:.0f} and {found[1]:.0f} "
              f"µs, uneven times {found[2]:.0f} and {found[3]:.0f} µs")


def least_s(call, calls: int = 2000) -> float:
    """The least time of many calls."""
    times = []
    for _ in range(calls):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)


if __name__ == "__main__":
    main()
