"""
What `pipeline` says, in the language of the window.

`pipeline` speaks English and knows of no other language. Whoever shows one of its sentences asks for it with `said`,
which looks for the template it was made from, and fills what was filled in into that of the other language. A sentence
that is in no book is shown as it is. Numbers in it are written as the reader does.
"""

from __future__ import annotations

import re
from collections import defaultdict
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING

from contactbench.widgets.numbers import local_numbers

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_HOLE = re.compile(r"\{(\d+)\}")
_BETWEEN = re.compile(r"(?<=[.!?;:,])\s+|\n+")
_SPEECH = re.compile(r"[A-Za-z]{2}")
_DEEPEST = 4  # a sentence in a sentence in a sentence
_KEPT = 4096  # sentences: what is shown 30 times a second is looked up once
_ENOUGH, _SHARE = 15, 0.3  # letters that must be the template's own: "{0} of the {1}" is many a sentence
_MOST_PARTS = 24


class _Phrase:
    """A template with something to fill in."""

    def __init__(self, source: str, meaning: str) -> None:
        pieces = _HOLE.split(source)
        self.meaning, self.holes = meaning, tuple(pieces[1::2])
        self._own = pieces[0::2]
        self._anchor = max(self._own, key=len)
        self._leads = self._own[0].endswith(": ")  # "Passed: {0}." is no chance, however long the rest
        self.letters = sum(_letters(piece) for piece in self._own)

    @cached_property
    def _pattern(
        self,
    ) -> re.Pattern[str]:  # made when it is first of use: 2,000 would keep a window that opens waiting
        return re.compile("(.*?)".join(re.escape(piece) for piece in self._own), re.DOTALL)

    def filled(self, text: str) -> dict[str, str] | None:
        """Return what was filled in to make a text, by hole; None: it was not made of this."""
        if self._anchor not in text:
            return None
        if self.letters < _ENOUGH and self.letters < _SHARE * _letters(text) and not self._leads:
            return None
        match = self._pattern.fullmatch(text)
        return None if match is None else dict(zip(self.holes, match.groups(), strict=True))


class PhraseBook:
    """
    Templates of one language, by those of English.

    Parameters
    ----------
    pairs : mapping
        English to other; what is filled in is {0}, {1}, ... in both.
    """

    def __init__(self, pairs: Mapping[str, str]) -> None:
        # What one sentence continues with begins with a space; texts are looked up without.
        pairs = {**{source.strip(): meaning.strip() for source, meaning in pairs.items()}, **pairs}
        self._plain = {source: meaning for source, meaning in pairs.items() if not _HOLE.search(source)}
        self._by_word: dict[str, list[_Phrase]] = defaultdict(list)
        for source in pairs.keys() - self._plain.keys():
            self._by_word[_first_word(source)].append(_Phrase(source, pairs[source]))
        for phrases in self._by_word.values():  # the one that says most itself is the right one
            phrases.sort(key=lambda phrase: -phrase.letters)
        self.say = lru_cache(_KEPT)(self._say)

    def _say(self, text: str, depth: int = 0) -> str:
        """Return a text in the other language, as far as it is known."""
        if depth > _DEEPEST or not _SPEECH.search(text):
            return text
        whole = self._whole(text, depth)
        return whole if whole is not None else self._in_parts(text, depth)

    def _in_parts(self, text: str, depth: int) -> str:
        """Return it sentence by sentence, with as many at once as are known together."""
        cuts = [(match.start(), match.end()) for match in _BETWEEN.finditer(text)][:_MOST_PARTS]
        ends = [*(cut[0] for cut in cuts), len(text)]
        begins = [0, *(cut[1] for cut in cuts)]
        if len(ends) == 1:
            return text
        said, i = "", 0
        while i < len(begins):
            for j in range(len(ends) - 1, i - 1, -1):
                found = (
                    None if (i, j) == (0, len(ends) - 1) else self._whole(text[begins[i] : ends[j]], depth)
                )
                if found is not None:
                    break
            else:
                j, found = i, text[begins[i] : ends[i]]
            said += found + (text[ends[j] : begins[j + 1]] if j + 1 < len(begins) else "")
            i = j + 1
        return said

    def _whole(self, text: str, depth: int) -> str | None:
        """Return what one template says of all of it; also of one that begins or ends otherwise."""
        for form, back in _forms(text):
            if form in self._plain:
                return back(self._plain[form])
            for phrase in self._candidates(form):
                filled = phrase.filled(form)
                if filled is not None:
                    said = {hole: self.say(words, depth + 1) for hole, words in filled.items()}
                    return back(_HOLE.sub(partial(_fill, said), phrase.meaning))
        return None

    def _candidates(self, text: str) -> Iterator[_Phrase]:
        yield from self._by_word.get(_first_word(text), ())
        yield from self._by_word.get("", ())


_book: PhraseBook | None = None


def use(book: PhraseBook | None) -> None:
    """Speak another language from now on; None: English."""
    global _book
    _book = book


def said(text: str) -> str:
    """Return what `pipeline` says in the language of the window."""
    return local_numbers(text if _book is None else _book.say(text))


def _fill(said: dict[str, str], hole: re.Match[str]) -> str:
    return said[hole[1]]


def _letters(text: str) -> int:
    return sum(character.isalpha() for character in text)


def _first_word(text: str) -> str:
    """Return what stands before the first space; nothing where that is filled in."""
    word = text.partition(" ")[0]
    return "" if "{" in word else word


def _forms(text: str) -> Iterator[tuple[str, _Back]]:
    """Yield a text as it is, and as it was before a capital or a full stop was put to it; each with the way back."""
    yield text, str
    if text[:1].isupper():
        yield text[0].lower() + text[1:], _capital
    if text.endswith("."):
        yield text[:-1], _stopped
        if text[:1].isupper():
            yield text[0].lower() + text[1:-1], _both


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _stopped(text: str) -> str:
    return f"{text}."


def _both(text: str) -> str:
    return _capital(_stopped(text))


if TYPE_CHECKING:
    from collections.abc import Callable

    _Back = Callable[[str], str]
