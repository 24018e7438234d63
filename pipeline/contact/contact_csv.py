"""Contacts as CSV rows, a block at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from contactbench.pipeline.contact.facet_marks import MARKS
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.tables.shortest import csv_rows

if TYPE_CHECKING:
    import numpy.typing as npt

HEADER = b"t,x,y,z,k,face,reason,candidates,sigma_max_mm,misfit,confidence,on\n"

REASONS: tuple[str, ...] = tuple(reason.name.lower() for reason in Reason)
_REASON_TEXTS = np.array(REASONS, dtype=np.bytes_)
_MARK_TEXTS = np.array((*MARKS, ""), dtype=np.bytes_)  # the last: not known


class Answers(Protocol):
    """What a method says about n wrenches: :class:`contactbench.pipeline.kernel.Batch` or the like."""

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """(n, 3) S, m; NaN where there is no point."""

    @property
    def torques(self) -> npt.NDArray[np.float64]:
        """(n,) k, N·m; NaN where there is no point."""

    @property
    def faces(self) -> npt.NDArray[np.int32]:
        """(n,) facet, or -1."""

    @property
    def reasons(self) -> npt.NDArray[np.uint8]:
        """(n,) values of Reason."""

    @property
    def candidates(self) -> npt.NDArray[np.int32]:
        """(n,) how many there were."""

    @property
    def sigma_max(self) -> npt.NDArray[np.float64]:
        """(n,) largest standard deviation of the point, m; NaN where there is no point."""

    @property
    def misfits(self) -> npt.NDArray[np.float64]:
        """(n,) d2 of the best touch, also where it was no contact; NaN where none was looked for."""

    @property
    def confidences(self) -> npt.NDArray[np.float64]:
        """(n,) 0 to 1; 0 where there is no point."""


class ContactRows:
    """Turns answers into CSV text."""

    def __init__(self) -> None:
        self._integers = np.array([b""], dtype=np.bytes_)  # the texts of -1, 0, 1, ...

    def encode(
        self,
        times: npt.NDArray[np.bytes_],
        answers: Answers,
        sigma_mm: npt.NDArray[np.float64],
        marks: npt.NDArray[np.uint8],
        more: npt.NDArray[np.float64] | None = None,
    ) -> bytes:
        """
        Write one line per answer, columns as in `HEADER`.

        Parameters
        ----------
        times : (n,) bytes
            What stands in the first column, without NUL bytes.
        answers : Answers
            Of n wrenches.
        sigma_mm : (n,) float64
            Largest standard deviation of each point, mm; NaN where there is none.
        marks : (n,) uint8
            What each lies on, a place in `MARKS`; beyond them: nothing is known.
        more : (n, k) float64, optional
            Columns behind those; NaN where there is no such number.
        """
        columns = (
            times,
            *answers.points.T,
            answers.torques,
            self._integer_texts(answers.faces),
            _REASON_TEXTS.take(answers.reasons),
            self._integer_texts(answers.candidates),
            sigma_mm,
            answers.misfits,
            answers.confidences,
            _MARK_TEXTS.take(marks),
            *(() if more is None else more.T),
        )
        return csv_rows(*columns)

    def _integer_texts(self, values: npt.NDArray[np.int32]) -> npt.NDArray[np.bytes_]:
        """Decimal text of integers from -1, which is written as nothing: looked up, as facets recur."""
        need = int(values.max(initial=0)) + 2
        if need > len(self._integers):
            texts = [b"", *(str(i).encode() for i in range(max(need, 2 * len(self._integers))))]
            self._integers = np.array(texts, dtype=np.bytes_)
        return self._integers.take(values + 1)
