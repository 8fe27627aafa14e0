"""The budgets as CSV: what was written is read back to the last bit, and nothing in it is calculated."""

from __future__ import annotations

import codecs
import csv
import io
import math
from dataclasses import replace
from pathlib import Path

import pytest

from ahrs_lab.errors import MachineError
from ahrs_lab.laboratory.budget_csv import COLUMNS, budget_csv, save_budget_csv
from ahrs_lab.messages import Message
from ahrs_lab.metrology.budgets import budgets_of
from ahrs_lab.metrology.result import CalibrationResult, Correlation, MonteCarloCheck, ScaleFactorResult
from ahrs_lab.metrology.uncertainty.budget import combine, from_half_width, type_a

CHECK = MonteCarloCheck(
    trials=200_000,
    seed=7,
    mean=1.0000001,
    standard=1.1e-5,
    symmetric=(0.99998, 1.00002),
    shortest=(0.999979, 1.000019),
    digits=2,
    tolerance=5e-7,
    validated=False,
    bins=(0.9, 1.1),
    counts=(1, 2, 3),
)


def result(symbol: str = "F", source: str = "Time base") -> CalibrationResult:
    rows = [
        type_a(symbol, Message(source), "deg/s", 1.0 / 3.0 * 1e-5, -0.3, 7.5, estimate=-1e-3),
        from_half_width("q", Message("Resolution of the output"), "1", 2e-5, 0.1, "assumption"),
    ]
    budget = replace(combine(rows, correlations=[Correlation(0, 1, -0.25)]), monte_carlo=CHECK)
    scale = ScaleFactorResult(
        axis="x",
        K=1.0023354972170277,
        F0=-6e-4,
        unit="(deg/s)/(deg/s)",
        rates_dps=(),
        demanded_rates_dps=(),
        means=(),
        residuals=(),
        static_before=0.0,
        static_after=0.0,
        nonlinearity_ppm=0.0,
        asymmetry_ppm=0.0,
        uncertainty=budget,
        F0_uncertainty=combine(rows[1:]),
    )
    return CalibrationResult("jjf1536-2015", "0" * 64, "ahrs-lab", scale_factor={"x": scale})


def lines(path: Path) -> list[dict[str, str]]:
    """As another program reads it: the first word of a heading is its name."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        first, *rest = csv.reader(file)
    names = [heading.split(" ")[0] for heading in first]
    assert all(len(line) == len(names) for line in rest)
    return [dict(zip(names, line, strict=True)) for line in rest]


def test_every_number_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    wanted = result()
    path = save_budget_csv(wanted, tmp_path / "out" / "budget.csv")
    assert path.read_bytes().startswith(codecs.BOM_UTF8)
    found = lines(path)
    assert list(found[0]) == list(COLUMNS)
    assert [(line["quantity"], line["line"].split(" ")[0]) for line in found] == [
        *(("K_x", name) for name in ("source", "source", "correlation", "combined", "monte-carlo")),
        *(("F0_x", name) for name in ("source", "combined")),
    ]
    budget = wanted.scale_factor["x"].uncertainty
    for line, row in zip(found, budget.rows, strict=False):
        assert (line["symbol"], line["unit"], line["type"]) == (row.symbol, row.unit, row.kind)
        assert line["source"] == row.source.text("en")
        assert line["source_zh"] == row.source.text("zh") != line["source"]
        assert float(line["u"]) == row.standard_uncertainty
        assert float(line["sensitivity"]) == row.sensitivity
        assert float(line["contribution"]) == row.contribution
        assert float(line["divisor"]) == row.divisor
        assert float(line["dof"]) == row.dof
        assert line["distribution"].split(" ")[0] == row.distribution
        assert line["origin"].split(" ")[0] == row.origin
    assert sum(float(line["share"]) for line in found[:2]) == pytest.approx(1.0)
    assert (found[2]["symbol"], float(found[2]["estimate"])) == ("r(F, q)", -0.25)
    total = found[3]
    assert float(total["estimate"]) == wanted.scale_factor["x"].K
    assert [float(total[name]) for name in ("u", "dof", "k", "U")] == [
        budget.standard, budget.dof, budget.coverage_factor, budget.expanded,
    ]  # fmt: skip
    check = found[4]
    assert (int(check["trials"]), int(check["seed"])) == (CHECK.trials, CHECK.seed)
    assert (float(check["symmetric_low"]), float(check["symmetric_high"])) == CHECK.symmetric
    assert (float(check["shortest_low"]), float(check["shortest_high"])) == CHECK.shortest
    assert check["validated"].split(" ")[0] == "no"
    assert total["from_monte_carlo"].split(" ")[0] == "no"
    assert math.isinf(float(found[5]["dof"]))
    assert found[5]["estimate"] == ""


def test_a_u_that_does_not_exist_is_a_dash_and_u_from_the_trials_is_said() -> None:
    found = result()
    scale = found.scale_factor["x"]
    check = replace(CHECK, standard=None, gum_expanded=1e-5)
    stated = replace(scale.uncertainty, expanded=2e-5, monte_carlo=check, from_monte_carlo=True)
    found = replace(found, scale_factor={"x": replace(scale, uncertainty=stated)})
    rows = [row for row in csv.DictReader(io.StringIO(budget_csv(found))) if row["quantity 被测量"] == "K_x"]
    total, checked = rows[-2:]
    assert total["from_monte_carlo U取自蒙特卡洛法"] == "yes 是"
    assert float(total["U 扩展不确定度"]) == 2e-5
    assert (checked["u 标准不确定度"], float(checked["U 扩展不确定度"])) == ("–", 1e-5)


@pytest.mark.parametrize("text", ["=1+1", "+1", "-cmd", "@SUM(A1)", " =1", "\t=1", "＝1"])
def test_texts_of_strangers_are_not_calculated(tmp_path: Path, text: str) -> None:
    found = lines(save_budget_csv(result(symbol=text, source=text), tmp_path / "b.csv"))[0]
    assert found["symbol"].startswith("'")
    assert found["source"].startswith("'")
    assert float(found["sensitivity"]) == -0.3  # a negative number is one


def test_a_text_of_several_lines_stays_in_its_cell() -> None:
    assert 'a b, ""c"' in budget_csv(result(source='a\nb, "c'))


def test_all_budgets_are_there_in_annex_c_order() -> None:
    assert [budget.name for budget in budgets_of(result())] == ["K_x", "F0_x"]
    assert [budget.unit for budget in budgets_of(result())] == ["(deg/s)/(deg/s)", "deg/s"]


def test_a_file_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(MachineError, match="Cannot write into"):
        save_budget_csv(result(), tmp_path / "file" / "budget.csv")
