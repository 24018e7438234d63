"""Tones: short, each of its own, and never in the way."""

import io
import sys
import wave

import numpy as np
import pytest

from contactbench.widgets.sounds import RATE, TONES, Sounds, tone


def samples(name):
    with wave.open(io.BytesIO(tone(TONES[name]))) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2")


@pytest.mark.parametrize("name", TONES)
def test_a_tone_is_short_begins_and_ends_in_silence_and_is_not_too_loud(name):
    played = samples(name)
    assert 0.03 < len(played) / RATE < 0.6
    assert abs(int(played[0])) < 400
    assert abs(int(played[-1])) < 2_000
    assert 5_000 < np.abs(played).max() < 20_000


def test_a_tone_has_the_pitch_that_it_should():
    played = samples("touching")
    peak = np.argmax(np.abs(np.fft.rfft(played * np.hanning(len(played)), 1 << 16)))
    assert peak * RATE / (1 << 16) == pytest.approx(TONES["touching"][0][0], rel=0.03)
    assert len(set(TONES.values())) == len(TONES)


def test_who_mutes_it_hears_nothing(qapp):  # noqa: ARG001
    sounds = Sounds()
    sounds.muted = True
    sounds.play("accepted")
    sounds.play("nothing of that name")
    assert sounds.played == []


def test_without_multimedia_nothing_fails_and_nothing_is_printed(qapp, monkeypatch, capfd):  # noqa: ARG001
    monkeypatch.setitem(sys.modules, "PySide6.QtMultimedia", None)
    sounds = Sounds()
    for name in TONES:
        sounds.play(name)
    assert sounds.played == list(TONES)
    sounds.close()
    assert capfd.readouterr().err == ""


def test_what_audio_libraries_print_does_not_reach_the_console(qapp, capfd):  # noqa: ARG001
    sounds = Sounds()
    sounds.play("accepted")
    sounds.close()
    assert "pipewire" not in capfd.readouterr().err
