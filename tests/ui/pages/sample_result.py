"""A result to look at: the numbers of the published sample, with a budget, findings and a room."""

from __future__ import annotations

import math

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import (
    AllanDiagnosis,
    Diagnosis,
    DiagnosisFinding,
    MisalignmentDiagnosis,
    Residuals,
    ScaleFactorDiagnosis,
    ZeroOffsetDiagnosis,
)
from ahrs_lab.metrology.result import (
    AxisName,
    BudgetRow,
    CalibrationResult,
    Environment,
    MisalignmentResult,
    ResultWarning,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)

K = {"x": 1.0023354972170277, "y": 0.9981303779047173, "z": 1.0007446457794191}
B = {"x": 3.087392621666639e-3, "y": -2.3500235037499885e-3, "z": 1.805527627916662e-3}
L = {
    "yx": -2.6885030749999997e-4,
    "zx": 3.9153196791666666e-4,
    "xy": 6.027772040277779e-4,
    "zy": -7.190909452777777e-4,
    "xz": -4.287619295833333e-4,
    "yz": 8.788338404166666e-4,
}
RATES = (-300.0, -200.0, -100.0, -50.0, -10.0, 10.0, 50.0, 100.0, 200.0, 300.0)
POSITIONS = {
    "x": ("ENU", "ESD", "WSU", "WND"),
    "y": ("UEN", "DES", "UWS", "DWN"),
    "z": ("NUE", "SDE", "SUW", "NDW"),
}
LATITUDE_DEG = 39.9042


def sample_result() -> CalibrationResult:
    """All twelve quantities, a deviation and a warning."""
    return CalibrationResult(
        procedure="jjf1536-2015",
        bundle_sha256="0" * 64,
        software="ahrs-lab 0.1.0",
        scale_factor={axis: _scale(axis) for axis in ("x", "y", "z")},
        zero_offset={axis: _offset(axis) for axis in ("x", "y", "z")},
        misalignment={key: _misalignment(key) for key in L},
        warnings=(ResultWarning(Message("The table did not hold the rate."), "sf_x_plus_100", 1204),),
        deviations=(Message("The zero offset positions last 600 s instead of 1800 s."),),
        environment=Environment(20.4, 0.3, 48.0, 2.0),
        device={"rate_unit": "deg/s", "name": "AHRS"},
        site={"latitude_deg": LATITUDE_DEG},
        simulated=True,
        diagnosis=_diagnosis(),
    )


def _diagnosis() -> Diagnosis:
    """Of X: one finding of each state, and the Allan deviation of white noise over a floor."""
    scale = _scale("x")
    residuals = Residuals(
        scale.segments, tuple(40.0 * n for n in range(10)), scale.residuals, scale.standard_errors,
        (0.5, -0.4, 6.1, *(0.2,) * 7), 7, 4.8, (2,), 5e-4,
    )  # fmt: skip
    moved = Message(
        "From the rest before to the rest after the rates the zero moved by {drift} {unit}, no more than "
        "noise explains (u = {standard} {unit}).",
        drift="−7.2", standard="9.1", unit="°/h",
    )  # fmt: skip
    findings = (
        DiagnosisFinding("fine", moved, 0.43),
        DiagnosisFinding("look", Message("The residuals show no trend with time."), 0.004),
        DiagnosisFinding(
            "warn", Message("None of the {count} rates stands apart.", count=10), 5e-4, "sf_x_-100"
        ),
    )
    taus = tuple(2.0**octave for octave in range(9))
    deviations = tuple(math.sqrt(1e-6 / tau + 1e-9) for tau in taus)
    allan = AllanDiagnosis(
        taus, deviations, tuple(0.9 * v for v in deviations), tuple(1.1 * v for v in deviations),
        (*taus, 600.0), (*deviations, 5e-5), 1e-3, 5e-5, 0.0, 600.0, 5e-5, "past",
    )  # fmt: skip
    order = tuple(range(1, 11))
    return Diagnosis(
        {"x": ScaleFactorDiagnosis(RATES, order, 300.7, residuals, None, None, None, findings)},
        {"x": ZeroOffsetDiagnosis(residuals, None, allan, findings)},
        {"yx": MisalignmentDiagnosis(1e-3, 0.0, findings)},
    )


