"""Wrong input ends in one exception that says what was found where, and what is expected there."""

import math
import pickle

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
        self.refused(lambda: glidelab.analyze(t, x, bandwidth="best"), key="bandwidth", found="best")
        self.refused(lambda: glidelab.analyze(t, x, estimator="best"), key="estimator")
        self.refused(lambda: glidelab.analyze(t, x, robust=True), key="robust")
        self.refused(lambda: glidelab.analyze(t, x, gravity_m_s2=0.0), key="gravity_m_s2")
        self.refused(lambda: glidelab.analyze(t, x, jobs=0), key="jobs")
        self.refused(lambda: glidelab.diagnose(t, x, without=["gremlins"]), key="without")
        self.refused(lambda: glidelab.analyze(glidelab.Track(t, x), mass_kg=1.0), key="mass_kg")
        self.refused(lambda: glidelab.analyze([]), key="source")
        self.refused(lambda: glidelab.plan(SCENARIO), key="noise_m", found="nothing")

    def test_what_a_file_does_not_say(self):
        t, x = damped()
        file = self.folder / "track.csv"
        file.write_text("t_s,x_m\n" + "".join(f"{a!r},{b!r}\n" for a, b in zip(t.tolist(), x.tolist())))
        self.refused(lambda: glidelab.analyze(self.folder, mass_kg=0.3), key="mass_kg", found="0.3")
        self.refused(lambda: glidelab.check(self.folder, runs="all"), key="runs")
        self.refused(lambda: glidelab.check(file, mass_kg=-0.3), key="mass_kg", found="-0.3")
        self.refused(lambda: glidelab.diagnose(file, incline_deg=91.0), key="incline_deg", found="91")
        self.refused(lambda: glidelab.diagnose(file, incline_deg=math.nan), key="incline_deg", found="nan")
        self.refused(lambda: glidelab.check(self.folder, gravity_m_s2=9.8123), key="gravity_m_s2", found="9.8123")
        self.refused(lambda: glidelab.certify(file, gravity_m_s2=-9.8), key="gravity_m_s2", found="-9.8")
        self.refused(lambda: glidelab.diagnose(file, gravity_sd_m_s2=0.1), key="gravity_sd_m_s2", found="0.1")
        self.refused(lambda: glidelab.analyze(t, x, gravity_sd_m_s2=0.1), key="gravity_sd_m_s2", found="0.1")
        self.refused(lambda: glidelab.analyze(file, incline_sd_deg=0.1), key="incline_sd_deg", found="0.1")
        self.refused(lambda: glidelab.analyze(file, incline_deg=4.0, incline_sd_deg=0.0), key="incline_sd_deg")
        self.refused(lambda: glidelab.analyze(file, masses_kg=[0.3]), key="masses_kg")
        self.refused(lambda: glidelab.analyze(file, runs=[], masses_kg=[0.3]), key="runs")
        self.refused(lambda: glidelab.analyze(file, runs=[7]), key="--runs", found='"7"')
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
