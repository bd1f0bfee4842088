#!/usr/bin/python3
"""The everyday experiments: the law has its closed form, effects of size 0 do nothing, and the program reads the folders.

usage: test_everyday.py GLIDELAB
"""

import copy
import filecmp
import os
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import everyday  # noqa: E402  exits with 77 without numpy or scipy
import everyday_effects as effects  # noqa: E402
import everyday_physics as physics  # noqa: E402
import everyday_shares as shares  # noqa: E402
import everyday_unlisted as unlisted  # noqa: E402
import numpy as np  # noqa: E402

GLIDELAB = sys.argv.pop(1)
MAKER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "everyday.py")


def some_clips():
    """A glider that turns round on a slope, slides down it, and comes to rest on the level; two masses."""
    glider = physics.Glider(drag=0.4, mu=0.01)
    clips = []
    for n, (mass, alpha, x0, v0) in enumerate([(0.3, 0.05, 1.2, -0.9), (0.5, 0.05, 0.1, 0.3), (0.3, 0.0, 0.2, 0.5),
                                               (0.5, 0.0, 1.0, -0.4), (0.5, 0.05, 1.1, -0.7), (0.3, 0.05, 0.2, 0.0)]):
        clip = physics.Clip(n, n % 4, mass, alpha, x0, v0, np.arange(0.0, 2.5, 0.02), "up", mass, np.degrees(alpha), "g")
        clip.path = physics.closed_form(glider, clip, clip.times)
        clips.append(clip)
    return glider, clips


class Law(unittest.TestCase):
    def test_the_nominal_motion_is_its_closed_form(self):
        glider, clips = some_clips()
        for clip in clips:
            x, _ = physics.motion(glider, [], clip, clip.times, rtol=1e-10)
            # The solver's error a step is 1e-10 of x, and grows along some hundred steps.
            np.testing.assert_allclose(x, physics.closed_form(glider, clip, clip.times), atol=1e-8)

    def test_the_closed_form_obeys_the_law(self):
        glider, clips = some_clips()
        for clip in clips:
            h = 1e-3  # central differences are good to h² x''''/12, 1e-7 here, and to 1e-16/h² = 1e-10 of rounding
            t = np.array([0.1, 0.2, 0.3])
            x = [physics.closed_form(glider, clip, np.concatenate(([0.0], t + s * h)))[1:] for s in (-1, 0, 1)]
            v, a = (x[2] - x[0]) / (2 * h), (x[2] - 2 * x[1] + x[0]) / h ** 2
            force = (clip.mass * physics.G * (np.sin(clip.alpha) - np.sign(v) * glider.mu * np.cos(clip.alpha))
                     - glider.drag * v)
            np.testing.assert_allclose(clip.mass * a, force, atol=1e-5)

    def test_a_glider_at_rest_stays_until_the_force_exceeds_its_friction(self):
        glider = physics.Glider(drag=0.1, mu=0.02)
        clip = physics.Clip(0, 0, 0.5, 0.0, 0.3, 0.0, np.arange(0.0, 1.0, 0.01), "released", 0.5, 0.0, "g",
                            force=lambda t: 0.5 * t)
        x, _ = physics.motion(glider, [], clip, clip.times)
        sets_off = glider.mu * clip.mass * physics.G / 0.5
        self.assertTrue(np.all(x[clip.times < sets_off] == 0.3))
        self.assertGreater(x[-1], 0.301)

    def test_an_effect_does_nothing_at_size_0_and_something_at_its_own(self):
        glider, clips = some_clips()
        d = effects.design(clips)
        for kind in effects.LIST + unlisted.OFF_LIST + unlisted.IMPERFECTIONS:
            with self.subTest(kind.id):
                effect = kind.draw(np.random.default_rng(1), d, glider)
                self.assertIsNotNone(effect)
                absent = copy.copy(effect)
                absent.size = 0.0
                far = error = 0.0
                for clip in clips:
                    nominal = physics.closed_form(glider, clip, clip.times)
                    if not getattr(kind, "fixed_size", False):
                        error = max(error, np.abs(physics.seen(glider, [absent], clip) - nominal).max())
                    far = max(far, np.abs(physics.seen(glider, [effect], clip) - nominal).max())
                self.assertLess(error, 5e-6)  # the solver's, 1e-6 a step
                self.assertGreater(far, 5e-6)

    def test_a_fit_takes_up_another_K_and_not_a_quadratic_drag(self):
        glider, clips = some_clips()
        fit = physics.NominalFit(glider, clips, 1e-4, 1e-3)
        other = physics.Glider(drag=glider.drag * 1.01, mu=glider.mu)
        self.assertGreater(np.mean(np.square(physics.nominal(other, clips[0], clips[0].times) - fit.base[0])), 1e-8)
        self.assertLess(fit.excess([physics.nominal(other, c, c.times) for c in clips]), 0.05)
        drag = effects.QuadraticDrag(0.1)
        self.assertGreater(fit.excess([physics.seen(glider, [drag], c) for c in clips]), 10.0)

    def test_of_two_causes_that_do_the_same_the_first_takes_all_and_of_two_unlike_ones_each_its_own(self):
        glider, clips = some_clips()
        maker = everyday.Maker(glider, clips, 1e-4, 1e-3)
        drag, same = effects.QuadraticDrag(0.02), effects.QuadraticDrag(0.02)
        shake = effects.CameraMotion(6e-4, omega=20.0, phase=np.arange(6.0))
        for causes in ([drag, same], [drag, shake]):
            positions = maker.positions(causes)
            whole = maker.fit.excess(positions)
            first, left = shares.in_order(maker, causes, positions, whole)
            self.assertLess(left, 0.02)
            self.assertAlmostEqual(sum(first), 2.0 if causes[1] is same else 1.0, delta=0.05)
            alone = 1.0 - maker.excess([causes[1]]) / whole  # without the first
            self.assertAlmostEqual(alone, 0.75 if causes[1] is same else first[0], delta=0.05)


class Folders(unittest.TestCase):
    def test_a_seed_makes_the_same_folders_and_the_program_reads_them(self):
        with tempfile.TemporaryDirectory() as out:
            for name in ("a", "b"):
                subprocess.run([sys.executable, MAKER, "make", "--cases", "3", "--seed", "11", "--jobs", "1", "--out",
                                os.path.join(out, name)], check=True)
            cases = [c for c in sorted(os.listdir(os.path.join(out, "a"))) if not c.endswith(".truth")]
            self.assertEqual(len(cases), 3)
            for case in cases:
                for folder in (case, case + "/tracks", case + ".truth"):
                    same = filecmp.dircmp(*(os.path.join(out, name, folder) for name in ("a", "b")))
                    self.assertFalse(same.diff_files + same.left_only + same.right_only)
                    self.assertTrue(same.same_files)
                done = subprocess.run([GLIDELAB, "check", os.path.join(out, "a", case), "-q", "-o",
                                       os.path.join(out, "check-" + case)], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
