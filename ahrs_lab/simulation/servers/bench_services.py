"""Table, supply, room and fixture of the virtual bench as they answer on their ports."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.protocols.acutrol import encode_reply
from ahrs_lab.instruments.protocols.acutrol_responder import AclResponder
from ahrs_lab.instruments.protocols.lines import LineDecoder
from ahrs_lab.instruments.simulated_identity import simulated_name
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.faults import FAULT_NAMES
from ahrs_lab.simulation.servers.connections import Connection
from ahrs_lab.simulation.servers.served_world import ServedWorld
from ahrs_lab.simulation.servers.serving import Answering

ACL_LATENCY_S = 0.002
SCPI_LATENCY_S = 0.005


class _Lines(Answering, ABC):
    """Line by line, each client with its own unfinished one."""

    def __init__(self, served: ServedWorld) -> None:
        super().__init__(served)
        self._decoders: dict[int, LineDecoder] = {}

    def connected(self, connection: Connection) -> None:
        super().connected(connection)
        self._decoders[id(connection)] = LineDecoder()

    def gone(self, connection: Connection) -> None:
        super().gone(connection)
        self._decoders.pop(id(connection), None)

    def answer(self, connection: Connection, data: bytes) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.serving.Service`."""
        return b"".join(self._line(line.strip()) for line in self._decoders[id(connection)].feed(data))

    @abstractmethod
    def _line(self, line: str) -> bytes:
        """The answer to one request, stripped."""


class AclTableService(_Lines):
    """The rate table as an ACUTROL 3000 on TCP, 2 ms an answer."""

    latency_s = ACL_LATENCY_S

    def __init__(self, served: ServedWorld) -> None:
        super().__init__(served)
        name = simulated_name("ACUTROL3000", served.said_speed)
        self.responder = AclResponder(served.world.table, name=name)

    def _line(self, line: str) -> bytes:
        return encode_reply(*self.responder.answer(line)) if line else b""


class ScpiService(_Lines):
    """A short list of SCPI headers; queries answer, commands do not. An unknown header goes into the queue of
    errors, as the language has it."""

    latency_s = SCPI_LATENCY_S

    def __init__(self, served: ServedWorld, name: str) -> None:
        super().__init__(served)
        self.name = name
        self._errors: list[str] = []
        self._queries: dict[str, Callable[[], str]] = {
            "*IDN": lambda: self.name,
            "*OPC": lambda: "1",
            "*ESR": lambda: "0",
            "SYST:ERR": self._next_error,
        }
        self._commands: dict[str, Callable[[str], None]] = {
            "*CLS": lambda _: self._errors.clear(),
            "*RST": lambda _: None,
            "SYST:REM": lambda _: None,
            "SYST:RWL": lambda _: None,
            "SYST:LOC": lambda _: None,
        }

    def _line(self, line: str) -> bytes:
        answers = []
        for part in filter(None, (piece.strip() for piece in line.split(";"))):
            header, _, argument = part.partition(" ")
            key = _short(header.removesuffix("?"))
            if header.endswith("?") and key in self._queries:
                answers.append(self._queries[key]())
            elif not header.endswith("?") and key in self._commands:
                self._command(key, argument.strip())
            else:
                self._errors.append('-113,"Undefined header"')
        return ";".join(answers).encode("ascii", "replace") + b"\n" if answers else b""

    def _command(self, key: str, argument: str) -> None:
        try:
            self._commands[key](argument)
        except (AhrsLabError, ValueError):
            self._errors.append('-222,"Data out of range"')

    def _next_error(self) -> str:
        return self._errors.pop(0) if self._errors else '0,"No error"'


