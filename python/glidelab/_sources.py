"""What functions are given: tracks, films, names of files; and how those that read files read what is in memory."""

from __future__ import annotations

import os
import shutil
import struct
import tempfile
import weakref
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._checks import file_name, kind_of, real, refuse_masked, shown, text, vector
from ._errors import InputError, input_error
from ._inputs import PathLike, Track, given_tracks, is_path, load_scenario, refuse_of_arrays
from ._shown import Brief
from ._toml import toml_text


@dataclass(frozen=True, eq=False, repr=False)
class Film(Brief):
    """The frames of one motion in memory, with what an experiment folder states of them.

    Attributes
    ----------
    frames : iterable of array_like, shape (height, width) or (height, width, 3), uint8 or uint16
        Grey, or red, green and blue, at the rate that `experiment` states; or a `FilmedClip`. They are taken one after
        the other.
    experiment : str, path or dict
        An experiment folder that states the camera, the calibration and the marker, and has the stills: its clips are
        left out. Or a dict of the tables of experiment.toml (docs/reference/experiment-folder.md): ``camera``,
        ``scale``, ``marker``, ``track``. Films that are analysed together have the same.
    mass_kg : float
        Of the glider.
    launched : {"up", "down", "released"}
        How the motion began.
    incline_deg : float
        As stated, in degrees.
    name : str
        Without one, ``clip-1``, ``clip-2``, ...
    mass_sd_kg, incline_sd_deg : float, optional
        Standard deviations of what is stated.
    start_s, end_s : float, optional
        The part in which the glider moves freely; left out, the analysis finds it.
    group : str
        As of a `Track`.
    """

    frames: Iterable[Any]
    experiment: Union[PathLike, Mapping[str, Any]]
    mass_kg: float
    launched: str
    incline_deg: float = 0.0
    name: str = ""
    mass_sd_kg: Optional[float] = None
    incline_sd_deg: Optional[float] = None
    start_s: Optional[float] = None
    end_s: Optional[float] = None
    group: str = ""


def png(name: str, image: Any) -> bytes:
    """An image as a PNG file, without loss; `name` stands in messages."""
    refuse_masked(name, image)
    pixels = np.asarray(image)
    is_image = pixels.dtype.kind == "u" and pixels.dtype.itemsize <= 2 and pixels.size > 0
    if not is_image or pixels.ndim not in (2, 3) or pixels.shape[2:] not in ((), (3,)):
        raise input_error(name, f"an array of shape {pixels.shape} of {pixels.dtype}",
                          "an image: (height, width), or (height, width, 3), of uint8 or uint16")
    height, width = pixels.shape[:2]
    bits, colours = 8 * pixels.dtype.itemsize, 0 if pixels.ndim == 2 else 2
    rows = np.ascontiguousarray(pixels, dtype=pixels.dtype.newbyteorder(">")).view(np.uint8).reshape(height, -1)
    lines = np.hstack([np.zeros((height, 1), np.uint8), rows])  # each begins with its filter, none

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, bits, colours, 0, 0, 0)
    quick = 1  # level of compression
    return b"".join([b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(lines.tobytes(), quick)),
                     chunk(b"IEND", b"")])


class Written:
    """What is in memory as files, for what reads files alone; they are there as long as this is."""

    path: str

    def __init__(self) -> None:
        self._folder = tempfile.mkdtemp(prefix="glidelab-")
        weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)

    @contextmanager
    def told(self) -> Iterator[None]:
        """Around what reads the files: it names them in messages, and these are none that the caller knows."""
        try:
            yield
        except InputError as error:
            folder = self._folder + os.sep
            issues = [(one.file.replace(folder, ""), one.line, one.key, one.found, one.expected) for one in error.issues]
            raise InputError(str(error).replace(folder, ""), issues) from None


class _Told:  # pylint: disable=too-few-public-methods
    """What may have been written for the call."""

    written: Optional[Written]

    def told(self) -> AbstractContextManager[None]:
        """Around the call: files that were made for it are not named with their folder."""
        return nullcontext() if self.written is None else self.written.told()


class WrittenTracks(Written):
    """Tracks as files."""

    def __init__(self, tracks: Sequence[Track], of_numbers: bool, gravity: Mapping[str, Optional[float]]) -> None:
        super().__init__()
        if of_numbers:  # nothing but a motion: a file with a track, of which no launch need be known
            self.path = str(self._table(tracks[0], Path(self._folder, "track.csv")))
            return
        self.path = os.path.join(self._folder, "tracks")
        os.mkdir(self.path)
        given_tracks(tracks)  # names everything that is wrong with a single value
        document: dict[str, Any] = {"format": 1, "name": "tracks", **{key: real(key, value) for key, value in gravity.items()
                                                                      if value is not None}}
        document["clip"] = [self._clip(track, number) for number, track in enumerate(tracks, 1)]
        Path(self.path, "experiment.toml").write_text(toml_text(document), encoding="utf-8")

    def _clip(self, track: Track, number: int) -> dict[str, Any]:
        name = track.name or f"track-{number}"
        of = f'track "{name}"'
        for key, value, wanted in (("mass_kg", track.mass_kg, "the mass in kilograms"),
                                   ("launched", None if track.launched == "unknown" else track.launched,
                                    "up, down or released")):
            if value is None:
                raise input_error(key, repr(getattr(track, key)), f"{wanted}: this function needs it", of)
        self._table(track, Path(self.path, f"{number}.csv"))
        stated = {"name": name, "track": f"{number}.csv", "mass_kg": track.mass_kg, "mass_sd_kg": track.mass_sd_kg,
                  "incline_deg": float(track.incline_deg), "incline_sd_deg": track.incline_sd_deg,
                  "launched": track.launched, "group": track.group}
        return {key: value for key, value in stated.items() if value not in (None, "")}

    @staticmethod
    def _table(track: Track, file: Path) -> Path:
        """With all digits."""
        columns = {"t_s": track.t_s, "x_m": track.x_m, "force_n": track.force_n}
        vectors = {name: vector(name, values).tolist() for name, values in columns.items() if values is not None}
        for name, values in vectors.items():
            if len(values) != len(vectors["t_s"]):
                raise input_error(name, f"{len(values)} numbers", f"as many as times, {len(vectors['t_s'])}")
        rows = [",".join(map(repr, row)) for row in zip(*vectors.values())]
        file.write_text("\n".join([",".join(vectors), *rows, ""]), encoding="utf-8")
        return file


