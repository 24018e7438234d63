import re
from importlib.resources import files
from xml.etree import ElementTree as ET

import pytest
from PySide6.QtCore import QUrl
from PySide6.QtGui import QImage, QTextDocument

from contactbench.app.help_book import PAGES, TUTORIAL, HelpBook, page

HELP = files("contactbench.app") / "help"
LABEL, PICTURE, LINK = (
    re.compile(r"\*\*(.+?)\*\*"),
    re.compile(r"!\[.+?\]\((.+?)\)"),
    re.compile(r"\]\((\w+)\.md\)"),
)


def plain(label):
    """Return a label without what the window adds to it: an accelerator, a number, dots."""
    return re.sub(r"^\d\.? +", "", label.replace("&", "")).rstrip("….")


def labels(language):
    """Return what the window shows in a language, from its translations."""
    tree = ET.fromstring((HELP.parent / "translations" / "contactbench_de.ts").read_bytes())  # noqa: S314  # our own file
    part = "source" if language == "en" else "translation"
    return [plain(each.text) for each in tree.iter(part) if each.text]


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize("name", PAGES)
def test_a_page_has_a_picture_and_names_what_the_window_shows(name, language):
    text = page(name, language).text
    assert (HELP / f"{name}.{language}.md").is_file() or language == "en"
    pictures = PICTURE.findall(text)
    assert pictures
    for picture in pictures:
        assert not QImage(str(HELP / "pictures" / picture)).isNull(), picture
    assert set(LINK.findall(text)) <= set(PAGES)
    shown = labels(language)
    for label in LABEL.findall(text):
        assert any(each.startswith(plain(label)) for each in shown), f"no part of the window says {label!r}"


@pytest.mark.usefixtures("qapp")
def test_the_help_lists_all_pages_and_turns_to_one():
    book = HelpBook("gravity")
    assert book.list.count() == len(PAGES)
    assert book.name == "gravity"
    assert "weight" in book.view.toPlainText()
    assert not book.isModal()  # what it says can be done meanwhile
    book._follow(QUrl("devices.md"))
    assert book.name == "devices"
    book._follow(QUrl("https://example.org/other.md"))
    assert book.name == "devices"


@pytest.mark.usefixtures("qapp")
def test_a_search_leaves_the_pages_that_have_the_words_and_marks_them():
    book = HelpBook(TUTORIAL)
    book.search.setText("Known WEIGHT")
    shown = [PAGES[row] for row in range(len(PAGES)) if not book.list.item(row).isHidden()]
    assert shown == [name for name in PAGES if page(name, "en").has(["known", "weight"])]
    assert "gravity" in shown
    assert book.name in shown
    marked = {mark.cursor.selectedText().lower() for mark in book.view.extraSelections()}
    assert marked == {"known", "weight"}
    book.search.setText("nosuchword")
    assert not book.none.isHidden()
    book.search.clear()
    assert book.none.isHidden()
    assert not any(book.list.item(row).isHidden() for row in range(len(PAGES)))


@pytest.mark.usefixtures("qapp")
def test_a_picture_is_never_wider_than_the_page_and_none_comes_from_elsewhere():
    book = HelpBook("gravity")
    book.show()
    kind = QTextDocument.ResourceType.ImageResource.value
    image = book.view.loadResource(kind, QUrl("gravity.png"))
    assert 0 < image.width() / image.devicePixelRatio() <= book.view.viewport().width()
    assert book.view.loadResource(kind, QUrl("../../../docs/figures/window.png")).isNull()
