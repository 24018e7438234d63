"""A mesh that was prepared before is not prepared again; whatever is wrong with what was kept costs only the work."""

import copy
import hashlib
import json
import os
import struct
from collections import OrderedDict

import numpy as np
import pytest

from contactbench.assets import make
from contactbench.pipeline.mesh import Probe, save_probe
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.regions.transfer import RegionReport
from contactbench.pipeline.mesh.shell import Shell
from contactbench.pipeline.mesh.sidecar import ProbeFile, encode_probe_file
from contactbench.pipeline.mesh.simplify import Simplified
from contactbench.pipeline.preparation import cache, prepare
from contactbench.pipeline.preparation.cache import VARIABLE, EntryError, decode, encode, made_once
from contactbench.pipeline.settings import ProbeSettings

START = 20 + 32  # magic and hash
KINDS = (ProbeFile, Shell, Simplified, tuple[RegionReport, ...])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Give a cache of one's own."""
    place = tmp_path / "kept"
    monkeypatch.setenv(VARIABLE, str(place))
    return place


@pytest.fixture
def mesh(tmp_path):
    """Write a mesh that is closed as it is."""
    file = tmp_path / "mesh.ply"
    save_probe(Probe.from_arrays(*make("linear", 600), name="linear"), file)
    return file


@pytest.fixture
def works(monkeypatch):
    """Count the outer surfaces that are made, without those that this process remembers."""
    made = []

    def counted(*arguments, **control):
        made.append(arguments)
        return whole(*arguments, **control)

    whole = prepare.shell_step
    monkeypatch.setattr(prepare, "shell_step", counted)
    monkeypatch.setattr(cache, "_MOST_HELD", 0)
    return made


def prepared(mesh, **settings):
    done = prepare.prepared({"mesh": mesh}, ProbeSettings(**{"facets": 300, **settings}), remember=True)
    return encode_probe_file(done.content, "probe.ply"), done.to_json(), done.sentences


def test_the_same_comes_from_the_cache_to_the_byte(mesh, folder, works, monkeypatch):
    first = prepared(mesh)
    assert prepared(mesh) == first
    assert len(works) == 1
    monkeypatch.setenv(VARIABLE, "off")
    assert prepared(mesh) == first
    assert len(works) == 2
    assert len([*folder.iterdir()]) == 2  # the outer surface, and the probe
    monkeypatch.setenv(VARIABLE, str(folder))
    prepared(mesh, facets=200)  # needs no other outer surface
    assert len(works) == 2
    assert len([*folder.iterdir()]) == 3


@pytest.mark.parametrize("settings", [{"gap": 3.0}, {"alpha": 2.0}, {"close": ("hull",)}, {"units": "m"}])
def test_settings_have_a_say(mesh, settings):
    assert prepare._key(mesh, ProbeSettings(**settings)) != prepare._key(mesh, ProbeSettings())


def test_a_mesh_its_name_and_what_is_beside_it_have_a_say(mesh):
    said = [prepare._key(mesh, ProbeSettings())]
    mesh.with_suffix(".json").write_text("{}", encoding="utf-8")
    said.append(prepare._key(mesh, ProbeSettings()))
    mesh.write_bytes(mesh.read_bytes() + b" ")
    said.append(prepare._key(mesh, ProbeSettings()))
    said.append(prepare._key(mesh.rename(mesh.with_name("other.ply")), ProbeSettings()))
    assert len(set(said)) == 4


def test_versions_have_a_say(folder, monkeypatch):
    assert made_once(lambda: "it", lambda: (1,), (int,)) == (1,)
    monkeypatch.setattr(cache, "_versions", lambda: {"contactbench": "9.9"})
    assert made_once(lambda: "it", lambda: (2,), (int,)) == (2,)
    assert len([*folder.iterdir()]) == 2


