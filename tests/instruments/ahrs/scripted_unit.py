"""A unit at the other end of a wire that answers exactly what is written down for it."""

from __future__ import annotations

import queue
from collections.abc import Sequence

from ahrs_lab.instruments.links.link import LinkLostError


class ScriptedLink:
    """A link whose other side knows ``dialogue``: (what it hears, what it answers), in any order, each as
    often as it is heard. What it does not know it does not answer."""

    name = "scripted"

    def __init__(self, dialogue: Sequence[tuple[bytes, bytes]], bits_per_second: int | None = None) -> None:
        self.dialogue = dict(dialogue)
        self.bits_per_second = bits_per_second
        self.heard: list[bytes] = []
        self.plugged = True
        self._arriving: queue.Queue[bytes | None] = queue.Queue()

    def open(self) -> None:
        if not self.plugged:
            raise LinkLostError("{name} is not plugged in.", name=self.name)

    def close(self) -> None:
        """Nothing to release."""

    def send(self, data: bytes) -> None:
        """The unit says something by itself."""
        self._arriving.put(data)

    def unplug(self) -> None:
        self.plugged = False
        self._arriving.put(None)

    def read(self, timeout_s: float) -> bytes:
        try:
            data = self._arriving.get(timeout=timeout_s)
        except queue.Empty:
            return b""
        if data is None:
            raise LinkLostError("{name} was pulled out.", name=self.name)
        return data

    def write(self, data: bytes) -> None:
        self.heard.append(data)
        answer = self.dialogue.get(data, b"")
        if answer:
            self.send(answer)
