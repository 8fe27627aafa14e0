"""JOB.toml: the figures that the standards' certificates state."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ahrs_lab.certificates.job_sheet import JobSheet, load_job_sheet
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.capability import StatedCapability
from ahrs_lab.metrology.stated_figures import StatedFigure
from ahrs_lab.resource_files import resource_path

WOBBLE = '[[standard.figure]]\nfigure = "wobble_arcsec"\nU = 1.2\nk = 2.3\ndof = 9\n'
SQUARE = '[[standard.figure]]\nfigure = "fixture_perpendicularity_arcsec"\nlimit = 0.05\nunit = "arcmin"\n'
STATED = re.compile(r"^\[\[standard\.figure\]\]\n(?:.+\n)+?(?=\[|\n)", re.MULTILINE)
BENCH = "\n[capability]\nposition_arcsec = 10.0\n"
DUE = 'due = 2027-09-01\ntraceability = "Demonstration"\n'


def read(tmp_path: Path, figures: str, *, capability: bool = False, due: str = DUE) -> JobSheet:
    """The demonstration's sheet with nothing but ``figures`` of its first standard, and a [capability]."""
    text = resource_path("jobs/demo.toml").read_text(encoding="utf-8")
    assert DUE in text
    head, count = STATED.subn("", text.split("\n[capability]")[0])
    assert count == 7
    text = head.replace(DUE, due + figures, 1) + (BENCH if capability else "")
    path = tmp_path / "JOB.toml"
    path.write_text(text, encoding="utf-8")
    return load_job_sheet(path)


def test_figures_are_read_and_enter_the_capability(tmp_path: Path) -> None:
    job = read(tmp_path, WOBBLE)
    stated = StatedFigure("wobble_arcsec", 1.2, "arcsec", 2.3, dof=9.0)
    assert job.standards[0].figures == (stated,)
    assert isinstance(job.capability, StatedCapability)
    figure = job.capability.figure("wobble_arcsec")
    assert (figure.divisor, figure.origin, figure.certificate) == (2.3, "certificate", "DEMO-26-0815")
    assert job.capability.origin("position_arcsec") == "assumption"


def test_a_limit_and_another_unit_are_read(tmp_path: Path) -> None:
    job = read(tmp_path, SQUARE.replace("fixture_perpendicularity", "level"))
    (stated,) = job.standards[0].figures
    assert (stated.distribution, stated.coverage_factor) == ("rectangular", None)
    assert stated.limit_or_expanded == pytest.approx(3.0)


def test_the_table_of_the_bench_stays_beside_the_figures(tmp_path: Path) -> None:
    job = read(tmp_path, WOBBLE, capability=True)
    assert job.capability.origin("position_arcsec") == "assumption"
    assert job.capability.figure("position_arcsec").certificate == ""
    assert job.capability.figure("wobble_arcsec").certificate == "DEMO-26-0815"


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("U = 1.2\n", "", "“standard[1].figure[1].U” is missing; add it"),
        ("k = 2.3\n", "", "“standard[1].figure[1].k” is missing; add it"),
        ("k = 2.3", "k = 0", "“standard[1].figure[1].k” must be a number above 0"),
        ("k = 2.3", "k = -2", "“standard[1].figure[1].k” must be a number, not negative"),
        ("k = 2.3", "k = 500", "“standard[1].figure[1]”: The figure"),
        ("U = 1.2", "U = 0", "“standard[1].figure[1].U” must be a number above 0"),
        ("U = 1.2", "U = nan", "“standard[1].figure[1].U” must be a number"),
        ("U = 1.2", "U = inf", "“standard[1].figure[1].U” must be a number"),
        ("U = 1.2", 'U = "1.2″"', "“standard[1].figure[1].U” must be a number"),
        ("dof = 9", "dof = 0", "less than one degree of freedom"),
        ("dof = 9", "dof = 9\nunit = 'kg'", "“standard[1].figure[1].unit” must be one of arcsec"),
        ("dof = 9", "dof = 9\nlimit = 2", "“standard[1].figure[1].limit” must be left out where U"),
        ("dof = 9", "dof = 9\ndistribution = 'rectangular'", "distribution” must be one of normal"),
        ("dof = 9", "ndof = 9", "“standard[1].figure[1].ndof” is not known here"),
        ("wobble_arcsec", "speed", "“standard[1].figure[1].figure” must be one of rate_relative_below_1"),
        ("wobble_arcsec", "azimuth_arcsec", "cannot state the figure “azimuth reference (north)”"),
        ("[[standard.figure]]", "[standard.figure]", "must be at most 100 tables"),
        (WOBBLE, WOBBLE + WOBBLE, "states the figure “wobble of the table's axis” twice"),
    ],
)
def test_a_figure_with_a_defect_is_named(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert old in WOBBLE
    with pytest.raises(InputError) as refused:
        read(tmp_path, WOBBLE.replace(old, new))
    assert says in str(refused.value)
    assert str(refused.value).startswith("JOB.toml")
    assert "\n" not in refused.value.message.text("zh")


def test_figures_need_the_certificates_date(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"“standard\[1\].due” is missing"):
        read(tmp_path, WOBBLE, due="")


def test_a_figure_is_not_said_in_the_bench_table_too(tmp_path: Path) -> None:
    twice = WOBBLE.replace("wobble_arcsec", "position_arcsec")
    with pytest.raises(InputError, match=r"“capability.position_arcsec” must be left out: standard\[1\]"):
        read(tmp_path, twice, capability=True)
