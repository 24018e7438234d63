import csv
import io
import math
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import plain_rows
from contactbench.pipeline.tables import TableError, TableReader, TableRows, Wording, open_table, read_table
from contactbench.pipeline.tables.layouts import LabTable, layout_of

POSES = Wording(
    header="x,y,z and qw,qx,qy,qz or rx,ry,rz",
    rows="poses",
    meaning="lengths in m, angles in degrees",
    not_finite="remove the pose.",
)
POSITION = ("x", "y", "z")


def pose(reader: TableReader) -> None:
    rotation = ("rx", "ry", "rz") if "rx" in reader.names else ("qw", "qx", "qy", "qz")
    reader.select((*POSITION, *rotation), optional=["temperature"], allow_nan={"temperature"})


def columns(*names: str, **options: Any) -> Callable[[TableReader], None]:
    return lambda reader: reader.select(names, **options)


def read(data: str | bytes, select: Callable[[TableReader], None] = pose, **options: Any) -> TableRows:
    stream = io.BytesIO(data.encode() if isinstance(data, str) else data)
    return read_table(stream, select, POSES, **options)


def table(header: str, *rows: str) -> str:
    return "".join(line + "\n" for line in (header, *rows))


# ---- which columns -------------------------------------------------------------------------------


def test_the_header_decides_the_columns():
    angles = read(table("rz,ry,rx,z,y,x", "6,5,4,3,2,1"))
    assert angles.columns == (*POSITION, "rx", "ry", "rz")
    assert angles.numbers.tolist() == [[1, 2, 3, 4, 5, 6]]
    quaternion = read(table("x,y,z,note,qx,qy,qz,qw", "1,2,3,far,0.5,0.25,0,-1", "7,8,9,,0,0,0,1"))
    assert quaternion.columns == (*POSITION, "qw", "qx", "qy", "qz")
    assert quaternion.numbers.tolist() == [[1, 2, 3, -1, 0.5, 0.25, 0], [7, 8, 9, 1, 0, 0, 0]]
    assert quaternion.text is None
    assert quaternion.lines.tolist() == [2, 3]


def test_optional_columns_come_last_where_they_are_there():
    rows = read(table("temperature,x,y,z,rx,ry,rz", "21.5,1,2,3,4,5,6"))
    assert rows.columns[-1] == "temperature"
    assert rows.column("temperature").tolist() == [21.5]
    assert rows.column("x").tolist() == [1]
    with pytest.raises(KeyError, match="temperature"):
        read(table("x,y,z,rx,ry,rz", "1,2,3,4,5,6")).column("temperature")


@pytest.mark.parametrize("header", ["t,a,b", "a,t,b", "a,b,t"])
def test_text_is_passed_on_as_it_stands(header):
    place = header.split(",").index("t")
    lines = []
    for text in ("0.10", "", "12:00Z", " µ "):
        cells = ["1", "2"]
        cells.insert(place, text)
        lines.append(",".join(cells))
    rows = read(table(header, *lines), columns("b", "a", text="t"))
    assert rows.text is not None
    assert [text.decode() for text in rows.text.tolist()] == ["0.10", "", "12:00Z", " µ "]
    assert rows.numbers.tolist() == [[2, 1]] * 4


def test_text_may_be_a_number_too():
    rows = read(table("t,a", "0.10,5", "1e1,6"), columns("t", "a", text="t"))
    assert rows.text is not None
    assert rows.text.tolist() == [b"0.10", b"1e1"]
    assert rows.numbers.tolist() == [[0.1, 5], [10, 6]]


def test_blocks_need_not_be_read_at_once():
    data = table("t,a", *(f"{i},{i * i}" for i in range(100))).encode()
    reader = TableReader(io.BytesIO(data), "squares.csv", POSES, block_bytes=50)
    assert reader.names == ("t", "a")
    reader.select(["a"], text="t")
    blocks = list(reader)
    assert len(blocks) > 5
    assert np.concatenate([rows.numbers[:, 0] for rows in blocks]).tolist() == [i * i for i in range(100)]
    assert np.concatenate([rows.lines for rows in blocks]).tolist() == list(range(2, 102))
    assert reader.bytes_read == len(data)


