"""A result with the printed values of the sample recording, and a job sheet for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest

from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.job_sheet import CertificateLanguage, DeviceUnderTest, JobSheet, Party, Person
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import Standard
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

RATES = (10.0, -10.0, 50.0, -50.0, 100.0, -100.0, 200.0, -200.0, 300.0, -300.0)
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
U_K, U_B, U_L = 2.1e-4, 9.7e-5, 3.8e-6
"""Expanded uncertainties, chosen by hand."""

BUNDLE_SHA256 = "4f1c8a0be7a2d95c3e60b7718d2f64aa90c5e1d3b8f7062a5c4d9e1f3b2a7c60"


def _row(symbol: str, source: str, contribution: float, origin: str = "data", kind: str = "A") -> BudgetRow:
    return BudgetRow(
        symbol=symbol,
        source=Message(source),
        unit="1",
        standard_uncertainty=contribution,
        sensitivity=1.0,
        contribution=contribution,
        kind="A" if kind == "A" else "B",
        distribution="normal",
        divisor=1.0,
        dof=20.0,
        origin="data" if origin == "data" else "certificate" if origin == "certificate" else "assumption",
    )


def _uncertainty(expanded: float, k: float = 2.0) -> Uncertainty:
    standard = expanded / k
    rows = (
        _row("N", "Noise of the unit", standard * 0.6),
        _row("Ω", "Rate of the table", standard * 0.72, "certificate", "B"),
        _row("α", "Azimuth of the north reference", standard * 0.35, "assumption", "B"),
    )
    return Uncertainty(standard, expanded, k, 40.0, "gum", rows)


def _scale_factor(axis: AxisName) -> ScaleFactorResult:
    residuals = tuple(
        4e-3 * (r / 300) ** 3 - 2.3e-3 * (r / 300) + 3e-4 * (-1) ** i for i, r in enumerate(RATES)
    )
    means = tuple(K[axis] * r + 0.0006 + v for r, v in zip(RATES, residuals, strict=True))
    return ScaleFactorResult(
        axis=axis,
        K=K[axis],
        F0=0.0006,
        unit="(deg/s)/(deg/s)",
        rates_dps=RATES,
        demanded_rates_dps=RATES,
        means=means,
        residuals=residuals,
        static_before=0.00012,
        static_after=0.00014,
        nonlinearity_ppm=7.3,
        asymmetry_ppm=-4.1,
        uncertainty=_uncertainty(U_K),
        standard_errors=(5e-4,) * len(RATES),
        segments=tuple(f"sf_{axis}_{i:02d}" for i in range(len(RATES))),
    )


def _zero_offset(axis: AxisName) -> ZeroOffsetResult:
    scatter = (0.21, -0.18, -0.11, 0.08)
    return ZeroOffsetResult(
        axis=axis,
        B=B[axis],
        unit="deg/s",
        duration_s=1800.0,
        angles_deg=tuple(B[axis] * 1800.0 + s for s in scatter),
        uncertainty=_uncertainty(U_B, 2.04),
        orientations={
            "x": ("ENU", "ESD", "WSU", "WND"),
            "y": ("UEN", "DES", "UWS", "DWN"),
            "z": ("NUE", "SDE", "SUW", "NDW"),
        }[axis],
        azimuths_deg=(0.0, 180.0, 180.0, 0.0),
        durations_s=(1800.0,) * 4,
        repeatability_dps=1.3e-4,
        segments=tuple(f"zo_{axis}_{i}" for i in range(1, 5)),
    )


def _misalignment(key: str) -> MisalignmentResult:
    output, turned = key[0], key[1]
    common = 0.3
    return MisalignmentResult(
        output_axis=output,  # type: ignore[arg-type]
        turned_axis=turned,  # type: ignore[arg-type]
        L=L[key],
        turns=10,
        angle_positive_deg=common + L[key] * 3600,
        angle_negative_deg=common - L[key] * 3600,
        uncertainty=_uncertainty(U_L, 2.11),
        rate_dps=100.0,
        duration_s=41.0,
        segments=(f"ma_{turned}_p", f"ma_{turned}_n"),
    )


@pytest.fixture
def result() -> CalibrationResult:
    return sample_result()


def sample_result() -> CalibrationResult:
    """The sample's printed values with plausible uncertainties."""
    axes: tuple[AxisName, ...] = ("x", "y", "z")
    return CalibrationResult(
        procedure="jjf1536-2015",
        bundle_sha256=BUNDLE_SHA256,
        software="ahrs-lab 0.1.0",
        scale_factor={axis: _scale_factor(axis) for axis in axes},
        zero_offset={axis: _zero_offset(axis) for axis in axes},
        misalignment={key: _misalignment(key) for key in L},
        warnings=(ResultWarning(Message("The unit was warm"), "sf_x_00", 3),),
        deviations=(Message("The dwell is shorter"),),
        environment=Environment(20.3, 0.37, 47.0, 2.6),
        device={"serial_number": "0100012345", "sample_rate_hz": 100.0, "model": "VN-100"},
        site={"latitude_deg": 39.9042, "altitude_m": 50.0},
        notes={},
    )


