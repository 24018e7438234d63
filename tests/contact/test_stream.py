import io
import math
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import trimesh

import contactbench.pipeline.contact.stream as stream_module
from contactbench.pipeline.contact import ContactSolver, Gates, Reason
from contactbench.pipeline.contact.contact_csv import HEADER, REASONS
from contactbench.pipeline.contact.facet_marks import MARKS
from contactbench.pipeline.contact.stream import WrenchFileError, locate_file
from contactbench.pipeline.contact.wrench_csv import RAW_COLUMNS
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe, load_probe
from contactbench.pipeline.tables.shortest import shortest

COLUMNS = "t,fx,fy,fz,mx,my,mz"
GOOD = "0.1,0,0,-5,0,0,0"


@pytest.fixture(scope="module")
def probe(tmp_path_factory: pytest.TempPathFactory) -> Probe:
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=40.0)
    mesh.apply_translation([5.0, 0.0, 120.0])
    path = tmp_path_factory.mktemp("probe") / "ball.stl"
    mesh.export(path)
    return load_probe(path, "mm")


@pytest.fixture
def solver(probe: Probe) -> ContactSolver:
    return ContactSolver(probe)


@pytest.fixture(scope="module")
def wrenches(probe: Probe) -> np.ndarray:
    """Touches all over the ball: some too light, some past it, some grazing."""
    random = np.random.default_rng(3)
    centre = probe.vertices.mean(axis=0)
    outward = random.normal(size=(300, 3))
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    force = -outward * random.uniform(0.1, 9.0, (300, 1)) + random.normal(0, 1.0, (300, 3))
    torque = np.cross(centre + 0.04 * outward, force) + random.normal(0, 0.01, (300, 3))
    return np.hstack((force, torque))


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def write(data: str | bytes, name: str = "wrenches.csv") -> Path:
        path = tmp_path / name
        path.write_bytes(data.encode() if isinstance(data, str) else data)
        return path

    return write


def table(*rows: str, header: str = COLUMNS) -> str:
    return "".join(line + "\n" for line in (header, *rows))


def rows_of(wrenches: np.ndarray) -> list[str]:
    return [f"{0.005 * i:.3f}," + ",".join(map(repr, row)) for i, row in enumerate(wrenches.tolist())]


def located(solver: Any, source: Path, **options: Any) -> bytes:
    out = source.with_name("contacts.csv")
    locate_file(solver, source, out, **options)
    return out.read_bytes()


def cells(data: bytes) -> list[list[str]]:
    return [line.split(",") for line in data.decode().splitlines()[1:]]


# ---- the numbers ---------------------------------------------------------------------------------


def test_output_holds_what_the_batch_says(solver, wrenches, write):
    data = located(solver, write(table(*rows_of(wrenches))))
    assert data.startswith(HEADER)
    found = cells(data)
    batch = solver.locate_batch(wrenches)
    assert len(found) == len(wrenches)
    assert {REASONS[r] for r in batch.reasons} >= {"ok", "low_force"}
    assert np.isfinite(batch.misfits[batch.reasons == Reason.IMPLAUSIBLE]).any()
    for i, (t, x, y, z, k, face, reason, candidates, sigma, misfit, confidence, on) in enumerate(found):
        assert t == f"{0.005 * i:.3f}"
        assert reason == REASONS[batch.reasons[i]]
        assert candidates == str(batch.candidates[i])
        assert face == ("" if batch.faces[i] < 0 else str(batch.faces[i]))
        numbers = (*batch.points[i], batch.torques[i], 1e3 * batch.sigma_max[i], batch.misfits[i])
        assert [x, y, z, k, sigma, misfit] == ["" if math.isnan(v) else repr(float(v)) for v in numbers]
        assert confidence == repr(float(batch.confidences[i]))
        assert on == ("measured" if face else "")


