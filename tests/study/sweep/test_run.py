"""Sweeps that are computed: the same whoever does it, kept, stopped and gone on with."""

import errno
import json
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
from terminal import command
from waiting import until

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.sidecar import encode_probe, save_probe
from contactbench.pipeline.study import pages as stored
from contactbench.pipeline.study.pages import RESULTS, origin, read_results
from contactbench.pipeline.study.sweep.cell import TIMES
from contactbench.pipeline.study.sweep.plan import SweepPlan, label, preset_plan
from contactbench.pipeline.study.sweep.run import DONE, Store, run, tasks_of

_TINY = SweepPlan(
    name="tiny",
    probes=("linear", "convex"),
    facets=(300, 500),
    forces=(9.0,),
    angles=(0.0, 40.0),
    methods=("contactbench", "algorithm1"),
    touches=40,
    times=False,
)
_TIMED = (*TIMES, "times", "key")
_ABOUT = {"plan": {}, "environment": {}}


def _table(folder):
    """Everything but the times and the moment, as text: equal text is equal to the bit."""
    results = read_results(folder)
    return json.dumps([{k: v for k, v in row.items() if k not in _TIMED} for row in results.rows])


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    folder = tmp_path_factory.mktemp("alone")
    run(_TINY, folder, workers=1)
    return _table(folder)


