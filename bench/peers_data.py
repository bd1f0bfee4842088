"""Positions that Glidelab tracked, handed to every method alike, and what each method's v and a come to: errors, lines, parameters."""

import csv
import json
import os
import re
import subprocess
import sys
import tomllib

import numpy as np
from peers_methods import EXAMPLES as FOLDER_OF_EXAMPLES
from peers_methods import Missing

ESTIMATORS = ("phase-diagram", "phase-diagram-gls", "trajectory")
SMOOTHERS = ("kalman", "spline")  # that find their own strength
# Of examples/estimators, each a whole estimator of its own; what they are.
EXAMPLES = {
    "finite_differences": "Tracker's formulas",
    "savitzky_golay": "scipy's savgol_filter, 0.16 s",
    "smoothing_spline": "scipy's UnivariateSpline",
    "kernel_smoother": "R's KernSmooth, 0.03 s",
    "kalman_smoother": "Kalman filter and RTS smoother, order 3",
    "chosen_by_pynumdiff": "PyNumDiff and its optimiser",
    "sparse_regression": "pysindy",
    "fit_of_motion": "solve_ivp and least_squares",
}
GRAVITY_M_S2 = 9.80665
CLIP_KEYS = ("mass_kg", "incline_deg", "incline_sd_deg", "mass_sd_kg", "launched", "start_s", "end_s", "group")


def run(arguments):
    done = subprocess.run(arguments, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(arguments)}: exit status {done.returncode}\n{done.stderr[-2000:]}")
    return done.stderr


def columns(path):
    with open(path, encoding="utf-8") as table:
        rows = [row for row in csv.reader(table) if row and not row[0].startswith("#")]
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def numbers(texts):
    return np.array([float(text) if text else np.nan for text in texts])


def write_tracks(experiment, analysed, folder):
    """The clips' positions, as analysed, as an experiment folder of tracks; returns its [[clip]] tables."""
    with open(os.path.join(experiment, "experiment.toml"), "rb") as text:
        clips = tomllib.load(text)["clip"]
    os.makedirs(os.path.join(folder, "tracks"), exist_ok=True)
    lines = ["format = 1", 'name = "tracks"', "[track]", 'downhill = "+X"']
    for clip in clips:
        motion = columns(os.path.join(analysed, f"motion-{clip['name']}.csv"))
        forces = {}
        if "track" in clip:
            source = columns(os.path.join(experiment, clip["track"]))
            if "force_n" in source:
                forces = {round(float(t), 6): f for t, f in zip(source["t_s"], source["force_n"])}
        with open(os.path.join(folder, "tracks", f"{clip['name']}.csv"), "w", encoding="utf-8") as track:
            track.write("t_s,x_m,force_n\n" if forces else "t_s,x_m\n")
            for t, x in zip(motion["t_s"], motion["measured_x_m"]):
                if x:
                    track.write(f"{t},{x}" + (f",{forces[round(float(t), 6)]}" if forces else "") + "\n")
        lines += ["[[clip]]", f'name = "{clip["name"]}"', f'track = "tracks/{clip["name"]}.csv"']
        lines += [f"{key} = {json.dumps(clip[key])}" for key in CLIP_KEYS if key in clip]
    with open(os.path.join(folder, "experiment.toml"), "w", encoding="utf-8") as text:
        text.write("\n".join(lines) + "\n")
    return clips


def analysis(glidelab, folder, name, *options):
    """What Glidelab makes of the tracks: results.json and the seconds of processor time without the page."""
    out = f"{folder}-{name}"
    said = run([glidelab, "analyze", folder, "-o", out, "-v", *options])
    with open(os.path.join(out, "results.json"), encoding="utf-8") as text:
        results = json.load(text)
    stages = re.findall(r"^(.*): took .*, ([\d.]+) s of processor time", said, re.M)
    return results, sum(float(s) for name, s in stages if name != "writing the report")


