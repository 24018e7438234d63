"""
A session at work: what a technician does at the bench, as models without a screen.

The desktop application draws them; nothing here knows of it. What counts ends in the session, so that the
commands that work on a session give the same bytes.
"""
