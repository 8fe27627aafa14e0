"""What the reduction says of a recording beside its numbers: nothing of a good one, the segment of a bad."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.result_json import from_json_text, to_json_text
from ahrs_lab.procedures.reduction import reduce_recording
from ahrs_lab.recording.read import RecordedSegment
from tests.procedures.virtual_unit import VirtualUnit, changed

DENSITY = 2.5e-3
"""0.15 °/√h in °/√s."""


def noisy(seed: int = 1, **settings: object) -> VirtualUnit:
    return VirtualUnit(density=DENSITY, rng=np.random.default_rng(seed), **settings)  # type: ignore[arg-type]


def moved(recorded: RecordedSegment, by_dps: float) -> RecordedSegment:
    return changed(recorded, gyro_x=recorded.samples["gyro_x"] + by_dps)


def diagnosed(result: CalibrationResult) -> list[str]:
    return [warning.what.text() for warning in result.warnings]


def test_a_good_recording_warns_of_nothing() -> None:
    unit = noisy(K=(1.001, 0.999, 1.0), L={"yx": 1e-3})
    result = reduce_recording(unit.standard())
    assert not result.warnings
    assert result.diagnosis is not None
    assert set(result.diagnosis.scale_factor) == set(result.diagnosis.zero_offset) == {"x", "y", "z"}
    assert set(result.diagnosis.misalignment) == set(result.misalignment)
    assert from_json_text(to_json_text(result)).diagnosis == result.diagnosis


def test_a_recording_without_noise_warns_of_nothing_but_the_rectangle_of_its_resolution() -> None:
    """Each position shows one value: what they differ by stands for the resolution."""
    unit = VirtualUnit(K=(1.001, 0.999, 1.0), L={"yx": 1e-3})
    said = diagnosed(reduce_recording(unit.standard()))
    assert all("(JCGM 101, clause 8)" in text for text in said)


def test_a_rate_that_stands_apart_is_named_and_not_dropped() -> None:
    unit = noisy(2)
    rates = unit.rates("x")
    rates[6] = moved(rates[6], 0.05)
    result = reduce_recording(unit.recording(rates))
    (warning,) = [one for one in result.warnings if "off the line" in one.what.text()]
    assert warning.segment == rates[6].segment.file
    assert warning.what.text().startswith("K_x: At 100 °/s")
    assert warning.what.text("zh").startswith("K_x：")
    assert len(result.scale_factor["x"].means) == 8


def test_a_zero_that_moved_between_the_rests_is_a_warning() -> None:
    unit = noisy(3)
    rates = unit.rates("x")
    rates[-1] = moved(rates[-1], 0.02)
    assert any("the zero moved by +7" in text for text in diagnosed(reduce_recording(unit.recording(rates))))


def test_a_position_that_stands_apart_is_named() -> None:
    unit = noisy(4)
    azimuths = unit.azimuths("x", 12, 60.0)
    azimuths[5] = moved(azimuths[5], 0.02)
    result = reduce_recording(unit.recording(azimuths))
    (warning,) = [one for one in result.warnings if "It was not left out" in one.what.text()]
    assert warning.segment == azimuths[5].segment.file


@pytest.mark.parametrize(("latitude_deg", "warned"), [(39.9042, False), (75.0, True)])
def test_the_earths_rate_has_to_be_that_of_the_latitude(latitude_deg: float, warned: bool) -> None:
    unit = VirtualUnit(density=1e-4, rng=np.random.default_rng(5))
    recording = unit.recording(unit.azimuths("x", 12, 60.0))
    site = replace(recording.header.site, latitude_deg=latitude_deg)
    result = reduce_recording(replace(recording, header=replace(recording.header, site=site)))
    assert any("The Earth's rate shows with" in text for text in diagnosed(result)) is warned


def test_counts_are_diagnosed_in_their_degrees() -> None:
    unit = noisy(6, rate_unit="LSB", shown_per_dps=(65.5, 65.5, 65.5), K=(1.0, 1.0, 1.0))
    result = reduce_recording(unit.recording([*unit.rates("x"), *unit.positions("x", 240.0)]))
    assert result.diagnosis is not None
    allan = result.diagnosis.zero_offset["x"].allan
    assert allan is not None
    assert allan.white == pytest.approx(DENSITY, rel=0.1)
    assert allan.verdict == "before"


def test_repeated_positions_are_diagnosed_one_by_one() -> None:
    unit = noisy(7)
    made = []
    for repeat in (1, 2, 3):
        for recorded in unit.positions("x", 60.0):
            segment = recorded.segment
            name = f"{segment.name}_{repeat}"
            extra = {**segment.extra, "repeat": repeat, "power_cycle": repeat}
            made.append(
                replace(
                    recorded, segment=replace(segment, name=name, file=f"segments/{name}.csv", extra=extra)
                )
            )
    result = reduce_recording(unit.recording(made))
    assert result.diagnosis is not None
    residuals = result.diagnosis.zero_offset["x"].residuals
    assert residuals is not None
    assert len(residuals.residuals) == 12
    assert residuals.dof == 10


def test_segments_of_one_name_are_told_apart() -> None:
    """Nothing in a bundle says that names differ; only files do."""
    unit = noisy(8)
    made = [*unit.rates("x"), *unit.turns("x"), *unit.positions("x")]
    result = reduce_recording(
        unit.recording([replace(one, segment=replace(one.segment, name="take")) for one in made])
    )
    assert result.diagnosis is not None
    residuals = result.diagnosis.scale_factor["x"].residuals
    assert residuals.residuals == pytest.approx(result.scale_factor["x"].residuals)
    assert len(set(residuals.starts_s)) == 8
