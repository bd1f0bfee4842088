"""What a prompt shows of results with arrays and parts: one line, alike for all."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any, Optional

import numpy as np

_LONGEST = 60  # characters of a text


def _shown(name: str, value: Any) -> Optional[str]:
    """"mass_kg=0.335", "len(clips)=6"; None for what has no value, is empty, or is too long."""
    if is_dataclass(value) and "__str__" in vars(type(value)):  # a Quantity
        return f"{name}={value}"
    if isinstance(value, (tuple, list, Mapping)):
        return f"len({name})={len(value)}" if value else None
    if isinstance(value, np.ndarray):
        return f"{name} of shape {value.shape}" if value.ndim != 1 else None
    if isinstance(value, float):
        return f"{name}={value:.6g}" if math.isfinite(value) else None
    if isinstance(value, str):
        return f"{name}={value!r}" if 0 < len(value) <= _LONGEST and "\n" not in value else None
    if isinstance(value, (bool, int, np.generic)):
        return f"{name}={value}"
    return None


class Brief:
    """A dataclass that a prompt shows on one line: its single values, and of the rest how much there is.

    ``<glidelab.Clip: name='m1-up', frames=320, len(segments)=2>``; all arrays of one dimension have one length, which is shown
    once.
    """

    def __repr__(self) -> str:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        shown = [one for one in (_shown(name, value) for name, value in values.items()) if one is not None]
        lengths = [len(value) for value in values.values() if isinstance(value, np.ndarray) and value.ndim == 1]
        if any(lengths):
            shown.insert(0, f"{max(lengths)} values")
        return f"<glidelab.{type(self).__name__}{': ' if shown else ''}{', '.join(shown)}>"
