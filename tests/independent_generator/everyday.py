#!/usr/bin/python3
"""Experiments as students record them, with a known cause: made independently of the program that is to find it.

usage: everyday.py make --cases N --seed S --out DIR            # DIR/case-000 … and DIR/case-000.truth/truth.json
       everyday.py score DIR… --program GLIDELAB [--results NAME] # diagnoses what has no result yet, and prints the table

4 to 12 clips at 25 to 240 frames/s with noise of 0.05 to 1.5 mm; one cause of the list (50 %), two (20 %), none (15 %) or one
on no list (15 %), with three to five small imperfections. The excess is the mean square, in units of the noise, of what a fit
of the nominal model leaves of the positions without noise; a share is the part by which it falls without a cause, and a share
in order the part that a cause takes beside those before it.
"""

import argparse
import json
import multiprocessing
import os
import sys

try:
    import numpy as np
    import scipy  # noqa: F401
except ImportError:
    print("skipped: no numpy or scipy (python3-numpy, python3-scipy)")
    sys.exit(77)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import everyday_effects as effects  # noqa: E402
import everyday_physics as physics  # noqa: E402
import everyday_score  # noqa: E402
import everyday_shares  # noqa: E402
import everyday_unlisted as unlisted  # noqa: E402

CLASSES = (("one", 0.5), ("two", 0.2), ("none", 0.15), ("off", 0.15))


class Impossible(Exception):
    """These draws make no experiment; draw anew."""


def reference_motion(glider, clip, duration, step):
    times = np.arange(0.0, duration, step)
    x = physics.nominal(glider, clip, times)
    return times, x, np.gradient(x, times)


