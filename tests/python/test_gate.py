"""gate(): the errors of an estimator, now and in a baseline."""

import json

import numpy as np

import glidelab
from tests.python.support import SOURCE, InFolder, needs, read_json, run

SCENARIO = SOURCE / "scenarios" / "paper" / "inclined.toml"
RUNS = 20


def estimate(tracks, off):
    """K/m from the last digit of a position, which is random: `off` above or below 2.5."""
    sign = 1.0 if round(1e7 * float(tracks[0].x_m[-1])) % 2 else -1.0
    return {"k_over_m_1_s": (2.5 + sign * off, 1.0)}


def good(tracks):
    return estimate(tracks, 0.1)


def bad(tracks):
    return estimate(tracks, 0.5)


class TheGate(InFolder):
    def test_it_is_the_command_s_for_glidelab_s_own_estimators(self):
        mine = glidelab.gate(SCENARIO, runs=10, seed=5)
        mine.write_baseline(self.folder / "mine.json")
        run("validate", SCENARIO, "--write-baseline", self.folder / "its.json", "--runs", "10", "--seed", "5", "-q")
        self.assertEqual((self.folder / "mine.json").read_bytes(), (self.folder / "its.json").read_bytes())
        self.assertEqual((mine.passed, mine.worse, mine.tests, mine.outside), (None, (), None, None))
        self.assertEqual((mine.runs, mine.seed, mine.noise_m), (10, 5, 2e-5))
        stored = read_json(self.folder / "its.json")["records"]
        self.assertEqual([(one["estimator"], one["mean_error"], one["sd_error"]) for one in stored],
                         [(row.estimator, row.bias, row.sd) for row in mine.rows])
        now = glidelab.gate(SCENARIO, self.folder / "its.json", runs=10)
        printed = run("validate", SCENARIO, "--baseline", self.folder / "mine.json", "--runs", "10", "-q",
                      status=0 if now.passed else 4)
        self.assertEqual(now.seed, 6)  # another noise than the baseline's
        self.assertIn(printed, str(now))
        self.assertGreater(now.tests, 60)
        for row in now.rows:
            self.assertGreater(row.runs_for_1_1, 100)

    def test_a_function_that_became_worse_does_not_pass_and_says_what(self):
        before = glidelab.gate(SCENARIO, runs=RUNS, estimator_command=good, estimator_name="mine")
        before.write_baseline(self.folder / "mine.json")
        self.assertEqual({row.estimator for row in before.rows}, {"mine"})
        self.assertEqual((before.outside.name, before.outside.runs, before.outside.failed), ("mine", RUNS, 0))
        k = [row for row in before.rows if row.quantity == "k_over_m_1_s"]
        self.assertEqual({(row.answered, row.covered) for row in k}, {(RUNS, RUNS)})
        self.assertEqual({row.answered for row in before.rows if row.quantity == "mu"}, {0})
        same = glidelab.gate(SCENARIO, self.folder / "mine.json", runs=RUNS, estimator_command=good, estimator_name="mine")
        self.assertIs(same.passed, True, same)
        self.assertIn("Nothing is worse than the baseline.", str(same))
        now = glidelab.gate(SCENARIO, self.folder / "mine.json", runs=RUNS, estimator_command=bad, estimator_name="mine")
        self.assertIs(now.passed, False)
        self.assertEqual({(one.quantity, one.what) for one in now.worse}, {("k_over_m_1_s", "spread")})
        for one in now.worse:  # five times as far from the mean, which of 20 equal chances is off by 0.22 sd
            self.assertAlmostEqual(one.now / one.then, 5.0, delta=1.5)
            self.assertLess(one.p_value, 1e-4)
        self.assertIn("Worse than the baseline:\nm1 mine k_over_m_1_s: spread was ", str(now))
        self.assertIn("Worse than the baseline:", now._repr_html_())
        self.assertEqual(glidelab.explain(now), str(now))
        now.write(self.folder / "page")
        self.assertEqual(read_json(self.folder / "page" / "gate.json"), now.to_dict())
        self.assertNotIn("baseline_json", now.to_dict())
        self.assertEqual(len((self.folder / "page" / "gate.csv").read_text().splitlines()), len(now.rows) + 1)

    def test_a_dict_is_compared_with_a_dict_and_with_no_other(self):
        scenario = glidelab.load_scenario(SCENARIO)
        glidelab.gate(scenario, runs=10, estimator_command=good).write_baseline(self.folder / "mine.json")
        self.assertIsNotNone(glidelab.gate(scenario, self.folder / "mine.json", runs=10, estimator_command=good).passed)
        scenario["camera"]["frame_rate_hz"] = 60.0
        with self.assertRaises(glidelab.InputError) as caught:
            glidelab.gate(scenario, self.folder / "mine.json", runs=10, estimator_command=good)
        self.assertEqual((caught.exception.key, caught.exception.found), ("scenario", "the text of another scenario"))

    def test_what_it_cannot_compare_it_refuses(self):
        file = self.folder / "mine.json"
        glidelab.gate(SCENARIO, runs=10, estimator_command=good).write_baseline(file)
        for key, wrong in (("noise_m", {"noise_m": 1e-5}), ("seed", {"seed": 1}), ("runs", {"runs": 9}),
                           ("noise_m", {"noise_m": -1.0}), ("estimator_command", {"estimator_command": "nobody"}),
                           ("baseline", {"baseline": 3})):
            with self.subTest(wrong), self.assertRaises(glidelab.InputError) as caught:
                glidelab.gate(SCENARIO, **{"baseline": file, "runs": 10, "estimator_command": good, **wrong})
            self.assertEqual(caught.exception.key, key)
            self.assertNotIn("--", caught.exception.key)
        with self.assertRaises(glidelab.InputError):  # of an estimator of another name
            glidelab.gate(SCENARIO, file, runs=10, estimator_command=bad)
        with self.assertRaises(glidelab.InputError) as caught:
            glidelab.gate(SCENARIO, self.folder / "none.json", runs=10, estimator_command=good)
        self.assertEqual(caught.exception.file, str(self.folder / "none.json"))

    def test_a_baseline_that_cannot_be_written_says_so_and_leaves_nothing(self):
        found = glidelab.gate(SCENARIO, runs=10, estimator_command=good)
        (self.folder / "taken").mkdir()
        for name in ("none/mine.json", "taken"):
            with self.assertRaises(glidelab.SystemFailure) as caught:
                found.write_baseline(self.folder / name)
            self.assertIn("cannot be written", str(caught.exception))
        self.assertEqual([one.name for one in self.folder.iterdir()], ["taken"])

    @needs("pandas")
    def test_its_table_has_a_row_for_each_quantity(self):
        table = glidelab.gate(SCENARIO, runs=10, estimator_command=good).to_frame()
        self.assertEqual(len(table), 12)
        self.assertEqual(table.attrs["units"]["sd"], "as the column unit says")
        self.assertTrue(np.isnan(table["sd"][table["quantity"] == "mu"]).all())


