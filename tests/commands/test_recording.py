"""recording info, convert, import-ros2."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import terminal
from mcap_ros2.writer import Writer
from recording.bag_cases import DEFINITIONS
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter, read_recording
from contactbench.pipeline.recording.ros2_poses import WRENCH_STAMPED


@pytest.fixture
def file(tmp_path: Path) -> Path:
    about = RecordingInfo(10**18, 5.0, (DeviceInfo("wrench", "/wrench", "sri+tcp://a:4008", serial="7"),))
    with RecordingWriter(tmp_path / "r.mcap", about) as writer:
        for number in range(101):
            if number != 50:
                sample = WrenchSample(5 + number / 100, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3), number)
                writer.wrench(sample)
            writer.flange(FlangeSample(5 + number / 100, np.eye(3), np.zeros(3)))
        writer.event("stop", {}, 6.0)
    return tmp_path / "r.mcap"


invoke = partial(terminal.invoke, "record")


def test_info(file: Path) -> None:
    result = invoke("info", file, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["complete"]
    assert found["devices"][0]["serial"] == "7"
    wrench, flange = found["topics"]
    assert (wrench["topic"], wrench["samples"], wrench["lost"]) == ("/wrench", 100, 1)
    assert flange["rate"] == pytest.approx(100)
    assert "/wrench: 100 wrenches in 1.00 s (99.0 Hz), 1 lost, 0 unusable." in result.output


def test_info_counts_what_is_unhealthy(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", RecordingInfo(10**18, 5.0)) as writer:
        for number in range(100):
            time, delay = 5 + number / 100, 0.15 if number in (7, 8) else 0.002
            status = {1: Status.OVERRANGE, 2: Status.LATE, 3: Status.CLOCK, 4: Status.CLOCK | Status.RAW}
            wrench = WrenchSample(time, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3), arrival=time + delay)
            writer.wrench(replace(wrench, status=status.get(number, Status.OK)))
            writer.flange(FlangeSample(time, np.eye(3), np.zeros(3)))
    result = invoke("info", tmp_path / "r.mcap", "--json")
    wrench, flange = json.loads(result.stdout)["topics"]
    assert wrench["flags"] == {"overrange": 1, "raw": 1, "late": 1, "clock": 2}
    assert (wrench["unusable"], wrench["late"], wrench["frozen"]) == (3, 2, 0)
    assert wrench["latency_median"] == pytest.approx(0.002)
    assert wrench["latency_p99"] > 0.1
    assert (flange["latency_median"], flange["late"]) == (None, 0)
    assert (
        "3 unusable, 1 overrange, 1 raw, 1 slower than the rate, 2 with an estimated time, 2 late by more than 0.1 s;"
        " latency 2.0 ms (median), 150.0 ms (99th percentile)."
    ) in result.output


def test_info_counts_frozen_readings(tmp_path: Path) -> None:
    chance = np.random.default_rng(4)
    with RecordingWriter(tmp_path / "r.mcap", RecordingInfo(10**18, 5.0)) as writer:
        for number in range(1000):
            if not 500 <= number < 700:
                values = tuple(chance.normal(size=6).tolist())
            writer.wrench(WrenchSample(5 + number / 100, values[:3], values[3:]))
    result = invoke("info", tmp_path / "r.mcap", "--json")
    wrench = json.loads(result.stdout)["topics"][0]
    assert (wrench["frozen"], wrench["unusable"]) == (201, 201)
    assert "201 frozen" in result.output


def test_info_of_a_file_that_is_cut_off(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-100])
    result = invoke("info", file, "--json")
    assert result.exit_code == 1
    assert "cut off" in json.loads(result.stdout)["warnings"][0]


@pytest.mark.parametrize("ending", ["csv", "npz", "CSV"])
def test_convert(file: Path, ending: str) -> None:
    out = file.with_name(f"out.{ending}")
    result = invoke("convert", file, "--out", out, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout) == {"out": str(out), "complete": True, "warnings": []}
    assert out.stat().st_size > 100


def test_a_converted_recording_shows_its_still_poses(file: Path) -> None:
    out = file.with_name("out.csv")
    assert invoke("convert", file, "--out", out).exit_code == 0
    result = terminal.invoke("calibrate", "captures", out, "--out", file.with_name("poses.csv"))
    assert result.exit_code == 1  # one pose is too few; but the table was understood
    assert "100 readings" in result.output


def bag(file: Path, topics: int = 1) -> Path:
    with file.open("wb") as stream:
        writer = Writer(stream)
        schema = writer.register_msgdef(WRENCH_STAMPED, DEFINITIONS[WRENCH_STAMPED])
        for number in range(10):
            for topic in range(topics):
                writer.write_message(f"/ft{topic}", schema, {"wrench": {"force": {"z": 4.0}}}, number)
        writer.finish()
    return file


def test_import_ros2(tmp_path: Path) -> None:
    result = invoke("import-ros2", bag(tmp_path / "b.mcap"), "--out", tmp_path / "r.mcap", "--json")
    assert result.exit_code == 1  # there are no poses in it
    assert json.loads(result.stdout)["wrenches"] == 10
    assert read_recording(tmp_path / "r.mcap").wrenches["/wrench"].wrenches[0, 2] == 4.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("info", "none.mcap"), "there is no such file"),
        (("info", "b.mcap"), "import-ros2"),
        (("convert", "r.mcap", "--out", "x.txt"), "end its name with .csv or .npz"),
        (("convert", "r.mcap", "--out", "x.csv", "--topic", "/no"), "it has: /wrench, /flange"),
        (("import-ros2", "r.mcap", "--out", "x.mcap"), "no topic of WrenchStamped"),
        (("import-ros2", "two.mcap", "--out", "x.mcap"), "several topics: /ft0"),
        (("import-ros2", "b.mcap", "--out", "r.mcap"), "choose another"),
        (("import-ros2", "b.mcap", "--out", "x.mcap", "--robot", "kuka"), "known: elfin3"),
    ],
)
def test_wrong_input(
    file: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(file.parent)
    bag(Path("b.mcap"))
    bag(Path("two.mcap"), 2)
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert message in " ".join(result.output.replace("│", " ").split())
    assert not Path("x.mcap").exists()


def test_info_of_times_that_are_almost_one_moment(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", RecordingInfo(10**18, 0.0)) as writer:
        for time in (0.0, 5e-324):
            writer.wrench(WrenchSample(time, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    result = invoke("info", tmp_path / "r.mcap", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["topics"][0]["rate"] is None


def test_names_in_a_file_cannot_steer_the_terminal(tmp_path: Path) -> None:
    device = DeviceInfo("wrench", "/wrench", "\x1b]0;title\x07\x1b[2J", "\x9b31m")
    with RecordingWriter(
        tmp_path / "r.mcap", RecordingInfo(10**18, 0.0, (device,), tool="\x1b[31mx")
    ) as writer:
        writer.wrench(WrenchSample(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    result = invoke("info", tmp_path / "r.mcap")
    assert "written by \ufffd[31mx" in result.output
    assert not set("\x1b\x07\x9b") & set(result.output)


def turning(file: Path, touched: bool = False) -> Path:
    noise = np.random.default_rng(0).normal(0, 0.05, (1500, 3))
    with RecordingWriter(file, RecordingInfo(10**18, 0.0)) as writer:
        for number in range(1500):
            time = number / 100
            R = Rotation.from_euler("xyz", [np.sin(time), np.cos(1.3 * time), 0.5 * np.sin(0.7 * time)])
            fx, fy, fz = (R.inv().apply([0, 0, -9.8]) + noise[number]).tolist()
            fx += 20.0 * (touched and 500 < number < 600)
            writer.wrench(WrenchSample(time + 0.02, (fx, fy, fz), (0.0, 0.0, 0.0), number))
            writer.flange(FlangeSample(time, R.as_matrix(), np.zeros(3)))
    return file


def test_delay(tmp_path: Path) -> None:
    result = invoke("delay", turning(tmp_path / "r.mcap"), "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["seconds"] == pytest.approx(0.02, abs=1e-3)
    assert found["doubt"] == ""


def test_a_doubtful_delay_is_told(tmp_path: Path) -> None:
    result = invoke("delay", turning(tmp_path / "r.mcap", touched=True), "--json")
    assert result.exit_code == 1
    assert "something was touched" in json.loads(result.stdout)["doubt"]
    assert "something was touched" in result.output


def test_delay_needs_one_of_each(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", RecordingInfo(10**18, 0.0)) as writer:
        writer.wrench(WrenchSample(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    result = invoke("delay", tmp_path / "r.mcap")
    assert result.exit_code == 2
    shown = " ".join(result.output.replace("│", " ").split())
    assert "it contains 1 sensors and 0 robots: record one of each" in shown
