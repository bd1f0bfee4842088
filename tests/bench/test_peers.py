#!/usr/bin/python3
"""bench/peers by closed forms: each method on polynomials that it must reproduce, and the whole on one made track.

usage: test_peers.py SOURCE-FOLDER GLIDELAB
"""

import importlib.machinery
import importlib.util
import math
import os
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
try:
    import numpy as np
except ImportError:
    print("skipped: no numpy (python3-numpy)")
    sys.exit(77)

SOURCE, GLIDELAB = sys.argv[1:3]
sys.path.insert(0, os.path.join(SOURCE, "bench"))
import peers_data as data  # noqa: E402
import peers_methods as methods  # noqa: E402
import peers_signals as signals  # noqa: E402
import peers_tables as tables  # noqa: E402

loader = importlib.machinery.SourceFileLoader("peers", os.path.join(SOURCE, "bench", "peers"))
peers = importlib.util.module_from_spec(importlib.util.spec_from_loader("peers", loader))
loader.exec_module(peers)

H = 0.005  # s, one step
T = np.arange(60) * H
CUBIC = np.array([3.0, -2.0, 0.7, 0.1])  # highest power first


def run_of(x, t=T):
    return {"t": t, "x": x}


def polynomial(coefficients, t=T):
    """x, v, a of a polynomial."""
    return np.column_stack([np.polyval(np.polyder(coefficients, d), t) for d in range(3)])


class Methods(unittest.TestCase):
    def of(self, method, *arguments):
        """What a method makes, or a skipped test where its program is not installed."""
        try:
            return method(*arguments)[0]
        except methods.Missing as missing:
            self.skipTest(f"no {missing}")

    def test_tracker_on_a_cubic(self):
        """(x+ - x-)/2h of c t^3 is 3 c t^2 + c h^2; the parabola through five steps has the cubic's second derivative."""
        true = polynomial(CUBIC)
        (found,) = self.of(methods.tracker, [run_of(true[:, 0])])
        np.testing.assert_allclose(found[1:-1, 1], true[1:-1, 1] + CUBIC[0] * H**2, atol=1e-12)
        np.testing.assert_allclose(found[2:-2, 2], true[2:-2, 2], atol=1e-9)
        self.assertTrue(np.isnan(found[[0, -1], 1]).all() and np.isnan(found[[0, 1, -2, -1], 2]).all())

    def test_tracker_on_a_quartic(self):
        """(2, -1, -2, -1, 2) k^4 / 7 is 62/7: of t^4 at 0, whose second derivative is 0, that times h^2."""
        t = T - T[30]
        (found,) = self.of(methods.tracker, [run_of(t**4, t)])
        self.assertAlmostEqual(found[30, 2], 62.0 / 7.0 * H**2, delta=1e-12)

    def test_savitzky_golay_reproduces_a_cubic(self):
        true = polynomial(CUBIC)
        (found,) = self.of(methods.savitzky_golay, [run_of(true[:, 0])], 0.1)
        for d, tolerance in ((0, 1e-12), (1, 1e-10), (2, 1e-7)):  # rounding, over h for each derivative
            np.testing.assert_allclose(found[:, d], true[:, d], atol=tolerance)

    def test_univariate_spline_leaves_what_was_asked_for(self):
        """Where no polynomial of degree 5 does, FITPACK ends where the weighted squares of the residuals come to s within 0.1 %."""
        x = 0.01 * np.sin(40.0 * T) + 1e-4 * np.random.default_rng(1).standard_normal(len(T))
        for factor in (0.7, 1.0, 2.0):
            (found,) = self.of(methods.univariate_spline, [run_of(x)], factor)
            squares = np.sum(((x - found[:, 0]) / methods.noise(x)) ** 2)
            self.assertAlmostEqual(squares / (factor * len(x)), 1.0, delta=2e-3)

    def test_smoothing_spline_keeps_a_line_and_without_a_penalty_the_positions(self):
        for penalty in (1e-8, 1e-3):
            (found,) = self.of(methods.smoothing_spline, [run_of(0.2 - 1.5 * T)], penalty)
            for d, true, tolerance in ((0, 0.2 - 1.5 * T, 1e-9), (1, -1.5, 1e-6), (2, 0.0, 1e-3)):
                np.testing.assert_allclose(found[:, d], true, atol=tolerance)
        x = 1e-4 * np.random.default_rng(4).standard_normal(len(T))
        (found,) = self.of(methods.smoothing_spline, [run_of(x)], 1e-16)
        np.testing.assert_allclose(found[:, 0], x, atol=1e-7)

    def test_kernsmooth_of_degree_three_reproduces_a_cubic(self):
        true = polynomial(CUBIC)
        (found,) = self.of(methods.kernsmooth, [run_of(true[:, 0])], [0.04], 3)
        for d, tolerance in ((0, 1e-9), (1, 1e-7), (2, 1e-5)):
            np.testing.assert_allclose(found[:, d], true[:, d], atol=tolerance)

    def test_noise_is_that_of_the_positions(self):
        """A parabola has no third differences; a median of 20000 moduli is known to 0.9 %, neighbours being correlated: 3 %."""
        t = np.arange(20000) * H
        white = 2e-5 * np.random.default_rng(2).standard_normal(len(t))
        self.assertAlmostEqual(methods.noise(0.3 * t + 0.1 * t**2 + white) / 2e-5, 1.0, delta=0.03)


    def test_test_signals_count_errors_inside_and_at_the_ends(self):
        """An error of 0.1 at either end alone is one of the whole: of 10 frames in 400."""
        runs, truth = signals.made_runs("two sines", 0.0, 2)
        np.testing.assert_array_equal(runs[0]["x"], truth[:, 0])
        off = np.zeros_like(truth)
        off[[0, 1, 2, 3, 4, -1, -2, -3, -4, -5], 2] = 0.1
        found = signals.errors("two sines", [truth + off, truth + off], truth)
        np.testing.assert_allclose(found, [0.0, 0.0, 0.0, 0.1 * math.sqrt(10.0 / 400.0)], atol=1e-12)
        self.assertEqual(signals.errors("triangle", [truth], truth)[1::2], [None, None])
        off[200, 1] = np.nan
        self.assertIsNone(signals.errors("two sines", [truth + off], truth)[0])

    def test_the_best_peer_by_its_own_choice_is_none_of_glidelab_and_none_in_hindsight(self):
        def row(method, error, self_choosing=True):
            return {"signal": "s", "noise_m": 0.1, "method": method, "self_choosing": self_choosing, "errors": [error] * 4}

        rows = [row("Glidelab, kalman", 1.0), row("Glidelab, spline", 2.0), row("a", 4.0), row("b", 3.0), row("c", 0.5, False)]
        self.assertEqual(tables.signal_summary(rows, 0, "v").splitlines()[-1], "| s, 0.1 | 1 | 2 | 3 b | 0.5 c |")

    def test_kalman_of_order_three_follows_a_parabola(self):
        """Its noise-free motions are parabolas; the ends are left out. Of noise of 1e-9 m v keeps some 1e-8 / (60 H)."""
        x = 0.2 - 1.5 * T + 0.8 * T**2 + 1e-9 * np.random.default_rng(6).standard_normal(len(T))
        (found,) = self.of(methods.kalman_of_order_three, [run_of(x)])
        self.assertTrue(np.isnan(found[[0, -1], 1]).all())
        np.testing.assert_allclose(found[5:-5, 1], (-1.5 + 1.6 * T)[5:-5], atol=1e-5)


