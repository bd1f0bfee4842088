"""check(): checks a recording before it is analysed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

from numpy.typing import ArrayLike

from . import _glidelab
from ._errors import input_error
from ._inputs import PathLike, Progress, Runs, Track, file_options, job_count, teller
from ._results import Made, Result, frame_of
from ._shown import html_table
from ._sources import Film, readable_source


@dataclass(frozen=True)
class Finding:
    """Something that is not as it should be.

    Attributes
    ----------
    severity : {"note", "change", "unusable"}
        Whether the recording can be used as it is.
    about : str
        The clip, or a part of the folder.
    found, advice : str
        What was seen, and what to do about it.
    """

    severity: str
    about: str
    found: str
    advice: str


@dataclass(frozen=True, eq=False, repr=False)
class RecordingCheck(Result):
    """What a look at a recording finds.

    Attributes
    ----------
    name : str
        Of the experiment.
    usable : bool
        Whether it can be analysed as it is.
    findings : tuple of Finding
        The most serious first.
    """

    name: str
    usable: bool
    findings: tuple[Finding, ...]

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per finding."""
        return frame_of({name: [getattr(one, name) for one in self.findings]
                         for name in ("severity", "about", "found", "advice")})

    def _repr_html_(self) -> str:
        rows = [[one.severity, one.about, one.found, one.advice] for one in self.findings]
        return html_table(["", "about", "found", "advice"], rows, "usable" if self.usable else "not usable as it is")


def check(source: Union[ArrayLike, Track, Film, PathLike, Sequence[Track], Sequence[Film]],
          x_m: Optional[ArrayLike] = None, *, allow_outside: bool = False,
          most_megapixels: Optional[float] = None, jobs: Optional[int] = None, progress: Progress = None,
          column: str = "", mass_kg: Optional[float] = None, incline_deg: Optional[float] = None, runs: Runs = None,
          masses_kg: Optional[Sequence[float]] = None,
          incline_sd_deg: Optional[float] = None, gravity_m_s2: Optional[float] = None,
          gravity_sd_m_s2: Optional[float] = None, frame_rate_hz: Optional[float] = None,
          px_per_m: Optional[float] = None) -> RecordingCheck:
    """A look at a recording before any analysis: pattern, marker, exposure, blur, frame times, statements.

    Parameters
    ----------
    source : array_like, Track, Film, str or path, or a sequence of tracks or of films
        ``check(t_s, x_m)``, as in `analyze`; a `Track` or several, each with its mass and how it was launched; a `Film`
        or several; an experiment folder, or a file with a track.
    x_m : array_like, shape (n,), optional
        With times as `source`: positions in metres, positive downhill.
    allow_outside, most_megapixels, jobs, progress, column, mass_kg, incline_deg, runs, masses_kg
        As in `analyze`.
    incline_sd_deg, gravity_m_s2, gravity_sd_m_s2, frame_rate_hz, px_per_m
        As in `analyze`.

    Returns
    -------
    RecordingCheck
        As ``glidelab check`` reports it (docs/reference/check.md). A recording that cannot be used raises no exception.

    Raises
    ------
    InputError
        There is no such folder or file, or it cannot be read; wrong numbers.

    Notes
    -----
    docs/reference/check.md lists what is looked at, with its limits. Arrays are written to a temporary folder, with all
    their digits, and read as a file or a folder is.
    """
    given = readable_source(source, x_m, {"column": column or None, "runs": runs, "masses_kg": masses_kg,
                                          "most_megapixels": most_megapixels, "frame_rate_hz": frame_rate_hz,
                                          "px_per_m": px_per_m}, allow_outside,
                            {"mass_kg": mass_kg, "incline_deg": incline_deg, "incline_sd_deg": incline_sd_deg},
                            {"gravity_m_s2": gravity_m_s2, "gravity_sd_m_s2": gravity_sd_m_s2})
    if len(given.paths) != 1:
        raise input_error("source", f"{len(given.paths)} names", "the name of one folder or file")
    files = file_options(given.paths, allow_outside, most_megapixels, column=column, runs=runs, masses_kg=masses_kg,
                         frame_rate_hz=frame_rate_hz, px_per_m=px_per_m, **given.stated)
    with given.told():
        made = Made(_glidelab.check(given.paths[0], files, job_count(jobs), teller(progress)), given.written)
    found = Result(made).to_dict()
    return RecordingCheck(made, found["name"], found["usable"], tuple(
        Finding(one["severity"], one["about"], one["found"], one["advice"]) for one in found["findings"]))
