"""What functions take: tracks, recordings, scenarios, and how they are to run."""

from __future__ import annotations

import importlib
import math
import os
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _glidelab
from ._checks import (Vector, above_0, file_name, is_whole, kind_of, optional_real, real, shown, stored, switch, text,
                      vector, whole)
from ._errors import input_error
from ._shown import Brief, html_plot, html_table, new_axes
from ._toml import toml_text

PathLike = Union[str, "os.PathLike[str]"]
Scenario = Union[PathLike, Mapping[str, Any]]
Progress = Union[Callable[[str, float], object], bool, None]


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Track(Brief):
    """One motion, as arrays, with what is known of it. x is positive downhill.

    Attributes
    ----------
    t_s : ndarray, shape (n,)
        Times in seconds, rising; n is 8 or more. A Track is made of any array_like.
    x_m : ndarray, shape (n,)
        Positions in metres.
    mass_kg : float, optional
        Of the glider. Without it 1 kg is assumed, on which K/m, mu and alpha do not depend; needed with a recorded
        force.
    incline_deg : float
        As stated, in degrees. It names the configuration; the inclination itself is measured.
    name : str
        Unique among the tracks of one call; without one, ``track-1``, ``track-2``, ...
    force_n : ndarray, shape (n,), optional
        A known force along x, in newtons.
    mass_sd_kg, incline_sd_deg : float, optional
        Standard deviations of what is stated. With that of the inclination, motion in one direction gives mu.
    launched : {"unknown", "up", "down", "released"}
        How the motion began. Motion against the stated launch is attributed to the hand.
    group : str
        Tracks of one group share one set-up of the track. Without it, those of one stated inclination do.
    """

    t_s: Vector
    x_m: Vector
    mass_kg: Optional[float] = None
    incline_deg: float = 0.0
    name: str = ""
    force_n: Optional[Vector] = None
    mass_sd_kg: float = 0.0
    incline_sd_deg: Optional[float] = None
    launched: str = "unknown"
    group: str = ""

    def __init__(self, t_s: ArrayLike, x_m: ArrayLike, mass_kg: Optional[float] = None, incline_deg: float = 0.0,
                 name: str = "", force_n: Optional[ArrayLike] = None, mass_sd_kg: float = 0.0,
                 incline_sd_deg: Optional[float] = None, launched: str = "unknown", group: str = "") -> None:
        given = {"t_s": stored(t_s), "x_m": stored(x_m), "mass_kg": mass_kg, "incline_deg": incline_deg, "name": name,
                 "force_n": None if force_n is None else stored(force_n), "mass_sd_kg": mass_sd_kg,
                 "incline_sd_deg": incline_sd_deg, "launched": launched, "group": group}
        for key, value in given.items():
            object.__setattr__(self, key, value)

    def plot(self, ax: Any = None) -> Any:
        """x over t.

        Returns
        -------
        matplotlib.axes.Axes
            `ax`, or new ones.
        """
        ax = new_axes(1)[0] if ax is None else ax
        ax.plot(self.t_s, self.x_m, ".", markersize=3, label=self.name or None)
        ax.set_xlabel("t (s)")
        ax.set_ylabel("x (m)")
        return ax

    def _repr_html_(self) -> str:
        stated = {"name": self.name, "mass (kg)": self.mass_kg, "stated α (°)": self.incline_deg,
                  "its sd (°)": self.incline_sd_deg, "launched": self.launched, "group": self.group}
        rows = [[words, f"{value:g}" if isinstance(value, (int, float)) else str(value)]
                for words, value in stated.items() if value not in (None, "")]
        try:
            t, x = vector("t_s", self.t_s), vector("x_m", self.x_m)
        except ValueError as error:  # what it holds is no motion, and it shows so
            return html_table(["", ""], [*rows, ["", str(error)]])
        rows += [["positions", str(len(x))]] + [
            [words, f"{values[0]:.4g} to {values[-1]:.4g}"] for words, values in (("t (s)", t), ("x (m)", x)) if len(values)]
        return html_table(["", ""], rows) + (html_plot(self.plot) if len(t) == len(x) else "")


