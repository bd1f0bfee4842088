"""The tables and the plot of bench/peers: peers.md, readme.md (the same, shortened), errors.csv, parameters.csv, signals.csv, peers.svg."""

import csv
import os
import subprocess

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")  # Okabe and Ito, as the reports have them


def number(value, scale=1.0, digits=3):
    return "–" if value is None else f"{float(f'{scale * value:.{digits}g}'):.6g}"  # 110, not 1.1e+02


def with_sd(parameters, name, digits):
    sd = parameters.get(f"{name}_sd")
    return number(parameters[name], digits=digits) + (f" ± {sd:.2g}" if sd is not None else "")


def markdown(header, rows):
    return "".join("| " + " | ".join(cells) + " |\n" for cells in [header, ["---"] * len(header), *rows])


def method_text(row):
    return row["method"] + (f" ({row['setting']:.3g})" if row["setting"] is not None else "")


def truth_table(rows):
    body = []
    for row in rows:
        x, v, a, everywhere = row["errors"] or [None] * 4
        off = row["off"]
        body.append([method_text(row), number(x, 1e6), number(v, 1e3), number(a), number(everywhere), number(off["k_over_m"], 100.0),
                     number(off["mu"], 1e4), number(off["alpha_deg"], 1e3), number(row["seconds"], digits=2)])
    header = ["method", "x (µm)", "v (mm/s)", "a (m/s²)", "a, all frames", "K/m (%)", "µ (1e-4)", "α (0.001°)", "time (s)"]
    return markdown(header, body)


def recording_table(rows, configurations):
    body = []
    for i, configuration in enumerate(configurations):
        clips = configuration["clips"]
        name = clips[0] if len(clips) == 1 else f"{clips[0]} … {clips[-1]}"
        for row in rows:
            p = row["parameters"][i]
            if p["k_over_m"] is not None:
                body.append([name, row["method"], with_sd(p, "k_over_m", 4), number(p["spread"], digits=2), with_sd(p, "mu", 3),
                             with_sd(p, "alpha_deg", 4), number(row["seconds"], digits=2)])
    return markdown(["clips", "method", "K/m (1/s)", "spread", "µ", "α (°)", "time (s)"], body)


def signal_summary(rows, which, quantity):
    """A signal and noise a row: Glidelab's smoothers, the best peer by its own choice, and what is best in hindsight."""
    body = []
    for signal, noise in dict.fromkeys((row["signal"], row["noise_m"]) for row in rows):
        here = [row for row in rows if (row["signal"], row["noise_m"]) == (signal, noise) and row["errors"][which] is not None]
        own = {row["method"]: row["errors"][which] for row in here if row["self_choosing"]}
        hindsight = {row["method"]: row["errors"][which] for row in here if not row["self_choosing"]}
        peers = {name: error for name, error in own.items() if not name.startswith("Glidelab")}
        if not here:
            continue

        def best(errors):
            name = min(errors, key=errors.get, default=None)
            return "–" if name is None else f"{number(errors[name])} {name}"

        body.append([f"{signal}, {noise:g}", number(own.get("Glidelab, kalman")), number(own.get("Glidelab, spline")), best(peers), best(hindsight)])
    return markdown([f"error of {quantity}", "kalman", "spline", "best peer by its own choice", "best in hindsight"], body)


def signal_tables(rows):
    """Errors of v and a inside, and in brackets of all frames: a table for methods that choose by themselves, one for those set in hindsight."""
    text = signal_summary(rows, 0, "v inside") + "\n" + signal_summary(rows, 1, "a inside") + "\n"
    kinds = list(dict.fromkeys((row["signal"], row["noise_m"]) for row in rows))
    for quantity, which in (("v", 0), ("a", 1)):
        for chosen in (True, False):
            header = [f"{quantity}, {'by its own choice' if chosen else 'the best in hindsight'}", *(f"{signal}, {noise:g}" for signal, noise in kinds)]
            body = []
            for method in dict.fromkeys(row["method"] for row in rows if row["self_choosing"] == chosen):
                of = {(row["signal"], row["noise_m"]): row["errors"] for row in rows if (row["method"], row["self_choosing"]) == (method, chosen)}
                cells = [of.get(kind, [None] * 4) for kind in kinds]
                body.append([method, *(f"{number(e[which])} ({number(e[which + 2])})" for e in cells)])
            text += markdown(header, body) + "\n"
    return text


def in_readme(row):
    """Settings that are best in hindsight are nobody's, and a method that gives nothing has no row."""
    return row["setting"] is None and any(p["k_over_m"] is not None for p in row["parameters"])


def readme_truth_table(scenario, rows):
    body = []
    for row in filter(in_readme, rows):
        x, v, a, _ = row["errors"] or [None] * 4
        off = row["off"]
        body.append([row["method"], number(x, 1e6, 2), number(v, 1e3, 2), number(a, digits=2), number(off["k_over_m"], 100.0, 2),
                     number(off["mu"], 1e4, 2), number(off["alpha_deg"], 1e3, 2), number(row["seconds"], digits=2)])
    return markdown([f"{scenario}: errors of", "x (µm)", "v (mm/s)", "a (m/s²)", "K/m (%)", "µ (1e-4)", "α (0.001°)", "time (s)"], body)


