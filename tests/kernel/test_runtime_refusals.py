"""What the C library refuses although every hash fits: files and figures that contradict each other."""

import json
import shutil
import struct
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from config.runtime.bundles import example, example_bundle, of_version_2
from kernel.test_runtime_library import Library, edited, put
from native import CMAKE, SOURCE, cmake, installed, needs_cmake, run

from contactbench.pipeline.config.runtime.pack import KNOWN
from contactbench.pipeline.config.runtime.swap import put_aside, write_folder
from contactbench.pipeline.config.runtime.values import low_pass_sections

pytestmark = needs_cmake


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return Library(installed(tmp_path_factory.mktemp("installed")))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    example_bundle(tmp_path / "bundle", 300)
    return tmp_path / "bundle"


def refusal(library: Library, folder: Path) -> tuple[int, str]:
    handle, error = library.open(folder)
    if handle:
        library.c.cb_close(handle)
    return error.code, error.message.decode()


def content(folder: Path) -> Any:
    return json.loads((folder / "contactbench.json").read_text(encoding="utf-8"))


def test_an_exported_bundle_is_taken(library: Library, folder: Path) -> None:
    assert refusal(library, folder) == (0, "")


def test_sections_that_turn_the_point_over_are_refused(library: Library, folder: Path) -> None:
    sections = np.array(content(folder)["filters"]["location"]["sections"])
    sections[0, :3] *= -1
    edited(folder, "filters.location.sections", sections.tolist())
    assert "filters.location.sections" in refusal(library, folder)[1]


@pytest.mark.parametrize("order", range(1, 9))
def test_every_butterworth_filter_is_known(library: Library, folder: Path, order: int) -> None:
    edited(folder, "verified", False)  # filters of other rates than the sensor's
    for cutoff, rate in ((2e-6, 1.0), (0.5, 1e3), (20.0, 1e3), (240.0, 1e3), (260.0, 1e3), (499.0, 1e3)):
        sections = low_pass_sections(cutoff, rate, order)
        part = {"kind": "lowpass", "rate_Hz": rate, "cutoff_Hz": cutoff, "order": order}
        edited(folder, "filters.location", {**part, "sections": sections.tolist()})
        assert refusal(library, folder) == (0, ""), (cutoff, order)
        sections[-1, 4] += 1e-9
        edited(folder, "filters.location", {**part, "sections": sections.tolist()})
        assert refusal(library, folder)[0] == 6, (cutoff, order)


def test_gravity_that_points_up_by_more_than_two_sigma_is_refused(library: Library, folder: Path) -> None:
    sigma = content(folder)["gravity"]["covariance"][2][2] ** 0.5
    edited(folder, "gravity.gravity_W_N", [0.0, 0.0, 1.9 * sigma])
    assert "points up" not in refusal(library, folder)[1]
    edited(folder, "gravity.gravity_W_N", [0.0, 0.0, 2.1 * sigma])
    assert "points up" in refusal(library, folder)[1]


def test_a_correlation_just_beyond_one_is_refused(library: Library, folder: Path) -> None:
    C = np.array(content(folder)["gravity"]["covariance"])
    C[0, 1] = C[1, 0] = (1 + 5e-9) * np.sqrt(C[0, 0] * C[1, 1])
    edited(folder, "gravity.covariance", C.tolist())
    assert "correlation" in refusal(library, folder)[1]


@pytest.mark.parametrize(
    ("odds", "untouchable", "code", "says"),
    [
        (0.0, False, 6, "regions[0].odds"),
        (0.5, False, 6, "regions[0].odds"),
        (1000.0, True, 6, "regions[0].odds"),
        (0.001, True, 8, "untouchable regions"),  # the mesh does not say so
        (1000.0, 1, 4, "regions[0].untouchable"),
    ],
)
def test_odds_that_the_region_denies_are_refused(
    library: Library, folder: Path, odds: float, untouchable: Any, code: int, says: str
) -> None:
    (region,) = content(folder)["regions"]
    edited(folder, "regions", [{**region, "odds": odds, "untouchable": untouchable}])
    found, message = refusal(library, folder)
    assert found == code
    assert says in message


def test_an_untouchable_region_that_only_the_mesh_has_is_refused(library: Library, tmp_path: Path) -> None:
    example_bundle(tmp_path, 300, clamped=True)
    assert refusal(library, tmp_path) == (0, "")
    mesh = (tmp_path / "probe.ply").read_bytes()
    line = b"comment untouchable regions 2\n"
    for change in (b"", line + line, line.replace(b"2", b"1")):
        put(tmp_path, "probe.ply", mesh.replace(line, change))
        code, message = refusal(library, tmp_path)
        assert code == 8
        assert "untouchable regions" in message


