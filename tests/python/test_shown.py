"""What a notebook shows of a result: tables with its numbers, and plots where matplotlib is; and how columns are labelled."""

import csv
import html
import json
import re
import unittest
from unittest import mock

import numpy as np

import glidelab
from glidelab._results import BY_ROW, unit_of
from glidelab._shown import html_plot
from tests.python.support import SOURCE, InFolder, damped, needs, read_json

SCENARIO = SOURCE / "scenarios" / "paper" / "inclined.toml"
PLOT = '<img alt="plot" src="data:image/png;base64,'


def made_sweep(folder, values="[100.0, 200.0]", key="camera.frame_rate_hz"):
    (folder / "sweep.toml").write_text(
        f'format = 1\nname = "short"\nscenario = "{SCENARIO}"\nreplicates = 2\nseed = 2\nestimators = '
        f'["phase-diagram"]\n[tracks]\nnoise_m = 2e-5\n[[vary]]\nkey = "{key}"\nvalues = {values}\n')
    return glidelab.sweep(folder / "sweep.toml", folder / "out")


class Shown(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.coverage = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=5)
        t, x = damped()
        cls.smooth = glidelab.smooth(t, x, smoother="kalman", breaks_s=[0.6])
        cls.local = glidelab.smooth(t, x, 0.03, noise_m=2e-5)

    def shown(self, result):
        """Its HTML, which has a table and no text as it was printed."""
        said = result._repr_html_()
        self.assertIn("<table>", said)
        self.assertNotIn("<pre>", said)
        return said

    def test_coverage(self):
        said = self.shown(self.coverage)
        for row in self.coverage.rows:
            self.assertIn(f"<td>{row.determined} of 5</td>", said)
            self.assertIn(f"{100.0 * row.interval95[0]:.1f} to {100.0 * row.interval95[1]:.1f} %", said)
        self.assertEqual(said.count("<tr>"), len(self.coverage.rows) + 1)

    def test_a_prompt_shows_one_line_and_explain_the_words(self):
        judged = glidelab.judge(SCENARIO, noise_m=2e-5, replicates=2)
        bandwidth = glidelab.choose_bandwidth(*damped(duration_s=0.5))
        for result in (self.coverage, self.smooth, self.local, judged, bandwidth):
            self.assertRegex(repr(result), r"^<glidelab\.\w+: [^\n]*>$")
            self.assertEqual(glidelab.explain(result), str(result))
        self.assertIn("smoothing time (s)", glidelab.explain(self.smooth))
        self.assertIn(f"{float(bandwidth):.4g} s", glidelab.explain(bandwidth))

    def test_so_does_whatever_has_arrays_or_parts(self):
        t, x = damped()
        analysis = glidelab.analyze(t, x, mass_kg=0.3, name="mine")
        clip, = analysis.clips
        simulated = glidelab.simulate(SCENARIO).clips[0]
        for result in (analysis, clip, clip.motion, analysis.configuration, simulated, glidelab.Track(t, x, name="up"),
                       self.smooth.strength, next(iter(glidelab.render(SCENARIO).values())),
                       glidelab.diagnose(t, x).residuals[0]):
            self.assertRegex(repr(result), r"^<glidelab\.%s: [^\n]{,300}>$" % type(result).__name__)
        self.assertEqual(repr(glidelab.Track(t, x, mass_kg=0.3, name="up")),
                         f"<glidelab.Track: {len(t)} values, mass_kg=0.3, incline_deg=0, name='up', mass_sd_kg=0, "
                         "launched='unknown'>")
        self.assertIn(f"mu={analysis.configuration.mu}", repr(analysis.configuration))
        self.assertIn("len(clips)=1, len(configurations)=1", repr(analysis))

    def test_what_is_of_no_command_is_json_as_well(self):
        judged = glidelab.judge(SCENARIO, noise_m=2e-5, replicates=2)
        order_1 = glidelab.smooth(*damped(), 0.03, order=1)  # a is NaN
        bandwidth = glidelab.choose_bandwidth(*damped(duration_s=0.5))
        for result in (judged, self.smooth, order_1, bandwidth):
            text = json.dumps(result.to_dict(), allow_nan=False)
            self.assertEqual(json.loads(text), result.to_dict())
        self.assertEqual(judged.to_dict()["rows"][0]["bias"], judged.rows[0].bias)
        self.assertEqual(self.smooth.to_dict()["a_m_s2"], self.smooth.a_m_s2.tolist())
        self.assertEqual(set(order_1.to_dict()["a_m_s2"]), {None})

    def test_what_is_of_no_command_writes_itself(self):
        judged = glidelab.judge(SCENARIO, "phase-diagram", noise_m=2e-5, replicates=2)
        t, x = damped(duration_s=0.5)
        local = glidelab.choose_bandwidth(t, x, "ici")
        for result, name, columns in (
                (judged, "judgement", {"bias": [row.bias for row in judged.rows], "truth": [row.truth for row in judged.rows]}),
                (self.smooth, "smoothed", {"a_m_s2": self.smooth.a_m_s2, "sd_a_m_s2": self.smooth.sd_a_m_s2}),
                (glidelab.smooth(t, x, 0.02, order=1), "smoothed", {"t_s": t, "a_m_s2": [None] * len(t)}),
                (local, "bandwidth", {"t_s": local.at_s, "bandwidth_s": local.local_s})):
            with self.subTest(name):
                folder = self.folder / "new" / name
                result.write(folder)
                self.assertEqual({one.name for one in folder.iterdir()}, {f"{name}.csv", f"{name}.json", "report.html"})
                self.assertEqual(read_json(folder / f"{name}.json"), result.to_dict())
                with open(folder / f"{name}.csv", newline="") as file:
                    rows = list(csv.DictReader(file))
                for column, values in columns.items():  # all digits
                    self.assertEqual([float(row[column]) if row[column] else None for row in rows], list(values))
                page = (folder / "report.html").read_text()
                self.assertIn("<table>", page)
                self.assertEqual((page.count("<html"), page.count("</html>")), (1, 1))
        plain = glidelab.choose_bandwidth(t, x, "plug-in")  # one number: no table
        plain.write(self.folder / "plain")
        self.assertEqual(sorted(one.name for one in (self.folder / "plain").iterdir()), ["bandwidth.json", "report.html"])
        (self.folder / "file").write_text("")
        with self.assertRaises(glidelab.SystemFailure):
            plain.write(self.folder / "file")
        with self.assertRaises(glidelab.InputError):
            plain.write(3)

    def test_a_bandwidth_the_rules_and_a_track_are_tables_too(self):
        t, x = damped(duration_s=0.5)
        for rule in ("plug-in", "ici"):
            pick = glidelab.choose_bandwidth(t, x, rule)
            self.assertIn(f"<td>{float(pick):.4g}</td>", self.shown(pick))
        rules = glidelab.bandwidth_rules()
        said = self.shown(rules)
        self.assertEqual(said.count("<tr>"), len(rules) + 1)
        for rule in rules:
            self.assertIn(f"<td>{rule.name}</td>", said)
            self.assertEqual(self.shown(rule).count("<tr>"), 2)
        said = self.shown(glidelab.Track(t, x, mass_kg=0.335, name="a < b", launched="up"))
        for part in ("a &lt; b", "<td>0.335</td>", "<td>up</td>", f"<td>{len(t)}</td>"):
            self.assertIn(part, said)
        self.assertIn("one dimension", self.shown(glidelab.Track(t, np.outer(x, x))))
        self.assertIn("<td>0</td>", self.shown(glidelab.Track([], [])))

    @needs("matplotlib")
    def test_a_judgement_s_points_and_a_plan_s_matrix_are_their_numbers(self):
        import matplotlib
        matplotlib.use("Agg")
        judged = glidelab.judge(SCENARIO, "phase-diagram", "trajectory", noise_m=2e-5, replicates=3)
        axes = judged.plot()
        quantities = list(dict.fromkeys(row.quantity for row in judged.rows))
        self.assertEqual(len(axes), len(quantities))
        for ax, quantity in zip(axes, quantities):
            for container, name in zip(ax.containers, ("phase-diagram", "trajectory")):
                rows = judged.of(name, quantity)
                self.assertEqual(list(container.lines[0].get_ydata()), [row.bias for row in rows])
                for (low, high), row in zip(container.lines[2][0].get_segments(), rows):
                    self.assertAlmostEqual((high[1] - low[1]) / (2.0 * row.sd), 1.0, places=6)
        self.assertIn(PLOT, judged._repr_html_())
        plan = glidelab.plan(SCENARIO, noise_m=2e-5)
        ax = plan.plot()
        self.assertEqual(ax.images[0].get_array().tolist(), plan.to_dict()["isolability"]["cosine"])
        self.assertEqual([label.get_text() for label in ax.get_yticklabels()],
                         [one.id.replace("_", " ") for one in plan.effects if one.seen])
        self.assertIn(PLOT, plan._repr_html_())

    @needs("pandas")
    def test_true_motions_are_a_table(self):
        simulation = glidelab.simulate(SCENARIO)
        table = simulation.to_frame()
        self.assertEqual(len(table), sum(len(clip.t_s) for clip in simulation.clips))
        last = table[table["clip"] == simulation.clips[-1].name]
        self.assertEqual(last["a_m_s2"].tolist(), simulation.clips[-1].a_m_s2.tolist())
        self.assertEqual(last["mode"].tolist(), simulation.clips[-1].mode.tolist())
        self.assertEqual(table.attrs["units"]["v_m_s"], "m/s")

    @needs("pandas")
    def test_every_target_and_every_size_has_its_column_and_unit(self):
        (self.folder / "two.toml").write_text(
            f'format = 1\nname = "two"\nscenario = "{SCENARIO}"\nlevel = "tracks"\n'
            '[[vary]]\nkey = "tracks.noise_m"\nvalues = [1e-5, 4e-5]\n')
        answer = glidelab.require(self.folder / "two.toml", ["mu=0.001", "alpha_deg=0.1"], track_runs=20)
        frame = answer.to_frame()
        self.assertEqual(frame["error_2"].tolist(), [one.errors[1] for one in answer.candidates])
        self.assertEqual((frame.attrs["units"]["error"], frame.attrs["units"]["bound_2"]), ("", "°"))
        self.assertEqual(frame.attrs["targets"], list(answer.targets))
        rows = answer.to_frame(by_target=True)
        self.assertEqual(rows["target"].tolist(), 2 * list(answer.targets))
        self.assertEqual(rows["error"].tolist(), [error for one in answer.candidates for error in one.errors])
        self.assertEqual(rows["bound"].tolist(), [bound for one in answer.candidates for bound in one.bounds])
        self.assertEqual((rows.attrs["units"]["error"], rows["unit"].tolist()), (BY_ROW, ["", "°", "", "°"]))
        plan = glidelab.plan(SCENARIO, noise_m=2e-5).to_frame().set_index("id")
        self.assertEqual(plan.attrs["units"]["seen_from"], BY_ROW)
        self.assertEqual((plan["unit"]["quadratic_drag"], plan["unit"]["load_independent_friction"]), ("kg/m", "N"))

    def test_sweep(self):
        sweep = made_sweep(self.folder)
        said = self.shown(sweep)
        document = sweep.to_dict()
        for row in [*document["overall"], *document["axes"][0]["groups"]]:
            self.assertIn(f"<td>{row['rms_error']:.3g}</td>", said)
        self.assertIn("<th>camera.frame_rate_hz</th>", said)

    def test_smoothed(self):
        said = self.shown(self.smooth)
        self.assertIn(f"{self.smooth.strength.time_s:.4g}", said)
        self.assertIn(f"{self.smooth.a_m_s2.min():.3g} to {self.smooth.a_m_s2.max():.3g}", said)
        self.assertIn("0.03", self.shown(self.local))
        order_1 = glidelab.smooth(*damped(), 0.03, order=1)  # which has no a
        self.assertIn("<td>none</td>", self.shown(order_1))

    @needs("matplotlib")
    def test_plots_stand_in_it_and_no_window_opens(self):
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        pyplot.close("all")
        t, x = damped()
        analysis = glidelab.analyze([glidelab.Track(t, x, mass_kg=0.3)])
        for result in (self.coverage, self.smooth, self.local, made_sweep(self.folder), analysis,
                       glidelab.simulate(SCENARIO), glidelab.diagnose(t, x)):
            said = result._repr_html_()
            self.assertNotIn("<pre>", said)
            self.assertEqual(said.count(PLOT), 1)
            self.assertEqual(pyplot.get_fignums(), [])
        self.coverage.plot()
        self.assertEqual(len(pyplot.get_fignums()), 1)
        pyplot.close("all")

    def test_without_matplotlib_the_tables_are_there(self):
        with mock.patch("importlib.util.find_spec", return_value=None):
            self.assertNotIn("<img", self.shown(self.coverage))
        self.assertEqual(html_plot(list), "")

    @needs("matplotlib")
    def test_coverage_s_bars_are_its_numbers(self):
        import matplotlib
        matplotlib.use("Agg")
        ax = self.coverage.plot()
        self.assertEqual([bar.get_width() for bar in ax.patches],
                         [100.0 * row.coverage for row in self.coverage.rows if row.coverage is not None])
        spans = [tuple(line.get_xdata()) for line in ax.lines if len(set(line.get_ydata())) == 1]
        self.assertEqual(spans, [tuple(100.0 * end for end in row.interval95) for row in self.coverage.rows
                                 if row.coverage is not None])

    @needs("matplotlib")
    def test_a_sweep_s_curves_are_its_numbers_words_one_after_the_other(self):
        import matplotlib
        matplotlib.use("Agg")
        sweep = made_sweep(self.folder)
        axes = sweep.plot()
        groups = sweep.to_dict()["axes"][0]["groups"]
        quantities = list(dict.fromkeys(row["quantity"] for row in groups))
        self.assertEqual(len(axes), len(quantities))
        for ax, quantity in zip(axes, quantities):
            self.assertEqual(list(ax.lines[0].get_xdata()), [100.0, 200.0])
            self.assertTrue(ax.get_ylabel().startswith("rms error of "))
            self.assertNotIn("_", ax.get_ylabel())
            self.assertEqual(list(ax.lines[0].get_ydata()),
                             [row["rms_error"] for row in groups if row["quantity"] == quantity])
        from glidelab._sweeps import _numbers
        self.assertEqual(_numbers(["1", "2.5"]), [1.0, 2.5])
        self.assertEqual(_numbers(["lens a", "lens b"]), [0.0, 1.0])

    @needs("matplotlib")
    def test_bands_of_a_are_as_wide_as_stated(self):
        import matplotlib
        matplotlib.use("Agg")
        for smooth, factors in ((self.smooth, [self.smooth.strength.simultaneous_a, 1.959964]), (self.local, [1.959964])):
            ax = smooth.plot()
            self.assertEqual(len(ax.collections), len(factors))
            for band, factor in zip(ax.collections, factors):
                outline = band.get_paths()[0].vertices
                middle = np.nonzero(outline[:, 0] == smooth.t_s[100])[0]
                width = np.ptp(outline[middle, 1])
                self.assertAlmostEqual(width / (2.0 * factor * smooth.sd_a_m_s2[100]), 1.0, places=9)

    @needs("matplotlib")
    def test_errors_of_a_validation_and_of_a_requirement(self):
        import matplotlib
        matplotlib.use("Agg")
        found = tuple(glidelab.Recovery("m1", name, "mu", 0.01, 0.011, 0.001, 0.001, 0.0005) for name in ("a", "b"))
        made = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2)._made
        validation = glidelab.Validation(made, found, 1, 1, "{}")
        (ax,) = validation.plot()
        self.assertEqual(ax.get_ylabel(), "error of µ")
        self.assertIn(PLOT, validation._repr_html_())
        self.assertIn("<td>µ</td>", validation._repr_html_())
        self.assertIn("<td>+1.00</td><td>0.0005</td>", validation._repr_html_())
        self.assertIn(html.escape(" ".join(str(validation).partition("\n\n")[0].split())), validation._repr_html_())
        requirement = glidelab.Requirement(made, "r", (glidelab.Candidate("c", True, "yes", 1.0, 2.0, 1e-5, (1e-4,),
                                                                          (1e-5,), (5e-5,)),), ("mu",))
        self.assertEqual(len(requirement.plot()), 1)
        self.assertIn(PLOT, requirement._repr_html_())

    def test_a_diagnosis_shows_all_its_tables(self):
        t, x = damped()
        diagnosis = glidelab.diagnose([glidelab.Track(t, x, 0.3, 4.3, f"clip-{i}") for i in range(2)])
        said = self.shown(diagnosis)
        for part in (diagnosis.summary, diagnosis.next_experiment, *diagnosis.notes,
                     *(one["id"] for one in diagnosis.to_dict()["ranking"]),
                     *(str(one.mu) for one in diagnosis.recovered)):
            self.assertIn(html.escape(part), said)

    @needs("matplotlib")
    def test_a_blind_run_s_bars_and_counts_are_its_numbers(self):
        import matplotlib
        matplotlib.use("Agg")
        made = glidelab._results.Made.__new__(glidelab._results.Made)
        targets = (glidelab.BlindTarget("finds it", 4, 3, 0.75, 0.9, None, False),
                   glidelab.BlindTarget("no false alarm", 2, 2, 1.0, 0.95, None, True),
                   glidelab.BlindTarget("seconds", None, None, 3.0, None, 60.0, True))
        cases = tuple(glidelab.BlindCase(i, kind, (), verdict, ()) for i, (kind, verdict) in enumerate(
            [("single", "effect")] * 3 + [("single", "unknown"), ("none", "none"), ("none", "none")]))
        blind = glidelab.Blind(made, 1, 0, targets, 0.1, cases, "")
        shares, counts = blind.plot()
        self.assertEqual([bar.get_width() for bar in shares.patches], [75.0, 100.0])
        self.assertEqual([line.get_xdata()[0] for line in shares.lines], [90.0, 95.0])
        self.assertEqual(counts.images[0].get_array().tolist(), [[2, 0, 0], [0, 3, 1]])
        self.assertEqual([text.get_text() for text in counts.get_yticklabels()], ["none", "single"])
        self.assertEqual([text.get_text() for text in counts.get_xticklabels()], ["none", "effect", "unknown"])
        said = self.shown(blind)
        self.assertIn(PLOT, said)
        self.assertIn("<td>single</td><td>0</td><td>3</td><td>1</td>", said)

    def test_a_smoother_without_a_bandwidth_and_without_breaks_names_neither(self):
        t, x = damped()
        said = str(glidelab.smooth(t[:60], x[:60], smoother="kalman"))
        self.assertNotIn("bandwidth (s)", said)
        self.assertNotIn("breaks (s)", said)
        self.assertIn("breaks (s)", str(self.smooth))
        self.assertRegex(str(self.local), r"bandwidth \(s\) +0\.03\n")

    @needs("pandas")
    def test_a_column_of_numbers_is_one_even_where_all_are_missing(self):
        found = tuple(glidelab.Recovery("m1", "a", "mu", 0.01, value, 0.001, 0.001, None) for value in (0.011, None))
        table = glidelab.Validation(self.coverage._made, found, 1, 1, "{}").to_frame()
        for name in ("value", "cramer_rao_sd"):
            self.assertEqual(table[name].dtype, np.float64)
        self.assertTrue(table["cramer_rao_sd"].isna().all())

    def test_an_explanation_shows_itself_as_it_reads(self):
        said = glidelab.explain(self.coverage)
        self.assertEqual(said, str(self.coverage))
        self.assertEqual(repr(said), str(self.coverage))
        self.assertGreater(len(said.splitlines()), 5)

    @needs("IPython")
    def test_so_does_it_in_a_notebook(self):
        from IPython.lib.pretty import pretty
        said = glidelab.explain(self.coverage)
        self.assertEqual(pretty(said), str(self.coverage))


