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
from itertools import product
from typing import TYPE_CHECKING

from contactbench.widgets.numbers import local_numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

_HOLE = re.compile(r"\{(\d+)\}")
_BETWEEN = re.compile(r"(?<=[.!?;:,])\s+|\n+")
_NEXT = re.compile(r"[.!?:]\s+\S")
_STOPPED = re.compile(r"[.!?:;,](\s|$)")
_MEASURE = re.compile(r"[-\d.,]+ \S+")
_SPEECH = re.compile(r"[A-Za-z]{2}")
_DEEPEST = 8  # a sentence in a sentence in a sentence
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
        match = self._pattern.fullmatch(text) if self._anchor in text else None
        return None if match is None else dict(zip(self.holes, match.groups(), strict=True))

    def says_enough(self, text: str) -> bool:
        """Tell whether so much of a text is its own that it is no chance."""
        return self.letters >= _ENOUGH or self.letters >= _SHARE * _letters(text) or self._leads


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
        whole = self._whole(text, depth, holding=False)
        if whole is None:
            parts, known = self._in_parts(text, depth)
            whole = parts if known else self._whole(text, depth, holding=True) or parts
        return whole

    def _in_parts(self, text: str, depth: int) -> tuple[str, bool]:
        """Return it sentence by sentence, with as many at once as are known together; and whether all are known."""
        cuts = [(match.start(), match.end()) for match in _BETWEEN.finditer(text)][:_MOST_PARTS]
        ends = [*(cut[0] for cut in cuts), len(text)]
        begins = [0, *(cut[1] for cut in cuts)]
        if len(ends) == 1:
            return text, False
        said, i, all_known = "", 0, True
        while i < len(begins):
            for holding, j in product((False, True), range(len(ends) - 1, i - 1, -1)):
                if (i, j) == (0, len(ends) - 1):
                    continue
                found = self._whole(text[begins[i] : ends[j]], depth, holding=holding)
                if found is not None:
                    break
            else:
                j, found = i, text[begins[i] : ends[i]]
                all_known = all_known and not _SPEECH.search(found)
            said += found + (text[ends[j] : begins[j + 1]] if j + 1 < len(begins) else "")
            i = j + 1
        return said, all_known

    def _whole(self, text: str, depth: int, *, holding: bool) -> str | None:
        """
        Return what one template says of all of it; also of one that begins or ends otherwise.

        Parameters
        ----------
        text : str
        depth : int
        holding : bool
            Whether what is filled in may be more than a sentence: the next one is rather one of its own.
        """
        forms = tuple(_forms(text))
        for form, back in forms:
            if form in self._plain:
                return back(self._plain[form])
        most, said = -1, None
        for form, back in forms:
            for phrase in self._candidates(form):
                if (
                    phrase.letters > most
                    and (filled := self._filled(phrase, form, depth, holding)) is not None
                ):
                    most, said = phrase.letters, (back, phrase, filled)
        if said is None:
            return None
        back, phrase, filled = said
        return back(
            _HOLE.sub(partial(_fill, {h: self.say(w, depth + 1) for h, w in filled.items()}), phrase.meaning)
        )

    def _filled(self, phrase: _Phrase, text: str, depth: int, holding: bool) -> dict[str, str] | None:
        """Return what fills a template; one of few words is chance unless that is known."""
        filled = phrase.filled(text)
        if filled is None or (not holding and any(map(_NEXT.search, filled.values()))):
            return None
        enough = phrase.says_enough(text) or all(self._known(words, depth) for words in filled.values())
        return filled if enough else None

    def _known(self, words: str, depth: int) -> bool:
        """Tell whether some words are known, or need not be: numbers, with a unit."""
        if not _SPEECH.search(words) or _MEASURE.fullmatch(words):
            return True
        if depth >= _DEEPEST or _STOPPED.search(words):
            return False
        return self._whole(words, depth + 1, holding=False) is not None

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


def _forms(text: str) -> Iterator[tuple[str, Callable[[str], str]]]:
    """Yield a text as it is, and as it was before a capital or a stop was put to it; each with the way back."""
    stop, lower = text[-1:], text[:1].lower() + text[1:]
    forms: list[tuple[str, Callable[[str], str]]] = [(text, str), (lower, _capital)]
    if stop in (*".:;,",):  # first without, else it is taken for a part of what is filled in
        bare = [(text[:-1], lambda said: said + stop), (lower[:-1], lambda said: _capital(said) + stop)]
        forms = bare + forms
    else:
        forms += [(f"{text}.", _unstopped), (f"{lower}.", lambda said: _capital(_unstopped(said)))]
    yield from forms if lower != text else forms[::2]


def _unstopped(text: str) -> str:
    return text.removesuffix(".")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