class ScpiSupply(ScpiService):
    """The DC supply."""

    def __init__(self, served: ServedWorld) -> None:
        name = simulated_name("DC supply", served.said_speed)
        super().__init__(served, f"AHRS LAB,{name},SIM-0002,1.0")
        self._supply = served.world.supply
        self._voltage_v, self._limit_a = 0.0, served.world.settings.supply.max_current_a
        self._commands |= {"VOLT": self._volt, "CURR": self._curr, "OUTP": self._output}
        self._queries |= {
            "VOLT": lambda: f"{self._voltage_v:.6g}",
            "CURR": lambda: f"{self._limit_a:.6g}",
            "OUTP": lambda: "1" if self._supply.read().output_on else "0",
            "MEAS:VOLT": lambda: f"{self._supply.read().voltage_v:.6f}",
            "MEAS:CURR": lambda: f"{self._supply.read().current_a:.6f}",
        }

    def _volt(self, argument: str) -> None:
        voltage = float(argument)
        self._supply.set_output(voltage, self._limit_a)
        self._voltage_v = voltage

    def _curr(self, argument: str) -> None:
        limit = float(argument)
        self._supply.set_output(self._voltage_v, limit)
        self._limit_a = limit

    def _output(self, argument: str) -> None:
        if argument.upper() in ("ON", "1"):
            self._supply.on()
        elif argument.upper() in ("OFF", "0"):
            self._supply.off()
        else:
            raise ValueError(argument)


class ScpiRoom(ScpiService):
    """Thermometer and hygrometer."""

    def __init__(self, served: ServedWorld) -> None:
        name = simulated_name("thermohygrometer", served.said_speed)
        super().__init__(served, f"AHRS LAB,{name},SIM-0003,1.0")
        room = served.world.room
        self._queries |= {
            "MEAS:TEMP": lambda: f"{room.read().temperature_c:.4f}",
            "MEAS:HUM": lambda: f"{room.read().humidity_percent:.4f}",
        }


class FixtureService(_Lines):
    """The hands at the virtual bench: ``mount ENU``, ``fault NAME [UNTIL_S]``, ``mend NAME``, ``reboot``,
    ``time``. Each line is answered by ``OK`` and what was asked, or ``NO`` and why."""

    def _line(self, line: str) -> bytes:
        try:
            text = f"OK {self._do(line.split())}".strip()
        except (AhrsLabError, ValueError) as error:
            text = f"NO {error}"
        return text.encode("utf-8") + b"\n"

    def _do(self, words: list[str]) -> str:
        world = self.served.world
        match words:
            case ["mount", letters]:
                orientation = Orientation(letters)
                fault = world.faults.active("wrong_mounting", self.served.now_s)
                if fault is not None:
                    orientation = fault.orientation or Orientation(letters[1:] + letters[0])
                    if fault.once:
                        world.faults.clear("wrong_mounting")
                world.place(orientation)
                return ""
            case ["fault", name, *until] if name in FAULT_NAMES:
                world.faults.trigger(name, None, float(until[0]) if until else None)
                return ""
            case ["mend", name] if name in FAULT_NAMES:
                world.faults.clear(name)
                return ""
            case ["reboot"]:
                self.served.reboot()
                return ""
            case ["time"]:
                return f"{self.served.now_s:.6f}"
        raise ValueError("not understood; say mount ENU, fault NAME, mend NAME, reboot or time")


def _short(header: str) -> str:
    """SCPI headers in their short form: ``MEASure:VOLTage:DC`` is ``MEAS:VOLT``."""
    words = [word.upper() for word in header.lstrip(":").split(":")]
    if words and words[0] in ("SOUR", "SOURCE"):
        words = words[1:]
    kept = [_SHORT.get(word, word) for word in words if word not in _IMPLIED]
    return ":".join(kept)


_IMPLIED = (
    "DC",
    "SCAL",
    "SCALAR",
    "IMM",
    "IMMEDIATE",
    "AMPL",
    "AMPLITUDE",
    "LEV",
    "LEVEL",
    "STAT",
    "STATE",
    "NEXT",
)
_SHORT = {
    "MEASURE": "MEAS",
    "VOLTAGE": "VOLT",
    "CURRENT": "CURR",
    "OUTPUT": "OUTP",
    "SYSTEM": "SYST",
    "ERROR": "ERR",
    "TEMPERATURE": "TEMP",
    "HUMIDITY": "HUM",
    "REMOTE": "REM",
    "RWLOCK": "RWL",
    "LOCAL": "LOC",
}
