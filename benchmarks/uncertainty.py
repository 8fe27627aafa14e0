"""A GUM budget and a Monte Carlo run of 10⁶ trials, six inputs each, against the tools that people use for
them.

    python benchmarks/uncertainty.py [--repeat 5]

The measurand is f = a·b/c + d·sin(e) + g with normal, t and rectangular inputs. Each tool does the same work
in the same process, the best of the repetitions counts; the peers' figures are ratios to ours. Peers that are
not installed are named.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
import warnings
from collections.abc import Callable
from importlib import import_module

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.metrology.uncertainty.budget import combine, from_half_width, type_a
from ahrs_lab.metrology.uncertainty.distributions import Normal, Rectangular, StudentT
from ahrs_lab.metrology.uncertainty.monte_carlo import propagate

TRIALS = 1_000_000
MEANS = {"a": 10.0, "b": 2.0, "c": 4.0, "d": 1.0, "e": 0.5, "g": 0.1}
STANDARD = {"a": 0.05, "b": 0.01, "c": 0.02, "d": 0.01, "e": 0.02, "g": 0.01}
DOFS = {"a": 9.0, "b": 19.0}
"""The t inputs; e and g are rectangular, the others normal."""
RECTANGULAR = ("e", "g")


def best(work: Callable[[], object], repeat: int) -> float:
    """Seconds of the fastest of ``repeat`` runs."""
    taken = []
    for _ in range(repeat):
        started = time.perf_counter()
        work()
        taken.append(time.perf_counter() - started)
    return min(taken)


def sensitivities() -> dict[str, float]:
    a, b, c, d, e = (MEANS[name] for name in "abcde")
    return {"a": b / c, "b": a / c, "c": -a * b / c**2, "d": math.sin(e), "e": d * math.cos(e), "g": 1.0}


def our_budget() -> float:
    source = Message("Time base")
    slopes = sensitivities()
    rows = [
        from_half_width(name, source, "1", math.sqrt(3.0) * u, slopes[name], "data")
        if name in RECTANGULAR
        else type_a(name, source, "1", u, slopes[name], DOFS.get(name, math.inf))
        for name, u in STANDARD.items()
    ]
    return combine(rows).expanded


def gtc_budget() -> Callable[[], float]:
    GTC = import_module("GTC")

    def work() -> float:
        x = {n: GTC.ureal(MEANS[n], u, DOFS.get(n, math.inf)) for n, u in STANDARD.items()}
        y = x["a"] * x["b"] / x["c"] + x["d"] * GTC.sin(x["e"]) + x["g"]
        return float(GTC.reporting.k_factor(y.df) * y.u)

    return work


def our_monte_carlo() -> tuple[float, float]:
    inputs = [
        Rectangular(MEANS[n], math.sqrt(3.0) * u)
        if n in RECTANGULAR
        else StudentT(MEANS[n], u, DOFS[n])
        if n in DOFS
        else Normal(MEANS[n], u)
        for n, u in STANDARD.items()
    ]
    found = propagate(
        inputs, lambda x: x[0] * x[1] / x[2] + x[3] * np.sin(x[4]) + x[5], seed=1, trials=TRIALS
    )
    return found.shortest


def numpy_monte_carlo() -> tuple[float, float]:
    """As one writes it down: one array for each input, sorted, the shortest interval."""
    rng = np.random.default_rng(1)
    x = {}
    for n, u in STANDARD.items():
        if n in RECTANGULAR:
            x[n] = rng.uniform(MEANS[n] - math.sqrt(3.0) * u, MEANS[n] + math.sqrt(3.0) * u, TRIALS)
        elif n in DOFS:
            x[n] = MEANS[n] + u * rng.standard_t(DOFS[n], TRIALS)
        else:
            x[n] = rng.normal(MEANS[n], u, TRIALS)
    y = np.sort(x["a"] * x["b"] / x["c"] + x["d"] * np.sin(x["e"]) + x["g"])
    inside = round(0.95 * TRIALS)
    first = int(np.argmin(y[inside:] - y[: TRIALS - inside]))
    return float(y[first]), float(y[first + inside])


def suncal_monte_carlo() -> Callable[[], object]:
    suncal = import_module("suncal")

    def work() -> object:
        # e and g are constants there
        model = suncal.Model("f = xa*xb/xc + xd*sin(xe) + xg")
        for name, u in STANDARD.items():
            variable = model.var(f"x{name}").measure(MEANS[name])
            if name in RECTANGULAR:
                variable.typeb(dist="uniform", a=math.sqrt(3.0) * u)
            elif name in DOFS:
                variable.typeb(dist="t", std=u, df=DOFS[name])
            else:
                variable.typeb(dist="normal", std=u)
        return model.monte_carlo(samples=TRIALS).expand(conf=0.95, shortest=True)

    return work


def metrolopy_monte_carlo() -> Callable[[], object]:
    uc = import_module("metrolopy")

    def work() -> object:
        x = {
            n: uc.gummy(uc.UniformDist(center=MEANS[n], half_width=math.sqrt(3.0) * u))
            if n in RECTANGULAR
            else uc.gummy(uc.TDist(MEANS[n], u, DOFS[n]))
            if n in DOFS
            else uc.gummy(MEANS[n], u)
            for n, u in STANDARD.items()
        }
        y = x["a"] * x["b"] / x["c"] + x["d"] * uc.sin(x["e"]) + x["g"]
        y.sim(TRIALS)
        return y.xsim, y.usim, y.cisim

    return work


def compare(
    ours: float, peers: dict[str, Callable[[], Callable[[], object]]], repeat: int
) -> dict[str, float]:
    """Ratio of each peer that is there to ``ours``."""
    found = {}
    for name, make in peers.items():
        try:
            work = make()
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                work()
                found[name] = round(best(work, repeat) / ours, 2)
        except ImportError as error:
            print(f"  {name:12} not compared: {error}")
    return found


def main() -> int:
    """Print the figures as text and, last, as one line of JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    repeat = parser.parse_args().repeat
    budget = best(our_budget, 100 * repeat)
    trials = best(our_monte_carlo, repeat)
    figures = {
        "budget_ms": round(1e3 * budget, 4),
        "budget_peers": compare(budget, {"GTC": gtc_budget}, 100 * repeat),
        "monte_carlo_s": round(trials, 4),
        "monte_carlo_peers": compare(
            trials,
            {
                "suncal": suncal_monte_carlo,
                "metrolopy": metrolopy_monte_carlo,
                "numpy": lambda: numpy_monte_carlo,
            },
            repeat,
        ),
    }
    print(f"budget of six inputs {figures['budget_ms']} ms; peers over ours {figures['budget_peers']}")
    print(
        f"10⁶ trials {figures['monte_carlo_s']} s; peers over ours {figures['monte_carlo_peers']}   aim ≥ 1"
    )
    print(json.dumps(figures))
    return 0


if __name__ == "__main__":
    sys.exit(main())
