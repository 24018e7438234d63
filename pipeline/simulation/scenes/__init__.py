"""
Scenes in MuJoCo, each with only what its question needs, and the truth about every contact in them.

The smallest is `TouchScene`: one tip on one place of a probe that is held still. `BenchScene` is a tool on a
wrist; `PlatformScene` and `ArmScene` follow set-points over a phantom of soft tissue that moves.
"""
