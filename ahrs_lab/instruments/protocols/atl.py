"""Ideal Aerosmith ATL (1270 and older): three letters, a number, CR LF; the answer is ``value CR LF > CR
LF``.

Experimental: known from one user's code only.
"""

from __future__ import annotations

from ahrs_lab.instruments.protocols.frames import LinkCounts
from ahrs_lab.instruments.protocols.lines import LineDecoder

PROMPT = ">"


def encode_command(word: str, value: float | None = None) -> bytes:
    """``MOV 12.5`` CR LF."""
    number = "" if value is None else f" {value:.6f}".rstrip("0").rstrip(".")
    return f"{word}{number}\r\n".encode("ascii", errors="replace")


class AnswerDecoder:
    """Gives one tuple of lines for each prompt: empty where there was nothing but the prompt."""

    def __init__(self) -> None:
        self._lines = LineDecoder(b"\r\n", 256)
        self._values: list[str] = []

    @property
    def counts(self) -> LinkCounts:
        """Of the lines."""
        return self._lines.counts

    def feed(self, data: bytes) -> list[tuple[str, ...]]:
        """The answers completed by ``data``."""
        answers: list[tuple[str, ...]] = []
        for line in self._lines.feed(data):
            text = line.strip()
            if text == PROMPT:
                answers.append(tuple(self._values))
                self._values = []
            elif text:
                self._values.append(text)
        return answers

    def flush(self) -> list[tuple[str, ...]]:
        """Forget an answer that was not finished."""
        self._lines.flush()
        self._values = []
        return []


def encode_answer(*values: str) -> bytes:
    """The table's side."""
    return "".join(f"{value}\r\n" for value in (*values, PROMPT)).encode("ascii", errors="replace")
