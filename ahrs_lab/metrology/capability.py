"""From the standards of a job to the bench's figures: certified where a certificate states them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from datetime import date
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import BenchCapability, Standard
from ahrs_lab.metrology.stated_figures import (
    CLAUSE_6_ONLY,
    FIGURES,
    RATE_FIGURES,
    FigureName,
    StatedFigure,
)
from ahrs_lab.metrology.uncertainty.bench_figure import BenchFigure


@dataclass(frozen=True)
class UsedFigure:
    """A stated figure with the standard and the certificate it stands in.

    ``valid``: the certificate has a number and had not run out. One that is not valid can only make a budget
    worse: its figure counts as an assumption, and only where it is larger than the assumption before.
    """

    stated: StatedFigure
    standard: str
    certificate: str
    valid: bool

    @property
    def bench(self) -> BenchFigure:
        """As a budget takes it, in the unit that the figure is used in."""
        certified = self.valid and bool(self.certificate.strip())
        return BenchFigure(
            half_width=self.stated.limit_or_expanded,
            divisor=self.stated.divisor,
            distribution=self.stated.budget_distribution,
            dof=self.stated.dof,
            origin="certificate" if certified else "assumption",
            certificate=self.certificate if certified else "",
        )


@dataclass(frozen=True)
class StatedCapability(BenchCapability):
    """Figures of the bench of which some are stated by the standards' certificates.

    The fields that are stated hold twice their standard uncertainty; :meth:`figure` knows them as they are
    stated.
    """

    stated: tuple[UsedFigure, ...] = ()

    def figure(self, name: str, band: int = 0) -> BenchFigure:
        """As the certificate states it, else the assumption."""
        wanted = RATE_FIGURES[band] if name == "rate_relative" else name
        for used in self.stated:
            if used.stated.figure == wanted:
                return used.bench
        return super().figure(name, band)


def capability_of(
    standards: Sequence[Standard], on_date: date | None = None, base: BenchCapability | None = None
) -> BenchCapability:
    """The bench's figures with these standards; ``base`` (default: clause 6's own) where none is stated.

    Raises InputError for a figure that two certificates state, or one that its standard cannot have.
    """
    for message in figure_conflicts(standards):
        raise InputError(message)
    capability = base or BenchCapability()
    return with_figures(
        capability,
        tuple(
            used
            for used in _used(standards, on_date)
            if used.valid or used.bench.standard > _assumed(capability, used.stated.figure).standard
        ),
    )


def with_figures(base: BenchCapability, used: tuple[UsedFigure, ...]) -> BenchCapability:
    """``base`` with the figures ``used`` instead of its own."""
    if not used:
        return base
    doubles: dict[str, float] = {one.stated.figure: one.bench.double for one in used}
    rates = tuple(
        doubles.pop(name, before) for name, before in zip(RATE_FIGURES, base.rate_relative, strict=True)
    )
    before = {entry.name: getattr(base, entry.name) for entry in fields(BenchCapability)}
    values: dict[str, Any] = {**before, **doubles, "rate_relative": rates}
    return StatedCapability(**values, stated=used)


def figure_conflicts(standards: Sequence[Standard]) -> tuple[Message, ...]:
    """What of the figures cannot be used: stated twice, or by a standard of another kind."""
    found: list[Message] = []
    first: dict[FigureName, Standard] = {}
    for standard in standards:
        for stated in standard.figures:
            figure = FIGURES[stated.figure]
            if standard.kind not in figure.kinds:
                found.append(
                    Message(
                        "{name} s/n {serial_number} cannot state the figure “{figure}”: enter it with the "
                        "standard whose certificate states it.",
                        figure=figure.name,
                        **_named(standard),
                    )
                )
            elif stated.figure in first:
                found.append(_twice(figure.name, first[stated.figure], standard))
            else:
                first[stated.figure] = standard
    return tuple(found)


def _twice(name: Message, first: Standard, second: Standard) -> Message:
    if first is second:
        return Message(
            "{name} s/n {serial_number} states the figure “{figure}” twice: keep the one that is used.",
            figure=name,
            **_named(first),
        )
    return Message(
        "{name} s/n {serial_number} and {other} s/n {other_number} both state the figure “{figure}”: take it "
        "out of one of them, or leave that standard out of the job.",
        figure=name,
        other=second.name,
        other_number=second.serial_number,
        **_named(first),
    )


def _named(standard: Standard) -> dict[str, str]:
    return {"name": standard.name, "serial_number": standard.serial_number}


def _used(standards: Sequence[Standard], on_date: date | None) -> Iterator[UsedFigure]:
    for standard in standards:
        number = standard.certificate_number.strip()
        in_date = standard.due is not None and (on_date is None or standard.due >= on_date)
        for stated in (one for one in standard.figures if one.figure not in CLAUSE_6_ONLY):
            yield UsedFigure(
                stated, f"{standard.name} s/n {standard.serial_number}", number, bool(number) and in_date
            )


def _assumed(capability: BenchCapability, name: FigureName) -> BenchFigure:
    if name in RATE_FIGURES:
        return capability.figure("rate_relative", RATE_FIGURES.index(name))
    return capability.figure(name)
