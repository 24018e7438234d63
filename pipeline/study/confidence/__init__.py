"""
How far a contact's own word can be trusted: sure answers that are wrong, stated confidence, stated ellipse.

`cases` draws touches whose place is known and asks the solver; `study` sums up, judges and tells about it.
"""
