"""What the table has of a session: one declaration of its columns.

The table of sessions, as Apache Parquet.

Parquet and not a database: the table is made anew from the sessions at each run and is never edited, it is one file
that pandas, DuckDB and MATLAB read, and pyarrow is what studies keep their results with already.
"""

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from datetime import UTC, date, datetime
from pathlib import Path, PurePath
from typing import Any, get_type_hints

import numpy as np

from contactbench.pipeline.calibration.files.calibration_file import decode_record
from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, FORCE_BIAS, TORQUE_BIAS
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.fleet.source import NoSessionError, SessionSource, opened
from contactbench.pipeline.report.report_file import parse_verification
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.state import Input, Result, State, content_of, fold
from contactbench.pipeline.session.why import stale_results
from contactbench.pipeline.settings import ReportSettings

AXES = "xyz"


@dataclass(frozen=True)
class FleetRow:
    """
    One session: its newest calibration and verification. SI units; None: it has none, or nobody said.

    Bias, mass and centre of mass have their standard deviations beside them, in ``..._sigma_...``.
    """

    journal: str  # SHA-256: it changes with whatever is in the session
    files: str  # JSON: size and time of each other file that was read
    place: str  # Of the folder or archive
    session: str  # Its id; a copy has the same
    records: int  # Of its journal
    sensor: str  # Serial number
    model: str
    tool: str
    operator: str
    certificate: str
    due: date | None  # Until when the sensor's certificate is valid
    due_unreadable: str  # What is said in place of that date, and is none
    calibrated: datetime | None
    verdict: str
    stale: bool  # Whether the calibration no longer follows from what the session holds
    poses: int | None
    temperature_C: float | None  # Mean over the poses
    force_bias_x_N: float | None = None
    force_bias_y_N: float | None = None
    force_bias_z_N: float | None = None
    torque_bias_x_Nm: float | None = None
    torque_bias_y_Nm: float | None = None
    torque_bias_z_Nm: float | None = None
    mass_kg: float | None = None
    centre_x_m: float | None = None
    centre_y_m: float | None = None
    centre_z_m: float | None = None
    force_bias_sigma_x_N: float | None = None
    force_bias_sigma_y_N: float | None = None
    force_bias_sigma_z_N: float | None = None
    torque_bias_sigma_x_Nm: float | None = None
    torque_bias_sigma_y_Nm: float | None = None
    torque_bias_sigma_z_Nm: float | None = None
    mass_sigma_kg: float | None = None
    centre_sigma_x_m: float | None = None
    centre_sigma_y_m: float | None = None
    centre_sigma_z_m: float | None = None
    verified: datetime | None = None
    verification_passed: bool | None = None
    error_mean_m: float | None = None
    error_p95_m: float | None = None
    error_max_m: float | None = None


def vector(name: str, unit: str, values: Any) -> dict[str, float]:
    """Return the three columns of a vector (3,)."""
    return {f"{name}_{axis}_{unit}": float(value) for axis, value in zip(AXES, values, strict=True)}


def column_types() -> dict[str, type]:
    """Return the type of each column, without None."""
    hints = get_type_hints(FleetRow)
    return {
        each.name: next(
            kind
            for kind in (date, datetime, bool, int, float, str)
            if hints[each.name] in (kind, kind | None)
        )
        for each in fields(FleetRow)
    }


# ---- A session's row of the table ----------------------------------------------------------------


_FIRST_YEAR, _LAST_YEAR = 1970, 2200  # Of what can have been made: the last is not included


def hash_of(journal: bytes) -> str:
    """Return what a session is known by: it changes with whatever is added to the session."""
    return hashlib.sha256(journal).hexdigest()


def summarize(source: SessionSource, journal: bytes) -> FleetRow:
    """
    Return a session's row.

    Raises
    ------
    InputError
        Its journal, its newest calibration or its newest verification is damaged.
    """
    state = fold(content_of(source.place, journal).records)
    calibration, verification = state.newest("calibration"), state.newest("verification")
    due, due_unreadable = _due(state)
    read = [each.file.path for each in (calibration, verification) if each is not None]
    return FleetRow(
        journal=hash_of(journal),
        files=json.dumps({path: source.stamp(path) for path in read}),
        place=str(source.place),
        session=state.id,
        records=state.count,
        sensor=_serial(state),
        tool=_tool(state),
        model=_text(state, "report.sensor"),
        operator=_text(state, "report.operator"),
        certificate=_text(state, "report.certificate"),
        due=due,
        due_unreadable=due_unreadable,
        **_calibration_facts(source, calibration),
        stale=_is_stale(state, calibration),
        **_verification_facts(source, verification),
    )


