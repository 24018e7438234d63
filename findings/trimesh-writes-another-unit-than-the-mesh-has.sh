#!/usr/bin/env bash
# trimesh writes a mesh's numbers as they are under the unit of the file format, whatever unit the mesh is in.
#
# A 3MF file states its unit, a COLLADA file may, and glTF is always in metres. trimesh 5.2.0 reads it into mesh.units,
# but its export neither converts the coordinates nor states the unit: 3MF always says millimeter, COLLADA says nothing,
# which means metre, and glTF gets the unit as a private remark ("extras") beside numbers that are not metres. A cube of
# 0.02 m is 0.02 mm in 3MF, one of 20 mm is 20 m in COLLADA and glTF, and a 3MF in inches that is only loaded and saved
# again shrinks by 25.4. A probe that went this way has its contacts off by that factor and its mass by the cube. Call
# mesh.convert_units("mm") before 3MF and mesh.convert_units("m") before the other two.
#
# Seen with trimesh 5.2.0, lxml 6.1.3, networkx 3.6.1, pycollada 0.9.3, scipy 1.17.1 and numpy 2.4.6 on Python 3.11.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check \
  "trimesh==5.2.0" "lxml==6.1.3" "networkx==3.6.1" "pycollada==0.9.3" "numpy==2.4.6" "scipy==1.17.1"
cat >"$folder/case.py" <<'PY'
import io
import json
import re
import struct
import sys
import zipfile
from pathlib import Path

import numpy as np
import trimesh

folder = Path(sys.argv[1])


def cube(edge: float, unit: str) -> trimesh.Trimesh:
    mesh = trimesh.creation.box([edge] * 3)
    mesh.units = unit
    return mesh


def in_3mf(data: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        text = archive.read("3D/3dmodel.model").decode()
    x = [float(value) for value in re.findall(r'<vertex[^>]* x="([^"]+)"', text)]
    unit = re.search(r'unit="(\w+)"', text)[1]
    return f"{np.ptp(x):g} {unit}"


def in_collada(data: bytes) -> str:
    text = data.decode()
    x = [float(value) for value in re.search(r"<float_array[^>]*>([^<]+)<", text)[1].split()[::3]]
    unit = re.search(r'<unit[^>]*meter="([^"]+)"', text)
    return f"{np.ptp(x):g} of {float(unit[1]) if unit else 1.0:g} m"


def in_gltf(data: bytes) -> str:
    length = struct.unpack("<I", data[12:16])[0]
    accessors = json.loads(data[20 : 20 + length])["accessors"]
    box = next(a for a in accessors if a["type"] == "VEC3")
    return f"{box['max'][0] - box['min'][0]:g} m"


print("3MF of 0.02 m:", in_3mf(cube(0.02, "m").export(file_type="3mf")))
print("COLLADA of 20 mm:", in_collada(cube(20, "mm").export(file_type="dae")))
print("glTF of 20 mm:", in_gltf(cube(20, "mm").export(file_type="glb")))

with zipfile.ZipFile(io.BytesIO(cube(2, "inch").export(file_type="3mf"))) as old:
    with zipfile.ZipFile(folder / "inch.3mf", "w") as new:
        for name in old.namelist():
            new.writestr(name, old.read(name).replace(b'unit="millimeter"', b'unit="inch"'))
loaded = trimesh.load_mesh(folder / "inch.3mf")
print("3MF loaded:", f"{loaded.extents[0]:g}", loaded.units)
print("3MF saved:", in_3mf(loaded.export(file_type="3mf")))
print("3MF converted:", in_3mf(loaded.convert_units("mm").export(file_type="3mf")))
print("COLLADA converted:", in_collada(cube(20, "mm").convert_units("m").export(file_type="dae")))
print("glTF converted:", in_gltf(cube(20, "mm").convert_units("m").export(file_type="glb")))
PY
read=$("$folder/venv/bin/python" "$folder/case.py" "$folder")
echo "$read"
expected='3MF of 0.02 m: 0.02 millimeter
COLLADA of 20 mm: 20 of 1 m
glTF of 20 mm: 20 m
3MF loaded: 2 inch
3MF saved: 2 millimeter
3MF converted: 50.8 millimeter
COLLADA converted: 0.02 of 1 m
glTF converted: 0.02 m'
[[ $read == "$expected" ]] || { echo "CHANGED: units are written another way now"; exit 1; }
