import pytest
from benchmarks.window.screenshots import run
from PySide6.QtGui import QImage

from contactbench.pipeline.errors import InputError

pytestmark = pytest.mark.usefixtures("qapp")


def test_the_first_page_in_both_themes_as_large_as_asked(tmp_path):
    assert run(tmp_path, ("light", "dark"), (1100, 720), ("start",)) == 0
    assert sorted(file.name for file in tmp_path.iterdir()) == ["start-dark.png", "start.png"]
    light, dark = (QImage(str(tmp_path / name)) for name in ("start.png", "start-dark.png"))
    assert light.size().toTuple() == dark.size().toTuple() == (1100, 720)
    assert light.pixelColor(20, 400).lightness() > 200 > 80 > dark.pixelColor(20, 400).lightness()


@pytest.mark.window
@pytest.mark.timeout(400)
def test_a_page_with_its_scene(tmp_path):
    run(tmp_path, pages=("verify", "heatmap"))
    for name in ("verify.png", "heatmap.png"):
        picture = QImage(str(tmp_path / name))
        seen = {picture.pixelColor(x, y).rgb() for y in range(150, 400, 25) for x in range(200, 860)}
        assert len(seen) > 60, f"{name}: the probe is shaded"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"pages": ("start", "end")}, "no page 'end': choose of start, devices"),
        ({"themes": ("blue",)}, "no theme 'blue'"),
        ({"size": (100_000, 800)}, "does not fit on this screen"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, given, said):
    with pytest.raises(InputError, match=said):
        run(tmp_path / "out", **given)
    assert not (tmp_path / "out").exists()
