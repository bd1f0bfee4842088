"""judge(): an estimator of the user's own beside the built-in ones."""

import asyncio
import math
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import glidelab
from tests.python.support import SOURCE, InFolder, needs
from tests.python.test_parts import small_scenario

SCENARIO = SOURCE / "scenarios" / "paper" / "inclined.toml"


def crude(tracks):
    """Lines through second differences of every tenth position: no smoothing, no corrections."""
    up, down = [], []
    for track in tracks:
        t, x = track.t_s[::10], track.x_m[::10]
        v, a = np.gradient(x, t)[1:-1], np.diff(x, 2) / (t[1] - t[0]) ** 2
        for line, moving in ((up, v < -0.1), (down, v > 0.1)):
            line.extend(zip(v[moving], a[moving]))
    slopes = [np.polyfit(*np.array(line).T, 1) for line in (up, down)]
    g = 9.80665
    sin = (slopes[0][1] + slopes[1][1]) / (2.0 * g)
    return {"k_over_m_1_s": -np.mean([slope[0] for slope in slopes]), "alpha_deg": np.degrees(np.arcsin(sin)),
            "mu": (slopes[0][1] - slopes[1][1]) / (2.0 * g * np.sqrt(1.0 - sin**2))}


class Judging(unittest.TestCase):
    def test_a_crude_estimator_finds_the_truth_and_errs_more_than_the_built_in_one(self):
        judged = glidelab.judge(SCENARIO, crude, "trajectory", noise_m=2e-5, replicates=10, seed=5)
        for mine, built_in in zip(judged.of("crude", "k_over_m_1_s"), judged.of("trajectory", "k_over_m_1_s")):
            self.assertEqual((mine.answered, mine.failed, mine.stated), (10, 0, 0))
            self.assertLess(abs(mine.bias), 0.05 * mine.truth)
            self.assertGreater(mine.rms, 3.0 * built_in.rms)
            self.assertEqual(built_in.stated, 10)
        self.assertIn("crude", str(judged))
        self.assertEqual(len({row.configuration for row in judged.rows}), 3)

    def test_an_estimator_that_knows_the_truth_has_no_error_and_its_intervals_hold_it(self):
        truth = {row.configuration: row.truth for row in glidelab.judge(
            SCENARIO, "phase-diagram", noise_m=2e-5, replicates=2).of("phase-diagram", "mu")}
        by_mass = dict(zip((0.335, 0.435, 0.535), truth.values()))

        def knowing(tracks):
            return {"mu": (by_mass[round(tracks[0].mass_kg, 3)], 1e-9)}

        for row in glidelab.judge(SCENARIO, knowing, noise_m=2e-5, replicates=3).of("knowing", "mu"):
            self.assertEqual((row.bias, row.rms, row.covered), (0.0, 0.0, 1.0))

    def test_what_it_raises_once_is_counted_once_and_told(self):
        calls = []

        def moody(tracks):
            calls.append(len(tracks))
            if len(calls) == 1:
                raise ZeroDivisionError("not today")
            return {"mu": 0.01}

        judged = glidelab.judge(SCENARIO, moody, noise_m=2e-5, replicates=3)
        self.assertEqual({row.failed for row in judged.rows}, {1})
        self.assertRegex(judged.failures["moody"], r"^ZeroDivisionError: not today \(test_estimator\.py, line \d+\)$")

    def test_whatever_an_estimator_raises_ends_nothing(self):
        class Own(Exception):
            """Not one of Python's."""

        def singular(tracks):
            return {"mu": np.linalg.inv(np.zeros((2, 2)))[0, 0]}

        def misspelt(tracks):
            return {"mu": tracks[0].position.mean()}

        def own(tracks):
            raise Own("of my own")

        def hungry(tracks):
            raise MemoryError

        judged = glidelab.judge(SCENARIO, singular, misspelt, own, hungry, "phase-diagram", noise_m=2e-5, replicates=2)
        for row in judged.rows:
            self.assertEqual((row.answered, row.failed), (2, 0) if row.estimator == "phase-diagram" else (0, 2))
            self.assertIsNone(row.rms if row.failed else None)
        self.assertRegex(judged.failures["singular"], r"^LinAlgError: Singular matrix \(\w+\.py, line \d+\)$")
        self.assertIn("AttributeError", judged.failures["misspelt"])
        self.assertRegex(judged.failures["own"], r"^Own: of my own \(test_estimator\.py, line \d+\)$")
        self.assertIn("own failed in 2 of 2 replicates, first with: Own: of my own", str(judged).splitlines()[2])
        self.assertIn("0 of 2, 2 failed", str(judged))
        self.assertIn("own failed in 2 of 2 replicates", judged._repr_html_())

    def test_an_estimator_of_coroutines_that_is_cancelled_has_failed(self):
        for raised in (asyncio.CancelledError, GeneratorExit):
            def cancelled(tracks, error=raised):
                raise error

            judged = glidelab.judge(SCENARIO, cancelled, noise_m=2e-5, replicates=2)
            self.assertEqual({row.failed for row in judged.rows}, {2})
            self.assertTrue(judged.failures["cancelled"].startswith(raised.__name__))

    def test_who_wants_to_stop_is_not_held(self):
        for wanted in (KeyboardInterrupt, SystemExit):
            def stopping(tracks, stop=wanted):
                raise stop

            with self.assertRaises(wanted):
                glidelab.judge(SCENARIO, stopping, noise_m=2e-5, replicates=2)

    def test_an_answer_that_is_none_is_counted_and_told(self):
        nan = float("nan")
        for answer, told in ((None, "a dict of quantities"), ([0.01], "a dict of quantities"),
                             ({"K": 1.0}, "the quantity 'K'"), ({1: 1.0}, "the quantity 1"),
                             ({"mu": 0.01, "alpha": 4.0}, 'did you mean "alpha_deg"'),
                             ({"mu": (1.0, 2.0, 3.0)}, "mu: found 3 numbers"), ({"mu": ()}, "mu: found 0 numbers"),
                             ({"mu": "0.01"}, "mu: found '0.01'"), ({"mu": True}, "mu: found True"),
                             ({"mu": 1j}, "mu: found 1j"), ({"mu": np.zeros(3)}, "mu: found array"),
                             ({"mu": (None, 0.1)}, "mu: found None"), ({"mu": (0.01, "small")}, "mu: found 'small'"),
                             ({"mu": (0.01, -1.0)}, "mu: found the standard deviation -1"),
                             ({"mu": (0.01, nan)}, "mu: found the standard deviation nan"),
                             ({"mu": (nan, -1.0)}, "mu: found the standard deviation -1"),
                             ({"mu": (0.01, float("inf"))}, "mu: found the standard deviation inf"),
                             ({"mu": glidelab.Quantity(0.01, -0.1)}, "mu: found the standard deviation -0.1"),
                             ({"mu": glidelab.Quantity(0.01, 0.1, (0.2, 0.0))}, "an interval from 0.2 to 0"),
                             ({"mu": glidelab.Quantity(0.01, 0.1, (0.2, 0.3))}, "an interval from 0.2 to 0.3"),
                             ({"mu": {"value": 0.01, "interval95": 3.0}}, "mu: found the interval 3.0"),
                             ({"mu": {"sd": 0.01}}, 'the key "value"'), ({"mu": float("inf")}, "mu: found inf")):
            with self.subTest(answer):
                judged = glidelab.judge(SCENARIO, lambda tracks, said=answer: said, noise_m=2e-5, replicates=2)
                self.assertEqual({(row.answered, row.failed, row.stated) for row in judged.rows}, {(0, 2, 0)})
                self.assertIn(told, judged.failures["<lambda>"])
        for wrong in ("best", 3.0, None):
            with self.assertRaises(glidelab.InputError):
                glidelab.judge(SCENARIO, wrong, noise_m=2e-5)
        with self.assertRaises(glidelab.InputError):
            glidelab.estimator(None)

    def test_a_configuration_as_in_results_json_is_an_answer(self):
        row = {"clips": ["m1-up", "m1-down"], "k_over_m_1_s": {"value": 2.77, "sd": 0.02, "interval95": [2.73, 2.81]},
               "mu": {"value": 0.0071, "sd": 0.0003}, "alpha_deg": None, "v_lim_m_s": None,
               "why": {"alpha_deg": "one direction only"}}
        judged = glidelab.judge(SCENARIO, lambda tracks: row, noise_m=2e-5, replicates=2)
        self.assertEqual(judged.failures, {})
        self.assertEqual({(one.quantity, one.answered, one.stated) for one in judged.rows},
                         {("k_over_m_1_s", 2, 2), ("mu", 2, 2), ("alpha_deg", 0, 0), ("v_lim_m_s", 0, 0)})
        of_glidelab = glidelab.simulate(SCENARIO).clips[0].track(noise_m=2e-5)
        document = glidelab.analyze(of_glidelab).to_dict()["configurations"][0]  # what the command writes
        self.assertEqual(glidelab.judge(SCENARIO, lambda tracks: document, noise_m=2e-5, replicates=2).failures, {})

    def test_an_exception_without_a_text_is_told_by_its_kind(self):
        class Mute(Exception):
            def __str__(self):
                raise ValueError

        def mute(tracks):
            raise Mute

        judged = glidelab.judge(SCENARIO, mute, noise_m=2e-5, replicates=2)
        self.assertRegex(judged.failures["mute"], r"^Mute \(test_estimator\.py, line \d+\)$")

    def test_what_cannot_be_determined_is_no_failure(self):
        for answer in ({}, {"mu": None}, {"mu": float("nan")}, {"mu": glidelab.Quantity(why="no reason")}):
            judged = glidelab.judge(SCENARIO, lambda tracks, said=answer: said, noise_m=2e-5, replicates=2)
            self.assertEqual({(row.answered, row.failed) for row in judged.rows}, {(0, 0)})
            self.assertEqual(judged.failures, {})

    def test_a_standard_deviation_makes_an_interval_of_it_unless_one_is_stated(self):
        def holds(answer):
            rows = glidelab.judge(SCENARIO, lambda tracks: {"mu": answer}, noise_m=2e-5, replicates=2).rows
            return {(row.stated, row.covered) for row in rows if row.quantity == "mu"}

        # A truth that is 1.95 standard deviations off lies in the interval of 1.96, one that is 1.97 off does not.
        off = {row.truth for row in glidelab.judge(SCENARIO, lambda tracks: {"mu": 1.0}, noise_m=2e-5,
                                                   replicates=2).rows if row.quantity == "mu"}
        far, near = max(1.0 - truth for truth in off), min(1.0 - truth for truth in off)
        self.assertEqual(holds((1.0, far / 1.95)), {(2, 1.0)})
        self.assertEqual(holds([1.0, near / 1.97]), {(2, 0.0)})
        self.assertEqual(holds(glidelab.Quantity(1.0, far / 1.95)), {(2, 1.0)})
        self.assertEqual(holds(glidelab.Quantity(1.0, near / 1.97)), {(2, 0.0)})
        self.assertEqual(holds(glidelab.Quantity(1.0, 9.0, (0.9, 1.1))), {(2, 0.0)})
        self.assertEqual(holds(np.float64(1.0)), {(0, None)})
        self.assertEqual(holds(np.array([1.0, far / 1.95])), {(2, 1.0)})
        self.assertEqual(holds({"value": 1.0, "sd": near / 1.97}), {(2, 0.0)})
        self.assertEqual(holds({"value": 1.0, "sd": 0.1, "interval95": [0.0, 1.0]}), {(2, 1.0)})
        self.assertEqual(holds({"value": 1.0}), {(0, None)})

    def test_the_positions_of_the_others_cannot_be_spoilt(self):
        def spoiling(tracks):
            tracks[0].x_m[:] = 0.0
            return {}

        alone = glidelab.judge(SCENARIO, crude, noise_m=2e-5, replicates=2)
        judged = glidelab.judge(SCENARIO, spoiling, crude, noise_m=2e-5, replicates=2)
        self.assertEqual(judged.of("crude", "mu"), alone.of("crude", "mu"))

    def test_a_registered_one_is_judged_by_default(self):
        @glidelab.estimator
        def mine(tracks):
            return {"alpha_deg": 4.0}

        judged = glidelab.judge(SCENARIO, noise_m=2e-5, replicates=2)
        self.assertEqual(set(judged.seconds), {"phase-diagram", "mine"})
        self.assertEqual(mine([]), {"alpha_deg": 4.0})


