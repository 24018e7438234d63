"""Where the application begins: PyInstaller makes its program of this file."""

import multiprocessing
import os
import sys

from contactbench.pipeline.installation import run_asked_module

if __name__ == "__main__":
    # The libraries of the application are loaded from its own folder. A program that it opens, such as a browser, is
    # another's and takes the system's.
    if (original := os.environ.pop("LD_LIBRARY_PATH_ORIG", None)) is not None:
        os.environ["LD_LIBRARY_PATH"] = original
    else:
        os.environ.pop("LD_LIBRARY_PATH", None)
    multiprocessing.freeze_support()  # a process that `multiprocessing` started ends in here
    if not run_asked_module(sys.argv):
        from contactbench.app.cli import main

        main()
