"""Stated figures and the bench's capability as JSON: in the records, in a recording's header, in a result."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.capability import StatedCapability, UsedFigure
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.json_reader import JsonReader
from ahrs_lab.metrology.stated_figures import FIGURES, LIMITS, StatedFigure

NOTE = "capability"
"""The key of a recording's and a result's notes that says which figures of the bench were used."""


def figure_to_json(figure: StatedFigure) -> dict[str, Any]:
    """What it says, without what it leaves out."""
    data: dict[str, Any] = {"figure": figure.figure, "value": figure.value, "unit": figure.unit}
    if figure.coverage_factor is not None:
        data["k"] = figure.coverage_factor
    else:
        data["distribution"] = figure.distribution
    if math.isfinite(figure.dof):
        data["dof"] = figure.dof
    return data


def figure_from_json(reader: JsonReader) -> StatedFigure:
    """Raises InputError where it is none."""
    return StatedFigure(
        figure=reader.choice("figure", FIGURES),
        value=reader.number("value"),
        unit=reader.text("unit"),
        coverage_factor=reader.optional_number("k"),
        distribution=reader.choice("distribution", ("normal", *LIMITS), "normal"),
        dof=reader.number("dof") if reader.has("dof") else math.inf,
    )


def figures_text(figures: Iterable[StatedFigure]) -> str:
    """As the records keep them; "" for none."""
    listed = [figure_to_json(figure) for figure in figures]
    return json.dumps(listed, allow_nan=False) if listed else ""


def figures_from_text(text: str, owner: str) -> tuple[StatedFigure, ...]:
    """The inverse; ``owner`` is whose figures they are, for the message."""
    if not text:
        return ()
    try:
        return tuple(
            figure_from_json(entry) for entry in JsonReader({"figures": json.loads(text)}).objects("figures")
        )
    except (ValueError, RecursionError) as error:
        reason: object = error
    except InputError as error:
        reason = error.message
    raise InputError(
        "The figures of {name} in the records cannot be used ({reason}): enter them again.",
        name=owner,
        reason=reason if isinstance(reason, Message) else str(reason),
    )


def capability_to_json(capability: BenchCapability) -> dict[str, Any]:
    """All its figures; an acquisition without known bits is left out."""
    data: dict[str, Any] = {
        entry.name: getattr(capability, entry.name)
        for entry in fields(BenchCapability)
        if entry.name not in ("rate_relative", "certified") and getattr(capability, entry.name) is not None
    }
    data["rate_relative"] = list(capability.rate_relative)
    data["certified"] = list(capability.certified)
    if isinstance(capability, StatedCapability):
        data["stated"] = [
            {
                **figure_to_json(used.stated),
                "standard": used.standard,
                "certificate": used.certificate,
                "valid": used.valid,
            }
            for used in capability.stated
        ]
    return data


def capability_from_json(data: object) -> BenchCapability:
    """Raises InputError where a figure is not what it has to be."""
    reader = JsonReader(data, NOTE)
    known = BenchCapability()
    rates = reader.numbers("rate_relative", known.rate_relative)
    if len(rates) != len(known.rate_relative):
        raise reader.fault("rate_relative", Message("three numbers"))
    values: dict[str, Any] = {
        entry.name: reader.optional_number(entry.name)
        if entry.name == "acquisition_bits"
        else reader.number(entry.name, getattr(known, entry.name))
        for entry in fields(BenchCapability)
        if entry.name not in ("rate_relative", "certified")
    }
    for name, value in [*values.items(), *(("rate_relative", rate) for rate in rates)]:
        if value is not None and value < 0.0:
            raise reader.fault(name, Message("a number, not negative"))
    values.update(rate_relative=rates, certified=reader.texts("certified"))
    used = tuple(_used(entry) for entry in reader.objects("stated"))
    return StatedCapability(**values, stated=used) if used else BenchCapability(**values)


def _used(reader: JsonReader) -> UsedFigure:
    return UsedFigure(
        stated=figure_from_json(reader),
        standard=reader.text("standard"),
        certificate=reader.text("certificate"),
        valid=reader.value("valid") is True,
    )


def noted_capability(notes: Mapping[str, Any]) -> BenchCapability | None:
    """The figures that the notes of a recording or a result name, or None."""
    return capability_from_json(notes[NOTE]) if NOTE in notes else None


def with_capability(notes: Mapping[str, Any], capability: BenchCapability) -> dict[str, Any]:
    """``notes`` saying which figures were used; clause 6's own need no saying."""
    said = {key: value for key, value in notes.items() if key != NOTE}
    if capability != BenchCapability():
        said[NOTE] = capability_to_json(capability)
    return said


def stated_figures(capability: BenchCapability | None) -> tuple[UsedFigure, ...]:
    """Those that certificates state."""
    return capability.stated if isinstance(capability, StatedCapability) else ()
