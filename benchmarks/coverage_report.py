"""``docs/coverage.md`` and its picture from what :mod:`benchmarks.coverage` counted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import beta

if TYPE_CHECKING:
    from benchmarks.coverage import Configuration, Tally

GROUPS = ("K", "F0", "B", "L")
LOW, HIGH, LIMIT_RATIO = 94.0, 96.5, 1.05
NAMES = {
    "industrial-mems": "industrial MEMS",
    "tactical-fog": "tactical FOG",
    "navigation-rlg": "navigation RLG",
}
BEGIN, END = "<!-- table: begin -->", "<!-- table: end -->"

_Found = Mapping["Configuration", "Tally"]


def members(group: str) -> list[int]:
    """Places of a group's quantities."""
    from benchmarks.coverage import QUANTITIES

    return [place for place, name in enumerate(QUANTITIES) if name.partition("_")[0] == group]


def bounds(covered: int, count: int) -> tuple[float, float]:
    """Clopper–Pearson, 95 %, in per cent."""
    low = 0.0 if covered == 0 else float(beta.ppf(0.025, covered, count - covered + 1))
    high = 1.0 if covered == count else float(beta.ppf(0.975, covered + 1, count - covered))
    return 100.0 * low, 100.0 * high


def dominant(tally: Tally, group: str) -> tuple[str, float]:
    """The row that contributes most, and its share of the variance in per cent."""
    contributions = tally.sources[group]
    name, most = max(contributions.items(), key=lambda item: item[1])
    total = sum(contributions.values())
    return name, 100.0 * most / total if total else 0.0


def ratios(tally: Tally, group: str) -> tuple[float, float]:
    """Root mean square error over the statistical limit, and over the root mean square of u."""
    places = members(group)
    errors = math.sqrt(float(np.mean(tally.errors[:, places] ** 2)))
    limit = math.sqrt(float(np.mean(tally.limits[places] ** 2)))
    stated = math.sqrt(float(np.mean(tally.standard[:, places] ** 2)))
    return errors / limit, errors / stated


def lines_of(configuration: Configuration, tally: Tally) -> list[str]:
    """What the terminal shows."""
    count = len(tally.errors)
    name = f"{configuration.grade:16} {configuration.schedule:9} {configuration.world:12}"
    lines = []
    for group in GROUPS:
        each = " ".join(f"{100.0 * tally.covered[place] / count:.2f}" for place in members(group))
        (to_limit, to_stated), (source, share) = ratios(tally, group), dominant(tally, group)
        lines.append(
            f"{name} {group:3} {each}  rms/limit {to_limit:.3f}  rms/u {to_stated:.3f}  {source} {share:.0f}"
        )
    return [*lines, f"{name} {count} calibrations, {count / tally.seconds:.1f} a second"]


def write_report(docs: Path, found: _Found, count: int, seed: int) -> None:
    """Replace the table in ``coverage.md`` and draw the picture."""
    page = docs / "coverage.md"
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    page.write_text(f"{before}{BEGIN}\n{_table(found, count, seed)}{END}{after}", encoding="utf-8")
    (docs / "images" / "coverage.svg").write_text(_picture(found), encoding="utf-8")


def _table(found: _Found, count: int, seed: int) -> str:
    seconds = sum(tally.seconds for tally in found.values())
    reduced = sum(len(tally.errors) for tally in found.values())
    lines = [
        f"`python benchmarks/coverage.py --count {count} --seed {seed} --report`: {reduced} calibrations "
        f"made and reduced, {reduced / seconds:.0f} in a second of processor time.",
        "",
        "| unit, schedule | bench | | covered, % | lowest, highest | rms error / limit | rms error / u | "
        "largest source (share of u²) |",
        "|---|---|---|---|---|---|---|---|",
    ]
    lines += [_row(one, tally, group) for one, tally in found.items() for group in GROUPS]
    return "\n".join(lines) + "\n"


