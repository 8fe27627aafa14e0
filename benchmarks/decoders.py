"""Throughput of the decoders of AHRS streams, against the line and against what others wrote.

    python benchmarks/decoders.py [--megabytes 4] [--block 4096] [--json]

Each protocol's stream is made by its own encoder and fed in blocks as a port delivers them. Printed: MB/s on
one core; the ratio to 50 lines of 921,600 baud (aim 1); the ratio to the peer on the same machine in the same
run: the vendor's decoder for MIP (over a local socket, the only way in that it has) and ANPP, pynmeagps for
NMEA, and a plain ``struct`` loop in Python for all. Peers that are not installed are left out, with the
reason.
"""

from __future__ import annotations

import argparse
import binascii
import importlib
import json
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ahrs_lab.instruments.protocols import (
    anpp,
    generic_binary,
    generic_text,
    microstrain,
    nmea,
    vectornav_ascii,
    xsens,
)
from ahrs_lab.instruments.protocols import vectornav_binary as vnb
from ahrs_lab.instruments.protocols.catalogue import stream_decoder
from ahrs_lab.instruments.protocols.description import load_description
from ahrs_lab.recording.samples import Samples
from ahrs_lab.resource_files import resource_path

AIM_LINES = 50
LINE_BYTES_PER_S = 92_160.0
"""921,600 baud, ten bits a byte."""


def samples(count: int) -> Samples:
    rng = np.random.default_rng(1)
    rows = np.arange(count, dtype=np.float64)
    columns = {"t_s": rows / 1000.0, "counter": rows, "temperature_c": np.full(count, 25.0)}
    for name in ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"):
        columns[name] = rng.normal(size=count)
    for name in ("heading_deg", "pitch_deg", "roll_deg"):
        columns[name] = rng.uniform(-90.0, 90.0, count)
    return Samples(columns)


def streams() -> dict[str, tuple[str, Callable[[Samples], bytes]]]:
    """Name → protocol, encoder."""
    output = vnb.BinaryOutput.of({vnb.COMMON: [0, 3], vnb.IMU: [2, 3, 4]})
    devices = {name: resource_path(f"devices/generic-{name}.toml") for name in ("binary", "text")}
    binary, text = (load_description(devices[name]) for name in ("binary", "text"))
    items = [0x1020, 0x1060, 0x8020, 0x4020, 0x2030, 0x0810, 0xE020]
    return {
        "VectorNav binary": ("vectornav", lambda s: vnb.encode_samples(output, s)),
        "VectorNav ASCII": ("vectornav", lambda s: vectornav_ascii.encode_samples("YMR", s)),
        "Xsens": ("xsens", lambda s: xsens.encode_samples(items, s)),
        "MIP": ("mip", lambda s: microstrain.encode_samples([0xD5, 0x04, 0x05, 0x0C], s)),
        "ANPP 20": ("anpp", lambda s: anpp.encode_samples([20], s)),
        "ANPP 20, 28": ("anpp", lambda s: anpp.encode_samples([20, 28], s)),
        "NMEA": ("nmea", nmea.encode_attitude),
        "generic binary": (str(devices["binary"]), lambda s: generic_binary.encode_samples(binary, s)),
        "generic text": (str(devices["text"]), lambda s: generic_text.encode_samples(text, s)),
    }


def stream_of(encode: Callable[[Samples], bytes], megabytes: float) -> tuple[bytes, int]:
    size = len(encode(samples(100))) / 100
    rows = max(200, int(megabytes * 1e6 / size))
    return encode(samples(rows)), rows


def ours(protocol: str, data: bytes, rows: int, block: int) -> float:
    """MB/s, best of three."""
    best = float("inf")
    for _ in range(3):
        decoder = stream_decoder(protocol)
        started = time.process_time()
        made = sum(len(decoder.feed(data[at : at + block])) for at in range(0, len(data), block))
        made += len(decoder.flush())
        best = min(best, time.process_time() - started)
        if made != rows or decoder.counts.failed:
            raise SystemExit(f"{protocol}: {made} of {rows} samples, {decoder.counts}")
    return len(data) / best / 1e6


def plain_loop(data: bytes, name: str) -> float | None:
    """MB/s of a loop over frames in Python that checks and unpacks one at a time, without resynchronising."""
    loops: dict[str, Callable[[bytes], list[Any]]] = {
        "VectorNav binary": _plain_vectornav,
        "VectorNav ASCII": _plain_ascii,
        "Xsens": _plain_xsens,
        "MIP": _plain_mip,
    }
    if name not in loops:
        return None
    part = data[: 1 << 20]
    started = time.process_time()
    rows = loops[name](part)
    if name.startswith("VectorNav"):
        np.array(rows)  # the decoder gives columns, too
    return len(part) / (time.process_time() - started) / 1e6


def _plain_vectornav(data: bytes) -> list[tuple[float, ...]]:
    unpack, rows, at, length = struct.Struct("<Q10f").unpack_from, [], 0, len(data)
    size = 6 + 8 + 12 + 12 + 12 + 4 + 2
    while at + size <= length:
        if binascii.crc_hqx(data[at + 1 : at + size], 0) == 0:
            rows.append(unpack(data, at + 6))
        at += size
    return rows


def _plain_ascii(data: bytes) -> list[list[float]]:
    rows = []
    for line in data.split(b"\r\n")[:-1]:
        body, _, checksum = line[1:].partition(b"*")
        value = 0
        for byte in body:
            value ^= byte
        if value == int(checksum, 16):
            rows.append([float(field) for field in body.split(b",")[1:]])
    return rows


