"""A floating body in waves on three mooring lines: `python run.py [-o FOLDER]` makes all figures and the table of docs/floating-body.md."""

import argparse
import dataclasses
import pathlib

import numpy as np
from body import AXES, COMING, DENSITY, EXTRAPOLATED, LAST, MOTION, Body, Hydrodynamics, Waves
from hosts import LINES, Case, Moorings, in_fmpy, in_libcosim

Run = dict[str, np.ndarray]
SEAS = {"spar": Waves(6.0, 10.0, 1), "barge": Waves(2.0, 8.0, 1)}
SHOWN = {"x": ("surge", "m", 1.0), "z": ("heave", "m", 1.0), "pitch": ("pitch", "°", 180 / np.pi)}  # name, unit, scale of figures


def unmoored(case: Case, moorings: Moorings) -> Run:
    """Runs a case without mooring: its force at rest stays."""
    rest, _ = moorings.statics(case.body)
    body = Body(case.body, case.step, rest, case.waves)
    body.x, rows = np.array(case.start), []
    for k in range(round(case.duration / case.step) + 1):
        rows.append([k * case.step, *body.x, *body.v])
        body.advance(rest, rest)
    return dict(zip(("time",) + MOTION, np.array(rows).T))


def surge_mode(name: str, moorings: Moorings) -> tuple[float, np.ndarray]:
    """Period [s] and shape of the slowest mode in surge of the moored body, from the stiffness of the mooring, hydrostatics and A(ω)."""
    rest, stiffness = moorings.statics(name)
    body, period = Body(name, 1.0, rest), 100.0
    for _ in range(5):
        mass = body.mass + body.data.at(body.data.added_mass, 2 * np.pi / period) - body.data.infinite
        squares, shapes = np.linalg.eig(np.linalg.solve(mass, body.stiffness + stiffness))
        surge = np.argmax(np.abs(shapes[0]) * (np.abs(shapes[1]) < 1e-3))
        period = 2 * np.pi / np.sqrt(squares[surge].real)
    return period, shapes[:, surge].real / shapes[0, surge].real


def period_of(run: Run, name: str) -> float:
    """Mean time between upward crossings of zero [s]."""
    t, x = run["time"], run[name]
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    return np.diff(t[up] - x[up] * (t[up + 1] - t[up]) / (x[up + 1] - x[up])).mean()


def amplitude(run: Run, name: str, omega: float) -> float:
    """Amplitude at a frequency [rad/s] over the last 20 periods, beside a mean and a drift."""
    last = run["time"] > run["time"][-1] - 40 * np.pi / omega
    t = run["time"][last]
    fit = np.c_[np.cos(omega * t), np.sin(omega * t), np.ones_like(t), t - t[0]]
    return np.hypot(*np.linalg.lstsq(fit, run[name][last], rcond=None)[0][:2])


def rao(name: str, omega: float, moorings: Moorings, moored: bool) -> np.ndarray:
    """Response to a unit wave in the frequency domain [m/m, rad/m]; with the quasi-static stiffness of the mooring, where moored."""
    rest, stiffness = moorings.statics(name)
    body = Body(name, 1.0, rest)
    matrix = body.dynamic_stiffness(omega) + moored * stiffness
    return np.linalg.solve(matrix, body.data.at(body.data.excitation, omega))


def ogilvie(name: str) -> float:
    """Greatest difference of A∞ − ∫K sin ωt dt/ω and ∫K cos ωt dt from A(ω) and B(ω), in surge, heave and pitch at 0.2 to 2 rad/s, over the
    greatest A and ωA of the axis [-] (Ogilvie 1964)."""
    data, t = Hydrodynamics(name), np.arange(0.0, 40.025, 0.05)
    kernel, worst = data.retardation(t), 0.0
    for omega, added, damping in zip(data.omega, data.added_mass, data.damping):
        if not 0.2 <= omega <= 2.0:
            continue
        sine, cosine = (np.trapezoid(f(omega * t)[:, None, None] * kernel, t, axis=0) for f in (np.sin, np.cos))
        error = np.maximum(np.abs(data.infinite - sine / omega - added), np.abs(cosine - damping) / omega)
        worst = max(worst, *(np.diag(error) / np.diag(data.added_mass.max(axis=0)))[[0, 2, 4]])
    return worst


