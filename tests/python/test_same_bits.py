"""The module gives the same bits as the command: the JSON is compared as text."""

import inspect

import glidelab
from tests.python.support import SOURCE, InFolder, damped, read_json, run

SCENARIO = SOURCE / "scenarios" / "paper" / "inclined.toml"


def made_tracks():
    """Four motions of two masses on one slope."""
    tracks = []
    for number, (mass_kg, v0) in enumerate([(0.335, -1.2), (0.335, -1.1), (0.435, -1.2), (0.435, -1.0)], 1):
        t, x = damped(k_1_s=2.77 * 0.335 / mass_kg, v0_m_s=v0, seed=number)
        tracks.append(glidelab.Track(t, x, mass_kg=mass_kg, incline_deg=4.3, incline_sd_deg=0.1, launched="up",
                                     name=f"m{number}"))
    return tracks


class SameBits(InFolder):
    def test_simulate(self):
        run("simulate", SCENARIO, "-q", "-o", self.folder / "out")
        said = run("simulate", SCENARIO, "-q", "--json", "-o", self.folder / "out")
        for scenario in (SCENARIO, str(SCENARIO), glidelab.load_scenario(SCENARIO)):
            simulation = glidelab.simulate(scenario)
            self.assertEqual(simulation.to_json(), said)
        simulation.write(self.folder / "written")
        for clip in simulation.clips:
            name = f"trajectory-{clip.name}.csv"
            text = (self.folder / "out" / name).read_text()
            self.assertEqual((self.folder / "written" / name).read_text(), text)
            rows = [line.split(",") for line in text.splitlines()[1:]]
            for column, values in enumerate((clip.t_s, clip.x_m, clip.v_m_s, clip.a_m_s2)):
                self.assertEqual([float(row[column]) for row in rows], values.tolist())
            self.assertEqual([row[4] for row in rows], clip.mode.tolist())

    def test_analyze(self):
        tracks = made_tracks()
        folder = self.write_experiment(tracks)
        for options, choices in ((), {}), (("--bandwidth", "0.05"), {"bandwidth": 0.05}), (
                ("--bandwidth", "gcv"), {"bandwidth": "gcv"}), (
                ("--estimator", "trajectory", "--robust"), {"estimator": "trajectory", "robust": True}):
            with self.subTest(choices):
                said = run("analyze", folder, "-q", "--json", "-o", self.folder / "out", *options)
                self.assertEqual(glidelab.analyze(folder, **choices).to_json(), said)
                self.assertEqual(glidelab.analyze(tracks, name="made", **choices).to_json(), said)

    def test_what_is_stated_beside_a_file(self):
        t, x = damped()
        file = self.folder / "track.csv"
        file.write_text("t_s,x_m\n" + "".join(f"{a!r},{b!r}\n" for a, b in zip(t.tolist(), x.tolist())))
        for options, stated in ((), {}), (("--gravity", "9.81"), {"gravity_m_s2": 9.81}), (
                ("--gravity", "9.8123", "--gravity-sd", "0.002"), {"gravity_m_s2": 9.8123, "gravity_sd_m_s2": 0.002}), (
                ("--incline", "4", "--incline-sd", "0.1"), {"incline_deg": 4.0, "incline_sd_deg": 0.1}):
            with self.subTest(stated):
                said = run("analyze", file, "-q", "--json", "-o", self.folder / "out", *options)
                of_file = glidelab.analyze(file, **stated)
                self.assertEqual(of_file.to_json(), said)
                of_arrays = glidelab.analyze(t, x, **stated)
                for quantity in ("mu", "alpha_deg"):
                    one, other = (getattr(of.configurations[0], quantity) for of in (of_file, of_arrays))
                    self.assertEqual((one.value, one.sd), (other.value, other.sd))

    def test_analyze_writes_the_command_s_files(self):
        tracks = made_tracks()
        folder = self.write_experiment(tracks)
        run("analyze", folder, "-q", "-o", self.folder / "out")
        glidelab.analyze(folder).write(self.folder / "written")
        names = sorted(path.name for path in (self.folder / "out").iterdir() if path.is_file())
        self.assertEqual(sorted(path.name for path in (self.folder / "written").iterdir() if path.is_file()), names)
        self.assertIn("results.json", names)
        for name in names:
            self.assertEqual((self.folder / "written" / name).read_bytes(), (self.folder / "out" / name).read_bytes())

    def test_diagnose(self):
        tracks = made_tracks()
        folder = self.write_experiment(tracks)
        run("diagnose", folder, "-q", "--no-page", "-o", self.folder / "out")
        said = (self.folder / "out" / "diagnosis.json").read_text()
        self.assertEqual(glidelab.diagnose(folder).to_json(), said)
        diagnosis = glidelab.diagnose(tracks, name="made")
        self.assertEqual(diagnosis.to_json(), said)
        self.assertEqual(diagnosis.verdict, read_json(self.folder / "out" / "diagnosis.json")["verdict"])
        self.assertEqual(glidelab.explain(diagnosis), run("diagnose", folder, "-q", "--no-page", "-o",
                                                          self.folder / "out"))

    def test_analyze_with_effects(self):
        tracks = made_tracks()
        folder = self.write_experiment(tracks)
        said = run("analyze", folder, "-q", "--json", "--with", "quadratic_drag", "--with", "track_bow", "-o",
                   self.folder / "out")
        found = glidelab.analyze(folder, with_effects=["quadratic_drag", "track_bow"])
        self.assertEqual(found.to_json(), said)
        self.assertEqual(glidelab.analyze(tracks, name="made", with_effects=["quadratic_drag", "track_bow"]).to_json(),
                         said)
        self.assertEqual(list(found.with_effects.effects), ["quadratic_drag", "track_bow"])
        self.assertEqual(len(found.with_effects.recovered), len(found.configurations))
        self.assertIn("with quadratic_drag, track_bow", found._repr_html_())
        self.assertEqual(str(found), run("analyze", folder, "-q", "--with", "quadratic_drag", "--with", "track_bow",
                                         "-o", self.folder / "out"))
        found.write(self.folder / "written")
        for name in ("results.json", "report.html"):
            self.assertEqual((self.folder / "written" / name).read_bytes(), (self.folder / "out" / name).read_bytes())
        self.assertIsNone(glidelab.analyze(tracks).with_effects)
        for wrong in (["gremlins"], ["track_bow", "track_bow"], "track_bow", [3]):
            with self.assertRaises(glidelab.InputError) as caught:
                glidelab.analyze(tracks, with_effects=wrong)
            self.assertEqual(caught.exception.key, "with_effects")

    def test_blind(self):
        for options, choices in (((), {}), (("--everyday", "--only", "dropped_frames"),
                                            {"everyday": True, "only": "dropped_frames"})):
            with self.subTest(choices):
                name = "everyday" if choices else "tracks"
                its, mine = self.folder / f"{name}-its", self.folder / f"{name}-mine"
                run("blind", "--cases", "1", "--seed", "3", *options, "-q", "-o", its)
                blind = glidelab.blind(1, mine, seed=3, **choices)
                wanted, said = read_json(its / "blind.json"), blind.to_dict()
                for document in (wanted, said):  # all but how long a diagnosis took
                    document.get("everyday", {}).pop("seconds", None)
                    document["outcomes"][0].pop("seconds", None)
                    document["targets"] = [one for one in document["targets"] if "seconds" not in one["what"]]
                self.assertEqual(said, wanted)
                for part in ("cases/0000/experiment.toml", "diagnoses/0000/diagnosis.json", "truth/0000.json"):
                    self.assertEqual((mine / part).read_bytes(), (its / part).read_bytes())
                case = blind.cases[0]
                self.assertEqual((case.verdict, list(case.causes)),
                                 (said["outcomes"][0]["verdict"], [one["id"] for one in said["outcomes"][0]["truth"]]))
                self.assertIn("1 blind cases, seed 3", blind._repr_html_())
                blind.write(mine)
                self.assertIn("<html", (mine / "report.html").read_text())
                self.assertEqual(glidelab.blind(1, mine, seed=3, **choices).to_dict()["outcomes"],
                                 blind.to_dict()["outcomes"])  # kept, not made again
        for wrong in ({"only": "gremlins"}, {"everyday": True, "pictures": True}, {"seed": 4}, {"cases": 0}):
            with self.assertRaises(glidelab.InputError):
                glidelab.blind(**{"cases": 1, "folder": self.folder / "tracks-mine", "seed": 3, **wrong})

    def test_require(self):
        (self.folder / "two.toml").write_text(
            f'format = 1\nname = "two"\nscenario = "{SCENARIO}"\nlevel = "tracks"\nreplicates = 1\n'
            '[[vary]]\nkey = "tracks.noise_m"\nvalues = [1e-5, 4e-5]\n')
        said = run("require", self.folder / "two.toml", "--target", "mu=0.001", "--track-runs", "20", "--seed", "5",
                   "-q", "--json", "-o", self.folder / "out")
        self.assertEqual(glidelab.require(self.folder / "two.toml", ["mu=0.001"], track_runs=20, seed=5).to_json(),
                         said)

    def test_require_by_its_defaults_judges_as_the_command_does(self):
        # A target that the bound forbids renders nothing, and the text says how the others would be judged.
        for level in ("clips", "tracks"):
            (self.folder / "sweep.toml").write_text(
                f'format = 1\nname = "sweep"\nscenario = "{SCENARIO}"\nlevel = "{level}"\n'
                f'[[vary]]\nkey = "{"camera.exposure_s" if level == "clips" else "tracks.noise_m"}"\nvalues = [1e-3]\n')
            said = run("require", self.folder / "sweep.toml", "--target", "mu=1e-9", "-q", "-o", self.folder / "out",
                       status=4)
            self.assertEqual(str(glidelab.require(self.folder / "sweep.toml", ["mu=1e-9"])), said)
            self.assertEqual("Judged by" in said, level == "tracks")
        usual = inspect.signature(glidelab.require).parameters
        self.assertEqual((usual["confirm"].default, usual["runs"].default, usual["track_runs"].default), (None, 20, 200))
        self.assertRegex(run("require", "--help"), r"--runs N:INT in \[2 - \d+\]=20\n")

    def test_an_estimator_s_program_that_prints_other_bytes_loses_no_run(self):
        (self.folder / "mine.sh").write_bytes(b"printf 'ung\\374ltig\\n' >&2; exit 2\n")
        judged = glidelab.coverage(SCENARIO, noise_m=2e-5, replicates=2, seed=1,
                                   estimator_command=f"sh {self.folder}/mine.sh {{folder}} {{out}}")
        self.assertEqual(judged.outside.failures["exit_status"].count, 2)
        self.assertEqual(judged.outside.failures["exit_status"].first, "exit status 2: ung\ufffdltig")
        self.assertTrue(str(judged).startswith("“mine” failed in 2 of 2 runs: "))

    def test_certify(self):
        folder = self.write_experiment(made_tracks())
        said = run("certify", folder, "-q", "--json", "--twins", "20", "--seed", "3", "-o", self.folder / "out")
        certificate = glidelab.certify(folder, twins=20, seed=3)
        self.assertEqual(certificate.to_json(), said)
        self.assertEqual([one.quantity for one in certificate.quantities],
                         ["k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"])
        self.assertTrue(certificate.holds)
        self.assertEqual(sum(one.twins for one in certificate.explanations), 20)

    def test_certify_and_check_of_arrays_are_those_of_files(self):
        tracks = made_tracks()
        folder = self.write_experiment(tracks)
        for function, more in ((glidelab.certify, {"twins": 20, "seed": 3}), (glidelab.check, {})):
            with self.subTest(function.__name__):
                of_folder, of_tracks = function(folder, **more).to_dict(), function(tracks, **more).to_dict()
                for document in (of_folder, of_tracks):  # one was given a name
                    document.pop("name", None)
                self.assertEqual(of_tracks, of_folder)
                t, x = tracks[0].t_s, tracks[0].x_m
                file = self.folder / "track.csv"
                file.write_text("t_s,x_m\n" + "".join(f"{a!r},{b!r}\n" for a, b in zip(t.tolist(), x.tolist())))
                stated = {"mass_kg": 0.335, "incline_deg": 4.3, "gravity_m_s2": 9.8123}
                of_arrays = function(t, x, **stated, **more)
                self.assertEqual(of_arrays.to_json(), function(file, **stated, **more).to_json())
                of_arrays.write(self.folder / function.__name__)
                self.assertTrue((self.folder / function.__name__ / "report.html").exists())

    def test_a_folder_of_simulated_tracks_is_read(self):
        clips = glidelab.simulate(SCENARIO).clips
        tracks = [clip.track(noise_m=2e-5, mass_kg=0.335, incline_deg=4.0) for clip in clips[:2]]
        self.assertEqual([track.launched for track in tracks],
                         ["up" if clip.v_m_s[0] < 0.0 else "down" if clip.v_m_s[0] > 0.0 else "released" for clip in clips[:2]])
        self.assertEqual(glidelab.analyze(self.write_experiment(tracks)).to_json(), glidelab.analyze(tracks, name="made").to_json())
        self.assertEqual(clips[0].track(launched="unknown").launched, "unknown")

    def test_files_with_several_runs(self):
        tracks = made_tracks()[:2]
        file = self.folder / "runs.csv"
        rows = zip(tracks[0].t_s, tracks[0].x_m, tracks[1].t_s, tracks[1].x_m)
        file.write_text("Run 1: Time (s),Run 1: Position (m),Run 2: Time (s),Run 2: Position (m)\n" + "".join(
            ",".join(repr(float(value)) for value in row) + "\n" for row in rows))
        for options, choices in ((("--runs", "all", "--mass", "0.335", "--incline", "4.3"),
                                  {"runs": "all", "mass_kg": 0.335, "incline_deg": 4.3}),
                                 (("--runs", "2,1", "--masses", "0.3,0.4"), {"runs": [2, 1], "masses_kg": [0.3, 0.4]})):
            with self.subTest(choices):
                said = run("analyze", file, "-q", "--json", "-o", self.folder / "a", *options)
                self.assertEqual(glidelab.analyze(file, **choices).to_json(), said)
                said = run("check", file, "-q", "--json", "-o", self.folder / "c", *options)
                self.assertEqual(glidelab.check(file, **choices).to_json(), said)
                run("diagnose", file, "-q", "--no-page", "-o", self.folder / "d", *options)
                self.assertEqual(glidelab.diagnose(file, **choices).to_json(),
                                 (self.folder / "d" / "diagnosis.json").read_text())
        by_sensor = glidelab.diagnose(file, runs="all")  # as its header says
        self.assertIn("motion sensor", " ".join(by_sensor.notes))
        self.assertNotIn("motion sensor", " ".join(glidelab.diagnose(file, runs="all", recorded_by="camera").notes))
        stated = glidelab.diagnose(tracks, recorded_by="sensor")
        self.assertIn("A motion sensor measured the positions", " ".join(stated.notes))
        self.assertEqual(len(glidelab.analyze(file, runs=[2]).clips), 1)

    def test_tables_of_frames_and_pixels(self):
        tracks = made_tracks()[:2]
        files = []
        for k, track in enumerate(tracks):
            files.append(self.folder / f"track-{k}.csv")
            files[-1].write_text("frame,x (px)\n" + "".join(
                f"{row},{500.0 * float(x)!r}\n" for row, x in enumerate(track.x_m)))
        options = ("--frame-rate", "200", "--px-per-m", "500", "--masses", "0.3,0.4")
        choices = {"frame_rate_hz": 200.0, "px_per_m": 500.0, "masses_kg": [0.3, 0.4]}
        said = run("analyze", *files, "-q", "--json", "-o", self.folder / "a", *options)
        self.assertEqual(glidelab.analyze(files, **choices).to_json(), said)
        run("diagnose", *files, "-q", "--no-page", "-o", self.folder / "d", *options)
        self.assertEqual(glidelab.diagnose(files, **choices).to_json(), (self.folder / "d" / "diagnosis.json").read_text())
        said = run("check", files[0], "-q", "--json", "-o", self.folder / "c", "--frame-rate", "200", "--px-per-m", "500",
                   "--mass", "0.3")
        self.assertEqual(glidelab.check(files[0], frame_rate_hz=200.0, px_per_m=500.0, mass_kg=0.3).to_json(), said)

    def test_plan(self):
        said = run("diagnose", "--plan", SCENARIO, "--noise-m", "2e-5", "--seed", "7", "-q", "--no-page", "--json",
                   "-o", self.folder / "out")
        self.assertEqual(glidelab.plan(SCENARIO, noise_m=2e-5, seed=7).to_json(), said)
