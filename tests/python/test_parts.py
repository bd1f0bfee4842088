"""The smoother, the rules, the calibration and the marker's fit on their own; films; studies; a check."""

import json
import math
import struct
import tomllib
import zlib

import numpy as np

import glidelab
from tests.python.support import SOURCE, InFolder, damped, read_json, run

TUTORIAL = SOURCE / "scenarios" / "tutorial.toml"


def small_scenario():
    """The tutorial's, small and short: one clip of 40 frames."""
    scenario = glidelab.load_scenario(TUTORIAL)
    scenario["camera"].update(width_px=400, height_px=300, focal_px=[575.0, 575.0])
    scenario["configuration"] = scenario["configuration"][:1]
    scenario["configuration"][0]["clip"] = scenario["configuration"][0]["clip"][:1]
    scenario["configuration"][0]["clip"][0]["duration_s"] = 0.34
    return scenario


def read_toml(path):
    return tomllib.loads(path.read_text())


def decoded(data):
    """The pixels of a PNG file whose lines have no filter, read by its specification."""
    chunks, at = {}, 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + body)
        chunks[kind], at = body, at + 12 + length
    width, height, bits, colours, *rest = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    assert rest == [0, 0, 0] and list(chunks)[-1] == b"IEND"
    lines = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    assert not lines[:, 0].any()
    shape = (height, width) if colours == 0 else (height, width, 3)
    return np.ascontiguousarray(lines[:, 1:]).view(">u2" if bits == 16 else np.uint8).reshape(shape)


