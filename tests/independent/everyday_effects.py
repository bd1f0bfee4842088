"""What can act beside the nominal model: effects of the list, causes that are on no list, and small imperfections.

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


# ---- on no list

class RailJoint(Effect):
    id, largest = "a joint of the rail", 40.0  # 1/s at the joint
    max_step = 0.01

    def force(self, clip, t, x, v):
        return -clip.mass * self.size * v * np.exp(-0.5 * ((x - self.place) / 0.006) ** 2)

    @staticmethod
    def draw(rng, d, glider):
        return RailJoint(2.0, place=d["low"] + rng.uniform(0.3, 0.7) * d["span"])


class Well(Effect):
    """A hill or a hollow that returns what it takes."""

    max_step = 0.02

    def force(self, clip, t, x, v):
        u = (x - self.place) / self.width
        return clip.mass * self.sign * self.size * u * np.exp(-0.5 * u * u)

    @classmethod
    def draw(cls, rng, d, glider):
        return cls(0.1, sign=cls.way, place=d["low"] + rng.uniform(0.25, 0.75) * d["span"], width=rng.uniform(*cls.widths))


class Bump(Well):
    id, largest, way, widths = "a bump of the track", 3.0, 1.0, (0.02, 0.05)


class Magnet(Well):
    id, largest, way, widths = "a magnet at one place", 3.0, -1.0, (0.05, 0.1)


class AgeingFriction(Effect):
    id, largest = "friction that ages within a clip", 1.5

    def friction(self, clip, t, x, v, s):
        return 1.0 + self.size * t

    @staticmethod
    def draw(rng, d, glider):
        return AgeingFriction(0.3)


class StickySpot(Effect):
    id, largest = "a sticky spot", 30.0
    max_step = 0.02

    def friction(self, clip, t, x, v, s):
        return 1.0 + self.size * np.exp(-0.5 * ((x - self.place) / 0.025) ** 2)

    @staticmethod
    def draw(rng, d, glider):
        return StickySpot(2.0, place=d["low"] + rng.uniform(0.3, 0.7) * d["span"])


class Ringing(Effect):
    id, largest = "a load that rings after the launch", 2.0

    def force(self, clip, t, x, v):
        return clip.mass * self.size * np.exp(-t / self.decay) * np.cos(self.omega * t)

    @staticmethod
    def draw(rng, d, glider):
        return Ringing(0.3, omega=2 * np.pi * rng.uniform(1.5, 4.0), decay=rng.uniform(0.2, 0.6))


class SinkingTrack(Effect):
    id, largest = "a force that grows with time", 0.6

    def force(self, clip, t, x, v):
        return clip.mass * self.sign * self.size * t

    @staticmethod
    def draw(rng, d, glider):
        return SinkingTrack(0.05, sign=signs(rng))


class TrackerJump(Effect):
    id, largest = "a tracker that jumps at one place", 0.03

    def seen(self, clip, t, x, v):
        return x + self.size * (x > self.place)

    @staticmethod
    def draw(rng, d, glider):
        return TrackerJump(0.004, place=d["low"] + rng.uniform(0.3, 0.7) * d["span"])


OFF_LIST = [RailJoint, Bump, Magnet, AgeingFriction, StickySpot, Ringing, SinkingTrack, TrackerJump]


# ---- small imperfections

class Scatter(Effect):
    id, largest = "friction scatters from clip to clip", 0.4

    def friction(self, clip, t, x, v, s):
        return max(0.0, 1.0 + self.size * self.z[clip.number])

    draw = staticmethod(lambda rng, d, glider: Scatter(0.1, z=rng.normal(size=d["clips"])))


class WavyTrack(Effect):
    id, largest = "the track is wavy", 0.01
    max_step = 0.04

    def force(self, clip, t, x, v):
        return clip.mass * G * self.size * float(self.a @ np.sin(self.k * x + self.phase))

    draw = staticmethod(lambda rng, d, glider: WavyTrack(5e-4, a=rng.normal(size=4), phase=rng.uniform(0, 6.3, 4),
                                                         k=2 * np.pi / rng.uniform(0.12, 0.6, 4)))


class LaggingTracker(Effect):
    id, largest = "the tracker lags", 3.0  # frames

    def seen(self, clip, t, x, v):
        keep = self.size / (1.0 + self.size)
        y = np.array(x)
        y[0] -= v[0] * (t[1] - t[0]) * self.size  # as if it had followed before
        for i in range(1, y.size):
            y[i] = keep * y[i - 1] + (1.0 - keep) * x[i]
        return y

    draw = staticmethod(lambda rng, d, glider: LaggingTracker(0.5))


class Draught(Effect):
    id, largest = "a draught", 0.2

    def force(self, clip, t, x, v):
        return self.mass * self.size * float(self.a[clip.number] @ np.sin(self.omega * t + self.phase[clip.number]))

    @staticmethod
    def draw(rng, d, glider):
        omega = 2 * np.pi * rng.uniform(0.1, 2.0, 5)
        a = rng.normal(size=(d["clips"], 5)) / (1.0 + omega)
        return Draught(0.02, omega=omega, a=a, phase=rng.uniform(0, 6.3, (d["clips"], 5)), mass=d["mass"])


class WrongMass(Effect):
    id, largest = "masses are off", 0.06

    def drag(self, clip, x, v, s):  # the weight cancels, so that K over the mass is all that differs
        return 1.0 / (1.0 + self.size * self.z[clip.mass])

    @staticmethod
    def draw(rng, d, glider):
        return when(d["masses"] > 1 and not d["driven"], WrongMass(0.01, z={m: rng.normal() for m in d["all_masses"]}))


class HandAtStart(Effect):
    id, largest = "a start is not free", 2.0
    max_step = 0.04

    def force(self, clip, t, x, v):
        return clip.mass * self.size * self.push[clip.number] if t < self.until else 0.0

    @staticmethod
    def draw(rng, d, glider):
        push = np.where(rng.random(d["clips"]) < 0.3, rng.normal(size=d["clips"]), 0.0)
        push[rng.integers(d["clips"])] = 1.0
        return HandAtStart(0.2, until=rng.uniform(0.08, 0.25), push=push)


class BadClip(Effect):
    id, largest = "one bad clip", 0.2

    def force(self, clip, t, x, v):
        return clip.mass * self.size * np.exp(-0.5 * ((t - self.at) / self.width) ** 2) if clip.number == self.bad else 0.0

    @staticmethod
    def draw(rng, d, glider):
        return BadClip(0.05, bad=rng.integers(d["clips"]), at=rng.uniform(0.2, 0.8) * d["duration"],
                       width=rng.uniform(0.1, 0.5))


class TiltScatter(Effect):
    id, largest = "the track is set anew before each clip", 0.01

    def force(self, clip, t, x, v):
        return clip.mass * G * self.size * self.z[clip.number]

    draw = staticmethod(lambda rng, d, glider: TiltScatter(5e-4, z=rng.normal(size=d["clips"])))


class MovedCamera(Effect):
    id, largest = "the scale differs from clip to clip", 0.02

    def seen(self, clip, t, x, v):
        return x * (1.0 + self.size * self.z[clip.number])

    draw = staticmethod(lambda rng, d, glider: MovedCamera(0.002, z=rng.normal(size=d["clips"])))


IMPERFECTIONS = [Scatter, WavyTrack, LaggingTracker, Draught, WrongMass, HandAtStart, BadClip, TiltScatter, MovedCamera]
