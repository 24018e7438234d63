"""Lines on standard error."""

import pytest

from contactbench.pipeline.console import printable, say


def test_control_characters_are_replaced_and_line_feeds_stay() -> None:
    controls = "".join(map(chr, (*range(10), *range(11, 32), *range(127, 160))))
    assert printable(f"a{controls}b\nü°·") == f"a{len(controls) * chr(0xFFFD)}b\nü°·"


def test_a_line_is_one_line_of_text(capsys: pytest.CaptureFixture[str]) -> None:
    say("a\nb\x1b[2J [bold]c[/bold] \udcff", "red")
    assert capsys.readouterr().err == "a b\ufffd[2J [bold]c[/bold] ?\n"
