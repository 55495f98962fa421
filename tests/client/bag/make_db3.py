#!/usr/bin/python3
"""Writes a database of rosbag2 for the tests: make_db3.py FILE. The frames are those of make_ros1.py."""
import os
import sqlite3
import struct
import sys


class Cdr:
    """Little endian; aligned behind its head."""

    def __init__(self):
        self.data = b""

    def put(self, form, *values):
        for value in values:
            size = struct.calcsize(form)
            self.data += b"\0" * (-len(self.data) % size) + struct.pack("<" + form, value)
        return self

    def text(self, value):
        self.put("I", len(value) + 1)
        self.data += value.encode() + b"\0"
        return self

    def bytes(self):
        return b"\0\1\0\0" + self.data


def header(frame):
    return Cdr().put("i", 1000).put("I", frame * 100_000_000).text("camera")


def image(frame, right):
    message = header(frame).put("I", 6, 8).text("mono8").put("B", 0).put("I", 8, 48)
    message.data += bytes((200 - frame - i if right else frame + i) for i in range(48))
    return message.bytes()


def camera():
    message = header(0).put("I", 6, 8).text("plumb_bob").put("I", 5)
    message.put("d", -0.25, 0.0625, 0, 0, 0)
    message.put("d", 7, 0, 4, 0, 7.5, 3, 0, 0, 1)
    message.put("d", 1, 0, 0, 0, 1, 0, 0, 0, 1)
    return message.put("d", 6, 0, 4, 0, 0, 6, 3, 0, 0, 0, 1, 0).bytes()


def main(path):
    if os.path.exists(path):
        os.remove(path)
    bag = sqlite3.connect(path)
    bag.execute("PRAGMA page_size = 512")
    bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
                " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
                " timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    bag.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    for name, kind in (("left/image_raw", "Image"), ("right/image_raw", "Image"),
                       ("left/camera_info", "CameraInfo")):
        bag.execute("INSERT INTO topics(name, type, serialization_format, offered_qos_profiles)"
                    " VALUES(?, ?, 'cdr', '')", ("/cam/" + name, "sensor_msgs/msg/" + kind))
    add = "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)"
    bag.execute(add, (3, 1000_000_000_007, camera()))
    for frame in range(12):
        time = 1000_000_000_007 + frame * 100_000_000
        bag.execute(add, (1, time, image(frame, False)))
        bag.execute(add, (2, time, image(frame, True)))
    bag.commit()
    bag.close()


main(sys.argv[1])