class Data(unittest.TestCase):
    def test_a_missing_frame_ends_a_run_and_joined_puts_values_back(self):
        x = T.copy()
        x[[20, 21]] = np.nan
        clips = [{"t": T, "x": x}]
        runs = data.even_runs(clips)
        self.assertEqual([list(run["frames"][[0, -1]]) for run in runs], [[0, 19], [22, 59]])
        (whole,) = data.joined(clips, runs, [np.column_stack([run["t"]] * 3) for run in runs])
        np.testing.assert_array_equal(whole[:, 0], x)

    def test_errors_take_off_a_constant_of_x_only(self):
        used = np.ones(len(T), bool)
        truth = polynomial(CUBIC)
        motion = truth + np.array([0.5, 0.02, 0.3])
        found = data.errors([{"truth": truth, "used": used}], [motion])
        np.testing.assert_allclose(found, [0.0, 0.02, 0.3, 0.3], atol=1e-12)

    def test_lines_that_are_exact_give_the_parameters(self):
        k, mu, alpha, g = 2.7, 0.006, math.radians(3.0), data.GRAVITY_M_S2
        v = np.concatenate([np.linspace(-1.2, -0.2, 30), np.linspace(0.1, 0.8, 30)])
        a = g * (math.sin(alpha) - mu * math.cos(alpha) * np.sign(v)) - k * v
        motion = np.column_stack([T, v, a])
        clip = {"configuration": 0, "force": None, "mass": 0.3, "used": np.ones(60, bool), "glidelab": {"phase-diagram": motion}}
        (found,) = data.parameters([clip], [motion])
        self.assertAlmostEqual(found["k_over_m"], k, delta=1e-9)
        self.assertAlmostEqual(found["mu"], mu, delta=1e-9)
        self.assertAlmostEqual(found["alpha_deg"], 3.0, delta=1e-6)


