"""Diagnoses made experiments and compares the verdicts with the truth."""

import json
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from scipy.stats import beta

# What no track can tell apart, by the contract of the effects.
ALWAYS_ALIKE = [{"scale_error", "frame_rate_error"}, {"camera_motion", "base_vibration"}]
# A cause off the list that an effect of the list describes.
DESCRIBED = {"a sticky spot": {"place_friction"}}
# What redefines K, mu or the inclination, so that the truth has no single value.
CHANGES = {"k_over_m_1_s": {"eddy_rolloff", "power_law_drag", "direction_dependent_drag", "configuration_drag", "clip_scatter",
                            "damping_gradient", "rotational_inertia", "mass_error", "frame_rate_error", "scale_error"},
           "mu": {"stribeck", "direction_asymmetry", "place_friction", "friction_drift", "configuration_friction", "clip_scatter",
                  "frame_rate_error", "scale_error", "mass_error", "rotational_inertia"},
           "alpha_deg": {"frame_rate_error", "scale_error", "rotational_inertia", "mass_error"}}


def add_command(commands):
    parser = commands.add_parser("score")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--program", required=True)
    parser.add_argument("--results", default="diagnosis", help="results lie in DIR/NAME/case-000/")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--list", action="store_true", help="a line for each case as well")
    parser.add_argument("--check", action="store_true", help="only glidelab check")


def diagnose(program, folder, out):
    if not (out / "diagnosis.json").exists():
        out.mkdir(parents=True, exist_ok=True)
        run = subprocess.run([program, "diagnose", str(folder), "-o", str(out), "--no-page", "-q", "--jobs", "1"],
                             capture_output=True, text=True, timeout=600)
        (out / "messages.txt").write_text(f"{run.returncode}\n{run.stdout}{run.stderr}")
    try:
        return json.loads((out / "diagnosis.json").read_text())
    except FileNotFoundError:
        return None


def alike(a, b):
    return a == b or any({a, b} <= s for s in ALWAYS_ALIKE)


def rests_in_order(truth, ids, explained):
    """Shares of the named causes less what these take beside those before them, as long as those are true ones."""
    before, left = None, list(truth["causes"])
    for one in explained:
        cause = next((c for c in left if one["id"] in ids and alike(one["id"], c["id"])), None)
        if cause is None or "share_first" not in cause:
            return
        left.remove(cause)
        share = cause["share_first"] if before is None else 1.0 - truth["left"] - before
        yield (one.get("share") or 0.0) - share
        before = share


def judge(truth, result):
    """What the table counts of one case."""
    causes = sorted(truth["causes"], key=lambda c: -c["share"])
    true = [c["id"] for c in causes]
    named = result["effects"] if result["verdict"] == "effect" else []
    ids = [e["id"] for e in named]
    row = {"class": truth["class"], "true": true, "named": ids, "verdict": result["verdict"], "excess": truth["excess"],
           "stated": [round(e["probability"], 2) for e in named], "joint": named[0]["joint_probability"] if named else None}
    shares = {e["id"]: e.get("share") or 0.0 for e in result.get("explained", [])}
    row["shares"] = {i: round(shares.get(i, 0.0), 2) for i in ids}
    row["true_shares"] = [round(c["share"], 2) for c in causes]
    if truth["class"] in ("one", "two"):
        row["first"] = bool(ids) and alike(ids[0], true[0])
        row["told"] = row["first"] or bool(ids) and any(alike(i, true[0]) for i in named[0].get("equivalent_to", []))
        row["wrong"] = [(i, p) for i, p in zip(ids, row["stated"]) if p > 0.8 and not any(alike(i, t) for t in true)]
        row["rests"] = [shares.get(i, 0.0) - c["share"] for i in ids for c in causes if alike(i, c["id"])]
        row["rests_in_order"] = list(rests_in_order(truth, ids, result.get("explained", [])))
        if truth["class"] == "two":
            row["either_first"] = bool(ids) and any(alike(ids[0], t) for t in true)
            row["both"] = all(any(alike(i, t) for i in ids) for t in true)
            row["both_told"] = all(any(alike(i, t) for e in named for i in [e["id"], *e.get("equivalent_to", [])]) for t in true)
    elif truth["class"] == "none":
        row["claimed"] = bool(ids) and sum(row["shares"].values()) >= 0.5
    else:
        right = DESCRIBED.get(true[0], set())
        row["wrong"] = [(i, p) for i, p in zip(ids, row["stated"]) if p > 0.8 and i not in right]
    row["held"] = {"all": [], "right": []}
    right_causes = sorted(ids) == sorted(true)
    for q, changing in CHANGES.items():
        if changing & set(true + ids):
            continue
        for r in result.get("recovered", []):
            value = r.get(q)
            match = [c for c in truth["configurations"] if c["group"] == r["group"] and abs(c["mass_kg"] - r["mass_kg"]) < 1e-9]
            if value is None or not match:
                continue
            inside = value["interval95"][0] <= match[0][q] <= value["interval95"][1]
            row["held"]["all"].append(inside)
            if right_causes:
                row["held"]["right"].append(inside)
    return row


