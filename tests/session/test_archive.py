"""Archives: there and back, and those that want to write elsewhere."""

import io
import stat
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from contactbench.pipeline.commands.session import session_app
from contactbench.pipeline.session import ArchiveError, Session, SessionError
from contactbench.pipeline.session.archive import ArchiveLimits, export_archive, import_archive
from contactbench.pipeline.session.check import check, check_journal


@pytest.fixture
def folder(tmp_path):
    with Session.create(tmp_path / "s", by="a") as session:
        session.add_input(b"solid" * 100, "mesh", name="m.stl")
        session.add_result("test", "r", {"r": b"1"}, {"mesh": session.state.mesh.file.sha256}, {})
    return tmp_path / "s"


@pytest.fixture
def archive(folder, tmp_path):
    export_archive(folder, tmp_path / "s.zip")
    return tmp_path / "s.zip"


def test_there_and_back(folder, archive, tmp_path):
    (folder / "raw" / "orphan").write_bytes(b"stays at home")
    import_archive(archive, tmp_path / "back")
    assert check(tmp_path / "back").notes == ()
    with Session.open(tmp_path / "back") as back, Session.open(folder) as session:
        assert back.state == session.state
        back.note("goes on")
    export_archive(folder, tmp_path / "again.zip")
    assert (tmp_path / "again.zip").read_bytes() == archive.read_bytes()


def test_it_is_packed_while_it_is_written_but_not_into_itself(folder, tmp_path):
    with Session.open(folder) as session:
        session.note("open")
        assert export_archive(folder, tmp_path / "x.zip").files == 3
    with pytest.raises(SessionError, match="inside the session"):
        export_archive(folder, folder / "x.zip")


def test_a_session_that_lost_a_file_is_not_packed(folder, tmp_path):
    next((folder / "meshes").iterdir()).unlink()
    with pytest.raises(SessionError, match="is missing"):
        export_archive(folder, tmp_path / "x.zip")
    assert not (tmp_path / "x.zip").exists()


def members(archive):
    with zipfile.ZipFile(archive) as packed:
        return {name: packed.read(name) for name in packed.namelist()}


def refused(tmp_path, content, said, limits=None):
    outside = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    file = tmp_path / "evil.zip"
    file.write_bytes(content)
    with pytest.raises(ArchiveError, match=said):
        import_archive(file, tmp_path / "in" / "out", limits)
    file.unlink()
    assert list((tmp_path / "in").iterdir()) == []
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == outside


@pytest.fixture
def inside(tmp_path):
    (tmp_path / "in").mkdir()


def packed_with(archive, name, data=b"evil", mode=stat.S_IFREG | 0o644, method=zipfile.ZIP_STORED):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as packed:
        for known, content in members(archive).items():
            packed.writestr(known, content)
        info = zipfile.ZipInfo(name)
        info.external_attr, info.create_system, info.compress_type = mode << 16, 3, method
        packed.writestr(info, data)
    return stream.getvalue()


@pytest.mark.parametrize(
    "name",
    [
        "../evil",
        "../../evil",
        "raw/../../evil",
        "/etc/evil",
        "raw/000000000000-x/../../../evil",
        "C:\\evil",
        "raw\\000000000000-x",
        "\\\\host\\evil",
        "evil",
        "lock",
        "raw/.hidden",
        "raw/000000000000-x:stream",
        "JOURNAL",
        "journal/",
        "raw/000000000000-x/",
    ],
)
@pytest.mark.usefixtures("inside")
def test_names_of_no_session_are_refused(tmp_path, archive, name):
    refused(tmp_path, packed_with(archive, name), "not a name that a session uses")


@pytest.mark.usefixtures("inside")
def test_links_bombs_doubles_and_strangers_are_refused(tmp_path, archive):
    name = "raw/000000000000-x"
    refused(tmp_path, packed_with(archive, name, b"/etc/passwd", stat.S_IFLNK | 0o777), "a link")
    bomb = packed_with(archive, name, bytes(4 * 2**20), method=zipfile.ZIP_DEFLATED)
    refused(tmp_path, bomb, "times its packed size")
    refused(tmp_path, packed_with(archive, name), "belongs to no record")
    refused(tmp_path, packed_with(archive, name, b"x" * 100), "larger than", ArchiveLimits(size=50))
    refused(tmp_path, packed_with(archive, name), "files, more than 3", ArchiveLimits(members=3))
    refused(tmp_path, packed_with(archive, name, method=zipfile.ZIP_LZMA), "unusual")
    with pytest.warns(UserWarning, match="Duplicate"):
        double = packed_with(archive, "journal")
    refused(tmp_path, double, "twice")
    refused(tmp_path, b"no zip", "not an intact zip")


@pytest.mark.usefixtures("inside")
def test_sizes_that_lie_and_changed_files_are_refused(tmp_path, archive):
    data = packed_with(archive, "raw/000000000000-x", b"x" * 500, method=zipfile.ZIP_DEFLATED)
    lying = data.replace((500).to_bytes(4, "little"), (5).to_bytes(4, "little"))
    refused(tmp_path, lying, "intact zip|larger than the archive says|belongs to no record")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as packed:
        for name, content in members(archive).items():
            packed.writestr(
                name, content.replace(b"solid", b"s0lid") if name.startswith("meshes") else content
            )
    refused(tmp_path, stream.getvalue(), "does not match the journal")


