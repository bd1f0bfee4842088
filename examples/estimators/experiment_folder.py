"""The two ends of an estimator: an experiment folder in, results.json out. The method between them is yours.

An estimator is a function that takes a Folder and returns one answer for each configuration:
{"k_over_m_1_s": (value, sd), "mu": (value, sd), "alpha_deg": (value, sd), "v_lim_m_s": (value, sd)}, None or a left-out key where
the positions do not determine it. main(estimator) does the rest. Python 3.11 and nothing else.
"""

import csv
import json
import math
import pathlib
import sys
import tomllib


class Clip:
    """One motion: times (s), positions (m, positive downhill)."""

    def __init__(self, table, folder):
        self.name = table["name"]
        self.mass_kg = table["mass_kg"]
        self.incline_deg = table["incline_deg"]
        self.group = table.get("group", "")
        self.launched = table.get("launched", "released")
        # A track is named in experiment.toml; of a filmed clip Glidelab's positions stand in the file of its name.
        path = folder / table.get("track", f"tracks/{self.name}.csv")
        with open(path, newline="", encoding="utf-8") as file:
            rows = csv.reader(line for line in file if not line.startswith("#"))
            header = next(rows)
            points = [(float(row[header.index("t_s")]), float(row[header.index("x_m")])) for row in rows]
        self.t_s = [t for t, _ in points]
        self.x_m = [x for _, x in points]


class Configuration:
    """The clips of one mass, stated inclination and group: they share K/m, mu and alpha."""

    def __init__(self, clips):
        self.clips = clips
        self.mass_kg = clips[0].mass_kg
        self.incline_deg = clips[0].incline_deg


class Folder:
    def __init__(self, path):
        path = pathlib.Path(path)
        with open(path / "experiment.toml", "rb") as file:
            toml = tomllib.load(file)
        self.gravity_m_s2 = toml.get("gravity_m_s2", 9.80665)
        by_configuration = {}
        for table in toml["clip"]:
            clip = Clip(table, path)
            by_configuration.setdefault((clip.mass_kg, clip.incline_deg, clip.group), []).append(clip)
        self.configurations = [Configuration(clips) for clips in by_configuration.values()]


def line(v, a):
    """Least squares of a = a0 - k v: k, a0 and their covariance (var k, cov, var a0) as if the points were independent."""
    n = len(v)
    if n < 3:
        return None
    mean_v, mean_a = sum(v) / n, sum(a) / n
    spread = sum((x - mean_v) ** 2 for x in v)
    if spread == 0.0:
        return None
    k = -sum((x - mean_v) * (y - mean_a) for x, y in zip(v, a)) / spread
    a0 = mean_a + k * mean_v
    variance = sum((y - a0 + k * x) ** 2 for x, y in zip(v, a)) / (n - 2)
    return {"k": k, "a0": a0, "var_k": variance / spread, "cov": variance * mean_v / spread,
            "var_a0": variance * (1.0 / n + mean_v**2 / spread)}


def from_lines(up, down, gravity_m_s2):
    """What the lines of the two directions of motion give: a = g sin(alpha) -+ mu g cos(alpha) - (K/m) v for v > 0, v < 0.

    Where there is one direction only, K/m (and the terminal velocity of v > 0) is all that it determines.
    """
    answer = {}
    lines = [found for found in (up, down) if found]
    if not lines:
        return answer
    k = sum(found["k"] for found in lines) / len(lines)
    answer["k_over_m_1_s"] = (k, math.sqrt(sum(found["var_k"] for found in lines)) / len(lines))
    if up and down:
        drive, friction = (up["a0"] + down["a0"]) / 2.0, (up["a0"] - down["a0"]) / 2.0
        sd = math.sqrt(up["var_a0"] + down["var_a0"]) / 2.0
        sine = drive / gravity_m_s2
        if abs(sine) < 1.0:
            cosine = math.sqrt(1.0 - sine**2)
            answer["alpha_deg"] = (math.degrees(math.asin(sine)), math.degrees(sd / gravity_m_s2 / cosine))
            answer["mu"] = (friction / gravity_m_s2 / cosine, sd / gravity_m_s2 / cosine)
    if down and down["a0"] > 0.0 and down["k"] > 0.0:
        v = down["a0"] / down["k"]
        variance = (down["var_a0"] - 2.0 * v * down["cov"] + v**2 * down["var_k"]) / down["k"] ** 2
        answer["v_lim_m_s"] = (v, math.sqrt(max(variance, 0.0)))
    return answer


def lines_through(derivatives):
    """An estimator from a method that gives v and a: derivatives(clip) returns lists of v and a, one pair a usable point."""

    def estimator(folder):
        answers = []
        for configuration in folder.configurations:
            points = {-1: ([], []), 1: ([], [])}
            for clip in configuration.clips:
                for v, a in zip(*derivatives(clip)):
                    if v != 0.0:
                        points[1 if v > 0.0 else -1][0].append(v)
                        points[1 if v > 0.0 else -1][1].append(a)
            answers.append(from_lines(line(*points[-1]), line(*points[1]), folder.gravity_m_s2))
        return answers

    return estimator


KEYS = ("k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s")


def main(estimator):
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} FOLDER OUT: reads FOLDER/experiment.toml, writes OUT/results.json")
    folder = Folder(sys.argv[1])
    document = {"format": 1, "configurations": []}
    for configuration, answer in zip(folder.configurations, estimator(folder)):
        entry = {"clips": [clip.name for clip in configuration.clips]}
        for key in KEYS:
            pair = answer.get(key)
            entry[key] = {"value": float(pair[0]), "sd": float(pair[1])} if pair else None
        missing = [key for key in KEYS if entry[key] is None]
        if missing:
            entry["why"] = {key: "the positions do not determine it" for key in missing}
        document["configurations"].append(entry)
    with open(pathlib.Path(sys.argv[2]) / "results.json", "w", encoding="utf-8") as file:
        json.dump(document, file, indent=2)


def public_package(name, package):
    """The module, or the end of the program with the reason: the package is not installed."""
    try:
        return __import__(name, fromlist=["_"])
    except ImportError:
        sys.exit(f"skipped: no {name} ({package})")
