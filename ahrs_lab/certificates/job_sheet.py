"""Everything of a certificate that is not a measured number: laboratory, customer, device, standards, people,
dates. Read from ``JOB.toml`` (see ``load_job_sheet``) or made from the records by the laboratory.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import date
from pathlib import Path
from typing import Literal

from ahrs_lab.metrology.best_capability import BestCapability
from ahrs_lab.metrology.conditions import BenchCapability, Standard
from ahrs_lab.metrology.declared_place import DeclaredPlace
from ahrs_lab.metrology.requirements import Requirements

CertificateLanguage = Literal["bilingual", "zh", "en"]


@dataclass(frozen=True)
class Party:
    """A laboratory or a customer, in both scripts; an empty ``name_en`` falls back to ``name``."""

    name: str
    address: str
    name_en: str = ""
    address_en: str = ""


@dataclass(frozen=True)
class Person:
    """Who certifies: operator (校准员), verifier (核验员) or approver (签发人)."""

    name: str
    position: str = ""
    name_en: str = ""
    position_en: str = ""


@dataclass(frozen=True)
class DeviceUnderTest:
    """被校对象 (clause 8 f)."""

    name: str
    manufacturer: str
    model: str
    serial_number: str
    name_en: str = ""


@dataclass(frozen=True)
class JobSheet:
    """One job. ``requirements``: limits, decision rule and units that the customer asked for; ``notes`` are
    printed as given."""

    number: str
    certificate_number: str
    laboratory: Party
    customer: Party
    device: DeviceUnderTest
    operator: Person
    verifier: Person
    approver: Person
    received: date
    calibrated: date
    issued: date | None = None
    place: str = ""
    place_en: str = ""
    standards: tuple[Standard, ...] = ()
    capability: BenchCapability = field(default_factory=BenchCapability)
    procedure: str = "JJF 1536—2015 捷联式惯性航姿仪校准规范"
    procedure_en: str = "JJF 1536-2015 Calibration Specification for Strapdown Inertial Flight Attitudes"
    recalibration_months: int = 24
    requirements: Requirements = field(default_factory=Requirements)
    best_capability: BestCapability = field(default_factory=BestCapability)
    """Of the laboratory: no U is reported below it."""
    rounding: Literal["half-even", "up"] = "half-even"
    uncertainty_method: Literal["gum", "annex-a"] = "gum"
    notes: tuple[str, ...] = ()
    declared_place: DeclaredPlace = field(default_factory=DeclaredPlace)
    """Of the laboratory, where the recording holds none."""
    accepted_violations: tuple[str, ...] = ()
    """Violations of clause 6 with the reason and the second person who accepted them; printed."""
    demonstration: bool = False
    budget_annex: bool = False
    """Whether every uncertainty budget is printed in full on annex pages."""
    seal: Path | None = None
    """Image (PNG) of the laboratory's calibration seal (clause 8 d); in JOB.toml relative to the file."""


def load_job_sheet(path: Path) -> JobSheet:
    """Read a ``JOB.toml``.

    Raises:
        InputError: what is wrong, at which key, and what to write instead.
    """
    from ahrs_lab.certificates.job_sheet_file import read_job_sheet

    return read_job_sheet(path)
