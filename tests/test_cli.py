import io
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
import typer
from typer.testing import CliRunner
from waiting import until

import contactbench
from contactbench.pipeline import cli, kernel
from contactbench.pipeline.commands import info as command_info
from contactbench.pipeline.commands.locate import MethodName
from contactbench.pipeline.console import Bar, say
from contactbench.pipeline.contact import ContactSolver, Gates, TouchModel, WrenchNoise
from contactbench.pipeline.contact.contact_csv import REASONS
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import _cpu
from contactbench.pipeline.mesh import load_probe, save_probe
from contactbench.pipeline.mesh.sidecar import save_probe_file
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.preparation.prepare import align_step, import_mesh
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM

RUNNER = CliRunner()
WRENCHES = "t,fx,fy,fz,mx,my,mz\n0.0,0,0,-5,0,0.01,0\n0.1,0,0,-0.1,0,0,0\n0.2,1,0,-5,0,0.1,0\n"


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    """A folder with a probe and a file of wrenches."""
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=40.0)
    mesh.apply_translation([0.0, 0.0, 120.0])
    mesh.export(tmp_path / "ball.stl")
    trimesh.Trimesh(mesh.vertices, mesh.faces[:-1], process=False).export(tmp_path / "open.ply")
    (tmp_path / "wrenches.csv").write_text(WRENCHES, encoding="utf-8")
    return tmp_path


def run(*arguments: Any, **options: Any) -> Any:
    return RUNNER.invoke(cli.app, [str(argument) for argument in arguments], **options)


def locate(bench: Path, *arguments: Any, probe: str = "ball.stl", **options: Any) -> Any:
    files = ("--probe", bench / probe, bench / "wrenches.csv", "--out", bench / "contacts.csv")
    return run("locate", *files, *arguments, **options)


def refused(result: Any, message: str) -> None:
    assert result.exit_code == 2
    assert message in " ".join(result.output.split())
    assert "Traceback" not in result.output


# ---- the whole -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("given", "used"), [(None, "1"), ("2", "2")])
def test_a_command_takes_one_thread_for_small_matrices_but_what_it_is_told(
    given: str | None, used: str
) -> None:
    code = (
        "import os, sys\nfrom contactbench.app import cli\nassert 'numpy' not in sys.modules\n"
        "print(os.environ['OPENBLAS_NUM_THREADS'])"
    )
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    if given:
        environment["OPENBLAS_NUM_THREADS"] = given
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout == f"{used}\n"


def test_version():
    result = run("--version")
    assert result.exit_code == 0
    assert result.stdout.startswith(f"contactbench {contactbench.__version__} (kernel {kernel.variant}, ")


def test_version_as_json():
    told = json.loads(run("--version", "--json").stdout)
    assert told["contactbench"] == contactbench.__version__
    assert told["kernel"] == kernel.variant
    assert {"commit", "build_type"} < set(told)


def test_json_alone_is_wrong():
    result = run("--json")
    assert result.exit_code == 2
    assert "--version" in json.loads(result.stdout)["error"]


def test_a_build_tells_its_commit_where_it_is_known(monkeypatch, tmp_path):
    monkeypatch.setattr(_cpu, "__file__", str(tmp_path / "_cpu.so"))
    (tmp_path / "build.json").write_text('{"commit": "0123abc+", "kind": "Release"}', "utf-8")
    assert "(kernel " in (said := run("--version").stdout)
    assert said.endswith(", Release build of 0123abc+)\n")
    (tmp_path / "build.json").write_text('{"commit": "", "kind": "Release"}', "utf-8")
    assert run("--version").stdout.endswith(", Release build of an unknown commit)\n")
    for wrong in ("", "[]", "{"):
        (tmp_path / "build.json").write_text(wrong, "utf-8")
        assert run("--version").stdout.endswith(", unknown build)\n")


def test_starting_imports_nothing_heavy():
    heavy = "{'numpy', 'scipy', 'manifold3d', 'pyvista', 'rich'}"
    code = f"import sys, contactbench.pipeline.cli; print(sorted({heavy} & set(sys.modules)))"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout == "[]\n"


