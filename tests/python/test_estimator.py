"""judge(): an estimator of the user's own beside the built-in ones."""

import unittest

import numpy as np

import glidelab
from tests.python.support import SOURCE

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

    def test_what_an_estimator_raises_is_counted_and_told(self):
        calls = []

        def moody(tracks):
            calls.append(len(tracks))
            if len(calls) == 1:
                raise ZeroDivisionError("not today")
            return {"mu": 0.01}

        judged = glidelab.judge(SCENARIO, moody, noise_m=2e-5, replicates=3)
        self.assertEqual({row.failed for row in judged.rows}, {1})
        self.assertEqual(judged.failures, {"moody": "ZeroDivisionError: not today"})

    def test_an_answer_that_is_none_is_refused(self):
        for answer in ({"K": 1.0}, {"mu": (1.0, 2.0, 3.0)}):
            with self.assertRaises(glidelab.InputError):
                glidelab.judge(SCENARIO, lambda tracks, said=answer: said, noise_m=2e-5, replicates=2)
        with self.assertRaises(glidelab.InputError):
            glidelab.judge(SCENARIO, "best", noise_m=2e-5)

    def test_a_registered_one_is_judged_by_default(self):
        @glidelab.estimator
        def mine(tracks):
            return {"alpha_deg": 4.0}

        judged = glidelab.judge(SCENARIO, noise_m=2e-5, replicates=2)
        self.assertEqual(set(judged.seconds), {"phase-diagram", "mine"})
        self.assertEqual(mine([]), {"alpha_deg": 4.0})