def _text(state: State, key: str) -> str:
    value = state.setting(key)
    return value.strip() if isinstance(value, str) else ""


def unchanged(source: SessionSource, files: str) -> bool:
    """Tell whether the files that a row was made of have the size and time of then."""
    try:
        return all(source.stamp(path) == stamp for path, stamp in json.loads(files).items())
    except (OSError, ValueError, AttributeError):  # a file is gone, or the table was changed by somebody
        return False


def _due(state: State) -> tuple[date | None, str]:
    """Return until when the certificate is valid, or what is said of it and is no date."""
    said = state.setting("report.due")
    try:
        due = ReportSettings.checked({"due": said}).due
    except InputError:
        return None, str(said)
    return (date.fromisoformat(due), "") if due else (None, "")


def _serial(state: State) -> str:
    said = (each.sensor for each in reversed(state.inputs) if each.sensor)
    return _text(state, "devices.serial") or next(said, "")


def _tool(state: State) -> str:
    """Return the name of the mesh file, or else of the probe."""
    made_of = state.mesh or state.newest("probe")
    if made_of is None:
        return ""
    return PurePath(made_of.action.name if isinstance(made_of, Result) else made_of.name).stem


def _is_stale(state: State, calibration: Result | Input | None) -> bool:
    return isinstance(calibration, Result) and bool(stale_results(state).get(calibration.slot))


def _calibration_facts(source: SessionSource, found: Result | Input | None) -> dict[str, Any]:
    if found is None:
        return {"calibrated": None, "verdict": "", "poses": None, "temperature_C": None}
    record = decode_record(source.read(found.file), f"{source.place}: {found.file.path}")
    calibration, model = record.calibration, record.calibration.model
    sigma = np.sqrt(np.diag(calibration.covariance))
    degrees = [pose.temperature for pose in calibration.poses if pose.temperature is not None]
    facts = {
        "calibrated": _moment(record.created or found.at, source, found),
        "verdict": calibration.verdict.level.value,
        "poses": len(calibration.poses),
        "temperature_C": float(np.mean(degrees)) if degrees else None,
        "mass_kg": float(model.mass),
        "mass_sigma_kg": float(model.mass_sigma),
    }
    for name, unit, part in (
        ("force_bias", "N", FORCE_BIAS),
        ("torque_bias", "Nm", TORQUE_BIAS),
        ("centre", "m", CENTRE_OF_MASS),
    ):
        facts |= vector(name, unit, model.vector[part]) | vector(f"{name}_sigma", unit, sigma[part])
    return facts


def _verification_facts(source: SessionSource, found: Result | Input | None) -> dict[str, Any]:
    if found is None:
        return {}
    verification = parse_verification(source.read(found.file), f"{source.place}: {found.file.path}")
    overall = verification.overall
    facts: dict[str, Any] = {
        "verified": _moment(found.at, source, found),
        "verification_passed": verification.verdict.passed,
    }
    if overall is not None:
        facts |= {
            f"error_{name}_m": 1e-3 * value
            for name, value in (("mean", overall.mean_mm), ("p95", overall.p95_mm), ("max", overall.max_mm))
        }
    return facts


def _moment(at: datetime | str, source: SessionSource, found: Result | Input) -> datetime:
    """Return when a result was made, UTC; SessionError: then it cannot have been."""
    made = datetime.fromisoformat(at) if isinstance(at, str) else at
    # Before it is turned into UTC, which the year 9999 may not be.
    if not _FIRST_YEAR <= made.year < _LAST_YEAR:
        raise SessionError(
            f"{source.place}: {found.file.path}: created in {made.year}, which cannot be: set the clock of the"
            " computer and make it again."
        )
    return made.astimezone(UTC).replace(microsecond=0)


# ---- the table of sessions, as Apache Parquet ----------------------------------------------------


_META, _VERSION = b"contactbench.fleet", b"2"


@dataclass(frozen=True)
class Skipped:
    """A folder or archive that is not in the table, and why."""

    place: str
    reason: str
    damaged: bool = False  # Not merely a copy, or no session


@dataclass(frozen=True)
class Fleet:
    """
    What was read.

    Attributes
    ----------
    table : pyarrow.Table
        A row a session; columns as `FleetRow`.
    skipped : tuple of Skipped
    read : int
        Sessions that were read now; the others were known.
    """

    table: Any
    skipped: tuple[Skipped, ...]
    read: int


