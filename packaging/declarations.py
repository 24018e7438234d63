"""
Write what is made from declarations in Python and checked in: two headers of the kernel, and the schema of a bundle.

``python packaging/declarations.py`` writes the files; a test compares them.
"""

from __future__ import annotations

from pathlib import Path
from textwrap import wrap
from typing import Any

from contactbench.pipeline.config.runtime.canonical import json_schema
from contactbench.pipeline.config.runtime.model import VERSION, RuntimeModel
from contactbench.pipeline.gates import BEHIND_M, Gates, GateSettings, absent_gates, gate_forms
from contactbench.pipeline.setting_options import default_text, option_name

ROOT = Path(__file__).resolve().parents[1]
_MADE = "// Made from {source} by packaging/declarations.py: change that, not this.\n#pragma once\n\n"
_TYPES = {bool: "bool", int: "std::int64_t", float: "double"}
_GATES = """\
#include <cmath>
#include <cstdint>

namespace contactbench {{

// SI; a cost is 2 ln(odds).
struct Gates {{
{members}
    // Nearer surfaces, m along the force, are one.
    double behind_distance = {behind!r};
}};

// How a gate follows from what a bundle holds.
enum class From {{ value, odds, angle }};

// Calls visit(name in a bundle, name here, member, From) for each gate.
template <class Visit>
void each_gate(Gates& g, Visit&& visit) {{
{rows}
}}

}}  // namespace contactbench
"""
_SCHEMA = """\
#include "shape.hpp"

namespace contactbench::runtime::schema {{

{parts}

}}  // namespace contactbench::runtime::schema
"""
_WHOLE: Any = {"break_long_words": False, "break_on_hyphens": False}
# Ranges that shape.hpp has a name for: the two ends, and whether they are out.
_RANGES = {
    (-1e9, 1e9, False, False): "any",
    (0, 1e9, True, False): "positive",
    (0, 1e9, False, False): "not_negative",
}
_GATES_PAGE = """\
# Gates

Gates decide which contacts are reported and accepted; odds decide between places. Both are options of `contactbench
locate`, fields of the [bundle](../bundle.md) (SI), and fields of a class (SI, angles in degrees).

| gate | option | in a bundle | default | meaning |
|---|---|---|---|---|
{rows}

::: contactbench.pipeline.contact.Gates
    options:
      members: [implausible_misfit, bonus, odds]
"""
# What the patterns of texts are called in shape.hpp.
_FORMATS = {
    "^[0-9a-f]{64}$": "hash",
    "^[A-Za-z0-9][A-Za-z0-9._-]{0,99}$": "file",
    "^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z$": "time",
    "^#[0-9a-f]{6}$": "colour",
}


def main() -> None:
    """Write all files."""
    for name, data in files().items():
        (ROOT / name).write_bytes(data)


def files() -> dict[str, bytes]:
    """Return all files: path from the top -> content."""
    return {
        "pipeline/kernel/include/contactbench/gates.hpp": _gates_header().encode(),
        "pipeline/kernel/runtime/src/schema.hpp": _schema_header().encode(),
        "assets/runtime-config.schema.json": json_schema(),
        "docs/reference/gates.md": _gates_page().encode(),
    }


def _gates_header() -> str:
    """Return the struct that the kernel's gates are, and the table that fills it."""
    defaults = Gates(**absent_gates()).kernel_values()
    members, rows = [], []
    for name, form in gate_forms():
        held = form.held or name
        text = Gates.model_fields[name].description or ""
        members += wrap(text, 115, initial_indent="    // ", subsequent_indent="    // ")
        members.append(f"    {_member(held, defaults[held])}")
        rows.append(f'    visit("{form.stored}", "{held}", g.{held}, From::{form.way.name});')
    body = _GATES.format(members="\n".join(members), behind=BEHIND_M, rows="\n".join(rows))
    return _MADE.format(source="pipeline/gates.py") + body


def _member(name: str, default: Any) -> str:
    if isinstance(default, tuple):
        return f"double {name}[{len(default)}] = {{{', '.join('HUGE_VAL' for _ in default)}}};"
    value = str(default).lower() if isinstance(default, bool) else repr(default)
    return f"{_TYPES[type(default)]} {name} = {value};"


