"""A bundle that is written over another: whatever fails, and wherever it is killed, one of the two loads by name."""

import errno
import os
import signal
import subprocess
import sys
import threading

import pytest
from config.runtime.bundles import example

from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig, swap
from contactbench.pipeline.config.runtime.swap import exchange

CALLS = ("mkdir", "fsync", "rename", "unlink", "rmdir", "replace")


class Killed(BaseException):
    """The process is gone: nothing that it does after this reaches the disk."""


class Killing:
    """From the n-th call of its own thread on nothing happens, or it fails once; other threads go on."""

    def __init__(self, patch, at, *, fails=False, after=False):
        self.count, self.at, self.fails, self.after = 0, at, fails, after
        self.thread = threading.get_ident()
        for name in CALLS:
            patch.setattr(os, name, self.wrap(getattr(os, name)))
        patch.setattr(swap, "exchange", self.wrap(swap.exchange))

    def wrap(self, real):
        def call(*arguments, **named):
            if threading.get_ident() != self.thread:
                return real(*arguments, **named)
            self.count += 1
            if self.fails and self.count == self.at:
                raise OSError(errno.EIO, os.strerror(errno.EIO))
            if not self.fails and self.count >= self.at:
                if self.after and self.count == self.at:
                    real(*arguments, **named)
                raise Killed
            return real(*arguments, **named)

        return call


def standing(path):
    """Return whether the bundle there is the verified one; it must load."""
    return RuntimeConfig.load(path).model.verified


@pytest.fixture(scope="module")
def configs():
    return example(300), example(300, verified=False)


@pytest.mark.parametrize(("name", "exchanges"), [("b", True), ("b", False), ("b.zip", True)])
@pytest.mark.parametrize("how", [{"fails": True}, {"after": False}, {"after": True}])
def test_the_old_or_the_new(tmp_path, configs, monkeypatch, name, exchanges, how):
    if not exchanges:
        monkeypatch.setattr(swap, "exchange", lambda *_: False)
    old, new = configs
    seen, at = set(), 0
    while True:
        at += 1
        path = tmp_path / f"{at}" / name
        old.write(path)
        with pytest.MonkeyPatch.context() as patch:
            calls = Killing(patch, at, **how)
            try:
                new.write(path)
                ended = True
            except (ConfigError, Killed):
                ended = False
        verified = standing(path)
        seen.add(verified)
        assert not (ended and verified)
        # And what is left over is in nobody's way.
        new.write(path)
        assert not standing(path)
        if calls.count < at:
            break
    assert seen == {True, False}
    assert at > 3
    assert [file.name for file in path.parent.iterdir()] == [name]


def test_exchange_swaps_two_folders(tmp_path):
    for name in "ab":
        (tmp_path / name).mkdir()
        (tmp_path / name / name).write_text(name, encoding="utf-8")
    if not exchange(tmp_path / "a", tmp_path / "b"):
        pytest.skip("this system cannot exchange two names")
    assert [file.name for file in (tmp_path / "a").iterdir()] == ["b"]
    with pytest.raises(OSError, match="No such file"):
        exchange(tmp_path / "a", tmp_path / "none")


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL")
def test_a_writer_that_is_killed(tmp_path, configs):
    old, new = configs
    for name, config in (("old", old), ("new", new)):
        config.write(tmp_path / name)
    old.write(tmp_path / "b")
    script = (
        "import sys; from contactbench.pipeline.config.runtime import RuntimeConfig as C\n"
        "one, other = C.load('new'), C.load('old')\n"
        "print('ready', flush=True)\n"
        "while True: one.write('b'); other.write('b'); print('again', flush=True)\n"
    )
    for times in (1, 3):
        with subprocess.Popen(
            [sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE
        ) as process:
            assert process.stdout.readline() == b"ready\n"
            assert [process.stdout.readline() for _ in range(times)] == times * [b"again\n"]
            process.send_signal(signal.SIGKILL)
        assert standing(tmp_path / "b") in (True, False)
