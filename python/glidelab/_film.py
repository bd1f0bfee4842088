"""render(): a scenario as the camera sees it, frame by frame in memory, or as an experiment folder."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import InitVar, dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _glidelab
from ._shown import Brief
from ._checks import file_name, frozen, switch
from ._errors import input_error
from ._inputs import PathLike, Progress, Scenario, checked_seed, given_scenario, job_count, teller

Pixels = Union[NDArray[np.uint8], NDArray[np.uint16]]


@dataclass(frozen=True, eq=False, repr=False)
class Frame(Brief):
    """One image as the camera stores it, with what is true of it.

    Attributes
    ----------
    pixels : ndarray, shape (height, width), uint8 or uint16
        Grey; the first row is the upper one.
    stamp_s : float
        What a container would say of its time.
    slot : int
        Of the camera's clock; slots without a frame were dropped.
    repeated : bool
        The image before, stored once more.
    true_t_s, true_x_m, true_v_m_s : float
        The middle of the exposure, and where the glider was then and how fast.
    """

    pixels: Pixels
    stamp_s: float
    slot: int
    repeated: bool
    true_t_s: float
    true_x_m: float
    true_v_m_s: float


class _Source:  # pylint: disable=too-few-public-methods
    """Where a clip's frames come from: in none of its fields."""

    _film: _glidelab.Film
    _number: int


@dataclass(frozen=True, eq=False, repr=False)
class FilmedClip(_Source, Brief):
    """One clip of a film; iterate over it for its frames. Only one frame is in memory at a time.

    Attributes
    ----------
    name, configuration : str
        Of the clip, and of its configuration in the scenario.
    frames : int
        How many there are; also ``len(clip)``.
    """

    name: str
    configuration: str
    frames: int
    film: InitVar[_glidelab.Film]
    number: InitVar[int]

    def __post_init__(self, film: _glidelab.Film, number: int) -> None:
        object.__setattr__(self, "_film", film)
        object.__setattr__(self, "_number", number)

    def __len__(self) -> int:
        return self.frames

    def __iter__(self) -> Iterator[Frame]:
        source = self._film.frames(self._number)
        while (found := source.next()) is not None:
            pixels, t_s, stamp_s, slot, repeated, x_m, v_m_s = found
            yield Frame(frozen(pixels), stamp_s, slot, repeated, t_s, x_m, v_m_s)


def render(scenario: Scenario, *, seed: Optional[int] = None, jobs: Optional[int] = None,
           progress: Progress = None) -> dict[str, FilmedClip]:
    """A scenario's clips as the camera sees them, to be iterated over frame by frame.

    Parameters
    ----------
    scenario : str, path or dict
        A scenario file (docs/reference/scenario.md), or what `load_scenario` makes of one.
    seed : int, optional
        Of the camera's noise; the scenario's.
    jobs, progress
        As in `analyze`; of what stands still, which is drawn first.

    Returns
    -------
    dict of str to FilmedClip
        By the clips' names. Frames are, bit for bit, those that ``glidelab render`` hands to the codec with this seed.

    Raises
    ------
    InputError
        Everything that is wrong with the scenario.

    Notes
    -----
    The sensor is that of the standard EMVA 1288; docs/reference/scenario.md has lens, exposure and shutter.

    Examples
    --------
    >>> clip = next(iter(glidelab.render("scenarios/tutorial.toml").values())) # doctest: +SKIP
    >>> brightest = [frame.pixels.max() for frame in clip] # doctest: +SKIP
    """
    film = _glidelab.set_up_film(given_scenario(scenario), checked_seed(seed), job_count(jobs), teller(progress))
    return {name: FilmedClip(name, configuration, frames, film, number)
            for number, (name, configuration, frames) in enumerate(film.clips())}


@dataclass(frozen=True)
class Rendered:
    """Where an experiment folder and its truth were written, and how much is in them.

    Attributes
    ----------
    experiment, truth : str
        The two folders.
    clips, frames : int
        How many there are, over all clips.
    """

    experiment: str
    truth: str
    clips: int
    frames: int


def render_folder(scenario: Scenario, folder: PathLike, *, seed: Optional[int] = None, ideal: bool = False,
                  jobs: Optional[int] = None, progress: Progress = None) -> Rendered:
    """Films a scenario: writes an experiment folder as a camera would, and the truth next to it.

    Parameters
    ----------
    scenario, seed
        As in `render`.
    folder : str or path
        Missing, or empty. The truth goes to ``FOLDER.truth``.
    ideal : bool
        Write sharp frames without noise and distortion besides, into the truth.
    jobs, progress
        As in `analyze`.

    Returns
    -------
    Rendered
        The two folders, bit for bit as ``glidelab render`` writes them.

    Raises
    ------
    InputError
        Something is in the folder; everything that is wrong with the scenario.
    SystemFailure
        A codec is missing, the disk is full.

    Notes
    -----
    docs/reference/experiment-folder.md has the form of the folder.
    """
    name = file_name("folder", folder, "the name of a folder")
    if not name:
        raise input_error("folder", "nothing", "the name of a folder")
    found: tuple[Any, ...] = _glidelab.render_folder(given_scenario(scenario), name, checked_seed(seed),
                                                     switch("ideal", ideal), job_count(jobs), teller(progress))
    return Rendered(*found)