def test_misuse_is_no_fault_of_the_file():
    reader = TableReader(io.BytesIO(b"a\n1\n"), "a.csv", POSES)
    with pytest.raises(RuntimeError, match="select columns before reading rows"):
        next(iter(reader))
    with pytest.raises(ValueError, match="select at least one column"):
        reader.select([], optional=["b"])


# ---- what a file may look like -------------------------------------------------------------------

PLAIN = table("x,y,z,rx,ry,rz", "1,2,3,4,5,6", "-1,2e0,.5,0,0,90.0")


@pytest.mark.parametrize("block_bytes", [1, 20, 4096])
@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace("\n", "\r\r\n"),
        "\ufeff" + PLAIN,
        PLAIN.replace("\n1", "\n\n  \n1") + "\n\n \n",
        PLAIN.rstrip("\n"),
        PLAIN.replace("4", '"4"').replace("rx", '"rx"'),
        PLAIN.replace(",", " , "),
    ],
    ids=["plain", "crlf", "crcrlf", "bom", "blank-lines", "no-last-newline", "quotes", "spaces"],
)
def test_dialects(text, block_bytes):
    rows = read(text, block_bytes=block_bytes)
    assert rows.numbers.tolist() == [[1, 2, 3, 4, 5, 6], [-1, 2, 0.5, 0, 0, 90]]


@pytest.mark.parametrize("block_bytes", [1, 3, 4096])
def test_one_column_with_blank_lines(block_bytes):
    rows = read("a\n\n1\n\n\n2\n \n", columns("a"), block_bytes=block_bytes)
    assert rows.numbers.tolist() == [[1], [2]]
    assert rows.lines.tolist() == [3, 6]


# ---- what is refused -----------------------------------------------------------------------------

HEADER = "x,y,z,rx,ry,rz"
GOOD = "1,2,3,4,5,6"
REFUSED = {
    "empty": ("", "the file is empty: it needs the header x,y,z and qw,qx,qy,qz or rx,ry,rz and rows below"),
    "no-rows": (table(HEADER, "", " "), "there is a header but no row below it"),
    "missing": (
        table("x,y,w", GOOD),
        "line 1: columns z, qw, qx, qy, qz missing; found: x, y, w. Name the columns x,y,z and qw,qx,qy,qz or",
    ),
    "unnamed": (
        table("x,,z", GOOD),
        "found: x, (no name), z. Name the columns x,y,z and qw,qx,qy,qz or rx,ry,",
    ),
    "meaning": (table("x", "1"), "or rx,ry,rz: lengths in m, angles in degrees."),
    "no-header": (table(GOOD), "The first line contains numbers: put the header x,y,z and"),
    "semicolons": (table(HEADER.replace(",", ";")), "Separate the columns with commas"),
    "twice": (table("x,x,y,z,rx,ry,rz", GOOD), "line 1: column x occurs 2 times: keep one"),
    "text": (table(HEADER, GOOD, "1,2,3,4,5,six"), "line 3: column rz holds 'six', which is not a number"),
    "no-value": (table(HEADER, GOOD, "", "1,,3,4,5,6"), "line 4: column y is empty: remove the pose."),
    "nan": (table(HEADER, GOOD, "1,2,nan,4,5,6"), "line 3: column z holds nan: remove the pose."),
    "inf": (table(HEADER, "1,2,3,4,5,-1e999"), "line 2: column rz holds -inf: remove the pose."),
    "few": (table(HEADER, GOOD, "1,2"), "line 3: 2 cells, but the header has 6: complete the row"),
    "many": (table(HEADER, GOOD + ",7"), "line 2: 7 cells, but the header has 6: remove the surplus"),
    "quote": (table(HEADER, GOOD, '1,2,3,4,5,"6'), "line 3: the cells cannot be separated"),
    "return": (table(HEADER, GOOD, "\r" + GOOD), "line 3: the cells cannot be separated"),
    "latin": (table(HEADER, GOOD).encode() + b"\xb5,2,3,4,5,6\n", "line 3: this is not UTF-8 text: save"),
    "binary": (table(HEADER, GOOD).encode() + bytes(9), "line 3: this is not UTF-8 text"),
    "huge-line": (
        b"1" * (2**20 + 1),
        "a line is longer than 1 MiB, so this is not a CSV file of poses: choose another.",
    ),
}


