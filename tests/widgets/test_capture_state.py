import pytest

from contactbench.pipeline.calibration.stillness import StillState
from contactbench.widgets.coverage import CaptureState


@pytest.fixture
def shown(seen):
    return seen(CaptureState(), 330, 100)


def test_each_state_has_its_own_word_and_shape(shown):
    words, pictures = set(), []
    for state in StillState:
        shown.show_state(state, share=0.5)
        words.add(shown.word)
        assert shown.line
        assert shown.accessibleName() == shown.word
        image = shown.grab().toImage().copy(0, 0, 100, 100)  # the icon alone
        image = image.convertToFormat(image.Format.Format_Grayscale8)
        assert image not in pictures
        pictures.append(image)
    assert len(words) == len(StillState)


def test_the_key_is_asked_for_and_the_capture_confirmed(shown):
    shown.show_state(StillState.STILL, by_key=True)
    assert shown.word == "still: press SPACE"
    shown.show_state(StillState.STILL, by_key=True, wanted=True)
    assert shown.word == "still"
    shown.show_state(StillState.STILL, by_key=True, captured=True)
    assert shown.word == "captured"
    shown.show_state(StillState.SETTLING, seconds=0.84)
    assert shown.word == "settling 0.8 s"
    shown.show_idle()
    assert shown.word == "not started"


def test_the_ring_fills(shown):
    shown.show_state(StillState.STILL, share=0.1)
    little = shown.grab().toImage()
    shown.show_state(StillState.STILL, share=0.9)
    assert shown.grab().toImage() != little


def test_long_words_stay_inside(shown):
    shown.resize(200, 100)
    shown.show_state(StillState.SETTLING, seconds=12.3)
    picture = shown.grab().toImage()
    plain = picture.pixel(199, 2)
    assert all(picture.pixel(199, y) == plain for y in range(0, 100, 3))
