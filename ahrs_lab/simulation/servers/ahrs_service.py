"""The virtual unit behind a serial line: its samples in its own protocol, paced by its own clock."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from ahrs_lab.instruments.links.faulty import ByteDamage, LinkFaults
from ahrs_lab.recording.samples import Samples, concatenate
from ahrs_lab.simulation.servers.connections import Connection, PtyConnection
from ahrs_lab.simulation.servers.served_world import ServedWorld

_GARBLE = 0xA5


class Speech(Protocol):
    """A unit's protocol, from the unit's side."""

    reboots: bool
    """Set where it was told to restart; whoever does it takes it back."""

    @property
    def streaming(self) -> bool:
        """Whether it sends by itself now."""
        ...

    @property
    def rate_hz(self) -> float:
        """Of the samples it sends; a whole fraction of the world's."""
        ...

    def boot(self) -> bytes:
        """Back to the settings it is switched on with; what it says at that."""
        ...

    def hear(self, data: bytes) -> bytes:
        """The answers to the commands that ``data`` completes."""
        ...

    def say(self, samples: Samples) -> bytes:
        """Samples as it sends them."""
        ...


@dataclass(frozen=True)
class UnitFaults:
    """What goes wrong with the unit and its line. ``counter_start`` and ``time_start_s`` make its counter and
    time wrap early; ``reboot_at_s`` is bench time; 0: never. ``baud`` is its line rate, 0: any."""

    link: LinkFaults = field(default_factory=LinkFaults)
    seed: int = 1
    counter_start: int = 0
    time_start_s: float = 0.0
    reboot_at_s: float = 0.0
    baud: int = 0


class AhrsService:
    """Sends the world's samples to everybody who is connected and answers their commands, like a line with
    several listeners."""

    latency_s = 0.001

    def __init__(self, served: ServedWorld, speech: Speech, faults: UnitFaults | None = None) -> None:
        self.served = served
        self.speech = speech
        self.faults = faults or UnitFaults()
        self.sent_samples = 0
        self._damage = ByteDamage(self.faults.link, self.faults.seed)
        self._connections: list[Connection] = []
        self._sessions = len(served.world.ahrs.sessions)
        self._left: Samples = Samples()
        self._held: list[bytes] = []
        self._passed = 0
        self._silent_until_s = 0.0
        self._bunch = -1.0
        self.ticked_s = 0.0
        """Bench time up to which everything is sent."""
        self._rebooted = False
        speech.boot()

    def connected(self, connection: Connection) -> None:
        self._connections.append(connection)

    def gone(self, connection: Connection) -> None:
        self._connections = [known for known in self._connections if known is not connection]

    @property
    def sent_bytes(self) -> int:
        """Taken by the system so far, for all who are connected."""
        return sum(connection.sent_bytes for connection in self._connections)

    def answer(self, connection: Connection, data: bytes) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.serving.Service`."""
        if not self.served.powered:
            return b""
        self._notice_boot(self.served.now_s)
        if self._wrong_baud(connection):
            data = _garbled(data)
        answer = self.speech.hear(data)
        if self.speech.reboots:
            self.speech.reboots = False
            self.served.reboot()
        answer = self._damage.apply(answer)
        return _garbled(answer) if self._wrong_baud(connection) else answer

    def tick(self, now_s: float) -> None:
        """See :class:`~ahrs_lab.simulation.servers.serving.Service`."""
        faults = self.faults
        if faults.reboot_at_s and not self._rebooted and now_s >= faults.reboot_at_s:
            self._rebooted = True
            self.served.reboot()
        self._notice_boot(now_s)
        samples = self.served.world.ahrs.read()
        if len(samples) and self.speech.streaming:
            samples = self._at_its_rate(self._with_offsets(samples))
            if len(samples):
                self.sent_samples += len(samples)
                self._send(self.speech.say(samples), now_s)
        self._release(now_s)
        self.ticked_s = now_s

    def _notice_boot(self, now_s: float) -> None:
        sessions = len(self.served.world.ahrs.sessions)
        if sessions != self._sessions:
            self._sessions = sessions
            self._left = Samples()
            self._send(self.speech.boot(), now_s)

    def _with_offsets(self, samples: Samples) -> Samples:
        return samples.with_columns(
            {
                "t_s": samples["t_s"] + self.faults.time_start_s,
                "counter": samples["counter"] + self.faults.counter_start,
            }
        )

    def _at_its_rate(self, samples: Samples) -> Samples:
        """Means over as many samples as the unit's rate leaves out, so that nothing of the motion is lost."""
        world_hz = self.served.world.ahrs.description.sample_rate_hz
        every = round(world_hz / self.speech.rate_hz)
        if every <= 1:
            return samples
        waiting = concatenate([self._left, samples])
        groups = np.floor((waiting["counter"] - self.faults.counter_start - 1.0) / every)
        complete = waiting["counter"] - self.faults.counter_start >= (groups[-1] + 1.0) * every - 0.5
        whole = len(waiting) if complete[-1] else int(np.searchsorted(groups, groups[-1]))
        self._left = waiting.rows(whole)
        if not whole:
            return Samples()
        starts = np.flatnonzero(np.diff(groups[:whole], prepend=groups[0] - 1.0))
        counts = np.diff(starts, append=whole)
        columns = {
            name: np.add.reduceat(column[:whole], starts) / counts for name, column in waiting.columns.items()
        }
        last = np.append(starts[1:], whole) - 1
        columns["t_s"] = waiting["t_s"][last]
        columns["counter"] = groups[starts] + 1.0 + self.faults.counter_start
        return Samples(columns)

    def _send(self, data: bytes, now_s: float) -> None:
        if not data:
            return
        link = self.faults.link
        self._passed += len(data)
        if link.stall_after and self._passed >= link.stall_after and not self._silent_until_s:
            self._silent_until_s = now_s + link.stall_s
        self._held.append(self._damage.apply(data))

    def _release(self, now_s: float) -> None:
        """Bytes leave at once, or in bunches, or after a stall."""
        if not self._held or now_s < self._silent_until_s:
            return
        merge = self.faults.link.merge_s
        if merge:
            if now_s // merge == self._bunch:
                return
            self._bunch = now_s // merge
        data, self._held = b"".join(self._held), []
        for connection in self._connections:
            connection.send(_garbled(data) if self._wrong_baud(connection) else data)

    def _wrong_baud(self, connection: Connection) -> bool:
        return bool(
            self.faults.baud and isinstance(connection, PtyConnection) and connection.baud != self.faults.baud
        )


def _garbled(data: bytes) -> bytes:
    """What a line makes of bytes that are read at another rate: something else, always the same."""
    values = np.frombuffer(data, np.uint8)
    return ((values >> 1) ^ _GARBLE | 0x80).astype(np.uint8).tobytes()
