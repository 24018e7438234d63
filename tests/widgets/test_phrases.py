import pytest

from contactbench.widgets.phrases import PhraseBook, said, use

BOOK = PhraseBook(
    {
        "{0}: the mesh has {1} holes. {2}": "{0}: Das Netz hat {1} Löcher. {2}",
        "Close them, or make a shell.": "Schließen Sie sie, oder machen Sie eine Hülle.",
        "pose {0} looks bumped{1} and was left out": "Pose {0} sieht angestoßen aus{1} und wurde weggelassen",
        " after {0} s of rest": " nach {0} s Ruhe",
        "the force is too small": "die Kraft ist zu klein",
        "{0} of the {1}": "{0} von: {1}",
        "{0} holds still for {1} s": "nach {1} s hält still: {0}",
        "Made on {0}.": "Erstellt am {0}.",
        "The arm moved. Hold it still.": "Der Arm bewegte sich. Halten Sie ihn still.",
        "with {0} the residuals fall from {1} to {2}": "die Abweichungen fallen von {1} auf {2} ({0})",
        "Wait.": "Warten Sie.",
        "{0} and {1}": "{0} und {1}",
        "forces": "Kräfte",
        "torques": "Momente",
    }
)


@pytest.fixture(autouse=True)
def german():
    use(BOOK)
    yield
    use(None)


def test_what_was_filled_in_is_filled_in_again_and_said_too():
    assert said("probe.stl: the mesh has 3 holes. Close them, or make a shell.") == (
        "probe.stl: Das Netz hat 3 Löcher. Schließen Sie sie, oder machen Sie eine Hülle."
    )
    assert said("pose 4 looks bumped after 3 s of rest and was left out") == (
        "Pose 4 sieht angestoßen aus nach 3 s Ruhe und wurde weggelassen"
    )
    assert said("pose 4 looks bumped and was left out") == "Pose 4 sieht angestoßen aus und wurde weggelassen"


def test_a_short_sentence_with_a_long_number_is_known():
    assert said("Made on 2026-11-22 18:00 UTC.") == "Erstellt am 2026-11-22 18:00 UTC."


def test_holes_may_stand_in_another_order():
    assert said("The tool holds still for 2 s") == "nach 2 s hält still: The tool"


def test_a_capital_and_a_full_stop_put_to_it_are_put_to_it_again():
    assert said("The force is too small.") == "Die Kraft ist zu klein."
    assert said("The force is too small") == "Die Kraft ist zu klein"


def test_sentences_one_after_the_other_are_said_one_by_one_and_those_that_belong_together_at_once():
    assert said("Pose 2 looks bumped and was left out. The arm moved. Hold it still. Well done.") == (
        "Pose 2 sieht angestoßen aus und wurde weggelassen. Der Arm bewegte sich. Halten Sie ihn still. Well done."
    )
    assert (
        said("the force is too small\nthe force is too small")
        == "die Kraft ist zu klein\ndie Kraft ist zu klein"
    )


def test_a_sentence_does_not_swallow_the_next_one_nor_a_colon_that_was_put_to_it():
    assert said("The force is too small: with forces the residuals fall from 9 to 1 mm. Wait.") == (
        "Die Kraft ist zu klein: die Abweichungen fallen von 9 auf 1 mm (Kräfte). Warten Sie."
    )
    assert said("The tool holds still for 2 s:") == "nach 2 s hält still: The tool:"


def test_few_words_join_only_what_is_known():
    assert said("forces and torques") == "Kräfte und Momente"
    assert said("forces and 0.16 mm") == "Kräfte und 0.16 mm"
    assert said("the forces of somebody and the torques of nobody") == (
        "the forces of somebody and the torques of nobody"
    )


def test_what_is_in_no_book_stays_as_it_is_and_is_not_said_by_half():
    for text in (
        "",
        "3.2 N",
        "Errno 2: the end of the file came before the header was whole",
        "Kraft ist da.",
    ):
        assert said(text) == text


def test_without_a_book_english_is_spoken():
    use(None)
    assert said("the force is too small") == "the force is too small"
