"""``python -m contactbench``: the command line."""

from contactbench.app.cli import main

if __name__ == "__main__":
    main()