def test_all_classes_come_back_as_they_were(mesh):
    done = prepare.prepared({"mesh": mesh}, ProbeSettings(facets=300))
    values = (done.content, done.shell, done.simplified, done.carried)
    data = encode("k", values)
    assert data == encode("k", values)
    again = decode(data, "k", KINDS)
    assert encode("k", again) == data
    assert values[0].probe.faces is values[2].probe.faces
    assert again[0].probe.faces is again[2].probe.faces  # one array stays one
    assert not again[0].probe.vertices.flags.writeable


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[:0],
        lambda data: data[: len(data) // 2],
        lambda data: data + b"x",
        lambda data: data[:-1] + bytes([data[-1] ^ 1]),
        lambda data: data[: START + 9] + bytes([data[START + 9] ^ 1]) + data[START + 10 :],
        lambda data: b"another " + data,
    ],
)
def test_a_damaged_entry_is_made_again(folder, damage):
    values = (np.arange(5.0),)
    calls = []

    def work():
        calls.append(1)
        return values

    made_once(lambda: "it", work, (np.ndarray,))
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    np.testing.assert_array_equal(made_once(lambda: "it", work, (np.ndarray,))[0], values[0])
    assert len(calls) == 2
    assert file.read_bytes() == whole
    made_once(lambda: "it", work, (np.ndarray,))
    assert len(calls) == 2


def test_an_entry_under_another_name_is_not_believed(folder):
    made_once(lambda: "a", lambda: (1,), (int,))
    (first,) = folder.iterdir()
    made_once(lambda: "b", lambda: (2,), (int,))
    (second,) = {*folder.iterdir()} - {first}
    second.write_bytes(first.read_bytes())
    assert made_once(lambda: "b", lambda: (2,), (int,)) == (2,)


def _hashed(values, *arrays, data=b"", **other):
    text = json.dumps({"kind": "k", "fields": {"values": values}, "arrays": arrays} | other).encode()
    body = b"MESH" + struct.pack("<I", len(text)) + text + data
    return b"contactbench kept 3\n" + hashlib.sha256(body).digest() + body


HEALTH = {"class": "MeshHealth", "fields": [True, True, True, 1, 0, 0, 0, 0]}
FIRST = {"array": "0", "writable": True}


@pytest.mark.parametrize(
    "entry",
    [
        _hashed([1], fields=[]),
        _hashed([]),
        _hashed([1], kind="other"),
        _hashed([1], data=b"1"),
        _hashed([{"class": "Path", "fields": ["/"]}]),
        _hashed([{"class": "MeshHealth", "fields": [True]}]),
        _hashed([{"again": 0}]),
        _hashed([FIRST | {"array": "-1"}], ["0", "<f8", [0]]),
        _hashed([FIRST], ["0", "<f8", [2**30, 2**30]]),
        _hashed([FIRST], ["0", "<f8", [-1]]),
        _hashed([FIRST], ["0", "|O", [1]]),
        _hashed([{"closing": "nonsense"}]),
        _hashed([{"map": [[[], 1]]}]),
    ],
)
def test_what_is_hashed_rightly_is_not_believed_for_that(entry):
    with pytest.raises(EntryError):
        decode(entry, "k", (object,))


