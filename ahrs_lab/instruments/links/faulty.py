"""A link with everything that goes wrong on wires, drawn from a seed: for tests and for simulated benches.

What happens to a byte depends on its place in the stream and on nothing else, so the same bytes suffer the
same however they were split.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.settings import settings_from_toml, within

_POLL_S = 0.005
_DRAWS = 4


@dataclass(frozen=True)
class LinkFaults:
    """How bad the wire is. ``lose``, ``double``, ``flip`` (one bit): probability of each byte. ``split``:
    probability that what arrived is handed on in two. ``merge_s``: bytes are handed on only at multiples of
    it (USB adapters bunch by 0.016). After ``stall_after`` bytes nothing comes for ``stall_s``; after
    ``disconnect_after`` bytes the link is lost and cannot be opened for ``disconnect_s``; both happen once
    for 0, or each time so many bytes have passed where ``again`` is set. ``writes``: bytes written suffer
    too."""

    lose: float = 0.0
    double: float = 0.0
    flip: float = 0.0
    split: float = 0.0
    merge_s: float = 0.0
    stall_after: int = 0
    stall_s: float = 0.0
    disconnect_after: int = 0
    disconnect_s: float = 0.0
    again: bool = False
    writes: bool = False

    def __post_init__(self) -> None:
        for key in ("lose", "double", "flip", "split"):
            within(f"faults.{key}", getattr(self, key), 0.0, 1.0)
        for key in ("merge_s", "stall_s", "disconnect_s"):
            within(f"faults.{key}", getattr(self, key), 0.0, 3600.0)
        for key in ("stall_after", "disconnect_after"):
            within(f"faults.{key}", getattr(self, key), 0, 2**62)


def faults_from_text(text: str) -> LinkFaults:
    """From ``"lose=1e-5,split=0.2,again=true"``, as it stands on a command line. Raises InputError."""
    import tomllib

    lines = "\n".join(part.strip() for part in text.split(",") if part.strip())
    try:
        table = tomllib.loads(lines)
    except ValueError as error:
        raise InputError(
            "“{text}” does not say what goes wrong with a link; write it like lose=1e-5,merge_s=0.016.",
            text=text,
        ) from error
    return settings_from_toml(LinkFaults, table, "faults")


class ByteDamage:
    """Loses, doubles and flips bytes of one direction."""

    def __init__(self, faults: LinkFaults, seed: int | np.random.SeedSequence) -> None:
        self._faults = faults
        self._rng = np.random.Generator(np.random.PCG64(seed))

    def apply(self, data: bytes) -> bytes:
        """``data`` as it arrives."""
        faults = self._faults
        if not data or not (faults.lose or faults.double or faults.flip):
            return data
        draws = self._rng.random((len(data), _DRAWS))
        values = np.frombuffer(data, dtype=np.uint8)
        flipped = draws[:, 0] < faults.flip
        bits: NDArray[np.uint8] = np.left_shift(1, (draws[:, 1] * 8.0).astype(np.uint8)).astype(np.uint8)
        values = np.where(flipped, values ^ bits, values)
        counts = np.where(draws[:, 2] < faults.lose, 0, np.where(draws[:, 3] < faults.double, 2, 1))
        return np.repeat(values, counts).astype(np.uint8).tobytes()


class FaultyLink:
    """A :class:`~ahrs_lab.instruments.links.link.Link` around another one."""

    def __init__(
        self,
        link: Link,
        faults: LinkFaults,
        seed: int = 1,
        *,
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self._link = link
        self._faults = faults
        self._now_s = now_s
        reads, writes, splits = np.random.SeedSequence(seed).spawn(3)
        self._reads = ByteDamage(faults, reads)
        self._writes = ByteDamage(faults, writes)
        self._split_rng = np.random.Generator(np.random.PCG64(splits))
        self._held = b""
        self._held_since_s = 0.0
        self._passed = 0
        self._next_stall = faults.stall_after or None
        self._next_disconnect = faults.disconnect_after or None
        self._silent_until_s = float("-inf")
        self._away_until_s: float | None = None
        self._lock = threading.Lock()

    @property
    def name(self) -> str:
        """Of the link inside."""
        return self._link.name

    @property
    def bits_per_second(self) -> int | None:
        """Of the link inside."""
        return self._link.bits_per_second

    def disconnect(self, seconds: float) -> None:
        """Pull the plug now, from any thread."""
        with self._lock:
            self._away_until_s = self._now_s() + seconds

    def stall(self, seconds: float) -> None:
        """Nothing comes through for ``seconds`` from now; what is sent meanwhile comes afterwards."""
        with self._lock:
            self._silent_until_s = self._now_s() + seconds

    def open(self) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        with self._lock:
            if self._away_until_s is not None and self._now_s() < self._away_until_s:
                raise self._gone()
            self._away_until_s = None
        self._link.open()

    def close(self) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        self._held = b""
        self._link.close()

    def read(self, timeout_s: float) -> bytes:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        end = self._now_s() + timeout_s
        while True:
            self._check_plug()
            now = self._now_s()
            open_at = self._opens_at()
            if self._held and now >= open_at:
                return self._hand_on()
            if now >= end:
                return b""
            # What comes while bytes are held joins them, so the wire inside is drained all the time.
            waiting = bool(self._held) or now < self._silent_until_s
            arrived = self._link.read(min(end - now, _POLL_S) if waiting else end - now)
            if arrived:
                if not self._held:
                    self._held_since_s = self._now_s()
                self._held += self._reads.apply(arrived)
                self._count(len(arrived))

    def write(self, data: bytes) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        self._check_plug()
        self._link.write(self._writes.apply(data) if self._faults.writes else data)

    def _opens_at(self) -> float:
        """When what is held may be handed on."""
        step = self._faults.merge_s
        merged = math.ceil(self._held_since_s / step) * step if step else self._held_since_s
        return max(merged, self._silent_until_s)

    def _hand_on(self) -> bytes:
        data, self._held = self._held, b""
        if self._faults.split and len(data) > 1 and self._split_rng.random() < self._faults.split:
            at = int(self._split_rng.integers(1, len(data)))
            data, self._held = data[:at], data[at:]
        return data

    def _count(self, arrived: int) -> None:
        faults = self._faults
        self._passed += arrived
        if self._next_stall is not None and self._passed >= self._next_stall:
            self._next_stall = self._passed + faults.stall_after if faults.again else None
            self.stall(faults.stall_s)
        if self._next_disconnect is not None and self._passed >= self._next_disconnect:
            self._next_disconnect = self._passed + faults.disconnect_after if faults.again else None
            self.disconnect(faults.disconnect_s)

    def _check_plug(self) -> None:
        with self._lock:
            if self._away_until_s is not None:
                raise self._gone()

    def _gone(self) -> LinkLostError:
        return LinkLostError("{name} is unplugged (a fault that was asked for).", name=self.name)
