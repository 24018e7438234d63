import copy
import json
from collections import OrderedDict

from contactbench.app.translation import keep_said, recall_said
from contactbench.pipeline import errors
from contactbench.pipeline.errors import InputError, arg, capitalised, join, message, said_lately

GERMAN = {
    "{0}: row {1} is {2} mm off{3}.": "{0}: {2} mm daneben in Zeile {1}{3}.",
    " after {0} s": " nach {0} s",
    "the force is small": "die Kraft ist klein",
    "forces": "Kräfte",
}


def german(text):
    return GERMAN.get(text, text)


def off(file="a.csv", later=""):
    return message(f"{arg(file)}: row {arg(7)} is {arg(0.256):.1f} mm off{arg(later)}.")


def test_a_message_is_its_english_text():
    said = off(later=message(f" after {arg(3)} s"))
    assert said == "a.csv: row 7 is 0.3 mm off after 3 s."
    assert json.dumps({"why": said}) == '{"why": "a.csv: row 7 is 0.3 mm off after 3 s."}'
    assert f"{said}" == f"{said!s}" == str(said)
    assert f"{said:>40}" == f"{said!s:>40}"
    assert {said: 1}["a.csv: row 7 is 0.3 mm off after 3 s."] == 1


def test_its_template_is_translated_and_so_are_messages_and_words_within():
    said = off("forces", message(f" after {arg(3)} s"))
    assert said.translated(german) == "Kräfte: 0.3 mm daneben in Zeile 7 nach 3 s."


def test_what_no_language_has_stays_english():
    said = message(f"pose {arg(4)} of {arg('forces')}")
    assert said.translated(str) == "pose 4 of forces"
    assert said.translated(german) == "pose 4 of Kräfte"


def test_joined_and_added_messages_keep_their_templates():
    said = message("the force is small")
    assert join("; ", [said, off()]).translated(german) == (
        "die Kraft ist klein; a.csv: 0.3 mm daneben in Zeile 7."
    )
    assert (said + ".").translated(german) == "die Kraft ist klein."
    assert ("forces" + said).translated(german) == "Kräftedie Kraft ist klein"
    assert join(", ", ["x", "y"]) == "x, y"


def test_a_capital_is_put_first_in_every_language():
    said = capitalised(message("the force is small"))
    assert said == "The force is small"
    assert said.translated(german) == "Die Kraft ist klein"
    assert message(f"{arg(said)}: {arg('forces')}").translated(german) == "Die Kraft ist klein: Kräfte"
    assert join(" ", [said, "forces"]).translated(german) == "Die Kraft ist klein Kräfte"


def test_blanks_at_the_ends_go_in_every_language():
    said = message(f"{arg('forces')} {arg('')}").strip()
    assert said == "forces"
    assert (said + " ").translated(german) == "Kräfte "


def test_an_error_says_what_it_was_made_of_also_within_another():
    inner = InputError(f"{arg('a.csv')}: row {arg(7)} is {arg(1)} mm off{arg('')}.")
    outer = InputError(f"{arg('probe')}: {arg(inner)}")
    assert str(outer) == "probe: a.csv: row 7 is 1 mm off."
    assert str(outer).translated(german) == "probe: a.csv: 1 mm daneben in Zeile 7."
    assert str(InputError(str(outer))).translated(german) == str(outer).translated(german)
    assert str(InputError("the force is small")).translated(german) == "die Kraft ist klein"


def test_conversions_and_formats_are_those_of_the_value():
    assert (
        message(f"{arg('a b')!r} {arg(1234.5):,.2f} {arg(None)} {arg(b'x')!s}") == "'a b' 1,234.50 None b'x'"
    )


def test_what_is_filled_in_cannot_break_a_message():
    strange = "a\ufdd0\ufdd3\ufdd1b {0} {7}"
    assert message(f"pose {arg(strange)} {{5}}") == "pose ab {0} {7} {5}"


def test_copies_keep_the_template():
    said = off()
    for other in (copy.copy(said), copy.deepcopy([said])[0]):
        assert other == said
        assert other.translated(german) == said.translated(german)


def test_a_text_that_went_through_a_file_is_the_message_that_it_was():
    said = off("b.csv")
    back = json.loads(json.dumps([said]))[0]
    assert said_lately(back).translated(german) == "b.csv: 0.3 mm daneben in Zeile 7."
    assert said_lately("never said") == "never said"


def test_a_later_program_says_it_again(monkeypatch, tmp_path):
    for n in range(9):
        message("long" * 2**18 + str(n))  # much was said before
    said = off("c.csv")
    keep_said(tmp_path)
    kept = tmp_path / "messages.json"
    monkeypatch.setattr(errors, "_LATELY", OrderedDict())
    assert type(said_lately(said[:])) is str
    recall_said(tmp_path)
    assert said_lately(said[:]).translated(german) == "c.csv: 0.3 mm daneben in Zeile 7."
    for content in (
        "{",
        "[1]",
        '{"a": 3}',
        json.dumps({"true": "\ufdd0false\ufdd1", "deep": "\ufdd2" * 5000}),
    ):
        kept.write_text(content)
        errors._LATELY.clear()
        recall_said(tmp_path)
        assert not errors._LATELY


def test_what_is_shown_is_kept_however_much_is_said():
    shown, said_once = off("d.csv"), off("e.csv")
    for k in range(3):
        for n in range(6_000):
            message(f"{arg(k)}: {arg(n)}")
        assert said_lately(shown[:]).translated(german) == "d.csv: 0.3 mm daneben in Zeile 7."
    assert said_lately(said_once[:]) == said_once
    assert type(said_lately(said_once[:])) is str
