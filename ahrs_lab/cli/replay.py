"""``ahrs-lab replay``: raw bytes of a link decoded as the live driver would."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.raw_log import Block, read_raw
from ahrs_lab.instruments.protocols.catalogue import replay_summary, stream_decoder
from ahrs_lab.instruments.protocols.stream import StreamDecoder, joined
from ahrs_lab.recording.samples import Samples

_BLOCK = 1 << 16
_DEFAULT_RATE_HZ = 100.0


def run(arguments: argparse.Namespace) -> int:
    """Decode, tell, and write a recording where asked."""
    decoder = stream_decoder(arguments.protocol, arguments.rate)
    samples = _decoded(arguments.raw, decoder)
    summary = replay_summary(samples, decoder)
    if arguments.out is not None:
        _write(arguments, samples, decoder)
    if arguments.json:
        print(json.dumps(summary, ensure_ascii=False, allow_nan=False))
    else:
        print(_text(summary, decoder))
    return 0


def _decoded(path: Path, decoder: StreamDecoder) -> Samples:
    """All samples in order; with an index of arrivals beside the bytes each has its ``host_t_s``."""
    blocks: list[Samples] = []
    for block in _blocks(path):
        samples = decoder.feed(block.data)
        if len(samples) and not math.isnan(block.t_s):
            samples = samples.with_columns({"host_t_s": np.full(len(samples), block.t_s)})
        blocks.append(samples)
    return joined([*blocks, decoder.flush()])


def _blocks(path: Path) -> list[Block]:
    """Of a run's raw bytes; of any other file, blocks without a time."""
    if path.suffix == ".idx" or path.with_suffix(".idx").exists():
        return list(read_raw(path))
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(
            "{path} cannot be read ({reason}).", path=path, reason=error.strerror or str(error)
        ) from error
    return [Block(math.nan, data[at : at + _BLOCK]) for at in range(0, len(data), _BLOCK)]


def _text(summary: dict[str, Any], decoder: StreamDecoder) -> str:
    lines = [
        f"{summary['frames']} frames, {summary['failed']} failed, {summary['skipped_bytes']} bytes skipped",
        f"{summary['samples']} samples, time: {decoder.time_source}",
    ]
    for name, last in summary["last"].items():
        lines.append(f"  {name:16} {summary['first'].get(name)} … {last}")
    if decoder.filtered_rates:
        lines.append(
            "The rates are the on-board filter's, its estimate of bias taken off: not for calibration."
        )
    return "\n".join(lines)


def _write(arguments: argparse.Namespace, samples: Samples, decoder: StreamDecoder) -> None:
    from ahrs_lab.recording.orientation import Orientation
    from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
    from ahrs_lab.recording.write import BundleWriter

    if not len(samples):
        raise InputError("{path} holds no sample of protocol “{protocol}”: there is nothing to record.",
                         path=arguments.raw, protocol=arguments.protocol)  # fmt: skip
    if "t_s" not in samples:
        raise InputError(
            "{path} says neither time nor counter: give the sample rate with --rate.", path=arguments.raw
        )
    steps = np.diff(samples["t_s"])
    rate_hz = 1.0 / float(np.median(steps)) if len(steps) and np.median(steps) > 0 else None
    device = DeviceDescription(
        rate_unit=decoder.rate_unit,
        accel_unit=decoder.accel_unit,
        sample_rate_hz=round(rate_hz or arguments.rate or _DEFAULT_RATE_HZ, 6),
    )
    notes = {
        "replay": {
            "source": arguments.raw.name,
            "protocol": arguments.protocol,
            "time": decoder.time_source,
            "assumed": "orientation ENU, latitude as given to the command",
        }
    }
    header = RecordingHeader("static", Site(arguments.latitude), device, notes=notes)
    with BundleWriter(arguments.out, header) as writer:
        writer.begin(Segment("replay", Orientation("ENU"), "static", "x", "position", position=1))
        writer.append(samples)
        writer.finish()