def test_each_row_says_what_its_facet_is(probe, wrenches, write):
    centre = probe.vertices[probe.faces].mean(axis=1)
    invented, hidden = centre[:, 0] > 0.005, centre[:, 1] > 0
    marked = probe.with_region(np.where(hidden, 1, 0), (1,)).with_invented(invented)
    expected = np.where(hidden, "untouchable", np.where(invented, "invented", "measured"))
    solver, out = ContactSolver(marked), io.BytesIO()
    source = write(table(*rows_of(wrenches)))
    summary = locate_file(solver, source, out)  # of the solver's own probe
    rows = cells(out.getvalue())
    assert [row[11] for row in rows] == [expected[int(row[5])] if row[5] else "" for row in rows]
    counts = {on: sum(row[11] == on for row in rows) for on in MARKS}
    assert min(counts.values()) > 10
    assert summary.on_invented == counts["invented"]
    assert summary.on_untouchable == counts["untouchable"]
    total = sum(counts.values())
    assert summary.warnings[0].startswith(f"Contacts on invented facets: {counts['invented']} of {total}.")
    assert summary.warnings[1].startswith(
        f"Contacts on untouchable regions: {counts['untouchable']} of {total}."
    )
    again = io.BytesIO()  # of the probe that is given: the method has none
    method = SimpleNamespace(name="own", locate_batch=solver.locate_batch)
    assert locate_file(method, source, again, probe=marked).on_invented == counts["invented"]
    assert again.getvalue() == out.getvalue()
    unknown = io.BytesIO()
    assert locate_file(method, source, unknown).on_untouchable == 0
    assert {row[11] for row in cells(unknown.getvalue())} == {""}


