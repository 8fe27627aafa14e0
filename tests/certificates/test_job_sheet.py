"""JOB.toml: what is right is read whole, what is wrong is refused with its place."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.certificates.job_sheet import JobSheet, load_job_sheet
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.demonstration import REQUIREMENTS
from ahrs_lab.metrology.best_capability import BestCapability
from ahrs_lab.metrology.conformity import DecisionRule
from ahrs_lab.metrology.declared_place import DeclaredPlace
from ahrs_lab.metrology.limits import Limit
from ahrs_lab.metrology.requirements import ResultUnits
from ahrs_lab.resource_files import resource_path

DEMO = resource_path("jobs/demo.toml")


def read(tmp_path: Path, text: str) -> JobSheet:
    path = tmp_path / "JOB.toml"
    path.write_text(text, encoding="utf-8")
    return load_job_sheet(path)


def changed(old: str, new: str) -> str:
    text = DEMO.read_text(encoding="utf-8")
    assert old in text
    return text.replace(old, new, 1)


def test_the_demonstration_sheet_is_read_whole() -> None:
    job = load_job_sheet(DEMO)
    assert job.certificate_number == "AL-2026-0142"
    assert job.calibrated == date(2026, 11, 22)
    assert job.issued is None
    assert [standard.kind for standard in job.standards] == ["table", "supply", "fixture", "room"]
    assert job.standards[0].due == date(2027, 9, 1)
    assert job.capability.rate_relative == (2e-2, 2e-3, 2e-4)
    assert job.capability.origin("position_arcsec") == "certificate"
    assert job.requirements == REQUIREMENTS
    assert job.approver.position_en == "Authorised signatory"
    assert job.recalibration_months == 24
    assert job.demonstration
    assert job.declared_place == DeclaredPlace(1.0, True)
    assert not job.budget_annex


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('number = "2026-0142"', "", "“number” is missing"),
        ('number = "2026-0142"', "number = 142", "“number” must be a text in quotation marks"),
        ('number = "2026-0142"', 'number = "  "', "“number” must be a text that is not empty"),
        ('number = "2026-0142"', r'number = "a\u0007b"', "“number” must be one line of printable"),
        ("received = 2026-11-20", 'received = "2026-11-20"', "“received” must be a date without"),
        ("received = 2026-11-20", "received = 2026-11-20T08:00:00", "“received” must be a date without"),
        ("received = 2026-11-20", "received = 2026-11-25", "“calibrated” (2026-11-22) is before"),
        ('rounding = "half-even"', 'rounding = "down"', "“rounding” must be one of half-even, up"),
        ("demonstration = true", "demonstration = 1", "“demonstration” must be true or false"),
        ("budget_annex = false", 'budget_annex = "yes"', "“budget_annex” must be true or false"),
        ("earth_resistance_ohm = 1.0", "earth_resistance_ohm = -1", "earth_resistance_ohm” must be a number"),
        ("isolated_foundation = true", "isolated_foundation = 1", "“laboratory.place.isolated_foundation”"),
        ("isolated_foundation = true", "isolated = true", "“laboratory.place.isolated” is not known here"),
        ("recalibration_months = 24", "recalibration_months = 0", "a whole number from 1 to 120"),
        ("recalibration_months = 24", "recalibration_months = true", "a whole number from 1 to 120"),
        ("[customer]", "[custumer]", "“customer” is missing"),
        ('name_en = "Strapdown AHRS"', 'nam_en = "AHRS"', "“device.nam_en” is not known here"),
        ('kind = "supply"', 'kind = "power"', "“standard[2].kind” must be one of table, supply"),
        ('serial_number = "P-0113"', "", "“standard[2].serial_number” is missing"),
        ("due = 2027-09-01", 'due = "soon"', "“standard[1].due” must be a date"),
        ("[people.approver]", "[people.signer]", "“people.approver” is missing"),
        (
            "level_arcsec = 20.0",
            "rate_relative = [2e-2, 2e-3]",
            "“capability.rate_relative” must be a list",
        ),
        (
            "level_arcsec = 20.0",
            "rate_relative = [2e-2, nan, 2e-4]",
            "“capability.rate_relative” must be a number",
        ),
        ("level_arcsec = 20.0", "level_arcsec = -1", "“capability.level_arcsec” must be a number"),
        (
            "level_arcsec = 20.0",
            'level_arcsec = 20.0\ncertified = ["level_arcsec"]',
            "“capability.certified” must be left out: enter each figure as [[standard.figure]]",
        ),
        ('# seal = "seal.png"', 'seal = "/etc/passwd" #', "“seal” must be the name of a PNG image"),
        ('quantity = "K"', 'quantity = "Q"', "“limit[1].quantity” must be one of K, K_x"),
        ('unit = "ppm"', 'unit = "rad"', "“limit[1].unit” must be one of 1, (rad/s)"),
        ("nominal = 1.0", "", "“limit[1]”: The limit of K is relative"),
        ("low = -30.0", "low = 31", "“limit[2]”: The limit of B goes from 31 to 30:"),
        ("low = -30.0", "low = nan", "“limit[2].low” must be a number"),
        ("low = -30.0", 'low = "-20"', "“limit[2].low” must be a number"),
        ('quantity = "L"', 'quantity = "B"', "“limit[3].unit” must be one of deg/h"),
        ('quantity = "L"\nlow', 'quantity = "L"\nlo', "“limit[3].lo” is not known here"),
        ('kind = "guard-band"', 'kind = "guard"', "“decision_rule.kind” must be one of simple"),
        ("r = 1.0", "r = 0", "“decision_rule”: The guard band is w = r·U"),
        ("K = 1e-5", "K = -1e-5", "“laboratory.capability.K” must be a number, not negative"),
        ("K = 1e-5", "Q = 1e-5", "“laboratory.capability.Q” is not known here"),
        ("# [units]", '[units]\nzero_offset = "rpm"', "“units.zero_offset” must be one of deg/s, deg/h"),
        (
            "# [units]",
            "[uncertainty]\ninclude_repeatability = 1",
            "“uncertainty.include_repeatability” must be",
        ),
        ("notes = []", 'notes = "none"', "“notes” must be a list of at most"),
        ('format = "ahrs-lab-job"', 'format = "other"', "is not a job sheet"),
        ("version = 1", "version = 2", "“version” must be a whole number from 1 to 1"),
        ("version = 1", "version = ", "is not valid TOML"),
    ],
)
def test_a_defect_is_named_with_its_place(tmp_path: Path, old: str, new: str, says: str) -> None:
    with pytest.raises(InputError) as refused:
        read(tmp_path, changed(old, new))
    assert says in str(refused.value)
    assert str(refused.value).startswith("JOB.toml")
    assert "\n" not in refused.value.message.text("zh")


def test_limits_rule_units_and_capability_are_read(tmp_path: Path) -> None:
    job = read(tmp_path, changed("# [units]", '[units]\nzero_offset = "deg/h"'))
    asked = job.requirements
    assert asked.limits[0] == Limit("K", -5000.0, 5000.0, "ppm", nominal=1.0)
    assert [one.quantity for one in asked.limits] == ["K", "B", "L"]
    assert asked.rule == DecisionRule("guard-band", 1.0, probability=True)
    assert asked.units == ResultUnits(zero_offset="deg/h")
    assert job.best_capability == BestCapability(1e-5, 1e-5, 1e-6)


def test_two_limits_of_one_quantity_are_refused(tmp_path: Path) -> None:
    again = '[[limit]]\nquantity = "B"\nhigh = 1.0\nunit = "deg/s"\n\n[decision_rule]'
    with pytest.raises(InputError, match="B has two limits"):
        read(tmp_path, changed("[decision_rule]", again))


def test_a_text_of_endless_length_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="at most 500 characters"):
        read(tmp_path, changed('"2026-0142"', '"' + "9" * 501 + '"'))


def test_other_encodings_missing_and_huge_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "JOB.toml"
    with pytest.raises(InputError, match="cannot be read"):
        load_job_sheet(path)
    path.write_bytes(DEMO.read_text(encoding="utf-8").encode("gb18030"))
    with pytest.raises(InputError, match="not UTF-8"):
        load_job_sheet(path)
    path.write_bytes(b"#" * 1_000_001)
    with pytest.raises(InputError, match="too large"):
        load_job_sheet(path)


def test_a_seal_beside_the_sheet_is_found(tmp_path: Path) -> None:
    (tmp_path / "seal.png").write_bytes(resource_path("seal/demo-seal.png").read_bytes())
    job = read(tmp_path, changed('# seal = "seal.png"', 'seal = "seal.png" #'))
    assert job.seal == tmp_path / "seal.png"


@given(st.binary(max_size=300))
def test_arbitrary_bytes_are_refused_and_never_crash(
    tmp_path_factory: pytest.TempPathFactory, data: bytes
) -> None:
    path = tmp_path_factory.mktemp("job") / "JOB.toml"
    path.write_bytes(data)
    with pytest.raises(InputError):
        load_job_sheet(path)


@given(st.integers(0, 60), st.sampled_from(["1", "[]", "{}", '"x"', "2026-01-01", "nan", "true"]))
def test_any_value_of_the_wrong_kind_is_refused_or_read(
    tmp_path_factory: pytest.TempPathFactory, line: int, value: str
) -> None:
    text = DEMO.read_text(encoding="utf-8").splitlines()
    settings = [i for i, one in enumerate(text) if "=" in one and not one.startswith("#")]
    at = settings[line % len(settings)]
    text[at] = text[at].split("=")[0] + "= " + value
    path = tmp_path_factory.mktemp("job") / "JOB.toml"
    path.write_text("\n".join(text), encoding="utf-8")
    try:
        job = load_job_sheet(path)
    except InputError:
        return
    assert isinstance(job, JobSheet)


@pytest.mark.parametrize("number", ["1" + "0" * 5000, "1" + "0" * 400, "inf", "nan", "-1"])
def test_a_number_that_cannot_be_is_refused(tmp_path: Path, number: str) -> None:
    with pytest.raises(InputError):
        read(tmp_path, changed("level_arcsec = 20.0", f"level_arcsec = {number}"))


def test_a_place_that_is_not_declared_is_not_made_up(tmp_path: Path) -> None:
    place = "earth_resistance_ohm = 1.0               # Ω, has to be below 4; left out: not declared\n"
    assert read(tmp_path, changed(place, "")).declared_place == DeclaredPlace(None, True)
    text = changed(place, "").replace("[laboratory.place]\nisolated_foundation = true", "")
    assert read(tmp_path, text).declared_place == DeclaredPlace()
