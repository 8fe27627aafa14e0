"""(2-27) and (2-28) written out channel by channel, as printed."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.inertial.sensor_model import AccelModel, GyroModel, Matrix

_CROSS: Matrix = ((0.0, 0.01, 0.02), (0.03, 0.0, 0.04), (0.05, 0.06, 0.0))


def test_gyro_channels_are_those_of_2_28() -> None:
    model = GyroModel(
        scale_factor=(100.0, 101.0, 102.0),
        bias_dps=(0.1, 0.2, 0.3),
        g_sensitivity=((1e-3, 2e-3, 3e-3), (4e-3, 5e-3, 6e-3), (7e-3, 8e-3, 9e-3)),
        misalignment_rad=_CROSS,
    )
    w, f = (10.0, -20.0, 30.0), (9.0, -5.0, 2.0)
    shown = model.output(np.array([w]).T, np.array([f]).T)[:, 0]
    x = 100.0 * (0.1 + 1e-3 * 9 + 2e-3 * -5 + 3e-3 * 2 + 10 + 0.01 * -20 + 0.02 * 30)
    y = 101.0 * (0.2 + 4e-3 * 9 + 5e-3 * -5 + 6e-3 * 2 + 0.03 * 10 - 20 + 0.04 * 30)
    z = 102.0 * (0.3 + 7e-3 * 9 + 8e-3 * -5 + 9e-3 * 2 + 0.05 * 10 + 0.06 * -20 + 30)
    np.testing.assert_allclose(shown, [x, y, z], rtol=1e-14)


def test_accelerometer_channels_are_those_of_2_27() -> None:
    model = AccelModel(scale_factor=(2.0, 3.0, 4.0), bias_mps2=(0.1, 0.2, 0.3), misalignment_rad=_CROSS)
    shown = model.output(np.array([[9.0], [-5.0], [2.0]]))[:, 0]
    x = 2.0 * (0.1 + 9 + 0.01 * -5 + 0.02 * 2)
    y = 3.0 * (0.2 + 0.03 * 9 - 5 + 0.04 * 2)
    z = 4.0 * (0.3 + 0.05 * 9 + 0.06 * -5 + 2)
    np.testing.assert_allclose(shown, [x, y, z], rtol=1e-14)


def test_nonlinearity_is_cubic_and_relative_at_its_reference_rate() -> None:
    model = GyroModel(nonlinearity=(1e-4, 0.0, 0.0), nonlinearity_rate_dps=400.0)
    rates = np.array([[400.0, -400.0, 200.0], [400.0, 0, 0], [0, 0, 0]])
    shown = model.indicated_dps(rates, np.zeros((3, 3)))
    np.testing.assert_allclose(shown[0], [400.04, -400.04, 200.005])
    assert shown[1, 0] == 400.0


def test_what_stands_on_the_diagonal_is_not_used() -> None:
    model = GyroModel(misalignment_rad=((5.0, 0, 0), (0, 5.0, 0), (0, 0, 5.0)))
    assert model.output(np.ones((3, 1)), np.zeros((3, 1))) == pytest.approx(1.0)


def test_output_saturates_at_the_range() -> None:
    gyro = GyroModel(scale_factor=(2.0, 2.0, 2.0), range_dps=100.0)
    assert gyro.output(np.full((3, 1), -300.0), np.zeros((3, 1)))[0, 0] == -200.0
    assert AccelModel(range_mps2=20.0).output(np.full((3, 1), 30.0))[1, 0] == 20.0