def estimates(glidelab, folder):
    """By each of Glidelab's estimators, and by each smoother."""
    found = {name: analysis(glidelab, folder, name, "--estimator", name) for name in ESTIMATORS}
    return found | {name: analysis(glidelab, folder, name, "--smoother", name) for name in SMOOTHERS}


def example_estimate(name, folder):
    """What an estimator of examples/estimators makes of the tracks: results.json and its seconds of processor time."""
    out = f"{folder}-{name}"
    os.makedirs(out, exist_ok=True)
    before = os.times()
    program = os.path.join(FOLDER_OF_EXAMPLES, f"{name}.py")
    done = subprocess.run([sys.executable, "-B", program, folder, out], capture_output=True, text=True, check=False)
    after = os.times()
    if done.returncode:
        if done.stderr.startswith("skipped: no "):
            raise Missing(done.stderr.strip().removeprefix("skipped: no "))
        sys.exit(f"{program}: exit status {done.returncode}\n{done.stderr[-2000:]}")
    with open(os.path.join(out, "results.json"), encoding="utf-8") as text:
        results = json.load(text)
    return results, sum(after[2:4]) - sum(before[2:4])


def smoothed(table, folder, name):
    """x, v, a of a clip frame by frame, as an analysis smoothed it."""
    motion = columns(os.path.join(f"{folder}-{name}", f"motion-{table['name']}.csv"))
    return np.column_stack([numbers(motion[c]) for c in ("x_m", "v_m_s", "a_m_s2")])


def load_clips(tables, results, folder, truth):
    """Per clip: times, positions, Glidelab's smoothed motion, the frames of its lines, and the truth where there is one."""
    of_clip = {name: i for i, configuration in enumerate(results["configurations"]) for name in configuration["clips"]}
    clips = []
    for table in tables:
        motion = columns(os.path.join(f"{folder}-phase-diagram", f"motion-{table['name']}.csv"))
        track = columns(os.path.join(folder, "tracks", f"{table['name']}.csv"))
        clip = {"name": table["name"], "mass": table["mass_kg"], "configuration": of_clip[table["name"]]}
        clip["t"], clip["x"] = numbers(motion["t_s"]), numbers(motion["measured_x_m"])
        clip["glidelab"] = {name: smoothed(table, folder, name) for name in ("phase-diagram", *SMOOTHERS)}
        clip["used"] = np.array([reason == "used" for reason in motion["reason"]])
        clip["force"] = numbers(track["force_n"]) if "force_n" in track else None
        if truth:
            true = columns(os.path.join(truth, f"trajectory-{table['name']}.csv"))
            clip["truth"] = np.column_stack([numbers(true[c]) for c in ("x_m", "v_m_s", "a_m_s2")])
        clips.append(clip)
    return clips


def even_runs(clips):
    """Evenly spaced stretches of positions, which every method can take: a missing frame begins another."""
    runs = []
    for index, clip in enumerate(clips):
        keep = np.flatnonzero(np.isfinite(clip["x"]))
        steps = np.diff(clip["t"][keep])
        for frames in np.split(keep, np.flatnonzero(steps > 1.5 * np.median(steps)) + 1):
            if len(frames) >= 5:
                runs.append({"clip": index, "frames": frames, "t": clip["t"][frames], "x": clip["x"][frames]})
    return runs


def joined(clips, runs, values):
    """Values by run put back into one array a clip."""
    whole = [np.full((len(clip["t"]), 3), np.nan) for clip in clips]
    for one, value in zip(runs, values):
        whole[one["clip"]][one["frames"]] = value
    return whole


