"""An MTi as it speaks: measurement and configuration state, output configuration kept over a restart."""

from __future__ import annotations

from ahrs_lab.instruments.protocols import xsens_xbus as xbus
from ahrs_lab.instruments.protocols.xsens import (
    ACCELERATION,
    PACKET_COUNTER,
    QUATERNION_XDI,
    SAMPLE_TIME_FINE,
    encode_samples,
    message_layout,
)
from ahrs_lab.recording.samples import Samples

_FASTEST = 0xFFFF
_UNTIMED = (PACKET_COUNTER, SAMPLE_TIME_FINE)
_INVALID_MESSAGE, _INVALID_PARAMETER = 0x04, 0x21


class XsensSpeech:
    """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`. It comes up measuring; its outputs are
    those it was last given, at first counter, time, orientation and acceleration."""

    def __init__(self, world_rate_hz: float, model: str, serial_number: str) -> None:
        self.world_rate_hz = world_rate_hz
        self.model = model
        self.device_id = bytes.fromhex(f"{sum(serial_number.encode()) & 0xFFFFFF | 0x03000000:08X}")
        self.reboots = False
        self.streaming = True
        self.outputs: tuple[tuple[int, int], ...] = tuple(
            (xdi, _FASTEST if xdi in _UNTIMED else round(world_rate_hz))
            for xdi in (PACKET_COUNTER, SAMPLE_TIME_FINE, QUATERNION_XDI, ACCELERATION)
        )
        self._decoder = xbus.XbusDecoder()

    def boot(self) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        self.streaming = True
        return xbus.encode(xbus.WAKE_UP)

    @property
    def rate_hz(self) -> float:
        """Of what it sends now."""
        rates = [hz for xdi, hz in self.outputs if xdi not in _UNTIMED and hz != _FASTEST]
        return float(rates[0]) if rates else self.world_rate_hz

    def hear(self, data: bytes) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        return b"".join(self._answer(message) for message in self._decoder.feed(data))

    def say(self, samples: Samples) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        return encode_samples([xdi for xdi, _ in self.outputs], samples) if self.outputs else b""

    def _answer(self, message: xbus.XbusMessage) -> bytes:
        mid = message.mid
        if mid == xbus.GO_TO_CONFIG:
            self.streaming = False
            return xbus.encode_acknowledge(mid)
        if mid == xbus.RESET:
            self.reboots = True
            return xbus.encode_acknowledge(mid)
        if mid == xbus.WAKE_UP_ACK:
            self.streaming = False
            return b""
        if self.streaming:
            return xbus.encode_error(_INVALID_MESSAGE)
        if mid == xbus.GO_TO_MEASUREMENT:
            self.streaming = True
            return xbus.encode_acknowledge(mid)
        if mid == xbus.SET_OUTPUT_CONFIGURATION:
            return self._configure(message.data)
        said = {
            xbus.REQ_DEVICE_ID: self.device_id,
            xbus.REQ_FIRMWARE: bytes((1, 8, 2)),
            xbus.REQ_PRODUCT_CODE: self.model.encode("ascii", "replace").ljust(20),
        }
        return xbus.encode_acknowledge(mid, said[mid]) if mid in said else xbus.encode_error(_INVALID_MESSAGE)

    def _configure(self, data: bytes) -> bytes:
        if data:
            wanted = xbus.output_configuration(data)
            try:
                message_layout([xdi for xdi, _ in wanted])
            except ValueError:
                return xbus.encode_error(_INVALID_PARAMETER)
            self.outputs = tuple((xdi, self._possible(xdi, hz)) for xdi, hz in wanted)
        return xbus.encode_output_configuration(self.outputs, xbus.OUTPUT_CONFIGURATION)

    def _possible(self, xdi: int, rate_hz: int) -> int:
        """The rate it takes instead: the next lower one it has."""
        if xdi in _UNTIMED:
            return _FASTEST
        fastest = round(self.world_rate_hz)
        return next(
            fastest // n for n in range(1, fastest + 1) if fastest % n == 0 and fastest // n <= rate_hz
        )
