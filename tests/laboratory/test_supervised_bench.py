"""A bench of instruments for a run: supervised, held to its limits, and left with a farewell."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.motion_limits import LimitedTable
from ahrs_lab.laboratory.supervised_bench import described_bench, supervised_bench
from ahrs_lab.simulation.servers.linked_toml import linked_bench
from ahrs_lab.simulation.servers.served_bench import ServeSettings, serve_bench
from ahrs_lab.simulation.settings import simulation_from_toml


def test_a_run_reaches_the_table_through_the_supervisor_and_takes_leave(tmp_path: Path) -> None:
    report = tmp_path / "supervisor.jsonl"
    with serve_bench(simulation_from_toml({}), ServeSettings(ahrs_on="tcp")) as served:
        bench = supervised_bench(linked_bench(served), "bench", report=report)
        try:
            assert isinstance(bench.table, LimitedTable)
            assert bench.simulated
            bench.table.enable()
            bench.table.set_rate(20.0)
            end = time.monotonic() + 10.0
            while abs(bench.table.state().rate_dps - 20.0) > 0.2:
                assert time.monotonic() < end
                time.sleep(0.02)
            with pytest.raises(InputError, match="limit is set to"):
                bench.table.set_rate(bench.table.limits.max_rate_dps + 1.0)
            bench.table.stop()
        finally:
            bench.close()
        assert abs(served.served.world.table.state().rate_dps) < 20.0
    assert not report.exists()


def test_a_bench_is_described_without_touching_its_wires() -> None:
    with serve_bench(simulation_from_toml({}), ServeSettings(ahrs_on="tcp")) as served:
        toml = linked_bench(served)
    # nobody serves any more
    found = described_bench(toml, "bench")
    assert found.names["table"].text() == "Acutronic ACUTROL 3000 (ACL)"
    assert found.limits.max_rate_dps == toml["table"]["limits"]["max_rate_dps"]
    assert found.device.sample_rate_hz == 100.0
    assert found.simulated
    with pytest.raises(InputError, match="supply"):
        described_bench({key: value for key, value in toml.items() if key != "supply"}, "bench")
