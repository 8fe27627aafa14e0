"""Results: frozen and complete: value, unit, uncertainty budget, inputs, warnings.

The JSON form (``to_json``/``from_json`` in :mod:`ahrs_lab.metrology.result_json`) is the one of ``evaluate
--json`` and is kept stable; keys beyond the published ones may be added, never taken away.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import Diagnosis

AxisName = Literal["x", "y", "z"]
Method = Literal["gum", "annex-a"]
Distribution = Literal["normal", "rectangular", "triangular", "arcsine", "t"]
Origin = Literal["data", "certificate", "assumption"]

MISALIGNMENT_KEYS = ("yx", "zx", "xy", "zy", "xz", "yz")
"""First index the output, second the turned axis, in annex C's order: X→Y, X→Z, Y→X, Y→Z, Z→X, Z→Y."""


@dataclass(frozen=True)
class BudgetRow:
    """One source of uncertainty of one quantity.

    ``standard_uncertainty`` is u(x) in the source's own ``unit``; ``contribution`` = |sensitivity|·u(x) in
    the quantity's unit; ``dof`` may be infinite. Rows whose uncertainty is one and the same estimate carry
    its name in ``shared``: their degrees of freedom count once. ``certificate``: the number of the standard's
    certificate that states the figure, where ``origin`` is one.
    """

    symbol: str
    source: Message
    unit: str
    standard_uncertainty: float
    sensitivity: float
    contribution: float
    kind: Literal["A", "B"]
    distribution: Distribution
    divisor: float
    dof: float
    origin: Origin
    estimate: float | None = None
    half_width: float | None = None
    shared: str = ""
    certificate: str = ""


@dataclass(frozen=True)
class Correlation:
    """Correlation coefficient of two rows of a budget, by their place in it."""

    first: int
    second: int
    coefficient: float


@dataclass(frozen=True)
class MonteCarloCheck:
    """Propagation of distributions (JCGM 101) of one quantity, and what it says of the GUM interval.

    Intervals hold 95 %; all in the quantity's unit. ``standard`` is None where the distribution has none: a
    row is a t of two or fewer degrees of freedom. ``tolerance`` is δ of 7.9.2 for ``digits`` significant
    digits of the GUM's u; ``validated``: both ends of value ± ``gum_expanded`` lie within δ of the symmetric
    interval's (clause 8). ``gum_expanded`` is None in results of before it was kept: then it is U.
    ``counts`` of the trials in equal bins from ``bins[0]`` to ``bins[1]`` are for looking at.
    """

    trials: int
    seed: int
    mean: float
    standard: float | None
    symmetric: tuple[float, float]
    shortest: tuple[float, float]
    digits: int
    tolerance: float
    validated: bool
    bins: tuple[float, float]
    counts: tuple[int, ...]
    gum_expanded: float | None = None


@dataclass(frozen=True)
class Uncertainty:
    """Combined and expanded uncertainty (JCGM 100): U = k·u_c at about 95 %.

    ``from_monte_carlo``: the GUM's U was too short by the trials, and U covers their symmetric interval.
    """

    standard: float
    expanded: float
    coverage_factor: float
    dof: float
    method: Method
    rows: tuple[BudgetRow, ...] = ()
    correlations: tuple[Correlation, ...] = ()
    monte_carlo: MonteCarloCheck | None = None
    from_monte_carlo: bool = False

    @property
    def gum_expanded(self) -> float:
        """U of the budget itself, which the Monte Carlo check tests."""
        check = self.monte_carlo
        return self.expanded if check is None or check.gum_expanded is None else check.gum_expanded


@dataclass(frozen=True)
class ScaleFactorResult:
    """7.1: K, F₀ by (14), (15). ``means`` are mean_j of (10), in the device's unit; ``rates_dps`` the Ω_j
    used; ``residuals`` v_j of (13); ``static_before``/``static_after`` are F_s, F_e of (11)."""

    axis: AxisName
    K: float
    F0: float
    unit: str
    rates_dps: tuple[float, ...]
    demanded_rates_dps: tuple[float, ...]
    means: tuple[float, ...]
    residuals: tuple[float, ...]
    static_before: float
    static_after: float
    nonlinearity_ppm: float
    asymmetry_ppm: float
    uncertainty: Uncertainty
    rate_source: Literal["demanded", "table"] = "demanded"
    segments: tuple[str, ...] = ()
    standard_errors: tuple[float, ...] = ()
    """Standard error of each mean_j from the data, for error bars; the device's unit."""
    F0_uncertainty: Uncertainty | None = None
    """Budget of F₀, the device's unit."""


