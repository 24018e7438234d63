"""How a command is declared, lines on standard error, and signals."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import pytest
from typer.testing import CliRunner

from contactbench.pipeline.console import Noun, ended_by_signals, flat, printable, say


@dataclass
class Light:
    """A lamp.

    Parameters
    ----------
    colour_ : #RRGGBB
        Its colour.
    """

    colour_: str = "#ffffff"


def _look(
    places: list[str],
    /,
    light: Light,
    at: list[tuple[float, float]],
    toward: tuple[float, float, float] = (0, 0, 1.5),
    up: tuple[float, float, float] | None = None,
    near_by: bool = False,
    far: bool = True,
) -> None:
    """Look at places.

    Parameters
    ----------
    places : PLACE...
        Where to look,
        one after the other.
    at : X,Y
        Where to stand.
    toward : X,Y,Z
        Where to.
    up : X,Y,Z
        What is up.
    near_by
        Also near by.
    far
        Also far away.
    """
    print(places, light, at, toward, up, near_by, far)  # noqa: T201


def _run(*words: str) -> str:
    noun = Noun()
    noun.command(example="look")(_look)
    return CliRunner().invoke(noun, words, env={"COLUMNS": "300"}).output


def test_a_command_is_declared_by_its_signature_and_docstring() -> None:
    assert _run("a", "b", "--at", "1,2", "--at", "3,-4") == (
        "['a', 'b'] Light(colour_='#ffffff') [(1.0, 2.0), (3.0, -4.0)] (0.0, 0.0, 1.5) None False True\n"
    )
    options = "--at 1,2 --toward 1,0,0 --up 0,1,0 --near-by --no-far --colour red"
    assert _run("a", *options.split()) == (
        "['a'] Light(colour_='red') [(1.0, 2.0)] (1.0, 0.0, 0.0) (0.0, 1.0, 0.0) True False\n"
    )
    assert "--up needs 3 finite numbers separated by commas, not '0,1'" in _run("a", "--at=1,2", "--up=0,1")


def test_the_help_of_a_command_is_its_docstring() -> None:
    lines = [" ".join(line.split()) for line in _run("--help").splitlines()]
    assert "Look at places." in lines
    assert "Parameters" not in lines
    assert "PLACE... <list[str]> Where to look, one after the other. [required]" in lines
    assert "--toward X,Y,Z Where to. [default: 0,0,1.5]" in lines
    assert "--colour #RRGGBB Its colour. [default: #ffffff]" in lines
    assert "--near-by Also near by." in lines
    assert "--far / --no-far Also far away. [default: far]" in lines


def test_a_docstring_describes_no_parameter_that_is_not_there() -> None:
    def gone() -> None:
        """Go.

        Parameters
        ----------
        where
            Where to.
        """

    with pytest.raises(ValueError, match="gone documents where"):
        flat(gone)


def test_control_characters_are_replaced_and_line_feeds_stay() -> None:
    controls = "".join(map(chr, (*range(10), *range(11, 32), *range(127, 160))))
    assert printable(f"a{controls}b\nü°·") == f"a{len(controls) * chr(0xFFFD)}b\nü°·"


def test_a_line_is_one_line_of_text(capsys: pytest.CaptureFixture[str]) -> None:
    say("a\nb\x1b[2J [bold]c[/bold] \udcff")
    say("wrong", "red")
    assert capsys.readouterr() == ("a b\ufffd[2J [bold]c[/bold] ?\n", "wrong\n")


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
