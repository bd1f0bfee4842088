"""The effects of the list that tracks can show.

Each class has the law of one effect, as the contract of the effects states it, and `draw`, which makes it for the clips of
one experiment with a size that is set later. `draw` gives None where the experiment could not show the effect.
"""

import numpy as np

from everyday_physics import G, Effect


def design(clips):
    """What the clips have in common: the range of x, speeds, masses."""
    xs = np.concatenate([c.path for c in clips])
    speeds = np.concatenate([np.gradient(c.path, c.times) for c in clips])
    return {"low": xs.min(), "high": xs.max(), "middle": 0.5 * (xs.min() + xs.max()), "span": np.ptp(xs),
            "speed": np.quantile(np.abs(speeds), 0.9), "masses": len({c.mass for c in clips}),
            "all_masses": sorted({c.mass for c in clips}), "mass": np.mean([c.mass for c in clips]),
            "driven": clips[0].force is not None,
            "both": min(np.mean(speeds > 0.05), np.mean(speeds < -0.05)) > 0.15,
            "configurations": len({c.configuration for c in clips}), "clips": len(clips),
            "interval": clips[0].times[1], "duration": max(c.times[-1] for c in clips)}


def signs(rng):
    return rng.choice([-1.0, 1.0])


def when(condition, made):
    return made if condition else None


# ---- the list: forces

class QuadraticDrag(Effect):
    id, largest = "quadratic_drag", 1.0

    def force(self, clip, t, x, v):
        return -self.size * v * abs(v)

    @staticmethod
    def draw(rng, d, glider):
        return QuadraticDrag(0.1 * d["mass"])


class EddyRolloff(Effect):
    id, largest = "eddy_rolloff", 5.0  # the inverse of v_c

    def drag(self, clip, x, v, s):
        return 1.0 / (1.0 + (v * self.size) ** 2)

    @staticmethod
    def draw(rng, d, glider):
        return when(glider.drag / d["mass"] > 0.5, EddyRolloff(1.0 / d["speed"]))


class PowerLawDrag(Effect):
    id, largest = "power_law_drag", 1.2

    def drag(self, clip, x, v, s):
        return max(abs(v), 1e-9) ** (self.sign * min(self.size, 0.7 if self.sign < 0 else 1.2))

    @staticmethod
    def draw(rng, d, glider):
        return when(glider.drag / d["mass"] > 0.3, PowerLawDrag(0.3, sign=rng.choice([-1.0, 1.0], p=[0.3, 0.7])))


class Stribeck(Effect):
    id, largest = "stribeck", 4.0

    def friction(self, clip, t, x, v, s):
        return 1.0 + self.size * np.exp(-(v / self.v_s) ** 2)

    @staticmethod
    def draw(rng, d, glider):
        return Stribeck(1.0, v_s=d["speed"] * rng.uniform(0.15, 0.4))


class LoadIndependentFriction(Effect):
    id, largest = "load_independent_friction", 0.5

    def constant_friction(self):
        return self.size

    @staticmethod
    def draw(rng, d, glider):
        return when(d["masses"] > 1, LoadIndependentFriction(glider.mu * d["mass"] * G))


class DirectionAsymmetry(Effect):
    id, largest = "direction_asymmetry", 0.7

    def friction(self, clip, t, x, v, s):
        return 1.0 + self.sign * self.size * s

    @staticmethod
    def draw(rng, d, glider):
        return when(d["both"], DirectionAsymmetry(0.3, sign=signs(rng)))


class DirectionDependentDrag(Effect):
    id, largest = "direction_dependent_drag", 0.7

    def drag(self, clip, x, v, s):
        return 1.0 + self.sign * self.size * s

    @staticmethod
    def draw(rng, d, glider):
        return when(d["both"] and glider.drag / d["mass"] > 0.15, DirectionDependentDrag(0.3, sign=signs(rng)))


class PlaceFriction(Effect):
    id, largest = "place_friction", 0.9

    def friction(self, clip, t, x, v, s):
        return max(0.0, 1.0 + self.size * float(self.a @ np.sin(self.k * (x - self.low) + self.phase)))

    @staticmethod
    def draw(rng, d, glider):
        a = rng.normal(size=3)
        return PlaceFriction(0.3, a=a / np.linalg.norm(a) * np.sqrt(2.0), k=2 * np.pi * rng.uniform(0.6, 3.0, 3) / d["span"],
                             phase=rng.uniform(0, 2 * np.pi, 3), low=d["low"])


