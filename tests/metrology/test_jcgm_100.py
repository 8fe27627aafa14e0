"""Examples H.1, H.2 and H.3 of JCGM 100:2008, with the numbers printed there."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import Correlation
from ahrs_lab.metrology.uncertainty.budget import (
    combine,
    coverage_factor,
    effective_dof,
    from_half_width,
    type_a,
)

SOURCE = Message("Time base")


def test_h1_end_gauge_calibration() -> None:
    """l = l_S + d − l_S(δα·θ + α_S·δθ); lengths in nm. Printed: u_c = 32 nm, ν_eff = 16, U₉₉ = 93 nm."""
    length, theta, alpha = 50_000_623.0, -0.1, 11.5e-6
    comparison = [(5.8, 24.0), (3.9, 5.0), (6.7, 8.0)]
    rows = [
        type_a("l_S", SOURCE, "nm", 25.0, 1.0, 18.0),
        *(type_a(f"d_{u}", SOURCE, "nm", u, 1.0, dof) for u, dof in comparison),
        from_half_width("α_S", SOURCE, "1/°C", 2e-6, 0.0, "certificate"),
        type_a("θ", SOURCE, "°C", 0.41, 0.0, math.inf),
        type_a("δα", SOURCE, "1/°C", 1e-6 / math.sqrt(3.0), -length * theta, 50.0),
        type_a("δθ", SOURCE, "°C", 0.05 / math.sqrt(3.0), -length * alpha, 2.0),
    ]
    found = combine(rows)
    contributions = [row.contribution for row in rows]
    assert math.hypot(*contributions[1:4]) == pytest.approx(9.7, abs=0.05)
    assert effective_dof(contributions[1:4], [row.dof for row in rows[1:4]]) == pytest.approx(25.6, abs=0.2)
    assert contributions[6:] == pytest.approx([2.9, 16.6], abs=0.05)
    assert found.standard == pytest.approx(32.0, abs=0.5)
    assert math.floor(found.dof) == 16
    assert coverage_factor(16.0, 0.99) * found.standard == pytest.approx(93.0, abs=1.0)


def test_h2_simultaneous_resistance_and_reactance() -> None:
    """Table H.2's five sets of V, I, φ; printed in tables H.3 and H.4: u(R) = 0.071 Ω, u(X) = 0.295 Ω,
    u(Z) = 0.236 Ω; all have the 4 degrees of freedom of the observations."""
    V = np.array([5.007, 4.994, 5.005, 4.990, 4.999])
    I = np.array([19.663, 19.639, 19.640, 19.685, 19.678]) * 1e-3  # noqa: E741
    phi = np.array([1.0456, 1.0438, 1.0468, 1.0428, 1.0433])
    sets = np.array([V, I, phi])
    v, i, p = sets.mean(axis=1)
    u = sets.std(axis=1, ddof=1) / math.sqrt(5.0)
    r = np.corrcoef(sets)
    assert u == pytest.approx([0.0032, 0.0095e-3, 0.00075], rel=0.02)
    assert [r[0, 1], r[0, 2], r[1, 2]] == pytest.approx([-0.36, 0.86, -0.65], abs=0.006)
    coefficients = [Correlation(a, b, float(r[a, b])) for a, b in combinations(range(3), 2)]
    R, X, Z = v / i * math.cos(p), v / i * math.sin(p), v / i
    for value, sensitivities, printed, printed_u in (
        (R, (R / v, -R / i, -X), 127.732, 0.071),
        (X, (X / v, -X / i, R), 219.847, 0.295),
        (Z, (Z / v, -Z / i, 0.0), 254.260, 0.236),
    ):
        rows = [
            type_a(symbol, SOURCE, "1", float(u[k]), float(c), 4.0, shared="five sets")
            for k, (symbol, c) in enumerate(zip(("V", "I", "φ"), sensitivities, strict=True))
        ]
        found = combine(rows, correlations=coefficients)
        assert value == pytest.approx(printed, abs=0.0006)
        assert found.standard == pytest.approx(printed_u, abs=0.0006)
        assert found.dof == pytest.approx(4.0)


def test_h3_calibration_curve_of_a_thermometer() -> None:
    """b(t) = y₁ + y₂(t − 20 °C) of the eleven readings of table H.6. Printed: y₁ = −0.1712(29) °C,
    y₂ = 0.00218(67), r = −0.930, s = 0.0035 °C; b(30 °C) = −0.1494(41) °C with ν = 9."""
    t = np.array([21.521, 22.012, 22.512, 23.003, 23.507, 23.999, 24.513, 25.002, 25.503, 26.010, 26.511])
    b = -np.array([0.171, 0.169, 0.166, 0.159, 0.164, 0.165, 0.156, 0.157, 0.159, 0.161, 0.160])
    columns = np.column_stack([np.ones(11), t - 20.0])
    y, residual, *_ = np.linalg.lstsq(columns, b, rcond=None)
    covariance = residual[0] / 9.0 * np.linalg.inv(columns.T @ columns)
    u = np.sqrt(np.diag(covariance))
    r = float(covariance[0, 1] / (u[0] * u[1]))
    assert y == pytest.approx([-0.1712, 0.00218], abs=6e-5)
    assert u == pytest.approx([0.0029, 0.00067], rel=0.02)
    assert r == pytest.approx(-0.930, abs=0.0006)
    rows = [
        type_a("y₁", SOURCE, "°C", float(u[0]), 1.0, 9.0, shared="s"),
        type_a("y₂", SOURCE, "1", float(u[1]), 10.0, 9.0, shared="s"),
    ]
    found = combine(rows, correlations=[Correlation(0, 1, r)])
    assert y[0] + 10.0 * y[1] == pytest.approx(-0.1494, abs=6e-5)
    assert found.standard == pytest.approx(0.0041, abs=6e-5)
    assert found.dof == pytest.approx(9.0)
    # without its correlation the curve would be far less known (H.3.5)
    assert combine(rows).standard > 1.7 * found.standard


def test_correlations_that_cannot_be_are_refused_by_the_rows_names() -> None:
    rows = [type_a(symbol, SOURCE, "nm", 1.0, 1.0, 9.0) for symbol in "abcd"]
    with pytest.raises(InputError, match="correlations of a, c, d contradict"):
        combine(rows, correlations=[Correlation(0, 2, 0.9), Correlation(0, 3, 0.9), Correlation(2, 3, -0.9)])
    with pytest.raises(InputError, match=r"a and b is -1\.2"):
        combine(rows, correlations=[Correlation(0, 1, -1.2)])
    for wrong in (Correlation(1, 1, 0.5), Correlation(0, 4, 0.5), Correlation(-1, 2, 0.5)):
        with pytest.raises(InputError, match="rows"):
            combine(rows, correlations=[wrong])
    with pytest.raises(InputError, match="rows 2 and 1"):
        combine(rows, correlations=[Correlation(0, 1, 0.1), Correlation(1, 0, 0.1)])


@pytest.mark.parametrize("dof", [0.0, -3.0, math.nan])
def test_degrees_of_freedom_that_are_not_positive_are_refused(dof: float) -> None:
    with pytest.raises(InputError, match=r"a has .* degrees of freedom"):
        combine([type_a("a", SOURCE, "nm", 1.0, 1.0, dof)])


def test_one_estimate_has_one_number_of_degrees_of_freedom() -> None:
    rows = [type_a("a", SOURCE, "nm", 1.0, 1.0, dof, shared="N") for dof in (4.0, 5.0)]
    with pytest.raises(InputError, match="“N” have different degrees"):
        combine(rows)


def test_a_distribution_without_width_contributes_nothing() -> None:
    certain = from_half_width("q", SOURCE, "deg", 0.0, 5.0, "data")
    other = type_a("a", SOURCE, "nm", 2.0, 1.0, 7.0)
    found = combine([certain, other], correlations=[Correlation(0, 1, 0.5)])
    assert (found.standard, found.dof) == pytest.approx((2.0, 7.0))


def test_fully_anticorrelated_rows_cancel() -> None:
    rows = [type_a(symbol, SOURCE, "nm", 1.0, 1.0, math.inf) for symbol in "ab"]
    assert combine(rows, correlations=[Correlation(0, 1, -1.0)]).standard == 0.0
