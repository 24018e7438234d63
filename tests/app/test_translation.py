import re
import shutil
import subprocess
from functools import cache
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import typer
from calibration.diagnosis_cases import KGF, NOISE, held, oriented, pushed, scaled, transposed, turned
from PySide6.QtCore import QCoreApplication, QTranslator

from contactbench.app import translation
from contactbench.app.cli import app
from contactbench.app.jobs import Jobs
from contactbench.pipeline.calibration.diagnosis.diagnose import diagnose
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.steps import Step
from contactbench.widgets.messages import CONTEXT, translated

from . import spoken as spoken_words
from .spoken import Source, sources

OTHERS = [code for code in translation.LANGUAGES if code != "en"]
_PLACES = re.compile(r"\{[^}]*\}|%n|%\d")


def test_unknown_languages_are_english(qapp):
    assert translation.load(qapp, "xx") == "en"
    assert translation.in_use() == "en"


@pytest.fixture
def small(tmp_path, monkeypatch):
    """A language of one finished and one missing string."""
    monkeypatch.setattr(translation, "_FOLDER", tmp_path)
    (tmp_path / "contactbench_de.ts").write_text(
        '<?xml version="1.0"?><TS version="2.1" language="de"><context><name>StepList</name>'
        "<message><source>Gravity</source><translation>Schwerkraft</translation></message>"
        '<message><source>Probe</source><translation type="unfinished"></translation></message>'
        "</context><context><name>pipeline</name>"
        "<message><source>{0}: row {1} is {2} mm off</source>"
        "<translation>{0}: {2} mm daneben in Zeile {1}</translation></message>"
        "<message><source>the force is small</source><translation>die Kraft ist klein</translation></message>"
        "</context></TS>",
        encoding="utf-8",
    )
    translation.release("de")
    return tmp_path


def test_a_language_is_spoken_where_it_is_known(qapp, small, spoken):  # noqa: ARG001
    from contactbench.widgets.step_list import StepList

    spoken("de")
    steps = StepList()
    try:
        assert steps.name_of(Step.GRAVITY) == "Schwerkraft"
        assert steps.name_of(Step.PROBE) == "Probe"
    finally:
        steps.deleteLater()


def test_messages_are_translated_and_numbers_are_the_readers(qapp, small, spoken):  # noqa: ARG001
    wrong = InputError(f"{arg('a.csv')}: row {arg(7)} is {arg(1234.56):,.1f} mm off")
    spoken("de")
    assert translated(wrong) == "a.csv: 1.234,6 mm daneben in Zeile 7"
    assert translated(message(f"{arg(wrong)}, {arg('the force is small')}")) == (
        "a.csv: 1.234,6 mm daneben in Zeile 7, die Kraft ist klein"
    )
    assert translated("the force is small") == "die Kraft ist klein"
    assert translated(message(f"pose {arg(4)} is {arg(0.5)} mm off")) == "pose 4 is 0,5 mm off"


def test_what_fails_in_a_worker_is_told_in_the_language_of_the_window(qapp, qtbot, small, spoken):  # noqa: ARG001
    def fail(_progress, _cancelled):
        raise InputError(f"{arg('a.csv')}: row {arg(7)} is {arg(0.5)} mm off")

    spoken("de")
    told = []
    jobs = Jobs()
    jobs.start("Reading", fail, lambda _: None, told.append)
    qtbot.waitUntil(lambda: bool(told))
    assert translated(told[0]) == "a.csv: 0,5 mm daneben in Zeile 7"


def test_missing_strings_are_named(small, capsys):  # noqa: ARG001
    assert translation.unfinished("de") == ("StepList: Probe",)
    assert translation.main(["check"]) == 1
    assert "de: StepList: Probe" in capsys.readouterr().out
    assert translation.main([]) == 2


def test_update_takes_strings_of_both_packages(tmp_path, monkeypatch):
    monkeypatch.setattr(translation, "_FOLDER", tmp_path)
    monkeypatch.setattr(translation.subprocess, "run", _quiet)
    translation.update("de")
    text = (tmp_path / "contactbench_de.ts").read_text(encoding="utf-8")
    assert "<name>StepList</name>" in text
    assert "<name>MainWindow</name>" in text
    assert (tmp_path / "contactbench_de.qm").exists()
    assert {text for context, text, _ in _messages("de") if context == CONTEXT} == templates()


# ---- what is said, and what is translated ----------------------------------------------------------


spoken_files, templates = cache(sources), cache(translation.messages)


def test_every_word_goes_through_tr():
    assert [wrong for each in spoken_files() for wrong in each.wrong] == []


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ('self.label.setText("Ready now")', "is not given to tr()"),
        ('QLabel(f"{count} poses")', "is not given to tr()"),
        ('push_button("Ready now", picture="tick")', "is not given to tr()"),
        ("self.tr(words)", "not a plain literal"),
        ("say = self.tr", "by another name"),
        ('window.tr("Steps")', "only self.tr"),
        ("name = f'{self.tr(\"Steps\")}: 1'", "in an f-string"),
    ],
)
def test_words_that_would_stay_english_are_found(tmp_path, monkeypatch, line, complaint):
    monkeypatch.setattr(spoken_words, "ROOT", tmp_path)
    file = tmp_path / "page.py"
    file.write_text(f"class Page:\n    def show(self):\n        {line}\n", encoding="utf-8")
    (wrong,) = Source(file).wrong
    assert complaint in wrong


