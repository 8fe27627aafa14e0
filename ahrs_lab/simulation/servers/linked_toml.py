"""The bench file with which ``ahrs-lab run`` uses a served bench: drivers on the ports it is served on."""

from __future__ import annotations

from typing import Any

from ahrs_lab.simulation.servers.served_bench import Place, ServedBench

BAUD = 921_600
_POLL_HZ = 200.0
_PERIOD_S = 0.05
_PATIENT_S = 3.0
"""Wall time: the computer may be busy with both ends of the wires."""


def linked_bench(bench: ServedBench) -> dict[str, Any]:
    """Tables of a bench file of kind "instruments" (see :mod:`ahrs_lab.laboratory.linked_benches`)."""
    settings, places, speed = bench.settings, bench.places, bench.served.speed
    device, site, table = settings.device, settings.site, settings.table
    data: dict[str, Any] = {
        "kind": "instruments",
        "north_deg": table.north_deg,
        "site": {"latitude_deg": site.latitude_deg, "altitude_m": site.altitude_m},
        "table": {
            "driver": places["table"].driver,
            "pause_s": 0.0,
            "link": _link(places["table"]),
            "limits": {
                "max_rate_dps": table.max_rate_dps,
                "max_acceleration_dps2": table.max_acceleration_dps2,
            },
            "polling": {"poll_hz": _POLL_HZ},
        },
        "ahrs": {
            "driver": places["ahrs"].driver,
            "name": device.name,
            "manufacturer": device.manufacturer,
            "model": device.model,
            "serial_number": device.serial_number,
            "rate_hz": bench.served.world.ahrs.description.sample_rate_hz,
            "link": _link(places["ahrs"]),
        },
        "supply": {
            "driver": places["supply"].driver,
            "period_s": _PERIOD_S,
            "connection": {"link": _link(places["supply"])},
        },
        "room": {
            "driver": places["room"].driver,
            "connection": {"link": _link(places["room"])},
        },
        "operator": {
            "kind": "simulated-hands",
            "host": places["fixture"].host,
            "port": places["fixture"].port,
        },
    }
    if site.longitude_deg is not None:
        data["site"]["longitude_deg"] = site.longitude_deg
    if speed != 1.0:
        data["speed"] = speed
        data["table"]["reply_timeout_s"] = _PATIENT_S
        for part in ("supply", "room"):
            data[part]["connection"]["timeout_s"] = _PATIENT_S
    return data


def _link(place: Place) -> dict[str, Any]:
    if place.device:
        return {"device": place.device, "baud": BAUD}
    return {"host": place.host, "port": place.port}
