"""The supervising process: lends the table's wire, listens for the heart, stops the bench when it is still.

Standard input brings one line of JSON (what is supervised), then ``beat`` lines, then ``farewell`` from an
application that leaves the bench in order. Its end without a farewell, or silence, is the heart's stop.
Standard output tells ``{"port": n}`` or ``{"refused": …}`` first, and ``{"stopped": …}`` at the end.
"""

from __future__ import annotations

import json
import queue
import signal
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import IO, Any

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.instruments.supervisor.last_stop import stop_bench
from ahrs_lab.instruments.supervisor.relay import Relay
from ahrs_lab.instruments.supervisor.supervised import Supervised
from ahrs_lab.messages import Message

BEAT, FAREWELL = "beat", "farewell"
SILENCE_S = 1.0


@dataclass(frozen=True)
class Charge:
    """What the application entrusts: the tables ``table`` and ``supply`` of the bench's TOML (either may be
    missing), how long the heart may be silent, and how much faster than time the bench runs."""

    table: Mapping[str, Any] | None = None
    supply: Mapping[str, Any] | None = None
    silence_s: float = SILENCE_S
    speed: float = 1.0

    @classmethod
    def from_line(cls, line: str) -> Charge:
        """From the first line of standard input; raises ValueError where it is none."""
        data = json.loads(line)
        return cls(
            data.get("table"), data.get("supply"), float(data["silence_s"]), float(data.get("speed", 1.0))
        )

    def to_line(self) -> str:
        """The inverse."""
        return json.dumps(vars(self))


class Listening:
    """A thread that reads lines, so that waiting for the next one can have a time limit."""

    def __init__(self, stream: IO[str]) -> None:
        self._lines: queue.Queue[str | None] = queue.Queue()
        threading.Thread(
            target=self._work, args=(stream,), name="heart of the application", daemon=True
        ).start()

    def _work(self, stream: IO[str]) -> None:
        try:
            for line in stream:
                self._lines.put(line.strip())
        except (OSError, ValueError):
            pass  # the same as its end
        self._lines.put(None)

    def line(self, timeout_s: float | None) -> str | None:
        """The next line, None at the end. Raises queue.Empty after ``timeout_s``."""
        return self._lines.get(timeout=timeout_s)


def supervise(
    listening: Listening,
    tell: Callable[[dict[str, Any]], None],
    *,
    supervised: Callable[[Charge, Clock], Supervised] = Supervised.of,
) -> int:
    """Until the farewell (returns 0), or until the heart stops and the bench is stopped (1; 2 where that did
    not work)."""
    first = listening.line(None)
    if first is None:
        return 0
    charge = Charge.from_line(first)
    clock = RealClock(charge.speed)
    relay: Relay | None = None
    try:
        bench = supervised(charge, clock)
        link = bench.table_link()
        relay = Relay(link) if link is not None else None
        if relay is not None:
            relay.start()
    except AhrsLabError as error:
        tell({"refused": error.message.to_json()})
        return 0
    tell({"port": relay.port if relay is not None else 0})
    try:
        why = _wait_for_stop(listening, charge.silence_s)
        if why is None:
            return 0
        problems = _stop(bench, relay, clock)
        tell(_report(why, problems))
        return 2 if problems else 1
    finally:
        if relay is not None:
            relay.close()


def _wait_for_stop(listening: Listening, silence_s: float) -> Message | None:
    """Why the bench has to be stopped; None after a farewell."""
    while True:
        try:
            line = listening.line(silence_s)
        except queue.Empty:
            return Message("The application gave no sign of life for {silence} s.", silence=silence_s)
        if line == FAREWELL:
            return None
        if line is None:
            return Message("The application ended without taking leave.")


def _stop(bench: Supervised, relay: Relay | None, clock: Clock) -> tuple[Message, ...]:
    problems: list[Message] = []
    table = None
    if relay is not None and relay.used:
        try:
            table = bench.table(relay.renew())
        except AhrsLabError as error:
            problems.append(error.message)
    supply = None
    try:
        supply = bench.supply()
    except AhrsLabError as error:
        problems.append(error.message)
    problems += stop_bench(table, supply, clock, rate_to_zero=bench.rate_to_zero)
    problems += bench.close()
    return tuple(dict.fromkeys(problems))


def _report(why: Message, problems: tuple[Message, ...]) -> dict[str, Any]:
    return {
        "stopped": why.to_json(),
        "problems": [problem.to_json() for problem in problems],
        "at": datetime.now(UTC).isoformat(timespec="seconds"),
    }


class Teller:
    """Writes to the application, and what counts into a file that outlives it."""

    def __init__(self, stream: IO[str], report: Path | None) -> None:
        self._stream = stream
        self._report = report

    def __call__(self, data: dict[str, Any]) -> None:
        """Never raises: nobody may be listening any more, and the bench counts more than the report."""
        line = json.dumps(data, ensure_ascii=False)
        if self._report is not None and "stopped" in data:
            try:
                with self._report.open("a", encoding="utf-8") as file:
                    file.write(line + "\n")
            except OSError as error:
                print(f"{self._report}: {error}", file=sys.stderr)
        try:
            self._stream.write(line + "\n")
            self._stream.flush()
        except (OSError, ValueError):
            return


def main(report: Path | None) -> int:
    """The process."""
    # Ctrl-C and a closed terminal are the application's business: it stops the bench itself, or ends.
    for name in ("SIGINT", "SIGHUP", "SIGPIPE"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    return supervise(Listening(sys.stdin), Teller(sys.stdout, report))