def made_track(folder, truth, sd_m):
    """A glider thrown uphill that comes back, by equation (8), with white noise; an experiment and its trajectory."""
    k, alpha, mu, g, v0 = 2.768, math.radians(4.311), 0.0071, data.GRAVITY_M_S2, -1.2
    t = np.arange(340) * H
    up, down = (g * (math.sin(alpha) + s * mu * math.cos(alpha)) for s in (1, -1))

    def motion(x, v, a0, after):
        decay = np.exp(-k * after)
        return np.column_stack([x + a0 / k * after + (v - a0 / k) / k * (1 - decay), a0 / k + (v - a0 / k) * decay, (a0 - k * v) * decay])

    turn = math.log(1.0 - v0 * k / up) / k
    top = motion(0.2, v0, up, np.array([turn]))[0, 0]
    true = np.where((t <= turn)[:, None], motion(0.2, v0, up, t), motion(top, 0.0, down, t - turn))
    x = true[:, 0] + sd_m * np.random.default_rng(3).standard_normal(len(t))
    os.makedirs(os.path.join(folder, "tracks"))
    os.makedirs(truth)
    np.savetxt(os.path.join(folder, "tracks", "up.csv"), np.column_stack([t, x]), "%.9f", ",", header="t_s,x_m", comments="")
    header = "t_s,x_m,v_m_s,a_m_s2"
    np.savetxt(os.path.join(truth, "trajectory-up.csv"), np.column_stack([t, true]), "%.12g", ",", header=header, comments="")
    with open(os.path.join(folder, "experiment.toml"), "w", encoding="utf-8") as text:
        text.write('format = 1\nname = "made"\n[track]\ndownhill = "+X"\n[[clip]]\nname = "up"\ntrack = "tracks/up.csv"\n')
        text.write('mass_kg = 0.335\nincline_deg = 4.0\nlaunched = "up"\n')
    return k


class Whole(unittest.TestCase):
    def test_all_peers_on_a_made_track(self):
        sd_m = 1e-4
        with tempfile.TemporaryDirectory(prefix="peers") as place:
            folder, truth, out = (os.path.join(place, name) for name in ("made", "truth", "out"))
            k = made_track(folder, truth, sd_m)
            subprocess.run([GLIDELAB, "analyze", folder, "-q", "-o", out], check=True, stdout=subprocess.DEVNULL)
            rows, _ = peers.compare(GLIDELAB, folder, out, os.path.join(place, "tracks"), truth)
            of = {row["method"]: row for row in rows}
            # White noise in Tracker's differences: sd / (sqrt(2) h), and sd sqrt(14) / (7 h^2). Of some 250 frames, whose
            # errors are correlated over five: 10 %.
            _, v, a, _ = of["Tracker"]["errors"]
            self.assertAlmostEqual(v / (sd_m / (math.sqrt(2.0) * H)), 1.0, delta=0.15)
            self.assertAlmostEqual(a / (sd_m * math.sqrt(14.0) / (7.0 * H**2)), 1.0, delta=0.15)
            for estimator in data.ESTIMATORS:
                (found,) = of[f"Glidelab, {estimator}"]["parameters"]
                self.assertLess(abs(found["k_over_m"] - k), 5.0 * found["k_over_m_sd"])
            for row in rows:
                row["off"] = data.parameter_errors(row["parameters"], [{"k_over_m": k, "mu": 0.0071, "alpha_deg": 4.311}])
            # The fit by solve_ivp and `trajectory` minimise the same squares; solve_ivp's to 1e-8.
            found, own = (of[name]["parameters"][0]["k_over_m"] for name in ("fit_of_motion.py", "Glidelab, trajectory"))
            self.assertAlmostEqual(found, own, delta=0.3 * of["Glidelab, trajectory"]["parameters"][0]["k_over_m_sd"])
            tables.write(place, [("made", rows)], [])
            errors = data.columns(os.path.join(place, "errors.csv"))
            self.assertEqual(errors["method"], [row["method"] for row in rows])
            self.assertEqual(float(errors["a_m_s2"][errors["method"].index("Tracker")]), a)
            with open(os.path.join(place, "peers.md"), encoding="utf-8") as page:
                self.assertIn("| Tracker |", page.read())
            with open(os.path.join(place, "readme.md"), encoding="utf-8") as page:
                lines = page.read().splitlines()
            self.assertEqual(lines[2].split("|")[1].strip(), "Tracker")
            self.assertEqual({line.count("|") for line in lines}, {9})
            self.assertFalse(any("best" in line for line in lines))
            recordings = tables.readme_recording_table([("made", rows, [{"clips": ["up"]}])]).splitlines()
            self.assertEqual({line.count("|") for line in recordings}, {4})
            self.assertTrue(os.path.getsize(os.path.join(place, "peers.svg")) > 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
