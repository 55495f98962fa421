"""Records a folder of images as a journey, comes home along another one, and plots the way.

usage: there_and_back.py SERVER JOURNEY OUT_FOLDER HOME_FOLDER [return|same]
"""

import pathlib
import sys

import homing


def images(folder):
    return (path.read_bytes() for path in sorted(pathlib.Path(folder).iterdir()))


def main(address, journey, out, home, travel="return"):
    with homing.Client(address) as client:
        steps = sum(one.step is not None for one in client.record(journey, images(out)))
        print(f"recorded {steps} steps")
        for answer in client.localize(journey, images(home), travel=homing.Travel[travel.upper()]):
            place = "?" if answer.progress_home is None else "#" * round(40 * answer.progress_home)
            print(f"{answer.sequence:5} {answer.outcome.name:13} {answer.probability:4.2f} {place}")


if __name__ == "__main__":
    main(*sys.argv[1:])
