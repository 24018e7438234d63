"""What a real bench adds is declared once: the text that names it is read back, and what is wrong is named."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import MIXES, Reality

_SIZES = {
    name: st.floats(*Reality.limits(name), allow_nan=False).map(lambda x: x + 0.0)
    for name in Reality.model_fields
}


@given(st.fixed_dictionaries({}, optional=_SIZES))
def test_what_is_written_is_read_back(sizes: dict[str, float]) -> None:
    reality = Reality(**sizes)
    assert Reality.parse(str(reality)) == reality
    address = f"virtual://bench?reality={reality}"
    again = DeviceAddress.parse(str(DeviceAddress.parse(address)))
    assert again.bench is not None
    assert again.bench.reality == reality


@pytest.mark.parametrize("name", MIXES)
def test_a_mix_is_written_by_its_name(name: str) -> None:
    assert str(MIXES[name]) == name
    assert Reality.parse(name) == MIXES[name]


def test_the_nearest_mix_makes_the_text_short() -> None:
    assert str(MIXES["typical"].model_copy(update={"cable": 0.2})) == "typical,cable=0.2"
    assert str(Reality(cable=0.2, mount=5)) == "cable=0.2,mount=5"


def test_the_ideal_bench_has_no_effect_on() -> None:
    assert MIXES["ideal"].on == ()
    assert Reality(scale=1.002, cable=1).on == ("cable", "scale")


def test_effects_are_taken_alone_and_away() -> None:
    typical = MIXES["typical"]
    assert typical.only("scale", "cable") == Reality(scale=typical.scale, cable=typical.cable)
    assert typical.without("scale").scale == 1.0
    assert typical.without("scale").cable == typical.cable


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("good", "there is no mix 'good': start with one of ideal, typical, harsh"),
        ("typical,harsh", "'harsh' must stand alone"),
        ("cables=1", "there is no effect 'cables': choose from cable, drag"),
        ("cable=much", "cable 'much': give a number, N"),
        ("cable=-1", r"cable -1: .*greater than or equal to 0 \(N\)"),
        ("lens=nan", r"lens nan: .* \(mm\)"),
        ("cable=1,cable=2", "cable appears twice"),
        ("", "there is no mix ''"),
    ],
)
def test_what_is_wrong_is_named(text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        Reality.parse(text)
    with pytest.raises(AddressError, match=said.replace("reality: ", "")):
        DeviceAddress.parse(f"virtual://bench?reality={text}&seed=1")


def test_an_address_without_it_is_written_as_before() -> None:
    text = "virtual://bench?rate=200&probe=t-shape&sensor=paper&seed=0&pose_rate=50"
    assert str(DeviceAddress.parse("virtual://bench")) == text


def test_every_effect_says_its_unit() -> None:
    for name, field in Reality.model_fields.items():
        assert field.description
        assert 1 <= len(Reality.unit(name)) < 30, name