class Smoothing(InFolder):
    def test_a_local_cubic_gives_back_a_cubic_and_its_derivatives(self):
        t = np.sort(np.random.default_rng(3).uniform(0.0, 1.0, 300))
        smooth = glidelab.smooth(t, 1.0 - 2.0 * t + 3.0 * t**2 - 4.0 * t**3, 0.05)
        # Rounding: positions of order 1 with 1e-16, over h² for a.
        np.testing.assert_allclose(smooth.x_m, 1.0 - 2.0 * t + 3.0 * t**2 - 4.0 * t**3, atol=1e-12)
        np.testing.assert_allclose(smooth.v_m_s, -2.0 + 6.0 * t - 12.0 * t**2, atol=1e-10)
        np.testing.assert_allclose(smooth.a_m_s2, 6.0 - 24.0 * t, atol=1e-8)
        at = glidelab.smooth(t, t**3, 0.05, at_s=[0.25, 0.5])
        np.testing.assert_allclose(at.a_m_s2, [1.5, 3.0], atol=1e-8)

    def test_standard_deviations_are_those_of_the_formula(self):
        t = np.arange(0.0, 2.0, 0.002)
        smooth = glidelab.smooth(t, 0.0 * t, 0.05, noise_m=1e-4)
        # Far from the ends: var a = 3/(8 sqrt(pi)) s² dt/h^5 (Fan and Gijbels 1996); h is 25 steps.
        expected = math.sqrt(3.0 / (8.0 * math.sqrt(math.pi)) * 0.002 / 0.05**5) * 1e-4
        self.assertAlmostEqual(smooth.sd_a_m_s2[500] / expected, 1.0, places=3)

    def test_the_noise_that_was_put_in_is_found_and_rules_choose_near_the_best(self):
        rng = np.random.default_rng(5)
        t = np.arange(0.0, 2.0, 0.005)
        noise = 1e-4
        x = 0.1 * np.cos(2.0 * np.pi * t) + rng.normal(0.0, noise, len(t))
        self.assertLess(abs(glidelab.position_noise(t, x) / noise - 1.0), 0.15)  # 400 points: 4 %, by half of them
        rms = 0.1 * (2.0 * np.pi) ** 4 / math.sqrt(2.0)  # of x''''
        best = (1.058 * noise**2 * 0.005 / rms**2) ** (1.0 / 9.0)
        for rule in glidelab.bandwidth_rules():
            picked = glidelab.choose_bandwidth(t, x, rule.name)
            self.assertLess(abs(math.log(float(picked) / best)), math.log(2.0), rule.name)

    def test_a_smoother_without_a_bandwidth_finds_its_strength_and_the_turn(self):
        t = np.arange(300) / 200.0
        noise = np.random.default_rng(3).normal(0.0, 1e-4, t.size)
        x = np.where(t < 0.7, 1.2, 0.8) * (t - 0.7) ** 2 / 2.0 + noise  # a jumps by -0.4 where v = 0
        for smoother in ("kalman", "spline"):
            smooth = glidelab.smooth(t, x, smoother=smoother, breaks_s=[0.72])
            self.assertAlmostEqual(smooth.strength.breaks_s[0], 0.7, delta=0.002)
            self.assertAlmostEqual(smooth.strength.noise_m, 1e-4, delta=2e-5)  # five standard deviations
            off = np.abs(smooth.a_m_s2 - np.where(t < smooth.strength.breaks_s[0], 1.2, 0.8)) / smooth.sd_a_m_s2
            self.assertLess(off.max(), 6.0)
            self.assertGreater(smooth.strength.simultaneous_a, 1.96)
            at = glidelab.smooth(t, x, smoother=smoother, breaks_s=[0.72], at_s=[0.3025])
            self.assertAlmostEqual(at.a_m_s2[0], 1.2, delta=6.0 * at.sd_a_m_s2[0])

    def test_a_glider_that_stands_is_smoothed_or_refused_by_every_smoother(self):
        t = np.arange(0.0, 1.0, 0.01)
        for x in (0.0 * t, 0.0 * t + 0.25):
            self.assertLess(abs(glidelab.smooth(t, x, 0.05).v_m_s).max(), 1e-12)
            for smoother in ("kalman", "spline"):
                try:
                    self.assertTrue(np.isfinite(glidelab.smooth(t, x, smoother=smoother).v_m_s).all())
                except glidelab.InputError as error:
                    self.assertEqual(error.key, "x_m")

    def test_other_times_are_taken_in_any_order_and_within_the_motion_by_every_smoother(self):
        t, x = damped()
        for options in ({"bandwidth_s": 0.05}, {"smoother": "kalman", "breaks_s": [0.6]}):
            rising = glidelab.smooth(t, x, at_s=[0.1, 0.3, 0.5], **options)
            mixed = glidelab.smooth(t, x, at_s=[0.5, 0.1, 0.3, 0.1], **options)
            self.assertEqual(mixed.x_m.tolist(), rising.x_m[[2, 0, 1, 0]].tolist())
            self.assertEqual(mixed.t_s.tolist(), [0.5, 0.1, 0.3, 0.1])
            self.assertEqual(len(glidelab.smooth(t, x, at_s=[], **options).a_m_s2), 0)
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.smooth(t, x, at_s=[0.1, 9.0], **options)
            self.assertEqual(caught.exception.key, "at_s[1]")
        with self.assertRaises(glidelab.InputError) as caught:
            glidelab.smooth(t, x, 1e-9)
        self.assertEqual(caught.exception.key, "bandwidth_s")

    def test_wrong_input_is_refused(self):
        t, x = damped()
        for call in (lambda: glidelab.smooth(t, x, 0.0), lambda: glidelab.smooth(t, x, math.inf),
                     lambda: glidelab.smooth(t, x[1:], 0.05), lambda: glidelab.smooth(t[::-1], x, 0.05),
                     lambda: glidelab.smooth(t, x * math.nan, 0.05), lambda: glidelab.smooth(t, x, 0.05, order=6),
                     lambda: glidelab.smooth(t, x, 0.05, kernel="square"),
                     lambda: glidelab.smooth(t, x, 0.05, noise_m=-1.0),
                     lambda: glidelab.smooth(t, x, 0.05, noise_m=1.0, at_s=[0.1]),
                     lambda: glidelab.smooth(t, x), lambda: glidelab.smooth(t, x, 0.05, breaks_s=[0.1]),
                     lambda: glidelab.smooth(t, x, 0.05, smoother="kalman"),
                     lambda: glidelab.smooth(t, x, smoother="kalman", order=4),
                     lambda: glidelab.smooth(t, x, smoother="kalman", breaks_s=[t[-1] + 1.0]),
                     lambda: glidelab.smooth(t[:4], x[:4], smoother="spline"),
                     lambda: glidelab.smooth(t, x, smoother="lowess"),
                     lambda: glidelab.choose_bandwidth(t, x, "lines"), lambda: glidelab.position_noise(t[:3], x[:3])):
            with self.assertRaises(glidelab.InputError):
                call()


