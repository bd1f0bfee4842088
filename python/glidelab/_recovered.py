"""Quantities with effects in the model: those that a diagnosis names, or that `analyze` was told of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

from . import _glidelab
from ._results import Quantity, quantity_of
from ._shown import Brief

QUANTITIES = dict(_glidelab.quantities())  # keys and their units


@dataclass(frozen=True)
class Recovered:
    """What one configuration's motion shows, with causes in the model.

    Attributes
    ----------
    group : str
        Clips that share one set-up of the track.
    mass_kg, incline_deg : float
        As stated.
    with_causes : tuple of str
        Ids of the effects in the model.
    k_over_m_1_s, mu, alpha_deg, v_lim_m_s : Quantity
        With them.
    """

    group: str
    mass_kg: float
    incline_deg: float
    with_causes: tuple[str, ...]
    k_over_m_1_s: Quantity
    mu: Quantity
    alpha_deg: Quantity
    v_lim_m_s: Quantity


def recovered_of(found: Mapping[str, Any]) -> Recovered:
    """An entry of "recovered" in a result's JSON."""
    quantities = {key: quantity_of(found, key, unit) for key, unit in QUANTITIES.items()}
    return Recovered(found["group"], found["mass_kg"], found["incline_deg"], tuple(found["with"]), **quantities)


@dataclass(frozen=True, eq=False, repr=False)
class WithEffects(Brief):
    """The quantities with effects in the model that the user named.

    Attributes
    ----------
    effects : dict of str to dict
        Each effect's parameters, ``{"value": ..., "sd": ...}`` by name with the unit in it.
    gap_before, gap_after : float or None
        Root mean square of standardised residuals of held-out clips without and with the effects; 1 is the noise floor.
    recovered : tuple of Recovered
        The quantities, a configuration each.
    notes : tuple of str
        What a reader should know.
    """

    effects: Mapping[str, Mapping[str, Any]]
    gap_before: Optional[float]
    gap_after: Optional[float]
    recovered: tuple[Recovered, ...]
    notes: tuple[str, ...]


def with_effects_of(found: Optional[Mapping[str, Any]]) -> Optional[WithEffects]:
    """The object "with" of results.json; None where no effect was named."""
    if found is None:
        return None
    gap = found.get("gap") or {}
    return WithEffects({one["id"]: one["parameters"] for one in found["effects"]}, gap.get("before"), gap.get("after"),
                       tuple(recovered_of(one) for one in found["recovered"]), tuple(found["notes"]))
