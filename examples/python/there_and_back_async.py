"""The same with asyncio and TLS; the way home goes to a plot if python3-matplotlib is installed.

usage: there_and_back_async.py SERVER PKI_FOLDER ROBOT OUT_FOLDER HOME_FOLDER [PLOT.png]
"""

import asyncio
import pathlib
import sys

import homing


async def images(folder):
    for path in sorted(pathlib.Path(folder).iterdir()):
        yield path.read_bytes()


def plot(answers, path):
    from matplotlib import pyplot
    known = [answer for answer in answers if answer.step is not None]
    pyplot.scatter([one.sequence for one in known], [one.step for one in known],
                   c=[one.probability for one in known])
    pyplot.colorbar(label="probability")
    pyplot.xlabel("observation on the way home")
    pyplot.ylabel("step of the way out")
    pyplot.savefig(path)


async def main(address, pki, robot, out, home, picture=None):
    server = homing.Server(address, tls_ca=f"{pki}/ca.pem", tls_cert=f"{pki}/robots/{robot}.pem",
                           tls_key=f"{pki}/robots/{robot}.key")
    journey = f"robots/{robot}/journeys/async"
    async with homing.AsyncClient(server) as client:
        async for recorded in client.record(journey, images(out)):
            print("recorded", recorded.sequence, end="\r")
        answers = [answer async for answer in client.localize(journey, images(home),
                                                               travel=homing.Travel.SAME)]
    found = sum(answer.outcome is homing.Outcome.MATCH for answer in answers)
    print(f"{found} of {len(answers)} places recognised")
    if picture:
        plot(answers, picture)


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
