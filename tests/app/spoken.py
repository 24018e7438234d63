"""What `app` and `widgets` say: the strings in their source, as a translator must find them."""

import ast
import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
_SHOWN = {
    "QLabel", "QPushButton", "QToolButton", "QCheckBox", "QRadioButton", "QGroupBox", "QAction", "QDockWidget",
    "QMessageBox", "QFileDialog", "QProgressDialog", "QTableWidgetItem", "QListWidgetItem", "QTreeWidgetItem",
    "addAction", "addButton", "addItem", "addItems", "addMenu", "addRow", "addTab", "critical", "insertItem",
    "information", "insertTab", "question", "setAccessibleDescription", "setAccessibleName", "setHeaderLabels",
    "setHorizontalHeaderLabels", "setItemText", "setLabelText", "setNameFilter", "setPlaceholderText",
    "setPlainText", "setPrefix", "setSpecialValueText", "setStatusTip", "setSuffix", "setTabText", "setText",
    "setTitle", "setToolTip", "setWhatsThis", "setWindowTitle", "showMessage", "tell", "warning",
}  # fmt: skip
_SHOWN_FIRST = {"plain_label", "push_button", "sentence_label"}  # the rest are roles and pictures
_SPOKEN = {"tr", "translate"}
_LETTERS = re.compile(r"[^\W\d_]{2,}")
_NO_WORDS = re.compile(r"<[^<>]*>|\S*://\S*")  # tags and addresses
_UNITS = {"mm", "cm", "Hz", "kHz", "ms", "kB", "MB", "SHA", "Fx", "Fy", "Fz", "Mx", "My", "Mz", "px", "dB"}
_NAMES = {"contactbench", "SRI", "Bota", "Robotiq", "FT", "MeshLab"}


class String(NamedTuple):
    """A string that is given to `tr`: the context under which Qt looks for it, itself, and where it is."""

    context: str
    text: str
    where: str


class Source(ast.NodeVisitor):
    """
    One file, looked through.

    Attributes
    ----------
    strings : list of String
        What can be translated.
    wrong : list of str
        Calls that Qt's tools or Qt itself would not find, and words that never reach them.
    """

    def __init__(self, file: Path) -> None:
        self.strings: list[String] = []
        self.wrong: list[str] = []
        self._name, self._classes, self._called = str(file.relative_to(ROOT)), [""], set[ast.expr]()
        self.visit(ast.parse(file.read_text(encoding="utf-8")))

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._classes.append(node.name)
        self.generic_visit(node)
        self._classes.pop()

    def visit_Attribute(self, node: ast.Attribute) -> None:
        if node.attr in _SPOKEN and node not in self._called:
            self.wrong.append(f"{self._where(node)}: by another name, pyside6-lupdate does not see it")
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        self._called.add(node.func)
        name = called(node)
        if name in _SPOKEN:
            self._take(node, name)
        elif name in _SHOWN and not (isinstance(node.func, ast.Attribute) and _is_log(node.func.value)):
            for text in _bare(node):
                self.wrong.append(f"{self._where(node)}: {text!r} is not given to tr()")
        elif name in _SHOWN_FIRST:
            for text in _bare(ast.Tuple(node.args[:1])):
                self.wrong.append(f"{self._where(node)}: {text!r} is not given to tr()")
        self.generic_visit(node)

    def _take(self, node: ast.Call, name: str) -> None:
        texts = [each.value for each in node.args if isinstance(each, ast.Constant)]
        if len(texts) != len(node.args) or not all(isinstance(each, str) for each in texts):
            self.wrong.append(f"{self._where(node)}: not a plain literal")
        elif name == "translate":
            self.strings.append(String(texts[0], texts[1], self._where(node)))
        elif not self._classes[-1] or ast.unparse(node.func) != "self.tr":
            self.wrong.append(f"{self._where(node)}: only self.tr of the class around it is found again")
        else:
            self.strings.append(String(self._classes[-1], texts[0], self._where(node)))

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        inside = [each for each in ast.walk(node) if isinstance(each, ast.Call) and called(each) in _SPOKEN]
        self.wrong += [
            f"{self._where(each)}: in an f-string, where pyside6-lupdate does not look" for each in inside
        ]
        self.generic_visit(node)

    def _where(self, node: ast.AST) -> str:
        return f"{self._name}:{node.lineno}"


def called(node: ast.Call) -> str:
    """Return the last name of what is called."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def sources() -> list[Source]:
    """
    Return every file of `app` and `widgets`.

    Not the command line, which is English as all commands are, and not what passes messages of `pipeline` on.
    """
    files = sorted(file for folder in ("app", "widgets") for file in (ROOT / folder).rglob("*.py"))
    return [Source(file) for file in files if not file.name.startswith(("cli", "messages."))]


def _is_log(value: ast.expr) -> bool:
    return ast.unparse(value).lower().endswith(("log", "logging"))


def _bare(node: ast.AST) -> list[str]:
    """Return the literals with words in what is shown, leaving out what is in calls inside it."""
    found = []
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Constant) and isinstance(child.value, str) and _has_words(child.value):
            found.append(child.value)
        elif isinstance(
            child, ast.JoinedStr | ast.BinOp | ast.IfExp | ast.BoolOp | ast.List | ast.Tuple | ast.keyword
        ):
            found += _bare(child)
    return found


def _has_words(text: str) -> bool:
    return any(word not in _UNITS | _NAMES for word in _LETTERS.findall(_NO_WORDS.sub("", text)))
