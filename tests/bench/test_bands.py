#!/usr/bin/python3
"""bench/bands and the motions that it and bench/peers make: derivatives by differences, counts by closed forms.

usage: test_bands.py SOURCE-FOLDER
"""

import importlib.machinery
import importlib.util
import math
import os
import sys
import unittest

sys.dont_write_bytecode = True
try:
    import numpy as np
except ImportError:
    print("skipped: no numpy (python3-numpy)")
    sys.exit(77)

sys.path.insert(0, os.path.join(sys.argv[1], "bench"))
import made_motions as motions  # noqa: E402

loader = importlib.machinery.SourceFileLoader("bands", os.path.join(sys.argv[1], "bench", "bands"))
bands = importlib.util.module_from_spec(importlib.util.spec_from_loader("bands", loader))
loader.exec_module(bands)

T = np.linspace(0.05, 1.9, 40)
H = 1e-5  # s: of central differences of motions of order 1, 1e-10 of a derivative and 1e-11 of rounding


class Motions(unittest.TestCase):
    def differences_agree(self, motion, t):
        true = motion(t)
        for d in (0, 1):
            by_difference = (motion(t + H)[:, d] - motion(t - H)[:, d]) / (2.0 * H)
            scale = 1.0 + np.abs(true).max()  # third derivatives are up to 25 1/s times the second
            np.testing.assert_allclose(by_difference, true[:, d + 1], atol=1e-7 * scale)

    def test_v_and_a_are_the_derivatives_of_x(self):
        for kind in motions.GLIDERS:
            for seed in range(3):
                with self.subTest(kind=kind, seed=seed):
                    motion, turn = motions.glider(kind, np.random.default_rng(seed), 2.0)
                    self.differences_agree(motion, T if turn is None else T[np.abs(T - turn) > 2.0 * H])
        for kind in motions.OTHERS:
            with self.subTest(kind=kind):
                self.differences_agree(motions.other_motion(kind, np.random.default_rng(5), 2.0), T)
        for kind in ("two sines", "triangle", "logistic growth", "damped spring"):
            with self.subTest(kind=kind):
                self.differences_agree(motions.SIGNALS[kind], T)

    def test_integrated_motions_follow_their_laws(self):
        try:
            import scipy.integrate  # noqa: F401
        except ImportError:
            self.skipTest("no scipy (python3-scipy)")
        t = np.arange(0.0, 1.0, 1e-3)
        for kind in ("controlled car", "Lorenz x"):
            true = motions.SIGNALS[kind](t)
            for d in (0, 1):  # five points: h^4 / 30 of the fifth derivative, of Lorenz's x some 1e7 of its scale
                x = true[:, d]
                by_difference = (x[:-4] - 8.0 * x[1:-3] + 8.0 * x[3:-1] - x[4:]) / 12e-3
                np.testing.assert_allclose(by_difference, true[2:-2, d + 1], atol=1e-4 * (1.0 + np.abs(true[:, d + 1]).max()))

    def test_a_glider_turns_when_told(self):
        motion, turn = motions.glider("viscous, with a reversal", np.random.default_rng(1), 2.0)
        self.assertAlmostEqual(motion(np.array([turn]))[0, 1], 0.0, delta=1e-12)


class Counts(unittest.TestCase):
    def test_the_probability_of_a_count(self):
        """All of 100 hold with 0.95^100, which is doubled; 95 of 100 is the middle."""
        self.assertAlmostEqual(bands.binomial_probability(100, 100), 2.0 * 0.95**100, delta=1e-12)
        self.assertEqual(bands.binomial_probability(95, 100), 1.0)
        self.assertLess(bands.binomial_probability(85, 100), 1e-3)

    def test_a_clip_is_the_same_whatever_else_is_counted(self):
        first, second = (bands.made_clip("drag by v^1.5", 3, 7) for _ in range(2))
        np.testing.assert_array_equal(first[1], second[1])
        self.assertFalse(np.array_equal(first[1][:10], bands.made_clip("drag by v^1.5", 4, 7)[1][:10]))
        self.assertTrue(np.all(np.diff(bands.made_clip("three sines", 1, 4)[0]) > 0.0))  # uneven frames still rise

    def test_a_row_gives_both_shares(self):
        text = bands.row("made", [(0.9, True), (1.0, True), (0.95, False), (0.95, True)])
        error = 100.0 * math.sqrt(0.005 / 3.0 / 4.0)
        self.assertTrue(text.startswith(f"| made | 4 | 95.0 ± {error:.1f} | 75.0 | "))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