class WrittenFilms(Written):
    """Films as an experiment folder, whose clips are folders of frames."""

    def __init__(self, films: Sequence[Film]) -> None:
        super().__init__()
        self.path = os.path.join(self._folder, "film")
        given = films[0].experiment
        if any(film.experiment is not given and film.experiment != given for film in films):
            raise input_error("experiment", "several", "the same of all films")
        if isinstance(given, Mapping):
            os.mkdir(self.path)
            document = {"name": "film", **given, "format": 1}
        else:
            document = self._copied(Path(file_name("experiment", given, "the name of an experiment folder, or a dict")))
        document["clip"] = [self._clip(film, number) for number, film in enumerate(films, 1)]
        Path(self.path, "experiment.toml").write_text(toml_text(document), encoding="utf-8")

    def _copied(self, folder: Path) -> dict[str, Any]:
        """What a folder states; all its files but those of its motions are copied."""
        document = load_scenario(folder / "experiment.toml")
        motions = {os.path.normpath(clip[key]) for clip in document.get("clip", []) for key in ("file", "track")
                   if key in clip}

        def left_out(where: str, names: list[str]) -> list[str]:
            return [name for name in names if os.path.relpath(os.path.join(where, name), folder) in motions]

        shutil.copytree(folder, self.path, ignore=left_out, symlinks=True)
        return document

    def _clip(self, film: Film, number: int) -> dict[str, Any]:
        name = text("name", film.name) or f"clip-{number}"
        frames = Path(self.path, "clips", f"in-memory-{number}")
        frames.mkdir(parents=True)
        count = 0
        for count, frame in enumerate(film.frames, 1):
            image = getattr(frame, "pixels", frame)
            (frames / f"{count - 1:06}.png").write_bytes(png(f"frames[{count - 1}]", image))
        if count == 0:
            raise input_error("frames", "none", "one or more", f'film "{name}"')
        stated = {"name": name, "file": f"clips/{frames.name}",
                  **{key: getattr(film, key) for key in ("mass_kg", "launched", "incline_deg", "mass_sd_kg",
                                                         "incline_sd_deg", "start_s", "end_s", "group")}}
        return {key: value for key, value in stated.items() if value not in (None, "")}


@dataclass(frozen=True)
class Source(_Told):
    """A call's first arguments: tracks, or names of folders and files."""

    tracks: tuple[Track, ...] = ()
    paths: tuple[str, ...] = ()
    written: Optional[Written] = None


def source_of(source: Any, x_m: Optional[ArrayLike], **stated: Any) -> Source:
    """What `analyze` and `diagnose` are given: (t, x), a Track, a Film, a name, or several of them.

    `stated` are fields of the Track that (t, x) makes.
    """
    if x_m is not None:
        return Source(tracks=(Track(source, x_m, **stated),))
    if is_path(source):
        return Source(paths=(file_name("source", source),))
    if isinstance(source, Track):
        return Source(tracks=(source,))
    films = [source] if isinstance(source, Film) else source
    if isinstance(films, Sequence) and len(films) > 0 and all(isinstance(one, Film) for one in films):
        written = WrittenFilms(films)
        return Source(paths=(written.path,), written=written)
    if isinstance(source, Sequence) and len(source) > 0:
        if all(isinstance(one, Track) for one in source):
            return Source(tracks=tuple(source))
        if all(is_path(one) for one in source):
            return Source(paths=tuple(file_name("source", one) for one in source))
    raise input_error("source", kind_of(source) + (" that is empty" if source is None or (
        isinstance(source, Sequence) and not source) else ""),
        "times and positions, a Track, a Film or a list of them, or names of folders or files")


@dataclass(frozen=True)
class Readable(_Told):
    """What a function that reads files reads, and what is stated with it."""

    paths: tuple[str, ...]
    stated: dict[str, Any]
    written: Optional[Written] = None


def readable_source(source: Any, x_m: Optional[ArrayLike], of_files: Mapping[str, object], allow_outside: bool,
                    of_motion: dict[str, Any], gravity: dict[str, Optional[float]]) -> Readable:
    """Names as they are; arrays and Tracks as files that are made of them. (t, x) is a file of one motion, of which the
    same is stated as of a file; Tracks are a folder, which states it itself."""
    given = source_of(source, x_m)
    if given.paths:
        return Readable(given.paths, {**of_motion, **gravity}, given.written)
    refuse_of_arrays(x_m is not None, of_files, allow_outside, of_motion)
    if gravity["gravity_sd_m_s2"] is not None and gravity["gravity_m_s2"] is None:
        raise input_error("gravity_sd_m_s2", shown(gravity["gravity_sd_m_s2"]),
                          "gravity_m_s2, whose uncertainty it is, as well")
    written = WrittenTracks(given.tracks, x_m is not None, gravity)
    return Readable((written.path,), {**of_motion, **gravity} if x_m is not None else {}, written)