def _scale(axis: AxisName) -> ScaleFactorResult:
    rates = np.asarray(RATES)
    wave = 8e-6 * np.sin(rates / 90.0 + {"x": 0.0, "y": 1.0, "z": 2.0}[axis]) * 300.0
    means = K[axis] * rates + 0.0006 + wave
    return ScaleFactorResult(
        axis=axis,
        K=K[axis],
        F0=0.0006,
        unit="(deg/s)/(deg/s)",
        rates_dps=RATES,
        demanded_rates_dps=RATES,
        means=tuple(float(v) for v in means),
        residuals=tuple(float(v) for v in wave),
        static_before=0.003,
        static_after=0.0032,
        nonlinearity_ppm=7.9,
        asymmetry_ppm=3.1,
        uncertainty=_uncertainty(2.1e-5, "1"),
        segments=tuple(f"sf_{axis}_{rate:g}" for rate in RATES),
        standard_errors=tuple(4.5e-6 * 300.0 for _ in RATES),
    )


def _offset(axis: AxisName) -> ZeroOffsetResult:
    seconds = 600.0
    earth = [earth_dph(letters["xyz".index(axis)]) / 3600.0 for letters in POSITIONS[axis]]
    wobble = (2e-6, -2e-6, 1e-6, -1e-6)
    angles = tuple((B[axis] + e + w) * seconds for e, w in zip(earth, wobble, strict=True))
    return ZeroOffsetResult(
        axis=axis,
        B=B[axis],
        unit="deg/s",
        duration_s=seconds,
        angles_deg=angles,
        uncertainty=_uncertainty(0.35 / 3600.0, "deg/s"),
        orientations=POSITIONS[axis],
        durations_s=(seconds,) * 4,
        repeatability_dps=1.2 / 3600.0,
        segments=tuple(f"zo_{axis}_{number}" for number in range(1, 5)),
    )


def earth_dph(letter: str) -> float:
    """Earth rate along a direction, °/h, at the sample's latitude."""
    latitude = math.radians(LATITUDE_DEG)
    return 15.041067 * {
        "E": 0.0, "W": 0.0, "N": math.cos(latitude), "S": -math.cos(latitude), "U": math.sin(latitude),
        "D": -math.sin(latitude),
    }[letter]  # fmt: skip


def _misalignment(key: str) -> MisalignmentResult:
    output, turned = key[0], key[1]
    middle = 0.1
    half = L[key] * 360.0 * 10
    return MisalignmentResult(
        output_axis=output,  # type: ignore[arg-type]
        turned_axis=turned,  # type: ignore[arg-type]
        L=L[key],
        turns=10,
        angle_positive_deg=middle + half,
        angle_negative_deg=middle - half,
        uncertainty=_uncertainty(0.013 / 60.0 * math.pi / 180.0, "rad"),
        rate_dps=100.0,
        duration_s=52.0,
        segments=(f"ma_{turned}_plus", f"ma_{turned}_minus"),
    )


def _uncertainty(expanded: float, unit: str) -> Uncertainty:
    standard = expanded / 2.01
    shares = (
        ("table rate, 10–1000 °/s band", 0.71, "B", math.inf, "certificate"),
        ("nonlinearity (lack of fit)", 0.17, "A", 8.0, "data"),
        ("sensor noise", 0.07, "A", 42.0, "data"),
        ("drift between rests", 0.03, "A", 1.0, "data"),
        ("table wobble", 0.0149, "B", math.inf, "assumption"),
        ("timing", 0.004, "B", math.inf, "assumption"),
        ("resolution", 0.0011, "B", math.inf, "certificate"),
    )
    rows = tuple(
        BudgetRow(
            symbol=f"x{number}",
            source=Message(source),
            unit=unit or "deg/s",
            standard_uncertainty=standard * math.sqrt(share),
            sensitivity=1.0,
            contribution=standard * math.sqrt(share),
            kind=kind,  # type: ignore[arg-type]
            distribution="normal" if kind == "A" else "rectangular",
            divisor=1.0,
            dof=dof,
            origin=origin,  # type: ignore[arg-type]
        )
        for number, (source, share, kind, dof, origin) in enumerate(shares, 1)
    )
    return Uncertainty(standard, expanded, 2.01, 87.0, "gum", rows)
