"""What an effect costs: the same bench and the same noise with it and without."""

import json
from pathlib import Path

import numpy as np
import pytest
from terminal import invoke

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import Reality
from contactbench.pipeline.study import reality_costs
from contactbench.pipeline.study.report import short


def test_a_table_has_each_effect_alone_and_what_is_saved_without_it(tmp_path: Path) -> None:
    command = [
        "study",
        "scene",
        "--probe",
        "linear",
        "--seeds",
        "1",
        "--reality",
        "cable=0.5,scale=1.004",
        "--json",
        "--out",
        str(tmp_path),
    ]
    done = invoke(*command)
    assert done.exit_code == 0, done.stderr
    (rows,) = (value for name, value in json.loads(done.stdout).items() if name.startswith("costs-"))
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "### What the effects of cable=0.5,scale=1.004 cost" in page
    assert f"| scale 1.004 | {short(rows[2]['rms mm'])} |" in page
    none, cable, scale, together = rows
    assert [row["effect"] for row in rows] == ["none", "cable 0.5", "scale 1.004", "together"]
    assert none["adds mm"] == 0
    assert none["rms mm"] < 0.3
    assert together["rms mm"] > max(cable["rms mm"], scale["rms mm"])
    assert together["rms mm"] == pytest.approx(
        np.sqrt(none["rms mm"] ** 2 + cable["adds mm"] ** 2 + scale["adds mm"] ** 2), rel=0.15
    )
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
