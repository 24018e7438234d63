"""How a probe's face lies on soft tissue, told from one wrench: against beds made of other places, and the bench."""

import csv

import numpy as np
import pytest
from scipy.optimize import brentq

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.contact.patch import Bed, LivePatch, PatchReader, spread
from contactbench.pipeline.contact.stream import locate_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.marker_touches import model_of

FORCE, MODULUS = 7.0, 3e6
TRUE = Bed(modulus=MODULUS, factor=1.0)
SURE = np.diag([1e-12, 1e-12, 1e-12])


@pytest.fixture(scope="module", params=["convex", "linear", "t-shape"])
def probe(request):
    return model_of(request.param, 2000)


def block(a, b, height=0.05):
    """A box of 2 a by 2 b, its flat face towards +z."""
    corners = np.array([[x, y, z] for x in (-a, a) for y in (-b, b) for z in (0.0, height)])
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    faces += [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return Probe.from_arrays(corners, np.array(faces, dtype=np.int32), name="block")


def pressed(probe, lean, curvature=(0.0, 0.0), count=4000):
    """Centre of pressure, middle and balance of a bed of other springs than those of the reader."""
    places, _, area = spread(probe, count)
    xi = places[:, :2] - places[:, :2].mean(axis=0)
    gaps = places[:, 2].max() - places[:, 2] + 0.5 * xi**2 @ np.array(curvature)

    def deep(depth):
        return np.maximum(depth + xi @ np.array(lean) - gaps, 0.0)

    depths = deep(brentq(lambda d: MODULUS * area * deep(d).sum() - FORCE, -0.02, 0.02))
    middle = places[depths > 0].mean(axis=0)
    balance = depths @ np.sign(places[:, :2] - middle[:2]) / depths.sum()
    return depths @ places / depths.sum(), middle, balance


@pytest.mark.parametrize("lean", [(0.0, 0.0), (0.04, 0.0), (0.0, 0.02), (-0.06, 0.02)])
def test_the_lean_is_that_of_the_bed(probe, lean):
    pressure, middle, balance = pressed(probe, lean)
    patch = PatchReader(probe, TRUE).read([0, 0, -FORCE], pressure, SURE)
    assert patch.lean == pytest.approx(lean, abs=0.004)
    assert patch.offset == pytest.approx((pressure - middle)[:2], abs=4e-4)
    assert patch.balance == pytest.approx(balance, abs=0.05)
    assert patch.pressure_S == pytest.approx(pressure, abs=1e-4)


def test_on_a_flat_rectangle_the_balance_is_known():
    """Pressure that grows evenly across it: one and a half times the offset over half the width (while all touches)."""
    patch = PatchReader(block(0.02, 0.01), TRUE).read([0, 0, -FORCE], [0.004, -0.001, 0.05], SURE)
    assert patch.area == pytest.approx(8e-4, rel=0.05)
    assert patch.balance == pytest.approx([1.5 * 0.004 / 0.02, -1.5 * 0.001 / 0.01], abs=0.02)
    assert patch.offset == pytest.approx([0.004, -0.001], abs=1e-4)


def test_a_force_that_slides_moves_nothing_where_its_line_is_followed():
    reader = PatchReader(block(0.02, 0.01), TRUE)
    straight = reader.read([0, 0, -FORCE], [0.003, 0.0, 0.05], SURE)
    aslant = reader.read([2.0, 0, -FORCE], [0.003, 0.0, 0.05], SURE)
    assert aslant.lean == pytest.approx(straight.lean, abs=1e-6)


def test_the_spread_holds_the_truth():
    probe = model_of("t-shape", 2000)
    pressure, _, _ = pressed(probe, (0.02, 0.0))
    sigma, rng = 4e-4, np.random.default_rng(1)
    reader, held = PatchReader(probe, TRUE), 0
    for _ in range(60):
        noisy = pressure + [*rng.normal(0, sigma, 2), 0]
        patch = reader.read([0, 0, -FORCE], noisy, np.diag([sigma**2, sigma**2, 0]))
        held += abs(patch.lean[0] - 0.02) < 2 * patch.lean_sigma[0]
    assert 52 <= held <= 60  # 95 % are expected


def test_a_modulus_that_is_only_nearly_known_widens_the_spread():
    probe = model_of("convex", 2000)
    pressure, _, _ = pressed(probe, (0.05, 0.0))
    sure = PatchReader(probe, TRUE).read([0, 0, -FORCE], pressure, SURE)
    unsure = PatchReader(probe, Bed(modulus=1.5e6, factor=3.0)).read([0, 0, -FORCE], pressure, SURE)
    assert abs(unsure.offset[0] - sure.offset[0]) < 2 * unsure.offset_sigma[0]
    assert unsure.offset_sigma[0] > 10 * sure.offset_sigma[0]


def test_a_body_that_bulges_is_not_taken_for_a_lean():
    probe = model_of("t-shape", 2000)
    curvature = (1 / 0.1, 0.0)
    pressure, middle, _ = pressed(probe, (0.03, 0.0), curvature)
    patch = PatchReader(probe, Bed(curvature, MODULUS, 1.0)).read([0, 0, -FORCE], pressure, SURE)
    assert patch.lean[0] == pytest.approx(0.03, abs=0.004)
    assert patch.offset[0] == pytest.approx((pressure - middle)[0], abs=1e-3)
    flat = PatchReader(probe, TRUE).read([0, 0, -FORCE], pressure, SURE)
    assert abs(flat.lean[0] - 0.03) > 0.01


@pytest.mark.parametrize(
    ("force", "point"),
    [
        ([0, 0, 7.0], [0, 0, 0.05]),  # pulls
        ([0, 0, -7.0], [0.0199, 0, 0.05]),  # on the rim: an edge, not a patch
        ([0, 0, -7.0], [0.5, 0, 0.05]),
        ([0, 0, np.nan], [0, 0, 0.05]),
        ([0, 0, -7.0], [np.nan, 0, 0.05]),
        ([0, 0, -1e6], [0, 0, 0.05]),  # deeper than a face is
    ],
)
def test_where_no_patch_shows_there_is_none(force, point):
    assert PatchReader(block(0.02, 0.01), TRUE).read(force, point, 1e-6 * np.eye(3)) is None


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"curvature": (0.0, np.nan)}, "Bed.curvature"),
        ({"curvature": (500.0, 0.0)}, "within ±100 1/m"),
        ({"modulus": 0.0}, "Bed.modulus 0.0: give a pressure per depth above 0"),
        ({"factor": 0.5}, "Bed.factor 0.5"),
    ],
)
def test_a_bed_that_makes_no_sense_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        Bed(**given)