@pytest.mark.parametrize("block_bytes", [16, 4 * 2**20])
@pytest.mark.parametrize("name", REFUSED)
def test_refused(tmp_path, name, block_bytes):
    data, message = REFUSED[name]
    path = tmp_path / "poses.csv"
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    with pytest.raises(TableError) as caught:
        read_table(path, pose, POSES, block_bytes=block_bytes if name != "huge-line" else 2**18)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_column_may_allow_what_others_refuse():
    header = "x,y,z,rx,ry,rz,temperature"
    rows = read(table(header, GOOD + ",nan", GOOD + ",", GOOD + ",inf", GOOD + ",20"))
    assert np.array_equal(rows.column("temperature"), [math.nan, math.nan, math.inf, 20], equal_nan=True)
    with pytest.raises(TableError, match="line 3: column y holds nan: remove the pose"):
        read(table(header, GOOD + ",nan", "1,nan,3,4,5,6,20"))
    with pytest.raises(TableError, match="line 2: column temperature holds 'warm', which is not a number"):
        read(table(header, GOOD + ",warm"))


@pytest.mark.parametrize("quote", ["", '"'])
def test_a_long_text_is_refused(quote):
    with pytest.raises(TableError, match="line 2: column t has 300 bytes, more than 256: it should hold a"):
        read(table("a,t", f"1,{quote}{'x' * 300}{quote}"), columns("a", text="t"))


def test_the_caller_names_the_error():
    class PoseFileError(InputError):
        pass

    wording = Wording(header="x", error=PoseFileError)
    with pytest.raises(PoseFileError, match=r"standard input: line 1: column x .*\. Name the columns x\.$"):
        read_table(io.BytesIO(b"y\n1\n"), columns("x"), wording)
    with pytest.raises(PoseFileError, match="line 2: column x is empty: correct or remove the row"):
        read_table(io.BytesIO(b"x,y\n,1\n"), columns("x"), wording)
    with pytest.raises(PoseFileError, match="there is no such file: check the path"):
        read_table(Path("nowhere.csv"), columns("x"), wording)
    assert issubclass(TableError, InputError)


def test_a_selection_may_refuse_the_file():
    def either(reader: TableReader) -> None:
        raise reader.error("both qw and rx: keep one kind of rotation.", 1)

    with pytest.raises(TableError, match="standard input: line 1: both qw and rx: keep one"):
        read("qw,rx\n", either)


def test_open_table_explains(tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text(PLAIN, encoding="utf-8")
    with open_table(path) as (stream, name, size):
        assert (stream.read(), name, size) == (PLAIN.encode(), str(path), len(PLAIN))
    for wrong, message in ((tmp_path, "this is a folder: choose a CSV file"), (Path("a\0b"), "cannot be op")):
        with pytest.raises(TableError, match=message), open_table(wrong):
            pass


def test_a_disk_that_fails_is_named():
    class Broken(io.BytesIO):
        def read(self, *_: Any) -> bytes:
            raise OSError(5, "Input/output error")

    with pytest.raises(TableError, match=r"the file cannot be read .*Input/output error.*copy it"):
        TableReader(Broken(), "a.csv", POSES)


@pytest.mark.parametrize("block_bytes", [1, 40, 4096])
def test_more_rows_than_a_small_table_has(block_bytes):
    text = table("a", *"123", "", *"4567")
    assert len(read(text, columns("a"), row_limit=7, block_bytes=block_bytes).lines) == 7
    with pytest.raises(TableError, match="line 6: more than 3 rows of poses: choose the right file or shor"):
        read(text, columns("a"), row_limit=3, block_bytes=block_bytes)


# ---- against a reading with the standard library -------------------------------------------------

Rows = list[tuple[int, str, list[float]]]


def reference(text: str, names: list[str], wanted: list[str]) -> Rows | None:
    """Read every line for itself; None stands for a file to refuse."""
    rows: Rows = []
    for line, row in enumerate(text.replace("\r\n", "\n").split("\n"), 2):
        if not row.strip():
            continue
        try:
            (cells,) = csv.reader([row], strict=True)
        except csv.Error:
            return None
        if len(cells) != len(names) or not all(cell.isascii() and "_" not in cell for cell in cells[1:]):
            return None
        try:
            numbers = [float(cells[names.index(name)]) for name in wanted]
        except ValueError:
            return None
        if not all(math.isfinite(number) for number in numbers):
            return None
        quoted = any(mark in cells[0] for mark in ',"')
        rows.append((line, '"' + cells[0].replace('"', '""') + '"' if quoted else cells[0], numbers))
    return rows or None


NUMBERS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False, width=32).map(repr),
    st.integers(-1000, 1000).map(str),
    st.sampled_from([" 1", "2 ", "+3", "4.", ".5", "1E3", '"6"', '" 7 "', "\t8"]),
)
TEXTS = st.sampled_from(["t", "", "0.1", "12:00", '"a b"', '""', "µ", " ", "\x0b", "\u2028"])
FAULTS = st.sampled_from(
    ["nan", "inf", "", "1_0", "٣", "x", '"', '1"', '"1, ""2"""', "1,2", "\r", "\r1", "1\r1", "0x1", "1d2"]
)
ENDS = st.sampled_from(["\n", "\n", "\n", "\r\n", "\r\r\n", "\n\n", "\n \n"])


