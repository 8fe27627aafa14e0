"""What the laboratory's tests share: the benches that are built, and a result of a run without trouble."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory.benches import load_bench
from ahrs_lab.laboratory.headless import run_plan
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.simulation import bench as simulated_bench
from tests.laboratory.short_run import write_bench, write_plan


@pytest.fixture(scope="module", autouse=True)
def quick_passwords() -> Iterator[None]:
    """Hashes at the least cost: what they cost in earnest is looked at where people are tested."""
    from argon2 import PasswordHasher

    from ahrs_lab.records import people

    hasher = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(people, "_hasher", lambda: hasher)
        yield


@pytest.fixture
def benches(monkeypatch: pytest.MonkeyPatch) -> list[Bench]:
    """Every bench that is built during the test, to look at its world afterwards."""
    built: list[Bench] = []
    build = simulated_bench.build_bench

    def keep(*arguments: Any, **options: Any) -> Bench:
        built.append(build(*arguments, **options))
        return built[-1]

    monkeypatch.setattr(simulated_bench, "build_bench", keep)
    return built


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The result of the short run on a bench where nothing goes wrong."""
    folder = tmp_path_factory.mktemp("undisturbed")
    plan, bench = load_plan(write_plan(folder)), load_bench(write_bench(folder))
    return to_json(run_plan(plan, bench, folder / "out", on_event=lambda _event: None).result)