def _row(configuration: Configuration, tally: Tally, group: str) -> str:
    count = len(tally.errors)
    # without noise, what only errors of second order reach has no U that could hold them
    places = [place for place in members(group) if tally.expanded[:, place].any()]
    each = tally.covered[places]
    # the axes share the table's errors: together they count as one sample of ``count``
    mean = round(float(each.mean()))
    low, high = bounds(mean, count)
    to_limit, to_stated = ratios(tally, group)
    source, share = dominant(tally, group)
    source = source.replace("|", "\\|")
    symbol = {"F0": "F₀"}.get(group, group)
    limit = (
        ""
        if configuration.world == "bench alone"
        else f"{to_limit:.3f}"
        if to_limit < 10.0
        else f"{to_limit:.0f}"
    )
    return (
        f"| {NAMES[configuration.grade]}, {configuration.schedule} | {configuration.world} | {symbol} "
        f"| {100.0 * mean / count:.1f} ({low:.1f} to {high:.1f}) "
        f"| {100.0 * each.min() / count:.1f}, {100.0 * each.max() / count:.1f} "
        f"| {limit} | {to_stated:.3f} | {source} ({share:.0f} %) |"
    )


_ROW, _LEFT, _TOP, _WIDTH = 15.0, 250.0, 34.0, 460.0
_FROM, _TO = 92.0, 98.0


def _picture(found: _Found) -> str:
    """Coverage of each quantity, with its binomial bounds, against the aim."""
    rows = [
        (f"{NAMES[one.grade]}, {one.schedule}, {one.world}", group, tally)
        for one, tally in found.items()
        for group in GROUPS
    ]
    height = _TOP + _ROW * len(rows) + 30.0
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_LEFT + _WIDTH + 20:.0f}" height="{height:.0f}" '
        'font-family="sans-serif" font-size="10" fill="#333">',
        f'<rect width="{_LEFT + _WIDTH + 20:.0f}" height="{height:.0f}" fill="#fff"/>',
        f'<rect x="{_at(LOW):.1f}" y="{_TOP - 8:.1f}" '
        f'width="{_at(HIGH) - _at(LOW):.1f}" height="{_ROW * len(rows) + 8:.1f}" fill="#e6f0e6"/>',
        f'<text x="{_LEFT}" y="14">intervals that hold the truth, %, with binomial 95 % bounds; shaded: '
        f"{LOW:g} to {HIGH:g}</text>",
    ]
    for tick in range(int(_FROM), int(_TO) + 1):
        strong = "#888" if tick == 95 else "#ddd"
        parts.append(
            f'<path d="M{_at(tick):.1f} {_TOP - 8:.1f}V{height - 28:.1f}" stroke="{strong}"/>'
            f'<text x="{_at(tick):.1f}" y="{height - 14:.1f}" text-anchor="middle">{tick}</text>'
        )
    for index, (name, group, tally) in enumerate(rows):
        parts += _marks(_TOP + _ROW * (index + 0.5), name if group == GROUPS[0] else "", group, tally)
    return "\n".join([*parts, "</svg>", ""])


def _marks(y: float, name: str, group: str, tally: Tally) -> list[str]:
    places, count = members(group), len(tally.errors)
    rule = f'<path d="M4 {y - _ROW / 2:.1f}H{_LEFT + _WIDTH:.0f}" stroke="#bbb"/>' if name else ""
    parts = [
        f'{rule}<text x="4" y="{y + 3.5:.1f}">{name}</text>'
        f'<text x="{_LEFT - 22:.0f}" y="{y + 3.5:.1f}">{group}</text>'
    ]
    for number, place in enumerate(places):
        if not tally.expanded[:, place].any():
            continue
        covered = int(tally.covered[place])
        low, high = bounds(covered, count)
        line = y + (number - (len(places) - 1) / 2.0) * (_ROW - 4.0) / len(places)
        parts.append(
            f'<path d="M{_at(low):.1f} {line:.1f}H{_at(high):.1f}" stroke="#6a8fb5"/>'
            f'<circle cx="{_at(100.0 * covered / count):.1f}" cy="{line:.1f}" r="1.6" fill="#123f6d"/>'
        )
    return parts


def _at(percent: float) -> float:
    return _LEFT + _WIDTH * (min(max(percent, _FROM), _TO) - _FROM) / (_TO - _FROM)