def difference(run: Run, reference: Run, name: str) -> tuple[float, float]:
    """RMS difference over the RMS and over the standard deviation of the reference, whose steps are a whole part of the run's [%]."""
    each = round((reference["time"].size - 1) / (run["time"].size - 1))
    other = reference[name][::each]
    rms = 100 * np.sqrt(np.mean((run[name] - other) ** 2))
    return rms / np.sqrt(np.mean(other**2)), rms / other.std()


def long_waves(body: Body) -> float:
    """Heave excitation in long waves over the waterplane stiffness [-]: of the longest wave in the table, with the inertia of the water
    that the body displaces and of its added mass."""
    inertia = DENSITY * body.shape.volume + body.data.added_mass[0, 2, 2]
    return (body.data.excitation[0, 2].real + body.data.omega[0] ** 2 * inertia) / body.stiffness[2, 2]


def exchanged(run: Run) -> float:
    """Energy that body and lines have exchanged in surge, heave and pitch, ∫|power| dt [J]."""
    power = np.sum([run[force] * run[speed] for force, speed in zip(("fx", "fz", "my"), ("vx", "vz", "wy"))], axis=0)
    return np.trapezoid(np.abs(power), run["time"])


class Report:
    """Figures by matplotlib and rows of a Markdown table, in a folder."""

    def __init__(self, folder: pathlib.Path) -> None:
        import matplotlib

        matplotlib.use("Agg")
        matplotlib.rcParams.update({"font.size": 8, "svg.hashsalt": "moorline", "lines.linewidth": 1.0, "axes.grid": True, "grid.alpha": 0.3})
        self.folder, self.rows = folder, ["| case | figure |", "|---|---|"]

    def say(self, case: str, figure: str) -> None:
        """Prints and keeps a row."""
        print(f"{case}: {figure}", flush=True)
        self.rows.append(f"| {case} | {figure} |")
        (self.folder / "table.md").write_text("\n".join(self.rows) + "\n")

    def draw(self, name: str, panels: int, xlabel: str) -> tuple:
        """Panels side by side, with the function that writes them."""
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(1, panels, figsize=(9, 2.8), layout="constrained")
        for axis in axes:
            axis.set_xlabel(xlabel)

        def write() -> None:
            figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
            for kind in ("svg", "png"):
                figure.savefig(self.folder / f"floating_{name}.{kind}", metadata={"Date": None} if kind == "svg" else None)
            plt.close(figure)

        return axes, write


def decays(moorings: Moorings, report: Report) -> None:
    """Free decay of the spar in surge, heave and pitch, with and without mooring."""
    period, mode = surge_mode("spar", moorings)
    for integrator in ("auto", "quasi_static"):
        found = period_of(in_fmpy(Case(duration=1000.0, start=tuple(2.0 * mode), integrator=integrator), moorings), "x")
        report.say(f"surge of the moored spar, lines `{integrator}`", f"{found:.2f} s; eigenvalue {period:.2f} s; {100 * (found / period - 1):+.2f} %")
    axes, write = report.draw("decay", 3, "time [s]")
    starts = {"x": (5.0, 600.0), "z": (2.0, 200.0), "pitch": (np.radians(5.0), 200.0)}  # displacement [m, rad], duration [s]
    for axis, (key, (name, unit, scale)) in zip(axes, SHOWN.items()):
        case = Case(duration=starts[key][1], start=tuple(starts[key][0] * (np.array(AXES) == key)))
        for label, simulate in (("moored", in_fmpy), ("without mooring", unmoored)):
            run = simulate(case, moorings)
            axis.plot(run["time"], scale * run[key], label=label)
            if (key, label) != ("x", "without mooring"):  # nothing brings that one back
                report.say(f"decay of the spar in {name}, {label}", f"period {period_of(run, key):.2f} s")
        axis.set_ylabel(f"{name} [{unit}]")
    write()


