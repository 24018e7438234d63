"""What an effect costs: the same bench and the same noise with it and without."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from terminal import invoke

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import Reality
from contactbench.pipeline.study import reality_costs
from contactbench.pipeline.study import scene_limits as study
from contactbench.pipeline.study.pages import make_page
from contactbench.pipeline.study.report import StudyReport, short


def test_a_table_has_each_effect_alone_and_what_is_saved_without_it(tmp_path: Path) -> None:
    effects = ("--reality", "cable=0.5,scale=1.004")
    done = invoke("study", "scene", "--probe", "linear", "--seeds", 1, *effects, "--json", "--out", tmp_path)
    assert done.exit_code == 0, done.stderr
    (rows,) = (value for name, value in json.loads(done.stdout).items() if name.startswith("costs-"))
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "### What the effects of cable=0.5,scale=1.004 cost" in page
    assert f"| scale 1.004 | {short(rows[2]['rms mm'])} |" in page
    none, cable, scale, together, followed = rows
    assert [row["effect"] for row in rows[:4]] == ["none", "cable 0.5", "scale 1.004", "together"]
    assert none["adds mm"] == 0
    assert none["rms mm"] < 0.3
    assert together["rms mm"] > max(cable["rms mm"], scale["rms mm"])
    assert together["rms mm"] == pytest.approx(
        np.sqrt(none["rms mm"] ** 2 + cable["adds mm"] ** 2 + scale["adds mm"] ** 2), rel=0.15
    )
    assert followed["effect"] == "with a zero that follows"
    assert followed["saved without it mm"] == pytest.approx(together["rms mm"] - followed["rms mm"])
    assert followed["rms mm"] < 0.9 * together["rms mm"]
    # To take the only other effect away leaves that effect alone.
    assert cable["saved without it mm"] == pytest.approx(together["rms mm"] - scale["rms mm"])


def test_the_noise_is_the_same_with_any_effect() -> None:
    ideal, late = (
        reality_costs.press_all("linear", reality, 3) for reality in (Reality(), Reality(latency=5.0))
    )
    np.testing.assert_array_equal(ideal.from_truth, late.from_truth)


def test_what_is_out_of_range_is_refused() -> None:
    with pytest.raises(InputError, match="no probe 'round'"):
        reality_costs.run([Reality()], ["round"])
    with pytest.raises(InputError, match="--seeds 0"):
        reality_costs.run([Reality()], seeds=0)


# ---- what the moving scenes leave out ------------------------------------------------------------


@pytest.fixture(scope="module")
def limits() -> StudyReport:
    pytest.importorskip("mujoco")
    return study.run(["convex"], 2.0, motions=("in plane",), only=("half the time step", study.ARM))


def rows(limits: StudyReport, name: str) -> list[dict[str, Any]]:
    return next(sheet for sheet in limits.sheets if sheet.name == name).to_json()


def test_each_change_brings_what_it_is_compared_with(limits: StudyReport) -> None:
    assert [row["change"] for row in rows(limits, "effects")] == ["half the time step", study.ARM]
    scenes = {row["scene"] for row in rows(limits, "speed")}
    assert scenes == {study.AS_IT_IS, "half the time step", study.ARM}


def test_the_time_step_hardly_counts_and_the_arm_a_little(limits: StudyReport) -> None:
    step, arm = rows(limits, "effects")
    assert step["N rms"] < 0.05
    assert step["deg rms"] < 0.02
    assert 0.01 < arm["N rms"] < 0.7
    # The mount has the arm's servo: what is left is next to nothing, but not nothing.
    assert 0.0 < arm["deg rms"] < 0.1


def test_the_inertia_of_a_tool_that_swings_is_felt(limits: StudyReport) -> None:
    found = rows(limits, "inertia")
    assert [row["scene"] for row in found] == [study.AS_IT_IS, study.ARM]
    for row in found:
        # 0.45 kg, 80 mm from the tip, 9 degrees in 2 s: 0.056 N, and some more for the set-points' corners.
        assert 0.04 < row["N most"] < 0.4


def test_the_command_gives_one_object_and_one_page(
    limits: StudyReport, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked = []
    monkeypatch.setattr(study, "run", lambda probes, *_, **__: asked.append(probes) or limits)
    command = ["study", "scene", "--moving", "--probe", "convex", "--probe", "linear", "--json"]
    done = invoke(*command, "--out", tmp_path)
    assert done.exit_code == 0, done.stderr
    assert asked == [("convex", "linear")]
    assert json.loads(done.stdout)["effects"][1]["change"] == study.ARM
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert page.startswith("## What the scenes with a moving phantom leave out")
    assert page.count("\n### ") == 3
    assert f"| convex | in plane | {study.ARM} |" in page
    assert "--probe convex --probe linear --seeds 5 --moving --period 2.0" in page
    assert make_page(tmp_path) == page


def test_a_probe_that_is_not_bundled_is_named() -> None:
    unknown = invoke("study", "scene", "--moving", "--probe", "round")
    assert unknown.exit_code == 2
    assert "no probe 'round'" in unknown.stderr


def test_every_change_can_be_made() -> None:
    known = study.changes(study.truth_of("convex"))
    assert all(each.against in known for each in known.values())
    for name in ("400 places", "friction 0.6", "arm, payload of 1 kg instead of 0.45"):
        scene = known[name].make(gap=0.01)
        scene.advance(0.01)
        assert np.isfinite(scene.moment().reading).all()
