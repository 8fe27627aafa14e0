"""What a transfer alignment found, as JSON, as a table of states, and as charts of its convergence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from ahrs_lab.analysis.report import Cell, Chart, Curve, Report, Table
from ahrs_lab.analysis.report_cells import digits, paired
from ahrs_lab.inertial.transfer_alignment import Reference, TransferAlignment
from ahrs_lab.inertial.transfer_alignment_model import (
    ACCEL_BIAS,
    AZIMUTH,
    EARTH_RADIUS_M,
    GYRO_BIAS,
    GYRO_CROSS,
    GYRO_SCALE,
    LONGITUDE,
    MOUNTING,
    NAMES,
    PHI,
    Assumptions,
)
from ahrs_lab.messages import Message

Array = NDArray[np.float64]

_HEAD: Final = (Message("about"), Message("value, °"), Message("standard uncertainty, °"))
NOT_SHOWN: Final = 0.5
"""A state whose uncertainty is still more than this part of what was assumed of it."""

_PER_HOUR = np.radians(1.0) / 3600.0
# per state: unit, and how many SI units it is
_UNITS: Final = (
    *([("°", np.radians(1.0))] * 3),
    *([("m/s", 1.0)] * 3),
    *([("m", 1 / EARTH_RADIUS_M)] * 2),
    *([("°/h", _PER_HOUR)] * 3),
    *([("mm/s²", 1e-3)] * 3),
    *([("ppm", 1e-6)] * 6),
    *([("°", np.radians(1.0))] * 4),
)


@dataclass(frozen=True)
class TransferResult:
    """``aligned`` has one unit; ``copied``: it started with the reference's attitude."""

    aligned: TransferAlignment
    assumed: Assumptions
    copied: bool
    reference: Reference
    data_warnings: tuple[Message, ...] = ()

    @property
    def misalignment(self) -> tuple[Array, Array]:
        """Rad about east, north, up at the end, and the standard uncertainties, each (3,).

        Of the computed frame; for the attitude methods of the unit's case against the reference's.
        """
        aligned = self.aligned
        if not aligned.method.needs_attitude:
            return aligned.misalignment[0, -1], aligned.misalignment_u[0, -1]
        C = aligned.motion.C_bn[0]
        if MOUNTING.start in aligned.method.states:
            at = aligned.method.states.index(MOUNTING.start)
            vector = Rotation.from_matrix(aligned.mounting[0]).as_rotvec()
            of_mounting = C @ aligned.covariance[0, at : at + 3, at : at + 3] @ C.T
            return C @ vector, np.sqrt(np.diag(of_mounting))
        # level from the attitude found and the reference's last one, about the case's z from all of them
        assert self.reference.C_bn is not None
        mounting = Rotation.from_matrix(self.reference.C_bn[0, -1].T @ C).as_rotvec()
        level = (C @ mounting)[:2]
        level_u = np.hypot(aligned.misalignment_u[0, -1, :2], self.assumed.attitude_noise)
        # heading is clockwise, the rotation about z is not; turns about x and y, one after the other, show
        # in heading to second order; and the turn about up has a share of level
        about_z = -aligned.estimate[0, -1, AZIMUTH] - mounting[0] * mounting[1] / 2
        z_u = aligned.estimate_u[0, -1, AZIMUTH]
        up = (about_z - C[:2, 2] @ level) / C[2, 2]
        up_u = np.hypot(z_u, np.hypot(*(C[:2, 2] * level_u))) / abs(C[2, 2])
        return np.array([*level, up]), np.array([*level_u, up_u])

    @property
    def nis(self) -> tuple[float, float, float, float]:
        """Mean of the normalised innovations squared; how large it should be, and its 95 % band."""
        numbers = int(np.sum(self.aligned.compared))
        runs = len(self.aligned.compared)
        low, high = (float(chi2.ppf(p, numbers)) / runs for p in (0.025, 0.975))
        return float(np.mean(self.aligned.nis)), numbers / runs, low, high

    @property
    def shrunk(self) -> Array:
        """Per estimated state the uncertainty at the end over that assumed at the start; 0 where that was 0,
        for nothing was left to be seen."""
        states = list(self.aligned.method.estimated)
        prior = self.aligned.prior_u[: len(states)]
        left = self.aligned.estimate_u[0, -1, states]
        return np.divide(left, prior, out=np.zeros(len(states)), where=prior > 0.0)

    @property
    def singular_values(self) -> Array:
        """Of the comparisons' sensitivity to the states at the start, in units of the prior and the noise:
        below 1 a combination of states was not seen."""
        values = np.linalg.eigvalsh(self.aligned.information)[::-1]
        return np.asarray(np.sqrt(np.clip(values, 0.0, None)), dtype=np.float64)

    def to_json(self) -> dict[str, Any]:
        """The keys of the interface; beside them ``t_s`` the values belong to, ``computed_frame_deg`` the
        misalignment of the computed frame with every method, the biases' uncertainties, how large
        ``nis_mean`` should be, what the manoeuvre did not show, and the singular values."""
        aligned = self.aligned
        angle, u = self.misalignment
        nis, expected, low, high = self.nis
        data: dict[str, Any] = {
            "method": aligned.method.name,
            "t_s": float(aligned.t_s[-1]),
            "misalignment_deg": np.degrees(angle).tolist(),
            "standard_uncertainty_deg": np.degrees(u).tolist(),
            "gyro_bias_deg_per_h": self._bias(aligned.estimate, GYRO_BIAS, _PER_HOUR),
            "accel_bias_mps2": self._bias(aligned.estimate, ACCEL_BIAS, 1.0),
            "nis_mean": nis,
            "nis_expected": expected,
            "nis_band": [low, high],
            "gyro_bias_standard_uncertainty_deg_per_h": self._bias(aligned.estimate_u, GYRO_BIAS, _PER_HOUR),
            "accel_bias_standard_uncertainty_mps2": self._bias(aligned.estimate_u, ACCEL_BIAS, 1.0),
            "computed_frame_deg": np.degrees(aligned.misalignment[0, -1]).tolist(),
            "computed_frame_at_start_deg": np.degrees(aligned.misalignment_at_start[0]).tolist(),
            "computed_frame_at_start_u_deg": np.degrees(aligned.misalignment_at_start_u[0]).tolist(),
            "not_shown": self._not_shown(),
            "singular_values": self.singular_values.tolist(),
            "warnings": [warning.text() for warning in self.warnings],
        }
        if aligned.method.needs_attitude:
            data["mounting_deg"] = np.degrees(aligned.motion.C_bn[0].T @ angle).tolist()
        return data

    @property
    def warnings(self) -> tuple[Message, ...]:
        """The data's, and where the innovations are larger than was assumed."""
        nis, _, _, high = self.nis
        if nis <= high:
            return self.data_warnings
        larger = Message(
            "The differences are larger than assumed ({what}): the stated uncertainties are too small. Look "
            "at the noise settings, the lever arm, and whether both systems share one time base.",
            what=self._nis_text(),
        )
        return (*self.data_warnings, larger)

    def _nis_text(self) -> Message:
        nis, expected, low, high = self.nis
        return Message(
            "mean NIS {nis}, expected {expected}, with 95 % probability from {low} to {high}",
            nis=f"{nis:.3f}",
            expected=f"{expected:.2f}",
            low=f"{low:.3f}",
            high=f"{high:.3f}",
        )

    def report(self) -> Report:
        """Tables of the misalignment, the states and what was observable; charts of the convergence."""
        return Report(
            Message("Alignment against a reference system"),
            (self._angles(), self._at_start(), self._states(), self._observability()),
            (*self._convergence(), *self._innovations()),
            notes=(*self._notes(), self._shown(), *self._fit()),
            warnings=self.warnings,
        )

    def _bias(self, values: Array, rows: slice, unit: float) -> list[float | None]:
        """Null where the method has no state for it; a considered one is not estimated."""
        if rows.start not in self.aligned.method.estimated:
            return [None, None, None]
        return [float(value) / unit for value in values[0, -1, rows]]

    def _not_shown(self) -> list[str]:
        states = self.aligned.method.estimated
        return [NAMES[s] for s, ratio in zip(states, self.shrunk, strict=True) if ratio > NOT_SHOWN]

    def _angles(self) -> Table:
        angle, u = np.degrees(self.misalignment)
        rows: list[tuple[Cell, ...]] = [
            (name, *paired(float(angle[i]), float(u[i]))) for i, name in enumerate(_ENU)
        ]
        if self.aligned.method.needs_attitude:
            title = Message("Unit's case against the reference's, at the end")
            body = np.degrees(self.aligned.motion.C_bn[0].T @ self.misalignment[0])
            rows += [
                (Message("about the case's {axis}", axis=axis), paired(float(body[i]), float(u.max()))[0], "")
                for i, axis in enumerate("xyz")
            ]
        else:
            title = Message("Unit's computed frame against the reference, at the end")
        return Table(title, _HEAD, tuple(rows))

    def _at_start(self) -> Table:
        angle, u = self.aligned.misalignment_at_start[0], self.aligned.misalignment_at_start_u[0]
        rows = tuple(
            (name, *paired(float(value), float(of)))
            for name, value, of in zip(_ENU, np.degrees(angle), np.degrees(u), strict=True)
        )
        title = Message("Unit's computed frame against the reference, at the start")
        return Table(title, _HEAD, rows)

    def _states(self) -> Table:
        aligned = self.aligned
        rows = []
        for i, state in enumerate(aligned.method.estimated):
            unit, scale = _UNITS[state]
            if state == LONGITUDE:
                scale = scale / np.cos(float(aligned.motion.latitude[0]))
            # velocity and position are put right at every comparison: there is no value to show at the end
            value = aligned.misalignment[0, -1, state] if state < 3 else aligned.estimate[0, -1, state]
            shown, u = paired(value / scale, aligned.estimate_u[0, -1, state] / scale)
            if 3 <= state < GYRO_BIAS.start:
                shown = "–"
            rows.append(
                (
                    NAMES[state],
                    unit,
                    shown,
                    digits(aligned.prior_u[i] / scale, 2),
                    u,
                    f"{self.shrunk[i]:.3f}",
                )
            )
        head = (
            Message("state"),
            Message("unit of measure"),
            Message("estimate"),
            Message("u at the start"),
            Message("u at the end"),
            Message("ratio"),
        )
        return Table(Message("States"), head, tuple(rows))

    def _observability(self) -> Table:
        values, vectors = np.linalg.eigh(self.aligned.information)
        states = self.aligned.method.estimated
        rows = []
        for column in np.argsort(values)[::-1]:
            largest = np.argsort(np.abs(vectors[:, column]))[::-1][:3]
            mix = ", ".join(f"{vectors[i, column]:+.2f} {NAMES[states[i]]}" for i in largest)
            rows.append((f"{np.sqrt(max(float(values[column]), 0.0)):.3g}", mix))
        head = (Message("singular value"), Message("chiefly"))
        return Table(Message("What the comparisons see, in units of the prior"), head, tuple(rows))

    def _shown(self) -> Message:
        missing = self._not_shown()
        if not missing:
            return Message(
                "The manoeuvre showed every state: each is known better than half of what was assumed."
            )
        if self.aligned.method.name == "velocity" and "φ_U" in missing:
            return Message(
                "The manoeuvre did not show {states}: still more than half as uncertain as assumed. "
                "Azimuth shows in velocity only while the carrier accelerates in the horizontal plane: "
                "change speed or fly S-turns.",
                states=", ".join(missing),
            )
        return Message(
            "The manoeuvre did not show {states}: still more than half as uncertain as assumed. What it is "
            "said to be rests on the assumption.",
            states=", ".join(missing),
        )

    def _fit(self) -> tuple[Message, ...]:
        nis, _, low, high = self.nis
        if nis > high:
            return ()
        if nis >= low:
            return (Message("The differences are as large as assumed ({what}).", what=self._nis_text()),)
        return (
            Message(
                "The differences are smaller than assumed ({what}): the stated uncertainties are larger than "
                "need be.",
                what=self._nis_text(),
            ),
        )

    def _notes(self) -> tuple[Message, ...]:
        frame = Message(
            "Ĉ = (I − φ×)C: the computed frame is turned by φ against the reference's east, north, up; "
            "C(reference) = (I + φ×)·Ĉ takes it out."
        )
        start = (
            Message("The unit started with the reference's attitude.")
            if self.copied
            else Message("The unit started with its own [initial].")
        )
        if not self.aligned.method.considered:
            return frame, start
        kinds = (
            (GYRO_BIAS, Message("gyro bias")),
            (ACCEL_BIAS, Message("accelerometer bias")),
            (GYRO_SCALE, Message("scale error")),
            (GYRO_CROSS, Message("misalignment of the sensors")),
        )
        considered = Message(
            "The method has no state for {states}; what was assumed of that is in the stated uncertainty.",
            states=_listed([n for rows, n in kinds if rows.start in self.aligned.method.considered]),
        )
        return frame, start, considered

    def _convergence(self) -> list[Chart]:
        aligned = self.aligned
        charts = [
            self._chart(
                Message("Misalignment of the computed frame, ± 3σ"),
                PHI,
                aligned.misalignment,
                ("φ_E", "φ_N", "φ_U"),
            )
        ]
        for title, rows in (
            (Message("Gyro bias, ± 3σ"), GYRO_BIAS),
            (Message("Accelerometer bias, ± 3σ"), ACCEL_BIAS),
            (Message("Mounting of the unit's case, ± 3σ"), MOUNTING),
            (Message("Azimuth offset, ± 3σ"), slice(AZIMUTH, AZIMUTH + 1)),
        ):
            if rows.start in aligned.method.estimated:
                charts.append(self._chart(title, rows, aligned.estimate[..., rows], "xyz"))
        return charts

    def _chart(self, title: Message, rows: slice, values: Array, names: Any) -> Chart:
        unit, scale = _UNITS[rows.start]
        curves = []
        for i in range(rows.stop - rows.start):
            value = values[0, :, i] / scale
            band = 3 * self.aligned.estimate_u[0, :, rows.start + i] / scale
            curves.append(Curve(names[i], self.aligned.t_s, value, value - band, value + band, axis=_XYZ[i]))
        return Chart(title, Message("time, s"), Message("value, {unit}", unit=unit), tuple(curves))

    def _innovations(self) -> list[Chart]:
        aligned = self.aligned
        groups = (
            (Message("Innovations of velocity, and ± 3σ"), "m/s", 1.0, (0, 1, 2)),
            (Message("Innovations of position, and ± 3σ"), "m", 1 / EARTH_RADIUS_M, (3, 4)),
            (Message("Innovations of angle, and ± 3σ"), "°", float(np.radians(1.0)), (5, 6, 7, 8)),
        )
        charts = []
        for title, unit, scale, members in groups:
            columns = [i for i, one in enumerate(aligned.method.compares) if one in members]
            if not columns:
                continue
            curves: list[Curve] = []
            for i in columns:
                seen = np.isfinite(aligned.innovation[0, :, i])
                t_s = aligned.t_s[seen]
                name = _COMPARED[aligned.method.compares[i]]
                along = float(np.cos(aligned.motion.latitude[0])) if name == "λ" else 1.0
                value = aligned.innovation[0, seen, i] * along / scale
                band = 3 * aligned.innovation_u[0, seen, i] * along / scale
                curves.append(Curve(name, t_s, value, -band, band, axis=_COMPARED_AXIS[name], style="points"))
            charts.append(
                Chart(title, Message("time, s"), Message("value, {unit}", unit=unit), tuple(curves))
            )
        return [*charts, self._nis_chart()]

    def _nis_chart(self) -> Chart:
        aligned = self.aligned
        curves = [Curve(Message("NIS"), aligned.t_s, aligned.nis[0], style="points")]
        for p in (0.025, 0.975):
            limit = chi2.ppf(p, aligned.compared)
            curves.append(Curve(f"{p:.1%}", aligned.t_s, np.asarray(limit, dtype=np.float64), style="dashed"))
        title = Message("Normalised innovations squared (NIS) and where 95 % should lie")
        return Chart(title, Message("time, s"), Message("NIS"), tuple(curves))


def _listed(names: list[Message]) -> Message:
    listed = names[0]
    for name in names[1:]:
        listed = Message("{listed}, {name}", listed=listed, name=name)
    return listed


_XYZ: Final = ("x", "y", "z")
_ENU: Final = ("E", "N", "U")
_COMPARED: Final = ("v_E", "v_N", "v_U", "L", "λ", "A", "Δφ_E", "Δφ_N", "Δφ_U")
_COMPARED_AXIS: Final[dict[str, Any]] = dict(
    zip(_COMPARED, ("x", "y", "z", "y", "x", "z", "x", "y", "z"), strict=True)
)