def leaves(group: Any, *words: str) -> Iterator[tuple[str, ...]]:
    """Give the words of every command."""
    for name in group.list_commands(None):
        command = group.get_command(None, name)
        if hasattr(command, "list_commands"):
            yield from leaves(command, *words, name)
        else:
            yield *words, name


@pytest.mark.parametrize("words", list(leaves(typer.main.get_command(cli.app))), ids=" ".join)
def test_every_command_has_an_example_of_itself_and_says_what_its_options_are_for(words):
    result = run(*words, "-h")
    assert result.exit_code == 0
    text = " ".join(result.stdout.split())
    assert f"Example: contactbench {' '.join(words)}" in text
    assert "--quiet" in text
    command = typer.main.get_command(cli.app)
    for word in words:
        command = command.get_command(None, word)
    assert not [each.name for each in command.params if not each.help]


@pytest.mark.parametrize("words", [[], ["probe"], ["probe", "regions"], ["session"], ["study"]])
def test_lists_of_commands_are_whole(words):
    result = run(*words, "-h", env={"COLUMNS": "80"})
    assert result.exit_code == 0
    assert "..." not in result.stdout.partition("]...")[2]
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_the_whole_list_is_on_one_screen():
    assert len(run("-h").stdout.splitlines()) <= 24


def test_help_states_the_defaults_of_the_gates():
    text = " ".join(run("locate", "--help").stdout.split())
    gates = Gates()
    assert f"N [{gates.min_force:g}]" in text
    assert f"degrees [{gates.friction_angle:g}]" in text
    assert f"mm [{1e3 * gates.ambiguity_distance:g}]" in text
    assert f"mm [{1e3 * gates.follow_distance:g}]" in text
    model = TouchModel()
    assert f"mm [{1e3 * model.torsion_arm:g}, or that of the scene]" in text
    assert f"N [{DEFAULT_FORCE_N:g}]" in text
    assert f"mN·m [{1e3 * DEFAULT_TORQUE_NM:g}]" in text


def test_method_names_are_those_of_the_methods():
    methods = pytest.importorskip("contactbench.pipeline.contact.methods")
    assert {name.value for name in MethodName} == set(methods.METHODS)


def test_input_error_anywhere_is_one_line(monkeypatch):
    def fail() -> None:
        raise InputError("this is\nwrong")

    monkeypatch.setattr(command_info, "facts", fail)
    result = run("info")
    assert (result.exit_code, result.stdout, result.stderr) == (2, "", "error: this is wrong\n")
    result = run("info", "--json")
    assert json.loads(result.stdout) == {"error": "this is\nwrong"}
    assert result.exit_code == 2


def test_a_missing_extra_is_a_sentence(monkeypatch):
    def fail() -> None:
        raise ModuleNotFoundError("No module named 'mujoco'", name="mujoco")

    monkeypatch.setattr(command_info, "facts", fail)
    result = run("info", "--json")
    assert result.exit_code == 2
    assert "pip install 'contactbench[sim]'" in json.loads(result.stdout)["error"]
    assert len(result.stderr.splitlines()) == 1


def test_quiet_leaves_warnings_only(bench):
    assert "rows" in locate(bench).output
    assert "rows" not in locate(bench, "--quiet").output
    assert "error:" in run("session", "info", bench, "-q").stderr


def test_interruption_is_a_sentence(monkeypatch):
    def fail() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(command_info, "facts", fail)
    result = run("info", "--json")
    assert result.exit_code == 130
    assert result.output.startswith("error: interrupted")
    assert list(json.loads(result.stdout)) == ["error"]


# ---- info ----------------------------------------------------------------------------------------