class FrictionDrift(Effect):
    id, largest = "friction_drift", 0.25  # a clip

    def friction(self, clip, t, x, v, s):
        return max(0.1, 1.0 + self.sign * self.size * (clip.number - (self.clips - 1) / 2))

    @staticmethod
    def draw(rng, d, glider):
        return when(d["clips"] > 4, FrictionDrift(0.08, sign=signs(rng), clips=d["clips"]))


class PerConfiguration(Effect):
    def factor(self, clip):
        return max(0.1, 1.0 + self.size * self.z[clip.configuration])

    @classmethod
    def draw(cls, rng, d, glider):
        z = rng.normal(size=d["configurations"])
        if len(z) < 3:
            return None
        z -= z.mean()
        return cls(0.2, z=z / z.std(ddof=1))


class ConfigurationFriction(PerConfiguration):
    id, largest = "configuration_friction", 0.5

    def friction(self, clip, t, x, v, s):
        return self.factor(clip)


class ConfigurationDrag(PerConfiguration):
    id, largest = "configuration_drag", 0.5

    def drag(self, clip, x, v, s):
        return self.factor(clip)


class ClipScatter(Effect):
    id, largest = "clip_scatter", 0.5

    def friction(self, clip, t, x, v, s):
        return max(0.0, 1.0 + self.size * self.z[0][clip.number])

    def drag(self, clip, x, v, s):
        return max(0.1, 1.0 + self.size * self.z[1][clip.number])

    @staticmethod
    def draw(rng, d, glider):
        return when(d["clips"] > d["configurations"] + 1, ClipScatter(0.2, z=rng.normal(size=(2, d["clips"]))))


class TrackBow(Effect):
    id, largest = "track_bow", 0.06

    def force(self, clip, t, x, v):
        return clip.mass * G * self.sign * self.size * (x - self.middle)

    @staticmethod
    def draw(rng, d, glider):
        return TrackBow(0.01, sign=signs(rng), middle=d["middle"])


class DampingGradient(Effect):
    id, largest = "damping_gradient", 1.0

    def drag(self, clip, x, v, s):
        return max(0.05, 1.0 + self.sign * self.size * (x - self.middle))

    @staticmethod
    def draw(rng, d, glider):
        return when(glider.drag / d["mass"] > 0.3, DampingGradient(0.3, sign=signs(rng), middle=d["middle"]))


class RotationalInertia(Effect):
    id, largest = "rotational_inertia", 0.2  # kg

    def added_mass(self):
        return self.size

    @staticmethod
    def draw(rng, d, glider):
        return when(d["masses"] > 1, RotationalInertia(0.1 * d["mass"]))


class Tether(Effect):
    id, largest = "tether", 4.0
    max_step = 0.04

    def force(self, clip, t, x, v):
        return -self.size * max(0.0, x - self.x_t)

    @staticmethod
    def draw(rng, d, glider):
        return Tether(0.5, x_t=d["low"] + rng.uniform(0.35, 0.75) * d["span"])


class EndStop(Effect):
    id, largest = "end_stop", 15.0
    max_step = 0.04

    def force(self, clip, t, x, v):
        return self.size * (max(0.0, self.x_low - x) - max(0.0, x - self.x_high))

    @staticmethod
    def draw(rng, d, glider):
        room = rng.uniform(0.06, 0.2) * d["span"]
        return EndStop(3.0, x_low=d["low"] + room, x_high=d["high"] - room)


class BaseVibration(Effect):
    id, largest = "base_vibration", 1.5

    def force(self, clip, t, x, v):
        return clip.mass * self.size * np.sin(self.omega * t + self.phase[clip.number])

    @staticmethod
    def draw(rng, d, glider):
        f = rng.uniform(max(1.0, 2.5 / d["duration"]), min(7.0, 0.2 / d["interval"]))
        return BaseVibration(0.1, omega=2 * np.pi * f, phase=rng.uniform(0, 2 * np.pi, d["clips"]))