@st.composite
def bodies(draw: st.DrawFn, cells: int) -> str:
    """Draw lines of which few are wrong: most files shall be read."""
    text = ""
    for _ in range(draw(st.integers(0, 6))):
        row = [draw(TEXTS), *(draw(NUMBERS) for _ in range(cells - 1))]
        if draw(st.integers(0, 9)) == 0:
            row[draw(st.integers(0, cells - 1))] = draw(FAULTS)
        text += ",".join(row) + draw(ENDS)
    return text.removesuffix("\n") if draw(st.booleans()) else text


@given(st.data(), st.integers(1, 3), st.integers(1, 60))
def test_agrees_with_the_standard_library(data, numbers, block_bytes):
    names = ["t", "a", "b", "c"][: numbers + 1]
    wanted = names[:0:-1]
    text = data.draw(bodies(numbers + 1))
    expected = reference(text, names, wanted)
    try:
        rows = read(",".join(names) + "\n" + text, columns(*wanted, text="t"), block_bytes=block_bytes)
    except TableError:
        assert expected is None
        return
    assert expected is not None
    assert rows.lines.tolist() == [line for line, _, _ in expected]
    assert rows.numbers.tolist() == [values for _, _, values in expected]
    assert rows.text is not None
    assert [value.decode() for value in rows.text.tolist()] == [value for _, value, _ in expected]


@given(st.data(), st.integers(1, 20))
def test_one_column_agrees_with_the_standard_library(data, block_bytes):
    cells = st.one_of(NUMBERS, st.sampled_from(["", " ", "\r", "1\r2"]))
    text = "".join(data.draw(st.lists(st.tuples(cells, ENDS).map("".join), max_size=8)))
    # Without a first column of text the reference needs one that is never wrong.
    lines = text.replace("\r\n", "\n").split("\n")
    expected = reference("\n".join("," + line if line.strip() else line for line in lines), ["t", "a"], ["a"])
    try:
        rows = read("a\n" + text, columns("a"), block_bytes=block_bytes)
    except TableError:
        assert expected is None
        return
    assert expected is not None
    assert rows.numbers[:, 0].tolist() == [values[0] for _, _, values in expected]
    assert rows.lines.tolist() == [line for line, _, _ in expected]


@given(st.binary(max_size=60))
def test_any_bytes_are_read_or_refused(data):
    try:
        rows = read(b"a,t\n" + data, columns("a", text="t"))
    except TableError:
        return
    assert np.isfinite(rows.numbers).all()


@st.composite
def _decimals(draw):
    """Cells as people and programs write them: few digits, as many as a float has, more, or near the middle of two."""
    x = draw(st.floats(1e-6, 1e9) | st.integers(0, 2**64).map(float))
    near = Decimal(x) + (Decimal(math.nextafter(x, math.inf)) - Decimal(x)) / 2
    digits = draw(st.integers(0, 24))
    text = draw(
        st.sampled_from(
            [repr(x), f"{x:.{digits}f}", f"{near:.{digits}f}", f"{x:.{digits}e}", ".5", "5.", "+1.5"]
        )
    )
    return draw(st.sampled_from(["", "-", "00"])) + text if text[0] != "+" else text


