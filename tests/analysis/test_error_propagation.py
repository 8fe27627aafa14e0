"""The propagation of one error as a person reads it."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.analysis.error_propagation import SOURCES, propagate_error
from ahrs_lab.errors import InputError


def test_a_gyro_bias_swings_with_the_three_periods() -> None:
    result = propagate_error("gyro_east", 0.01, 45.0, 48.0)
    periods = result.periods_h()
    assert periods["schuler"] == pytest.approx(84.4 / 60, rel=3e-3)
    assert periods["earth"] == pytest.approx(23.934, rel=1e-4)
    assert periods["foucault"] == pytest.approx(34.0, rel=5e-3)
    marks = result.report().charts[0].marks
    assert [mark.label.text() for mark in marks] == ["84.4 min", "24 h", "Foucault"]  # type: ignore[union-attr]
    # table 2-9: δL from ε_x is ω_s²/(ω_s² − ω²)·(sin ωt/ω − sin ω_s t/ω_s)·ε_x; the gyro's sign is the other
    t, w, ws = result.hours * 3600, 7.292115e-5, result.place.schuler_radps
    drift = np.radians(0.01) / 3600
    printed = -(ws**2) / (ws**2 - w**2) * (np.sin(w * t) / w - np.sin(ws * t) / ws) * drift
    shown = result.series()["error_north_m"] / result.place.meridian_m
    # the print leaves Foucault out: it holds over the first hours
    early = result.hours < 3.0
    assert shown[early] == pytest.approx(printed[early], abs=0.1 * np.max(np.abs(printed[early])))


def test_errors_of_the_start_are_there_at_the_start() -> None:
    expected = {
        "tilt_east": ("tilt_east_arcsec", 10.0),
        "tilt_north": ("tilt_north_arcsec", 10.0),
        "azimuth": ("error_heading_arcsec", 600.0),
        "velocity_east": ("error_ve_mps", 10.0),
        "velocity_north": ("error_vn_mps", 10.0),
    }
    for source, (column, size) in expected.items():
        assert propagate_error(source, 10.0, 40.0, 1.0).series()[column][0] == pytest.approx(size)
    north = propagate_error("latitude", 1.0, 40.0, 1.0).series()["error_north_m"][0]
    assert north == pytest.approx(30.8, abs=0.1)


def test_at_the_equator_there_is_no_foucault() -> None:
    result = propagate_error("accel_north", 100.0, 0.0, 100.0)
    assert result.periods_h()["foucault"] is None
    assert len(result.report().charts[0].marks) == 2
    assert np.all(np.isfinite(result.states))


@pytest.mark.parametrize("source", SOURCES)
def test_every_source_gives_its_result(source: str) -> None:
    result = propagate_error(source, 1.0, -35.0, 5.0)
    data = result.to_json()
    assert data["unit"] == SOURCES[source].unit
    assert all(np.isfinite(value) for value in data["final"].values())
    assert max(data["largest"].values()) > 0
    assert len(data["eigenfrequencies_radps"]) == 3


@pytest.mark.parametrize(
    ("source", "size", "latitude", "hours", "said"),
    [
        ("wind", 1.0, 40.0, 1.0, "no source of error"),
        ("gyro_up", float("nan"), 40.0, 1.0, "finite"),
        ("gyro_up", 1.0, 90.0, 1.0, "east and north are lost"),
        ("gyro_up", 1.0, -90.0, 1.0, "east and north are lost"),
        ("gyro_up", 1.0, 91.0, 1.0, "between −90° and 90°"),
        ("gyro_up", 1.0, float("nan"), 1.0, "between −90° and 90°"),
        ("gyro_up", 1.0, 40.0, 0.0, "above 0"),
        ("gyro_up", 1.0, 40.0, 1e9, "above 0"),
    ],
)
def test_nonsense_is_refused(source: str, size: float, latitude: float, hours: float, said: str) -> None:
    with pytest.raises(InputError, match=said):
        propagate_error(source, size, latitude, hours)
