"""Serial ports and TCP connections: bytes both ways, time limits, being unplugged."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.links.serial_link import SerialLink
from ahrs_lab.instruments.links.tcp_link import TcpLink
from tests.instruments.links.ports import needs_pty, pty_end, tcp_end

EVERY_BYTE = bytes(range(256)) * 8


def read_all(link: Link, count: int) -> bytes:
    data = b""
    deadline = time.monotonic() + 5.0
    while len(data) < count and time.monotonic() < deadline:
        data += link.read(0.1)
    return data


@needs_pty
def test_every_byte_passes_a_serial_port_unchanged_both_ways() -> None:
    with pty_end() as end:
        link = SerialLink(end.path, 115200)
        link.open()
        end.send(EVERY_BYTE)
        assert read_all(link, len(EVERY_BYTE)) == EVERY_BYTE
        link.write(EVERY_BYTE)
        assert end.receive(len(EVERY_BYTE)) == EVERY_BYTE
        link.close()


@needs_pty
def test_nothing_on_a_serial_port_is_no_bytes_after_the_time() -> None:
    with pty_end() as end:
        link = SerialLink(end.path)
        link.open()
        begin = time.monotonic()
        assert link.read(0.05) == b""
        assert time.monotonic() - begin >= 0.04
        assert link.read(0.0) == b""
        link.close()


@needs_pty
def test_an_unplugged_serial_port_is_lost() -> None:
    with pty_end() as end:
        link = SerialLink(end.path)
        link.open()
        end.unplug()
        with pytest.raises(LinkLostError, match="plug its cable in"):
            link.read(1.0)
        link.close()
        with pytest.raises(LinkLostError, match="cannot be opened"):
            link.open()


@needs_pty
def test_a_port_in_use_is_refused() -> None:
    with pty_end() as end:
        first, second = SerialLink(end.path), SerialLink(end.path)
        first.open()
        with pytest.raises(LinkLostError, match="no other program uses"):
            second.open()
        first.close()


@needs_pty
def test_a_serial_port_that_takes_no_more_is_lost_and_does_not_hang() -> None:
    with pty_end() as end:
        link = SerialLink(end.path)
        link.open()
        with pytest.raises(LinkLostError, match="takes no more"):
            link.write(bytes(1 << 22))
        os.set_blocking(end.master, False)
        link.close()


def test_every_byte_passes_tcp_unchanged_both_ways() -> None:
    with tcp_end() as end:
        link = TcpLink("127.0.0.1", end.port)
        link.open()
        peer = end.accept()
        peer.sendall(EVERY_BYTE)
        assert read_all(link, len(EVERY_BYTE)) == EVERY_BYTE
        link.write(EVERY_BYTE)
        assert peer.recv(len(EVERY_BYTE)) == EVERY_BYTE
        assert link.read(0.02) == b""
        link.close()


def test_a_closed_connection_is_lost() -> None:
    with tcp_end() as end:
        link = TcpLink("127.0.0.1", end.port)
        link.open()
        end.accept()
        end.unplug()
        with pytest.raises(LinkLostError):
            link.read(1.0)
        link.close()
        with pytest.raises(LinkLostError, match="does not answer"):
            link.open()


def test_closed_links_say_so_and_close_again() -> None:
    for link in (TcpLink("127.0.0.1", 9), SerialLink("no such port")):
        link.close()
        with pytest.raises(LinkLostError):
            link.read(0.0)
        with pytest.raises(LinkLostError):
            link.write(b"x")


@pytest.mark.parametrize(
    ("settings", "name", "bits"),
    [
        (LinkSettings(host="10.0.0.1", port=4001), "10.0.0.1:4001", None),
        (LinkSettings(host="10.0.0.1"), "10.0.0.1:9878", None),
        (LinkSettings(device="COM3", baud=115200), "COM3", 115200),
    ],
)
def test_settings_name_the_link(settings: LinkSettings, name: str, bits: int | None) -> None:
    link = make_link(settings, default_port=9878)
    assert (link.name, link.bits_per_second) == (name, bits)


def test_parity_and_stop_bits_count_on_the_line() -> None:
    assert SerialLink("COM3").bits_per_byte == 10.0
    assert SerialLink("COM3", parity="E", stop_bits=2.0).bits_per_byte == 12.0


def test_a_link_is_a_port_or_an_address() -> None:
    with pytest.raises(InputError):
        LinkSettings()
    with pytest.raises(InputError):
        LinkSettings(device="COM1", host="x")
    with pytest.raises(InputError):
        make_link(LinkSettings(host="x"))


def test_nobody_reads_a_folder_as_a_port(tmp_path: Path) -> None:
    with pytest.raises(LinkLostError):
        SerialLink(str(tmp_path)).open()