def regular(moorings: Moorings, report: Report) -> None:
    """Regular waves of 2 m height on the spar: amplitudes beside the response in the frequency domain."""
    axes, write = report.draw("regular", 3, "period of the wave [s]")
    omegas, line = np.array([0.3, 0.4, 0.5, 0.6, 0.8]), np.linspace(0.28, 1.0, 150)
    for moored, label, simulate, style in ((True, "moored", in_fmpy, "C0-o"), (False, "without mooring", unmoored, "C1--x")):
        runs = [simulate(Case(duration=2000.0, waves=Waves(2.0, 2 * np.pi / omega)), moorings) for omega in omegas]
        curve, exact = (np.abs([rao("spar", omega, moorings, moored) for omega in some]) for some in (line, omegas))
        for axis, (key, (name, unit, scale)) in zip(axes, SHOWN.items()):
            found = np.array([amplitude(run, key, omega) for run, omega in zip(runs, omegas)])
            axis.plot(2 * np.pi / line, scale * curve[:, AXES.index(key)], style[:-1], label=f"frequency domain, {label}")
            axis.plot(2 * np.pi / omegas, scale * found, style[:2] + style[-1], label=f"in time, {label}")
            axis.set_ylabel(f"{name} [{unit}/m]")
            worst = 100 * np.max(np.abs(found / exact[:, AXES.index(key)] - 1))
            report.say(f"{name} of the spar in waves of 7.9 to 20.9 s, {label}", f"within {worst:.2f} % of the RAO")
    write()


def seas(moorings: Moorings, report: Report) -> None:
    """An hour of an irregular sea at h = 0.1 s, with three forces of the mooring."""
    axes, write = report.draw("sea", 2, "time [s]")
    for axis, (name, waves) in zip(axes, SEAS.items()):
        runs = {kind: in_fmpy(Case(name, duration=3600.0, waves=waves, coupling=kind), moorings) for kind in (COMING, LAST, EXTRAPOLATED)}
        for kind, run in runs.items():
            energy = np.max(np.abs(run["solver.energy_error"])) / exchanged(run)
            report.say(f"an hour of the {name}, {kind}: energy error of the lines over the energy exchanged", f"{energy:.1e}")
            shown = (run["time"] > 3000) & (run["time"] < 3100)
            axis.plot(run["time"][shown], run[LINES[0]][shown] / 1e3, ls={COMING: "-", LAST: "--", EXTRAPOLATED: ":"}[kind], label=f"{kind} force")
            if kind != COMING:
                rms, deviation = difference(run, runs[COMING], LINES[0])
                report.say(f"an hour of the {name}, {kind} against coming: tension of line 1", f"{rms:.2f} % of its RMS, {deviation:.2f} % of its deviation")
        axis.set_ylabel(f"tension of line 1, {name} [kN]")
    write()


def steps(moorings: Moorings, report: Report) -> None:
    """Error by communication step and force of the mooring, against steps of 1/160 s with the last forces extrapolated."""
    axes, write = report.draw("steps", 2, "communication step [s]")
    for axis, (name, waves) in zip(axes, SEAS.items()):
        case = Case(name, 0.00625, 200.0, EXTRAPOLATED, waves)
        reference, sizes = in_fmpy(case, moorings), (0.0125, 0.025, 0.05, 0.1)
        for kind in (LAST, EXTRAPOLATED, COMING):
            runs = [in_fmpy(dataclasses.replace(case, step=step, coupling=kind), moorings) for step in sizes]
            errors = [difference(run, reference, LINES[0])[1] for run in runs]
            axis.loglog(sizes, errors, "o-", label=f"{kind} force")
            report.say(f"{name}, {kind}: error of the tension at h = 0.05 and 0.1 s over its deviation", f"{errors[2]:.2f} %, {errors[3]:.2f} %")
        axis.set_xticks(sizes, map(str, sizes))
        axis.minorticks_off()
        axis.set_ylabel(f"error of the tension, {name} [%]")
    write()


def bodies(moorings: Moorings, report: Report) -> None:
    """Checks of the tables and of the weight."""
    for name in SEAS:
        body = Body(name, 0.1, moorings.statics(name)[0])
        report.say(f"{name}: point mass that balances the weight", f"{body.point_mass / 1e3:.1f} t")
        report.say(f"{name}: heave excitation in long waves over the waterplane stiffness", f"{long_waves(body):.4f}")
        report.say(f"{name}: greatest departure from Ogilvie's relations", f"{100 * ogilvie(name):.2f} %")
    case = Case("barge", duration=120.0, waves=SEAS["barge"])
    one, other = in_fmpy(case, moorings), in_libcosim(case, moorings)
    worst = max(np.max(np.abs(one[key][1:] - other[key])) / max(np.ptp(one[key]), 1e-300) for key in (*MOTION, *LINES))
    report.say("FMPy against libcosim, barge, 120 s: greatest difference over the range", f"{worst:.0e}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("out/floating_body"), help="folder of figures and table")
    output = parser.parse_args().output
    made, written = Moorings(output), Report(output)
    for part in (bodies, decays, regular, seas, steps):
        part(made, written)
