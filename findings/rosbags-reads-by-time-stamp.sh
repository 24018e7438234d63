#!/usr/bin/env bash
# rosbags hands out a bag's messages by their time stamps, not as they were recorded: a clock set back cannot be seen.
#
# A recorder whose computer gets its time corrected (NTP, PTP) stamps later messages earlier. The order in which they
# were written is the only trace of it: rows of a SQLite bag have ascending numbers, messages of an MCAP chunk stand one
# after the other. rosbags 0.11.9 sorts both by time stamp, without a word and without an option, so the two stretches
# come interleaved: here a force that rises from 0 to 5 comes back as 0 3 1 4 2 5. Whoever pairs such readings with
# poses pairs those of different moments. The mcap library can give them as they were recorded (log_time_order=False).
#
# Seen with rosbags 0.11.9 on Python 3.11, SQLite and MCAP alike.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check "rosbags==0.11.9"
cat >"$folder/case.py" <<'PY'
import sys
from pathlib import Path

from rosbags.rosbag2 import Reader, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS2_HUMBLE)
Float = store.types["std_msgs/msg/Float64"]
stamps = [0, 100, 200, 50, 150, 250]  # ms: set back by 150 ms after the third
for plugin in (StoragePlugin.SQLITE3, StoragePlugin.MCAP):
    bag = Path(sys.argv[1]) / plugin.name
    with Writer(bag, version=9, storage_plugin=plugin) as writer:
        force = writer.add_connection("/force", Float.__msgtype__, typestore=store)
        for value, stamp in enumerate(stamps):
            data = store.serialize_cdr(Float(data=float(value)), Float.__msgtype__)
            writer.write(force, stamp * 1_000_000, data)
    with Reader(bag) as reader:
        read = [int(store.deserialize_cdr(data, c.msgtype).data) for c, _, data in reader.messages()]
    print(plugin.name, *read)
PY
read=$("$folder/venv/bin/python" "$folder/case.py" "$folder")
echo "$read"
[[ $read == $'SQLITE3 0 3 1 4 2 5\nMCAP 0 3 1 4 2 5' ]] || { echo "CHANGED: the order is another one now"; exit 1; }