def _gates_page() -> str:
    """Return the table of the gates."""
    rows = []
    stored = {name: form.stored for name, form in gate_forms()}
    for name, field in GateSettings.model_fields.items():
        extra: Any = field.json_schema_extra
        option = option_name(name, field)
        default = default_text(field) + (f" {extra['unit']}" if extra["unit"] and not extra["none"] else "")
        why = f" {extra['why']}" if extra["why"] else ""
        where = f"`gates.{stored[name]}`" if name in stored else "`regions[i].odds`"
        rows.append(f"| `{name}` | `{option}` | {where} | {default} | {field.description}{why} |")
    return _GATES_PAGE.format(rows="\n".join(rows))


# ---- the schema of a bundle ----------------------------------------------------------------------


def _schema_header() -> str:
    """Return the shape of contactbench.json as tables: every object before those that hold it."""
    schema = RuntimeModel.model_json_schema()
    writer = _Shapes(schema["$defs"])
    # Older versions have been brought up to this one, all but their number.
    schema["properties"]["version"] = {"type": "integer", "minimum": 1, "maximum": VERSION}
    writer.add("Runtime", schema)
    return _MADE.format(source="pipeline/config/runtime/model.py") + _SCHEMA.format(
        parts="\n".join(writer.parts)
    )


class _Shapes:
    def __init__(self, definitions: dict[str, Any]) -> None:
        self.parts: list[str] = []
        self._definitions, self._named, self._items = definitions, set[str](), dict[str, str]()

    def add(self, name: str, definition: dict[str, Any]) -> None:
        needed = definition["required"]
        members = [
            f'{{"{each}", {self._shape(shape)}{"" if each in needed else ", true"}}}'
            for each, shape in definition["properties"].items()
        ]
        self._write(f"inline constexpr Member {name}[] = {{{', '.join(members)}}};")
        self._named.add(name)

    def _write(self, text: str) -> None:
        # Breaks lines before a member only: texts hold blanks, too.
        whole = text.replace(" ", "\0").replace(",\0{", ", {").replace("\0=\0{", " = {")
        self.parts += [
            line.replace("\0", " ") for line in wrap(whole, 118, subsequent_indent="    ", **_WHOLE)
        ]

    def _shape(self, told: dict[str, Any]) -> str:
        if "anyOf" in told:
            return f"or_null({self._shape(told['anyOf'][0])})"
        if "$ref" in told:
            name = told["$ref"].rpartition("/")[2]
            if name not in self._named:
                self.add(name, self._definitions[name])
            return f"object({name})"
        kind = told["type"]
        return "flag" if kind == "boolean" else getattr(self, f"_{kind}")(told)

    def _number(self, told: dict[str, Any]) -> str:
        above, below = "exclusiveMinimum" in told, "exclusiveMaximum" in told
        low = told["exclusiveMinimum" if above else "minimum"]
        high = told["exclusiveMaximum" if below else "maximum"]
        if name := _RANGES.get((low, high, above, below)):
            return name
        ends = f", {str(above).lower()}, {str(below).lower()}" if above or below else ""
        return f"number({low!r}, {high!r}{ends})"

    def _integer(self, told: dict[str, Any]) -> str:
        return f"integer({told['minimum']}, {told['maximum']})"

    def _string(self, told: dict[str, Any]) -> str:
        if words := told.get("enum", [told["const"]] if "const" in told else []):
            return f'one_of("{"|".join(words)}")'
        if pattern := told.get("pattern"):
            return f"formatted(Format::{_FORMATS[pattern]})"
        return f"text({told['maxLength']})"

    def _array(self, told: dict[str, Any]) -> str:
        return f"array({self._item(told['items'])}, {told.get('minItems', 0)}, {told['maxItems']})"

    def _object(self, told: dict[str, Any]) -> str:
        """Return the shape of an object with any names: files with their hashes."""
        return f"files({told['minProperties']}, {told['maxProperties']})"

    def _item(self, told: dict[str, Any]) -> str:
        shape = self._shape(told)
        if not shape.isidentifier() and shape not in self._items:
            self._items[shape] = f"each_{len(self._items) + 1}"
            self._write(f"inline constexpr Shape {self._items[shape]} = {shape};")
        return self._items.get(shape, shape)


if __name__ == "__main__":
    main()