@pytest.fixture(scope="module")
def scheduler():
    """Address of a cluster that somebody else runs."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster.scheduler_address


def test_two_workers_give_the_same_to_the_bit(tmp_path, alone):
    done = run(_TINY, tmp_path, workers=2)
    assert done.computed == done.cells == len(_TINY)
    assert _table(tmp_path) == alone
    assert read_results(tmp_path).environment["workers"] == 2


def test_a_killed_worker_loses_nothing_and_two_are_told(tmp_path):
    plan = _TINY.changed(touches=1_000)
    whole = run(plan, tmp_path / "a", workers=2, progress=lambda done, _: done == 1 and _kill_a_child())
    run(plan, tmp_path / "b", workers=1)
    assert whole.computed == len(plan)
    assert _table(tmp_path / "a") == _table(tmp_path / "b")
    with pytest.raises(InputError, match=r"ended twice .* fewer --workers"):
        run(plan.changed(seed=1), tmp_path / "a", workers=2, progress=lambda *_: _kill_a_child())


def _kill_a_child():
    for child in multiprocessing.active_children()[:1]:
        child.kill()


def test_a_cluster_gives_the_same_to_the_bit(tmp_path, alone, scheduler):
    assert scheduler.startswith("tcp://")
    shown = []
    run(_TINY, tmp_path, scheduler=scheduler, progress=lambda *of: shown.append(of))
    assert _table(tmp_path) == alone
    assert shown[-1] == (len(_TINY), len(_TINY))
    assert read_results(tmp_path).environment["scheduler"] == "a cluster"


def test_times_are_beside_the_errors_and_do_not_change_them(tmp_path, alone):
    run(_TINY.changed(times=True), tmp_path, workers=1)
    rows = read_results(tmp_path).rows
    assert all(0 < row["compiled_median_ns"] <= row["compiled_p99_ns"] for row in rows)
    assert all(0 < row["python_median_ns"] <= row["python_p99_ns"] for row in rows)
    assert _table(tmp_path) == alone


def test_another_seed_gives_other_errors_and_other_noise_the_same_touches(rows):
    def errors(seed):
        return [_cell_error(cell) for cell in _TINY.model_copy(update={"seed": seed}).cells()]

    assert errors(0) == errors(0) != errors(1)
    pairs = {(r["method"], r["facets"], r["force"], r["angle"], r["noise"]): r["mean_mm"] for r in rows}
    assert pairs["contactbench", 1200, 9.0, 0.0, "none"] < pairs["contactbench", 1200, 9.0, 0.0, "paper"]


def _cell_error(cell):
    from contactbench.pipeline.study.sweep.cell import forget, run_cell

    try:
        return run_cell(cell)["mean_mm"]
    finally:
        forget()


def test_what_is_done_is_not_done_again(tmp_path, alone):
    asked = iter([False] * 3 + [True] * 99)
    first = run(_TINY, tmp_path, workers=1, cancelled=lambda: next(asked))
    assert (first.results, first.computed) == (None, 3)
    assert not (tmp_path / RESULTS).exists()
    shown = []
    second = run(_TINY, tmp_path, workers=1, progress=lambda *of: shown.append(of))
    assert second.computed == len(_TINY) - 3
    assert shown[0] == (4, len(_TINY))
    assert shown[-1] == (len(_TINY), len(_TINY))
    assert _table(tmp_path) == alone
    assert run(_TINY, tmp_path, workers=1).computed == 0


def test_a_cluster_is_cancelled_too(tmp_path, scheduler):
    done = run(_TINY, tmp_path, scheduler=scheduler, cancelled=lambda: True)
    assert (done.results, done.computed) == (None, 0)


def test_a_plan_that_grows_computes_only_what_is_new(tmp_path):
    run(_TINY, tmp_path, workers=1)
    more = _TINY.model_copy(update={"forces": (9.0, 5.0)})
    assert run(more, tmp_path, workers=1).computed == len(_TINY)
    assert len(read_results(tmp_path).rows) == 2 * len(_TINY)


def test_two_processes_that_write_at_the_same_time_lose_nothing(tmp_path):
    code = (
        "import sys; from pathlib import Path; from contactbench.pipeline.study.sweep.run import Store\n"
        "with Store(Path(sys.argv[1]), {'plan': {}, 'environment': {}}) as store:\n"
        "    print(flush=True); sys.stdin.readline()\n"
        "    for i in range(200): store.keep({'key': f'{sys.argv[2]}-{i}', 'failed': '', 'text': 'x' * 5000})\n"
    )
    pipe = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    both = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path), name], **pipe) for name in "ab"]
    for process in both:
        process.stdout.readline()  # both have opened the folder before either writes
    for process in both:
        process.stdin.write("\n")
        process.stdin.flush()
    assert [process.communicate(timeout=120) and process.returncode for process in both] == [0, 0]
    with Store(tmp_path, _ABOUT) as store:
        assert set(store.rows) == {f"{name}-{i}" for name in "ab" for i in range(200)}
    assert len([*tmp_path.iterdir()]) == 2  # who keeps nothing leaves nothing


def test_what_another_does_meanwhile_is_seen(tmp_path):
    with Store(tmp_path, _ABOUT) as one, Store(tmp_path, _ABOUT) as other:
        other.keep({"key": "a", "failed": ""})
        one.keep({"key": "a", "failed": "lacks a library"})
        one.look()
        other.look()
        assert one.rows == other.rows == {"a": {"key": "a", "failed": ""}}


def test_parts_make_the_whole_to_the_bit(tmp_path, alone):
    parts = [run(_TINY, tmp_path, workers=1, part=(number, 3)) for number in (1, 2, 3)]
    assert [part.results is None for part in parts] == [True, True, False]
    assert sum(part.computed for part in parts) == len(_TINY)
    assert all(part.computed for part in parts)
    assert _table(tmp_path) == alone
    assert parts[0].to_json()["results"] is None
    with pytest.raises(InputError, match=r"--part 4/3: give one of the parts 1/3 to 3/3"):
        run(_TINY, tmp_path, part=(4, 3))


def test_each_machine_is_told_with_its_own_environment(tmp_path, monkeypatch):
    for number, name in enumerate(("one", "one", "other"), 1):
        monkeypatch.setattr(stored, "processor", lambda name=name: name)
        run(_TINY, tmp_path, workers=1, part=(number, 3))
    found = read_results(tmp_path).environment
    told = {each["processor"]: each["cells"] for each in found["machines"]}
    assert sum(told.values()) == len(_TINY)
    assert 0 < told["other"] < told["one"]
    said = origin(found, "it")
    assert "on 2 machines that differ in processor, so that" in said
    assert f"(1) one, {found['cores']} cores" in said
    assert f": {told['other']:,} cells. Repeat with" in said
    assert "machines" not in origin(found | {"machines": found["machines"][1:]}, "it")


def test_parts_of_other_plans_are_named(tmp_path):
    run(_TINY, tmp_path, workers=1, part=(1, 2))
    assert not run(_TINY.changed(times=False), tmp_path / "b", workers=1, part=(1, 2)).strange
    for other, what in (
        (_TINY.changed(seed=1), "seed 0, here 1"),
        (_TINY.changed(times=True), "times False, here True"),
    ):
        done = run(other, tmp_path, workers=1, part=(2, 2))
        assert done.results is None
        said = f"{tmp_path / DONE}: made by another plan ({what}): for one result, give the same plan and options"
        assert f"{said} on every machine." in done.strange


def test_parts_do_not_depend_on_where_a_probes_file_lies(tmp_path):
    data = [encode_probe(Probe.from_arrays(*assets.make(name, 400))) for name in ("linear", "convex")]
    keys = []
    for first, second in (("a", "b"), ("z", "b")):
        files = [tmp_path / first / "x.ply", tmp_path / second / "y.ply"]
        for file, content in zip(files, data, strict=True):
            file.parent.mkdir(exist_ok=True)
            file.write_bytes(content)
        cells = SweepPlan(probes=tuple(map(str, files)), facets=(400,)).cells()
        keys.append([[cell.key for cell in task] for task in tasks_of(list(cells), 1)])
    assert keys[0] == keys[1]


def test_more_workers_have_more_tasks_and_no_cell_is_lost():
    cells = list(SweepPlan(forces=tuple(range(1, 101))).cells())
    few, many = tasks_of(cells, 1), tasks_of(cells, 100)
    assert max(map(len, few)) == 24
    assert len(many) >= 4 * 100
    assert sorted((cell for task in many for cell in task), key=repr) == sorted(cells, key=repr)


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize(("ending", "code"), [("SIGKILL", -9), ("SIGINT", 130)])
def test_stopped_in_the_middle_it_goes_on_and_a_torn_line_is_computed_again(
    tmp_path, alone, ending, code, workers
):
    plan = tmp_path / "tiny.toml"
    plan.write_text(
        'name = "tiny"\nprobes = ["linear", "convex"]\nfacets = [300, 500]\nforces = [9]\nangles = [0, 40]\n'
        'methods = ["contactbench", "algorithm1"]\ntouches = 40\n',
        encoding="utf-8",
    )
    out = tmp_path / "out"
    words = command("study", "run", plan, "--no-times", "--workers", workers, "--out", out)
    with subprocess.Popen(words, stderr=subprocess.DEVNULL) as process:
        until(lambda: _lines(out) >= 3, 120)
        process.send_signal(getattr(signal, ending))
        assert process.wait(60) in (code, 0)  # a fast machine may have finished
    kept = _lines(out)
    assert kept >= 3
    with (out / DONE).open("ab") as stream:
        stream.write(b'{"key": "torn')
    (out / RESULTS).unlink(missing_ok=True)
    assert run(_TINY, out, workers=1).computed == len(_TINY) - kept
    assert _table(out) == alone


def _lines(out):
    """Cells that are kept; the first line is not one."""
    return max((out / DONE).read_bytes().count(b"\n") - 1, 0) if (out / DONE).exists() else 0


def test_a_method_that_cannot_do_it_says_so_and_is_tried_again(tmp_path, monkeypatch):
    plan = _TINY.model_copy(update={"methods": ("contactbench", "wrench_axis"), "probes": ("linear",)})
    monkeypatch.setitem(sys.modules, "embreex.rtcore_scene", None)
    first = run(plan, tmp_path, workers=1)
    assert first.failed == len(plan) / 2
    rows = read_results(tmp_path).rows
    assert {row["method"] for row in rows if row["failed"]} == {"wrench_axis"}
    assert "needs Embree" in next(row["failed"] for row in rows if row["failed"])
    monkeypatch.undo()
    pytest.importorskip("embreex")
    second = run(plan, tmp_path, workers=1)
    assert (second.computed, second.failed) == (first.failed, 0)


def test_a_file_is_swept_up_to_its_own_mesh(tmp_path):
    file = tmp_path / "mine.ply"
    save_probe(Probe.from_arrays(*assets.make("convex", 800)), file)
    plan = SweepPlan(
        probes=(str(file),), facets=(300, 1_000, 2_000), methods=("contactbench",), touches=40, times=False
    )
    run(plan, tmp_path / "out", workers=1)
    results = read_results(tmp_path / "out")
    found = {row["facets"]: row["facets_found"] for row in results.rows}
    assert sorted(found) == [300, 1_000]
    assert abs(found[300] - 300) < 10
    assert 780 <= found[1_000] <= 820
    assert {row["probe"] for row in results.rows} == {"mine.ply"}
    assert {row["facets"]: row["exact"] for row in results.rows} == {300: False, 1_000: True}
    assert str(tmp_path) not in json.dumps([results.about, results.command, dict(results.environment)])


def test_the_environment_is_kept(small):
    results = read_results(small)
    assert {"contactbench", "python", "processor", "cores", "kernel", "numpy", "workers"} <= set(
        results.environment
    )
    assert results.command == "contactbench study run small.toml"
    assert results.about["plan"]["touches"] == 60


def test_wrong_folders_and_schedulers_are_named(tmp_path):
    (tmp_path / "file").write_text("x", encoding="utf-8")
    with pytest.raises(InputError, match="is a file"):
        run(_TINY, tmp_path / "file", workers=1)
    with pytest.raises(InputError, match=r"no connection .* check the address"):
        run(_TINY, tmp_path / "a", scheduler="nonsense://x")
    (tmp_path / DONE).write_text("no result\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 1: no result of a study"):
        Store(tmp_path, _ABOUT)
    with pytest.raises(InputError, match="no results of a study"):
        read_results(tmp_path)


class _Full:
    """A file on a full disk: it holds what it could not write, and tries again when it is closed."""

    def tell(self):
        return 1

    def write(self, data):
        return len(data)

    def flush(self):
        raise OSError(errno.ENOSPC, "No space left on device")

    close = flush


def test_a_full_disk_is_named_and_what_was_done_stays(tmp_path, monkeypatch):
    with Store(tmp_path, _ABOUT) as store:
        store.keep({"key": "a", "failed": ""})
        with store._stream:
            monkeypatch.setattr(store, "_stream", _Full())
        with pytest.raises(InputError, match=r"done\.jsonl: .*No space left.*free disk space"):
            store.keep({"key": "b", "failed": ""})
    with Store(tmp_path, _ABOUT) as store:
        assert list(store.rows) == ["a"]


def test_lists_in_lists_without_end_are_no_result(tmp_path):
    (tmp_path / DONE).write_text("[" * 100_000 + "\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 1: no result of a study"):
        Store(tmp_path, _ABOUT)


def test_errors_are_those_of_the_answers(rows):
    """Sure answers keep to the bound; where it is steep, to know that torsion is small is worth a third of it."""
    fine = [
        r for r in rows if r["facets"] == 1200 and r["method"] == "contactbench" and r["noise"] == "paper"
    ]
    assert all(0.8 < row["over_bound"] < 1.6 for row in fine if row["force"] < 20 and row["angle"] <= 30)
    assert all(0.6 < row["over_bound"] < 1.0 for row in fine if row["force"] < 20 and row["angle"] > 30)
    assert all(np.isclose(row["answered"], 1.0, atol=0.05) for row in fine)


# ---- plans: what a TOML file says, what is wrong with it, and what a cell is known by ------------


_GOOD = """
methods = ["contactbench", "algorithm1"]
probes = ["linear", "t-shape"]
facets = [500, 2000]
forces = [2, 9.5]
angles = [0, 30]
torsions = [0.0003]
noises = ["paper", "none"]
filters = ["none", "mean-50"]
touches = 20
seed = 7
most_facets = { algorithm1 = 500 }
"""


def _file(folder, text):
    file = folder / "My study.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_every_combination_is_a_cell_but_what_takes_too_long(tmp_path):
    plan = SweepPlan.read(_file(tmp_path, _GOOD))
    cells = plan.cells()
    assert plan.name == "my-study"
    assert len(plan) == len(cells) == 2 * 3 * 2 * 2 * 2 * 2
    assert {cell.facets for cell in cells if cell.method == "algorithm1"} == {500}
    assert len({cell.key for cell in cells}) == len(cells)
    assert {(cell.touches, cell.seed) for cell in cells} == {(20, 7)}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('methods = ["guess"]', "methods: 'guess' is none of contactbench"),
        ("forces = [0]", r"forces\.0: Input should be greater than 0"),
        ("forces = [nan]", r"forces\.0"),
        ("forces = []", "forces"),
        ('forces = ["much"]', r"forces\.0: Input should be a valid number"),
        ("angles = [90]", r"angles\.0: Input should be less than 90"),
        ("angles = [10, 10]", "angles: something is named twice"),
        ("facets = [10]", r"facets\.0: Input should be greater than or equal to 20"),
        ("torsions = [1]", r"torsions\.0"),
        ('noises = ["loud"]', "noises: 'loud' is none of none, ideal, paper"),
        ('filters = ["magic"]', "filters: 'magic' is none of none, mean-10"),
        ("touches = 1", "touches: Input should be greater than or equal to 10"),
        ("seed = -1", "seed"),
        ("colour = 3", "colour: Extra inputs are not permitted"),
        ("most_facets = { guess = 500 }", "most_facets: 'guess' is none of"),
        ('probes = ["a/x.ply", "b/x.ply"]', "probes: two probes are called x.ply"),
        ('name = "Ä"', "name"),
        ("forces = [", "the study cannot be read"),
    ],
)
def test_wrong_fields_are_named(tmp_path, line, said):
    file = _file(tmp_path, line)
    with pytest.raises(InputError, match=said) as caught:
        SweepPlan.read(file)
    assert str(file) in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"nowhere\.toml: the study cannot be read"):
        SweepPlan.read(tmp_path / "nowhere.toml")
    with pytest.raises(InputError, match=r"nowhere\.ply: the probe cannot be read.*linear, convex, t-shape"):
        SweepPlan(probes=(str(tmp_path / "nowhere.ply"),)).cells()[0].key  # noqa: B018 - it reads the file


def test_too_much_and_nothing_are_refused():
    with pytest.raises(InputError, match="cells are more than"):
        SweepPlan(forces=tuple(float(x) for x in range(1, 800)), facets=tuple(range(20, 1020))).cells()
    with pytest.raises(InputError, match="it leaves no cell"):
        SweepPlan(methods=("scan",), facets=(500,), most_facets={"scan": 100}).cells()


def test_methods_meshes_noises_and_filters_are_paired_on_the_same_touches():
    plan = SweepPlan(
        facets=(500, 800), noises=("none", "paper"), filters=("none", "mean-50"), forces=(2.0, 9.0)
    )
    seeds = {(cell.probe, cell.force, cell.angle): set() for cell in plan.cells()}
    for cell in plan.cells():
        seeds[cell.probe, cell.force, cell.angle].add(cell.touch_seed)
    assert all(len(each) == 1 for each in seeds.values())
    assert len(set.union(*seeds.values())) == len(seeds)
    assert SweepPlan(seed=1).cells()[0].touch_seed != SweepPlan(seed=2).cells()[0].touch_seed


def test_a_file_is_known_by_what_is_in_it_not_by_where_it_lies(tmp_path):
    first, second, third = (tmp_path / name / "mine.ply" for name in "abc")
    for file, facets in ((first, 400), (third, 500)):
        file.parent.mkdir()
        save_probe(Probe.from_arrays(*assets.make("linear", facets)), file)
    second.parent.mkdir()
    shutil.copy(first, second)
    cells = [SweepPlan(probes=(str(file),)).cells()[0] for file in (first, second, third)]
    assert cells[0].key == cells[1].key != cells[2].key
    assert cells[0].touch_seed == cells[1].touch_seed != cells[2].touch_seed
    assert label(str(first)) == "mine.ply"


def test_presets_are_whole_and_can_be_changed():
    for name in ("paper", "quick", "resolution", "steep"):
        assert preset_plan(name).name == name
        assert len(preset_plan(name)) == len(preset_plan(name).cells())
    plan = preset_plan("quick").changed(["convex"], 50, 3)
    assert (plan.probes, plan.touches, plan.seed) == (("convex",), 50, 3)
    assert plan.changed() == plan
    with pytest.raises(InputError, match="choose one of paper, quick, resolution, steep"):
        preset_plan("slow")
