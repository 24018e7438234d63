#!/usr/bin/env bash
# A TDMS channel with a scale, copied by npTDMS as its documentation shows, holds other forces afterwards.
#
# A data logger stores raw numbers and says in properties of the channel how to turn them into a force (NI_Scale...),
# which npTDMS applies on reading. A channel that was read may be handed to TdmsWriter as it is, say to keep a few
# channels of a long recording. It then writes the scaled forces beside a scale still marked as not applied, and under
# the type of the raw numbers. From raw numbers that are doubles or floats, the copy is scaled once more on reading: 1 3
# 5 7 9 N become 3 7 11 15 19 N, with nothing to tell it by. From 32-bit integers it gives forces up to 2148532225 N,
# and from 16-bit integers a file that cannot be read: ValueError, and the recording is lost if the first file was
# deleted. Write ChannelObject(group, name, channel.read_data(scaled=False), channel.properties) instead, which keeps
# them all; TdmsWriter.defragment, for a whole file, does too. Read a copy before deleting what it was made from.
#
# Seen with npTDMS 1.13.0 and numpy 2.4.6 on Python 3.11.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check "npTDMS==1.13.0" "numpy==2.4.6"
cat >"$folder/case.py" <<'PY'
import sys
from pathlib import Path

import numpy as np
from nptdms import ChannelObject, RootObject, TdmsFile, TdmsWriter

folder = Path(sys.argv[1])
scale = {  # force = 2 * raw + 1, of the raw numbers (0xFFFFFFFF), not of another scale
    "NI_Number_Of_Scales": 1,
    "NI_Scaling_Status": "unscaled",
    "NI_Scale[0]_Scale_Type": "Linear",
    "NI_Scale[0]_Linear_Slope": 2.0,
    "NI_Scale[0]_Linear_Y_Intercept": 1.0,
    "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
}


def forces(path: Path) -> list[int]:
    return [int(force) for force in TdmsFile.read(path)["sensor"]["Fz"][:]]


for kind in (np.float64, np.float32, np.int32, np.int16):
    logged, copied, raw, whole = (folder / f"{name}.tdms" for name in ("logged", "copied", "raw", "whole"))
    with TdmsWriter(logged) as writer:
        writer.write_segment([ChannelObject("sensor", "Fz", np.arange(5, dtype=kind), properties=scale)])
    file = TdmsFile.read(logged)
    channel = file["sensor"]["Fz"]
    above = [RootObject(file.properties), *file.groups()]
    with TdmsWriter(copied) as writer:
        writer.write_segment([*above, channel])
    with TdmsWriter(raw) as writer:
        as_stored = channel.read_data(scaled=False)
        writer.write_segment([*above, ChannelObject("sensor", "Fz", as_stored, channel.properties)])
    TdmsWriter.defragment(logged, whole)
    assert forces(logged) == forces(raw) == forces(whole) == [1, 3, 5, 7, 9], "CHANGED: not even these are right"
    try:
        print(kind.__name__, *forces(copied))
    except ValueError:
        print(kind.__name__, "ValueError")
PY
read=$("$folder/venv/bin/python" "$folder/case.py" "$folder")
echo "$read"
expected='float64 3 7 11 15 19
float32 3 7 11 15 19
int32 1 2145386497 1 2148532225 1
int16 ValueError'
[[ $read == "$expected" ]] || { echo "CHANGED: a copy holds other forces now"; exit 1; }