def schema() -> Any:
    """Return the table's Arrow schema."""
    import pyarrow as pa

    kinds = {
        str: pa.string(),
        int: pa.int64(),
        float: pa.float64(),
        bool: pa.bool_(),
        date: pa.date32(),
        datetime: pa.timestamp("us", "UTC"),
    }
    columns = [(name, kinds[kind]) for name, kind in column_types().items()]
    return pa.schema(columns, metadata={_META: _VERSION})


def table_of(rows: Sequence[FleetRow]) -> Any:
    """Return rows as an Arrow table."""
    import pyarrow as pa

    form = schema()
    columns = [pa.array([_plain(getattr(row, each.name)) for row in rows], each.type) for each in form]
    return pa.Table.from_arrays(columns, schema=form)


def _plain(value: Any) -> Any:
    """Return a text that UTF-8 can hold, as names of files may not be; anything else as it is."""
    return value.encode("utf-8", "backslashreplace").decode() if isinstance(value, str) else value


def read_fleet(
    places: Sequence[Path], known: Any = None, progress: Callable[[int, int], None] = lambda *_: None
) -> Fleet:
    """
    Read sessions; what is damaged or no session is told and left out.

    Parameters
    ----------
    places : sequence of Path
        Folders and archives, as `find` yields them.
    known : pyarrow.Table, optional
        An earlier table: a session whose journal is in it, and whose files have the size and time of then,
        is not read again.
    progress : callable
        Gets how many are through, and of how many.
    """
    import pyarrow as pa

    index = {} if known is None else {sha: row for row, sha in enumerate(known["journal"].to_pylist())}
    files = [] if known is None else known["files"].to_pylist()
    rows: list[FleetRow] = []
    kept: list[tuple[int, str]] = []
    skipped = []
    for number, place in enumerate(places):
        progress(number, len(places))
        try:
            with opened(place) as source:
                journal = source.journal()
                row = index.get(hash_of(journal))
                if row is None or not unchanged(source, files[row]):
                    rows.append(summarize(source, journal))
                else:
                    kept.append((row, _plain(str(place))))
        except InputError as error:
            damaged = not isinstance(error, NoSessionError)
            skipped.append(Skipped(_plain(str(place)), _plain(str(error)), damaged))
    table = table_of(rows)
    if known is not None and kept:
        rows_kept, where = zip(*kept, strict=True)
        moved = pa.array(where, pa.string())
        old = known.take(rows_kept).set_column(known.schema.get_field_index("place"), "place", moved)
        table = pa.concat_tables([old.cast(schema()), table])
    table, copies = _without_copies(table)
    return Fleet(table, (*skipped, *copies), len(rows))


def _without_copies(table: Any) -> tuple[Any, list[Skipped]]:
    """Leave one of several states of the same session: that with the most records."""
    if not table.num_rows:
        return table, []
    order = [("session", "ascending"), ("records", "descending"), ("place", "ascending")]
    table = table.sort_by(order)
    stay, copies, last, place = [], [], None, ""
    sessions = zip(table["session"].to_pylist(), table["place"].to_pylist(), strict=True)
    for number, (session, where) in enumerate(sessions):
        if session == last:
            copies.append(Skipped(where, f"{where}: a copy of the session in {place}, which is no older."))
            continue
        last, place = session, where
        stay.append(number)
    order = [(name, "ascending") for name in ("sensor", "tool", "calibrated", "place")]
    return table.take(stay).sort_by(order), copies


def load_table(file: Path) -> Any:
    """
    Return an earlier table; None: there is none, or one of another version, which is made anew.

    Raises
    ------
    InputError
        The file is something else.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    if not file.exists():
        return None
    try:
        table = pq.read_table(file)
    except (OSError, pa.ArrowException) as error:
        raise InputError(
            f"{file}: this file exists and is no table of a fleet: choose another name."
        ) from error
    metadata = table.schema.metadata or {}
    if _META not in metadata:
        raise InputError(f"{file}: this file exists and is no table of a fleet: choose another name.")
    same = metadata[_META] == _VERSION and table.schema.equals(schema())
    return table if same else None


def save_table(table: Any, file: Path) -> None:
    """Write a table, whole or not at all; InputError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd")
    write_file(file, sink.getvalue().to_pybytes(), what="the table cannot be written")
