"""Who mounts the case, and sets by hand what has no wire, where there is no screen: a person at a terminal,
or the hands of a served virtual bench."""

from __future__ import annotations

import queue
import socket
import sys
import threading
from typing import TextIO

from ahrs_lab.errors import AbortedError, InstrumentError
from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.messages import Message
from ahrs_lab.recording.orientation import Orientation

_LOOK_S = 0.1
_TIMEOUT_S = 5.0


class TerminalOperator:
    """An :class:`~ahrs_lab.instruments.interfaces.Operator` and
    :class:`~ahrs_lab.instruments.by_hand.Setter` who confirms with Enter."""

    def __init__(self, answers: TextIO | None = None, questions: TextIO | None = None) -> None:
        self._answers = answers or sys.stdin
        self._questions = questions or sys.stderr
        self._lines: queue.Queue[str] = queue.Queue()
        self._reader: threading.Thread | None = None
        self._given_up = threading.Event()

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:  # noqa: ARG002
        """See :class:`~ahrs_lab.instruments.interfaces.Operator`."""
        self._show(
            Message(
                "Mount the case so that its x, y and z point to {letters} (E east, N north, U up, W west, "
                "S south, D down) with the table at its home angle.",
                letters=" ".join(orientation.letters),
            )
        )
        while not self._confirmed(_LOOK_S):
            pass

    def ask(self, request: HandRequest, because: Message | None = None) -> None:
        """See :class:`~ahrs_lab.instruments.by_hand.Setter`."""
        if because is not None:
            self._questions.write(f"\n{because.text()}")
        self._show(request.message)

    def has_set(self, wait_s: float) -> bool:
        """See :class:`~ahrs_lab.instruments.by_hand.Setter`."""
        return self._confirmed(wait_s)

    def interrupt(self) -> None:
        """Nobody will answer any more."""
        self._given_up.set()

    def _show(self, request: Message) -> None:
        self._given_up.clear()
        self._questions.write(f"\n{request.text()}\nEnter: done, q: stop the run. ")
        self._questions.flush()
        if self._reader is None or not self._reader.is_alive():
            # A thread of its own: a line that is waited for cannot be interrupted on every system.
            self._reader = threading.Thread(target=self._read, name="terminal-operator", daemon=True)
            self._reader.start()

    def _confirmed(self, wait_s: float) -> bool:
        """Whether the person has confirmed; raises AbortedError where the person answers “q”, where there is
        nobody, and when the run is stopped meanwhile."""
        if self._given_up.is_set():
            raise AbortedError("The run was stopped while the operator was asked.")
        try:
            line = self._lines.get(timeout=wait_s)
        except queue.Empty:
            return False
        if not line:
            raise AbortedError("Nobody is at the terminal to answer: the input has ended.")
        if line.strip().lower() in ("q", "quit"):
            raise AbortedError("The run was stopped while the operator was asked.")
        return True

    def _read(self) -> None:
        self._lines.put(self._answers.readline())


class SimulatedHands:
    """The fixture of a bench that ``ahrs-lab simulate`` serves."""

    def __init__(self, host: str, port: int) -> None:
        self._address = (host, port)

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:  # noqa: ARG002
        """See :class:`~ahrs_lab.instruments.interfaces.Operator`."""
        self.say(f"mount {orientation.letters}")

    def say(self, text: str) -> str:
        """One request to the served bench; its answer. Raises InstrumentError where it refuses."""
        try:
            with socket.create_connection(self._address, _TIMEOUT_S) as connection:
                connection.sendall(text.encode("ascii") + b"\r\n")
                answer = connection.makefile("r", encoding="utf-8").readline()
        except OSError as error:
            raise InstrumentError(
                "The simulated fixture at {host}:{port} does not answer ({reason}): is the bench still "
                "served?",
                host=self._address[0],
                port=self._address[1],
                reason=error.strerror or str(error),
            ) from error
        state, _, rest = answer.strip().partition(" ")
        if state != "OK":
            raise InstrumentError(
                "The simulated fixture refuses “{request}”: {reason}", request=text, reason=rest
            )
        return rest