def _standard(kind: str, zh: str, en: str, serial: str, accuracy: str, number: str) -> Standard:
    return Standard(
        kind=kind,  # type: ignore[arg-type]
        name=en,
        name_zh=zh,
        manufacturer="",
        model="DEMO-1",
        serial_number=serial,
        accuracy=accuracy,
        accuracy_zh="",
        certificate_number=number,
        due=date(2027, 3, 1),
    )


STANDARDS = (
    _standard(
        "table",
        "单轴位置速率转台",
        "Position and rate table",
        "T-0007",
        "U = 10″; Urel = 0.02 %",
        "NIM-26-0815",
    ),
    _standard("supply", "线性直流电源", "Linear DC supply", "P-0113", "Urel = 0.2 %", "NIM-26-0816"),
    _standard("fixture", "安装夹具", "Fixture", "F-0021", "垂直度 < 5″", "NIM-26-0821"),
)


@pytest.fixture
def job() -> JobSheet:
    return sample_job()


def sample_job() -> JobSheet:
    """A job sheet in both scripts."""
    return JobSheet(
        number="2026-0142",
        certificate_number="AL-2026-0142",
        laboratory=Party(
            "演示校准实验室",
            "演示市示例路 2 号",
            "Demonstration Calibration Laboratory",
            "2 Example Road, Demo City",
        ),
        customer=Party(
            "演示客户有限公司",
            "演示市示例路 1 号",
            "Demonstration Customer Ltd.",
            "1 Example Road, Demo City",
        ),
        device=DeviceUnderTest("捷联式惯性航姿仪", "VectorNav", "VN-100", "0100012345", "Strapdown AHRS"),
        operator=Person("演示校准员", "校准工程师", "Demonstration Operator", "Calibration engineer"),
        verifier=Person("演示核验员", "技术负责人", "Demonstration Verifier", "Technical manager"),
        approver=Person("演示签发人", "授权签字人", "Demonstration Approver", "Authorised signatory"),
        received=date(2026, 11, 20),
        calibrated=date(2026, 11, 22),
        issued=date(2026, 11, 23),
        place="惯性实验室 101",
        place_en="Inertial laboratory 101",
        standards=STANDARDS,
    )


@pytest.fixture(scope="session")
def certificates(tmp_path_factory: pytest.TempPathFactory) -> Mapping[CertificateLanguage, Path]:
    """The sample's certificate in every language, made once; not to be changed."""
    folder = tmp_path_factory.mktemp("certificates")
    languages: tuple[CertificateLanguage, ...] = ("bilingual", "zh", "en")
    return {
        language: certificate_pdf(sample_result(), sample_job(), folder / f"{language}.pdf", language)
        for language in languages
    }


@pytest.fixture
def demonstration_job(job: JobSheet) -> JobSheet:
    return replace(job, demonstration=True)