class Patience(unittest.TestCase):
    @needs("pandas")
    @unittest.skipUnless(hasattr(signal, "setitimer"), "skipped: no signal.setitimer")
    def test_what_tables_need_is_imported_before_a_call_that_may_be_ended_within_its_import(self):
        code = (f"import glidelab, sys\ndef mine(tracks):\n    print('pandas' in sys.modules)\n    return {{}}\n"
                f"glidelab.judge({str(SCENARIO)!r}, mine, noise_m=2e-5, replicates=2, seconds=60.0)")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertEqual(set(done.stdout.split()), {"True"})

    @unittest.skipUnless(hasattr(signal, "setitimer"), "skipped: no signal.setitimer")
    def test_a_call_that_takes_too_long_is_ended_and_counted(self):
        def endless(tracks):
            while True:
                try:
                    time.sleep(60.0)
                except Exception:  # one that holds on to whatever it can
                    continue

        def quick(tracks):
            return {"mu": 0.01}

        begin = time.monotonic()
        judged = glidelab.judge(SCENARIO, endless, quick, noise_m=2e-5, replicates=2, seconds=0.2)
        self.assertLess(time.monotonic() - begin, 30.0)  # one call of each experiment; the first that fails ends it
        self.assertEqual({row.failed for row in judged.of("endless", "mu")}, {2})
        self.assertEqual({(row.answered, row.failed) for row in judged.of("quick", "mu")}, {(2, 0)})
        self.assertEqual(judged.failures, {"endless": "not done after 0.2 s"})

    @unittest.skipUnless(hasattr(signal, "setitimer"), "skipped: no signal.setitimer")
    def test_a_limit_holds_of_a_built_in_one_and_of_any_length(self):
        before = signal.getsignal(signal.SIGALRM)
        for seconds in (1e-6, 1e-5, 1e-4, 1e-3):  # a fit of all motions takes longer
            judged = glidelab.judge(SCENARIO, "trajectory", noise_m=2e-5, replicates=2, seconds=seconds)
            self.assertEqual({row.failed for row in judged.rows}, {2})
            self.assertIn("not done after", judged.failures["trajectory"])
            self.assertEqual(signal.getsignal(signal.SIGALRM), before)
            self.assertEqual(signal.getitimer(signal.ITIMER_REAL), (0.0, 0.0))

    @unittest.skipUnless(hasattr(signal, "setitimer"), "skipped: no signal.setitimer")
    def test_a_timer_of_the_caller_s_rings_all_the_same(self):
        rung = threading.Event()
        before = signal.signal(signal.SIGALRM, lambda number, frame: rung.set())
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        glidelab.judge(SCENARIO, lambda tracks: time.sleep(0.1), noise_m=2e-5, replicates=2, seconds=10.0)
        self.assertTrue(rung.wait(10.0))

    def test_where_a_limit_cannot_be_kept_it_is_refused(self):
        def judged():
            try:
                glidelab.judge(SCENARIO, lambda tracks: {}, noise_m=2e-5, replicates=2, seconds=1.0)
            except glidelab.InputError as error:
                refused.append(error)

        refused: list[glidelab.InputError] = []
        thread = threading.Thread(target=judged)
        thread.start()
        thread.join()
        self.assertIn("main thread", refused[0].expected)
        for seconds in (0.0, -1.0, float("nan"), True, "1"):
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.judge(SCENARIO, lambda tracks: {}, noise_m=2e-5, replicates=2, seconds=seconds)
            self.assertEqual(caught.exception.key, "seconds")


