"""Plans: what a TOML file says, what is wrong with it, and what a cell is known by."""

import shutil

import pytest

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.save import save_probe
from contactbench.pipeline.study.sweep.plan import SweepPlan, label, preset_plan

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
