"""Contacts as CSV rows, a block at a time."""

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.contact.facet_marks import MARKS
from contactbench.pipeline.kernel import Batch, Reason
from contactbench.pipeline.tables.shortest import csv_rows

HEADER = b"t,x,y,z,k,face,reason,candidates,sigma_max_mm,misfit,confidence,on\n"

REASONS: tuple[str, ...] = tuple(reason.name.lower() for reason in Reason)
_REASON_TEXTS = np.array(REASONS, dtype=np.bytes_)
_MARK_TEXTS = np.array((*MARKS, ""), dtype=np.bytes_)  # the last: not known


class ContactRows:
    """Turns answers into CSV text."""

    def __init__(self) -> None:
        self._integers = np.array([b""], dtype=np.bytes_)  # the texts of -1, 0, 1, ...

    def encode(
        self,
        times: npt.NDArray[np.bytes_],
        answers: Batch,
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
        answers : Batch
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
