"""True shares as the contract states them: what each cause takes beside those before it, in either order.

A fit with a cause in the model can give it any size and shape near the true ones, as it can K and mu. To first order that
removes from the positions, beside what the nominal fit takes up, what the derivatives of the motion by the cause's numbers
span. Where two causes act alike the first one takes what both do, so such a share depends on the order; the share in
truth.json's "share", by how much the excess falls if the cause does not act, does not.
"""

import copy

import numpy as np

import everyday_physics as physics

STEPS = {"size": 0.1, "phase": 0.1, "push": 0.1}  # of a number, or of 1 where it is larger
STEP = 0.03


def numbers(effect):
    """(name, index) of what a fit would vary; the index is None for a single number."""
    for name, value in effect.__dict__.items():
        if isinstance(value, np.ndarray) and value.dtype.kind == "f":
            yield from ((name, index) for index in np.ndindex(value.shape))
        elif isinstance(value, dict):
            yield from ((name, key) for key in value)
        elif isinstance(value, float) and name not in ("sign", "interval", "mass"):
            yield name, None


def moved(effect, name, index, by):
    other = copy.deepcopy(effect)
    if index is None:
        setattr(other, name, getattr(other, name) + by)
    else:
        getattr(other, name)[index] += by
    return other


def columns(maker, effect):
    """The derivatives of all positions, in units of the noise, at the motion with this cause alone."""
    clips = maker.clips
    start = np.cumsum([0] + [c.times.size for c in clips])
    whole = [physics.seen(maker.glider, [effect], c) for c in clips]
    if getattr(effect, "fixed_size", False):  # it has no size, only what it does
        return np.concatenate([x - b for x, b in zip(whole, maker.fit.base)])[:, None] / maker.fit.noise
    made = []
    for name, index in numbers(effect):
        value = getattr(effect, name) if index is None else getattr(effect, name)[index]
        step = STEPS.get(name, STEP) * (max(1.0, abs(value)) if name in ("phase", "push") else max(abs(value), 1e-3))
        shape = np.shape(getattr(effect, name))
        own = shape and index is not None and shape[-1] == len(clips)  # a number of one clip
        column = np.zeros(start[-1])
        for i, clip in enumerate(clips):
            if own and index[-1] != clip.number:
                continue
            ends = [physics.seen(maker.glider, [moved(effect, name, index, by)], clip) for by in (step, -step)]
            column[start[i]:start[i + 1]] = (ends[0] - ends[1]) / (2 * step * maker.fit.noise)
        made.append(column)
    return np.stack(made, axis=1)


def excess_with(fit, positions, extra):
    """NominalFit.excess with further columns in the model."""
    basis = fit.basis
    rows = np.vstack([extra, np.zeros((basis.shape[0] - extra.shape[0], extra.shape[1]))])
    rows = rows - basis @ (basis.T @ rows)
    rows = rows / (np.linalg.norm(rows, axis=0) + 1e-300)
    u, s, _ = np.linalg.svd(rows, full_matrices=False)
    u = u[:, s > 1e-4 * s[0]]
    r = np.concatenate([(x - b) / fit.noise for x, b in zip(positions, fit.base)])
    r = np.concatenate([r, np.zeros(basis.shape[0] - r.size)])
    r -= basis @ (basis.T @ r)
    r -= u @ (u.T @ r)
    return float(np.mean(r[:fit.positions] ** 2))


def in_order(maker, causes, positions, whole):
    """The share of each cause where it comes first, and the part that all of them leave."""
    by_cause = [columns(maker, c) for c in causes]
    first = [1.0 - excess_with(maker.fit, positions, c) / whole for c in by_cause]
    return first, excess_with(maker.fit, positions, np.hstack(by_cause)) / whole if by_cause else 1.0
