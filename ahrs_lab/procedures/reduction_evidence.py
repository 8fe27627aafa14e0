"""What all quantities of a recording share while it is reduced: takes, noise and resolution of each axis,
the bench."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.result import Method, Origin, Uncertainty
from ahrs_lab.metrology.uncertainty.annex_a import annex_a_uncertainty
from ahrs_lab.metrology.uncertainty.full_model import MonteCarloSettings
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, batch_means, fit_noise, resolution_step
from ahrs_lab.procedures.reduction_output import DeviceOutput
from ahrs_lab.procedures.reduction_selection import Selection
from ahrs_lab.recording.orientation import AXES, Axis
from ahrs_lab.recording.segment import DeviceDescription, Site

Array = NDArray[np.float64]

RateSource = Literal["demanded", "table"]

ANNEX_A_BITS = 12.0
"""The standard's example, where the data do not show a resolution."""


@dataclass(frozen=True)
class Resolution:
    """Step of the output, in its unit, and whether the noise spreads readings over several steps."""

    step: float
    dithered: bool


@dataclass(frozen=True)
class Evidence:
    """Input of one reduction."""

    selection: Selection
    device: DeviceDescription
    site: Site
    rate_source: RateSource
    method: Method
    capability: BenchCapability
    monte_carlo: MonteCarloSettings

    @cached_property
    def noise(self) -> dict[Axis, NoiseModel]:
        """Of each axis, from everything that was recorded at rest; the output's unit."""
        outputs = [take.output for take in self.selection.takes if take.at_rest]
        found: dict[Axis, NoiseModel] = {}
        for axis in AXES:
            batches = [axis_batches(output, axis) for output in outputs]
            longest = max((batch_s for _, batch_s in batches), default=0.0)
            found[axis] = fit_noise([means for means, batch_s in batches if batch_s == longest], longest)
        return found

    @cached_property
    def resolution(self) -> dict[Axis, Resolution]:
        """Of each axis, at rest where possible; the output's unit."""
        takes = sorted(self.selection.takes, key=lambda take: not take.at_rest)
        found: dict[Axis, Resolution] = {}
        for axis in AXES:
            column = takes[0].output.rates[axis][:4096]
            step = resolution_step(column)
            found[axis] = Resolution(step, float(np.std(column)) >= 0.5 * step > 0.0)
        return found

    def annex_a(
        self, value: float, unit: str, rate_dps: float, bits: float | None, repeatability: list[float]
    ) -> Uncertainty:
        """The annex's budget; the table counts with the band of ``rate_dps``."""
        from ahrs_lab.metrology.conditions import rate_band

        origin: Origin = "data"
        if self.capability.acquisition_bits is not None:
            bits, origin = self.capability.acquisition_bits, self.capability.origin("acquisition_bits")
        elif bits is None:
            bits, origin = ANNEX_A_BITS, "assumption"
        table = self.capability.figure("rate_relative", rate_band(rate_dps))
        return annex_a_uncertainty(
            value,
            unit,
            table_expanded=table.double,
            table_origin=table.origin,
            table_certificate=table.certificate,
            bits=bits,
            bits_origin=origin,
            repeatability=repeatability,
        )

    def acquisition_bits(self, axis: Axis) -> float | None:
        """Effective bits by the data: the largest output at the table's rates, both senses, over the step."""
        step = self.resolution[axis].step
        largest = max(
            (
                abs(take.output.mean(axis))
                for take in self.selection.of("scale_factor", axis)
                if take.segment.role == "rate"
            ),
            default=0.0,
        )
        return math.log2(2.0 * largest / step) if step > 0.0 and largest > step else None


def axis_batches(output: DeviceOutput, axis: Axis) -> tuple[Array, float]:
    """Means over about a second of one axis's rate, and the length of a batch, s."""
    return batch_means(output.rates[axis], output.step_s)