class Film(InFolder):
    def test_frames_are_those_of_the_file_and_the_marker_is_where_it_is(self):
        scenario = small_scenario()
        rendered = glidelab.render_folder(scenario, self.folder / "made", ideal=False)
        clip = glidelab.render(scenario)["m1-up"]
        frames = list(clip)
        self.assertEqual((len(frames), rendered.frames, rendered.clips), (len(clip), len(clip), 1))
        rows = (self.folder / "made.truth" / "marker-m1-up.csv").read_text().splitlines()[1:]
        for frame, row in zip(frames, rows):
            _, _, u, v, *_ = map(float, row.split(","))
            marker = glidelab.fit_marker(frame.pixels, (u + 0.5, v - 0.5), 2.4)
            self.assertIsNotNone(marker)
            # Six standard deviations, and a hundredth of a pixel of the model's own.
            self.assertLess(math.hypot(marker.u_px - u, marker.v_px - v), 6.0 * marker.sd_px + 0.02)
        self.assertTrue((self.folder / "made" / "experiment.toml").exists())
        with self.assertRaises(glidelab.InputError):
            glidelab.render_folder(scenario, self.folder / "made")

    def test_the_folder_is_that_of_the_command(self):
        scenario = small_scenario()
        glidelab.render_folder(scenario, self.folder / "mine", seed=4)
        from glidelab._toml import toml_text
        (self.folder / "scenario.toml").write_text(toml_text(scenario))
        run("render", self.folder / "scenario.toml", "--seed", "4", "-q", "-o", self.folder / "its")
        for suffix in ("", ".truth"):
            its = self.folder / f"its{suffix}"
            names = sorted(str(path.relative_to(its)) for path in its.rglob("*") if path.is_file())
            self.assertGreater(len(names), 3)
            for name in names:
                if "truth" not in suffix or name != "truth.json":  # which names the scenario's file
                    self.assertEqual((self.folder / f"mine{suffix}" / name).read_bytes(), (its / name).read_bytes(),
                                     name)

    def test_frames_in_memory_are_analysed_as_those_of_the_file(self):
        scenario = small_scenario()
        glidelab.render_folder(scenario, self.folder / "made")
        frames = glidelab.render(scenario)["m1-up"]
        stated = read_toml(self.folder / "made" / "experiment.toml")["clip"][0]
        stated = {key: value for key, value in stated.items() if key != "file"}
        of_folder = glidelab.analyze(self.folder / "made")
        for given in (frames, [frame.pixels for frame in frames]):
            film = glidelab.Film(given, self.folder / "made", **stated)
            of_film = glidelab.analyze(film)
            self.assertEqual(of_film.clips[0].motion.measured_x_m.tolist(), of_folder.clips[0].motion.measured_x_m.tolist())
            self.assertEqual(of_film.to_dict()["configurations"], of_folder.to_dict()["configurations"])
        of_film.write(self.folder / "written")  # whose page shows the frames, which are still there
        self.assertTrue((self.folder / "written" / "report.html").exists())
        self.assertEqual(glidelab.check([film]).usable, glidelab.check(self.folder / "made").usable)

    def test_frames_with_a_stated_scale_need_no_folder(self):
        # A disc of 9 pixels' radius that moves by 1.5 pixels a frame: v = 1.5 * 100 / 500 m/s, by the stated scale.
        v, u = np.mgrid[0:80, 0:240]
        frames = [(40.0 + 180.0 / (1.0 + np.exp(2.0 * (np.hypot(u - 40.0 - 1.5 * k, v - 40.0) - 9.0)))).astype(np.uint8)
                  for k in range(100)]
        tables = {"camera": {"frame_rate_hz": 100.0}, "scale": {"px_per_m": 500.0}, "marker": {"diameter_m": 0.036},
                  "track": {"downhill": "+X"}}
        clip, = glidelab.analyze(glidelab.Film(frames, tables, 0.3, "down", 0.0)).clips
        x = clip.motion.measured_x_m
        self.assertEqual((clip.name, clip.detected), ("clip-1", 100))
        self.assertAlmostEqual(np.polyfit(clip.motion.t_s, x, 1)[0], 0.3, places=3)
        for wrong, key in (([], "frames"), ([np.zeros((9, 9))], "frames[0]"), ([frames[0], np.zeros(9, np.uint8)], "frames[1]")):
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.analyze(glidelab.Film(wrong, tables, 0.3, "down"))
            self.assertEqual(caught.exception.key, key)
        with self.assertRaises(glidelab.InputError) as caught:
            glidelab.analyze([glidelab.Film(frames, tables, 0.3, "down"), glidelab.Film(frames, {}, 0.3, "down")])
        self.assertEqual(caught.exception.key, "experiment")
        with self.assertRaises(glidelab.InputError) as caught:
            glidelab.analyze(glidelab.Film(frames[:3], {**tables, "marker": {}}, 0.3, "sideways"))
        self.assertEqual({(one.file, one.key) for one in caught.exception.issues},
                         {("film/experiment.toml", "marker.diameter_m"), ("film/experiment.toml", "clip[1].launched")})

    def test_an_image_is_written_without_loss(self):
        from glidelab._sources import png
        random = np.random.default_rng(1)
        for shape, kind in (((5, 7), np.uint8), ((5, 7), np.uint16), ((4, 3, 3), np.uint8), ((4, 3, 3), np.uint16)):
            image = random.integers(0, np.iinfo(kind).max, shape, dtype=kind, endpoint=True)
            for given in (image, np.asfortranarray(image), image.astype(image.dtype.newbyteorder(">"))):
                np.testing.assert_array_equal(decoded(png("image", given)), image)

    def test_the_camera_is_recovered_from_its_views(self):
        scenario = small_scenario()
        glidelab.render_folder(scenario, self.folder / "made")
        files = sorted((self.folder / "made" / "calibration").glob("view-*.png"))
        camera = glidelab.calibrate(files, (9, 6), 0.04)
        self.assertEqual(camera.views_used, 12)
        self.assertLess(abs(camera.focal_px[0] - 575.0), 5.0 * camera.sd[0])
        self.assertLess(camera.sd[0], 1.0)
        self.assertEqual(camera.matrix[0, 0], camera.focal_px[0])
        with self.assertRaises(glidelab.InputError) as caught:
            glidelab.calibrate([np.zeros((300, 400), np.uint8)] * 3, (9, 6), 0.04)
        self.assertEqual(caught.exception.key, "calibration.views")

    def test_check_says_what_the_command_says(self):
        glidelab.render_folder(small_scenario(), self.folder / "made")
        checked = glidelab.check(self.folder / "made")
        run("check", self.folder / "made", "-q", "-o", self.folder / "out", status=0 if checked.usable else 4)
        self.assertEqual(checked.to_dict(), read_json(self.folder / "out" / "check.json"))

    def test_validate_finds_what_the_command_finds(self):
        scenario = small_scenario()
        scenario["configuration"][0]["clip"][0]["duration_s"] = 1.2
        validation = glidelab.validate(scenario, seed=9)
        from glidelab._toml import toml_text
        (self.folder / "scenario.toml").write_text(toml_text(scenario))
        run("validate", self.folder / "scenario.toml", "--seed", "9", "-q", "-o", self.folder / "out")
        its, mine = read_json(self.folder / "out" / "comparison.json"), validation.to_dict()
        self.assertGreater(mine.pop("wall_s"), 0.0)
        its.pop("wall_s")
        self.assertEqual(mine, its)
        self.assertEqual(validation.analysis_json, (self.folder / "out" / "results.json").read_text())


