"""The application's side of the supervisor: start it, let the heart beat, take leave."""

from __future__ import annotations

import contextlib
import json
import queue
import subprocess
import sys
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ahrs_lab.errors import InstrumentError, MachineError
from ahrs_lab.instruments.registry import LinkMaker
from ahrs_lab.instruments.supervisor.heart import Heart, Pulse
from ahrs_lab.instruments.supervisor.making import relayed
from ahrs_lab.instruments.supervisor.supervisor import BEAT, FAREWELL, SILENCE_S, Charge
from ahrs_lab.messages import Message

_READY_LIMIT_S = 15.0
_LEAVE_LIMIT_S = 5.0
_STOP_LIMIT_S = 30.0


class Supervisor:
    """A supervising process and the heart that it listens to. Use as a context manager, or close it after the
    bench: a supervisor that hears no farewell stops table and supply.

    ``table`` and ``supply`` are the bench's TOML tables of these names; either may be missing.
    """

    def __init__(
        self,
        table: Mapping[str, Any] | None,
        supply: Mapping[str, Any] | None = None,
        *,
        silence_s: float = SILENCE_S,
        speed: float = 1.0,
        report: Path | None = None,
    ) -> None:
        self._charge = Charge(table, supply, silence_s, speed)
        self._report = report
        self._process: subprocess.Popen[str] | None = None
        self._port = 0
        self._told: queue.Queue[dict[str, Any]] = queue.Queue()
        self._reader: threading.Thread | None = None
        self._write = threading.Lock()
        self.heart = Heart(lambda: self._say(BEAT))
        self.stopped: Message | None = None
        """Why the supervisor has stopped the bench, once it has."""

    def __enter__(self) -> Supervisor:
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    @property
    def process_id(self) -> int | None:
        """Of the supervising process; None before the start and after the end."""
        return None if self._process is None else self._process.pid

    @property
    def running(self) -> bool:
        """Whether the supervising process is there."""
        return self._process is not None and self._process.poll() is None

    def start(self) -> None:
        """Start the process and the heart. Raises InstrumentError where the table does not answer,
        MachineError where the process does not start."""
        command = [sys.executable, "-m", "ahrs_lab.instruments.supervisor"]
        if self._report is not None:
            command += ["--report", str(self._report)]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                start_new_session=True,
            )
        except OSError as error:
            raise MachineError(
                "The supervisor of the bench cannot be started ({reason}).",
                reason=error.strerror or str(error),
            ) from error
        self._reader = threading.Thread(target=self._listen, name="supervisor's words", daemon=True)
        self._reader.start()
        self._say(self._charge.to_line())
        self.heart.start()
        try:
            first = self._told.get(timeout=_READY_LIMIT_S)
            self._take_first(first)
        except queue.Empty:
            self.close()
            raise MachineError("The supervisor of the bench does not answer.") from None
        except InstrumentError:
            self.close()
            raise

    def _take_first(self, told: dict[str, Any]) -> None:
        if "refused" in told:
            raise InstrumentError(Message.from_json(told["refused"]))
        if "port" not in told:
            raise InstrumentError("The supervisor of the bench has ended at once: look at its error output.")
        self._port = int(told["port"])

    @property
    def table_links(self) -> LinkMaker:
        """What the table's driver makes its link with
        (:attr:`~ahrs_lab.instruments.registry.Surroundings.link`): it leads through the supervisor."""
        return relayed(self._port)

    def needs(self, name: str, limit_s: float) -> Pulse:
        """See :meth:`Heart.needs`."""
        return self.heart.needs(name, limit_s)

    def close(self) -> None:
        """Take leave: the bench has been left in order, nothing is stopped. May be called again."""
        self._end(farewell=True, limit_s=_LEAVE_LIMIT_S)

    def abandon(self) -> None:
        """End without a farewell: the bench could not be left in order, and the supervisor shall try to stop
        it. Waits for that."""
        self._end(farewell=False, limit_s=_STOP_LIMIT_S)

    def _end(self, *, farewell: bool, limit_s: float) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        self.heart.stop()
        if farewell:
            self._say(FAREWELL, process)
        if process.stdin is not None:
            with contextlib.suppress(OSError):
                process.stdin.close()
        try:
            process.wait(limit_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if self._reader is not None:
            self._reader.join()
        if process.stdout is not None:
            process.stdout.close()

    def _say(self, line: str, process: subprocess.Popen[str] | None = None) -> None:
        process = process or self._process
        if process is None or process.stdin is None:
            return
        with self._write, contextlib.suppress(OSError, ValueError):
            # A supervisor that has gone shows in `running` and in the table's lost link.
            process.stdin.write(line + "\n")
            process.stdin.flush()

    def _listen(self) -> None:
        process = self._process
        if process is None or process.stdout is None:
            return
        for line in process.stdout:
            with contextlib.suppress(ValueError):
                told = json.loads(line)
                if "stopped" in told:
                    self.stopped = Message.from_json(told["stopped"])
                self._told.put(told)
        self._told.put({})
