"""The motion itself, x'' = g sin(alpha) - mu g cos(alpha) sign(v) - (K/m) v, integrated by scipy's solve_ivp and fitted to the positions by
least_squares: K/m, drive and friction of all clips of a configuration, and a start (x0, v0) of each clip."""

import math

from experiment_folder import main, public_package

numpy = public_package("numpy", "python3-numpy")
integrate = public_package("scipy.integrate", "python3-scipy")
optimize = public_package("scipy.optimize", "python3-scipy")


def motion(k, drive, friction, x0, v0, t):
    """x at the times t, from turn to turn; where the drive does not overcome friction, a glider that has stopped rests."""
    out, at, state = numpy.empty(len(t)), t[0], [x0, v0]
    done = 0
    while done < len(t):
        sign = math.copysign(1.0, state[1]) if state[1] else math.copysign(1.0, drive)
        if state[1] == 0.0 and abs(drive) <= friction:
            out[done:] = state[0]
            break
        turn = lambda _, y: y[1] if state[1] else y[1] + sign * 1e-9
        turn.terminal, turn.direction = True, -sign
        run = integrate.solve_ivp(lambda _, y: [y[1], drive - friction * sign - k * y[1]], (at, t[-1] + 1e-9), state,
                                  t_eval=t[done:], events=turn, rtol=1e-8, atol=1e-10)
        out[done:done + len(run.t)] = run.y[0]
        done += len(run.t)
        if run.status != 1 or done == len(t):
            break
        at, state = run.t_events[0][0], [run.y_events[0][0][0], 0.0]
    return out


def start_of(clip):
    """x0 and v0 from a parabola through the first tenth of a second or five points."""
    n = max(5, sum(1 for t in clip.t_s if t < clip.t_s[0] + 0.1))
    fit = numpy.polyfit(numpy.array(clip.t_s[:n]) - clip.t_s[0], clip.x_m[:n], 2)
    return [fit[2], fit[1]]


def fitted(configuration, gravity):
    clips = configuration.clips
    first = [1.0, gravity * math.sin(math.radians(configuration.incline_deg)), 0.05]
    first += [number for clip in clips for number in start_of(clip)]

    def rests(p):
        return numpy.concatenate([motion(p[0], p[1], abs(p[2]), p[3 + 2 * i], p[4 + 2 * i], numpy.array(clip.t_s)) - clip.x_m
                                  for i, clip in enumerate(clips)])

    best = optimize.least_squares(rests, first, x_scale="jac")
    degrees = len(best.fun) - len(first)
    covariance = numpy.linalg.pinv(best.jac.T @ best.jac) * (best.fun @ best.fun) / degrees
    k, drive, friction = best.x[0], best.x[1], abs(best.x[2])
    sine = drive / gravity
    cosine = math.sqrt(1.0 - sine**2)
    sd = numpy.sqrt(numpy.diag(covariance))
    answer = {"k_over_m_1_s": (k, sd[0])}
    answer["alpha_deg"] = (math.degrees(math.asin(sine)), math.degrees(sd[1] / gravity / cosine))
    answer["mu"] = (friction / gravity / cosine, sd[2] / gravity / cosine)
    if k > 0.0 and drive > friction:
        v = (drive - friction) / k
        slope = numpy.array([-v / k, 1.0 / k, -1.0 / k])
        answer["v_lim_m_s"] = (v, math.sqrt(slope @ covariance[:3, :3] @ slope))
    return answer


if __name__ == "__main__":
    main(lambda folder: [fitted(configuration, folder.gravity_m_s2) for configuration in folder.configurations])