OLD_GATES = json.loads(of_version_2(example(300).encoded())["contactbench.json"])["gates"]


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        (
            {"gates": {name: value for name, value in OLD_GATES.items() if name != "rival_sigmas"}},
            "gates.rival_sigmas",
        ),
        ({"gates": {**OLD_GATES, "rival_odds": 100.0}}, "gates.rival_odds"),
        ({"gates": []}, "gates"),
        ({"touch": {}}, "touch"),
        ({"regions": example(300).model.to_json()["regions"]}, "regions[0]"),
        ({"regions": 3}, "regions"),
    ],
)
def test_what_version_2_never_was_is_refused(
    library: Library, tmp_path: Path, changes: dict[str, Any], says: str
) -> None:
    for name, data in of_version_2(example(300).encoded(), **changes).items():
        (tmp_path / name).write_bytes(data)
    code, message = refusal(library, tmp_path)
    assert code == 4
    assert message.startswith(f"contactbench.json: {says}")


def test_a_facet_without_area_is_refused(library: Library, folder: Path) -> None:
    mesh, places = bytearray((folder / "probe.ply").read_bytes()), content(folder)["probe"]
    begin = mesh.index(b"end_header\n") + 11
    points = np.frombuffer(bytes(mesh), "<f8", 3 * places["vertices"], begin).reshape(-1, 3)
    inside = ((points > points.min(axis=0)) & (points < points.max(axis=0))).all(axis=1)
    faces = [struct.unpack_from("<3i", mesh, at + 1) for at in range(begin + points.nbytes, len(mesh), 21)]
    one, two, moved = next(face for face in faces if inside[face[2]])  # so that the bounds stay
    mesh[begin + 24 * moved : begin + 24 * moved + 24] = points[[one, two]].mean(axis=0).tobytes()
    put(folder, "probe.ply", bytes(mesh))
    assert "has no area" in refusal(library, folder)[1]


def test_planes_are_counted(library: Library, folder: Path) -> None:
    edited(folder, "planes.count", 299)
    assert "planes.count" in refusal(library, folder)[1]


def test_a_config_of_more_than_a_mebibyte_is_refused(library: Library, folder: Path) -> None:
    text = (folder / "contactbench.json").read_bytes()
    put(folder, "contactbench.json", text + b" " * (2**20 - len(text)))
    assert "is not as contactbench writes it" in refusal(library, folder)[1]
    put(folder, "contactbench.json", text + b" " * (2**20 - len(text) + 1))
    assert "too large" in refusal(library, folder)[1]


def test_a_surface_inside_out_was_never_verified(library: Library, folder: Path) -> None:
    mesh = bytearray((folder / "probe.ply").read_bytes())
    facets = content(folder)["probe"]["facets"]
    for at in range(len(mesh) - 21 * facets, len(mesh), 21):
        mesh[at + 5 : at + 13] = mesh[at + 9 : at + 13] + mesh[at + 5 : at + 9]
    put(folder, "probe.ply", bytes(mesh))
    assert "inside out" in refusal(library, folder)[1]
    edited(folder, "verified", False)
    assert refusal(library, folder)[0] == 0


def test_a_folder_that_is_replaced_is_read_all_old_or_all_new(library: Library, tmp_path: Path) -> None:
    folder, stop = tmp_path / "bundle", threading.Event()
    both = [example(300).encoded(), example(400).encoded()]
    write_folder(folder, both[0], KNOWN)

    def export() -> None:
        for i in range(40):
            write_folder(folder, both[1 - i % 2], KNOWN)
        stop.set()

    writer = threading.Thread(target=export)
    writer.start()
    answers = set()
    while not stop.is_set():
        answers.add(refusal(library, folder))
    writer.join()
    assert answers == {(0, "")}


def test_a_folder_put_aside_is_found(library: Library, folder: Path) -> None:
    folder.rename(put_aside(folder))
    assert refusal(library, folder) == (0, "")
    assert refusal(library, Path(f"{folder}/")) == (0, "")


def test_a_folder_copied_alone_says_what_is_missing(tmp_path: Path) -> None:
    done = run(CMAKE, "-S", shutil.copytree(SOURCE, tmp_path / "runtime"), "-B", tmp_path / "build")
    assert done.returncode != 0
    assert "does not build alone" in done.stderr


def test_a_project_of_c_alone_hears_that_a_static_library_needs_more(tmp_path: Path) -> None:
    static, user = tmp_path / "static", tmp_path / "user"
    cmake("-S", SOURCE, "-B", static, "-DBUILD_SHARED_LIBS=OFF")
    user.mkdir()
    (user / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.22)\nproject(consumer LANGUAGES C)\n"
        "find_package(contactbench_runtime 2 REQUIRED)\n",
        encoding="ascii",
    )
    done = run(CMAKE, "-S", user, "-B", user / "build", f"-Dcontactbench_runtime_DIR={static}")
    assert done.returncode != 0
    assert "LANGUAGES C CXX" in " ".join(done.stderr.split())
