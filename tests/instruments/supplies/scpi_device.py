"""A small SCPI supply and room sensor: what they answer, for any link."""

from __future__ import annotations


class ScpiDevice:
    """Answers line by line; ``values`` are what it measures."""

    def __init__(self) -> None:
        self.volt, self.curr, self.output = 0.0, 0.1, False
        self.load_ohm = 24.0
        self.identity = "ACME,PS1,7,1.0"
        self.highest_volt = 30.0
        self.said: list[str] = []
        self._rest = b""

    def __call__(self, data: bytes) -> bytes:
        *lines, self._rest = (self._rest + data).split(b"\n")
        return b"".join(self._answer(line.decode().strip()) for line in lines)

    def _answer(self, line: str) -> bytes:
        self.said.append(line)
        word, _, value = line.partition(" ")
        if word == "VOLT":
            self.volt = min(float(value), self.highest_volt)
        elif word == "CURR":
            self.curr = float(value)
        elif word == "OUTP":
            self.output = value == "ON"
        answers = {
            "*IDN?": self.identity,
            "VOLT?": f"{self.volt:.3f}",
            "CURR?": f"{self.curr:.3f}",
            "OUTP?": str(int(self.output)),
            "MEAS:VOLT?": f"{self.volt * self.output:.4E}",
            "MEAS:CURR?": f"{self.volt * self.output / self.load_ohm:.4E} A",
            "MEAS:TEMP?": "21.35",
            "MEAS:HUM?": "48.2 %",
        }
        return (answers[line] + "\n").encode() if line in answers else b""
