"""The header a recording begins with: who is measured, where, by which plan, on which bench."""

from __future__ import annotations

from typing import Any

from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.figures_json import with_capability
from ahrs_lab.procedures.plan import Plan, deviations, plan_to_toml
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader


def recording_header(
    bench: Bench,
    plan: Plan,
    *,
    device: DeviceDescription | None = None,
    capability: BenchCapability | None = None,
    **notes: Any,
) -> RecordingHeader:
    """The header of a calibration of ``device`` (default: what the bench's AHRS says of itself); ``notes``
    are kept beside the plan, its deviations and the bench's figures (``capability``), which every later
    evaluation of the recording finds there."""
    return RecordingHeader(
        procedure=plan.procedure,
        site=bench.site,
        device=device or bench.ahrs.description,
        notes=with_capability(
            {
                "plan": plan_to_toml(plan),
                "deviations": [message.to_json() for message in deviations(plan)],
                "simulated": bench.simulated,
                **notes,
            },
            capability or BenchCapability(),
        ),
    )
