"""The table of many sessions: how long a hundred thousand take, and what is found of what was planted."""

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.fleet.judge import FEWEST, DueRules, judge
from contactbench.pipeline.fleet.page import fleet_html
from contactbench.pipeline.fleet.row import FleetRow, load_table, read_fleet, save_table, table_of, vector
from contactbench.pipeline.fleet.source import find
from contactbench.pipeline.session import Session
from contactbench.pipeline.study.report import Figure, StudyReport

BEGIN, TODAY = datetime(2026, 1, 1, tzinfo=UTC), datetime(2026, 11, 1, tzinfo=UTC)
_TABLE_S, _JUDGE_S, _PAGE_S = 5.0, 10.0, 15.0  # of a hundred thousand sessions
_TOOLS = 4
_FORCE, _TORQUE, _MASS, _CENTRE = 0.05, 0.002, 0.0005, 0.0003  # scatter between sessions, N, N·m, kg, m
_DRIFT = 1.0  # N a year
_FAR = 30.0  # times the scatter


def run(
    sessions: int = 100_000,
    folders: int = 200,
    seed: int = 0,
    *,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure the table of sessions; `folders`: sessions on the disk that are read, without calibrations."""
    if sessions < 1_000 or folders < 1:
        raise InputError("give at least 1,000 sessions, and one folder.")
    progress(f"drawing {sessions:,} sessions")
    rows, drifting, outliers = drawn(sessions, seed)
    with TemporaryDirectory(prefix="contactbench-") as name:
        folder = Path(name)
        file = folder / "fleet.parquet"
        progress("writing and reading the table")
        begin = process_time()
        save_table(table_of(rows), file)
        table = load_table(file)
        table_s = process_time() - begin
        progress("judging it")
        begin = process_time()
        found = judge(table, DueRules(TODAY.date()))
        judge_s = process_time() - begin
        begin = process_time()
        fleet_html(table, found, (), TODAY)
        page_s = process_time() - begin
        size = file.stat().st_size
        progress(f"reading {folders:,} folders")
        first, again = _read_times(folder / "sessions", folders)
    told = {each.place for each in found.outliers}
    drifts = {(each.sensor, each.tool) for each in found.trends if each.drifts}
    of = f"{sessions:,} sessions"
    return StudyReport(
        "Fleet",
        {"sessions": sessions, "folders": folders, "seed": seed},
        (
            Figure(of, "written and read as a table", table_s, "s", most=_TABLE_S),
            Figure(of, "judged", judge_s, "s", most=_JUDGE_S),
            Figure(of, "page", page_s, "s", most=_PAGE_S),
            Figure(of, "size of the table", size / sessions, "bytes a session"),
            Figure(of, "outliers found of those planted", _share(told, outliers), "%", least=95),
            Figure(of, "outliers told of all others", 100 * len(told - outliers) / sessions, "%", most=0.1),
            Figure(of, "drifts found of those planted", _share(drifts, drifting), "%", least=95),
            Figure(of, "drifts told of none", len(drifts - drifting), "", most=1),
            Figure(f"{folders:,} folders", "first run", 1e3 * first / folders, "ms a session"),
            Figure(f"{folders:,} folders", "second run", 1e3 * again / folders, "ms a session"),
        ),
        ("Times are of the processor.",),
    )


def drawn(count: int, seed: int) -> tuple[list[FleetRow], set[tuple[str, str]], set[str]]:
    """Return sessions, the sensors with a tool whose bias drifts, and the places of sessions that are far off."""
    rng = np.random.default_rng(seed)
    groups = max(1, count // 100)
    normal = rng.standard_normal((count, 12))
    biases = rng.normal(0, 5, (groups, 6))
    masses = rng.uniform(0.2, 2.0, groups)
    drifts = set(range(0, groups, 20))
    far = {int(each) for each in rng.choice(count, count // 500, replace=False)}
    rows = [
        _row(number, number % groups, normal[number], biases, masses, drifts=number % groups in drifts)
        for number in range(count)
    ]
    for number in far:
        rows[number] = replace(rows[number], mass_kg=float(masses[number % groups] + _FAR * _MASS))
    named = {_names(group) for group in drifts}
    return rows, named, {rows[number].place for number in far}


def _names(group: int) -> tuple[str, str]:
    return f"M8128-{group // _TOOLS:04d}", f"probe-{group % _TOOLS}"


def row(number: int, **more: Any) -> FleetRow:
    """Return a session, sound and with next to nothing in it but what is given."""
    blank = FleetRow(
        journal=f"{number:064x}",
        files="{}",
        place=f"/s/{number}",
        session=f"{number:032x}",
        records=3,
        sensor="SN 7",
        model="",
        tool="linear",
        operator="",
        certificate="",
        due=None,
        due_unreadable="",
        calibrated=BEGIN + timedelta(days=10 * number),
        verdict="good",
        stale=False,
        poses=9,
        temperature_C=None,
    )
    return replace(blank, **more)


def _row(
    number: int,
    group: int,
    normal: NDArray[np.float64],
    biases: NDArray[np.float64],
    masses: NDArray[np.float64],
    *,
    drifts: bool,
) -> FleetRow:
    sensor, tool = _names(group)
    nth = number // len(masses)
    when = TODAY - timedelta(days=3.0 * (100 - nth % 100) + group % 3)
    force = biases[group, :3] + _FORCE * normal[:3]
    if drifts:
        force[0] += _DRIFT * 3.0 * nth / 365.25
    return row(
        number,
        sensor=sensor,
        model="M8128",
        tool=tool,
        due=date(2027, 3, 31),
        calibrated=when.replace(microsecond=0),
        temperature_C=float(22 + normal[6]),
        mass_kg=float(masses[group] + _MASS * normal[7]),
        mass_sigma_kg=1e-4,
        verified=when.replace(microsecond=0),
        verification_passed=True,
        error_mean_m=float(4e-4 + 2e-5 * normal[8]),
        error_p95_m=8e-4,
        error_max_m=1e-3,
        **vector("force_bias", "N", force),
        **vector("force_bias_sigma", "N", [0.01] * 3),
        **vector("torque_bias", "Nm", biases[group, 3:] / 20 + _TORQUE * normal[3:6]),
        **vector("torque_bias_sigma", "Nm", [5e-4] * 3),
        **vector("centre", "m", [0.0, 0.0, 0.1] + _CENTRE * normal[9:12]),
        **vector("centre_sigma", "m", [1e-4] * 3),
    )


def _share(found: set[Any], planted: set[Any]) -> float:
    return 100 * len(found & planted) / len(planted)


def _read_times(folder: Path, count: int) -> tuple[float, float]:
    """Return how long sessions on the disk take, at first and with their table at hand, s."""
    for number in range(count):
        with Session.create(folder / f"{number:04d}") as session:
            session.set_parameter("devices.serial", f"M8128-{number % FEWEST}")
            session.add_input(b"solid", "mesh", name="probe.stl")
    begin = process_time()
    first = read_fleet([*find([folder])])
    between = process_time()
    again = read_fleet([*find([folder])], first.table)
    end = process_time()
    if first.read != count or again.read != 0 or not first.table.equals(again.table):
        raise AssertionError("the second run is not the first")
    return between - begin, end - between