def fraction(hits):
    """'9 of 12 (43 to 95 %)', with the interval of Clopper and Pearson."""
    k, n = sum(map(bool, hits)), len(hits)
    if n == 0:
        return "-"
    low = beta.ppf(0.025, k, n - k + 1) if k else 0.0
    high = beta.ppf(0.975, k + 1, n - k) if k < n else 1.0
    return f"{100 * k / n:.0f} % ({k} of {n}; {100 * low:.0f} to {100 * high:.0f} %)"


def rms(errors):
    return f"{np.sqrt(np.mean(np.square(errors))):.3f} ({len(errors)})" if errors else "-"


def table(rows):
    def of(key, *classes):
        return [r[key] for r in rows if r["class"] in classes]

    rests, in_order = ([x for r in rows for x in r.get(key, [])] for key in ("rests", "rests_in_order"))
    yield "main cause first", fraction(of("first", "one", "two"))
    yield "or told as not to be told apart", fraction(of("told", "one", "two"))
    yield "one cause", fraction(of("first", "one"))
    yield "two causes, main first; either first", f'{fraction(of("first", "two"))}; {fraction(of("either_first", "two"))}'
    yield "two causes, both named", fraction(of("both", "two"))
    yield "or told as not to be told apart", fraction(of("both_told", "two"))
    yield "one or two causes, a wrong name above 0.8", fraction(of("wrong", "one", "two"))
    yield "imperfections alone, half of the excess claimed", fraction(of("claimed", "none"))
    yield "imperfections alone, any name", fraction(of("named", "none"))
    yield "off the list, a wrong name above 0.8", fraction(of("wrong", "off"))
    yield "shares, rms error; each beside those before it", f"{rms(rests)}; {rms(in_order)}"
    yield "recovered intervals contain the true value", fraction([h for r in rows for h in r["held"]["all"]])
    yield "the same, right causes named", fraction([h for r in rows for h in r["held"]["right"]])


def run(options):
    cases = [p.with_suffix("") for folder in options.folders for p in sorted(Path(folder).glob("case-*.truth"))]
    if options.check:
        failed = [c.name for c in cases if subprocess.run([options.program, "check", str(c), "-q", "-o", str(c) + ".check"],
                                                          capture_output=True).returncode]
        print(f"{len(cases)} folders, {len(failed)} refused: {' '.join(failed)}")
        return int(bool(failed))
    with ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda c: diagnose(options.program, c, c.parent / options.results / c.name), cases))
    rows = []
    for case, result in zip(cases, results):
        truth = json.loads((case.with_suffix(".truth") / "truth.json").read_text())
        if result is None:
            print(f"{case.name}: refused")
            result = {"verdict": "refused", "effects": []}
        rows.append(judge(truth, result))
        if options.list:
            r = rows[-1]
            mark = {True: "+", False: "-"}.get(r.get("first", not r.get("claimed", False) and not r.get("wrong")))
            print(f'{mark} {case.name} {r["class"]:4s} E={r["excess"]:.1f} {dict(zip(r["true"], r["true_shares"]))} -> {r["verdict"]} '
                  f'{[f"{i} {p}" for i, p in zip(r["named"], r["stated"])]} {r["shares"]}')
    for name, value in table(rows):
        print(f"{name:50s} {value}")
    return 0
