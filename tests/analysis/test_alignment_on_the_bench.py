"""A static recording from the virtual bench, aligned by each method against how the case really stands."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ahrs_lab.analysis.alignment import METHODS, AlignmentSettings, Method, align
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2
from ahrs_lab.recording.samples import ATTITUDE, Samples
from ahrs_lab.simulation.presets import GRADES, sensor_preset, table_preset
from ahrs_lab.simulation.settings import DeviceSettings, SimulationSettings
from tests.analysis.unit_at_rest import record_of
from tests.simulation.bench_at_hand import after, ready

LATITUDE_DEG = 39.9042
NAVIGATION = GRADES["navigation-rlg"]


@cache
def recorded() -> Samples:
    """Ten minutes of a ring-laser unit at 20 Hz, x up, turned 30° from where it was mounted. Its attitude
    output is without error."""
    settings = SimulationSettings.ideal(
        seed=4,
        sensor=sensor_preset("navigation-rlg"),
        table=replace(table_preset("standard"), north_misalignment_arcsec=0.0),
        device=DeviceSettings(outputs=("rate", "accel", "attitude"), sample_rate_hz=20.0),
    )
    bench = ready(settings, "UEN")
    bench.table.move_to(-30.0, 50.0)
    bench.clock.wait(5.0)
    return after(bench, 600.0)


@pytest.mark.parametrize("method", METHODS)
def test_a_navigation_grade_unit_aligns_within_what_its_biases_allow(method: Method) -> None:
    rows = recorded()
    truth = np.array([rows[name].mean() for name in ATTITUDE])
    assert truth[0] == pytest.approx(30.0, abs=0.01)
    assumed_gyro = 3.0 * NAVIGATION.instability
    assumed_accel = 10.0 * NAVIGATION.accel_instability + NAVIGATION.misalignment * STANDARD_GRAVITY_MPS2
    settings = AlignmentSettings(method, assumed_gyro, assumed_accel, axes="yzx")
    found = align(record_of(rows, LATITUDE_DEG), settings)
    error = (found.attitude.angles_deg - truth + 180.0) % 360.0 - 180.0
    assert np.all(np.abs(error) < 2.5 * found.attitude.uncertainty_deg)
    assert np.all(found.attitude.uncertainty_deg < [0.1, 0.02, 0.02])
    assert not found.warnings
