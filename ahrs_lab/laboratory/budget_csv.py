"""All uncertainty budgets of a result as one CSV file for a spreadsheet: every source, the sums, the Monte
Carlo checks, in full precision.

Headings and codes are the English word, a space, the Chinese: a program takes the first word. Texts may come
from files of anybody, so a cell that a spreadsheet would calculate begins with an apostrophe.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path

from ahrs_lab.laboratory.evaluation import OutputFolder
from ahrs_lab.metrology.budgets import QuantityBudget, budgets_of
from ahrs_lab.metrology.result import BudgetRow, CalibrationResult, Correlation, MonteCarloCheck
from ahrs_lab.metrology.uncertainty.budget import shares

COLUMNS = {
    "quantity": "被测量",
    "line": "行别",
    "symbol": "符号",
    "source": "来源（英文）",
    "source_zh": "来源（中文）",
    "unit": "单位",
    "estimate": "估计值",
    "half_width": "半宽或U",
    "distribution": "分布",
    "divisor": "除数",
    "u": "标准不确定度",
    "type": "类别",
    "dof": "自由度",
    "sensitivity": "灵敏系数",
    "contribution": "不确定度分量",
    "share": "方差占比",
    "origin": "依据",
    "shared": "共用的估计",
    "method": "评定方法",
    "k": "包含因子",
    "U": "扩展不确定度",
    "trials": "试验次数",
    "seed": "随机数种子",
    "symmetric_low": "对称区间下限",
    "symmetric_high": "对称区间上限",
    "shortest_low": "最短区间下限",
    "shortest_high": "最短区间上限",
    "tolerance": "容差δ",
    "validated": "是否得到验证",
    "from_monte_carlo": "U取自蒙特卡洛法",
}
_CODES = {
    "source": "来源",
    "correlation": "相关系数",
    "combined": "合成",
    "monte-carlo": "蒙特卡洛法",
    "normal": "正态",
    "rectangular": "矩形",
    "triangular": "三角",
    "arcsine": "反正弦",
    "t": "t分布",
    "data": "记录数据",
    "certificate": "证书",
    "assumption": "假定",
    "gum": "GUM",
    "annex-a": "附录A",
    "yes": "是",
    "no": "否",
}
_NONE = "–"
"""For a number that does not exist, not one that is left out."""
_CALCULATES = "=+-@＝＋－＠"
_Value = str | float | int | None


def budget_csv(result: CalibrationResult) -> str:
    """A line for each source of each quantity, then its correlations, its sum and its Monte Carlo check.

    Contribution, sum and intervals are in the quantity's unit, which stands in the sum line; u of a source is
    in the source's own. U in the line of a check is the GUM's, which was tested.
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow([f"{name} {chinese}" for name, chinese in COLUMNS.items()])
    for budget in budgets_of(result):
        for line in _lines(budget):
            writer.writerow([_cell(line.get(name)) for name in COLUMNS])
    return text.getvalue()


def save_budget_csv(result: CalibrationResult, target: Path) -> Path:
    """Write it as UTF-8 with a mark that tells Excel so, whole or not at all; raises MachineError."""
    with OutputFolder(target.parent):
        partial = target.with_name(target.name + ".part")
        partial.write_bytes(budget_csv(result).encode("utf-8-sig"))
        partial.replace(target)
    return target


def _lines(budget: QuantityBudget) -> Iterator[dict[str, _Value]]:
    found = budget.uncertainty
    head = {"quantity": budget.name}
    for row, share in zip(found.rows, shares(found), strict=True):
        yield {**head, **_source(row), "share": share}
    for entry in found.correlations:
        yield {**head, **_correlation(found.rows, entry)}
    yield {
        **head,
        "line": _code("combined"),
        "unit": _text(budget.unit),
        "estimate": budget.value,
        "u": found.standard,
        "dof": found.dof,
        "method": _code(found.method),
        "k": found.coverage_factor,
        "U": found.expanded,
        "from_monte_carlo": _code("yes" if found.from_monte_carlo else "no"),
    }
    if found.monte_carlo is not None:
        yield {**head, "unit": _text(budget.unit), **_monte_carlo(found.monte_carlo)}


def _source(row: BudgetRow) -> dict[str, _Value]:
    return {
        "line": _code("source"),
        "symbol": _text(row.symbol),
        "source": _text(row.source.text("en")),
        "source_zh": _text(row.source.text("zh")),
        "unit": _text(row.unit),
        "estimate": row.estimate,
        "half_width": row.half_width,
        "distribution": _code(row.distribution),
        "divisor": row.divisor,
        "u": row.standard_uncertainty,
        "type": row.kind,
        "dof": row.dof,
        "sensitivity": row.sensitivity,
        "contribution": row.contribution,
        "origin": _code(row.origin),
        "shared": _text(row.shared),
    }


def _correlation(rows: tuple[BudgetRow, ...], entry: Correlation) -> dict[str, _Value]:
    return {
        "line": _code("correlation"),
        "symbol": _text(f"r({rows[entry.first].symbol}, {rows[entry.second].symbol})"),
        "unit": "1",
        "estimate": entry.coefficient,
    }


def _monte_carlo(check: MonteCarloCheck) -> dict[str, _Value]:
    return {
        "line": _code("monte-carlo"),
        "estimate": check.mean,
        "u": _NONE if check.standard is None else check.standard,
        "U": check.gum_expanded,
        "trials": check.trials,
        "seed": check.seed,
        "symmetric_low": check.symmetric[0],
        "symmetric_high": check.symmetric[1],
        "shortest_low": check.shortest[0],
        "shortest_high": check.shortest[1],
        "tolerance": check.tolerance,
        "validated": _code("yes" if check.validated else "no"),
    }


def _code(code: str) -> str:
    return f"{code} {_CODES[code]}"


def _cell(value: _Value) -> str:
    """Numbers so that reading them gives the same number."""
    if value is None:
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)


def _text(text: str) -> str:
    """One line that no spreadsheet takes for a formula."""
    line = "".join(c if c.isprintable() else " " for c in text)
    return f"'{line}" if line.lstrip()[:1] in tuple(_CALCULATES) else line