@dataclass(frozen=True)
class ZeroOffsetResult:
    """7.2: B by (16), °/s; ``angles_deg`` are the N_i, in the order of ``positions``."""

    axis: AxisName
    B: float
    unit: str
    duration_s: float
    angles_deg: tuple[float, ...]
    uncertainty: Uncertainty
    schedule: Literal["standard", "combined", "multi-position"] = "standard"
    orientations: tuple[str, ...] = ()
    azimuths_deg: tuple[float, ...] = ()
    durations_s: tuple[float, ...] = ()
    repeatability_dps: float | None = None
    """What B may be another day, °/s; beside U, unless ``repeatability_included``."""
    earth_rate_check: Mapping[str, float] | None = None
    """Multi-position: first harmonic: ``amplitude_dps``, ``expected_dps``, ``phase_deg``, and
    ``heading_at_zero_deg``: where the axis points, clockwise from north, at table azimuth 0."""
    segments: tuple[str, ...] = ()
    repeatability_cycles: int = 0
    """Power-ons whose single results scatter by ``repeatability_dps``; 0: it is the Allan deviation at the
    dwell, which shows the bias instability alone."""
    repeatability_included: bool = False
    """U includes it, as the job asked: it holds for another day too."""


@dataclass(frozen=True)
class MisalignmentResult:
    """7.3: L by (7), (17), rad: what ``output_axis`` shows per unit rotation about ``turned_axis``."""

    output_axis: AxisName
    turned_axis: AxisName
    L: float
    turns: int
    angle_positive_deg: float
    angle_negative_deg: float
    uncertainty: Uncertainty
    unit: str = "rad"
    rate_dps: float = 0.0
    duration_s: float = 0.0
    segments: tuple[str, ...] = ()


@dataclass(frozen=True)
class ResultWarning:
    """Something the reader of the result has to know; ``segment`` and ``line`` say where (line 0: all of
    it)."""

    what: Message
    segment: str = ""
    line: int = 0


@dataclass(frozen=True)
class Environment:
    """Room over the whole run: mean and half the spread."""

    temperature_c: float
    temperature_spread_c: float
    humidity_percent: float
    humidity_spread_percent: float


class Reported(Protocol):
    """What the result of every procedure says beside its quantities; see :class:`CalibrationResult`."""

    @property
    def procedure(self) -> str: ...
    @property
    def bundle_sha256(self) -> str: ...
    @property
    def software(self) -> str: ...
    @property
    def warnings(self) -> tuple[ResultWarning, ...]: ...
    @property
    def deviations(self) -> tuple[Message, ...]: ...
    @property
    def environment(self) -> Environment | None: ...
    @property
    def device(self) -> Mapping[str, Any]: ...
    @property
    def site(self) -> Mapping[str, Any]: ...
    @property
    def notes(self) -> Mapping[str, Any]: ...
    @property
    def simulated(self) -> bool: ...


@dataclass(frozen=True)
class CalibrationResult:
    """All of one calibration. Missing items or axes are absent keys.

    ``deviations`` are settings that leave the standard, each a sentence; ``device``, ``notes`` carry what
    the bundle's header says (plan, order run, people, dates) for the original record.
    """

    procedure: str
    bundle_sha256: str
    software: str
    scale_factor: Mapping[AxisName, ScaleFactorResult] = field(default_factory=dict)
    zero_offset: Mapping[AxisName, ZeroOffsetResult] = field(default_factory=dict)
    misalignment: Mapping[str, MisalignmentResult] = field(default_factory=dict)
    warnings: tuple[ResultWarning, ...] = ()
    deviations: tuple[Message, ...] = ()
    environment: Environment | None = None
    device: Mapping[str, Any] = field(default_factory=dict)
    site: Mapping[str, Any] = field(default_factory=dict)
    notes: Mapping[str, Any] = field(default_factory=dict)
    simulated: bool = False
    diagnosis: Diagnosis | None = None
    """None in a result that an earlier version wrote."""