def scaled(tracks):
    """Numbers of the positions, the masses and the launches: what another reader of the same folder finds as well."""
    of = sum(float(track.x_m[0] + track.t_s[-1]) * track.mass_kg * (2.0 if track.launched == "up" else 1.0) for track in tracks)
    return {"k_over_m_1_s": (of, 0.5), "mu": None, "alpha_deg": {"value": of, "sd": 1.0, "interval95": (of - 3.0, of + 1.0)},
            "v_lim_m_s": math.nan, "why": {"mu": "not asked"}}


PROGRAM = """
import json, pathlib, sys, tomllib
folder, out = map(pathlib.Path, sys.argv[1:])
found = {}
for clip in tomllib.loads((folder / "experiment.toml").read_text())["clip"]:
    lines = (folder / "tracks" / (clip["name"] + ".csv")).read_text().split()[1:]
    of = (float(lines[0].split(",")[1]) + float(lines[-1].split(",")[0])) * clip["mass_kg"] * (1 + (clip["launched"] == "up"))
    names, sums = found.setdefault((clip["mass_kg"], clip["incline_deg"], clip.get("group")), ([], []))
    names.append(clip["name"])
    sums.append(of)
configurations = [{"clips": names, "k_over_m_1_s": {"value": sum(of), "sd": 0.5}, "mu": None, "v_lim_m_s": None,
                   "alpha_deg": {"value": sum(of), "sd": 1.0, "interval95": [sum(of) - 3.0, sum(of) + 1.0]}}
                  for names, of in found.values()]
(out / "results.json").write_text(json.dumps({"format": 1, "configurations": configurations}))
"""