@given(
    st.lists(
        _decimals() | st.sampled_from(["", "nan", "-inf", " 1 ", "1.5.2", "-", "1,0", "1e400"]), min_size=1
    )
)
def test_numbers_are_those_of_python(cells):
    def number(cell):
        return float(cell) if cell else math.nan

    text = "x,y,z\n" + "".join(f"7,{cell},8\n" for cell in cells)
    select = columns("y", "z", allow_nan=("y",))
    try:
        expected = [number(cell) for cell in cells]
    except ValueError:
        with pytest.raises(TableError):
            read(text, select)
        return
    found = read(text, select).numbers
    # As texts: -0.0 is not 0.0, and NaN is NaN.
    assert [*map(repr, found[:, 0].tolist())] == [*map(repr, expected)]
    assert (found[:, 1] == 8).all()


def test_threads_share_a_block():
    """Lines of every length, so that parts begin inside them; in each something that only Python reads."""
    rng = np.random.default_rng(4)
    rows = [
        (repr(x), f"{'n' * int(n)}", "1e3" if n == 0 else "" if n == 1 else f"{x:.3f}")
        for x, n in zip(rng.normal(size=40_000).tolist(), rng.integers(0, 60, 40_000), strict=True)
    ]
    text = table("x,t,y", *map(",".join, rows))
    assert len(text) > 2**20
    stream = io.BytesIO(text.encode())
    found = read_table(stream, columns("y", "x", text="t", allow_nan={"y"}), POSES)
    expected = [[float(y or "nan"), float(x)] for x, _, y in rows]
    np.testing.assert_array_equal(found.numbers, expected)
    assert found.text is not None
    assert found.text.tolist() == [t.encode() for _, t, _ in rows]
    assert found.lines.tolist() == list(range(2, 40_002))


@pytest.mark.parametrize("row", [0, 20_000, 39_999])
def test_one_bad_cell_among_many_is_named(row):
    cells = ["0.25,1"] * 40_000
    for bad, message in (
        ("x,1", "holds 'x'"),
        (",1", "is empty"),
        ("1", "1 cell, but"),
        ("1,2,3", "3 cells, but"),
    ):
        text = table("a,b", *cells[:row], bad, *cells[row + 1 :])
        with pytest.raises(TableError, match=f"line {row + 2}: .*{message}"):
            read(text, columns("a"))


@pytest.mark.parametrize(
    ("call", "error"),
    [
        ((b"", 1, [0], [True]), ValueError),
        ((b"1", 1, [0], [True]), ValueError),
        ((b"1\n", 1, [], []), ValueError),
        ((b"1\n", 1, [0], []), ValueError),
        ((b"1\n", 1, [1], [True]), IndexError),
        ((b"1\n", 0, [0], [True]), IndexError),
        ((b"1\n", 1, [0], [True], 1), IndexError),
        ((b"1\n", 1, [-1], [True]), TypeError),
    ],
)
def test_the_kernel_refuses_columns_that_are_not_there(call, error):
    with pytest.raises(error):
        plain_rows(*call)


def test_halfway_between_two_floats():
    """Decimals of 18 digits that are exactly in the middle, or the least that can be on either side of it."""
    middles = [2**53 + odd for odd in range(1, 2_000, 2)]
    cells = [
        f"{10 * whole + step}"[:-1] + f".{(10 * whole + step) % 10}"
        for whole in middles
        for step in (-1, 0, 1)
    ]
    found = read("x\n" + "\n".join(cells) + "\n", columns("x")).numbers[:, 0]
    assert found.tolist() == [float(cell) for cell in cells]


# ---- as laboratories write them ----------------------------------------------------------------------

ROWS = [[0.5 * n, 1.5 + n, -2.25, 3.125, 0.5, -0.25, 0.125] for n in range(400)]


