"""The run's things in words, in the language that is on: faces, steps, segments."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from ahrs_lab.procedures.commands import Step
from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.recording.segment import Segment
from ahrs_lab.ui.formatting import signed_rate
from ahrs_lab.ui.translation import language


def face(mounting: str) -> str:
    """``"x+"`` is "X up"."""
    text = (
        QCoreApplication.translate("RunWords", "{axis} up")
        if mounting.endswith("+")
        else QCoreApplication.translate("RunWords", "{axis} down")
    )
    return text.format(axis=mounting[:1].upper())


def direction(letter: str) -> str:
    """``"E"`` is "east"."""
    return {
        "E": QCoreApplication.translate("RunWords", "east"),
        "N": QCoreApplication.translate("RunWords", "north"),
        "U": QCoreApplication.translate("RunWords", "up"),
        "W": QCoreApplication.translate("RunWords", "west"),
        "S": QCoreApplication.translate("RunWords", "south"),
        "D": QCoreApplication.translate("RunWords", "down"),
    }[letter]


def orientation(where: Orientation) -> str:
    """``X up, Y east, Z north``."""
    one = QCoreApplication.translate("RunWords", "{axis} {direction}")
    return QCoreApplication.translate("RunWords", ", ").join(
        one.format(axis=axis.upper(), direction=direction(letter))
        for axis, letter in zip(AXES, where.letters, strict=True)
    )


def step(which: Step) -> str:
    """A line of the list of steps."""
    axis, detail = which.axis.upper(), which.detail
    match which.kind:
        case "mount":
            return QCoreApplication.translate("RunWords", "mount")
        case "power":
            return QCoreApplication.translate("RunWords", "power on, warm up")
        case "rest":
            return QCoreApplication.translate("RunWords", "{axis} at rest").format(axis=axis)
        case "rates":
            return QCoreApplication.translate("RunWords", "{axis} rates").format(axis=axis)
        case "turns":
            return QCoreApplication.translate("RunWords", "{axis} turns {turns}").format(
                axis=axis, turns=detail
            )
        case "position":
            return QCoreApplication.translate("RunWords", "{axis} zero offset, {position}").format(
                axis=axis, position=position(detail)
            )
        case "static":
            return QCoreApplication.translate("RunWords", "at rest, {position}").format(
                position=position(detail)
            )
        case _:
            return which.kind


def position(letters: str) -> str:
    """Where X, Y and Z point, short: ``UEN``, in Chinese ``天东北``."""
    if language() == "en" or not set(letters) <= set("ENUWSD"):
        return letters
    return "".join(direction(letter) for letter in letters)


def segment(which: Segment) -> str:
    """What is being recorded, as a heading."""
    axis = which.axis.upper()
    if which.role in ("static_before", "static_after"):
        return QCoreApplication.translate("RunWords", "{axis} with the table at rest").format(axis=axis)
    if which.role == "rate":
        text = QCoreApplication.translate("RunWords", "{axis} at {rate} °/s")
        return text.format(axis=axis, rate=signed_rate(which.rate_dps))
    if which.role == "turns":
        text = QCoreApplication.translate("RunWords", "{n} turns about {axis} at {rate} °/s")
        return text.format(n=abs(which.turns or 0), axis=axis, rate=signed_rate(which.rate_dps))
    if which.item == "static":
        return QCoreApplication.translate("RunWords", "Position {n} at rest").format(n=which.position or "")
    text = QCoreApplication.translate("RunWords", "Zero offset of {axis}, position {n}")
    return text.format(axis=axis, n=which.position or "")


def segment_kind(which: Segment) -> str:
    """What it is for, as a sentence under the heading."""
    match which.item:
        case "scale_factor":
            return QCoreApplication.translate("RunWords", "Scale factor (7.1). {standing}.").format(
                standing=orientation(which.orientation)
            )
        case "zero_offset":
            return QCoreApplication.translate("RunWords", "Zero offset (7.2). {standing}.").format(
                standing=orientation(which.orientation)
            )
        case "misalignment":
            return QCoreApplication.translate("RunWords", "Misalignment (7.3). {standing}.").format(
                standing=orientation(which.orientation)
            )
        case "rotation":
            return QCoreApplication.translate("RunWords", "Rates of the IMU (2.6.3.1). {standing}.").format(
                standing=orientation(which.orientation)
            )
        case "static":
            return QCoreApplication.translate(
                "RunWords", "Positions of the IMU (2.6.3.2). {standing}."
            ).format(standing=orientation(which.orientation))
        case _:
            return orientation(which.orientation)


def rate_unit(unit: str) -> str:
    """A device's rate unit as it is printed."""
    return {"deg/s": "°/s", "rad/s": "rad/s", "LSB": "LSB"}.get(unit, unit)
