"""Wrong input ends in one exception that says what was found where, and what is expected there."""

import math
import os
import pickle
from pathlib import Path
from unittest import mock

import numpy as np

import glidelab
from glidelab._toml import toml_text
from tests.python.support import SOURCE, InFolder, damped

SCENARIO = SOURCE / "scenarios" / "paper" / "inclined.toml"


class WrongInput(InFolder):
    def refused(self, call, **expected):
        """The exception, whose first issue is as expected."""
        with self.assertRaises(glidelab.InputError) as caught:
            call()
        for key, value in expected.items():
            self.assertEqual(getattr(caught.exception, key), value)
        self.assertIsInstance(caught.exception, ValueError)
        return caught.exception

    def test_positions(self):
        t, x = damped()
        x[3] = math.nan
        self.refused(lambda: glidelab.analyze(t, x), file='track "track"', key="x_m[3]", found="nan")
        self.refused(lambda: glidelab.analyze(t, x[:-1]), key="x_m", found=f"{len(t) - 1} numbers")
        self.refused(lambda: glidelab.analyze(t[::-1], x), key="x_m[3]")
        self.refused(lambda: glidelab.analyze(t[:5], t[:5]), found="5 points")
        self.refused(lambda: glidelab.analyze(t, np.outer(x, x)), key="x_m")
        self.refused(lambda: glidelab.analyze(t, ["one"] * len(t)), key="x_m", expected="real numbers")
        self.refused(lambda: glidelab.analyze(t, 1j * t), key="x_m")

    def test_all_issues_of_all_tracks_are_told_at_once(self):
        t, x = damped()
        error = self.refused(lambda: glidelab.analyze([
            glidelab.Track(t, x, mass_kg=-1.0, name="a"), glidelab.Track(t, x, launched="sideways", name="b"),
            glidelab.Track(t, x, name="a")]))
        self.assertEqual([(one.file, one.key) for one in error.issues],
                         [('track "a"', "mass_kg"), ('track "b"', "launched"), ('track "a"', "name")])

    def test_choices(self):
        t, x = damped()
        self.refused(lambda: glidelab.analyze(t, x, bandwidth=-0.1), key="bandwidth", found="-0.1")
        self.refused(lambda: glidelab.analyze(t, x, bandwidth="best"), key="bandwidth", found='"best"')
        self.refused(lambda: glidelab.analyze(t, x, estimator="best"), key="estimator")
        self.refused(lambda: glidelab.analyze(t, x, robust=True), key="robust")
        self.refused(lambda: glidelab.analyze(t, x, gravity_m_s2=0.0), key="gravity_m_s2")
        self.refused(lambda: glidelab.analyze(t, x, jobs=0), key="jobs")
        self.refused(lambda: glidelab.diagnose(t, x, without=["gremlins"]), key="without")
        self.refused(lambda: glidelab.analyze(glidelab.Track(t, x), mass_kg=1.0), key="mass_kg")
        self.refused(lambda: glidelab.analyze([]), key="source")
        self.refused(lambda: glidelab.plan(SCENARIO), key="noise_m", found="nothing")

    def test_a_single_value_of_a_wrong_type_is_refused_in_words(self):
        t, x = damped()
        analyze, track = glidelab.analyze, glidelab.Track
        for key, found, call in (
                ("mass_kg", "'0.335'", lambda: analyze(t, x, mass_kg="0.335")),
                ("mass_kg", "True", lambda: analyze(t, x, mass_kg=True)),
                ("mass_sd_kg", "'0'", lambda: analyze(track(t, x, mass_sd_kg="0"))),
                ("incline_deg", "'4'", lambda: analyze(t, x, incline_deg="4")),
                ("gravity_m_s2", "'9.81'", lambda: analyze(t, x, gravity_m_s2="9.81")),
                ("gravity_m_s2", "'9.81'", lambda: glidelab.diagnose(t, x, gravity_m_s2="9.81")),
                ("name", "3", lambda: analyze(t, x, name=3)),
                ("group", "3", lambda: analyze(track(t, x, group=3))),
                ("launched", "1", lambda: analyze(track(t, x, launched=1))),
                ("estimator", "a function", lambda: analyze(t, x, estimator=lambda tracks: {})),
                ("robust", "'no'", lambda: analyze(t, x, robust="no")),
                ("with_effects", "'quadratic_drag'", lambda: analyze(t, x, with_effects="quadratic_drag")),
                ("bandwidth_s", "'gcv'", lambda: glidelab.smooth(t, x, "gcv")),
                ("order", "2.5", lambda: glidelab.smooth(t, x, 0.05, order=2.5)),
                ("noise_m", f"an array of shape ({len(t)},)", lambda: glidelab.smooth(t, x, 0.05, noise_m=t)),
                ("rule", "0.05", lambda: glidelab.choose_bandwidth(t, x, 0.05)),
                ("noise_m", "'a'", lambda: glidelab.coverage(SCENARIO, noise_m="a")),
                ("bandwidth_s", "'gcv'", lambda: glidelab.coverage(SCENARIO, bandwidth_s="gcv")),
                ("bandwidth_s", "-1", lambda: glidelab.coverage(SCENARIO, noise_m=2e-5, bandwidth_s=-1)),
                ("bandwidth_s", "0", lambda: glidelab.coverage(SCENARIO, noise_m=2e-5, bandwidth_s=0.0)),
                ("bandwidth_s", "nan", lambda: glidelab.coverage(SCENARIO, noise_m=2e-5, bandwidth_s=math.nan)),
                ("levels", "0.95", lambda: glidelab.coverage(SCENARIO, levels=0.95)),
                ("noise_m", "'2e-5'", lambda: glidelab.judge(SCENARIO, noise_m="2e-5")),
                ("noise_m", "'a'", lambda: glidelab.plan(SCENARIO, noise_m="a")),
                ("rate_hz", "'a'", lambda: glidelab.simulate(SCENARIO, rate_hz="a")),
                ("targets", "0.1", lambda: glidelab.require("none.toml", ("mu", 0.1))),
                ("confirm", "1", lambda: glidelab.require("none.toml", ["mu=1"], confirm=1)),
                ("file", "3", lambda: glidelab.sweep(3, self.folder)),
                ("source", "an int", lambda: glidelab.check(3)),
                ("name", "'a\\udcff'", lambda: analyze(t, x, name="a\udcff")),
                ("name", "'a\\udcff'", lambda: analyze(track(t, x, name="a\udcff"))),
                ("source", "'a\\udcff'", lambda: analyze("a\udcff")),
                ("source", "'a\\udcff'", lambda: glidelab.certify(["a\udcff"])),
                ("images[0]", "'a\\udcff'", lambda: glidelab.calibrate(["a\udcff"], (9, 6), 0.04)),
                ("x_m[2]", "1e+200", lambda: glidelab.smooth(t, np.where(t == t[2], 1e200, x), smoother="kalman")),
                ("only", "3", lambda: glidelab.blind(1, self.folder, only=3)),
                ("inner_corners", "9", lambda: glidelab.calibrate([], 9, 0.04)),
                ("inner_corners", "nan", lambda: glidelab.calibrate([], (math.nan, 6), 0.04)),
                ("inner_corners", "9.0", lambda: glidelab.calibrate([], (9.0, 6), 0.04)),
                ("jobs", "2.0", lambda: analyze(t, x, jobs=2.0)),
                ("seed", "True", lambda: glidelab.coverage(SCENARIO, noise_m=2e-5, seed=True)),
                ("seed", str(2**64), lambda: glidelab.judge(SCENARIO, noise_m=2e-5, seed=2**64)),
                ("replicates", "1", lambda: glidelab.judge(SCENARIO, noise_m=2e-5, replicates=1)),
                ("runs", "[1.0]", lambda: analyze("none.csv", runs=[1.0])),
                ("images", "3", lambda: glidelab.calibrate(3, (9, 6), 0.04)),
                ("centre_px", "(nan, 1.0)", lambda: glidelab.fit_marker(np.zeros((9, 9), np.uint8), (math.nan, 1.0), 3)),
                ("radius_px", "0", lambda: glidelab.fit_marker(np.zeros((9, 9), np.uint8), (4, 4), 0))):
            with self.subTest(key=key, found=found):
                error = self.refused(call, key=key, found=found)
                self.assertLess(len(str(error)), 300)

    def test_a_scenario_s_text_that_is_no_unicode_is_shown_where_it_is(self):
        scenario = {**glidelab.load_scenario(SCENARIO), "name": "one\udcfftwo"}
        error = self.refused(lambda: glidelab.simulate(scenario), key="scenario")
        self.assertRegex(error.found, r"one\\udcff'$")
        self.assertLess(len(error.found), 60)

    def test_a_gap_across_which_nothing_is_known_is_told_in_glidelab_s_words(self):
        short = damped(duration_s=0.5)
        t = np.arange(1000) * 0.005  # the two end at different places of the computation
        for t, x in (short, (t, 0.5 * t - 0.1 * np.exp(-t) + np.random.default_rng(1).normal(0.0, 2e-5, len(t)))):
            half = len(t) // 2
            for smoother in ("kalman", "spline"):
                with self.assertRaises((glidelab.NumericalError, glidelab.InputError)) as caught:
                    glidelab.smooth(np.append(t[:half], t[half:] + 1e6), x, smoother=smoother)
                self.assertRegex(str(caught.exception), "gap|neither motion nor noise")
                self.assertNotIn("boost", str(caught.exception))

    def test_tracks_for_what_reads_files(self):
        t, x = damped()
        self.refused(lambda: glidelab.check(glidelab.Track(t, x, launched="up")), file='track "track-1"', key="mass_kg")
        self.refused(lambda: glidelab.check([glidelab.Track(t, x, mass_kg=0.3)]), key="launched", found="'unknown'")
        self.refused(lambda: glidelab.check(glidelab.Track(t, x), mass_kg=1.0), key="mass_kg")
        self.refused(lambda: glidelab.check(t, x, runs="all"), key="runs")
        self.refused(lambda: glidelab.certify(t, x[:-1]), key="x_m", found=f"{len(t) - 1} numbers")
        self.refused(lambda: glidelab.certify(t, x, gravity_sd_m_s2=0.1), key="gravity_sd_m_s2")
        self.refused(lambda: glidelab.check(["a", "b"]), key="source", found="2 names")
        error = self.refused(lambda: glidelab.certify(t[::-1], x), file="track.csv")
        self.assertNotIn("/", str(error))  # no name of a temporary folder

    def test_masked_values_are_refused_where_nan_is(self):
        t, x = damped()
        masked = np.ma.masked_array(x, mask=np.arange(len(x)) % 100 == 7)
        self.assertTrue(masked.mask.sum() > 1)
        for call in (lambda: glidelab.analyze(t, masked), lambda: glidelab.diagnose(t, masked),
                     lambda: glidelab.analyze(glidelab.Track(t, masked)), lambda: glidelab.smooth(t, masked, 0.02),
                     lambda: glidelab.choose_bandwidth(t, masked), lambda: glidelab.position_noise(t, masked)):
            error = self.refused(call, key="x_m[7]", found="a masked value, and 3 more")
            self.assertEqual((len(error.issues), masked.mask.sum()), (1, 4))
        self.refused(lambda: glidelab.smooth(t, x, 0.02, at_s=np.ma.masked_array(t, t == t[-1])), found="a masked value")
        self.assertEqual(glidelab.analyze(t, np.ma.masked_array(x)).to_json(), glidelab.analyze(t, x).to_json())
        image = np.ma.masked_array(np.zeros((9, 9), np.uint8), mask=np.eye(9, dtype=bool))
        self.refused(lambda: glidelab.fit_marker(image, (4, 4), 2), key="image[0, 0]",
                     found="a masked value, and 8 more")
        self.refused(lambda: glidelab.calibrate([image] * 3, (9, 6), 0.04), key="images[0][0, 0]")

    def test_an_argument_that_does_not_apply_says_why(self):
        t, x = damped()
        for options in ({"runs": "all"}, {"column": "x"}, {"most_megapixels": 3}, {"allow_outside": True}):
            self.refused(lambda said=options: glidelab.analyze(t, x, **said), key=next(iter(options)),
                         expected="nothing: it is for f" + ("olders, and these are arrays" if "allow_outside" in options
                                                            else "iles and folders, and these are arrays"))
        self.refused(lambda: glidelab.diagnose(glidelab.Track(t, x), mass_kg=0.3), expected="nothing: a Track states its own")

    def test_the_key_is_the_argument_and_a_misspelt_word_finds_its_neighbour(self):
        t, x = damped()
        (self.folder / "two.toml").write_text(
            f'format = 1\nname = "two"\nscenario = "{SCENARIO}"\nlevel = "tracks"\n'
            '[[vary]]\nkey = "tracks.noise_m"\nvalues = [1e-5]\n')
        for key, word, call in (
                ("targets", "alpha_deg", lambda: glidelab.require(self.folder / "two.toml", ["alpha=0.01"])),
                ("bandwidth", "gcv", lambda: glidelab.analyze(t, x, bandwidth="gvc")),
                ("rule", "gcv", lambda: glidelab.choose_bandwidth(t, x, "gvc")),
                ("kernel", "gaussian", lambda: glidelab.smooth(t, x, 0.05, kernel="gausian")),
                ("estimator", "trajectory", lambda: glidelab.analyze(t, x, estimator="trajectry")),
                ("estimators", "trajectory", lambda: glidelab.judge(SCENARIO, "trajectry", noise_m=2e-5))):
            with self.subTest(word):
                error = self.refused(call, key=key)
                self.assertIn(f'did you mean "{word}"?', error.expected)
                self.assertNotIn("--", str(error))
        self.refused(lambda: glidelab.coverage(SCENARIO, noise_m=2e-5, estimator_command="sh {folder}"),
                     key="estimator_command")

    def test_a_scenario_that_cannot_be_read(self):
        (self.folder / "picture.png").write_bytes(bytes(range(256)))
        (self.folder / "broken.toml").write_text("format = \n")
        for name in ("missing.toml", "", "picture.png", "broken.toml"):
            error = self.refused(lambda said=name: glidelab.load_scenario(self.folder / said), file=str(self.folder / name))
            self.assertTrue(error.found)
        self.refused(lambda: glidelab.load_scenario(3), key="file")

    def test_what_a_file_does_not_say(self):
        t, x = damped()
        file = self.folder / "track.csv"
        file.write_text("t_s,x_m\n" + "".join(f"{a!r},{b!r}\n" for a, b in zip(t.tolist(), x.tolist())))
        self.refused(lambda: glidelab.analyze(self.folder, mass_kg=0.3), key="mass_kg", found="0.3")
        self.refused(lambda: glidelab.check(self.folder, runs="all"), key="runs")
        self.refused(lambda: glidelab.check(file, mass_kg=-0.3), key="mass_kg", found="-0.3")
        self.refused(lambda: glidelab.diagnose(file, incline_deg=91.0), key="incline_deg", found="91")
        self.refused(lambda: glidelab.diagnose(file, recorded_by="sonar"), key="recorded_by", found="'sonar'")
        self.refused(lambda: glidelab.diagnose(t, x, recorded_by="sonar"), key="recorded_by", found="'sonar'")
        self.refused(lambda: glidelab.diagnose(self.folder, recorded_by="sensor"), key="recorded_by")
        self.refused(lambda: glidelab.diagnose(file, incline_deg=math.nan), key="incline_deg", found="nan")
        self.refused(lambda: glidelab.check(self.folder, gravity_m_s2=9.8123), key="gravity_m_s2", found="9.8123")
        self.refused(lambda: glidelab.certify(file, gravity_m_s2=-9.8), key="gravity_m_s2", found="-9.8")
        self.refused(lambda: glidelab.diagnose(file, gravity_sd_m_s2=0.1), key="gravity_sd_m_s2", found="0.1")
        self.refused(lambda: glidelab.analyze(t, x, gravity_sd_m_s2=0.1), key="gravity_sd_m_s2", found="0.1")
        self.refused(lambda: glidelab.analyze(file, incline_sd_deg=0.1), key="incline_sd_deg", found="0.1")
        self.refused(lambda: glidelab.analyze(file, incline_deg=4.0, incline_sd_deg=0.0), key="incline_sd_deg")
        self.refused(lambda: glidelab.analyze(file, masses_kg=[0.3, 0.4]), key="masses_kg", found="2 of them")
        self.refused(lambda: glidelab.analyze([file, file], masses_kg=[0.3]), key="masses_kg", found="1 of them")
        self.refused(lambda: glidelab.check(self.folder, frame_rate_hz=60.0), key="frame_rate_hz", found="60.0")
        self.refused(lambda: glidelab.diagnose(t, x, px_per_m=500.0), key="px_per_m", found="500.0")
        self.refused(lambda: glidelab.certify(file, frame_rate_hz=0.0), key="frame_rate_hz", found="0")
        self.refused(lambda: glidelab.analyze(file, runs=[], masses_kg=[0.3]), key="runs")
        self.refused(lambda: glidelab.analyze(file, runs=[7]), key="runs", found='"7"')
        self.refused(lambda: glidelab.analyze(file, runs=[1], mass_kg=0.3, masses_kg=[0.3]), key="mass_kg")
        self.refused(lambda: glidelab.analyze(file, runs=[1], column="2"), key="column")
        self.refused(lambda: glidelab.analyze(t, x, runs="all"), key="runs")
        self.refused(lambda: glidelab.analyze(file, force_n=x), key="force_n")
        self.refused(lambda: glidelab.analyze(t, x, force_n=x), key="mass_kg", found="none, with a recorded force")
        self.refused(lambda: glidelab.certify(file, twins=5), key="twins")
        self.refused(lambda: glidelab.certify(file, estimator="best"), key="estimator")
        self.refused(lambda: glidelab.certify(file, bandwidth_s=0.0), key="bandwidth_s")
        self.refused(lambda: glidelab.certify([]), key="source")

    def test_files(self):
        self.refused(lambda: glidelab.analyze(self.folder / "missing"), file=str(self.folder / "missing"),
                     found="no file or folder of this name")
        (self.folder / "experiment.toml").write_text("format = 1\nmisspelt = 3\n")
        error = self.refused(lambda: glidelab.analyze(self.folder))
        self.assertTrue(any(one.key == "misspelt" and one.line == 2 for one in error.issues))

    def test_a_scenario_that_is_a_dict(self):
        scenario = glidelab.load_scenario(SCENARIO)
        scenario["camera"]["focal"] = 3
        self.refused(lambda: glidelab.simulate(scenario), file="scenario", line=0, key="camera.focal")
        scenario["camera"] = None
        self.refused(lambda: glidelab.simulate(scenario), key="camera", found="a value of type NoneType")

    def test_an_exception_survives_pickling(self):
        error = self.refused(lambda: glidelab.analyze([0.0], [1.0]))
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.issues), (str(error), error.issues))