def test_summary_counts_and_finds_the_median(solver, wrenches, write):
    out = io.BytesIO()
    summary = locate_file(solver, write(table(*rows_of(wrenches))), out)
    batch = solver.locate_batch(wrenches)
    assert summary.rows == len(wrenches)
    assert summary.reasons == {
        name: int(np.count_nonzero(batch.reasons == i)) for i, name in enumerate(REASONS)
    }
    sigma = np.sort(batch.sigma_max[~np.isnan(batch.sigma_max)])
    middle = 1e3 * sigma[(len(sigma) - 1) // 2]
    assert summary.median_sigma_max_mm == pytest.approx(middle, rel=1e-3)
    assert summary.method == "contactbench"
    assert summary.rows_per_second > 0
    assert summary.warnings == ()


@pytest.mark.parametrize(("block_bytes", "track"), [(7, False), (64, True), (1000, True)])
def test_blocks_leave_no_seam(solver, wrenches, write, block_bytes, track):
    lines = rows_of(wrenches)
    lines[100] = lines[100].replace(",", ',"', 1).replace(",", '",', 2).replace('",', ",", 1)
    lines.insert(50, "")
    for end in ("\n", "\r\n"):
        source = write(b"\xef\xbb\xbf" + table(*lines).replace("\n", end).encode())
        whole = located(solver, source, track=track)
        assert located(solver, source, track=track, block_bytes=block_bytes) == whole
        assert whole.count(b"\n") == 301


@pytest.mark.parametrize("seed", [0])
def test_shortest_is_repr(seed):
    random = np.random.default_rng(seed)
    size = 20_000
    values = np.concatenate(
        (
            random.normal(0, 0.1, size),
            10.0 ** random.uniform(-7, 14, 3 * size),
            np.round(10.0 ** random.uniform(2, 12, size), 6),
            -random.integers(1, 10**6, size) / 10.0 ** random.integers(0, 9, size),
            random.integers(0, 2**20, size) / 2.0 ** random.integers(0, 30, size),
            np.nextafter(10.0 ** np.arange(-6, 14), 0),
            np.nextafter(10.0 ** np.arange(-6, 14), 1e15),
            np.nextafter(2.0 ** np.arange(-20, 45), 0),
            [0.0, -0.0, math.inf, -math.inf, 5e-324, -1.7976931348623157e308, 0.1, 0.0001, 1000.0, 999.9999],
        )
    )
    texts = [bytes(row).replace(b"\0", b"").decode() for row in shortest(values)]
    assert texts == [repr(value) for value in values.tolist()]
    assert not shortest(np.array([math.nan])).any()


# ---- what a file may look like -------------------------------------------------------------------

PLAIN = table("0.10,0,0,-5.5,0,0.25,0", "0.20,1,0,-5,0,0.25,0")


@pytest.mark.parametrize(
    "text",
    [
        PLAIN.replace("\n", "\r\n"),
        "\ufeff" + PLAIN,
        PLAIN + "\n\n  \n",
        PLAIN.rstrip("\n"),
        table('0.10,"0","0","-5.5",0,0.25,0', '"0.20",1,0,-5,0,"0.25",0'),
        table(*(row.replace(",", " , ").replace("0 ,", "0,", 1) for row in PLAIN.splitlines()[1:])),
        table(
            "0.25,x,0.10,0,0,-5.5,0,0,é",
            '0.25,y,0.20,0,1,-5,0,0,"a, b"',
            header=' my,T,"t",mx,fx , fz,fy,mz,note',
        ),
    ],
    ids=["crlf", "bom", "blank-lines", "no-last-newline", "quoted", "spaces", "other-columns"],
)
def test_dialects_give_the_same_contacts(solver, write, text):
    plain = located(solver, write(PLAIN))
    assert located(solver, write(text)) == plain
    assert plain.count(b"\n") == 3


@pytest.mark.parametrize("t", ["", "1e3", "007", "2024-05-01T12:00:00Z", " 1 ", "µ"])
def test_t_is_copied_as_it_stands(solver, write, t):
    source = write(table(f"{t},0,0,-5,0,0,0", "1,0,0,-5,0,0,0"))
    assert cells(located(solver, source))[0][0] == t


def test_t_with_a_comma_stays_one_cell(solver, write):
    data = located(solver, write(table('"May 1, ""noon""",0,0,-5,0,0,0')))
    assert data.splitlines()[1].startswith(b'"May 1, ""noon""",')


def test_streams_instead_of_files(solver, write):
    out = io.BytesIO()
    locate_file(solver, io.BytesIO(PLAIN.encode()), out)
    assert out.getvalue() == located(solver, write(PLAIN))


def test_progress_ends_with_every_byte_read(solver, write):
    source = write(PLAIN * 1)
    seen: list[tuple[int, int]] = []
    locate_file(
        solver, source, io.BytesIO(), block_bytes=10, progress=lambda done, total: seen.append((done, total))
    )
    size = source.stat().st_size
    assert seen[-1] == (size, size)
    assert seen == sorted(seen)


# ---- tracking ------------------------------------------------------------------------------------


def test_track_equals_track_batch(probe, wrenches, write):
    source = write(table(*rows_of(wrenches)))
    solver = ContactSolver(probe)
    solver.track(wrenches[7])  # a stream before this one must not matter
    found = cells(located(solver, source, track=True))
    times = np.array([float(row[0]) for row in found])
    steps = np.diff(times, prepend=times[0])
    fresh = ContactSolver(probe).track_batch(wrenches, np.zeros(len(times)), steps)
    assert [row[5] for row in found] == ["" if face < 0 else str(face) for face in fresh.faces]
    assert [row[6] for row in found] == [REASONS[reason] for reason in fresh.reasons]


@pytest.mark.parametrize("block_bytes", [10, 2**20])
@pytest.mark.parametrize("max_age", [0.1, math.inf])
def test_time_that_does_not_increase_is_stale(probe, write, block_bytes, max_age):
    times = [0.0, 0.1, 0.1, 0.05, 0.2]
    source = write(table(*(f"{t},0,0,-5,0,0.025,0" for t in times)))
    out = io.BytesIO()
    solver = ContactSolver(probe, gates=Gates(max_age=max_age))
    summary = locate_file(solver, source, out, track=True, block_bytes=block_bytes)
    stale = [row[6] == "stale" for row in cells(out.getvalue())]
    assert stale == [False, False, True, True, False]
    assert "2, the first on line 4" in summary.warnings[0]
    assert locate_file(solver, source, io.BytesIO()).reasons["stale"] == 0


def test_track_needs_numbers_for_times(solver, write):
    source = write(table(GOOD, "noon,0,0,-5,0,0,0"))
    with pytest.raises(WrenchFileError, match=r"line 3: column t holds 'noon', which is not a number"):
        located(solver, source, track=True)


def test_track_needs_a_method_that_can(solver, write):
    class Other:
        name = "other"
        locate_batch = solver.locate_batch

    with pytest.raises(InputError, match="method other cannot track: only contactbench can"):
        located(Other(), write(PLAIN), track=True)
    assert locate_file(Other(), write(PLAIN), io.BytesIO()).method == "other"


# ---- what is refused -----------------------------------------------------------------------------

LONG = "1" * 300
REMEDY = "remove the row, or pass --allow-nan to get the answer not_finite"
REFUSED = {
    "empty": ("", "the file is empty: it needs the header t,fx,fy,fz,mx,my,mz"),
    "only-bom": ("\ufeff", "the file is empty"),
    "no-rows": (table(), "there is a header but no row below it"),
    "blank-rows": (table("", ""), "there is a header but no row below it"),
    "missing": (
        table("1,2", header="t,fx,force"),
        "line 1: columns fy, fz, mx, my, mz missing; found: t, fx, force. Name the columns",
    ),
    "missing-one": (
        table(header="t,fx,fy,fz,mx,my,"),
        "column mz missing; found: t, fx, fy, fz, mx, my, (no",
    ),
    "no-header": (GOOD + "\n", "The first line contains numbers: put the header t,fx"),
    "semicolons": (table(header=COLUMNS.replace(",", ";")), "Separate the columns with commas"),
    "duplicate": (table(header=COLUMNS + ",fx"), "line 1: column fx occurs 2 times: keep one"),
    "text": (
        table(GOOD, "", GOOD, "2,0,zero,-5,0,0,0"),
        "line 5: column fy holds 'zero', which is not a number: correct or remove the row",
    ),
    "underscore": (table("2,0,1_0,-5,0,0,0"), "line 2: column fy holds '1_0', which is not a number"),
    "no-value": (table(GOOD, "2,0,,-5,0,0,0"), f"line 3: column fy is empty: {REMEDY}"),
    "nan": (table(GOOD, GOOD, "2,0,0,-5,0,NaN,0"), f"line 4: column my holds nan: {REMEDY}"),
    "inf": (table("", "2,0,0,-inf,0,0,0"), f"line 3: column fz holds -inf: {REMEDY}"),
    "too-large": (table("2,0,0,-5,0,0,1e999"), "line 2: column mz holds inf"),
    "few": (table(GOOD, "1,2,3"), "line 3: 3 cells, but the header has 7: complete the row or remove it"),
    "many": (table("0,1,0,0,0,-5,0,0,0"), "line 2: 9 cells, but the header has 7: remove .* with a point"),
    "quote": (table('1,"2,3,4,5,6,7'), "line 2: the cells cannot be separated .*: check the quotes"),
    "old-mac": (table(GOOD).replace("\n", "\r"), "line 1: the cells cannot be separated"),
    "return": (table(GOOD, "1\r,0,0,0,0,0,0"), "line 3: the cells cannot be separated"),
    "latin": (
        table(GOOD).encode() + b"\xb5,0,0,0,0,0,0\n",
        "line 3: this is not UTF-8 text: save the table as",
    ),
    "utf16": (table(GOOD).encode("utf-16"), "line 1: this is not UTF-8 text"),
    "binary": (table(GOOD).encode() + bytes(500), "line 3: this is not UTF-8 text"),
    "long-line": (b"1" * 2**21, "a line is longer than 1 MiB, so this is not a CSV file"),
    "long-time": (table(GOOD, LONG + GOOD), "line 3: column t has 303 bytes, more than 256"),
}


@pytest.mark.parametrize("block_bytes", [16, 4 * 2**20])
@pytest.mark.parametrize("name", REFUSED)
def test_refused(solver, write, name, block_bytes):
    data, message = REFUSED[name]
    with pytest.raises(WrenchFileError, match=message.replace("(", r"\(")) as caught:
        located(solver, write(data), block_bytes=block_bytes if name != "long-line" else 2**19)
    assert str(caught.value).startswith(str(write("")) + ": ")
    assert len(str(caught.value).splitlines()) == 1


def test_allow_nan_answers_with_not_finite(solver, write):
    source = write(table(GOOD, "1,nan,0,0,0,0,0", "2,0,0,-inf,0,0,0", "3,0,,0,0,0,0", GOOD))
    found = cells(located(solver, source, allow_nan=True))
    assert [row[6] == "not_finite" for row in found] == [False, True, True, True, False]
    assert found[1] == ["1", "", "", "", "", "", "not_finite", "0", "", "", "0.0", ""]
    source = write(table("0,0,0,-5,0,0,0", "nan,0,0,-5,0,0,0", "1,0,0,-5,0,0,0"))
    found = cells(located(solver, source, allow_nan=True, track=True))
    assert [row[6] == "stale" for row in found] == [False, True, False]


@pytest.mark.parametrize("column", RAW_COLUMNS)
def test_a_raw_recording_is_refused(solver, write, column):
    source = write(table(GOOD + ",0", header=f"{COLUMNS},{column}"))
    with pytest.raises(
        WrenchFileError,
        match=f"line 1: column {column}: this is a raw recording.* contactbench calibrate comp",
    ):
        located(solver, source)
    plain = located(solver, write(table(GOOD), "plain.csv"))
    assert located(solver, source, compensated=True) == plain


def test_missing_file_and_folder(solver, tmp_path):
    with pytest.raises(WrenchFileError, match=r"nowhere\.csv: there is no such file: check the path"):
        located(solver, tmp_path / "nowhere.csv")
    with pytest.raises(WrenchFileError, match="this is a folder: choose a CSV file inside it"):
        located(solver, tmp_path)


def test_output_must_not_be_the_input(solver, write, tmp_path):
    source = write(PLAIN)
    link = tmp_path / "link.csv"
    link.symlink_to(source)
    for out in (source, tmp_path / "." / source.name, link):
        with pytest.raises(
            WrenchFileError, match="the output would overwrite the input: choose another name"
        ):
            locate_file(solver, source, out)
    assert source.read_text(encoding="utf-8") == PLAIN


def test_output_that_cannot_be_written(solver, write, tmp_path):
    source = write(PLAIN)
    with pytest.raises(
        WrenchFileError, match=r"the contacts cannot be written .*: choose a folder that exists"
    ):
        locate_file(solver, source, tmp_path / "nowhere" / "contacts.csv")
    with pytest.raises(WrenchFileError, match="this is a folder or a device"):
        locate_file(solver, source, tmp_path)
    with pytest.raises(WrenchFileError, match="this is a folder or a device"):
        locate_file(solver, source, Path(os.devnull))


# ---- all or nothing ------------------------------------------------------------------------------


def test_a_bad_row_late_in_the_file_leaves_the_old_output(solver, write, tmp_path):
    old = write("old", "contacts.csv")
    source = write(table(*[GOOD] * 5000, "1,2,3"))
    with pytest.raises(WrenchFileError, match="line 5002"):
        located(solver, source, block_bytes=1000)
    assert old.read_text(encoding="utf-8") == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["contacts.csv", "wrenches.csv"]


@pytest.mark.parametrize("fault", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_an_interruption_leaves_the_old_output(solver, write, tmp_path, monkeypatch, fault):
    old = write("old", "contacts.csv")

    def fail(_: int) -> None:
        raise fault

    monkeypatch.setattr(stream_module.os, "fsync", fail)
    expected = WrenchFileError if isinstance(fault, OSError) else KeyboardInterrupt
    with pytest.raises(expected, match="No space left" if isinstance(fault, OSError) else None):
        located(solver, write(PLAIN))
    assert old.read_text(encoding="utf-8") == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["contacts.csv", "wrenches.csv"]


def test_a_link_as_output_stays_a_link(solver, write, tmp_path):
    target = write("old", "target.csv")
    link = tmp_path / "contacts.csv"
    link.symlink_to(target)
    locate_file(solver, write(PLAIN), link)
    assert link.is_symlink()
    assert target.read_bytes().startswith(HEADER)
