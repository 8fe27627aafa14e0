"""Advanced Navigation units on ANPP: raw sensors (28), each with the time packet (21) before it.

Experimental: no unit was at hand; the packets are held against the manufacturer's own package.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.instruments.drivers.ahrs.unit_settings import UnitSettings
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.protocols.anpp import (
    ACKNOWLEDGE,
    DEVICE_INFORMATION,
    PACKET_TIMER_PERIOD,
    RAW_SENSORS,
    UNIX_TIME,
    AnppPacket,
    AnppStream,
    encode_packets_period,
    encode_request,
    encode_timer_period,
    packet_object,
)

_FRAME_BYTES = 5 + 8 + 5 + 48
_WORDS = range(0, 24, 4)
"""Of the device information: software version, device, hardware revision, serial number in three."""
_RESULTS = {
    1: "CRC error",
    2: "wrong size",
    3: "out of range",
    4: "its memory failed",
    5: "not ready",
    6: "unknown packet",
    7: "not accepted in this mode",
}


@dataclass(frozen=True)
class AdvancedNavigationSettings(UnitSettings):
    """``rate_hz``: one over a whole number of microseconds, from 15.3 to 1000 Hz."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 1000 <= self.timer_us <= 65535 or abs(self.timer_us * self.rate_hz - 1e6) > 1e-3:
            raise InputError(
                "An Advanced Navigation unit sends once in a whole number of microseconds from 1000 to "
                "65535, and {rate} Hz is no such rate.",
                rate=self.rate_hz,
            )

    @property
    def timer_us(self) -> int:
        """Packet timer period."""
        return round(1e6 / self.rate_hz)


class AdvancedNavigationAhrs(StreamingAhrs):
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""

    def __init__(self, settings: AdvancedNavigationSettings, link: Link, clock: Clock) -> None:
        self.settings = settings
        super().__init__(
            link,
            clock,
            settings.description("rad/s", "m/s^2", "Advanced Navigation"),
            boot_time_s=settings.boot_time_s,
            range_dps=settings.range_dps,
        )

    def _new_decoder(self) -> AnppStream:
        return AnppStream()

    @property
    def _frame_bytes(self) -> float:
        return _FRAME_BYTES

    def _ask_identity(self) -> str:
        data = self._packet(DEVICE_INFORMATION, "device information")
        software, device, hardware, *serial = (int.from_bytes(data[at : at + 4], "little") for at in _WORDS)
        number = "-".join(f"{part:08X}" for part in serial)
        known = packet_object(AnppPacket(DEVICE_INFORMATION, data))
        model = f"device {device}" if known is None else known.device_id.name.replace("_", " ")
        self._named(model=model, serial_number=number)
        return f"Advanced Navigation {model} hardware {hardware} s/n {number} firmware {software}"

    def _pause(self) -> None:
        self._command(encode_packets_period([]), "packets period")

    def _resume(self) -> None:
        self._command(encode_packets_period(self._periods), "packets period")

    def _write_settings(self) -> None:
        timer = encode_timer_period(self.settings.timer_us)
        self._command(timer, "packet timer period")

    def _settings(self) -> tuple[Mapping[str, str], Mapping[str, str]]:
        data = self._packet(PACKET_TIMER_PERIOD, "packet timer period")
        found = int.from_bytes(data[2:4], "little")
        return {"packet timer": f"{self.settings.timer_us} µs"}, {"packet timer": f"{found} µs"}

    @property
    def _periods(self) -> list[tuple[int, int]]:
        return [(UNIX_TIME, 1), (RAW_SENSORS, 1)]

    def _packet(self, packet_id: int, what: str) -> bytes:
        def data(packet: AnppPacket) -> bytes | None:
            return packet.data if packet.id == packet_id else None

        return self._ask(encode_request([packet_id]), data, what)

    def _command(self, command: bytes, what: str) -> None:
        self._ask(command, _acknowledged(command, what), what)


def _acknowledged(command: bytes, what: str) -> Callable[[AnppPacket], bool | None]:
    """Whether a packet acknowledges ``command``, by its identifier and its CRC: the answer to an earlier one
    may come late. Raises InstrumentError where it refuses it."""
    mark = command[1:2] + command[3:5]

    def accepted(packet: AnppPacket) -> bool | None:
        if packet.id != ACKNOWLEDGE or len(packet.data) != 4 or not packet.data.startswith(mark):
            return None
        result = packet.data[3]
        if result:
            raise InstrumentError(
                "The Advanced Navigation unit refuses {what}: {text}.",
                what=what,
                text=_RESULTS.get(result, str(result)),
            )
        return True

    return accepted