def test_an_existing_place_is_left_alone(archive, folder):
    with pytest.raises(SessionError, match="already exists"):
        import_archive(archive, folder)
    assert check(folder).sound


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.data())
def test_flipped_bytes_give_a_whole_session_or_none(tmp_path_factory, data):
    base = tmp_path_factory.getbasetemp() / "flips"
    if not base.exists():
        base.mkdir()
        with Session.create(base / "s", by="a") as session:
            session.add_input(b"solid" * 20, "mesh", name="m.stl")
        export_archive(base / "s", base / "s.zip")
    content = bytearray((base / "s.zip").read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    work = tmp_path_factory.mktemp("flip")
    (work / "x.zip").write_bytes(content)
    try:
        import_archive(work / "x.zip", work / "out")
    except SessionError:
        assert [each.name for each in work.iterdir()] == ["x.zip"]
    else:
        assert check(work / "out").sound


# ---- what export writes, import takes ----------------------------------------------------------


def packed(session, out):
    done = export_archive(session, out)
    import_archive(out, out.with_suffix(""))
    assert check(out.with_suffix("")).sound
    return done


def test_files_that_shrink_like_bombs_come_back(folder, tmp_path):
    (tmp_path / "zeros.bin").write_bytes(bytes(3 * 2**20))
    # Shrinks 150 times: a zlib that packs better may come to 200, where it would be refused.
    (tmp_path / "between.bin").write_bytes(np.random.default_rng(1).bytes(18_000) + bytes(3 * 2**20))
    (tmp_path / "text.csv").write_text(
        "".join(f"{n * 7919 % 100_003}\n" for n in range(200_000)), encoding="utf-8"
    )
    with Session.open(folder) as session:
        for name in ("zeros.bin", "between.bin", "text.csv"):
            session.add_input(tmp_path / name, "raw")
    packed(folder, tmp_path / "x.zip")
    with zipfile.ZipFile(tmp_path / "x.zip") as archive:
        methods = {info.filename.split("-")[-1]: info.compress_type for info in archive.infolist()}
    assert methods["zeros.bin"] == methods["between.bin"] == zipfile.ZIP_STORED
    assert methods["text.csv"] == zipfile.ZIP_DEFLATED


def test_names_that_differ_in_case_only_come_back(folder, tmp_path, monkeypatch):
    (tmp_path / "one.csv").write_bytes(b"x")
    with Session.open(folder) as session:
        for name in ("A.csv", "a.csv"):
            session.add_input(tmp_path / "one.csv", "poses", name=name)
    assert len(list((folder / "raw").iterdir())) == 1
    packed(folder, tmp_path / "x.zip")
    # As sessions were written before.
    monkeypatch.setattr("contactbench.pipeline.session.files._plain", lambda name: name)
    with Session.open(folder) as session:
        session.add_input(tmp_path / "one.csv", "poses", name="A.csv")
    packed(folder, tmp_path / "y.zip")


def test_what_would_be_too_large_is_not_packed(folder, tmp_path):
    for limits in (ArchiveLimits(members=2), ArchiveLimits(size=100)):
        with pytest.raises(SessionError, match="an archive holds at most"):
            export_archive(folder, tmp_path / "x.zip", limits)
    assert not (tmp_path / "x.zip").exists()


def test_what_is_added_meanwhile_is_not_in_it(folder, tmp_path, monkeypatch):
    with Session.open(folder) as session:

        def later(*arguments):
            found = check_journal(*arguments)
            if len(session.records) == 3:
                session.add_input(b"late", "mesh", name="late.stl")
            return found

        monkeypatch.setattr("contactbench.pipeline.session.archive.check_journal", later)
        assert export_archive(folder, tmp_path / "x.zip").files == 3
        monkeypatch.undo()
    import_archive(tmp_path / "x.zip", tmp_path / "x")
    with Session.open(tmp_path / "x", write=False) as back:
        assert len(back.records) == 3


def test_a_recording_that_is_not_adopted_is_never_left_out_silently(folder, tmp_path):
    (folder / "raw" / "unfinished-a.mcap").write_bytes(b"samples")
    with pytest.raises(SessionError, match="session repair"):
        export_archive(folder, tmp_path / "x.zip")
    with Session.open(folder):  # somebody records
        assert export_archive(folder, tmp_path / "x.zip").left_out == ("raw/unfinished-a.mcap",)
        result = CliRunner().invoke(
            session_app, ["export-archive", str(folder), "--out", str(tmp_path / "y.zip")]
        )
    assert result.exit_code == 1
    assert "in progress" in result.output
    assert (tmp_path / "y.zip").exists()


def test_the_notes_of_a_check_come_with_it(folder, tmp_path):
    (folder / "raw" / "orphan").write_bytes(b"x")
    assert "belong to no record" in export_archive(folder, tmp_path / "x.zip").notes[0]


def test_nothing_but_an_archive_is_written_over(folder, tmp_path):
    journal = (folder / "journal").read_bytes()
    (tmp_path / "sub").mkdir()
    (tmp_path / "link").symlink_to(folder)
    (tmp_path / "to-journal").symlink_to(folder / "journal")
    for out in (
        tmp_path / "sub" / ".." / "s" / "journal",
        tmp_path / "link" / "x.zip",
        tmp_path / "to-journal",
    ):
        with pytest.raises(SessionError, match="inside the session"):
            export_archive(folder, out)
    assert (folder / "journal").read_bytes() == journal
    (tmp_path / "letter.txt").write_text("dear", encoding="utf-8")
    with pytest.raises(SessionError, match="not an archive"):
        export_archive(folder, tmp_path / "letter.txt")
    assert (tmp_path / "letter.txt").read_text(encoding="utf-8") == "dear"
    for _ in range(2):
        export_archive(folder, tmp_path / "x.zip")