class LateRelease(Effect):
    id, largest = "late_release", 3.0
    max_step = 0.04

    def force(self, clip, t, x, v):
        return clip.mass * self.size * self.push[clip.number] if t < self.t_r else 0.0

    @staticmethod
    def draw(rng, d, glider):
        return LateRelease(0.3, t_r=max(5 * d["interval"], rng.uniform(0.1, 0.3)), push=rng.normal(size=d["clips"]))


class ForceGain(Effect):
    id, largest = "force_gain", 0.4

    def true_force_time(self, t):
        return t, 1.0 + self.sign * self.size

    @staticmethod
    def draw(rng, d, glider):
        return ForceGain(0.05, sign=signs(rng))


class ForceDelay(Effect):
    id, largest = "force_delay", 0.2

    def true_force_time(self, t):
        return t + self.size, 1.0  # the record shows later what acts now

    @staticmethod
    def draw(rng, d, glider):
        return ForceDelay(0.02)


class MassError(Effect):
    id, largest = "mass_error", 0.4

    def added_mass(self):
        return self.sign * self.size * self.mass

    @staticmethod
    def draw(rng, d, glider):
        return MassError(0.05, sign=signs(rng), mass=d["mass"])


# ---- the list: what the record does

class FrameRateError(Effect):
    id, largest = "frame_rate_error", 0.1

    def frame_times(self, clip, t):
        return t * (1.0 + self.sign * self.size)

    @staticmethod
    def draw(rng, d, glider):
        return FrameRateError(0.02, sign=signs(rng))


class ScaleError(Effect):
    id, largest = "scale_error", 0.1

    def seen(self, clip, t, x, v):
        return (1.0 + self.sign * self.size) * x

    @staticmethod
    def draw(rng, d, glider):
        return ScaleError(0.02, sign=signs(rng))


class PerspectiveError(Effect):
    id, largest = "perspective_error", 0.15

    def seen(self, clip, t, x, v):
        return x / (1.0 + self.sign * self.size * x)

    @staticmethod
    def draw(rng, d, glider):
        return PerspectiveError(0.02, sign=signs(rng))


class LensDistortion(Effect):
    id, largest = "lens_distortion", 0.15

    def seen(self, clip, t, x, v):
        return x * (1.0 + self.sign * self.size * (x - self.axis) ** 2)

    @staticmethod
    def draw(rng, d, glider):
        return LensDistortion(0.02, sign=signs(rng), axis=d["middle"] + rng.uniform(-0.15, 0.15) * d["span"])


class CameraMotion(Effect):
    id, largest = "camera_motion", 0.02

    def seen(self, clip, t, x, v):
        return x + self.size * np.sin(self.omega * t + self.phase[clip.number])

    draw = staticmethod(lambda rng, d, glider: CameraMotion(0.003, **{
        k: v for k, v in BaseVibration.draw(rng, d, glider).__dict__.items() if k != "size"}))


class DroppedFrames(Effect):
    id, largest = "dropped_frames", 1.0
    fixed_size = True

    def frame_times(self, clip, t):
        return t + np.cumsum(self.lost[clip.number][:t.size]) * self.interval

    @staticmethod
    def draw(rng, d, glider):
        n = int(d["duration"] / d["interval"]) + 2
        lost = rng.random((d["clips"], n)) < rng.uniform(0.01, 0.03)
        lost[:, :2] = False
        return DroppedFrames(1.0, lost=lost, interval=d["interval"])


LIST = [QuadraticDrag, EddyRolloff, PowerLawDrag, Stribeck, LoadIndependentFriction, DirectionAsymmetry,
        DirectionDependentDrag, PlaceFriction, FrictionDrift, ConfigurationFriction, ConfigurationDrag, ClipScatter,
        TrackBow, DampingGradient, RotationalInertia, Tether, EndStop, BaseVibration, LateRelease, FrameRateError,
        ScaleError, PerspectiveError, LensDistortion, CameraMotion, DroppedFrames]
DRIVEN = [ForceGain, ForceDelay, MassError]
NEEDS_ANGLE = {"direction_asymmetry", "frame_rate_error", "scale_error"}  # shown only by a well-known inclination