def draw_clips(rng, driven, well_known_angle):
    """A glider and its clips, with the frames during which it moves on the track."""
    kind = rng.choice(["air track", "cart", "friction block"], p=[0.45, 0.45, 0.1])
    base_mass = rng.uniform(0.1, 0.6) if kind == "air track" else rng.uniform(0.25, 1.2)
    rate = {"air track": rng.uniform(0.3, 2.5), "cart": rng.uniform(0.05, 0.8), "friction block": rng.uniform(0.05, 0.5)}[kind]
    mu = {"air track": rng.uniform(0.002, 0.015), "cart": rng.uniform(0.005, 0.04), "friction block": rng.uniform(0.1, 0.2)}[kind]
    glider = physics.Glider(drag=rate * base_mass, mu=mu)
    masses = [round(base_mass * f, 3) for f in (1.0, rng.uniform(1.3, 1.8), rng.uniform(2.0, 3.0))][:rng.choice([1, 2, 3], p=[.4, .35, .25])]
    angles = [0.0] if driven else list(rng.choice([0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 8.0], rng.choice([1, 2], p=[.6, .4]), replace=False))
    if kind == "friction block" and not driven:
        angles = [float(rng.choice([0.0, 12.0, 15.0]))]
    sd = np.radians(0.03 if well_known_angle else rng.choice([0.1, 0.2, 0.3, 0.5]))
    true_angles = {a: np.radians(a) + sd * rng.normal() for a in angles}
    step = 1.0 / rng.choice([25.0, 30.0, 50.0, 60.0, 100.0, 120.0, 240.0])
    length = rng.uniform(1.0, 2.2)
    settings = [(m, a) for a in angles for m in masses]
    count = rng.integers(4, 13)
    clips = []
    for n in range(count):
        m, a = settings[n % len(settings)] if n < 2 * len(settings) else settings[rng.integers(len(settings))]
        ways = ["down", "up"] if a == 0.0 else ["released", "up", "up", "down"]
        way = ways[(n // len(settings)) % len(ways)] if rng.random() < 0.7 else ways[rng.integers(len(ways))]
        alpha = true_angles[a]
        # An upward launch turns within the track; what is released slides as far as the track goes.
        pull = physics.G * (np.sin(abs(alpha)) + mu) + rate * 0.4
        speed = rng.uniform(0.4, 0.9) * min(1.8, np.sqrt(2 * pull * length * 0.8)) if way == "up" else rng.uniform(0.3, 1.2)
        speed = max(speed, 0.25)
        start = {"up": length * rng.uniform(0.85, 0.95), "down": rng.uniform(0.05, 0.1), "released": rng.uniform(0.05, 0.2)}[way]
        if driven:
            way, speed, start = "released", 0.0, length / 2
        if way == "released" and not driven and np.tan(alpha) <= 1.3 * mu:
            way, speed = "down", rng.uniform(0.4, 1.2)
        force = None
        if driven:
            amplitude, w = m * rng.uniform(0.6, 1.5), 2 * np.pi * rng.uniform(0.3, 1.0, 2)
            phase, weights = rng.uniform(0, 6.3, 2), rng.uniform(0.5, 1.0, 2)
            force = Wave(amplitude * weights, w, phase)
        clip = physics.Clip(n, settings.index((m, a)), m, alpha, start, {"up": -speed, "down": speed, "released": 0.0}[way],
                            None, way, m, a, f"{a:g} degrees", force)
        times, x, v = reference_motion(glider, clip, rng.uniform(1.0, 3.5), step)
        inside = np.ones(x.size, bool) if driven else (x >= 0.02) & (x <= length)
        moving = (np.abs(v) > 1e-6) | (times < 0.2) if not driven else inside
        end = int(np.argmin(inside & moving)) if not np.all(inside & moving) else x.size
        if end < max(14, 0.4 / step):
            continue
        clip.times, clip.path = times[:end], x[:end]
        clips.append(clip)
    for n, clip in enumerate(clips):
        clip.number = n
    if len(clips) < 4 or sum(c.times.size for c in clips) < 150 or min(np.ptp(c.path) for c in clips) < 0.1:
        raise Impossible
    return glider, clips, sd


class Wave:
    """A recorded force, a sum of two sines in N."""

    def __init__(self, amplitude, omega, phase):
        self.amplitude, self.omega, self.phase = amplitude, omega, phase

    def __call__(self, t):
        return float(self.amplitude @ np.sin(self.omega * t + self.phase))


class Maker:
    """Sets sizes by the excess that they make."""

    def __init__(self, glider, clips, noise, angle_sd):
        self.glider, self.clips = glider, clips
        self.fit = physics.NominalFit(glider, clips, noise, angle_sd)

    def positions(self, acting):
        try:
            return [physics.seen(self.glider, acting, c) for c in self.clips]
        except (ArithmeticError, ValueError) as e:
            raise Impossible from e

    def excess(self, acting):
        return self.fit.excess(self.positions(acting))

    def set_size(self, effect, target, within=0.15):
        """The size at which the effect alone makes this excess, to 15 %; Impossible beyond what is plausible."""
        if getattr(effect, "fixed_size", False):
            if not 0.3 * target < self.excess([effect]) < 3.0 * target:
                raise Impossible
            return
        for _ in range(8):
            e = self.excess([effect])
            if not np.isfinite(e) or e <= 0:
                raise Impossible
            if abs(e / target - 1.0) < within:
                return
            effect.size *= float(np.clip(np.sqrt(target / e), 0.1, 10.0))
            if effect.size > effect.largest:
                raise Impossible
        raise Impossible


def draw_causes(rng, kind, driven, d, glider):
    if kind == "none":
        return []
    if kind == "off":
        kinds = [unlisted.OFF_LIST[rng.integers(len(unlisted.OFF_LIST))]]
    elif driven:
        kinds = [effects.DRIVEN[rng.integers(len(effects.DRIVEN))]]
        if kind == "two":
            kinds.append(effects.LIST[rng.integers(len(effects.LIST))])
    else:
        kinds = list(rng.choice(effects.LIST, 2 if kind == "two" else 1, replace=False))
    made = [k.draw(rng, d, glider) for k in kinds]
    alike = [{"scale_error", "frame_rate_error"}, {"camera_motion", "base_vibration"}]
    if any(m is None for m in made) or any(s <= {k.id for k in kinds} for s in alike):
        raise Impossible
    return made


def draw_case(rng, kind):
    driven = kind in ("one", "two") and rng.random() < 0.08
    known = rng.random() < 0.2
    glider, clips, angle_sd = draw_clips(rng, driven, known)
    noise = 10.0 ** rng.uniform(np.log10(5e-5), np.log10(1.5e-3))
    d = effects.design(clips)
    causes = draw_causes(rng, kind, driven, d, glider)
    if any(c.id in effects.NEEDS_ANGLE for c in causes) and not known:
        raise Impossible
    maker = Maker(glider, clips, noise, angle_sd)
    target = rng.uniform(0.2, 2.0) if kind == "none" else 10.0 ** rng.uniform(np.log10(1.5), np.log10(40.0))
    if len(causes) == 2:
        part = rng.uniform(0.35, 0.65)
        maker.set_size(causes[0], target * part)
        maker.set_size(causes[1], target * (1.0 - part))
    elif causes:
        maker.set_size(causes[0], target)
    small = []
    pieces = [k for k in rng.permutation(unlisted.IMPERFECTIONS)][:rng.integers(3, 6)]
    weights = rng.dirichlet(np.full(len(pieces), 4.0))
    fraction = 1.0 if kind == "none" else rng.uniform(0.02, 0.30)
    for k, weight in zip(pieces, weights):
        piece = k.draw(rng, d, glider)
        if piece is None:
            continue
        try:
            maker.set_size(piece, target * fraction * weight, within=0.3)
        except Impossible:
            continue
        small.append(piece)
    if len(small) < 2:
        raise Impossible
    positions = maker.positions(causes + small)
    whole = maker.fit.excess(positions)
    dirt = maker.excess(small)
    shares = [1.0 - maker.excess([c for c in causes if c is not cause] + small) / whole for cause in causes]
    if causes and not 0.015 <= dirt / whole <= 0.33 or len(causes) == 2 and min(shares) < 0.25:
        raise Impossible
    in_order = everyday_shares.in_order(maker, causes, positions, whole)
    return glider, clips, angle_sd, noise, causes, small, positions, whole, dirt, shares, in_order


def recorded(rng, noise, positions):
    """Positions with noise; a third of the experiments is clicked or written to a step."""
    step = 0.0
    if rng.random() < 0.33:
        step = float(rng.choice([1e-4, 2e-4, 5e-4, 1e-3, 2e-3]))
        if step > 2.5 * noise:
            step = 0.0
    out = []
    for x in positions:
        sd = np.sqrt(max(noise ** 2 - step ** 2 / 12.0, 0.0))
        y = x + sd * rng.normal(size=x.size)
        out.append(np.round(y / step) * step if step else y)
    return step, out


def write_case(folder, rng, case, kind):
    glider, clips, angle_sd, noise, causes, small, positions, whole, dirt, shares, (first, left) = case
    step, noisy = recorded(rng, noise, positions)
    os.makedirs(os.path.join(folder, "tracks"))
    lines = ["format = 1", f'name = "{os.path.basename(folder)}"', ""]
    for clip, x in zip(clips, noisy):
        name = f"c{clip.number + 1:02d}"
        lines += ["[[clip]]", f'name = "{name}"', f'track = "tracks/{name}.csv"', f"mass_kg = {clip.stated_mass}",
                  f"incline_deg = {clip.stated_incline_deg}", f"incline_sd_deg = {np.degrees(angle_sd):.3g}",
                  f'launched = "{clip.launched}"', f'group = "{clip.group}"', ""]
        with open(os.path.join(folder, "tracks", name + ".csv"), "w") as f:
            f.write("t_s,x_m" + (",force_n" if clip.force else "") + "\n")
            for t, position in zip(clip.times, x):
                f.write(f"{t:.6f},{position:.7f}" + (f",{clip.force(t):.6f}" if clip.force else "") + "\n")
    with open(os.path.join(folder, "experiment.toml"), "w") as f:
        f.write("\n".join(lines))

    def told(effect, **more):
        numbers = {k: v for k, v in effect.__dict__.items() if isinstance(v, (int, float))}
        return {"id": effect.id, **numbers, **more}

    truth = {"class": kind, "causes": [told(c, share=s, share_first=f) for c, s, f in zip(causes, shares, first)], "left": left, "imperfections": [told(p) for p in small],
             "excess": whole, "dirt_excess": dirt, "noise_m": noise, "rounding_m": step, "drag_kg_s": glider.drag, "mu": glider.mu,
             "configurations": [{"group": g, "mass_kg": m, "k_over_m_1_s": glider.drag / m, "mu": glider.mu, "alpha_deg": np.degrees(a)}
                                for g, m, a in sorted({(c.group, c.mass, c.alpha) for c in clips})]}
    os.makedirs(folder + ".truth")
    with open(os.path.join(folder + ".truth", "truth.json"), "w") as f:
        json.dump(truth, f, indent=1)


def make_one(job):
    out, seed, number = job
    kind = np.random.default_rng([seed, number, 0]).choice([c for c, _ in CLASSES], p=[p for _, p in CLASSES])
    folder = os.path.join(out, f"case-{number:03d}")
    if os.path.exists(folder + ".truth"):
        return
    for attempt in range(1, 500):
        rng = np.random.default_rng([seed, number, attempt])
        try:
            case = draw_case(rng, kind)
        except Impossible:
            continue
        write_case(folder, rng, case, kind)
        return
    raise RuntimeError(f"case {number}: 500 draws gave no experiment")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make")
    make.add_argument("--cases", type=int, required=True)
    make.add_argument("--seed", type=int, required=True)
    make.add_argument("--out", required=True)
    make.add_argument("--jobs", type=int, default=2)
    everyday_score.add_command(commands)
    options = parser.parse_args()
    if options.command == "score":
        return everyday_score.run(options)
    jobs = [(options.out, options.seed, n) for n in range(options.cases)]
    with multiprocessing.Pool(options.jobs) as pool:
        pool.map(make_one, jobs, chunksize=1)
    return 0


if __name__ == "__main__":
    sys.exit(main())
