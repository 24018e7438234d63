"""What an action does to a session."""

from contactbench.pipeline.workbench.undo_history import change_between


def observed(action):
    """Return an action that also tells what it did."""

    def run(session):
        before = session.state
        return action(session), change_between(before, session.state)

    return run