def knowing(truth_file, off_1_s, sd_1_s):
    """An estimator that reads the sealed truth, and is off by so much in K/m; of mu it says nothing."""
    truths = json.loads(truth_file.read_text())["configurations"]

    def mine(tracks):
        true = next(one["k_over_m_1_s"] for one in truths if abs(one["mass_kg"] - tracks[0].mass_kg) < 1e-6
                    and abs(one["incline_deg"] - tracks[0].incline_deg) < 1e-3)
        return {"k_over_m_1_s": (true + off_1_s, sd_1_s)}

    return mine


class OnBlindCases(InFolder):
    """An estimator beside the diagnosis, on the same everyday cases."""

    def test_its_errors_and_intervals_are_scored_and_the_diagnoses_are_kept(self):
        choices = {"everyday": True, "only": "dropped_frames", "seed": 3}
        alone = glidelab.blind(1, self.folder / "out", **choices)
        self.assertEqual((alone.answers, alone.outside), ((), None))
        self.assertNotIn("answers", alone.to_dict()["everyday"])
        truth = self.folder / "out" / "truth" / "0000.json"
        diagnosis = self.folder / "out" / "diagnoses" / "0000" / "diagnosis.json"
        made_at = diagnosis.stat().st_mtime_ns
        configurations = json.loads(truth.read_text())["configurations"]
        for off, sd, held in ((0.1, 0.1 / 1.95, True), (0.1, 0.1 / 1.97, False)):
            blind = glidelab.blind(1, self.folder / "out", estimator_command=knowing(truth, off, sd), **choices)
            by = {one.quantity: one for one in blind.answers}
            k = by["k_over_m_1_s"]
            self.assertEqual((k.true_values, k.answered), (len(configurations),) * 2)
            self.assertEqual(k.covered, len(configurations) if held else 0)
            self.assertEqual(k.coverage, 1.0 if held else 0.0)
            self.assertAlmostEqual(k.bias, off, places=9)
            self.assertAlmostEqual(k.rms_error, off, places=9)
            self.assertEqual((by["mu"].answered, by["mu"].rms_error, by["mu"].coverage), (0, None, None))
            self.assertEqual((blind.outside.name, blind.outside.runs, blind.outside.failed), ("mine", 1, 0))
            self.assertIn("95 % intervals that hold", str(blind))
            self.assertIn("mine: 1 run, none failed", str(blind))
            self.assertIn("<td>K/m (1/s)</td>", blind._repr_html_())
            self.assertEqual(blind.to_dict()["outcomes"], alone.to_dict()["outcomes"])
        self.assertEqual(diagnosis.stat().st_mtime_ns, made_at)
        blind.write(self.folder / "page")
        self.assertIn("An estimator on the same cases", (self.folder / "page" / "report.html").read_text())

    def test_one_that_fails_is_counted_and_the_diagnosis_is_scored_all_the_same(self):
        def raising(tracks):
            raise ValueError("not today")

        blind = glidelab.blind(1, self.folder / "out", everyday=True, only="dropped_frames", seed=3,
                               estimator_command=raising)
        self.assertEqual((blind.outside.failed, list(blind.outside.failures)), (1, ["raised"]))
        self.assertEqual({one.answered for one in blind.answers}, {0})
        self.assertIn("“raising” failed in 1 of 1 run", str(blind))
        self.assertEqual(blind.failed, 0)

    def test_it_is_refused_where_no_values_are_true(self):
        for choices in ({}, {"pictures": True}):
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.blind(1, self.folder / "out", estimator_command=good, **choices)
            self.assertEqual(caught.exception.key, "estimator_command")
        self.assertFalse((self.folder / "out").exists())
