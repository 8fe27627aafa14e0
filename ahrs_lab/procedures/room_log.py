"""The room over a run: what the certificate states of it, and whether it left the limits of clause 6.2.1."""

from __future__ import annotations

from collections.abc import Iterable

from ahrs_lab.instruments.interfaces import RoomReading
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import RoomLimits
from ahrs_lab.procedures.figures import figure
from ahrs_lab.recording.segment import Segment


class RoomLog:
    """Collects readings; each limit that is left is told once."""

    def __init__(self, limits: RoomLimits | None = None) -> None:
        self._limits = limits or RoomLimits()
        self._temperatures: list[float] = []
        self._humidities: list[float] = []
        self._told: set[str] = set()

    def add(self, reading: RoomReading) -> tuple[Message, ...]:
        """Keep a reading; returns what is to be warned of."""
        self._temperatures.append(reading.temperature_c)
        self._humidities.append(reading.humidity_percent)
        found = []
        low, high = self._limits.temperature_c
        if not low <= reading.temperature_c <= high and "temperature" not in self._told:
            self._told.add("temperature")
            found.append(
                Message(
                    "The room is at {value} °C, outside {low} to {high} °C (6.2.1): wait until it is back, "
                    "or have the deviation approved.",
                    value=round(reading.temperature_c, 1),
                    low=figure(low),
                    high=figure(high),
                )
            )
        low, high = self._limits.humidity_percent
        if not low <= reading.humidity_percent <= high and "humidity" not in self._told:
            self._told.add("humidity")
            found.append(
                Message(
                    "The room is at {value} % relative humidity, outside {low} to {high} % (6.2.1): wait "
                    "until it is back, or have the deviation approved.",
                    value=round(reading.humidity_percent),
                    low=figure(low),
                    high=figure(high),
                )
            )
        return tuple(found)

    def add_earlier(self, segments: Iterable[Segment]) -> None:
        """What an earlier run of the same recording noted with its segments."""
        for segment in segments:
            temperature = segment.extra.get("temperature_c")
            humidity = segment.extra.get("humidity_percent")
            if isinstance(temperature, (int, float)) and isinstance(humidity, (int, float)):
                self._temperatures.append(float(temperature))
                self._humidities.append(float(humidity))

    def summary(self) -> dict[str, float]:
        """Mean of the extremes and half the spread, keys as in the recording's notes; empty before any
        reading."""
        if not self._temperatures:
            return {}
        temperature, temperature_spread = _middle(self._temperatures)
        humidity, humidity_spread = _middle(self._humidities)
        return {
            "temperature_c": temperature,
            "temperature_spread_c": temperature_spread,
            "humidity_percent": humidity,
            "humidity_spread_percent": humidity_spread,
        }


def _middle(values: list[float]) -> tuple[float, float]:
    """The mean, and half the spread: readings come at uneven times, so the mean is that of the extremes."""
    low, high = min(values), max(values)
    return (low + high) / 2.0, (high - low) / 2.0
