"""Every kind of call fails once: the n-th open, write, allocation, integration, query, decoded frame, …

    fail_each_call.py GLIDELAB LIBRARY [COMMAND ...] [--most N] [--last N]

LIBRARY is failing_calls. Each COMMAND (see lines_of(); default all) runs once undisturbed, which counts the
calls of each function, and then once for each function and n, at most N of them (default 12: the first ones, the last ones, and some
between), and the last ones (default 0), in which results are put in place. Allowed: the undisturbed result, or status 1 or 3 with a message, and then the output's place as it was before. A
signal, an endless run, a half-written or another result is a finding, which is printed with the way to repeat it; the exit status is 1.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SECONDS = 120

SCENARIO = """format = 1
name = "small"
seed = 5
[camera]
width_px = 320
height_px = 160
frame_rate_hz = 60.0
focal_px = [420.0, 420.0]
position_m = [0.05, 0.08, 2.40]
target_m = [0.0, 0.0, 0.0]
[calibration]
inner_corners = [7, 5]
square_m = 0.06
views = 4
[marker]
diameter_m = 0.04
[[configuration]]
name = "m1"
mass_kg = 0.335
incline_deg = 4.3
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.768
[[configuration.force]]
law = "coulomb"
mu = 0.0071
[[configuration.clip]]
name = "up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.3
duration_s = 1.0
[[configuration.clip]]
name = "down"
launched = "down"
x0_m = -0.45
v0_m_s = 1.2
duration_s = 0.8
"""

SWEEP = """format = 1
name = "small"
scenario = "scenario.toml"
level = "tracks"
replicates = 2
[tracks]
noise_m = 1e-5
[[vary]]
key = "camera.frame_rate_hz"
values = [60.0, 90.0]
"""


OLD = ["note.txt", "trajectory-down.csv"]


def lines_of(command):
    """The program's words; all write to the folder "out"."""
    return {
        "simulate": ["simulate", "scenario.toml", "-q", "-o", "out"],
        "simulate-again": ["simulate", "scenario.toml", "-q", "-o", "out"],
        "render": ["render", "scenario.toml", "-q", "-o", "out", "--jobs", "1"],
        "analyze": ["analyze", "film", "-q", "-o", "out", "--jobs", "1"],
        "diagnose": ["diagnose", "film", "-q", "-o", "out", "--jobs", "1"],
        "sweep": ["sweep", "sweep.toml", "-q", "-o", "out", "--jobs", "1"],
    }[command]


def files_of(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


class Trial:
    """One command in a folder of its own."""

    def __init__(self, program, library, place, command, before):
        self.program, self.library, self.place, self.command, self.before = program, library, place, command, before
        self.makes = []

    def run(self, **environment):
        for name in set(os.listdir(self.place)) - self.before:
            path = self.place / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        if self.command == "simulate-again":  # over results of the same names, and a file of somebody's own
            (self.place / "out").mkdir()
            for name in OLD:
                (self.place / "out" / name).write_text("old\n")
        return subprocess.run([self.program, *lines_of(self.command)], cwd=self.place, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=SECONDS,
                              env=dict(os.environ, LD_PRELOAD=str(self.library), **environment))

    def left(self):
        """What a run that failed has changed."""
        left = set(os.listdir(self.place)) - self.before
        if self.command == "simulate-again":
            old = [(self.place / "out" / name).read_text() for name in OLD] == ["old\n"] * len(OLD)
            if old and files_of(self.place / "out") == sorted(OLD):
                left.discard("out")
        return sorted(left)

    def result(self):
        """Names of files, and the bytes of the one that other programs read."""
        main = {"analyze": "results.json", "diagnose": "diagnosis.json", "render": "experiment.toml"}.get(self.command)
        out = self.place / "out"
        return files_of(out), (out / main).read_bytes() if main and (out / main).exists() else b""

    def counts(self):
        with tempfile.NamedTemporaryFile() as told:
            done = self.run(GLIDELAB_FAIL_COUNTS=told.name)
            if done.returncode != 0:
                sys.exit(f"{self.command} fails undisturbed: {done.stderr}")
            lines = pathlib.Path(told.name).read_text().split("\n")
        self.makes = sorted(set(os.listdir(self.place)) - self.before)
        return {name: int(count) for name, count in (line.split() for line in lines if line)}

    def finding(self, name, n, whole):
        """What is wrong when the n-th call fails; None if nothing is."""
        try:
            done = self.run(GLIDELAB_FAIL=f"{name}:{n}")
        except subprocess.TimeoutExpired:
            return f"no end within {SECONDS} s"
        if done.returncode not in (0, 1, 3):
            return f"status {done.returncode}: {done.stderr[:300]}"
        if done.returncode == 0:
            return None if self.result() == whole else f"status 0 with another result: {done.stderr[:300]}"
        if not done.stderr.strip():
            return f"status {done.returncode} without a message"
        if self.command == "sweep":  # keeps the runs that are done, and goes on when it is called again
            again = subprocess.run([self.program, *lines_of(self.command)], cwd=self.place, capture_output=True,
                                   timeout=SECONDS)
            return None if again.returncode == 0 else f"cannot be continued: {again.stderr[:300]}"
        left = self.left()
        if left == self.makes and self.result() == whole:
            return None  # only the last words failed
        return f"left behind: {', '.join(left)}" if left else None


def chosen(count, most):
    """Of 1 to count: the first third and the last third of `most`, and the rest evenly between."""
    if count <= most:
        return range(1, count + 1)
    edge = most // 3
    inner = most - 2 * edge
    between = [edge + round((i + 1) * (count - 2 * edge) / (inner + 1)) for i in range(inner)]
    return sorted({*range(1, edge + 1), *between, *range(count - edge + 1, count + 1)})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("commands", nargs="*", default=["simulate", "simulate-again", "render", "analyze", "diagnose", "sweep"])
    parser.add_argument("--most", type=int, default=12)
    parser.add_argument("--last", type=int, default=0)
    options = parser.parse_args()
    program, library = options.program.resolve(), options.library.resolve()
    found = runs = 0
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        (place / "scenario.toml").write_text(SCENARIO)
        (place / "sweep.toml").write_text(SWEEP)
        subprocess.run([program, "render", "scenario.toml", "-q", "-o", "film"], cwd=place, check=True)
        before = set(os.listdir(place))
        for command in options.commands:
            trial = Trial(program, library, place, command, before)
            counts = trial.counts()
            whole = trial.result()
            for name, count in sorted(counts.items()):
                last = range(max(1, count - options.last + 1), count + 1)
                for n in sorted({*chosen(count, options.most), *last}):
                    runs += 1
                    finding = trial.finding(name, n, whole)
                    if finding:
                        found += 1
                        print(f"{command}, call {n} of {count} of {name}: {finding}", flush=True)
            print(f"{command}: {', '.join(f'{name} {count}' for name, count in sorted(counts.items()) if count)}", flush=True)
    print(f"{runs} runs, {found} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
