"""What an experiment has besides the effects of the list: causes that are on no list, and small imperfections."""

import numpy as np

from everyday_effects import signs, when
from everyday_physics import G, Effect


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
