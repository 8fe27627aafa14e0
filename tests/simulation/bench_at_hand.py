"""A bench with its unit powered, mounted and streaming."""

from __future__ import annotations

from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.simulation.bench import build_bench
from ahrs_lab.simulation.settings import SimulationSettings


def ready(settings: SimulationSettings | None = None, letters: str = "UEN") -> Bench:
    """Mounted, powered, table enabled, streaming."""
    bench = build_bench(settings or SimulationSettings.ideal())
    bench.operator.mount(Orientation(letters), None)
    bench.supply.set_output(12.0, 5.0)
    bench.supply.on()
    bench.table.enable()
    bench.ahrs.start()
    return bench


def after(bench: Bench, seconds: float) -> Samples:
    """The samples of the next ``seconds``, without those before."""
    bench.ahrs.read()
    bench.clock.wait(seconds)
    return bench.ahrs.read()
