"""What a VectorNav unit sends: ASCII sentences and binary messages, mixed in one stream, as samples.

Calibrate on ``IMU`` or on the binary uncompensated rates: the others have the on-board filter's estimate of
bias taken off, and ``filtered_rates`` says so. Axes are the case's own; heading is the yaw of the sent
yaw-pitch-roll, clockwise from north, ±180°.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ahrs_lab.instruments.protocols.frames import Run, grouped, stacked
from ahrs_lab.instruments.protocols.rows import Part, Rank, rank_of
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.instruments.protocols.vectornav_ascii import (
    ASCII_FORMAT,
    ASYNC_COLUMNS,
    numbers_of,
    sentence_of,
)
from ahrs_lab.instruments.protocols.vectornav_binary import BinaryFormat, header_of, output_of


class VectorNavStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`. Rates in rad/s, specific force in
    m/s², magnetic field in Gauss. Device time is the binary TimeStartup; ASCII has none.

    ``replies`` are :class:`~ahrs_lab.instruments.protocols.vectornav_ascii.Sentence`.
    """

    def __init__(self, nominal_rate_hz: float | None = None) -> None:
        super().__init__([BinaryFormat(), ASCII_FORMAT], nominal_rate_hz=nominal_rate_hz)

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        text = [run for run in runs if run.format is ASCII_FORMAT]
        binary = [run for run in runs if run.format is not ASCII_FORMAT]
        return [*self._binary_parts(binary), *self._ascii_parts(text)]

    @staticmethod
    def _binary_parts(runs: Sequence[Run]) -> list[Part]:
        parts = []
        for header, group in grouped((header_of(run.data, run.start), run) for run in runs).items():
            output = output_of(header)
            if output is not None:
                orders, rows = stacked(group)
                columns = output.layout().read(rows)
                rank = rank_of(tuple(columns), output.filtered_rates)
                parts.append(Part(header, rank, orders, columns))
        return parts

    def _ascii_parts(self, runs: Sequence[Run]) -> list[Part]:
        lines: dict[str, tuple[list[int], list[bytes]]] = {}
        for run in runs:
            data = run.data[run.start : run.start + run.length]
            tag, _, rest = data[3:].partition(b",")
            name = tag.decode("ascii")
            if name in ASYNC_COLUMNS:
                orders, bodies = lines.setdefault(name, ([], []))
                orders.append(run.order)
                bodies.append(rest[: rest.rindex(b"*")])
            else:
                self.replies.append(sentence_of(data))
        return [part for name, (orders, bodies) in lines.items() for part in _measured(name, orders, bodies)]


def _measured(name: str, orders: Sequence[int], bodies: Sequence[bytes]) -> list[Part]:
    """Usually one part; lines that are not the numbers they should be are left out."""
    columns = ASYNC_COLUMNS[name]
    matrix = numbers_of(bodies, len(columns))
    if matrix is None:
        # A status field at the end (register 30) is no number; a single odd line must not cost the others.
        kept = [(order, body.split(b",")) for order, body in zip(orders, bodies, strict=True)]
        rows = [(order, numbers_of([b",".join(f[: len(columns)])], len(columns))) for order, f in kept]
        good = [(order, row) for order, row in rows if row is not None]
        if not good:
            return []
        orders, matrix = [order for order, _ in good], np.concatenate([row for _, row in good])
    rank = Rank.RAW_RATE if name == "IMU" else rank_of(columns, filtered=True)
    measured = {column: matrix[:, i] for i, column in enumerate(columns)}
    return [Part(name, rank, np.array(orders, dtype=np.int64), measured)]