def given_tracks(tracks: Sequence[Track]) -> list[_glidelab.GivenTrack]:
    """As the C++ side takes them."""
    given = []
    for number, track in enumerate(tracks, 1):
        name = text("name", track.name) or (f"track-{number}" if len(tracks) > 1 else "track")
        of = f'track "{name}"'
        force = np.empty(0) if track.force_n is None else vector("force_n", track.force_n, of)
        given.append(
            _glidelab.GivenTrack(name, vector("t_s", track.t_s, of), vector("x_m", track.x_m, of), force,
                                 optional_real("mass_kg", track.mass_kg, "kilograms, or None", of),
                                 real("mass_sd_kg", track.mass_sd_kg, "kilograms", of),
                                 real("incline_deg", track.incline_deg, "degrees", of),
                                 optional_real("incline_sd_deg", track.incline_sd_deg, "degrees, or None", of),
                                 text("launched", track.launched, "up, down, released or unknown", of),
                                 text("group", track.group, "text", of)))
    return given


def is_path(value: object) -> bool:
    """A file's or a folder's name."""
    return isinstance(value, (str, os.PathLike))


Runs = Union[str, Sequence[int], None]


def _positive(key: str, value: float, unit: str = "kilograms") -> float:
    return above_0(key, value, f"{unit}, above 0")


def _runs_text(runs: Runs) -> str:
    if runs is None or isinstance(runs, str):
        return runs or ""
    numbers = list(runs) if isinstance(runs, Iterable) else []
    if not numbers or not all(is_whole(one) for one in numbers):
        raise input_error("runs", shown(runs), 'numbers of runs, from 1 on, or "all"')
    return ",".join(str(one) for one in numbers)


def given_gravity(gravity_m_s2: Optional[float],
                  gravity_sd_m_s2: Optional[float]) -> tuple[Optional[float], Optional[float]]:
    """Gravity of arrays and its standard deviation; what is not stated stays None."""
    return (optional_real("gravity_m_s2", gravity_m_s2, "m/s², above 0, or None"),
            optional_real("gravity_sd_m_s2", gravity_sd_m_s2, "m/s², from 0 on, or None"))


def stated_incline(incline_deg: Optional[float], incline_sd_deg: Optional[float]) -> float:
    """The inclination of arrays; level if it is not stated. Its uncertainty is that of a stated one."""
    if incline_sd_deg is not None and incline_deg is None:
        raise input_error("incline_sd_deg", shown(incline_sd_deg), "incline_deg, whose uncertainty it is, as well")
    return 0.0 if incline_deg is None else incline_deg


def refuse(options: Mapping[str, object], why: str) -> None:
    """Arguments that do not apply here, and why."""
    for key, value in options.items():
        if value is not None:
            raise input_error(key, shown(value), f"nothing: {why}")


def refuse_of_arrays(of_numbers: bool, of_files: Mapping[str, object], allow_outside: bool,
                     of_motion: Mapping[str, object]) -> None:
    """Arrays have no columns, runs and images; a Track states its own mass, inclination and force, (t, x) does not."""
    refuse(of_files, "it is for files and folders, and these are arrays")
    if switch("allow_outside", allow_outside):
        refuse({"allow_outside": True}, "it is for folders, and these are arrays")
    if not of_numbers:
        refuse(of_motion, "a Track states its own")


def _megapixels(most: Optional[float]) -> Optional[float]:
    most_decoded = 1000.0  # OpenCV decodes no image of more than 2^30 pixels
    expected = f"millions of pixels, above 0 and at most {most_decoded:g}"
    number = optional_real("most_megapixels", most, expected)
    if number is not None and not 0.0 < number <= most_decoded:
        raise input_error("most_megapixels", f"{number:g}", expected)
    return number