class OneVocabulary(InFolder):
    @needs("pandas")
    def test_every_study_s_table_has_the_common_columns_beside_its_own(self):
        made = glidelab._results.Made.__new__(glidelab._results.Made)
        certified = glidelab.CertifiedQuantity("mu", 40, 3, 0.9, (0.8, 1.0), 0.1, 2e-4, 1e-4, False)
        certificate = glidelab.Certificate(made, "", True, 40, "trajectory", "tracks", (certified,), (), (), ())
        for study, names in (
                (glidelab.judge(SCENARIO, noise_m=2e-5, replicates=2), {"rms": "rms_error", "covered": "coverage"}),
                (glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2), {"determined": "answered"}),
                (made_sweep(self.folder), {"mean_error": "bias"}), (certificate, {"rms": "rms_error"})):
            with self.subTest(type(study).__name__):
                table = study.to_frame()
                for name in {"answered", "rms_error", "coverage", "bias"} - ({"bias"} if study is certificate else set()):
                    self.assertIn(name, table)
                self.assertEqual(table.attrs["units"]["rms_error"], BY_ROW)
                for own, common in names.items():
                    self.assertTrue((table[own].fillna(-1.0) == table[common].fillna(-1.0)).all())
                    self.assertEqual(table.attrs["units"][own], table.attrs["units"][common])
        self.assertEqual((certified.answered, certified.rms_error), (37, 2e-4))

    def test_the_rms_error_of_a_coverage_is_that_of_its_errors(self):
        # Errors 1, 2 and 6: mean 3, variance (4 + 1 + 9) / 2 = 7, mean square (1 + 4 + 36) / 3.
        row = glidelab.CoverageRow("m1", "e", "mu", 0.0, 3, 3, 3.0, 7.0**0.5, 1.0, 1.0, (0.3, 1.0), 1.0)
        self.assertAlmostEqual(row.rms_error, (41.0 / 3.0) ** 0.5, places=12)
        self.assertEqual(row.answered, 3)
        judged = glidelab.judge(SCENARIO, noise_m=2e-5, replicates=4).rows[0]
        mean_square = judged.bias**2 + judged.sd**2 * 3 / 4
        self.assertAlmostEqual(judged.rms_error**2 / mean_square, 1.0, places=9)
        self.assertEqual(judged.coverage, judged.covered)


