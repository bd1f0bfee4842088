"""Results: numbers against closed forms, tables, plots, pickling."""

import dataclasses
import json
import pickle
import unittest

import numpy as np

import glidelab
from tests.python.support import SOURCE, InFolder, damped, needs


class AnalysisOfArrays(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.t, cls.x = damped()
        cls.analysis = glidelab.analyze(cls.t, cls.x, mass_kg=0.335, incline_deg=4.3)

    def test_it_recovers_what_was_put_in(self):
        found = self.analysis.configuration
        # Four standard deviations of the estimate itself: one false alarm in 10000, and the seed is fixed.
        for quantity, truth in ((found.k_over_m_1_s, 2.77), (found.mu, 0.0071), (found.alpha_deg, 4.3)):
            self.assertLess(abs(float(quantity) - truth), 4.0 * quantity.sd)
            self.assertLess(quantity.sd, 0.02 * truth)
            self.assertLess(quantity.interval95[0], float(quantity))

    def test_arrays_are_those_of_the_input_and_cannot_be_written_to(self):
        motion = self.analysis.clips[0].motion
        self.assertEqual(motion.t_s.tolist(), self.t.tolist())
        self.assertEqual(motion.measured_x_m.tolist(), self.x.tolist())
        self.assertGreater(motion.used.sum(), 200)
        with self.assertRaises(ValueError):
            motion.x_m[0] = 0.0

    def test_a_number_without_a_value_says_why(self):
        t, x = damped(duration_s=0.5)  # it turns after 0.6 s: one direction alone
        flat = glidelab.analyze(t, x).configuration
        self.assertFalse(flat.alpha_deg.determined)
        self.assertTrue(flat.alpha_deg.why)
        with self.assertRaises(ValueError):
            float(flat.alpha_deg)

    def test_pickling_keeps_numbers_and_text(self):
        again = pickle.loads(pickle.dumps(self.analysis))
        self.assertEqual(again.to_json(), self.analysis.to_json())
        self.assertEqual(str(again), str(self.analysis))
        self.assertEqual(again.configurations, self.analysis.configurations)
        with self.assertRaises(RuntimeError):
            again.write(self.folder / "page")

    def test_as_a_dict_it_is_its_public_data(self):
        def names(value):
            """All keys, of whatever depth."""
            if isinstance(value, dict):
                return set(value).union(*(names(one) for one in value.values()))
            return set().union(*(names(one) for one in value)) if isinstance(value, (list, tuple)) else set()

        scenario = SOURCE / "scenarios" / "paper" / "inclined.toml"
        for result in (glidelab.plan(scenario, noise_m=2e-5), glidelab.coverage(scenario, noise_m=2e-5, replicates=2),
                       glidelab.judge(scenario, noise_m=2e-5, replicates=2), self.analysis, glidelab.simulate(scenario),
                       *glidelab.render(SOURCE / "scenarios" / "tutorial.toml").values()):
            with self.subTest(type(result).__name__):
                plain = dataclasses.asdict(result)
                self.assertTrue(all(isinstance(key, str) and not key.startswith("_") for key in names(plain)))
                text = json.dumps(plain, default=lambda array: array.tolist())  # numpy's arrays are all that JSON lacks
                self.assertGreater(len(text), 30)

    def test_the_page_is_written(self):
        self.analysis.write(self.folder / "page")
        self.assertIn("<html", (self.folder / "page" / "report.html").read_text())

    def test_a_notebook_shows_a_table(self):
        self.assertIn("<table>", self.analysis._repr_html_())
        self.assertIn("K/m", self.analysis._repr_html_())

    def test_a_notebook_shows_where_the_law_does_not_fit(self):
        self.assertEqual(self.analysis.doubts, ())
        rising = glidelab.analyze(*damped(k_1_s=-0.5, v0_m_s=-0.6), mass_kg=0.335)  # what drives it grows with v
        self.assertIn("below zero", rising.doubts[0])
        self.assertIn("below zero", rising._repr_html_())

    @needs("pandas")
    def test_tables_have_units(self):
        table = self.analysis.to_frame()
        self.assertEqual(table.attrs["units"]["k_over_m_1_s_sd"], "1/s")
        self.assertEqual(table.attrs["units"]["mu"], "")
        self.assertEqual(table["mu"][0], float(self.analysis.configuration.mu))
        motion = self.analysis.clips[0].motion.to_frame()
        self.assertEqual(len(motion), len(self.t))
        self.assertEqual(motion.attrs["units"]["sd_a_m_s2"], "m/s²")

    @needs("matplotlib")
    def test_plots(self):
        import matplotlib
        matplotlib.use("Agg")
        axes = self.analysis.plot()
        self.assertEqual(axes[0].get_xlabel(), "v (m/s)")
        self.assertEqual(len(axes[0].lines), 2 + len(self.analysis.clips[0].segments))

    @needs("matplotlib")
    def test_many_plots_stand_three_in_a_row(self):
        import matplotlib
        matplotlib.use("Agg")
        from glidelab._shown import new_axes
        axes = new_axes(7)
        self.assertEqual(len(axes), 7)
        places = [ax.get_subplotspec() for ax in axes]
        self.assertEqual([(place.rowspan.start, place.colspan.start) for place in places],
                         [(i // 3, i % 3) for i in range(7)])
        self.assertEqual(len(axes[0].figure.axes), 9)
        self.assertFalse(any(ax.axison for ax in axes[0].figure.axes[7:]))


class RequirementOfTracks(InFolder):
    def test_the_table_has_each_error_and_the_least_one(self):
        scenario = SOURCE / "scenarios" / "paper" / "inclined.toml"
        (self.folder / "two.toml").write_text(
            f'format = 1\nname = "two"\nscenario = "{scenario}"\nlevel = "tracks"\nreplicates = 1\n'
            '[[vary]]\nkey = "tracks.noise_m"\nvalues = [1e-5, 4e-5]\n')
        answer = glidelab.require(self.folder / "two.toml", ["mu=0.001"], track_runs=20)
        self.assertEqual(answer.targets, ("mu 95 % error 0.001",))
        fine, coarse = answer.candidates
        # The bound goes with the noise, and no error is far below its bound: 20 runs tell it to a sixth.
        self.assertAlmostEqual(coarse.bounds[0] / fine.bounds[0], 4.0, places=3)
        for one in answer.candidates:
            self.assertTrue(one.reached)
            self.assertGreater(one.errors[0], 0.5 * one.bounds[0])
            self.assertIn(f"{one.bounds[0]:.2g}", answer._repr_html_())


class Quantities(unittest.TestCase):
    def test_a_value_is_rounded_to_its_uncertainty(self):
        for value, sd, said in ((2.7791, 0.0061, "2.7791 ± 0.0061"), (2.7791, 0.0132, "2.779 ± 0.013"),
                                (1234.5, 25.0, "1234 ± 25"), (0.5, None, "0.5"), (2.0, 0.0196, "2.000 ± 0.020"), (0.5, 0.0996, "0.50 ± 0.10")):
            self.assertEqual(str(glidelab.Quantity(value, sd)), said)
        self.assertEqual(str(glidelab.Quantity(2.7791, 0.0061, unit="1/s")), "2.7791 ± 0.0061 1/s")
        self.assertEqual(str(glidelab.Quantity(4.309, 0.0031, unit="°")), "4.3090 ± 0.0031°")


class CtrlC(unittest.TestCase):
    def test_an_interrupt_ends_the_work_and_the_next_call_runs(self):
        import _thread
        import threading
        import time
        t, x = damped()
        tracks = [glidelab.Track(t, x + 1e-9 * i, mass_kg=0.3 + 0.01 * i, name=f"m{i}") for i in range(12)]
        started = threading.Event()

        def press():
            started.wait(60.0)
            _thread.interrupt_main()

        presser = threading.Thread(target=press)
        presser.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            glidelab.diagnose(tracks, progress=lambda stage, fraction: started.set())
        self.assertLess(time.monotonic() - begin, 60.0)
        presser.join()
        self.assertEqual(len(glidelab.analyze(t, x).clips), 1)

    def test_an_interrupt_ends_the_smoothers_and_the_bandwidth_rules(self):
        import _thread
        import functools
        import sys
        import threading
        from unittest import mock
        from glidelab import _glidelab
        even = np.arange(200_000) / 100.0
        uneven = np.cumsum(np.random.default_rng(1).uniform(0.004, 0.016, 60_000))
        before = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, before)
        for name, call in (("smooth_by", lambda: glidelab.smooth(even, np.sin(even), smoother="kalman")),
                           ("smooth_by", lambda: glidelab.smooth(even, np.sin(even), smoother="spline")),
                           ("smooth", lambda: glidelab.smooth(uneven, np.sin(uneven), 2.0)),
                           ("smooth_at", lambda: glidelab.smooth(uneven, np.sin(uneven), 2.0, at_s=uneven[:-1] + 1e-4)),
                           ("choose_bandwidth", lambda: glidelab.choose_bandwidth(uneven, np.sin(uneven), "cv"))):
            started, work, returned = threading.Event(), getattr(_glidelab, name), []

            def press(started=started):
                started.wait(60.0)
                _thread.interrupt_main()

            def pressed(*given, work=work, started=started, returned=returned):
                """The key is pressed once the work has let go of the interpreter. What the work returns nevertheless is in
                `returned` before Python looks at the signal."""
                sys.setswitchinterval(1000.0)
                started.set()
                returned.extend(map(functools.partial(work, *given[:-1]), given[-1:]))

            presser = threading.Thread(target=press)
            presser.start()
            with self.subTest(name), mock.patch.object(_glidelab, name, pressed):
                with self.assertRaises(KeyboardInterrupt):
                    call()
                self.assertEqual(len(returned), 0)
            sys.setswitchinterval(before)
            presser.join()

    def test_what_the_progress_function_raises_comes_out(self):
        t, x = damped()

        def stop(stage, fraction):
            raise LookupError(f"{stage}: {fraction}")

        with self.assertRaises(LookupError):
            glidelab.analyze(t, x, progress=stop)

    def test_the_last_report_is_that_all_is_done(self):
        t, x = damped()
        scenario = SOURCE / "scenarios" / "paper" / "inclined.toml"
        for work in (lambda told: glidelab.diagnose(t, x, progress=told), lambda told: glidelab.analyze(t, x, progress=told),
                     lambda told: glidelab.coverage(scenario, noise_m=2e-5, replicates=2, progress=told),
                     lambda told: glidelab.judge(scenario, noise_m=2e-5, replicates=2, progress=told)):
            told = []
            work(lambda stage, fraction, to=told: to.append((stage, fraction)))
            self.assertEqual(told[-1][1], 1.0, told[-1])

    def test_the_interpreter_runs_on_meanwhile(self):
        import threading
        t, x = damped()
        counted = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1

        counter = threading.Thread(target=count)
        counter.start()
        before = counted[0]
        glidelab.diagnose(t, x)
        during = counted[0] - before
        done.set()
        counter.join()
        self.assertGreater(during, 1000)  # with the lock held it would be of the order of one
