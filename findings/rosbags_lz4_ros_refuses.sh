#!/usr/bin/env bash
# rosbags 0.11.9 and ROS' own library (librosbag-storage 1.15.15, from Debian): a bag that rosbags packs by lz4 cannot be read by ROS.
# ROS reads lz4 frames only as it writes them: independent blocks, a checksum of the content, no size of the content. rosbags takes the
# defaults of the lz4 package, which differ in all three. Packed otherwise, or by bz2, the same bag is read.
# Needs: apt-get install librosbag-storage-dev g++
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 rosbags==0.11.9 lz4==4.4.5
cd "$folder"
cat > count.cpp <<'CPP'
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <cstdio>

int main(int, char** arguments) {
  try {
    rosbag::Bag bag(arguments[1]);
    std::size_t bytes = 0;
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) bytes += message.size();
    std::printf("%zu bytes of messages\n", bytes);
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
  }
}
CPP
includes=()
for package in pluginlib class_loader rcutils rcpputils ament_index_cpp; do includes+=("-I/usr/include/$package"); done
g++ -O1 "${includes[@]}" count.cpp -o count -lrosbag_storage -lroscpp_serialization -lrostime -lcpp_common -lconsole_bridge
"$folder/environment/bin/python" - <<'PYTHON'
import subprocess

import lz4.frame
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS1_NOETIC)
text = store.types["std_msgs/msg/String"]("word " * 200)

def said(name, compression, compressor=None):
    writer = Writer(name)
    writer.set_compression(compression)
    if compressor:
        writer.compressor = compressor
    with writer:
        topic = writer.add_connection("/words", "std_msgs/msg/String", typestore=store)
        for i in range(100):
            writer.write(topic, 1 + i, bytes(store.serialize_ros1(text, "std_msgs/msg/String")))
    answer = subprocess.run(["./count", name], capture_output=True, text=True, check=True).stdout.strip()
    print("%s: %s" % (name, answer))
    return answer

as_ros = dict(block_linked=False, store_size=False, content_checksum=True)
whole = "100400 bytes of messages"
assert said("bz2.bag", Writer.CompressionFormat.BZ2) == whole
assert "ROSLZ4" in said("lz4.bag", Writer.CompressionFormat.LZ4)
assert said("lz4_as_ros.bag", Writer.CompressionFormat.LZ4, lambda chunk: lz4.frame.compress(chunk, **as_ros)) == whole
for name in as_ros:
    without = {key: value for key, value in as_ros.items() if key != name}
    assert "ROSLZ4" in said("without_%s.bag" % name, Writer.CompressionFormat.LZ4, lambda chunk: lz4.frame.compress(chunk, **without))
PYTHON
