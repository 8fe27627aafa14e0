"""What the plots draw, against numbers worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.recording.samples import Samples
from ahrs_lab.ui.pages.results import plot_data
from tests.ui.pages.sample_result import LATITUDE_DEG, sample_result


def test_residuals_are_ppm_of_the_largest_mean_and_their_bars_two_standard_errors() -> None:
    source = replace(
        sample_result().scale_factor["x"],
        rates_dps=(-100.0, 100.0),
        means=(-99.0, 101.0),
        residuals=(0.001, -0.002),
        standard_errors=(0.0005, 0.0005),
        static_before=1.0,
        static_after=1.0,
    )
    data = plot_data.residuals(source)
    assert data.full_scale == 100.0
    assert data.residuals_ppm == pytest.approx([10.0, -20.0])
    assert data.errors_ppm == pytest.approx([10.0, 10.0])


def test_four_positions_are_expected_where_the_earth_turns_the_axis() -> None:
    source = sample_result().zero_offset["x"]
    data = plot_data.positions(source, LATITUDE_DEG)
    assert data.labels == ("E", "E", "W", "W")
    assert data.expected_dph == pytest.approx([11.1146] * 4, abs=1e-4)
    north = plot_data.positions(replace(source, orientations=("NUE", "SUW", "UEN", "DWN")), LATITUDE_DEG)
    # 15.041067 °/h times cos and sin of 39.9042°
    assert north.expected_dph - north.offset_dph == pytest.approx(
        [11.5381, -11.5381, 9.6490, -9.6490], abs=2e-4
    )


def test_without_a_latitude_only_the_offset_is_expected() -> None:
    data = plot_data.positions(sample_result().zero_offset["y"], None)
    assert data.expected_dph == pytest.approx([data.offset_dph] * 4)


def test_a_multi_position_run_shows_its_first_harmonic() -> None:
    azimuths = tuple(30.0 * i for i in range(12))
    # the axis points east at azimuth 0 and is turned to north by a quarter turn of the table
    rates = [1.0 + 11.5 * np.sin(np.radians(a)) for a in azimuths]
    source = replace(
        sample_result().zero_offset["x"],
        B=1.0 / 3600.0,
        schedule="multi-position",
        azimuths_deg=azimuths,
        angles_deg=tuple(rate / 3600.0 * 1200.0 for rate in rates),
        durations_s=(1200.0,) * 12,
        earth_rate_check={
            "amplitude_dps": 11.5 / 3600.0,
            "expected_dps": 11.5 / 3600.0,
            "phase_deg": 0.0,
            "heading_at_zero_deg": 90.0,
        },
        segments=(),
    )
    data = plot_data.positions(source, LATITUDE_DEG)
    assert data.rates_dph == pytest.approx(rates)
    assert data.expected_dph == pytest.approx(rates)
    assert data.wave is not None
    assert data.wave[1].max() == pytest.approx(12.5)
    assert data.segments == ("",) * 12


def test_an_envelope_keeps_every_extreme() -> None:
    values = np.zeros(100_000)
    values[31_234], values[77_777] = 5.0, -7.0
    curve = plot_data.envelope(np.arange(100_000) / 100.0, values, bins=500)
    assert curve.values.size <= 2 * 500 + 200
    assert (curve.values.max(), curve.values.min()) == (5.0, -7.0)
    assert np.all(np.diff(curve.time) >= 0.0)


def test_a_short_curve_is_left_as_it_is() -> None:
    values = np.arange(10.0)
    assert plot_data.envelope(values, values).values is values


def test_turns_show_both_ends() -> None:
    data = plot_data.turns(sample_result().misalignment["zy"])
    assert (data.angles_deg[0] - data.angles_deg[1]) / 7200.0 == pytest.approx(-7.190909452777777e-4)
    assert data.segments == ("ma_y_plus", "ma_y_minus")


def test_samples_thin_without_their_time_running_back() -> None:
    time = np.arange(1, 5001) / 100.0
    samples = Samples({"t_s": time, "gyro_x": np.sin(time)})
    curve = plot_data.envelope(samples["t_s"], samples["gyro_x"], bins=100)
    assert np.all(np.diff(curve.time) >= 0.0)


def test_the_rests_before_and_after_are_no_points() -> None:
    source = sample_result().scale_factor["x"]
    with_rests = replace(source, segments=("before", *source.segments, "after"))
    assert plot_data.residuals(with_rests).segments == source.segments
    assert plot_data.residuals(replace(source, segments=("one",))).segments == ("",) * 10
