"""Lines on standard error, and signals."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor

import pytest

from contactbench.pipeline.console import ended_by_signals, printable, say


def test_control_characters_are_replaced_and_line_feeds_stay() -> None:
    controls = "".join(map(chr, (*range(10), *range(11, 32), *range(127, 160))))
    assert printable(f"a{controls}b\nü°·") == f"a{len(controls) * chr(0xFFFD)}b\nü°·"


def test_a_line_is_one_line_of_text(capsys: pytest.CaptureFixture[str]) -> None:
    say("a\nb\x1b[2J [bold]c[/bold] \udcff", "red")
    assert capsys.readouterr().err == "a b\ufffd[2J [bold]c[/bold] ?\n"


@pytest.mark.skipif(os.name != "posix", reason="this system sends itself no signals")
def test_what_was_ignored_stays_so_and_the_rest_ends_it() -> None:
    heard = (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)
    before = {each: signal.signal(each, signal.SIG_DFL) for each in heard}
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        with ended_by_signals() as ended:
            signal.raise_signal(signal.SIGHUP)
            assert not ended.asked
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
        with ended_by_signals() as ended:
            signal.raise_signal(signal.SIGTERM)
            assert ended.asked
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN  # it is about to end, and is not killed
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def test_another_thread_hears_no_signal() -> None:
    def asked() -> bool:
        with ended_by_signals() as ended:
            return ended.asked

    with ThreadPoolExecutor(1) as pool:
        assert not pool.submit(asked).result()