def file_options(paths: Sequence[str], allow_outside: bool, most_megapixels: Optional[float], *, column: str = "",
                 mass_kg: Optional[float] = None, incline_deg: Optional[float] = None,
                 incline_sd_deg: Optional[float] = None, gravity_m_s2: Optional[float] = None,
                 gravity_sd_m_s2: Optional[float] = None, runs: Runs = None,
                 masses_kg: Optional[Sequence[float]] = None, recorded_by: str = "",
                 frame_rate_hz: Optional[float] = None, px_per_m: Optional[float] = None) -> _glidelab.FileOptions:
    """What is stated along with files with a track; a folder's experiment.toml says the same of its clips."""
    text("column", column, "a column's header or its number, as text")
    steepest_deg = 90.0  # a fall
    given = {"column": column or None, "mass_kg": mass_kg, "incline_deg": incline_deg,
             "incline_sd_deg": incline_sd_deg, "gravity_m_s2": gravity_m_s2, "gravity_sd_m_s2": gravity_sd_m_s2,
             "runs": runs, "masses_kg": masses_kg, "recorded_by": recorded_by or None,
             "frame_rate_hz": frame_rate_hz, "px_per_m": px_per_m}
    for key, value in given.items():
        if value is not None and any(os.path.isdir(path) for path in paths):
            raise input_error(key, shown(value), "none for a folder: its experiment.toml states it")
    if runs is not None and column:
        raise input_error("column", repr(column), "none with runs, each of which has a column of its own")
    if masses_kg is not None and mass_kg is not None:
        raise input_error("mass_kg", repr(mass_kg), "none with masses_kg")
    incline_deg = optional_real("incline_deg", incline_deg, "degrees, from -90 to 90")
    if incline_deg is not None and not abs(incline_deg) <= steepest_deg:  # NaN is not
        raise input_error("incline_deg", f"{incline_deg:g}", "degrees, from -90 to 90")
    stated_incline(incline_deg, incline_sd_deg)
    if gravity_sd_m_s2 is not None and gravity_m_s2 is None:
        raise input_error("gravity_sd_m_s2", repr(gravity_sd_m_s2), "gravity_m_s2, whose uncertainty it is, as well")
    gravity_sd_m_s2 = optional_real("gravity_sd_m_s2", gravity_sd_m_s2, "metres per second squared, from 0 on")
    if gravity_sd_m_s2 is not None and not (math.isfinite(gravity_sd_m_s2) and gravity_sd_m_s2 >= 0.0):
        raise input_error("gravity_sd_m_s2", f"{gravity_sd_m_s2:g}", "metres per second squared, from 0 on")
    masses = () if masses_kg is None else masses_kg
    if isinstance(masses, str) or not isinstance(masses, Iterable):
        raise input_error("masses_kg", shown(masses), "a list of kilograms")
    masses = [_positive("masses_kg", one) for one in masses]
    if masses_kg is not None and runs is None and len(masses) != len(paths):
        raise input_error("masses_kg", f"{len(masses)} of them",
                          f"one for each of the {len(paths)} file{'' if len(paths) == 1 else 's'}, or runs= as well")
    return _glidelab.FileOptions(column, None if mass_kg is None else _positive("mass_kg", mass_kg), incline_deg,
                                 None if incline_sd_deg is None else _positive("incline_sd_deg", incline_sd_deg,
                                                                               "degrees"),
                                 None if gravity_m_s2 is None else _positive("gravity_m_s2", gravity_m_s2,
                                                                             "metres per second squared"),
                                 gravity_sd_m_s2, _runs_text(runs), masses,
                                 switch("allow_outside", allow_outside), _megapixels(most_megapixels), recorded_by,
                                 None if frame_rate_hz is None else _positive("frame_rate_hz", frame_rate_hz, "hertz"),
                                 None if px_per_m is None else _positive("px_per_m", px_per_m, "pixels per metre"))


def recorder(recorded_by: str) -> str:
    """What measured the positions, as stated; empty if nothing is."""
    if recorded_by not in ("", "sensor", "camera"):
        raise input_error("recorded_by", repr(recorded_by), '"sensor" or "camera"')
    return recorded_by