class Studies(InFolder):
    def test_coverage_is_that_of_the_command(self):
        path = SOURCE / "scenarios" / "paper" / "inclined.toml"
        mine = glidelab.coverage(path, noise_m=2e-5, replicates=10, seed=3)
        self.assertEqual(mine.rows[0].interval95, tuple(mine.to_dict()["quantities"][0]["coverage_interval95"]))
        run("coverage", path, "--noise-m", "2e-5", "--replicates", "10", "--seed", "3", "-q", "-o", self.folder / "out")
        self.assertEqual(mine.to_json(), (self.folder / "out" / "coverage.json").read_text())

    def test_a_program_of_one_s_own_is_judged_as_the_command_judges_it(self):
        command = f'/usr/bin/python3 "{SOURCE}/examples/estimators/finite_differences.py" {{folder}} {{out}}'
        mine = {"estimator_command": command, "estimator_name": "mine", "estimator_seconds": 120.0}
        its = ("--estimator-command", command, "--estimator-name", "mine", "--estimator-seconds", "120")
        timed = ("mean_s", "longest_s")

        def without_times(document):
            document["outside"] = {key: value for key, value in document["outside"].items() if key not in timed}
            document.pop("wall_s", None)
            return document

        path = SOURCE / "scenarios" / "paper" / "inclined.toml"
        run("coverage", path, "--noise-m", "2e-5", "--replicates", "3", "-q", *its, "-o", self.folder / "c")
        coverage = glidelab.coverage(path, noise_m=2e-5, replicates=3, **mine)
        self.assertEqual(without_times(coverage.to_dict()), without_times(read_json(self.folder / "c/coverage.json")))
        self.assertEqual((coverage.outside.name, coverage.outside.command, coverage.outside.runs,
                          coverage.outside.failed, coverage.outside.failures),
                         ("mine", command.replace('"', ""), 3, 0, {}))
        self.assertGreater(coverage.outside.longest_s, 0.0)
        self.assertTrue(any(row.estimator == "mine" and row.determined == 3 for row in coverage.rows))

        from glidelab._toml import toml_text
        (self.folder / "scenario.toml").write_text(toml_text(small_scenario()))
        run("validate", self.folder / "scenario.toml", "-q", *its, "-o", self.folder / "v")
        validation = glidelab.validate(self.folder / "scenario.toml", **mine)
        self.assertEqual(without_times(validation.to_dict()), without_times(read_json(self.folder / "v/comparison.json")))
        self.assertEqual((validation.outside.runs, validation.outside.failed), (1, 0))
        validation.write(self.folder / "written")
        self.assertEqual((self.folder / "written/results-mine.json").read_text(),
                         (self.folder / "v/results-mine.json").read_text())

        (self.folder / "sweep.toml").write_text(
            f'format = 1\nname = "short"\nscenario = "{path}"\nreplicates = 1\nseed = 2\nestimators = '
            '["phase-diagram"]\n[tracks]\nnoise_m = 2e-5\n[[vary]]\nkey = "camera.frame_rate_hz"\nvalues = [100.0, 200.0]\n')
        sweep = glidelab.sweep(self.folder / "sweep.toml", self.folder / "mine", **mine)
        said = json.loads(run("sweep", self.folder / "sweep.toml", "-q", "--json", *its, "-o", self.folder / "its"))
        self.assertEqual(without_times(sweep.to_dict()), without_times(said))
        self.assertEqual((sweep.outside.runs, sweep.outside.failed), (2, 0))

    def test_a_program_that_fails_is_counted_and_a_wrong_command_is_refused(self):
        path = SOURCE / "scenarios" / "paper" / "inclined.toml"
        judged = glidelab.coverage(path, noise_m=2e-5, replicates=2, estimator_seconds=0.3,
                                   estimator_command="sh -c 'sleep 60' sleeper {folder} {out}")
        self.assertEqual((judged.outside.runs, judged.outside.failed), (2, 2))
        self.assertEqual(judged.outside.failures["time_out"].count, 2)
        self.assertIn("0.3 s", judged.outside.failures["time_out"].first)
        self.assertIsNone(glidelab.coverage(path, noise_m=2e-5, replicates=2).outside)
        for wrong in ({"estimator_command": "sh mine"}, {"estimator_command": "no-such-program {folder} {out}"},
                      {"estimator_command": 3}, {"estimator_name": "mine"},
                      {"estimator_command": "sh {folder} {out}", "estimator_seconds": 0.0},
                      {"estimator_command": "sh {folder} {out}", "estimator_megabytes": 1e10},
                      {"estimator_command": "sh {folder} {out}", "estimator_megabytes": math.nan},
                      {"estimator_command": "sh {folder} {out}", "estimator_name": "trajectory"}):
            with self.assertRaises(glidelab.InputError):
                glidelab.coverage(path, noise_m=2e-5, replicates=2, **wrong)

    def test_another_interpreter_finds_this_package_and_the_modules_of_python(self):
        import os
        import subprocess
        from pathlib import Path
        from unittest import mock
        from glidelab import _apart
        (self.folder / "random.py").write_text("raise SystemExit('hidden')\n")  # numpy reads the one of Python
        (self.folder / "glidelab").symlink_to(Path(_apart.__file__).parent)
        with mock.patch.object(_apart, "__file__", str(self.folder / "glidelab" / "_apart.py")):
            command = _apart.interpreter()
        done = subprocess.run([*command, "diagnose", "no-such-folder", str(self.folder)], capture_output=True, text=True,
                              cwd=self.folder, env={name: value for name, value in os.environ.items() if name != "PYTHONPATH"})
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("no-such-folder", done.stderr)

    def test_an_image_that_is_too_large_is_refused(self):
        glidelab.render_folder(small_scenario(), self.folder / "made")  # 400 x 300 pixels
        small = glidelab.check(self.folder / "made", most_megapixels=0.1)
        self.assertFalse(small.usable)
        self.assertIn("400 x 300 pixels", str(small))
        for call in (glidelab.analyze, glidelab.diagnose, glidelab.certify):
            with self.assertRaises(glidelab.InputError) as caught:
                call(self.folder / "made", most_megapixels=0.1)
            self.assertIn("400 x 300 pixels", str(caught.exception))
            with self.assertRaises(glidelab.InputError) as caught:
                call(self.folder / "made", most_megapixels=0.0)
            self.assertEqual(caught.exception.key, "most_megapixels")
        self.assertEqual(glidelab.check(self.folder / "made", most_megapixels=0.2).to_json(),
                         glidelab.check(self.folder / "made").to_json())

    def test_a_sweep_goes_on_where_it_stopped(self):
        (self.folder / "scenario.toml").write_text((SOURCE / "scenarios" / "paper" / "inclined.toml").read_text())
        (self.folder / "sweep.toml").write_text(
            'format = 1\nname = "short"\nscenario = "scenario.toml"\nreplicates = 3\nseed = 2\nestimators = '
            '["phase-diagram"]\n[tracks]\nnoise_m = 2e-5\n[[vary]]\nkey = "camera.frame_rate_hz"\nvalues = [100.0, 200.0]\n')
        first = glidelab.sweep(self.folder / "sweep.toml", self.folder / "out")
        self.assertEqual((first.runs, first.failed), (6, 0))
        again = glidelab.sweep(self.folder / "sweep.toml", self.folder / "out")
        self.assertEqual(again.to_json(), first.to_json())
        self.assertEqual(run("sweep", self.folder / "sweep.toml", "-q", "--json", "-o", self.folder / "its"),
                         first.to_json())
