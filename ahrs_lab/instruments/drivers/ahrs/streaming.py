"""What all AHRS drivers share: the stream, its time, its counts, and what to do when the wire is gone.

A driver is used by one thread (the run's, or the page's); its reader thread only stamps and keeps blocks.
After a lost link a second thread opens the conversation anew, so that :meth:`StreamingAhrs.read` never waits.
"""

from __future__ import annotations

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import radians
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.line_budget import check_line
from ahrs_lab.instruments.drivers.ahrs.screening import EARLY_S, Screening
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.links.port_reader import PortReader
from ahrs_lab.instruments.links.raw_log import Block, BlockKind, RawLog
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.instruments.protocols.frames import LinkCounts
from ahrs_lab.instruments.protocols.stream import StreamDecoder, joined
from ahrs_lab.instruments.settings import Difference
from ahrs_lab.instruments.time_base import TimeBase, TimeRelation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription

ANSWER_TIMEOUT_S = 0.25
"""Wall time that a device may take to answer one command."""
_TRIES = 3
_MUTE_S = 0.8
"""Bench time without a sample after which what is known of the reason is told: less than the second after
which a run complains of silence."""
_RETRY_S = 0.2
_RECOVERY_TRIES = 4

_R = TypeVar("_R")


@dataclass(frozen=True)
class StreamCounts:
    """Of the stream since it was last started. ``lost`` by the device's counter, or by its time."""

    received_bytes: int = 0
    frames: int = 0
    failed: int = 0
    skipped_bytes: int = 0
    untimed: int = 0
    lost: int = 0
    repeated: int = 0
    implausible: int = 0
    reconnections: int = 0