@pytest.mark.parametrize("language", OTHERS)
def test_the_file_of_a_language_is_that_of_the_source(language):
    """After a string has changed: ``python -m contactbench.app.translation update``, then translate what is new."""
    wanted = {(each.context, each.text) for source in spoken_files() for each in source.strings}
    wanted |= {(CONTEXT, text) for text in templates()}
    assert {(context, text) for context, text, _ in _messages(language)} == wanted


@pytest.mark.parametrize("language", OTHERS)
def test_a_language_is_complete(language):
    assert translation.unfinished(language) == ()


@pytest.mark.parametrize("language", OTHERS)
def test_numbers_and_names_are_put_into_the_same_places(language):
    for context, text, made in _messages(language):
        assert sorted(_PLACES.findall(made)) == sorted(_PLACES.findall(text)), f"{context}: {text}"
        assert made[:1].isspace() == text[:1].isspace(), f"{context}: {text!r}"
        assert made.count("\n") == text.count("\n"), f"{context}: {text}"
        assert ("&" in made) == ("&" in text), f"{context}: {text}"


@pytest.fixture
def said_by(tmp_path, monkeypatch):
    """Return the templates of a source."""

    def found(source, file="pipeline/mesh/module.py"):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(source, encoding="utf-8")
        monkeypatch.setattr(translation, "_HERE", tmp_path / "app")
        return set(translation.messages())

    return found


def test_messages_and_what_errors_are_made_of_are_found(said_by):
    assert said_by('say(message(f"pose {arg(name)} is {arg(angle):.1f} deg " "off"))') == {
        "pose {0} is {1} deg off"
    }
    assert said_by(
        'class FileError(InputError): ...\nclass TextError(FileError): ...\nraise TextError("no text")'
    ) == {"no text"}
    assert (
        said_by('raise ValueError("no text"); raise InputError(text); message(f"{arg(a)}: 3 {arg(b)}")')
        == set()
    )
    assert said_by('message("seen in a terminal")', "pipeline/commands/run.py") == set()


def test_a_value_that_is_no_argument_is_refused(said_by):
    """It would be part of the template, which no language has."""
    with pytest.raises(ValueError, match="each value in a message is given as arg"):
        said_by('message(f"pose {name} is {arg(angle)} deg off")')


@pytest.mark.parametrize("language", OTHERS)
def test_what_the_window_loads_is_up_to_date(language, tmp_path, monkeypatch):
    kept = (translation._FOLDER / f"contactbench_{language}.qm").read_bytes()
    shutil.copy(translation._file(language), tmp_path)
    monkeypatch.setattr(translation, "_FOLDER", tmp_path)
    monkeypatch.setattr(translation.subprocess, "run", _quiet)
    translation.release(language)
    assert (tmp_path / f"contactbench_{language}.qm").read_bytes() == kept


def test_help_names_commands_that_there_are():
    group = typer.main.get_command(app)
    for page in _pages("en"):
        for words in re.findall(r"`contactbench ([a-z -]+)`", page.read_text(encoding="utf-8")):
            here = group
            for word in words.split():
                here = here.get_command(None, word)
                assert here is not None, words


@pytest.mark.parametrize("language", OTHERS)
def test_help_is_in_every_language(language):
    for english, page in zip(_pages("en"), _pages(language), strict=True):
        text, other = english.read_text(encoding="utf-8"), page.read_text(encoding="utf-8")
        assert text.count("\n") == other.count("\n"), page.name
        assert text.count("**") == other.count("**"), page.name
        assert re.findall(r"`contactbench [a-z -]+`", text) == re.findall(r"`contactbench [a-z -]+`", other)


def _pages(language):
    """Return the help pages of a language: one for each step, and the first."""
    ending = ".md" if language == "en" else f".{language}.md"
    return [
        translation._HERE / "help" / f"{name}{ending}" for name in ("start", *(step.value for step in Step))
    ]


def _messages(language):
    for context in ET.parse(translation._file(language)).iter("context"):  # noqa: S314 - our own file
        for each in context.iter("message"):
            made = each.find("translation").text or ""
            yield context.findtext("name"), each.findtext("source"), made


@pytest.fixture
def spoken(qapp):
    """Have the application speak a language until the test ends."""
    before = _translators(qapp)
    yield lambda code: translation.load(qapp, code)
    for each in _translators(qapp):
        if each not in before:
            QCoreApplication.removeTranslator(each)
    translation.load(qapp, "en")


def _translators(application):
    return [each for each in application.children() if isinstance(each, QTranslator)]


_run = subprocess.run


def _quiet(*arguments, **options):
    return _run(*arguments, **options, capture_output=True)


@pytest.mark.parametrize(
    "mistake",
    [
        transposed,
        lambda poses: scaled(poses, [-1, 1, 1], 1),
        lambda poses: scaled(poses, -1, -1),
        lambda poses: scaled(poses, 1 / KGF, 1000),
        lambda poses: pushed(poses, 1, 4),
        lambda poses: pushed(poses, *range(5, 12)),
        lambda poses: oriented(poses, [pose.R_WS @ turned(1)[0] for pose in poses]),
        lambda poses: oriented(poses, np.roll([pose.R_WS for pose in poses], 1, axis=0)),
    ],
)
def test_what_a_diagnosis_says_is_said_whole(qapp, spoken, mistake):  # noqa: ARG001
    spoken("de")
    found = diagnose(mistake(held(turned(12))), NOISE)
    for sentence in (found.sentence, *found.not_testable):
        english = r"\b(the|and|with|of|to|from|is|are|fall|forces|torques|negated)\b"
        assert not re.search(english, translated(sentence))
