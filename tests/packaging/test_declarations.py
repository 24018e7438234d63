"""What is made from declarations and checked in is what the declarations say now."""

from pathlib import Path
from runpy import run_path

import pytest
from pydantic import create_model

from contactbench.pipeline.config.runtime import model
from contactbench.pipeline.gates import gate_forms

ROOT = Path(__file__).parents[2]
FILES: dict[str, bytes] = run_path(str(ROOT / "packaging" / "declarations.py"))["files"]()


@pytest.mark.parametrize("name", FILES)
def test_a_checked_in_file_is_what_the_declarations_say(name: str) -> None:
    assert (ROOT / name).read_bytes() == FILES[name], "run: python packaging/declarations.py"


def test_the_specification_of_a_bundle_has_every_gate() -> None:
    page = (ROOT / "docs" / "bundle.md").read_text(encoding="utf-8")
    rows = "".join(line for line in page.splitlines() if line.startswith("| `gates."))
    assert [form.stored for _, form in gate_forms() if f"{form.stored}`" not in rows] == []


@pytest.mark.parametrize("only", [False, True])
def test_a_later_field_stands_in_a_bundle_only_where_it_is_not_the_default(*, only: bool) -> None:
    part = create_model("_Part", __base__=model.ConfigPart, ever=(int, ...), later=(bool, False))
    assert ("later" in part(ever=1, later=only).model_dump(mode="json")) is only
