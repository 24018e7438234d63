"""Drawing without a graphics card."""

import os


def spare_cores() -> None:
    """
    Leave two cores to the rest, where Mesa draws without a graphics card; before the first window that uses OpenGL.

    Its threads and the one that draws wait for each other: where all cores are taken, as by streams and a worker on
    two cores, a frame takes twice as long as one drawn by a single thread.
    """
    os.environ.setdefault("LP_NUM_THREADS", str(max(0, (os.cpu_count() or 1) - 2)))
