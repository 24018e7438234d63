"""Short tones for what is not looked at; silent where nothing can be played."""

import io
import logging
import os
import sys
import tempfile
import wave
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, QUrl
from PySide6.QtWidgets import QApplication

RATE = 44_100
# Name -> notes of (Hz, s): up for good, down for bad, told apart also by their number.
TONES: Mapping[str, tuple[tuple[float, float], ...]] = {
    "touching": ((440.0, 0.06),),
    "settled": ((660.0, 0.08),),
    "accepted": ((660.0, 0.08), (990.0, 0.14)),
    "rejected": ((330.0, 0.12), (220.0, 0.2)),
    "done": ((523.0, 0.1), (659.0, 0.1), (784.0, 0.2)),
}
_BEEPS = ("accepted", "rejected", "done")
_VOLUME, _FADE_S = 0.35, 0.008
_log = logging.getLogger(__name__)


def tone(notes: tuple[tuple[float, float], ...]) -> bytes:
    """Return notes of (Hz, s) as a WAV file, mono, 16 bits; each fades in and out, so that nothing clicks."""
    parts = []
    for frequency, seconds in notes:
        t = np.arange(round(seconds * RATE)) / RATE
        fade = np.minimum(1.0, np.minimum(t, seconds - t) / _FADE_S)
        parts.append(fade * np.sin(2 * np.pi * frequency * t))
    samples = np.round(_VOLUME * 32767 * np.concatenate(parts)).astype("<i2")
    out = io.BytesIO()
    with wave.open(out, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.tobytes())
    return out.getvalue()


class Sounds(QObject):
    """
    Plays a tone for a state.

    Attributes
    ----------
    muted : bool
    played : list of str
        The last ones, newest last: for who cannot hear them.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.muted = False
        self.played: list[str] = []
        self._effects: dict[str, Any] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def play(self, name: str) -> None:
        """Play one of `TONES`; others are silent. Never waits, never fails."""
        if self.muted or name not in TONES:
            return
        self.played = [*self.played[-19:], name]
        if self._effects is None:
            self._effects = self._made()
        effect = self._effects.get(name)
        if effect is not None:
            effect.play()
        elif name in _BEEPS:
            QApplication.beep()

    def _made(self) -> dict[str, Any]:
        """Make the effects; none where there is no QtMultimedia or no audio device."""
        with _quiet():
            try:
                from PySide6.QtMultimedia import QMediaDevices, QSoundEffect
            except ImportError:
                return {}
            if not QMediaDevices.audioOutputs():
                return {}
            try:
                self._folder = tempfile.TemporaryDirectory(prefix="contactbench-", ignore_cleanup_errors=True)
                return {name: self._effect(QSoundEffect, name) for name in TONES}
            except OSError as error:
                _log.info("no sounds: %s", error)
                return {}

    def _effect(self, kind: Any, name: str) -> Any:
        assert self._folder is not None  # noqa: S101  (for the type checker)
        file = Path(self._folder.name) / f"{name}.wav"
        file.write_bytes(tone(TONES[name]))
        effect = kind(self)
        effect.setSource(QUrl.fromLocalFile(str(file)))
        return effect

    def close(self) -> None:
        """Give devices and files back."""
        for effect in (self._effects or {}).values():
            effect.stop()
            effect.deleteLater()
        self._effects = {}
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep what audio libraries print by themselves from the console: it is about pipewire, and helps nobody."""
    try:
        place = sys.__stderr__.fileno() if sys.__stderr__ is not None else -1
        kept = os.dup(place)
    except (OSError, ValueError):
        yield
        return
    try:
        with Path(os.devnull).open("wb") as nowhere:
            os.dup2(nowhere.fileno(), place)
        yield
    finally:
        with suppress(OSError):
            os.dup2(kept, place)
        os.close(kept)
