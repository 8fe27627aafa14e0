"""Xsens MTi units: packet counter, sample time, rate of turn and acceleration in MTData2."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.instruments.drivers.ahrs.unit_settings import UnitSettings
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.protocols import xsens_xbus as xbus
from ahrs_lab.instruments.protocols.xsens import (
    ACCELERATION,
    EULER,
    PACKET_COUNTER,
    RATE_OF_TURN,
    SAMPLE_TIME_FINE,
    STATUS_WORD,
    TEMPERATURE,
    XsensStream,
    message_layout,
)

_EACH = 0xFFFF
"""The rate of an item that goes with every message."""
_LOCAL_FRAME_NED = 0x4


@dataclass(frozen=True)
class XsensSettings(UnitSettings):
    """``rate_hz`` is a whole number. ``double``: numbers as float64 instead of float32. ``attitude``: Euler
    angles (NED) of the unit's filter as well."""

    double: bool = False
    attitude: bool = False
    status: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.rate_hz != round(self.rate_hz):
            raise InputError(
                "An Xsens unit sends a whole number of samples a second, not {rate}.", rate=self.rate_hz
            )

    @property
    def outputs(self) -> tuple[tuple[int, int], ...]:
        """(data identifier, Hz) as the unit is asked for them."""
        kind = 0x3 if self.double else 0x0
        measured = [RATE_OF_TURN | kind, ACCELERATION | kind]
        if self.attitude:
            measured.append(EULER | kind | _LOCAL_FRAME_NED)
        items = [(xdi, round(self.rate_hz)) for xdi in measured]
        if self.status:
            items.append((STATUS_WORD, _EACH))
        return ((PACKET_COUNTER, _EACH), (SAMPLE_TIME_FINE, _EACH), *items, (TEMPERATURE | kind, 1))


class XsensAhrs(StreamingAhrs):
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""

    def __init__(self, settings: XsensSettings, link: Link, clock: Clock) -> None:
        self.settings = settings
        super().__init__(
            link,
            clock,
            settings.description("rad/s", "m/s^2", "Xsens"),
            boot_time_s=settings.boot_time_s,
            range_dps=settings.range_dps,
        )

    def _new_decoder(self) -> XsensStream:
        return XsensStream()

    @property
    def _frame_bytes(self) -> float:
        # The longest message there is, with the temperature that goes with one in a second.
        return message_layout([xdi for xdi, _ in self.settings.outputs]).length

    def _ask_identity(self) -> str:
        device = self._command(xbus.REQ_DEVICE_ID).hex().upper()
        product = self._command(xbus.REQ_PRODUCT_CODE).decode("ascii", "replace").strip("\0 ")
        firmware = ".".join(str(part) for part in self._command(xbus.REQ_FIRMWARE)[:3])
        self._named(model=product, serial_number=device)
        return f"Xsens {product} s/n {device} firmware {firmware}"

    def _pause(self) -> None:
        self._command(xbus.GO_TO_CONFIG)

    def _resume(self) -> None:
        self._command(xbus.GO_TO_MEASUREMENT)

    def _write_settings(self) -> None:
        self._ask(
            xbus.encode_output_configuration(self.settings.outputs),
            _acknowledged(xbus.SET_OUTPUT_CONFIGURATION),
            "SetOutputConfiguration",
        )

    def _settings(self) -> tuple[Mapping[str, str], Mapping[str, str]]:
        found = xbus.output_configuration(self._command(xbus.SET_OUTPUT_CONFIGURATION))
        return _named_outputs(self.settings.outputs), _named_outputs(found)

    def _command(self, mid: int) -> bytes:
        return self._ask(xbus.encode(mid), _acknowledged(mid), f"message {mid:02X}")


def _named_outputs(outputs: tuple[tuple[int, int], ...]) -> dict[str, str]:
    """Rates by identifier. Of items that go with every message units answer either FFFF or their own rate."""
    named = {f"output {xdi:04X}": "each message" if rate == _EACH else f"{rate} Hz" for xdi, rate in outputs}
    for xdi in (PACKET_COUNTER, SAMPLE_TIME_FINE, STATUS_WORD):
        if f"output {xdi:04X}" in named:
            named[f"output {xdi:04X}"] = "each message"
    return named


def _acknowledged(mid: int) -> Callable[[xbus.XbusMessage], bytes | None]:
    """The data of the answer to a message; raises InstrumentError on an error message."""

    def data(message: xbus.XbusMessage) -> bytes | None:
        code = message.error
        if code is not None:
            raise InstrumentError(
                "The Xsens unit refuses message {mid}: error {code}, {text}.",
                mid=f"{mid:02X}",
                code=f"{code:02X}",
                text=xbus.ERRORS.get(code, "unknown"),
            )
        return message.data if message.acknowledges == mid else None

    return data
