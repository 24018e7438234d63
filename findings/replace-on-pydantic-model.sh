#!/usr/bin/env bash
# mypy accepts dataclasses.replace() on a pydantic model, which raises TypeError when it runs.
#
# pydantic 2.14.3 declares BaseModel with typing.dataclass_transform, so a type checker gives a model the attributes of
# a dataclass, and typeshed's replace() takes it. At run time a model has no __dataclass_fields__. A setting class that
# is turned from a dataclass into a model keeps passing `mypy --strict` wherever it was copied by replace(), and fails
# there only when that line runs; the copy that works is model_copy(update=...), which in turn checks nothing.
#
# Seen with mypy 2.4.1 and pydantic 2.14.3 on Python 3.11: "Success: no issues found", then
# "TypeError: replace() should be called on dataclass instances".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check "mypy==2.4.1" "pydantic==2.14.3"
cat >"$folder/case.py" <<'PY'
from dataclasses import replace

from pydantic import BaseModel


class Limits(BaseModel):
    force: float = 30.0


print(replace(Limits(), force=20.0).force)
PY
cd "$folder"
checked=$(venv/bin/mypy --strict case.py) || { echo "CHANGED: mypy refuses it now: $checked"; exit 1; }
echo "$checked"
if said=$(venv/bin/python case.py 2>&1); then echo "CHANGED: replace() works on a model now: $said"; exit 1; fi
grep "TypeError: replace() should be called on dataclass instances" <<<"$said" ||
  { echo "CHANGED: it fails in another way: $said"; exit 1; }
