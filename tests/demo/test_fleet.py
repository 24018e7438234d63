"""Sessions made of what the demo wrote, read as a fleet."""

import json
from pathlib import Path

import pytest
from terminal import invoke

from contactbench.pipeline import demo
from contactbench.pipeline.calibration.files.calibration_file import load_calibration
from contactbench.pipeline.session import Session


def test_the_demo_s_probes_make_a_fleet(
    done: demo.DemoReport, benched: demo.DemoReport, tmp_path: Path
) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    folders = {name: done.out / name for name in demo.PROBE_NAMES} | {"bench": benched.out / "convex"}
    for name, folder in folders.items():
        with Session.create(tmp_path / "all" / name) as session:
            session.add_input(folder / "housing.stl", "mesh")
            for kind in ("calibration", "verification"):
                if (folder / f"{kind}.json").exists():
                    session.add_input(folder / f"{kind}.json", kind, sensor="V-1")
    out = tmp_path / "f.parquet"
    ran = invoke("fleet", tmp_path / "all", "--out", out, "--json")
    assert json.loads(ran.stdout)["skipped"] == []
    rows = {row["place"].rpartition("/")[2]: row for row in pq.read_table(out).to_pylist()}
    assert rows.keys() == folders.keys()
    for name, folder in folders.items():
        assert rows[name]["mass_kg"] == load_calibration(folder / "calibration.json").model.mass
        assert (rows[name]["sensor"], rows[name]["tool"]) == ("V-1", "housing")
    content = json.loads((folders["bench"] / "verification.json").read_text("utf-8"))
    assert rows["bench"]["error_max_m"] == pytest.approx(1e-3 * content["overall"]["max_mm"])
    assert rows["bench"]["verification_passed"] is content["verdict"]["passed"]