def test_info():
    facts = json.loads(run("info", "--json").stdout)
    assert facts["contactbench"] == contactbench.__version__
    assert facts["numpy"] == np.__version__
    assert facts["kernel"] in {"base", "avx2"}
    assert set(facts["optional"]) == {"embreex", "pyvista", "PySide6", "mujoco", "pymeshlab", "igl"}
    assert facts["cpu"]
    assert facts["cpu_count"] > 0
    result = run("info")
    assert result.exit_code == 0
    assert facts["python"] in result.stdout


# ---- locate --------------------------------------------------------------------------------------


def test_locate_writes_contacts_and_says_how_it_went(bench):
    result = locate(bench)
    assert (result.exit_code, result.stderr) == (0, "")
    for text in ("rows", "ok", "low_force", "33.3 %", "median sigma_max", "rows/s"):
        assert text in result.stdout
    lines = (bench / "contacts.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 4
    assert lines[2].startswith("0.1,,,,,,low_force,0,")


def test_json_is_exactly_one_object(bench):
    facts = json.loads(locate(bench, "--json").stdout)
    assert facts["rows"] == 3
    assert set(facts["reasons"]) == set(REASONS)
    assert facts["reasons"]["low_force"] == 1
    assert sum(facts["reasons"].values()) == 3
    assert facts["out"] == str(bench / "contacts.csv")
    assert facts["method"] == "contactbench"
    assert facts["median_sigma_max_mm"] > 0
    assert facts["seconds"] > 0
    assert facts["rows_per_second"] > 0
    assert facts["warnings"] == []


def test_options_reach_the_solver(bench):
    limits = ("--min-force", 0.05, "--friction-angle", 60, "--ambiguity-distance", 3)
    noise = ("--noise-force", 0.01, "--noise-torque", 0.001, "--saturation", "9,9,5,9,9,9")
    facts = json.loads(locate(bench, *limits, *noise, "--region-only", "--json").stdout)
    assert facts["reasons"]["low_force"] == 0
    assert facts["reasons"]["saturated"] == 2


def test_the_touch_model_reaches_the_solver(bench):
    options = ("--torsion-arm", 3, "--model-force", 0.2, "--model-torque", 4, "--noise-force", 0.01)
    assert locate(bench, *options).exit_code == 0
    model = TouchModel(torsion_arm=0.003, model_error=WrenchNoise(0.2, 0.004))
    solver = ContactSolver(load_probe(bench / "ball.stl", "mm"), WrenchNoise(0.01, 0.002), model=model)
    row = (bench / "contacts.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
    contact = solver.locate([0, 0, -5, 0, 0.01, 0])
    assert [float(row[8]), float(row[9])] == [1e3 * contact.sigma_max, contact.misfit]


def plausibility(result: Any) -> Any:
    assert result.exit_code == 1, result.stderr
    return json.loads(result.stdout)["plausibility"]


def test_wrenches_that_no_touch_explains_end_with_the_likely_cause(bench):
    touches = ball_touches(40)
    write_wrenches(bench, touches * [1, 1, 1, 1e3, 1e3, 1e3])
    result = locate(bench, "--json")
    found = plausibility(result)
    assert found["likely"] == ["torques_in_Nmm"]
    assert found["trials"][0]["plausible"] == 40
    assert found["plausible"] == 0
    said = " ".join(result.output.split())
    assert "warning: Most likely the torques are in N·mm: 40 of 40 rows (100 %) are then plausible." in said
    assert "Divide mx, my and mz by 1000." in said
    assert (bench / "contacts.csv").exists()
    write_wrenches(bench, touches)
    result = locate(bench, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["plausibility"] is None


def test_a_raw_recording_is_refused_unless_it_is_said_to_be_compensated(bench):
    header, *rows = WRENCHES.splitlines()
    lines = [f"{header},qw,qx,qy,qz,status", *(f"{row},1,0,0,0,0" for row in rows)]
    (bench / "wrenches.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    refused(locate(bench), "wrenches.csv: line 1: columns qw, qx, qy, qz, status: this is a raw recording")
    refused(locate(bench), "contactbench calibrate compensate calibration.json RECORDING --out WRENCHES")
    assert not (bench / "contacts.csv").exists()
    assert locate(bench, "--compensated").exit_code == 0


def ball_touches(count: int) -> np.ndarray:
    """Straight presses all over the ball of the fixture, about 8 N."""
    outward = np.random.default_rng(1).normal(size=(count, 3))
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    return np.hstack([-8 * outward, np.cross([0, 0, 0.12] + 0.039 * outward, -8 * outward)])


def write_wrenches(bench: Path, wrenches: np.ndarray) -> None:
    rows = (f"{0.01 * i}," + ",".join(map(repr, row)) for i, row in enumerate(wrenches.tolist()))
    (bench / "wrenches.csv").write_text("\n".join(["t,fx,fy,fz,mx,my,mz", *rows]) + "\n", encoding="utf-8")


def test_units_and_mount_move_the_probe(bench):
    mesh = trimesh.load_mesh(bench / "ball.stl")
    mesh.apply_translation([3.0, -7.0, 11.0])
    mesh.apply_scale(0.1)
    mesh.export(bench / "ball.stl")
    a, b, c = np.radians([10, -20, 30])
    Rx = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    Ry = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    Rz = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    T_SP = np.eye(4)
    T_SP[:3, :3] = Rz @ Ry @ Rx
    T_SP[:3, 3] = np.array([0.0, 0.0, 0.12]) - T_SP[:3, :3] @ mesh.centroid / 100  # back below the force
    position = ",".join(repr(100 * float(x)) for x in T_SP[:3, 3])
    assert locate(bench, "--units", "cm", "--place", f"{position},10,-20,30").exit_code == 0
    solver = ContactSolver(load_probe(bench / "ball.stl", "cm", T_SP))
    contacts = (bench / "contacts.csv").read_text(encoding="utf-8").splitlines()[1:]
    points = solver.locate_batch(np.loadtxt(WRENCHES.splitlines()[1:], delimiter=",")[:, 1:]).points
    assert np.isfinite(points[0]).all()
    np.testing.assert_allclose([float(cell) for cell in contacts[0].split(",")[1:4]], points[0], atol=1e-9)


def test_the_unit_is_found_and_the_mount_is_in_it(bench):
    assert locate(bench, "--place", "0,0,20,0,0,0").exit_code == 0
    expected = (bench / "contacts.csv").read_bytes()
    mesh = trimesh.load_mesh(bench / "ball.stl")
    mesh.apply_scale(0.001)
    (bench / "metres.obj").write_bytes(b"# units: m\n" + mesh.export(file_type="obj", digits=9).encode())
    result = locate(bench, "--place", "0,0,0.020,0,0,0", "--json", probe="metres.obj")
    assert (json.loads(result.stdout)["warnings"], "--place in metres?" in result.stderr) == ([], True)
    points = [
        np.genfromtxt(each.splitlines()[1:], delimiter=",", usecols=(1, 2, 3))
        for each in (expected.decode(), (bench / "contacts.csv").read_text(encoding="utf-8"))
    ]
    np.testing.assert_allclose(points[1], points[0], atol=1e-6)


def test_a_doubtful_unit_is_asked_for(bench):
    mesh = trimesh.load_mesh(bench / "ball.stl")
    mesh.apply_scale(1 / 25.4)
    mesh.export(bench / "inches.stl")
    result = locate(bench, "--json", probe="inches.stl")
    assert result.exit_code == 2
    assert "inches.stl: the unit cannot be determined. The numbers span 3.15" in result.output
    assert json.loads(locate(bench, "--json", "--units", "in", probe="inches.stl").stdout)["warnings"] == []


def test_a_probe_of_our_own_is_in_metres_and_says_when_it_was_never_aligned(bench):
    known = import_mesh(bench / "ball.stl", "mm")
    save_probe_file(known, bench / "own.ply")
    result = locate(bench, "--json", probe="own.ply")
    assert result.exit_code == 0
    assert "was never aligned with the sensor" in json.loads(result.stdout)["warnings"][0]
    save_probe_file(align_step(known, from_angles([0, 0, 0], [0, 0, 0])), bench / "own.ply")
    result = locate(bench, "--json", probe="own.ply")
    assert json.loads(result.stdout)["warnings"] == []
    unmoved = (bench / "contacts.csv").read_bytes()
    assert locate(bench).exit_code == 0
    assert unmoved == (bench / "contacts.csv").read_bytes()


def test_contacts_on_invented_facets_are_counted(bench):
    known = import_mesh(bench / "ball.stl", "mm")
    everything = np.ones(len(known.probe.faces), dtype=bool)
    save_probe(known.probe.with_invented(everything), bench / "own.ply")
    facts = json.loads(locate(bench, "--json", probe="own.ply").stdout)
    points = facts["reasons"]["ok"] + facts["reasons"]["vertex"] + facts["reasons"]["ambiguous"]
    assert facts["on_invented"] == points > 0
    assert any("Contacts on invented facets" in warning for warning in facts["warnings"])
    assert json.loads(locate(bench, "--json").stdout)["on_invented"] == 0


def test_defects_of_the_mesh_are_a_sentence_and_no_dump(bench):
    result = locate(bench, "--json", probe="open.ply")
    assert result.exit_code == 0
    (warning,) = json.loads(result.stdout)["warnings"]
    assert "The surface is open" in warning
    assert f"warning: {warning}\n" in result.output
    assert "MeshWarning" not in result.output


@pytest.mark.parametrize("method", [name.value for name in MethodName])
def test_methods(bench, method):
    if method == "wrench_axis":
        pytest.importorskip("embreex")
    result = locate(bench, "--method", method, "--json")
    if method == "iterative":  # a ball has no contact face: refused or answered, never a traceback
        assert result.exit_code in {0, 2}
        return
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["method"] == method


def test_track(bench):
    (bench / "wrenches.csv").write_text(WRENCHES + "0.1,0,0,-5,0,0.01,0\n", encoding="utf-8")
    result = locate(bench, "--track", "--json")
    facts = json.loads(result.stdout)
    assert facts["reasons"]["stale"] == 1
    assert "the first on line 5" in facts["warnings"][0]
    assert "warning: Rows that are not later" in result.output


def test_allow_nan(bench):
    (bench / "wrenches.csv").write_text(WRENCHES + "0.3,nan,0,-5,0,0.01,0\n", encoding="utf-8")
    refused(locate(bench), "line 5: column fx holds nan: remove the row, or pass --allow-nan")
    assert json.loads(locate(bench, "--allow-nan", "--json").stdout)["reasons"]["not_finite"] == 1


def test_standard_input_and_output(bench):
    locate(bench)
    result = run("locate", "--probe", bench / "ball.stl", "-", "--out", "-", input=WRENCHES)
    assert result.exit_code == 0
    assert result.stdout == (bench / "contacts.csv").read_text(encoding="utf-8")
    result = run("locate", "--probe", bench / "ball.stl", "-", "--out", bench / "x.csv", input="t\n")
    refused(result, "error: standard input: line 1: columns fx")


def test_wrong_input_with_json_is_one_object_too(bench):
    (bench / "wrenches.csv").write_text("t,fx\n", encoding="utf-8")
    result = locate(bench, "--json")
    refused(result, "error: ")
    assert "missing" in json.loads(result.stdout)["error"]
    assert not (bench / "contacts.csv").exists()


def test_wrong_files(bench):
    refused(locate(bench, probe="none.stl"), "none.stl: there is no such file: check the path")
    (bench / "wrenches.csv").unlink()
    refused(locate(bench), "wrenches.csv: there is no such file: check the path")
    result = run("locate", "--probe", bench / "ball.stl", bench / "w.csv", "--out", bench / "ball.stl")
    refused(result, "ball.stl: the output would overwrite the input")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--method", "guess"], "'contactbench', 'scan', 'algorithm1', 'wrench_axis', 'iterative'"),
        (["--units", "ft"], "'ft' is not one of 'mm', 'm', 'cm', 'in'"),
        (["--place", "1,2,3"], "--place needs 6 finite numbers separated by commas, not '1,2,3'"),
        (["--place", "1,2,3,4,5,nan"], "--place needs 6 finite numbers"),
        (["--place", "1,2,3,4,5,east"], "--place needs 6 finite numbers"),
        (["--saturation", "1"], "--saturation needs 6 finite numbers"),
        (["--patch", "round"], "error: patch 'round': give flat, or the radii"),
        (["--patch", "5,0"], "error: Bed.curvature (200.0, 0.0)"),
        (
            ["--patch", "flat", "--method", "scan"],
            "--patch works only with --method contactbench, not with scan",
        ),
        (["--track", "--method", "scan"], "--track works only with --method contactbench, not with scan"),
        (["--min-force", "-1"], "error: --min-force: Input should be greater than or equal to 0"),
        (["--torsion-arm", "-1"], "error: TouchModel.torsion_arm must be between 0 and 1000 m"),
        (["--model-torque", "-1"], "error: WrenchNoise.torque"),
        (["--torque-ratio", "2"], "No such option"),
        (["--noise-force", "nan"], "error: WrenchNoise.force"),
        (["--place", "99999,0,0,0,0,0"], "is 10 m or longer, too long for a mount"),
        (["--json", "--out", "-"], "--json and --out - both use standard output"),
        (["--unknown"], "No such option"),
    ],
)
def test_wrong_options(bench, arguments, message):
    refused(locate(bench, *arguments, env={"COLUMNS": "300"}), message)
    assert not (bench / "contacts.csv").exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for one process")
def sleeps(pid: int) -> bool:
    """Tell whether a process waits for something."""
    return Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()[0] == "S"


def test_ctrl_c_leaves_the_old_output(bench):
    (bench / "contacts.csv").write_text("old", encoding="utf-8")
    files = ["--probe", bench / "ball.stl", "-", "--out", bench / "contacts.csv"]
    command = [sys.executable, "-m", "contactbench.pipeline.cli", "locate", *map(str, files)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdin is not None
        assert child.stderr is not None
        child.stdin.write(WRENCHES)
        child.stdin.flush()
        until(lambda: list(bench.glob(".contacts.csv.*.tmp")))
        # One that comes between Python's last look for signals and the wait for a row would wait for that row, too.
        until(lambda: not Path("/proc/self").exists() or sleeps(child.pid))
        child.send_signal(signal.SIGINT)
        said = child.stderr.read()
        assert child.wait(60) == 130
    assert said == "error: interrupted: the command was stopped before it finished.\n"
    assert (bench / "contacts.csv").read_text(encoding="utf-8") == "old"
    assert not list(bench.glob(".*"))


def test_bar_waits_for_half_a_second_and_a_terminal(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setenv("TERM", "xterm")
    with Bar("locating") as bar:
        bar(1, 100)
        assert screen.getvalue() == ""
        monkeypatch.setattr(bar, "_begin", time.perf_counter() - 1)
        bar(50, 100)
        bar(100, 100)
    assert "locating" in screen.getvalue()
    monkeypatch.setattr(sys, "stderr", quiet := io.StringIO())
    with Bar("locating") as bar:
        monkeypatch.setattr(bar, "_begin", time.perf_counter() - 1)
        bar(50, 100)
    assert quiet.getvalue() == ""


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("probe inspect --units furlong a.stl --json", "furlong"),
        ("probe inspect --json", "FILE"),
        ("probe simplify a.stl --facets abc --out b.ply --json", "--facets"),
        ("locate --nonsense --json", "--nonsense"),
        ("nonsense --json", "nonsense"),
    ],
)
def test_wrong_usage_is_one_object_too(words, said, capsys):
    done = RUNNER.invoke(cli.app, words.split())
    assert done.exit_code == 2
    assert said in json.loads(done.stdout)["error"]
    assert said in done.stderr
    say("next")
    assert capsys.readouterr().out == "next\n", "a wrong word leaves nothing behind"
