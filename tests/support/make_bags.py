#!/usr/bin/python3
"""Writes a drive of `homing simulate` as bags of every format: make_bags.py [--png] DRIVE OUT.

The frames of DRIVE/left and DRIVE/right (8-bit grey PNG) become messages on /cam/left and /cam/right, a
tenth of a second apart: sensor_msgs/Image in mono8, with --png sensor_msgs/CompressedImage. Uses only the
standard library, libzstd and liblz4. tests/client/bag has files that other programs wrote.
"""
import bz2
import ctypes
import glob
import os
import sqlite3
import struct
import sys
import zlib

START_S = 1000
STEP_NS = 100_000_000
CHUNK_BYTES = 1 << 18


def predict(kind, left, up, corner):
    """What PNG adds to a byte."""
    if kind == 3:
        return (left + up) // 2
    if kind == 4:
        a, b, c = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
        return left if a <= b and a <= c else up if b <= c else corner
    return (0, left, up)[kind]


def read_png(path):
    """Width, height and pixels."""
    with open(path, "rb") as file:
        data = file.read()
    width, height, depth, colour = struct.unpack_from(">IIBB", data, 16)
    assert (depth, colour) == (8, 0), f"{path} is not 8-bit grey"
    packed, at = b"", 8
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    lines = zlib.decompress(packed)
    above, pixels = bytes(width), b""
    for y in range(height):
        line = bytearray(lines[y * (width + 1):(y + 1) * (width + 1)])
        kind, row = line[0], line[1:]
        for x in range(width if kind else 0):
            left, corner = (row[x - 1], above[x - 1]) if x else (0, 0)
            row[x] = (row[x] + predict(kind, left, above[x], corner)) & 255
        above = bytes(row)
        pixels += above
    return width, height, pixels


def text(value):
    """After its length."""
    value = value if isinstance(value, bytes) else value.encode()
    return struct.pack("<I", len(value)) + value


