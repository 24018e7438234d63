"""The packages for ROS 2: the node's core on a bundle, and its ROS layer compiled and driven on stubs of ROS."""

from __future__ import annotations

import ast
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import yaml
from config.runtime.bundles import example_bundle
from native import cmake, installed, needs_cmake, run
from scipy.spatial.transform import Rotation

from contactbench import __version__

ROOT = Path(__file__).parents[2]
PACKAGES, HERE = ROOT / "packaging/ros2", Path(__file__).parent / "ros2"
FIELDS = """std_msgs/Header header
bool accepted
string reason
string[] health
geometry_msgs/Point point
geometry_msgs/Vector3 normal
geometry_msgs/Wrench wrench
float64[9] covariance
float64 confidence
uint32 region
float64 latency""".splitlines()


def fields() -> list[str]:
    lines = (PACKAGES / "contactbench_msgs/msg/Contact.msg").read_text("utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def contact_struct() -> str:
    """Return Contact.msg as the C++ struct that rosidl makes of it."""
    plain = {"bool": "bool", "string": "std::string", "float64": "double", "uint32": "std::uint32_t"}
    members = []
    for line in fields():
        kind, name = line.split()
        base, size = re.fullmatch(r"([\w/]+?)(\[\d*\])?", kind).groups()
        made = plain.get(base) or base.replace("/", "::msg::")
        if size:
            made = f"std::vector<{made}>" if size == "[]" else f"std::array<{made}, {size[1:-1]}>"
        members.append(f"    {made} {name}{{}};")
    return "\n".join(["namespace contactbench_msgs::msg {", "struct Contact {", *members, "};", "}", ""])


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Return a bundle, one that is not verified, and what its probe feels."""
    folder = tmp_path_factory.mktemp("given")
    config = example_bundle(folder / "bundle")
    example_bundle(folder / "unverified", verified=False)
    tilt = Rotation.from_euler("xyz", [170, 25, 40], degrees=True)
    level = config.gravity.predict(np.eye(3))
    probe = config.probe
    facet = int(np.flatnonzero(probe.region == 1)[0])
    force = -8.0 * probe.normals[facet]
    touch = [*force, *np.cross(probe.vertices[probe.faces[facet]].mean(axis=0), force)]
    rows = [level, level + touch, config.gravity.predict(tilt.as_matrix()), tilt.as_quat()]
    text = "\n".join(" ".join(map(repr, map(float, np.ravel(row)))) for row in rows)
    (folder / "readings").write_text(text, encoding="utf-8")
    return [folder / "bundle", folder / "unverified", folder / "readings"]


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("build")
    prefix = installed(tmp_path_factory.mktemp("prefix"))
    (folder / "contact").mkdir()
    (folder / "contact/contact_stub.hpp").write_text(contact_struct(), encoding="utf-8")
    where = [f"-DPACKAGES={PACKAGES}", f"-DCONTACT={folder / 'contact'}", f"-DCMAKE_PREFIX_PATH={prefix}"]
    cmake("-S", HERE, "-B", folder, *where, "-DSANITIZE=ON")
    cmake("--build", folder)
    return folder


@needs_cmake
def test_the_node_core_keeps_its_word(programs: Path, given: list[Path]) -> None:
    done = run(programs / "core_test", *given)
    assert done.returncode == 0, done.stdout + done.stderr[-3000:]
    assert int(done.stdout.split()[-5]) > 1_000


@needs_cmake
def test_the_ros_layer_keeps_its_word_on_stubs(programs: Path, given: list[Path]) -> None:
    done = run(programs / "node_test", given[0], given[2])
    assert done.returncode == 0, done.stdout + done.stderr[-3000:]


@needs_cmake
def test_the_program_says_what_is_wrong_and_ends(programs: Path) -> None:
    node = programs / "contactbench_ros/contactbench_node"
    assert run(node).returncode == 0
    done = run(node, "--ros-args")
    assert (done.returncode, done.stdout) == (1, "fatal: failed to parse arguments\n")


def test_the_message_is_the_one_that_others_publish_too() -> None:
    assert fields() == FIELDS


def test_every_package_declares_what_it_finds() -> None:
    for folder in ("contactbench_msgs", "contactbench_ros"):
        told = ET.parse(PACKAGES / folder / "package.xml").getroot()  # noqa: S314 - our own file
        assert told.findtext("name") == folder
        assert told.findtext("license") == "Apache-2.0"
        assert told.findtext("version") == __version__
        depends = {each.text for each in told if each.tag.endswith("depend")}
        wanted = re.findall(r"find_package\((\w+)", (PACKAGES / folder / "CMakeLists.txt").read_text("utf-8"))
        assert set(wanted) <= depends


def test_the_parameter_file_has_what_the_node_declares() -> None:
    source = (PACKAGES / "contactbench_ros/src/node.cpp").read_text("utf-8")
    declared = set(re.findall(r'(?:declare_parameter<[\w:]+>|declare_rate)\("(\w+)"', source))
    told = yaml.safe_load((PACKAGES / "contactbench_ros/config/contactbench.yaml").read_text("utf-8"))
    assert set(told["/**"]["ros__parameters"]) | {"bundle"} == declared
    asked = set(re.findall(r'(?:get_parameter|\brate)\("(\w+)"\)', source))
    assert asked == declared


def test_the_launch_file_is_python_and_uses_packages_that_are_declared() -> None:
    tree = ast.parse((PACKAGES / "contactbench_ros/launch/contactbench.launch.py").read_text("utf-8"))
    used = {each.module.split(".")[0] for each in ast.walk(tree) if isinstance(each, ast.ImportFrom)}
    told = (PACKAGES / "contactbench_ros/package.xml").read_text("utf-8")
    assert all(f"<exec_depend>{name}</exec_depend>" in told for name in used)
