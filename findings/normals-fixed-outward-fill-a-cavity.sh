#!/usr/bin/env bash
# Turning normals outward makes a hollow part heavier than a solid one, in trimesh and in VTK alike.
#
# A hollow part is two closed surfaces, and the inner one has to face into the cavity: its volume then counts as taken
# away. trimesh 5.2.0 (fix_normals, process(validate=True)) and VTK 9.7.2 (vtkPolyDataNormals with auto-orient, which is
# pyvista's compute_normals(auto_orient_normals=True)) turn each of the two outward, so that its volume is added. A ball
# of 10 mm radius with a cavity of 8 mm, 2040 mm3 of material, comes back as 6320 mm3, while the solid ball has 4180. It
# was sound before, and trimesh still calls it a volume after. Mass, centre of mass and gravity compensation of a hollow
# probe follow from it, and a check by the other library agrees. In trimesh use fix_normals(multibody=False), in VTK
# leave auto-orient off; both then leave it as it was. Compare the volume before and after.
#
# Seen with trimesh 5.2.0, VTK 9.7.2, pyvista 0.49.1, scipy 1.17.1 and numpy 2.4.6 on Python 3.11.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check \
  "trimesh==5.2.0" "networkx==3.6.1" "scipy==1.17.1" "vtk==9.7.2" "pyvista==0.49.1" "numpy==2.4.6"
cat >"$folder/case.py" <<'PY'
import pyvista
import trimesh

ball, cavity = trimesh.creation.icosphere(4, radius=10.0), trimesh.creation.icosphere(4, radius=8.0)
cavity.invert()
hollow = trimesh.util.concatenate([ball, cavity])
print("solid", round(ball.volume))
print("hollow", round(hollow.volume), hollow.is_volume)
fixed, checked, kept = hollow.copy(), hollow.copy(), hollow.copy()
fixed.fix_normals()
checked.process(validate=True)
kept.fix_normals(multibody=False)
for name, mesh in (("fix_normals", fixed), ("validate", checked), ("one body", kept)):
    print(name, round(mesh.volume), mesh.is_volume)
for auto in (True, False):
    surface = pyvista.wrap(hollow).compute_normals(auto_orient_normals=auto)
    again = trimesh.Trimesh(surface.points, surface.faces.reshape(-1, 4)[:, 1:], process=False)
    print("auto-orient" if auto else "VTK", round(again.volume))
PY
read=$("$folder/venv/bin/python" "$folder/case.py")
echo "$read"
expected='solid 4180
hollow 2040 True
fix_normals 6320 True
validate 6320 True
one body 2040 True
auto-orient 6320
VTK 2040'
[[ $read == "$expected" ]] || { echo "CHANGED: a cavity is treated another way now"; exit 1; }
