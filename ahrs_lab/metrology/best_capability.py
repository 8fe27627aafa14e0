"""The laboratory's best measurement capability (CMC): no reported U is smaller.

Stated as expanded uncertainty at k = 2, K relative to the value. Where the computed U is smaller, the stated
one is reported in its place; budget and stored result keep what was computed.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, replace

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.json_reader import JsonReader
from ahrs_lab.metrology.result import CalibrationResult, Uncertainty
from ahrs_lab.metrology.uncertainty.budget import scale_of

_K = 2.0


@dataclass(frozen=True)
class BestCapability:
    """Smallest U that may be reported: K relative, B in °/s, L in rad; 0: none stated."""

    K_relative: float = 0.0
    B_dps: float = 0.0
    L_rad: float = 0.0

    def __post_init__(self) -> None:
        if not all(0.0 <= one < math.inf for one in (self.K_relative, self.B_dps, self.L_rad)):
            raise InputError("The best measurement capability has to be numbers that are not negative.")


def capability_to_json(capability: BestCapability) -> str:
    """As the records keep it; "" where none is stated."""
    return "" if capability == BestCapability() else json.dumps(asdict(capability), allow_nan=False)


def capability_from_json(text: str) -> BestCapability:
    """The inverse of :func:`capability_to_json`; raises InputError for what it did not write."""
    if not text.strip():
        return BestCapability()
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(
            "The laboratory's capability is not valid JSON: {reason}", reason=str(error)
        ) from error
    reader = JsonReader(data, "capability")
    return BestCapability(*(reader.number(key, 0.0) for key in ("K_relative", "B_dps", "L_rad")))


@dataclass(frozen=True)
class Reported:
    """A result as it is reported, and the quantities ("K_x") whose U was raised to the capability."""

    result: CalibrationResult
    raised: tuple[str, ...] = ()


def reported(result: CalibrationResult, capability: BestCapability) -> Reported:
    """``result`` with no U below ``capability``; a raised U has no budget of its own.

    u is the capability's half, but never below what was found, and its degrees of freedom stay: a larger U
    makes no conformance more probable. k = U/u, so at most 2.
    """
    raised: list[str] = []

    def at_least(key: str, found: Uncertainty, smallest: float) -> Uncertainty:
        if not found.expanded < smallest:
            return found
        raised.append(key)
        standard = max(scale_of(found), smallest / _K)
        return replace(
            found, standard=standard, expanded=smallest, coverage_factor=smallest / standard, rows=(),
            correlations=(), monte_carlo=None, from_monte_carlo=False,
        )  # fmt: skip

    scale_factor = {
        axis: replace(
            one,
            uncertainty=at_least(f"K_{axis}", one.uncertainty, capability.K_relative * abs(one.K)),
        )
        for axis, one in result.scale_factor.items()
    }
    zero_offset = {
        axis: replace(one, uncertainty=at_least(f"B_{axis}", one.uncertainty, capability.B_dps))
        for axis, one in result.zero_offset.items()
    }
    misalignment = {
        pair: replace(one, uncertainty=at_least(f"L_{pair}", one.uncertainty, capability.L_rad))
        for pair, one in result.misalignment.items()
    }
    if not raised:
        return Reported(result)
    return Reported(
        replace(result, scale_factor=scale_factor, zero_offset=zero_offset, misalignment=misalignment),
        tuple(raised),
    )
