"""
What a scene needs: each modelling choice left out and put in, on the same touches and the same noise.

For every choice and every scene in which it has a meaning: what it buys in mm of the contact's place, and what it costs
in microseconds. Curves say from where on it begins to matter.
"""
