"""Whatever bytes a file holds, the answer is a sound probe or a MeshError that names the file."""

import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.mesh_fuzz import fuzz as mesh_fuzz
from benchmarks.mesh_fuzz import large
from benchmarks.mesh_fuzz.cases import FuzzCase, make_case, sound_files
from benchmarks.mesh_fuzz.worker import try_case
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.mesh import MeshError, Probe, load_probe

pytestmark = pytest.mark.filterwarnings("ignore::contactbench.pipeline.mesh.MeshWarning")

NAMES = sorted(sound_files())


def suffix_of(name: str) -> str:
    return Path(name).suffix


def sound(case: FuzzCase, folder: Path) -> str:
    found = try_case(case, folder, "mm")
    assert found["outcome"] in ("valid", "refused"), (case.suffix, case.kind, found["why"], case.data[:200])
    assert found["peak"] < mesh_fuzz.BYTES + mesh_fuzz.BYTES_PER_BYTE * len(case.data)
    return found["outcome"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("fuzz")


@pytest.mark.parametrize("name", NAMES)
def test_the_files_that_are_changed_are_sound(folder, name):
    assert sound(FuzzCase(suffix_of(name), "none", sound_files()[name]), folder) == "valid"
    probe = load_probe(folder / f"case{suffix_of(name)}", "mm")
    assert (len(probe.faces), probe.health.sentences) == (48, ())


def test_a_series_of_changed_files(folder):
    outcomes = [sound(make_case(1, number), folder) for number in range(120)]
    assert outcomes.count("valid") > 4
    assert outcomes.count("refused") > 60


def test_a_case_is_its_number():
    assert make_case(3, 7) == make_case(3, 7)
    assert len({make_case(3, number).data for number in range(50)}) > 40


@pytest.mark.parametrize("name", NAMES)
def test_large_files_whose_counts_are_right(folder, name, monkeypatch):
    monkeypatch.setattr(large, "_USUAL", 250_000)  # read by the same code as ten times as much

    class Small:
        """Draws the smallest size, and every form in turn."""

        def __init__(self, form: int) -> None:
            self._form = form

        def randrange(self, low: int, high: int | None = None) -> int:
            return low if high is not None else self._form % low

        def random(self) -> float:
            return self._form / 5

        def randbytes(self, count: int) -> bytes:
            return bytes(range(count))

    kinds = set()
    for form in range(5):
        kind, data = large.swollen(name, Small(form))
        kinds.add(kind)
        sound(FuzzCase(suffix_of(name), kind, data), folder)
    assert kinds


@settings(max_examples=60, derandomize=True, deadline=None)
@given(name=st.sampled_from(NAMES), share=st.floats(0, 1))
def test_truncated_anywhere(folder, name, share):
    data = sound_files()[name]
    sound(FuzzCase(suffix_of(name), "cut", data[: int(share * len(data))]), folder)


@settings(max_examples=60, derandomize=True, deadline=None)
@given(name=st.sampled_from(NAMES), data=st.binary(max_size=300))
def test_random_bytes(folder, name, data):
    sound(FuzzCase(suffix_of(name), "random", data), folder)


# ---------------------------------------------------------------- the run in child processes


def test_run_in_children():
    told: list[tuple[int, int]] = []
    report = mesh_fuzz.run(30, 5, lambda done, count: told.append((done, count)))
    assert report.passed
    assert report.figures[0].measured == 30
    assert told == [(done, 30) for done in range(1, 31)]


WORKER = """
import json, os, sys, time
seed, first, last = map(int, sys.argv[1:])
for n in range(first, last):
    print(json.dumps({"begins": n, "suffix": ".stl", "kind": "test", "bytes": 1000}), flush=True)
    if n == 2:
        sys.stderr.write("a terrible thing\\n")
        sys.stderr.flush()
        os.abort()
    if n == 4:
        time.sleep(60)
    bad = {5: ("wrong", 0.1, 1), 6: ("valid", 9.0, 1), 7: ("refused", 0.1, 1e9)}
    outcome, seconds, peak = bad.get(n, ("valid", 0.1, 1))
    print(json.dumps({"outcome": outcome, "why": "TypeError: x", "seconds": seconds, "peak": peak}), flush=True)
"""


def test_what_breaks_is_laid_to_its_file_and_the_rest_goes_on(monkeypatch):
    monkeypatch.setattr("benchmarks.mesh_fuzz.fuzz._WORKER", (sys.executable, "-c", WORKER))
    monkeypatch.setattr("benchmarks.mesh_fuzz.fuzz._HANGS_S", 1.5)
    report = mesh_fuzz.run(10)
    assert not report.passed
    died, hung, wrong, slow, hungry = report.notes[1:]
    assert died.startswith("Case 2 (.stl, test): ")
    assert "the process died, exit code" in died
    assert "a terrible thing" in died
    assert "it hangs" in hung
    assert wrong == "Case 5 (.stl, test): TypeError: x."
    assert "it took 9.0 s for 1000 bytes" in slow
    assert "1000 MB of memory" in hungry
    assert [figure.measured for figure in report.figures[:2]] == [5, 5]


@settings(max_examples=100, derandomize=True, deadline=None)
@given(
    vertices=st.lists(
        st.lists(st.one_of(st.floats(), st.integers(-2, 2)), min_size=3, max_size=3), min_size=1, max_size=8
    ),
    faces=st.lists(st.lists(st.integers(-1, 8), min_size=3, max_size=3), max_size=8),
)
def test_arrays(vertices, faces):
    try:
        probe = Probe.from_arrays(vertices, faces, check_size=False)
    except MeshError:
        return
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)
    assert probe.size > 0
