"""The camera's calibration and the marker's fit on their own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _glidelab
from ._checks import Vector, above_0, file_name, frozen, pair, real, refuse_masked, shown, switch, whole
from ._errors import input_error
from ._inputs import PathLike, Progress, is_path, job_count, teller
from ._shown import Brief


def _grey(image: Any, name: str) -> NDArray[Any]:
    refuse_masked(name, image)
    array = np.asarray(image)
    if array.ndim != 2 or array.dtype not in (np.uint8, np.uint16):
        raise input_error(name, f"an array of shape {array.shape} and type {array.dtype}",
                          "a grey image: shape (height, width), uint8 or uint16")
    return np.ascontiguousarray(array)


@dataclass(frozen=True, eq=False, repr=False)
class Camera(Brief):
    """A calibrated camera. Pixels are counted from the centre of the image's first pixel.

    Attributes
    ----------
    lens : {"brown-conrady", "fisheye"}
        As OpenCV writes both.
    focal_px, centre_px : (float, float)
        fx, fy and cx, cy.
    distortion : ndarray
        k1, k2, p1, p2, k3; of a fisheye k1 to k4. Terms that the views do not support are 0.
    sd : ndarray
        Standard deviations of fx, fy, cx, cy, then of `distortion`.
    size_px : (int, int)
        Width and height.
    rms_px : float
        Root mean square distance of a corner from where the camera has it.
    model : str
        Which terms the views support, and why.
    views_used : int
        Of the images.
    notes : tuple of str
        Views without a pattern, outlying ones, ...
    """

    lens: str
    focal_px: tuple[float, float]
    centre_px: tuple[float, float]
    distortion: Vector
    sd: Vector
    size_px: tuple[int, int]
    rms_px: float
    model: str
    views_used: int
    notes: tuple[str, ...]

    @property
    def matrix(self) -> Vector:
        """The camera matrix, shape (3, 3)."""
        (fx, fy), (cx, cy) = self.focal_px, self.centre_px
        return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])


def calibrate(images: Sequence[Any], inner_corners: tuple[int, int], square_m: float, *, jobs: Optional[int] = None,
              progress: Progress = None) -> Camera:
    """A camera from images of a chessboard.

    Parameters
    ----------
    images : sequence of array_like, or of str or path
        Grey images, shape (height, width), uint8 or uint16, all of one size; or files. Three or more must show the
        whole pattern.
    inner_corners : (int, int)
        Columns and rows of the pattern's inner corners.
    square_m : float
        Side of a square in metres.
    jobs, progress
        As in `analyze`.

    Returns
    -------
    Camera
        By least squares over all corners, with the terms of the distortion that the views support.

    Raises
    ------
    InputError
        Images of different sizes, or fewer than three with a visible pattern.

    Notes
    -----
    Zhang 2000; Brown 1966; Kannala and Brandt 2006 for a fisheye, which is taken where it explains the corners
    decisively better. Corners are fitted to a hundredth of a pixel.
    """
    pair("inner_corners", inner_corners, "two whole numbers: columns and rows")
    columns, rows = (whole("inner_corners", one, 1) for one in inner_corners)
    board = (columns, rows)
    square_m = real("square_m", square_m, "metres, above 0")
    if isinstance(images, str) or not isinstance(images, (Sequence, np.ndarray)):
        raise input_error("images", shown(images), "a list of images, or of names of files")
    found: dict[str, Any]
    if len(images) > 0 and all(is_path(image) for image in images):
        files = [file_name(f"images[{i}]", image) for i, image in enumerate(images)]
        found = _glidelab.calibrate_files(files, board, square_m, job_count(jobs), teller(progress))
    else:
        arrays = [_grey(image, f"images[{i}]") for i, image in enumerate(images)]
        found = _glidelab.calibrate_images(arrays, board, square_m, job_count(jobs), teller(progress))
    found["notes"] = tuple(found["notes"])
    for name in ("distortion", "sd"):
        frozen(found[name])
    return Camera(**found)


@dataclass(frozen=True)
class Marker:
    """A marker's image, by a least-squares fit.

    Attributes
    ----------
    u_px, v_px : float
        Its centre, to the right and down from the centre of the first pixel.
    sd_px : float
        Of one coordinate, from the residuals.
    radius_px : float
        Of the circle with its area.
    elongation : float
        Long over short axis.
    amplitude, background : float
        Brightness above its surroundings, and of the surroundings, in codes.
    blur_px : float
        Standard deviation of its edge.
    rms : float
        Root mean square residual, in codes.
    """

    u_px: float
    v_px: float
    sd_px: float
    radius_px: float
    elongation: float
    amplitude: float
    background: float
    blur_px: float
    rms: float


def fit_marker(image: Any, centre_px: tuple[float, float], radius_px: float, *, shaded: bool = False,
               dark: bool = False) -> Optional[Marker]:
    """The centre of a round marker's image, to a hundredth of a pixel.

    Parameters
    ----------
    image : array_like, shape (height, width), uint8 or uint16
        Grey.
    centre_px : (float, float)
        About where it is: right, down; within a radius.
    radius_px : float
        About how large it is; within a factor of two.
    shaded : bool
        Model a surface that is lit from one side.
    dark : bool
        The marker is darker than what surrounds it; amplitude and background are then those of the inverse image.

    Returns
    -------
    Marker or None
        None where the window leaves the image, the fit does not converge, or ends with what is not the marker.

    Raises
    ------
    InputError
        `image` is not an image, or has masked pixels; a number is none.

    Notes
    -----
    An opaque ellipse with a blurred edge in front of a sloping background, fitted to the pixels; a centroid above a
    threshold follows the background's slope, this does not.
    """
    u_px, v_px = pair("centre_px", centre_px, "two numbers: right and down")
    if not (math.isfinite(u_px) and math.isfinite(v_px)):
        raise input_error("centre_px", shown(centre_px), "two finite numbers")
    found = _glidelab.fit_marker(_grey(image, "image"), u_px, v_px,
                                 above_0("radius_px", radius_px, "pixels, above 0"), switch("shaded", shaded),
                                 switch("dark", dark))
    return None if found is None else Marker(*found)
