"""What is set by hand, in words: the title, the number, the button, in the language that is on."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.ui.formatting import number, signed_rate

translate = QCoreApplication.translate


def title(request: HandRequest) -> str:
    """What to do."""
    return {
        "switch_on": translate("HandWords", "Switch the rate table on"),
        "rate": translate("HandWords", "Set the rate by hand"),
        "angle": translate("HandWords", "Turn the table to an angle"),
        "turns": translate("HandWords", "Turn the table by whole turns"),
        "rest": translate("HandWords", "Bring the table to rest"),
        "switch_off": translate("HandWords", "Switch the rate table off"),
    }[request.kind]


def how(request: HandRequest) -> str:
    """A sentence under it: the sense, and when to confirm."""
    clockwise = turning(request) < 0
    if request.kind == "rate":
        return (
            translate("HandWords", "Clockwise seen from above. Confirm when it turns steadily.")
            if clockwise
            else translate("HandWords", "Anticlockwise seen from above. Confirm when it turns steadily.")
        )
    if request.kind == "turns":
        text = (
            translate(
                "HandWords",
                "Clockwise seen from above, at most {rate} °/s, to rest where it began. It is being "
                "recorded.",
            )
            if clockwise
            else translate(
                "HandWords",
                "Anticlockwise seen from above, at most {rate} °/s, to rest where it began. It is being "
                "recorded.",
            )
        )
        return text.format(rate=signed_rate(abs(request.rate_dps)))
    return {
        "switch_on": translate("HandWords", "Let it stand still at its zero mark."),
        "angle": translate(
            "HandWords",
            "On the table's own scale, counted anticlockwise seen from above. Let it stand still.",
        ),
        "rest": translate("HandWords", "Confirm when it stands still."),
        "switch_off": translate("HandWords", "Bring it to rest first."),
    }[request.kind]


def figure(request: HandRequest) -> tuple[str, str]:
    """The number to set, and its unit."""
    if request.kind == "rate":
        rate = signed_rate(request.rate_dps)
        return (rate if request.rate_dps < 0 else f"+{rate}"), "°/s"
    if request.kind == "turns":
        return number(request.travel_deg / 360.0, 0, plus=True), translate("HandWords", "turns")
    if request.kind in ("angle", "switch_on"):
        return f"{number(request.angle_deg % 360.0, 1 if request.angle_deg % 1.0 else 0)}°", translate(
            "HandWords", "on the table's scale"
        )
    return "0", "°/s"


def done(request: HandRequest) -> str:
    """The button."""
    return {
        "switch_on": translate("HandWords", "It is on and stands"),
        "rate": translate("HandWords", "It turns steadily"),
        "angle": translate("HandWords", "It stands there"),
        "turns": translate("HandWords", "Turned, at rest"),
        "rest": translate("HandWords", "It stands still"),
        "switch_off": translate("HandWords", "It is off"),
    }[request.kind]


def turning(request: HandRequest) -> int:
    """1: anticlockwise seen from above, −1: clockwise, 0: not turning, or either way will do."""
    along = {"rate": request.rate_dps, "turns": request.travel_deg}.get(request.kind, 0.0)
    return (along > 0) - (along < 0)
