"""What all quantities of a recording share while it is reduced: takes, noise and resolution of each axis,
the bench."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.result import (
    Method,
    MisalignmentResult,
    Origin,
    ResultWarning,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.uncertainty.annex_a import annex_a_uncertainty
from ahrs_lab.metrology.uncertainty.full_model import MonteCarloSettings
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, batch_means, fit_noise
from ahrs_lab.metrology.uncertainty.resolution import Resolution, find_resolution
from ahrs_lab.procedures.reduction_output import DeviceOutput
from ahrs_lab.procedures.reduction_selection import Selection
from ahrs_lab.recording.orientation import AXES, Axis
from ahrs_lab.recording.segment import DeviceDescription, Site

Array = NDArray[np.float64]

RateSource = Literal["demanded", "table"]

ANNEX_A_BITS = 12.0
"""The standard's example, where the data do not show a resolution."""


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
    with_repeatability: bool = False
    """U of B includes what B may be another day."""

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
        """Of each axis, from the recordings at rest and at the rates, where there are any; the output's
        unit. Where an axis shows no step, or all axes are made of the three angles of attitude, the coarsest
        step of the three holds."""
        takes = self.selection.takes
        rest = [take for take in takes if take.at_rest]
        moving = [take for take in takes if take.segment.role == "rate"]
        if not rest and not moving:  # a rate that changes on the way is no step of the output
            moving = list(takes)
        source = takes[0].output.source
        found = {
            axis: find_resolution(
                [take.output.readings[axis] for take in rest],
                [take.output.readings[axis] for take in moving],
                [
                    take.output.readings[axis]
                    for take in takes
                    if not take.at_rest and take.segment.axis not in (axis, None)
                ],
                of_angle=source != "rate",
            )
            for axis in AXES
        }
        coarsest = max(found.values(), key=lambda one: one.step)
        if source == "attitude":
            return dict.fromkeys(AXES, coarsest)
        return {
            axis: one if one.step > 0.0 else replace(one, step=coarsest.step) for axis, one in found.items()
        }

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
        resolution = self.resolution[axis]
        # of an angle: what its step makes of one rate reading
        step = resolution.step / (self.selection.takes[0].output.step_s if resolution.of_angle else 1.0)
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


def unknown_resolution(
    evidence: Evidence,
    scale_factors: Mapping[Axis, ScaleFactorResult],
    zero_offsets: Mapping[Axis, ZeroOffsetResult],
    misalignments: Mapping[str, MisalignmentResult],
) -> list[ResultWarning]:
    """A warning for each output that has results, where no output shows a step in any recording."""
    used = {*scale_factors, *zero_offsets, *(one.output_axis for one in misalignments.values())}
    return [
        ResultWarning(
            Message(
                "output {axis} shows one and the same value throughout each recording: its resolution is "
                "not known, and no uncertainty contains it.",
                axis=axis.upper(),
            )
        )
        for axis in AXES
        if axis in used and evidence.resolution[axis].step == 0.0
    ]
