"""One stream of each protocol, made by its own encoder, and how it is decoded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ahrs_lab.instruments.protocols import (
    anpp,
    generic_binary,
    generic_text,
    microstrain,
    microstrain_mip,
    nmea,
    vectornav_ascii,
    vectornav_binary,
    xsens,
    xsens_xbus,
)
from ahrs_lab.instruments.protocols.catalogue import stream_decoder
from ahrs_lab.instruments.protocols.checksums import fletcher
from ahrs_lab.instruments.protocols.description import TextDescription, load_description
from ahrs_lab.instruments.protocols.frames import FrameScanner
from ahrs_lab.instruments.protocols.generic_binary import BinaryFormat
from ahrs_lab.instruments.protocols.generic_text import TextFormat
from ahrs_lab.instruments.protocols.stream import StreamDecoder
from ahrs_lab.recording.samples import Array, Samples
from ahrs_lab.resource_files import resource_path

DEVICES = {name: resource_path(f"devices/generic-{name}.toml") for name in ("binary", "counts", "text")}


def samples(count: int, seed: int = 1) -> Samples:
    """Plausible readings of ``count`` rows at 100 Hz."""
    rng = np.random.default_rng(seed)
    rows = np.arange(count, dtype=np.float64)
    columns: dict[str, Array] = {"t_s": 100.0 + rows / 100.0, "counter": 7.0 + rows}
    for name in ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"):
        columns[name] = rng.uniform(-1.0, 1.0, count)
    columns["heading_deg"] = rng.uniform(0.0, 179.0, count)
    columns["pitch_deg"] = rng.uniform(-80.0, 80.0, count)
    columns["roll_deg"] = rng.uniform(-170.0, 170.0, count)
    columns["temperature_c"] = rng.uniform(20.0, 30.0, count)
    return Samples(columns)


@dataclass(frozen=True)
class Codec:
    """A protocol under test: ``frames`` is its valid frames, ``replies`` frames that are no samples,
    ``sealed`` makes a frame with a right checksum of any content."""

    name: str
    decoder: Callable[[], StreamDecoder]
    scanner: Callable[[], FrameScanner]
    frames: tuple[bytes, ...]
    replies: tuple[bytes, ...] = ()
    sync: bytes = b""
    sealed: Callable[[bytes], bytes] = bytes

    @property
    def stream(self) -> bytes:
        return b"".join(self.frames)


def _text(content: bytes) -> str:
    """Printable, and often what the decoders look for."""
    words = (
        "HEHDT",
        "PASHR",
        "VNYMR",
        "VNIMU",
        "VNERR",
        ",",
        "1.5",
        "-2",
        "nan",
        "1e999",
        "T",
        "_1",
        "",
        "0x",
    )
    return ",".join(words[byte % len(words)] for byte in content)


def _sealed_vectornav(content: bytes) -> bytes:
    if len(content) % 2:
        text = _text(content).removeprefix("VN")
        return vectornav_ascii.encode(text)
    output = vectornav_binary.BinaryOutput.of({vectornav_binary.IMU: [3]})
    return vectornav_binary.encode_frame(output, content[:12].ljust(12, b"\xff"))


def _sealed_mip(content: bytes) -> bytes:
    body = b"\x75\x65\x80" + bytes((len(content),)) + content
    return body + fletcher(body).to_bytes(2, "big")


def _sealed_anpp(content: bytes) -> bytes:
    packet = (20, 21, 28, 38, 39, 42, 49, 0, 3, 255)[sum(content) % 10]
    length = {20: 100, 21: 8, 28: 48, 38: 16, 39: 12, 42: 12, 49: 8}.get(packet, len(content))
    return anpp.encode(packet, content[:length].ljust(length, b"\x81"))


def _vectornav() -> Codec:
    said = samples(12)
    output = vectornav_binary.BinaryOutput.of(
        {vectornav_binary.COMMON: [0, 3], vectornav_binary.IMU: [2, 3, 4]}
    )
    binary = [vectornav_binary.encode_samples(output, said.rows(i, i + 1)) for i in range(12)]
    ascii_ = [vectornav_ascii.encode_samples("YMR", said.rows(i, i + 1)) for i in range(3)]
    replies = (vectornav_ascii.encode_write(7, 40), vectornav_ascii.encode("ERR", 3, checksum="crc16"))
    return Codec(
        "vectornav",
        lambda: stream_decoder("vectornav"),
        lambda: FrameScanner([vectornav_binary.BinaryFormat(), vectornav_ascii.ASCII_FORMAT]),
        (*binary[:6], *ascii_, *binary[6:]),
        replies,
        b"\xfa$VN",
        _sealed_vectornav,
    )


def _xsens() -> Codec:
    said = samples(12)
    items = [xsens.PACKET_COUNTER, xsens.SAMPLE_TIME_FINE, xsens.RATE_OF_TURN, xsens.QUATERNION_XDI | 4]
    frames = tuple(xsens.encode_samples(items, said.rows(i, i + 1)) for i in range(11))
    more = xsens.encode_samples([*items, xsens.TEMPERATURE], said.rows(11, 12))
    replies = (xsens_xbus.encode(xsens_xbus.GO_TO_CONFIG_ACK), xsens_xbus.encode(0x91, bytes(300)))
    return Codec(
        "xsens",
        lambda: stream_decoder("xsens"),
        lambda: FrameScanner([xsens_xbus.XbusFormat()]),
        (*frames[:5], more, *frames[5:]),
        replies,
        b"\xfa\xff\x36",
        lambda content: xsens_xbus.encode(xsens_xbus.MT_DATA2, content),
    )


def _mip() -> Codec:
    said = samples(12)
    fields = [0xD5, 0x04, 0x05, 0x0C, 0x14]
    frames = tuple(microstrain.encode_samples(fields, said.rows(i, i + 1)) for i in range(12))
    replies = (microstrain_mip.encode_acknowledge(0x0C, 0x0F), microstrain_mip.encode_idle())
    return Codec(
        "mip",
        lambda: stream_decoder("mip"),
        lambda: FrameScanner([microstrain_mip.MipFormat()]),
        frames,
        replies,
        b"\x75\x65\x80",
        _sealed_mip,
    )


def _anpp() -> Codec:
    said = samples(12)
    frames = [anpp.encode_samples([packet], said.rows(i, i + 1)) for i in range(12) for packet in (20, 28)]
    replies = (anpp.encode_acknowledge(anpp.encode_packets_period([(28, 1)])), anpp.encode(3, bytes(24)))
    return Codec(
        "anpp",
        lambda: stream_decoder("anpp"),
        lambda: FrameScanner([anpp.AnppFormat()]),
        tuple(frames),
        replies,
        b"\x00\x1c\x30",
        _sealed_anpp,
    )


def _nmea() -> Codec:
    said = samples(8)
    frames = [nmea.encode_attitude(said.rows(i, i + 1)) for i in range(8)]
    replies = (nmea.encode("GPGGA", "", "1"), nmea.encode("PASHR", "", "", "T"))
    return Codec(
        "nmea",
        lambda: stream_decoder("nmea"),
        lambda: FrameScanner([nmea.NMEA_FORMAT]),
        tuple(frames),
        replies,
        b"$*",
        lambda content: nmea.encode(_text(content)),
    )


def _generic(name: str) -> Codec:
    path = DEVICES[name]
    description = load_description(path)
    text = isinstance(description.frame, TextDescription)
    encode = generic_text.encode_samples if text else generic_binary.encode_samples
    said = samples(12)

    def scanner() -> FrameScanner:
        frame = description.frame
        if isinstance(frame, TextDescription):
            return FrameScanner([TextFormat(frame, description.columns)])
        return FrameScanner([BinaryFormat(frame)])

    return Codec(
        f"generic {name}",
        lambda: stream_decoder(str(path)),
        scanner,
        tuple(encode(description, said.rows(i, i + 1)) for i in range(12)),
        sync=b"$AHRS," if text else b"\xaa\x55\x80\x7f",
    )


CODECS = (_vectornav(), _xsens(), _mip(), _anpp(), _nmea(), *(_generic(name) for name in DEVICES))
