"""Frames of one fixed length, found in a stream of bytes."""

from collections.abc import Callable

# Larger input is taken in pieces, so that the buffer stays this small whatever is handed in.
_PIECE = 4096


class Pieces:
    """
    Bytes of a stream, cut anywhere, that wait for their rest.

    Attributes
    ----------
    skipped_bytes : int
        Bytes that were given up, or belong to nothing.
    """

    def __init__(self) -> None:
        self._buffer = bytearray()
        self.skipped_bytes = 0

    @property
    def pending(self) -> int:
        """Bytes that wait for the rest of their frame: fewer than the longest one."""
        return len(self._buffer)

    def reset(self) -> None:
        """Drop what waits for the rest of its frame."""
        self.skipped_bytes += len(self._buffer)
        self._buffer.clear()


class FrameScanner(Pieces):
    """
    Finds frames by header and checksum; what is not a frame is skipped and counted.

    After a failed check it moves on by one byte only: header bytes also occur inside numbers, and a jump by
    a whole frame from such a place would lose the intact frame that begins behind it.

    Parameters
    ----------
    header : bytes
        The fixed bytes that each frame begins with.
    length : int
        Of a whole frame, header and checksum included.
    intact : callable
        Tells from a whole frame whether its checksum is right.
    """

    def __init__(self, header: bytes, length: int, intact: Callable[[bytes], bool]) -> None:
        super().__init__()
        self._header = header
        self._length = length
        self._intact = intact
        self.frames = 0
        self.bad_checksums = 0

    def push(self, data: bytes) -> list[bytes]:
        """Take bytes; return the whole frames that end in them, oldest first."""
        found: list[bytes] = []
        for start in range(0, len(data), _PIECE):
            self._buffer += data[start : start + _PIECE]
            self._scan(found)
        return found

    def _scan(self, found: list[bytes]) -> None:
        buffer, length = self._buffer, self._length
        position = 0
        while True:
            start = self._next_header(position)
            self.skipped_bytes += start - position
            position = start
            if start + length > len(buffer):
                break
            frame = bytes(buffer[start : start + length])
            if self._intact(frame):
                self.frames += 1
                found.append(frame)
                position += length
            else:
                self.bad_checksums += 1
                self.skipped_bytes += 1
                position += 1
        del buffer[:position]

    def _next_header(self, position: int) -> int:
        """Return where a header begins, or may begin once more bytes are there."""
        start = self._buffer.find(self._header, position)
        if start >= 0:
            return start
        return max(position, len(self._buffer) - len(self._header) + 1)