def given_scenario(scenario: Scenario) -> tuple[str, Optional[str]]:
    """The file, or what a dict is called in messages and its text."""
    if isinstance(scenario, Mapping):
        return "scenario", text("scenario", toml_text(scenario))
    return file_name("scenario", scenario, "the name of a file, or a dict"), None


def scenarios_folder() -> Path:
    """The folder of the scenarios that come with Glidelab: ``scenarios_folder() / "paper/inclined.toml"``.

    Returns
    -------
    Path
        That of the checkout in which Python runs or the module was built; else that of the package, as pip installs it;
        else the one next to which the package is installed, or of the Debian package ``glidelab``.

    Raises
    ------
    InputError
        There is none of them; the message says where they were looked for.
    """
    package, here = Path(__file__).resolve().parent, Path.cwd()
    within = [folder / "scenarios" for folder in (here, *here.parents, package, *package.parents)]
    shared = [folder / "share" / "glidelab" / "scenarios" for folder in (*package.parents, Path("/usr"))]
    for folder in (*within, *shared):
        if (folder / "tutorial.toml").is_file():
            return folder
    raise input_error("scenarios", "no such folder", f'a folder "scenarios" with tutorial.toml in {here}, in {package}, or in a '
                      f"folder above them, or {shared[-1]}: from a checkout, `pip install .`, or the Debian package glidelab")


def load_scenario(file: PathLike) -> dict[str, Any]:
    """A scenario file as a dict, to be changed and given to `simulate`, `validate`, `coverage`, ...

    Parameters
    ----------
    file : str or path
        As docs/reference/scenario.md describes it. A camera file that it names is named by its absolute path then, so
        that the dict means the same wherever it is used.

    Returns
    -------
    dict
        Tables are dicts, arrays of tables are lists of dicts. Only that the file is TOML is checked.

    Raises
    ------
    InputError
        There is no such file, it cannot be read, or is not TOML.
    """
    path = Path(file_name("file", file))
    try:
        scenario = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise input_error("", (error.strerror or "nothing").lower(), "a scenario file that can be read", str(path)) from None
    except UnicodeDecodeError:
        raise input_error("", "bytes that are not UTF-8", "a TOML file", str(path)) from None
    except tomllib.TOMLDecodeError as error:
        raise input_error("", str(error), "a TOML file", str(path)) from None
    camera = scenario.get("camera_file")
    if isinstance(camera, str):
        scenario["camera_file"] = str((path.parent / camera).resolve())
    return scenario


def job_count(jobs: Optional[int]) -> int:
    """How many threads: as many as there are cores, where nothing is said."""
    return os.cpu_count() or 1 if jobs is None else whole("jobs", jobs, 1, 1024)


def checked_seed(seed: Optional[int]) -> Optional[int]:
    """A seed as the C++ side takes it."""
    return None if seed is None else whole("seed", seed, 0, 2**64 - 1)


class _Bar:
    """Progress as a bar of tqdm, one for each stage."""

    def __init__(self) -> None:
        try:
            self._tqdm: Any = importlib.import_module("tqdm.auto").tqdm
        except ModuleNotFoundError:
            raise input_error("progress", "True, and no tqdm", "python3-tqdm installed, or a function(stage, fraction)"
                              ) from None
        self._stage: Optional[str] = None
        self._bar: Any = None

    def __call__(self, stage: str, fraction: float) -> None:
        if stage != self._stage:
            self._finish()
            self._stage = stage
            self._bar = self._tqdm(total=100, desc=stage, bar_format="{desc}: {percentage:3.0f}% |{bar}| {elapsed}")
        self._bar.update(100.0 * fraction - self._bar.n)

    def _finish(self) -> None:
        """A stage that another one follows is done, whatever was last said of it."""
        if self._bar is not None:
            self._bar.update(100.0 - self._bar.n)
            self._bar.close()


def teller(progress: Progress) -> Optional[Callable[[str, float], object]]:
    """The function that is told of the progress; None for no progress."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _Bar()
    if not callable(progress):
        raise input_error("progress", kind_of(progress), "a function(stage, fraction), True or None")
    return progress