def ros1(number, frame):
    """A message of ROS 1."""
    head = struct.pack("<III", number, START_S + number // 10, number % 10 * STEP_NS) + text("camera")
    if "format" in frame:
        return head + text(frame["format"]) + text(frame["data"])
    return (head + struct.pack("<II", frame["height"], frame["width"]) + text("mono8")
            + struct.pack("<BI", 0, frame["width"]) + text(frame["data"]))


def cdr(number, frame):
    """A message of ROS 2: numbers are aligned, texts end with a zero."""
    def aligned(data):
        return data + b"\0" * (-len(data) % 4)
    out = aligned(struct.pack("<iI", START_S + number // 10, number % 10 * STEP_NS) + text("camera\0"))
    if "format" in frame:
        out = aligned(out + text(frame["format"] + "\0"))
    else:
        out += struct.pack("<II", frame["height"], frame["width"]) + text("mono8\0") + b"\0"
        out = aligned(out) + struct.pack("<I", frame["width"])
    return b"\0\1\0\0" + out + text(frame["data"])


def compress(kind, data):
    """By the names of the formats."""
    if kind == "bz2":
        return bz2.compress(data)
    if kind == "none":
        return data
    room = len(data) + (1 << 16)
    out = ctypes.create_string_buffer(room)
    sizes = out, ctypes.c_size_t(room), data, ctypes.c_size_t(len(data))
    if kind == "zstd":
        size = ctypes.CDLL("libzstd.so.1").ZSTD_compress(*sizes, 1)
    else:
        # As ROS writes them: blocks of 4 MB, independent of each other, and a checksum.
        size = ctypes.CDLL("liblz4.so.1").LZ4F_compressFrame(*sizes, struct.pack("<IIIIQIIiIIIII", 7, 1, 1, *[0] * 10))
    return out.raw[:size]


def chunks(messages):
    """Lists of messages of about CHUNK_BYTES."""
    chunk, size = [], 0
    for message in messages:
        chunk.append(message)
        size += len(message[3]["data"])
        if size > CHUNK_BYTES:
            yield chunk
            chunk, size = [], 0
    if chunk:
        yield chunk


def write_mcap(path, kind, drive):
    """Chunks with their indexes; no summary."""
    def record(opcode, data):
        return struct.pack("<BQ", opcode, len(data)) + data
    name = "sensor_msgs/msg/" + drive["type"]
    heads = record(3, struct.pack("<H", 1) + text(name) + text("ros2msg") + text(""))
    for channel, topic in enumerate(drive["topics"]):
        heads += record(4, struct.pack("<HH", channel, 1) + text(topic) + text("cdr") + text(""))
    with open(path, "wb") as file:
        file.write(b"\x89MCAP0\r\n" + record(1, text("ros2") + text("test")))
        for chunk in chunks(drive["messages"]):
            records, index = heads, {}
            for number, channel, time, frame in chunk:
                index.setdefault(channel, b"")
                index[channel] += struct.pack("<QQ", time, len(records))
                records += record(5, struct.pack("<HIQQ", channel, number, time, time) + cdr(number, frame))
            packed = compress(kind, records)
            file.write(record(6, struct.pack("<QQQI", chunk[0][2], chunk[-1][2], len(records), zlib.crc32(records))
                              + text("" if kind == "none" else kind) + struct.pack("<Q", len(packed)) + packed))
            for channel, entries in index.items():
                file.write(record(7, struct.pack("<H", channel) + text(entries)))
        file.write(record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n")


def write_ros1(path, kind, drive):
    """Chunks with their indexes; connections and chunk infos at the end."""
    def record(data, **fields):
        head = b"".join(text(name.encode() + b"=" + value) for name, value in fields.items())
        return text(head) + text(data)
    def number(value):
        return struct.pack("<I", value)
    def stamp(time):
        return struct.pack("<II", time // 10**9, time % 10**9)
    connections = b""
    for channel, topic in enumerate(drive["topics"]):
        about = (text("topic=" + topic) + text("type=sensor_msgs/" + drive["type"])
                 + text("md5sum=*") + text("message_definition="))
        connections += record(about, op=b"\7", conn=number(channel), topic=topic.encode())
    infos, count = b"", 0
    with open(path, "wb") as file:
        file.write(b"#ROSBAG V2.0\n" + b" " * 4117)
        for chunk in chunks(drive["messages"]):
            records, index, begin = connections, {}, file.tell()
            for step, channel, time, frame in chunk:
                index.setdefault(channel, []).append(stamp(time) + number(len(records)))
                records += record(ros1(step, frame), op=b"\2", conn=number(channel), time=stamp(time))
            file.write(record(compress(kind, records), op=b"\5", compression=kind.encode(), size=number(len(records))))
            for channel, entries in index.items():
                file.write(record(b"".join(entries), op=b"\4", ver=number(1), conn=number(channel),
                                  count=number(len(entries))))
            counts = b"".join(number(channel) + number(len(entries)) for channel, entries in index.items())
            infos += record(counts, op=b"\6", ver=number(1), chunk_pos=struct.pack("<Q", begin),
                            start_time=stamp(chunk[0][2]), end_time=stamp(chunk[-1][2]), count=number(len(index)))
            count += 1
        end = file.tell()
        file.write(connections + infos)
        file.seek(13)
        about = dict(op=b"\3", index_pos=struct.pack("<Q", end), conn_count=number(len(drive["topics"])),
                     chunk_count=number(count))
        # The first record has 4117 bytes, whatever its header.
        file.write(record(b" " * (4117 - len(record(b"", **about))), **about))


def write_db3(path, drive):
    """The tables of rosbag2."""
    bag = sqlite3.connect(path)
    bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
                " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
                " timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    for channel, topic in enumerate(drive["topics"]):
        bag.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (channel, topic, "sensor_msgs/msg/" + drive["type"]))
    for number, channel, time, frame in drive["messages"]:
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                    (channel, time, cdr(number, frame)))
    bag.commit()
    bag.close()


def read_frame(path, as_png):
    """What a message holds of a frame."""
    if not as_png:
        return dict(zip(("width", "height", "data"), read_png(path)))
    with open(path, "rb") as file:
        return {"format": "png", "data": file.read()}


def main():
    as_png = sys.argv[1] == "--png"
    folder, out = sys.argv[-2:]
    cameras = [sorted(glob.glob(f"{folder}/{camera}/*.png")) for camera in ("left", "right")]
    drive = {
        "type": "CompressedImage" if as_png else "Image",
        "topics": ["/cam/left/image_raw", "/cam/right/image_raw"],
        "messages": [(number, channel, START_S * 10**9 + number * STEP_NS, read_frame(path, as_png))
                     for number, pair in enumerate(zip(*cameras)) for channel, path in enumerate(pair)],
    }
    os.makedirs(out)
    for kind in ("none", "zstd", "lz4"):
        write_mcap(f"{out}/{kind}.mcap", kind, drive)
    for kind in ("none", "bz2", "lz4"):
        write_ros1(f"{out}/{kind}.bag", kind, drive)
    write_db3(f"{out}/rosbag2.db3", drive)


main()