def _plain_xsens(data: bytes) -> list[list[tuple[float, ...]]]:
    rows, at = [], 0
    while at + 4 <= len(data) and at + 5 + data[at + 3] <= len(data):
        stop = at + 5 + data[at + 3]
        if sum(data[at + 1 : stop]) & 0xFF == 0:
            row, place = [], at + 4
            while place < stop - 1:
                size = data[place + 2]
                code = ">H" if size == 2 else f">{size // 4}f"
                row.append(struct.unpack_from(code, data, place + 3))
                place += 3 + size
            rows.append(row)
        at = stop
    return rows


def _plain_mip(data: bytes) -> list[list[tuple[float, ...]]]:
    rows, at = [], 0
    while at + 4 <= len(data) and at + 6 + data[at + 3] <= len(data):
        stop = at + 6 + data[at + 3]
        first = second = 0
        for byte in data[at : stop - 2]:
            first += byte
            second += first
        if (first & 0xFF, second & 0xFF) == (data[stop - 2], data[stop - 1]):
            row, place = [], at + 4
            while place < stop - 2:
                size = data[place]
                code = ">Q" if data[place + 1] == 0xD5 else f">{(size - 2) // 4}f"
                row.append(struct.unpack_from(code, data, place + 2))
                place += size
            rows.append(row)
        at = stop
    return rows


def vendor(name: str, data: bytes, rows: int) -> tuple[str, float | str] | None:
    """The peer's name and its MB/s, or why it is not there."""
    peers: dict[str, tuple[str, Callable[[bytes, int], float]]] = {
        "MIP": ("pymscl", _pymscl),
        "ANPP 20": ("advanced-navigation", _advanced_navigation),
        "ANPP 20, 28": ("advanced-navigation", _advanced_navigation),
        "NMEA": ("pynmeagps", _pynmeagps),
    }
    if name not in peers:
        return None
    peer, measure = peers[name]
    try:
        return peer, measure(data, rows)
    except ImportError as error:
        return peer, f"not installed ({error})"


def _pymscl(data: bytes, rows: int) -> float:
    """Wall time: its thread reads the socket and decodes; ours is measured by the processor's time."""
    mscl = importlib.import_module("mscl")
    done = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            peer, _ = server.accept()
            with peer:
                peer.sendall(data)
                done.wait(60.0)

        thread = threading.Thread(target=serve)
        thread.start()
        connection = mscl.Connection.TcpIp("127.0.0.1", server.getsockname()[1])
        node = mscl.InertialNode(connection)
        started, got = time.perf_counter(), 0
        while got < rows and time.perf_counter() - started < 60.0:
            for packet in node.getDataPackets(100):
                got += 1
                for point in packet.data():
                    point.as_double()
        seconds = time.perf_counter() - started
        connection.disconnect()
        done.set()
        thread.join()
    return len(data) * got / rows / seconds / 1e6


def _advanced_navigation(data: bytes, _rows: int) -> float:
    packets = "advanced_navigation.anpp_packets."
    decoder = importlib.import_module(packets + "an_packet_protocol").ANDecoder()
    state = importlib.import_module(packets + "an_packet_20").SystemStatePacket
    raw = importlib.import_module(packets + "an_packet_28").RawSensorsPacket
    started = time.process_time()
    decoder.add_data(data)
    while (packet := decoder.decode()) is not None:
        (state if packet.id == 20 else raw)().decode(packet)
    return len(data) / (time.process_time() - started) / 1e6


def _pynmeagps(data: bytes, _rows: int) -> float:
    reader = importlib.import_module("pynmeagps").NMEAReader
    lines = data.splitlines(keepends=True)
    started = time.process_time()
    for line in lines:
        reader.parse(line)
    return len(data) / (time.process_time() - started) / 1e6


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--megabytes", type=float, default=4.0)
    parser.add_argument("--block", type=int, default=4096)
    parser.add_argument("--json", action="store_true")
    call = parser.parse_args()
    aim = AIM_LINES * LINE_BYTES_PER_S / 1e6
    report = []
    for name, (protocol, encode) in streams().items():
        data, rows = stream_of(encode, call.megabytes)
        rate = ours(protocol, data, rows, call.block)
        entry: dict[str, object] = {"stream": name, "mb_per_s": rate, "aim_ratio": rate / aim}
        plain = plain_loop(data, name)
        if plain:
            entry["plain_ratio"] = rate / plain
        peer = vendor(name, data[: len(data)], rows)
        if peer:
            entry["peer"] = peer[0]
            entry["peer_ratio"] = rate / peer[1] if isinstance(peer[1], float) else peer[1]
        report.append(entry)
        if not call.json:
            print(_line(entry), flush=True)
    if call.json:
        json.dump({"block": call.block, "aim_mb_per_s": aim, "streams": report}, sys.stdout)


def _line(entry: dict[str, object]) -> str:
    text = f"{entry['stream']:17} {entry['mb_per_s']:7.1f} MB/s  {entry['aim_ratio']:6.1f} × aim"
    if "plain_ratio" in entry:
        text += f"  {entry['plain_ratio']:6.1f} × plain loop"
    if "peer" in entry:
        ratio = entry["peer_ratio"]
        text += (
            f"  {ratio:6.1f} × {entry['peer']}" if isinstance(ratio, float) else f"  {entry['peer']}: {ratio}"
        )
    return text


if __name__ == "__main__":
    main()
