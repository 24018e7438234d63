"""Scripts that are wrong say where and how."""

import pytest
from simulation.virtual.script_text import script_text

from contactbench.pipeline.simulation.virtual.commands import ScriptError, parse_script, read_script

_HUGE = "1" + "0" * 400  # more than a double holds


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("touch 3", "not valid JSON"),
        ("[1]", "not a JSON object"),
        ('{"do": "release"}', "either at or after"),
        ('{"at": 1, "after": 1, "do": "release"}', "either at or after"),
        ('{"at": -1, "do": "release"}', "at -1: give seconds"),
        ('{"at": "2", "do": "release"}', "at '2': give seconds"),
        ('{"at": NaN, "do": "release"}', "at nan: give seconds"),
        ('{"at": 1}', "do None: choose one of turn_to"),
        ('{"at": 1, "do": ["touch"]}', "choose one of turn_to"),
        ('{"at": 1, "do": "touch"}', "either marker"),
        ('{"at": 1, "do": "touch", "marker": 1.5}', "whole number"),
        ('{"at": 1, "do": "touch", "marker": 1, "forse": 1}', "unknown key 'forse'"),
        ('{"at": 1, "do": "touch", "marker": 1, "force": "9"}', "force '9': give a finite number"),
        ('{"at": 1, "do": "touch", "marker": 1, "force": 1e9}', "0 to 1000 N"),
        ('{"at": 1, "do": "touch", "marker": 1, "seconds": 0}', "positive number"),
        ('{"at": 1, "do": "touch", "point_S": [0, 0]}', "give 3 finite numbers"),
        ('{"at": 1, "do": "turn_to"}', "either rpy"),
        ('{"at": 1, "do": "turn_to", "rpy": [0, 0, "x"]}', "give 3 finite"),
        ('{"at": 1, "do": "turn_to", "R_WS": [[1,0,0],[0,1,0],[0,0,-1]]}', "not a rotation"),
        ('{"at": 1, "do": "bump"}', "some of these are missing"),
        ('{"at": 1, "do": "bump", "force": [1, 2, Infinity]}', "give 3 finite"),
        ('{"at": 1, "do": "bump", "force": [1, 2, 3], "seconds": null}', "seconds null"),
        ('{"at": 1, "do": "bump", "force": [800, 800, 0]}', "at most 1000 N"),
        ('{"at": 1, "do": "bump", "force": [8, 8, 0], "lever": [20, 0, 0]}', "at most 10 m"),
        ('{"at": 1, "do": "touch", "marker": 1, "torsion": 11}', "at most 10 N"),
        (f'{{"at": {_HUGE}, "do": "end"}}', "...: give seconds"),
        (f'{{"at": 1, "do": "warm", "kelvin": {_HUGE}}}', "...: give a finite number"),
        (f'{{"at": 1, "do": "turn_to", "rpy": [{_HUGE}, 0, 0]}}', "...: give 3 finite"),
        ('{"at": 90000, "do": "end"}', "at most 86,400"),
        ('{"at": 1, "do": "warm", "kelvin": 1000}', "at most 100 K"),
        ('{"at": 1, "do": "release", "seconds": 1}', "Possible: nothing"),
    ],
)
def test_a_wrong_line_is_named(line, message):
    with pytest.raises(ScriptError) as error:
        parse_script(f"# a comment\n\n{line}\n", "bench.jsonl")
    assert str(error.value).startswith("bench.jsonl, line 3: ")
    assert message in str(error.value)


def test_a_script_in_the_wrong_order_is_refused():
    with pytest.raises(ScriptError, match="line 2: at 1 s is before 2 s"):
        parse_script('{"at": 2, "do": "release"}\n{"at": 1, "do": "release"}', "a")


def test_a_command_that_would_come_after_the_longest_run_is_refused():
    wait = '{"after": 50000, "do": "release"}\n'
    with pytest.raises(ScriptError, match=r"line 2: it is due after 86,400 s"):
        parse_script(2 * wait, "a")


def test_what_is_no_script_is_refused(tmp_path):
    with pytest.raises(ScriptError, match="cannot be read"):
        read_script(tmp_path / "none")
    (tmp_path / "binary").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScriptError, match="cannot be read"):
        read_script(tmp_path / "binary")
    with pytest.raises(ScriptError, match="no commands"):
        parse_script("# nothing")


def test_a_script_that_is_written_reads_back():
    text = (
        '{"at": 1, "do": "touch", "marker": 2, "tilt": 30}\n{"after": 1, "do": "turn_to", "rpy": [1, 2, 3]}'
    )
    script = parse_script(text)
    again = parse_script(script_text(script))
    assert [(timed.at, timed.after, timed.command) for timed in again] == [
        (timed.at, timed.after, timed.command) for timed in script
    ]
