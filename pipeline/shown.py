"""Results that show themselves briefly: in a console some lines, in a notebook a table."""

from collections.abc import Mapping
from html import escape


class Shown:
    """Has `facts`, which stand for it where it is printed."""

    def facts(self) -> Mapping[str, str]:
        """Return what it is in a few words each, by what they say."""
        raise NotImplementedError

    def __repr__(self) -> str:
        """Return its name and its facts, a line each."""
        said = self.facts()
        width = max(map(len, said), default=0)
        return "\n  ".join(
            [type(self).__name__, *(f"{what:<{width}}  {value}" for what, value in said.items())]
        )

    def _repr_html_(self) -> str:
        rows = [
            f"<tr><th>{escape(what)}</th><td>{escape(value)}</td></tr>"
            for what, value in self.facts().items()
        ]
        return f"<table><caption>{type(self).__name__}</caption>{''.join(rows)}</table>"