def test_a_mesh_whose_facets_point_beyond_it_is_refused():
    arrays = [["0", "<f8", [3, 3]], ["1", "<i4", [1, 3]], ["2", "<i4", [1]], ["3", "|b1", [1]]]
    parts = [*({"array": str(number), "writable": False} for number in range(4)), "p", HEALTH, {"tuple": []}]
    data = bytes(72) + np.array([[0, 1, 7]], dtype="<i4").tobytes() + bytes(5)
    with pytest.raises(EntryError) as refused:
        decode(_hashed([{"class": "Probe", "fields": parts}], *arrays, data=data), "k", (Probe,))
    assert "faces" in str(refused.value.__cause__)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Prepare a mesh with a hole and a region: all classes occur."""
    vertices, faces = make("linear", 600)
    middles = vertices[faces].mean(axis=1)
    kept = np.linalg.norm(middles - middles[100], axis=1) > 0.008
    regions = (middles[:, 2] > np.median(middles[:, 2])).astype(np.int32)
    file = tmp_path_factory.mktemp("whole") / "mesh.ply"
    save_probe(Probe.from_arrays(vertices, faces[kept], regions[kept], name="linear"), file)
    done = prepare.prepared({"mesh": file}, ProbeSettings(facets=300))
    assert len(done.carried) == 1
    assert len(done.shell.openings) == 1
    return done.content, done.shell, done.simplified, done.carried


def _put(values, place, value):
    """Return copies of values in which what is at a place, written with dots, is another."""
    first, _, rest = place.partition(".")
    if isinstance(values, tuple):
        number = int(first)
        made = _put(values[number], rest, value) if rest else value(values[number])
        return (*values[:number], made, *values[number + 1 :])
    made = copy.copy(values)
    old = getattr(values, first)
    object.__setattr__(made, first, _put(old, rest, value) if rest else value(old))
    return made


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("0.probe.health.components", str),
        ("0.probe.region", lambda old: old.astype(np.int64)),
        ("0.probe.invented", lambda old: old[1:]),
        ("0.probe.vertices", lambda old: np.full_like(old, np.nan)),
        ("0.regions", lambda old: RegionSet(old.regions, old.labels[1:])),
        ("0.frame", lambda _: "Q"),
        ("0.notes", lambda _: (1,)),
        ("0.history", lambda _: ({1: 2},)),
        ("1.how", lambda _: None),
        ("1.gap", lambda _: np.inf),
        ("1.dropped", lambda _: 1.5),
        ("1.openings.0.opening.rim", lambda old: old[:, :2]),
        ("1.openings.0.opening.centre", lambda old: old * np.nan),
        ("1.openings.0.closing", lambda _: "fair"),
        ("1.soundness.pinched_vertices", lambda _: np.array([10**6])),
        ("2.deviation.rms", lambda _: np.nan),
        ("2.deviation.samples", lambda _: True),
        ("2.regions", lambda old: {str(rank): each for rank, each in old.items()}),
        ("2.soundness.flat_facets", lambda _: np.array([-1])),
        ("2.soundness.pairs", lambda _: np.zeros((1, 2), np.int32)),
        ("2.soundness.normal_deviation_deg", lambda old: old[1:]),
        ("2.soundness.nested_facets", lambda _: np.zeros((1, 1), np.int64)),
        ("3", lambda old: (*old, "no report")),
    ],
)
def test_fields_that_cannot_be_are_not_believed(whole, place, value):
    decode(encode("k", whole), "k", KINDS)
    with pytest.raises(EntryError):
        decode(encode("k", _put(whole, place, value)), "k", KINDS)


def _foreign(path, monkeypatch):
    """Let something belong to another user."""
    monkeypatch.setattr(os, "getuid", lambda: 4321)
    if path.stat().st_uid == 0:  # what is the system's is believed
        os.chown(path, 1234, -1)


@pytest.mark.skipif(os.name != "posix", reason="this system does not say who can write")
@pytest.mark.parametrize("mode", [0o720, 0o702])
def test_a_folder_that_others_can_write_is_not_believed(folder, mode):
    made_once(lambda: "it", lambda: (1,), (int,))
    folder.chmod(mode)
    for answer in (2, 3):
        with pytest.warns(UserWarning, match=rf"^{folder}: .* others can write it: chmod go-w '{folder}'\.$"):
            assert made_once(lambda: "it", lambda answer=answer: (answer,), (int,)) == (answer,)
    folder.chmod(0o755)
    assert made_once(lambda: "it", lambda: (2,), (int,)) == (1,)


@pytest.mark.skipif(os.name != "posix", reason="this system does not say who can write")
def test_what_another_user_put_there_is_not_believed(folder, monkeypatch):
    made_once(lambda: "it", lambda: (1,), (int,))
    monkeypatch.setattr(cache, "_folder", lambda: folder)
    _foreign(next(folder.iterdir()), monkeypatch)
    assert made_once(lambda: "it", lambda: (2,), (int,)) == (2,)


@pytest.mark.skipif(os.name != "posix", reason="this system does not say who can write")
def test_another_users_folder_is_not_believed(folder, monkeypatch):
    made_once(lambda: "it", lambda: (1,), (int,))
    _foreign(folder, monkeypatch)
    with pytest.warns(UserWarning, match=f"name a folder of your own in {VARIABLE}"):
        assert made_once(lambda: "it", lambda: (2,), (int,)) == (2,)


def test_what_a_killed_writer_left_goes_and_what_is_being_written_stays(folder):
    made_once(lambda: "it", lambda: (1,), (int,))
    left, fresh = (folder / f".{name}.kept.{16 * '0'}.tmp" for name in "ab")
    for each in (left, fresh):
        each.write_bytes(b"x")
    os.utime(left, (0, 0))
    made_once(lambda: "other", lambda: (1,), (int,))
    assert not left.exists()
    assert fresh.exists()


def test_a_process_holds_some_without_a_folder(monkeypatch):
    monkeypatch.setenv(VARIABLE, "off")
    monkeypatch.setattr(cache, "_held", OrderedDict())
    values = {name: made_once(lambda n=name: n, lambda: (object(),), (object,), held=True) for name in "abc"}
    for name, same in (("b", True), ("c", True), ("a", False)):
        again = made_once(lambda n=name: n, lambda: (object(),), (object,), held=True)
        assert (again is values[name]) == same


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_in_an_entrys_place_is_not_waited_for(folder):
    assert made_once(lambda: "given", lambda: (1,), (int,)) == (1,)
    (entry,) = folder.iterdir()
    entry.unlink()
    os.mkfifo(entry)
    assert made_once(lambda: "given", lambda: (2,), (int,)) == (2,)


def test_a_file_that_cannot_be_read_costs_only_the_cache(folder):
    def given():
        raise PermissionError(13, "denied", "mesh.json")

    assert made_once(given, lambda: (1,), (int,)) == (1,)
    asked = iter(["given"])
    assert made_once(lambda: next(asked, None) or given(), lambda: (2,), (int,)) == (2,)
    assert not folder.exists()


@pytest.mark.usefixtures("folder")
def test_a_mesh_is_prepared_beside_a_file_that_cannot_be_read(mesh, monkeypatch):
    whole = prepare._key

    def refused(*_):
        raise PermissionError(13, "denied", "mesh.json")

    monkeypatch.setattr(prepare, "_key", refused)
    unkept = prepared(mesh)
    monkeypatch.setattr(prepare, "_key", whole)
    assert prepared(mesh) == unkept


@pytest.mark.parametrize("said", ["off", "OFF"])
def test_nothing_is_kept_where_it_is_off(tmp_path, monkeypatch, said):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(VARIABLE, said)
    assert made_once(lambda: "given", lambda: (1,), (int,)) == (1,)
    assert not [*tmp_path.iterdir()]


def test_what_changed_meanwhile_is_not_kept(folder):
    said = iter(["before", "after"])
    assert made_once(lambda: next(said), lambda: (1,), (int,)) == (1,)
    assert not folder.exists()


def test_the_cache_is_bounded_and_drops_what_was_used_longest_ago(folder, monkeypatch):
    entry = len(encode("0" * 64, (np.zeros(1000),)))
    monkeypatch.setattr(cache, "_MOST_BYTES", 3 * entry + 100)

    def ask(name):
        made_once(lambda: name, lambda: (np.zeros(1000),), (np.ndarray,))
        newest = max(folder.iterdir(), key=lambda file: file.stat().st_mtime_ns)
        # As if a while passed between one and the next, whatever the file system's clock.
        for file in folder.iterdir():
            if file != newest:
                cache.os.utime(file, ns=(0, file.stat().st_mtime_ns - 10**9))
        return newest

    first, second, third = map(ask, "abc")
    assert ask("a") == first  # used again: now the second is the oldest
    ask("d")
    assert first.exists()
    assert not second.exists()
    assert third.exists()


def test_a_folder_that_cannot_be_written_costs_only_the_work(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv(VARIABLE, str(tmp_path / "file" / "kept"))
    assert made_once(lambda: "it", lambda: (1,), (int,)) == (1,)