class AsACommand(InFolder):
    """A function in place of a program's command: the same folder, the same checks, the same results."""

    def test_a_function_is_judged_as_the_program_that_does_the_same(self):
        (self.folder / "mine.py").write_text(PROGRAM)
        by_program = {"estimator_command": f"{sys.executable} {self.folder}/mine.py {{folder}} {{out}}",
                      "estimator_name": "scaled"}
        (self.folder / "sweep.toml").write_text(
            f'format = 1\nname = "short"\nscenario = "{SCENARIO}"\nreplicates = 1\nseed = 2\nestimators = '
            '["phase-diagram"]\n[tracks]\nnoise_m = 2e-5\n[[vary]]\nkey = "camera.frame_rate_hz"\nvalues = [100.0, 200.0]\n')
        small = small_scenario()
        for study in (lambda **mine: glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=3, seed=5, **mine),
                      lambda **mine: glidelab.validate(small, **mine),
                      lambda **mine: glidelab.sweep(self.folder / "sweep.toml", self.folder / str(len(mine)), **mine)):
            of_function, of_program = study(estimator_command=scaled), study(**by_program)
            self.assertEqual((of_function.outside.name, of_function.outside.failed), ("scaled", 0), of_function.outside)
            one, other = ({key: value for key, value in found.to_dict().items() if key not in ("outside", "wall_s")}
                          for found in (of_function, of_program))
            self.assertEqual(one, other)
            for seconds in (of_function.outside.mean_s, of_function.outside.longest_s):
                self.assertGreater(seconds, 0.0)
            self.assertLessEqual(of_function.outside.mean_s, of_function.outside.longest_s)
        again = glidelab.sweep(self.folder / "sweep.toml", self.folder / "1", estimator_command=scaled)  # goes on
        self.assertEqual(again.to_dict()["overall"], of_function.to_dict()["overall"])

    def test_what_it_does_wrong_is_counted_and_told(self):
        def raising(tracks):
            raise ValueError("two\nlines")

        def uncertain(tracks):
            return {"mu": 0.1}

        def leaving(tracks):
            raise SystemExit(3)

        for function, kind, said in (
                (raising, "raised", r"ValueError: two lines \(test_estimator\.py, line \d+\)$"),
                (uncertain, "bad_output", "mu: found no standard deviation"), (leaving, "raised", "SystemExit: 3")):
            with self.subTest(function.__name__):
                covered = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, estimator_command=function)
                outside = covered.outside
                self.assertEqual((outside.runs, outside.failed, list(outside.failures)), (2, 2, [kind]))
                self.assertEqual(outside.command, f"the function {function.__name__}")
                self.assertRegex(outside.failures[kind].first, "^" + said)
                self.assertIn(f"“{function.__name__}” failed in 2 of 2 runs: 2 ", str(covered))
                self.assertIn(outside.failures[kind].first, " ".join(str(covered).split()))
        released = threading.Event()
        outside = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, estimator_seconds=0.3,
                                    estimator_command=lambda tracks: released.wait(60.0)).outside
        released.set()
        self.assertEqual((outside.name, outside.failures["time_out"].count), ("lambda", 2))

    def test_a_registered_one_goes_by_its_name(self):
        from glidelab._outside import registered
        self.addCleanup(registered.clear)
        registered.clear()

        @glidelab.estimator
        def of_the_class(tracks):
            return scaled(tracks)

        mine = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, seed=5, estimator_command="of_the_class")
        same = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, seed=5, estimator_command=of_the_class)
        self.assertEqual((mine.outside.name, mine.outside.failed), ("of_the_class", 0))
        self.assertEqual(mine.rows, same.rows)
        judged = glidelab.judge(SCENARIO, "of_the_class", noise_m=2e-5, replicates=2)
        self.assertEqual({row.estimator for row in judged.rows}, {"of_the_class"})
        (self.folder / "short.toml").write_text(
            f'format = 1\nname = "short"\nscenario = "{SCENARIO}"\nreplicates = 1\nseed = 2\nestimators = '
            '["phase-diagram"]\n[tracks]\nnoise_m = 2e-5\n[[vary]]\nkey = "camera.frame_rate_hz"\nvalues = [100.0]\n')
        swept = glidelab.sweep(self.folder / "short.toml", self.folder / "swept", estimator_command="of_the_class")
        self.assertEqual((swept.outside.name, swept.outside.runs), ("of_the_class", 1))
        for call in (lambda name: glidelab.coverage(SCENARIO, noise_m=2e-5, estimator_command=name),
                     lambda name: glidelab.validate(SCENARIO, estimator_command=name)):
            with self.assertRaises(glidelab.InputError) as caught:
                call("of_the_clas")
            self.assertEqual(caught.exception.key, "estimator_command")
            self.assertIn("of_the_class", caught.exception.expected)

    def test_it_is_not_judged_under_one_name_twice_at_once(self):
        def inner(tracks):
            return {}

        seen = []

        def nested(tracks):
            inner.__name__ = "nested"
            try:
                glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, estimator_command=inner)
            except glidelab.InputError as error:
                seen.append(error.key)
            return {}

        glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, estimator_command=nested)
        self.assertEqual(set(seen), {"estimator_command"})
        self.assertFalse([key for key in os.environ if key.startswith("GLIDELAB_FUNCTION")])