def test_it_says_what_it_found():
    patch = PatchReader(block(0.02, 0.01), TRUE).read([0, 0, -FORCE], [0.004, 0.0, 0.05], 1e-8 * np.eye(3))
    assert patch.sentence.startswith(
        "The point is the centre of pressure of a patch of 8.3 cm²: +4.0 ± 0.1 mm along"
    )
    tilt, sigma = np.degrees(patch.lean), np.degrees(patch.lean_sigma)
    assert f"at a tilt of {tilt[0]:+.1f} ± {sigma[0]:.1f}° along x" in patch.sentence
    assert "the force is 35/65" in patch.sentence


@pytest.mark.parametrize(
    ("text", "curvature"), [("flat", (0, 0)), ("80,0", (12.5, 0)), (" -40, 50", (-25, 20)), ("0,0", (0, 0))]
)
def test_a_shape_is_read(text, curvature):
    assert Bed.parse(text).curvature == pytest.approx(curvature)


@pytest.mark.parametrize("text", ["round", "80", "1,2,3", "5,0", "nan,0", ""])
def test_what_is_no_shape_is_refused(text):
    with pytest.raises(InputError, match=r"give (flat|two numbers)"):
        Bed.parse(text)


class _Contact:
    def __init__(self, x, accepted=True):
        self.accepted, self.point, self.covariance = accepted, np.array([x, 0, 0.05]), 1e-8 * np.eye(3)


def test_a_stream_is_read_ten_times_a_second_and_says_nothing_of_no_contact():
    live, force = LivePatch(PatchReader(block(0.02, 0.01), TRUE)), [0, 0, -FORCE]
    first = live.read(1.0, force, _Contact(0.004))
    assert first.offset[0] == pytest.approx(0.004, abs=1e-4)
    assert live.read(1.09, force, _Contact(0.001)) is first
    assert live.read(1.11, force, _Contact(0.001)).offset[0] == pytest.approx(0.001, abs=1e-4)
    assert live.read(1.12, force, None) is None
    assert live.read(1.30, force, _Contact(0.004, accepted=False)) is None
    assert live.read(0.0, force, _Contact(0.004)).offset[0] == pytest.approx(
        0.004, abs=1e-4
    )  # another stream


def test_a_file_of_contacts_gets_columns_more(tmp_path):
    probe = block(0.02, 0.01)
    source, out = tmp_path / "wrenches.csv", tmp_path / "contacts.csv"
    wrench = np.concatenate([[0, 0, -FORCE], np.cross([0.004, 0, 0.05], [0, 0, -FORCE])])
    lines = [",".join(map(repr, [float(t), *map(float, row)])) for t, row in enumerate((wrench, np.zeros(6)))]
    source.write_text("\n".join(["t,fx,fy,fz,mx,my,mz", *lines, ""]))
    locate_file(ContactSolver(probe), source, out, patches=PatchReader(probe, TRUE))
    with out.open(newline="") as stream:
        pressed_, free = csv.DictReader(stream)
    assert float(pressed_["offset_x_mm"]) == pytest.approx(4, abs=0.1)
    assert float(pressed_["balance_x"]) == pytest.approx(0.3, abs=0.02)
    assert float(pressed_["centre_z"]) == pytest.approx(0.05)
    assert {free[name] for name in ("centre_x", "offset_x_mm", "balance_x", "balance_sigma_y")} == {""}


@pytest.mark.parametrize("tilt", [-0.03, 0.0, 0.05])
def test_the_bench_agrees(tilt):
    pytest.importorskip("mujoco", reason="the virtual bench needs MuJoCo (extra sim)")
    from press_scene import PressScene, still

    from contactbench.pipeline.simulation.scenes.physics import TrueSurface
    from contactbench.pipeline.simulation.scenes.platform import Tissue

    probe = model_of("t-shape", 2000)
    scene = PressScene(TrueSurface(probe), still(0, 0, -0.003, 0, tilt, 0), Tissue(modulus=MODULUS))
    scene.advance(0.4)
    moment = scene.moment()
    patch = PatchReader(probe, TRUE).read(moment.contact[:3], moment.point_S, SURE)
    assert patch.lean[0] == pytest.approx(tilt, abs=0.008)
    assert np.linalg.norm(patch.pressure_S[:2] - moment.centroid_S[:2]) < 3e-4
