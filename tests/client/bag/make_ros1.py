#!/usr/bin/python3
"""Writes ROS 1 bags for the tests: make_ros1.py FOLDER (needs python3-rosbag, python3-sensor-msgs).

Each bag has twelve frames of a left and a right camera, 8 x 6 pixels, mono8: pixel i of frame n is
n + i on the left and 200 - n - i on the right, at n / 10 s after 1000 s; and the left camera's
camera_info.
"""
import sys

import genpy
import rosbag
from sensor_msgs.msg import CameraInfo, Image


def image(frame, right):
    message = Image(height=6, width=8, encoding="mono8", step=8)
    message.header.stamp = genpy.Time(1000, frame * 100_000_000)
    message.data = bytes((200 - frame - i if right else frame + i) for i in range(48))
    return message


def main(folder):
    for compression in ("none", "bz2", "lz4"):
        # Small chunks, so that there are several.
        with rosbag.Bag(f"{folder}/{compression}.bag", "w", compression, chunk_threshold=500) as bag:
            info = CameraInfo(height=6, width=8, distortion_model="plumb_bob")
            info.K = [7, 0, 4, 0, 7.5, 3, 0, 0, 1]
            info.D = [-0.25, 0.0625, 0, 0, 0]
            info.P = [6, 0, 4, 0, 0, 6, 3, 0, 0, 0, 1, 0]
            bag.write("/cam/left/camera_info", info, genpy.Time(1000))
            for frame in range(12):
                time = genpy.Time(1000, frame * 100_000_000 + 7)
                bag.write("/cam/left/image_raw", image(frame, False), time)
                bag.write("/cam/right/image_raw", image(frame, True), time)


main(sys.argv[1])
