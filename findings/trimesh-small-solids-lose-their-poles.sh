#!/usr/bin/env bash
# trimesh makes balls and capsules of a few millimetres without their poles when they are given in metres.
#
# trimesh 5.2.0 drops every triangle below 1e-8 square units when it turns an outline into a solid. In metres that is
# 0.01 mm2, the size of a facet of a stylus tip. A capsule of 2 mm radius with the usual number of sections comes 0.47
# mm too short, with a hole at either end; one of 1 mm radius comes as a bare tube, both caps gone. A ball of 5 mm
# radius in 100 by 100 sections is 3.9 mm too short, and one of 2 mm in 64 by 64 has no face at all, yet is_watertight
# is True. Nothing is raised or logged. A contact at such a tip is found on its rim or not at all, and a mass taken from
# it is wrong. Make the solid in millimetres, where it is whole, and scale it: apply_scale drops nothing.
#
# Seen with trimesh 5.2.0, scipy 1.17.1 and numpy 2.4.6 on Python 3.11: faces, closed or not, and mm too short.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check "trimesh==5.2.0" "numpy==2.4.6" "scipy==1.17.1"
cat >"$folder/case.py" <<'PY'
import numpy as np
from trimesh.creation import capsule, uv_sphere


def show(name: str, solid, height: float) -> None:
    short = height - float(np.ptp(solid.vertices[:, 2])) if len(solid.faces) else height
    print(name, len(solid.faces), "closed" if solid.is_watertight else "open", f"{short * 1e3:.2f}")


for radius in (0.002, 0.001):
    show("capsule", capsule(height=0.04, radius=radius), 0.04 + 2 * radius)
    show("scaled", capsule(height=40, radius=radius * 1e3).apply_scale(1e-3), 0.04 + 2 * radius)
for radius, sections in ((0.005, 100), (0.002, 64)):
    show("ball", uv_sphere(radius=radius, count=[sections, sections]), 2 * radius)
    show("scaled", uv_sphere(radius=radius * 1e3, count=[sections, sections]).apply_scale(1e-3), 2 * radius)
PY
read=$("$folder/venv/bin/python" "$folder/case.py")
echo "$read"
expected='capsule 2816 open 0.47
scaled 4096 closed 0.00
capsule 128 open 2.00
scaled 4096 closed 0.00
ball 16000 open 3.94
scaled 39200 closed 0.00
ball 0 closed 4.00
scaled 15872 closed 0.00'
[[ $read == "$expected" ]] || { echo "CHANGED: other triangles are dropped now"; exit 1; }