def errors(clips, motions):
    """Root mean square errors of x, v, a in the frames of the lines, and of a in all frames that have a value. A clip's origin of x is
    the pattern's, not the scenario's: a constant is taken off. None where a clip has no values."""
    parts, everywhere = [], []
    for clip, motion in zip(clips, motions):
        off = motion - clip["truth"]
        if not np.isfinite(off[clip["used"]]).any():
            return None
        off[:, 0] -= np.nanmean(off[clip["used"], 0])
        parts.append(off[clip["used"]])
        everywhere.append(off[:, 2])
    inside = np.sqrt(np.nanmean(np.concatenate(parts) ** 2, axis=0))
    return [*inside, np.sqrt(np.nanmean(np.concatenate(everywhere) ** 2))]


def line(v, a):
    """a = a0 - k v by ordinary least squares: k, a0; None for fewer than ten points, or none that differ."""
    good = np.isfinite(v) & np.isfinite(a)
    if good.sum() < 10 or np.ptp(v[good]) == 0.0:
        return None
    slope, intercept = np.polyfit(v[good], a[good], 1)
    return -slope, intercept


def parameters(clips, motions):
    """For each configuration one line for each direction through all its clips; K/m their mean, mu and alpha by equation (13); and the
    standard deviation of the K/m of single clips and directions."""
    found = []
    for configuration in range(1 + max(clip["configuration"] for clip in clips)):
        members = [(c, m) for c, m in zip(clips, motions) if c["configuration"] == configuration]
        points = {-1: [[], []], 1: [[], []]}
        single = []
        for clip, motion in members:
            force = 0.0 if clip["force"] is None else clip["force"] / clip["mass"]
            v, a = motion[:, 1], motion[:, 2] - force
            for sign, (vs, accelerations) in points.items():
                # The frames and their direction are Glidelab's for all: the same frames for the same line.
                frames = clip["used"] & (np.sign(clip["glidelab"]["phase-diagram"][:, 1]) == sign)
                vs.append(v[frames])
                accelerations.append(a[frames])
                single.append(line(v[frames], a[frames]))
        lines = {sign: line(np.concatenate(vs), np.concatenate(accs)) for sign, (vs, accs) in points.items()}
        slopes = [fit[0] for fit in lines.values() if fit]
        entry = {"k_over_m": float(np.mean(slopes)) if slopes else None, "mu": None, "alpha_deg": None}
        if lines[-1] and lines[1]:
            mean, half = (lines[-1][1] + lines[1][1]) / 2.0, (lines[-1][1] - lines[1][1]) / 2.0
            alpha = np.arcsin(np.clip(mean / GRAVITY_M_S2, -1.0, 1.0))
            entry["mu"], entry["alpha_deg"] = float(half / (GRAVITY_M_S2 * np.cos(alpha))), float(np.degrees(alpha))
        singles = [fit[0] for fit in single if fit]
        entry["spread"] = float(np.std(singles, ddof=1)) if len(singles) > 1 else None
        found.append(entry)
    return found


def own_parameters(results, order=None):
    """K/m, mu, alpha of a results.json, with the stated standard deviations; its configurations in the order of another's."""
    of_clip = {configuration["clips"][0]: configuration for configuration in results["configurations"]}
    found = []
    for configuration in [of_clip[one["clips"][0]] for one in (order or results)["configurations"]]:
        entry = {"spread": None}
        for short, name in (("k_over_m", "k_over_m_1_s"), ("mu", "mu"), ("alpha_deg", "alpha_deg")):
            quantity = configuration.get(name)
            entry[short], entry[short + "_sd"] = (quantity["value"], quantity["sd"]) if quantity else (None, None)
        found.append(entry)
    return found


def parameter_errors(found, true):
    """Root mean square error over the configurations of K/m (relative), mu, alpha (degrees); None where one has no value."""
    def rms(name, relative):
        if any(p[name] is None for p in found):
            return None
        off = [(p[name] - t[name]) / (t[name] if relative else 1.0) for p, t in zip(found, true)]
        return float(np.sqrt(np.mean(np.square(off))))

    return {"k_over_m": rms("k_over_m", True), "mu": rms("mu", False), "alpha_deg": rms("alpha_deg", False)}
