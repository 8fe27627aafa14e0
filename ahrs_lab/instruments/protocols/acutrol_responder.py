"""The table's side of ACL: requests in, answers out, over any rate table.

It behaves as the language describes: demands persist and act when their mode is entered, a position is
reached on the shortest path and wraps at ±180°, faults stay latched until ``:Interlock:Reset``. The numbers
of errors are its own; their texts are what ``:Query:Error?`` gives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.angles import wrap_180
from ahrs_lab.instruments.interfaces import RateTable, TableState
from ahrs_lab.instruments.protocols.acutrol import Call, Misunderstood, encode_reply, parse_request
from ahrs_lab.instruments.protocols.lines import LineDecoder

MODE_LETTERS = "AOPRST"
_LONGEST_REQUEST = 1024
_RATE_REACHED = 1e-3
_LARGEST_DELTA_DEG = 180.0

ERRORS = {
    101: "unknown command",
    102: "ambiguous command",
    103: "not a query",
    104: "not a command",
    105: "wrong arguments",
    106: "no such axis",
    107: "no such register",
    201: "interlock is open",
    202: "fault is latched, reset the interlock",
    203: "demand exceeds limit",
    204: "refused",
}
_CODES = {text: code for code, text in ERRORS.items()}


class _RefusedError(Exception):
    """Carries one of :data:`ERRORS`."""


@dataclass
class AclResponder:
    """Answers for ``table`` as axis ``axis``. Nothing of the clock: every answer is about now."""

    table: RateTable
    axis: int = 1
    name: str = "ACUTROL3000 (simulated)"
    mode: str = "Off"
    closed: bool = False
    lockout: str = "OFF"
    demand_position_deg: float = 0.0
    demand_rate_dps: float = 0.0
    rate_limits: dict[str, float] = field(default_factory=dict)
    acceleration_limits: dict[str, float] = field(default_factory=dict)
    trip_limits: dict[str, float] = field(default_factory=dict)
    tripped: str = ""
    acknowledged: bool = True
    last_error: int = 0
    _errors_unread: bool = False
    _latched: dict[str, int] = field(default_factory=dict)
    _last: tuple[float, float] | None = None
    _lines: LineDecoder = field(default_factory=lambda: LineDecoder(b"\n", _LONGEST_REQUEST))

    def __post_init__(self) -> None:
        for letter in MODE_LETTERS:
            self.rate_limits.setdefault(letter, self.table.limits.max_rate_dps)
            self.acceleration_limits.setdefault(letter, self.table.limits.max_acceleration_dps2)
            self.trip_limits.setdefault(letter, 1.1 * self.table.limits.max_rate_dps)

    def feed(self, data: bytes) -> bytes:
        """The answers to the requests that ``data`` completes."""
        return b"".join(encode_reply(*self.answer(line.strip())) for line in self._lines.feed(data))

    def answer(self, line: str) -> tuple[int, str]:
        """Code and text for one request."""
        texts: list[str] = []
        try:
            for call in parse_request(line):
                if isinstance(call, Misunderstood):
                    raise _RefusedError(call.reason)
                text = self._do(call)
                if call.query:
                    texts.append(text)
        except _RefusedError as refused:
            return self._refuse(_CODES[str(refused)])
        except AhrsLabError:
            return self._refuse(_CODES["refused"])
        return 0, ";".join(texts) or "OK"

    def _refuse(self, code: int) -> tuple[int, str]:
        self.last_error, self._errors_unread = code, True
        return code, ERRORS[code]

    def _do(self, call: Call) -> str:
        match call.path, call.query:
            case ("*IDN",), True:
                return self.name
            case ("*STB",), True:
                status, self._errors_unread = self._status(), False
                return str(status)
            case ("Status", "STB"), True:
                return str(self._status())
            case ("Status", which), True:
                return self._register(call.arguments, latched=which == "ESR")
            case ("Query", _), True:
                return ERRORS.get(_whole(call.arguments, 0), "no error")
            case ("Utility", _), True:
                return self.lockout
            case ("Utility", _), False:
                self.lockout = _argument(call.arguments, 0).upper()
                return ""
            case ("Limit", which), query:
                return self._limit(which, call.arguments, query)
            case (main, *_), query if not main.startswith("*"):
                self._check_axis(_argument(call.arguments, 0), query)
                return self._of_axis(main, call)
        raise _RefusedError("unknown command")

    def _of_axis(self, main: str, call: Call) -> str:
        sub = call.path[1] if len(call.path) > 1 else ""
        if main == "Interlock":
            return self._interlock_state() if call.query else self._interlock(sub)
        if main == "Mode":
            return self.mode if call.query else self._enter(sub)
        if main == "Read":
            return self._read(sub)
        return self._demand(sub, call)

    # commands ─────────────────────────────────────────────────────────────────────────────────────────────

    def _interlock(self, sub: str) -> str:
        if sub == "Reset":
            self.tripped, self.acknowledged = "", True
            self._latched.clear()
        elif sub == "Close":
            if self._fault() and not self.acknowledged:
                raise _RefusedError("fault is latched, reset the interlock")
            self.table.enable()
            self.closed = True
        else:
            self.table.disable()
            self.closed, self.mode = False, "Off"
        return ""

    def _enter(self, mode: str) -> str:
        if mode == "Off":
            self.mode = mode
            self.table.stop()
            return ""
        if self._fault():
            raise _RefusedError("fault is latched, reset the interlock")
        if not self.closed:
            raise _RefusedError("interlock is open")
        self.mode = mode
        self._act()
        return ""

    def _act(self) -> None:
        """The demand of the present mode takes effect."""
        if self.mode == "Position":
            now_deg = self.table.state().angle_deg
            target = now_deg + wrap_180(self.demand_position_deg - now_deg)
            self.table.move_to(target, self.rate_limits["P"])
        elif self.mode != "Off":
            self.table.set_rate(self.demand_rate_dps)

    def _demand(self, sub: str, call: Call) -> str:
        if call.query:
            return _number(self.demand_rate_dps if sub == "Rate" else self.demand_position_deg)
        value = _float(call.arguments, 1)
        if sub == "Rate":
            if not abs(value) <= self.rate_limits["R"]:
                raise _RefusedError("demand exceeds limit")
            self.demand_rate_dps = value
            concerned = self.mode in ("Rate", "ARate")
        else:
            if sub == "DeltaPosition":
                if not abs(value) <= _LARGEST_DELTA_DEG:
                    raise _RefusedError("demand exceeds limit")
                value += self.table.state().angle_deg
            self.demand_position_deg = wrap_180(value)
            concerned = self.mode == "Position"
        if concerned:
            self._act()
        return ""

    def _limit(self, which: str, arguments: tuple[str, ...], query: bool) -> str:
        if which == "Absolute":
            self._check_axis(_argument(arguments, 0), query)
            if query:
                limits = self.table.limits
                return f"{_number(limits.max_rate_dps)};{_number(limits.max_acceleration_dps2)}"
            raise _RefusedError("not a command")
        letter = _argument(arguments, 0).upper()
        self._check_axis(_argument(arguments, 1), query)
        limits_of = {
            "Rate": self.rate_limits,
            "Acceleration": self.acceleration_limits,
            "Vtrip": self.trip_limits,
        }[which]
        if letter not in limits_of:
            raise _RefusedError("wrong arguments")
        if query:
            return _number(limits_of[letter])
        value = _float(arguments, 2)
        if not value > 0.0:
            raise _RefusedError("wrong arguments")
        absolute = {
            "Rate": self.table.limits.max_rate_dps,
            "Acceleration": self.table.limits.max_acceleration_dps2,
        }
        limits_of[letter] = min(value, absolute.get(which, value))
        return ""

    # queries ──────────────────────────────────────────────────────────────────────────────────────────────

    def _look(self) -> TableState:
        """The table now; trips where it turns faster than its mode may."""
        state = self.table.state()
        letter = self.mode[0]
        if self.closed and abs(state.rate_dps) > self.trip_limits[letter]:
            self.tripped = "rate trip"
            self.table.disable()
        if state.fault or self.tripped:
            # a fault is new where the table stood enabled before
            if self.closed:
                self.acknowledged = False
            self.closed, self.mode = False, "Off"
        return state

    def _fault(self) -> str:
        state = self._look()
        return "" if self.acknowledged else self.tripped or state.fault

    def _interlock_state(self) -> str:
        if self._fault():
            return "Fault"
        return "Close" if self.closed else "Open"

    def _read(self, sub: str) -> str:
        state = self._look()
        if sub == "Position":
            return _number(wrap_180(state.angle_deg))
        if sub == "Rate":
            return _number(state.rate_dps)
        last, self._last = self._last, (state.t_s, state.rate_dps)
        if last is None or state.t_s <= last[0]:
            return _number(0.0)
        return _number((state.rate_dps - last[1]) / (state.t_s - last[0]))

    def _status(self) -> int:
        fault = bool(self._fault())
        summary = fault | fault << 1 | self._errors_unread << 7
        return summary | (1 << 6 if summary else 0)

    def _register(self, arguments: tuple[str, ...], *, latched: bool) -> str:
        name = _argument(arguments, 0).upper()
        live = self._live_registers()
        if name not in live:
            raise _RefusedError("no such register")
        for key, value in live.items():
            self._latched[key] = self._latched.get(key, 0) | value
        value = live[name]
        if latched:
            value, self._latched[name] = self._latched[name], 0
        if len(arguments) > 1:
            return str(value >> min(max(_whole(arguments, 1), 0), 63) & 1)
        return str(value)

    def _live_registers(self) -> dict[str, int]:
        state, fault = self._look(), self._fault()
        there = self.mode == "Position" and not state.moving
        reached = self.mode == "Rate" and abs(state.rate_dps - self.demand_rate_dps) < _RATE_REACHED
        rate_trip = bool(fault) and bool(self.tripped)
        registers = {
            "DYN": there << 8 | reached << 9,
            "STATE": (self.closed and not fault) << 4 | bool(fault) << 7,
            "SWFLT": bool(fault) | rate_trip << 1,
            "INTLK": bool(fault) << 9,
        }
        return {f"A{self.axis}{key}": int(value) for key, value in registers.items()}

    def _check_axis(self, text: str, query: bool) -> None:
        if text.upper() == "ALL" and not query:
            return
        if text != str(self.axis):
            raise _RefusedError("no such axis")


def _argument(arguments: tuple[str, ...], index: int) -> str:
    if index >= len(arguments):
        raise _RefusedError("wrong arguments")
    return arguments[index]


def _parsed(text: str, kind: Callable[[str], float]) -> float:
    try:
        value = kind(text)
    except ValueError as error:
        raise _RefusedError("wrong arguments") from error
    if value - value != 0.0:
        raise _RefusedError("wrong arguments")
    return value


def _float(arguments: tuple[str, ...], index: int) -> float:
    return _parsed(_argument(arguments, index), float)


def _whole(arguments: tuple[str, ...], index: int) -> int:
    return int(_parsed(_argument(arguments, index), int))


def _number(value: float) -> str:
    return f"{value:.9g}"