def as_written(
    separator: str = ",", decimal: str = ".", above: str = "", header: str = "", end: str = "\n", **more: Any
) -> str:
    """A table of ROWS; `more`: what each column is multiplied by, and what the first cells are."""
    factors, first = more.get("factors", [1.0] * 7), more.get("first", str)
    lines = []
    for row in ROWS:
        cells = [repr(value * factor) for value, factor in zip(row, factors, strict=True)]
        cells[0] = first(cells[0])
        lines.append(separator.join(cell.replace(".", decimal) for cell in cells))
    return above + header + "".join(end + line for line in lines) + end


LABS = {
    "excel": as_written(";", ",", header="t;fx;fy;fz;mx;my;mz"),
    "excel-sep": as_written(";", ",", "sep=;\n", "t;fx;fy;fz;mx;my;mz", "\r\n"),
    "matlab": as_written("\t", header="Time\tF_x\tF_y\tF_z\tT_x\tT_y\tT_z"),
    "units": as_written(
        header="t [ms],Fx [N],Fy (N),Fz [kN],Mx [Nmm],My (N-mm),Mz [N·m]", factors=[1e3, 1, 1, 1e-3, 1e3, 1e3, 1]
    ),
    "units-below": as_written(
        header="time,fx,fy,fz,mx,my,mz\ns,N,N,N,N·mm,N·mm,N·mm", factors=[1, 1, 1, 1, *[1e3] * 3]
    ),
    "numpy": as_written("  ", header="# t fx fy fz mx my mz"),
    "matlab-quoted": as_written("; ", ",", header='%"t";"fx";"fy";"fz";"mx";"my";"mz"'),
    "classic-mac": as_written("|", header="t|fx|fy|fz|mx|my|mz", end="\r"),
    "din": as_written(
        ";", ",", header="t/ms;Fx/N;Fy/N;F_z, kN;Mx in Nmm;My/(Nmm);Mz_in-lbf",
        factors=[1e3, 1, 1, 1e-3, 1e3, 1e3, 1 / 0.1129848290276167],
    ),
    "plotjuggler": as_written(
        header="__time," + ",".join(f"/ft/wrench/{kind}/{axis}" for kind in ("force", "torque") for axis in "xyz")
    ),
    "labview": as_written(
        "\t", ".", "LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\t\n\nChannels\t6\n",
        "X_Value\tfx\tfy\tfz\tmx\tmy\tmz\tComment",
    ),
    "ati-daq": as_written(
        ",", ".", "Device: a,Serial: b\nForce Units: lbf,Counts per Unit Force: 1000\n"
        "Torque Units: lbf-in,Counts per Unit Torque: 100\n\n", "Time,Fx,Fy,Fz,Tx,Ty,Tz",
        factors=[1, *[1e3 / 4.4482216152605] * 3, *[1e2 / 0.1129848290276167] * 3],
    ),
    "twincat": "Name;Bench\nFile;bench.csv\n\nName;fx;Name;fy;Name;fz;Name;mx;Name;my;Name;mz\n"
    + ";".join(["SampleTime[ms];10"] * 6) + "\n\n"
    + "".join(";".join(f"{1000 * row[0]};{value}" for value in row[1:]).replace(".", ",") + "\n" for row in ROWS),
    "dates": as_written(
        ";", ",", header="Zeit;fx;fy;fz;mx;my;mz",
        first=lambda cell: f"28.11.2026 03:{int(float(cell)) // 60:02}:{float(cell) % 60:06.3f}".replace(".000", ""),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LABS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("block", [64, 2**20])
def test_tables_of_laboratories_are_read(name: str, encoding: str, block: int) -> None:
    with open_table(io.BytesIO(LABS[name].encode(encoding)), lab=True) as (stream, _, _):
        reader = TableReader(stream, "a.csv", Wording("t"), block_bytes=block)
        reader.select(("t", "fx", "fy", "fz", "mx", "my", "mz"))
        blocks = list(reader)
    numbers = np.concatenate([rows.numbers for rows in blocks])
    if name == "dates":
        assert numbers[0, 0] == 1_795_834_800.0
        numbers[:, 0] -= numbers[0, 0]
    np.testing.assert_allclose(numbers, ROWS, rtol=1e-12, atol=1e-6 if name == "dates" else 0)
    assert int(blocks[-1].lines[-1]) == len(LABS[name].splitlines())


@pytest.mark.parametrize(
    ("header", "columns"),
    [
        ("tx,ty,tz,fx,fy,fz", ["mx", "my", "mz", "fx", "fy", "fz"]),
        ("tx,ty,tz,fx,mx,my,mz", ["tx", "ty", "tz", "fx", "mx", "my", "mz"]),
        ("r00,r01,r02,r10,r11,r12,r20,r21,r22", [f"r{row}{column}" for row in "123" for column in "123"]),
        ("R_11,R_12,R_13", ["r11", "r12", "r13"]),
        ("R_x_x,R_x_y,rxz,xx,zy,yy", ["R_x_x", "rxy", "rxz", "xx", "rzy", "ryy"]),
        ("q0,q1,q2,q3", ["q1", "q2", "q3", "q4"]),
        ("quat_1,quat_2,quat_3,quat_4", ["q1", "q2", "q3", "q4"]),
        ("orientation[0],orientation[1],orientation[2],orientation[3]", ["q1", "q2", "q3", "q4"]),
        ("q1,q2,q3,q4,q5,q6", ["j1", "j2", "j3", "j4", "j5", "j6"]),
        ("q1,q2,q3,fx,fy,fz", ["q1", "q2", "q3", "fx", "fy", "fz"]),
        (
            ",Hand,Hand,Hand,Hand\n,Rotation,Rotation,Rotation,Position\nTime,X,Y,W,X",
            ["t", "qx", "qy", "qw", "Position X"],
        ),
        ("fx,Fx,Fy,Fz", ["fx", "Fx", "fy", "fz"]),
        (
            "pose.orientation.w,pose.orientation.x,pose.position.x,q_y,q_z",
            ["qw", "qx", "pose.position.x", "qy", "qz"],
        ),
    ],
)
def test_columns_mean_what_their_names_say(header: str, columns: list[str]) -> None:
    row = ",".join(["0.5"] * len(columns))
    layout = layout_of(f"{header}\n{row}\n{row}\n{row}\n".encode())
    assert layout is not None
    assert list(layout.columns) == columns


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("t;fx [N];fy [blob]\n1;2;3\n", "line 1: column fy is in blob, a unit that is not known"),
        ("t;fx;fy\ns;N;blob\n1;2;3\n", "line 1: column fy is in blob, a unit that is not known"),
        # A column of indices has no name in the header: R writes so.
        ("t;fx;fy\n1;1;2;3\n2;1;2;3\n", "Separate the columns with commas"),
        (" t fx fy\n0 1 2 3\n1 1 2 3\n", "column t missing|columns t, fx, fy missing"),
        ("t,fx,fy\n1,1,2,3\n2,1,2,3\n", "line 2: 4 cells, but the header has 3"),
    ],
)
def test_what_a_header_leaves_open_is_not_guessed(text: str, told: str) -> None:
    with pytest.raises(TableError, match=told):
        read_table(
            io.BytesIO(text.encode()), lambda reader: reader.select(("t", "fx", "fy")), Wording("t"), lab=True
        )


@pytest.mark.parametrize(
    "data", [b"", b"a,b\n", bytes(range(256)) * 99, b"x" * 10**6, b'"\n' * 99, b"1,2,3\n4,5,6\n"]
)
def test_what_is_no_table_goes_through_unchanged(data: bytes) -> None:
    stream = LabTable(io.BytesIO(data))
    assert stream.layout is None
    assert b"".join(iter(lambda: stream.read(1000), b"")) == data


def test_a_table_without_rows_is_not_called_empty() -> None:
    data = io.BytesIO(b"a lab\nt;fx;fy;fz;mx;my;mz\n")
    with pytest.raises(TableError, match="there is a header but no row below it"):
        read_table(data, lambda reader: reader.select(("t",)), Wording("t"), lab=True)


def test_a_plain_table_goes_through_unchanged() -> None:
    data = as_written(header="t,fx,fy,fz,mx,my,mz").encode()
    stream = LabTable(io.BytesIO(data))
    assert stream.layout is not None
    assert stream.layout.plain
    assert b"".join(iter(lambda: stream.read(100), b"")) == data