class Scenarios(InFolder):
    def test_they_are_those_of_the_checkout_in_which_python_runs(self):
        before = Path.cwd()
        self.addCleanup(os.chdir, before)
        made = self.folder.resolve() / "scenarios"
        (self.folder / "below").mkdir()
        made.mkdir()
        for folder, found in ((SOURCE, SOURCE / "scenarios"), (SOURCE / "docs", SOURCE / "scenarios")):
            os.chdir(folder)
            self.assertEqual(glidelab.scenarios_folder(), found)
        os.chdir(self.folder / "below")
        with mock.patch.object(Path, "is_file", lambda path: False):
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.scenarios_folder()
        self.assertEqual((caught.exception.key, caught.exception.found), ("scenarios", "no such folder"))
        self.assertIn(str(self.folder.resolve() / "below"), caught.exception.expected)
        (made / "tutorial.toml").write_text("")
        self.assertEqual(glidelab.scenarios_folder(), made)


class DictsAsToml(InFolder):
    def test_every_value_reads_back_as_it_was(self):
        import tomllib
        tricky = {"int": 3, "float": 0.1 + 0.2, "small": 5e-324, "whole": 1e22, "yes": True, "text": 'a"\\\n\x7f\u00b5',
                  "list": [1, 2.5], "empty": [], "odd key.": {"inner": {"deep": [[1.0], [2.0]]}},
                  "tables": [{"a": 1, "sub": {"b": 2}}, {"a": 2, "rows": [{"c": 1}]}], "mixed": [{"a": 1}, 2]}
        self.assertEqual(tomllib.loads(toml_text(tricky)), tricky)

    def test_numbers_of_numpy_and_paths_are_taken(self):
        import tomllib
        from pathlib import Path
        made = toml_text({"a": np.float64(0.1), "b": np.int32(4), "c": np.array([1.0, 2.0]), "d": Path("x/y")})
        self.assertEqual(tomllib.loads(made), {"a": 0.1, "b": 4, "c": [1.0, 2.0], "d": "x/y"})

    def test_every_scenario_of_the_repository_survives(self):
        import tomllib
        for path in sorted((SOURCE / "scenarios").rglob("*.toml")):
            with self.subTest(path.name):
                read = tomllib.loads(path.read_text())
                self.assertEqual(tomllib.loads(toml_text(read)), read)