class Units(unittest.TestCase):
    def test_they_are_those_that_the_name_ends_with(self):
        for column, unit in (("bandwidth_s", "s"), ("noise_m", "m"), ("frame_rate_hz", "Hz"), ("price_eur", "EUR"),
                             ("mass_kg", "kg"), ("k_over_m_1_s", "1/s"), ("k_over_m_1_s_sd", "1/s"), ("v_m_s", "m/s"),
                             ("sd_a_m_s2", "m/s²"), ("alpha_deg", "°"), ("u_px", "px"), ("force_n", "N"), ("mu", ""),
                             ("mu_sd", ""), ("bias_sds", ""), ("replicates", ""), ("coverage", ""), ("name", "")):
            self.assertEqual(unit_of(column), unit, column)

    @needs("pandas")
    def test_where_they_differ_from_row_to_row_a_column_says_them(self):
        judged = glidelab.judge(SCENARIO, "phase-diagram", noise_m=2e-5, replicates=2).to_frame()
        coverage = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2).to_frame()
        for table, columns in ((judged, ("truth", "bias", "sd", "rms")), (coverage, ("truth", "bias", "sd", "stated_sd"))):
            for column in columns:
                self.assertEqual(table.attrs["units"][column], BY_ROW)
            self.assertEqual(dict(zip(table["quantity"], table["unit"])),
                             {"k_over_m_1_s": "1/s", "mu": "", "alpha_deg": "°", "v_lim_m_s": "m/s"})


    @needs("pandas")
    def test_errors_of_cameras_are_in_the_unit_of_their_target(self):
        from glidelab._results import Made
        from glidelab._sweeps import Candidate, Requirement
        for target, unit in (("k_over_m_1_s 95 % error 0.01", "1/s"), ("mu sd 0.0001", ""), ("alpha_deg bias 0.01", "°")):
            made = Requirement(Made.__new__(Made), "cameras", (Candidate("a", True, "reached", None, None, None),), (target,))
            self.assertEqual(made.to_frame().attrs["units"]["error"], unit)
            self.assertEqual(made.to_frame().attrs["units"]["bound"], unit)
            self.assertEqual(made.to_frame().attrs["units"]["price_eur"], "EUR")


class Bar(unittest.TestCase):
    @needs("tqdm")
    def test_true_is_a_bar_of_tqdm_for_each_stage(self):
        import contextlib
        import io
        t, x = damped()
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            glidelab.diagnose(t, x, progress=True)
        stages = list(dict.fromkeys(re.findall(r"([\w -]+): +\d+%", said.getvalue())))
        self.assertGreater(len(stages), 1)
        for stage in stages[:-1]:  # each is full before the next begins
            self.assertRegex(said.getvalue().split(f"{stages[stages.index(stage) + 1]}: ")[0], rf"{stage}: 100%")

    def test_without_tqdm_it_is_refused(self):
        with mock.patch("importlib.import_module", side_effect=ModuleNotFoundError):
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.judge(SCENARIO, "phase-diagram", noise_m=2e-5, replicates=2, progress=True)
        self.assertEqual(caught.exception.key, "progress")
