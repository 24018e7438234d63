import pytest


@pytest.fixture
def seen(qtbot):
    """Show a widget, as large as asked, and wait until it is seen."""

    def show(widget, *size):
        qtbot.addWidget(widget)
        if size:
            widget.resize(*size)
        widget.show()
        qtbot.waitExposed(widget)
        return widget

    return show
