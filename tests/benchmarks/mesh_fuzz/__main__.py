"""``python -m benchmarks.mesh_fuzz [COUNT [SEED]]``: 10,000 hostile files unless told otherwise."""

from __future__ import annotations

import sys

from benchmarks.mesh_fuzz.fuzz import run

if __name__ == "__main__":
    many, first_seed, *_ = (*(int(word) for word in sys.argv[1:3]), *(10_000, 0)[len(sys.argv) - 1 :])
    found = run(many, first_seed)
    sys.stdout.write("\n".join(found.sentences) + "\n")
    raise SystemExit(0 if found.passed else 1)
