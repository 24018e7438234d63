#!/usr/bin/env bash
# MuJoCo gives a tube more mass than the solid block it was cut from, unless its mesh asks for the exact mass.
#
# From a mesh and a density MuJoCo 4.0.0 computes mass and inertia as if every triangle were seen from a point inside:
# what has to be taken away is added. This is what a mesh gets by default ("legacy"). A square tube, 100 mm long and
# wide with a bore of 80 mm, weighs 0.36 kg at 1000 kg/m3, and the block it was cut from 1 kg; MuJoCo says 1.213 kg. The
# mesh is closed and oriented correctly, and there is no warning. Whoever simulates a hollow probe on a force sensor to
# check gravity compensation or a payload estimate will blame the estimate. Set inertia="exact" on the mesh, or give the
# body an <inertial> of its own.
#
# Seen with mujoco 4.0.0 and numpy 2.4.6 on Python 3.11.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check "mujoco==4.0.0" "numpy==2.4.6"
cat >"$folder/case.py" <<'PY'
import mujoco
import numpy as np

# corners: outside low, outside high, inside low, inside high; each four, counterclockwise seen from above
square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
corners = [(*(xy * half), z) for half in (0.05, 0.04) for z in (-0.05, 0.05) for xy in square]
quads = []
for k in range(4):
    n = (k + 1) % 4
    quads += [(k, n, 4 + n, 4 + k), (8 + n, 8 + k, 12 + k, 12 + n)]  # walls outside and inside
    quads += [(4 + k, 4 + n, 12 + n, 12 + k), (n, k, 8 + k, 8 + n)]  # rims above and below
faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
p = np.array(corners)[np.array(faces)]
print("true", round(float(np.linalg.det(p).sum() / 6 * 1000), 3))
for name, kind in (("default", ""), ("convex", 'inertia="convex"'), ("exact", 'inertia="exact"')):
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco><asset><mesh name="tube" {kind} vertex="{" ".join(str(x) for c in corners for x in c)}"
        face="{" ".join(str(i) for t in faces for i in t)}"/></asset>
        <worldbody><body><freejoint/><geom type="mesh" mesh="tube" density="1000"/></body></worldbody></mujoco>""")
    print(name, round(float(model.body_mass[1]), 3))
PY
read=$("$folder/venv/bin/python" "$folder/case.py")
echo "$read"
[[ $read == $'true 0.36\ndefault 1.213\nconvex 1.0\nexact 0.36' ]] || { echo "CHANGED: another mass now"; exit 1; }