class StreamingAhrs(ABC):
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs` on a link.

    ``boot_time_s``: how long a device that has just been given power may be deaf, bench time.
    ``range_dps``: rates beyond it, with half as much again, cannot be the device's.
    """

    def __init__(
        self,
        link: Link,
        clock: Clock,
        description: DeviceDescription,
        *,
        boot_time_s: float = 5.0,
        range_dps: float = 2000.0,
    ) -> None:
        self.description = description
        self._link = link
        self._clock = clock
        self._boot_time_s = boot_time_s
        self._mute_s = patient_s(clock, _MUTE_S)
        self._range_limit = _in_unit(range_dps, description)
        self._reader = PortReader(link, now_s=clock.now_s)
        self._decoder = self._new_decoder()
        self._screening = self._new_screening()
        self._time_base = TimeBase()
        self._opened = False
        self._streaming = False
        self._configured = False
        self._last_sample_s = 0.0
        self._last_bytes_s: float | None = None
        self._first_connections = 1
        self._recovery: threading.Thread | None = None
        self._failure: AhrsLabError | None = None
        self.last_differences: tuple[Difference, ...] = ()

    # what a protocol adds ─────────────────────────────────────────────────────────────────────────────────

    @abstractmethod
    def _new_decoder(self) -> StreamDecoder:
        """A decoder that has seen nothing yet."""

    @abstractmethod
    def _ask_identity(self) -> str:
        """Model, serial number and firmware, from a paused device."""

    @abstractmethod
    def _pause(self) -> None:
        """Make the device answer commands and send nothing else."""

    @abstractmethod
    def _write_settings(self) -> None:
        """Set what the device shall send."""

    @abstractmethod
    def _settings(self) -> tuple[Mapping[str, str], Mapping[str, str]]:
        """What is wanted and what the device reads back, by the same names."""

    @abstractmethod
    def _resume(self) -> None:
        """Make the device send."""

    @property
    @abstractmethod
    def _frame_bytes(self) -> float:
        """Bytes the device sends for each sample."""

    # the interface ────────────────────────────────────────────────────────────────────────────────────────

    def open(self) -> str:
        """Open the link; its name, for the device may not have its power yet. Raises LinkLostError."""
        self._open()
        return self._link.name

    def identify(self) -> str:
        """Ask the device for its name; leaves it paused unless it streams."""
        self._open()
        self._pause()
        try:
            return self._ask_identity()
        finally:
            if self._streaming:
                self._resume()

    def configure(self) -> tuple[Difference, ...]:
        """Pause the stream, set what it shall send, read it back; what the device says otherwise.

        Raises InputError where the line is too slow for it, InstrumentError where the device does not answer.
        """
        check_line(self._link, self._frame_bytes, self.description.sample_rate_hz)
        self._open()
        self._pause()
        self._write_settings()
        self.last_differences = self._differences()
        self._configured = not self.last_differences
        return self.last_differences

    def start(self) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Ahrs`. Settings are read back each time, and set where
        they differ."""
        check_line(self._link, self._frame_bytes, self.description.sample_rate_hz)
        self._end_recovery()
        self._failure = None
        self._streaming = False
        self._retry_while_booting(self._open)
        self._retry_while_booting(self._pause)
        self._settle_settings()
        self._begin_stream()

    def stop(self) -> None:
        """Pause the device, if it still hears."""
        self._end_recovery()
        was_streaming, self._streaming = self._streaming, False
        if was_streaming and self._opened and self._reader.lost is None:
            try:
                self._pause()
            except InstrumentError:
                # A device that has lost its power cannot be paused, and need not be.
                self._configured = False

    def close(self) -> None:
        """Release the port; the device is left as it is."""
        self._end_recovery()
        self._streaming = self._opened = False
        self._reader.close()

    def read(self) -> Samples:
        """See :class:`~ahrs_lab.instruments.interfaces.Ahrs`. Raises InstrumentError where the link is gone
        for longer than a run can bridge, or the device has restarted."""
        if self._failure is not None:
            failure, self._failure = self._failure, None
            raise failure
        if not self._streaming or self._recovery is not None:
            self._check_gone()
            return Samples()
        samples = self._read_blocks(self._reader.take())
        if len(samples):
            self._last_sample_s = self._clock.now_s()
        else:
            self._check_gone()
        return samples

    # what a screen shows ──────────────────────────────────────────────────────────────────────────────────

    @property
    def counts(self) -> StreamCounts:
        """Of the stream since its start."""
        decoded: LinkCounts = self._decoder.counts
        screened = self._screening
        return StreamCounts(
            decoded.received_bytes,
            decoded.frames,
            decoded.failed,
            decoded.skipped_bytes,
            decoded.untimed,
            screened.lost,
            screened.repeated,
            screened.implausible,
            max(self._reader.connections - self._first_connections, 0),
        )

    @property
    def link_counts(self) -> dict[str, int]:
        """The counts by name; see :class:`~ahrs_lab.instruments.interfaces.CountsLink`."""
        return {name: int(value) for name, value in vars(self.counts).items()}

    @property
    def time_relation(self) -> TimeRelation | None:
        """Device time against bench time; None before the first sample."""
        return self._time_base.relation

    @property
    def link_name(self) -> str:
        """Where it hangs."""
        return self._link.name

    def keep_raw(self, stem: Path | None) -> None:
        """From now on keep what arrives in ``stem``.bin and .idx; None ends it."""
        self._reader.keep_raw(None if stem is None else RawLog(stem))

    # the conversation ─────────────────────────────────────────────────────────────────────────────────────

    def _ask(
        self, request: bytes, answers: Callable[[Any], _R | None], what: str, *, tries: int = _TRIES
    ) -> _R:
        """Send ``request`` and return what ``answers`` makes of the first reply that it takes for one; asks
        again where none comes. What else arrives meanwhile is dropped."""
        for _ in range(tries):
            self._decoder.replies.clear()
            self._link.write(request)
            found = self._wait_for(answers)
            if found is not None:
                return found
        raise self._unanswered(what)

    def _wait_for(self, answers: Callable[[Any], _R | None]) -> _R | None:
        end = time.monotonic() + ANSWER_TIMEOUT_S
        while (left := end - time.monotonic()) > 0.0:
            for block in self._reader.take(left):
                if block.kind is BlockKind.LOST:
                    raise self._reader.lost or LinkLostError("The link {name} is gone.", name=self._link.name)
                if block.data:
                    self._last_bytes_s = block.t_s
                    self._decoder.feed(block.data)
            replies, self._decoder.replies[:] = list(self._decoder.replies), []
            for reply in replies:
                found = answers(reply)
                if found is not None:
                    return found
        return None

    def _unanswered(self, what: str) -> InstrumentError:
        counts = self._decoder.counts
        if self._last_bytes_s is None or not counts.received_bytes:
            return InstrumentError(
                "The device on {port} does not answer ({what}): check its power, its cable and the baud "
                "rate.",
                port=self._link.name,
                what=what,
            )
        return InstrumentError(
            "The device on {port} does not answer ({what}) although {received} bytes came, of which "
            "{skipped} made no frame: check the baud rate and the protocol.",
            port=self._link.name,
            what=what,
            received=counts.received_bytes,
            skipped=counts.skipped_bytes,
        )

    def _open(self) -> None:
        if not self._opened:
            self._reader.start()
            self._opened = True
        elif self._reader.lost is not None:
            raise self._reader.lost

    def _retry_while_booting(self, call: Callable[[], None]) -> None:
        """Until it works, or until the device should have booted."""
        end = self._clock.now_s() + patient_s(self._clock, self._boot_time_s)
        while True:
            try:
                call()
            except InstrumentError:
                if self._clock.now_s() >= end:
                    raise
                self._clock.wait(min(_RETRY_S, self._boot_time_s))
            else:
                return

    def _differences(self) -> tuple[Difference, ...]:
        wanted, found = self._settings()
        return tuple(
            Difference(name, value, found.get(name, "–"))
            for name, value in wanted.items()
            if found.get(name) != value
        )

    def _settle_settings(self) -> None:
        """Settings verified; set again where the device has others, refused where it keeps them."""
        if self._configured and not self._differences():
            return
        self._write_settings()
        self.last_differences = self._differences()
        self._configured = not self.last_differences
        if self.last_differences:
            raise InstrumentError(
                "The device does not take its settings: {difference} It was not started.",
                difference=self.last_differences[0].message,
            )

    def _begin_stream(self) -> None:
        self._reader.take()
        self._decoder = self._new_decoder()
        self._screening = self._new_screening()
        self._time_base = TimeBase()
        self._first_connections = self._reader.connections
        self._last_sample_s = self._clock.now_s()
        self._last_bytes_s = None
        self._resume()
        self._streaming = True

    # the stream ───────────────────────────────────────────────────────────────────────────────────────────

    def _new_screening(self) -> Screening:
        early_s = patient_s(self._clock, EARLY_S, 1.0)
        return Screening(1.0 / self.description.sample_rate_hz, self._range_limit, early_s)

    def _read_blocks(self, blocks: Sequence[Block]) -> Samples:
        arrived: list[Samples] = []
        for block in blocks:
            if block.kind is BlockKind.LOST:
                # Half a frame from before the gap and half of one from behind it are not to become one.
                arrived.append(self._stamped(self._decoder.flush(), block.t_s))
            if block.kind is BlockKind.BACK:
                self._recover()
                if self._recovery is not None:
                    break
            if block.data:
                self._last_bytes_s = block.t_s
                arrived.append(self._stamped(self._decoder.feed(block.data), block.t_s))
        samples = joined(arrived)
        if not len(samples):
            return samples
        if self._decoder.filtered_rates:
            raise InstrumentError(
                "The device sends rates that its own filter took its estimate of bias off: they are not "
                "fit for calibration. Set it to send its uncompensated rates."
            )
        samples = self._screening.take(samples)
        self._time_base.add(samples["t_s"], samples["host_t_s"]) if len(samples) else None
        return samples

    def _stamped(self, samples: Samples, host_t_s: float) -> Samples:
        if not len(samples):
            return samples
        host = np.full(len(samples), host_t_s)
        if "t_s" in samples:
            return samples.with_columns({"host_t_s": host})
        raise InstrumentError(
            "The device on {port} sends neither time nor counter: its samples cannot be placed in time. Set "
            "its output to include one of them, or describe its sample rate.",
            port=self._link.name,
        )

    def _check_gone(self) -> None:
        if not self._streaming or self._clock.now_s() - self._last_sample_s < self._mute_s:
            return
        if self._reader.lost is not None:
            raise self._reader.lost
        if self._recovery is not None or self._last_bytes_s is None:
            return
        if self._clock.now_s() - self._last_bytes_s < self._mute_s:
            counts = self._decoder.counts
            raise InstrumentError(
                "The device on {port} sends, but for {silence} s nothing of what it was set to: {failed} "
                "frames failed, {skipped} bytes made none. It may have restarted with other settings, or "
                "the line is disturbed.",
                port=self._link.name,
                silence=round(self._clock.now_s() - self._last_sample_s, 1),
                failed=counts.failed,
                skipped=counts.skipped_bytes,
            )

    # the link came back ───────────────────────────────────────────────────────────────────────────────────

    def _recover(self) -> None:
        self._recovery = threading.Thread(
            target=self._verify_again, name=f"recovery {self._link.name}", daemon=True
        )
        self._recovery.start()

    def _verify_again(self) -> None:
        """Settings verified after the link came back; the time goes on, so the gap is in the record."""
        try:
            for left in reversed(range(_RECOVERY_TRIES)):
                try:
                    self._pause()
                    break
                except InstrumentError:
                    if not left:
                        raise
            self._settle_settings()
            self._resume()
            # Its silence so far was the cable's: from here on it has as long as any other to send.
            self._last_sample_s = self._clock.now_s()
        except AhrsLabError as error:
            self._failure = error
        finally:
            self._recovery = None

    def _end_recovery(self) -> None:
        thread = self._recovery
        if thread is not None:
            thread.join()

    def _named(self, model: str = "", serial_number: str = "") -> None:
        """Fill in of the description what the settings left empty."""
        known = self.description
        self.description = replace(
            known, model=known.model or model, serial_number=known.serial_number or serial_number
        )


def _in_unit(range_dps: float, description: DeviceDescription) -> float:
    if description.rate_unit == "rad/s":
        return radians(range_dps)
    return range_dps if description.rate_unit == "deg/s" else float("inf")