def readme_recording_table(recordings):
    """A method a row, a recording a column: what its first configuration (of the block: each) comes to."""
    def cell(rows, method):
        row = next((row for row in rows if row["method"] == method), None)
        if row is None or row["parameters"][0]["k_over_m"] is None:
            return "–"
        of = row["parameters"] if all(p["mu"] is None for p in row["parameters"]) else row["parameters"][:1]
        texts = [with_sd(p, "k_over_m", 3) for p in of if p["k_over_m"] is not None]
        texts += [with_sd(of[0], name, 3) for name in ("mu", "alpha_deg") if of[0][name] is not None]
        return ", ".join(texts)

    methods, header = [], ["K/m (1/s), µ, α (°)"]
    for name, rows, configurations in recordings:
        header.append(name + ("" if len(configurations) == 1 else f", {configurations[0]['clips'][0]}…"))
        methods += [row["method"] for row in rows if row["method"] not in methods and in_readme(row)]
    body = []
    for method in methods:
        taken = [row["seconds"] for _, rows, _ in recordings for row in rows if row["method"] == method]
        seconds = None if None in taken or not taken else sum(taken)
        body.append([method, *(cell(rows, method) for _, rows, _ in recordings), number(seconds, digits=2)])
    return markdown([*header, "time (s)"], body)


def plot(clips, path):
    """Errors of a and of K/m by method, a point each, on logarithmic axes."""
    names = [row["method"] for row in clips[0][1]]
    height = 150 + 28 * len(names)
    blocks, panels = [], {"a": [], "k": []}
    for i, (scenario, rows) in enumerate(clips):
        blocks.append(f"$d{i} << END\n")
        for n, row in enumerate(rows):
            a = row["errors"][2] if row["errors"] else float("nan")
            k = row["off"]["k_over_m"]
            blocks.append(f"{a:.6g} {100.0 * k if k is not None else float('nan'):.6g} {len(names) - n}\n")
        blocks.append("END\n")
        for column, panel in ((1, "a"), (2, "k")):
            panels[panel].append(f"$d{i} using {column}:3 with points pt {7 + 2 * i} ps 0.9 lc rgb '{COLORS[i % 4]}' title '{scenario}'")
    tics = ", ".join(f"'{name}' {len(names) - n}" for n, name in enumerate(names))
    bare_tics = ", ".join(f"'' {len(names) - n}" for n in range(len(names)))  # the names stand at the left panel
    script = (
        f"set terminal svg noenhanced size 1000,{height} dynamic font 'sans-serif,15' background '#ffffff'\n"
        f"set output '{path}'\nset encoding utf8\n{''.join(blocks)}"
        "set format x '%g'\nset border 3 lc rgb '#555555'\nset tics nomirror out scale 0.6\nset grid xtics ytics lc rgb '#dddddd'\n"
        f"set logscale x\nset yrange [0.4:{len(names) + 0.6}]\nset key outside top center horizontal samplen 1\n"
        "set multiplot layout 1,2 margins 0.27,0.97,0.14,0.9 spacing 0.06,0\n"
        f"set ytics ({tics})\nset xlabel 'rms error of a in the lines  (m/s²)'\nplot {', '.join(panels['a'])}\n"
        f"set ytics ({bare_tics})\nset xlabel 'rms error of K/m  (%)'\n"
        f"plot {', '.join(panels['k'])}\nunset multiplot\n"
    )
    subprocess.run(["gnuplot", "-d", "-"], input=script, text=True, check=True)


def write_csv(path, header, rows):
    with open(path, "w", encoding="utf-8", newline="") as table:
        writer = csv.writer(table, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([["" if cell is None else cell for cell in row] for row in rows])


def write(out, clips, recordings, signals=()):
    text = ""
    for scenario, rows in clips:
        text += f"## {scenario}\n\n{truth_table(rows)}\n"
    for name, rows, configurations in recordings:
        text += f"## {name}\n\n{recording_table(rows, configurations)}\n"
    if signals:
        text += f"## test signals\n\n{signal_tables(signals)}"
        write_csv(os.path.join(out, "signals.csv"),
                  ["signal", "noise_m", "method", "own_choice", "v_inside_m_s", "a_inside_m_s2", "v_m_s", "a_m_s2"],
                  [[row["signal"], row["noise_m"], row["method"], row["self_choosing"], *row["errors"]] for row in signals])
    with open(os.path.join(out, "peers.md"), "w", encoding="utf-8") as page:
        page.write(text)
    with open(os.path.join(out, "readme.md"), "w", encoding="utf-8") as page:
        page.write("\n".join([readme_truth_table(*one) for one in clips] + ([readme_recording_table(recordings)] if recordings else [])))
    write_csv(os.path.join(out, "errors.csv"),
              ["clips", "method", "setting", "x_m", "v_m_s", "a_m_s2", "a_all_frames_m_s2", "k_over_m_relative", "mu", "alpha_deg", "time_s"],
              [[scenario, row["method"], row["setting"], *(row["errors"] or [None] * 4), *row["off"].values(), row["seconds"]]
               for scenario, rows in clips for row in rows])
    names = ("k_over_m", "k_over_m_sd", "spread", "mu", "mu_sd", "alpha_deg", "alpha_deg_sd")
    experiments = [(name, rows) for name, rows in clips] + [(name, rows) for name, rows, _ in recordings]
    write_csv(os.path.join(out, "parameters.csv"), ["clips", "configuration", "method", *names],
              [[name, i, row["method"], *(p.get(n) for n in names)]
               for name, rows in experiments for row in rows for i, p in enumerate(row["parameters"])])
    if clips:
        plot(clips, os.path.join(out, "peers.svg"))
