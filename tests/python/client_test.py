"""The client against a server: HOMING_SERVER_PROGRAM names it."""

import asyncio
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import homing
import numpy as np

JOURNEY = "robots/r1/journeys/out"


def frames(count, start=0):
    """A camera that passes a rough wall, 4 pixels a frame."""
    random = np.random.default_rng(7)
    wall = np.kron(random.integers(40, 216, (20, 200)), np.ones((6, 6))).astype(np.uint8)
    return [np.ascontiguousarray(wall[:, 4 * i:4 * i + 160]) for i in range(start, start + count)]


class ClientTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.flags = []
        self.server = None
        self.address = "127.0.0.1:0"

    def tearDown(self):
        self.stop(signal.SIGKILL)
        self.folder.cleanup()

    def path(self, name):
        return str(pathlib.Path(self.folder.name) / name)

    def start(self):
        with open(self.path("log"), "w", encoding="utf-8") as log:
            self.server = subprocess.Popen(
                [os.environ["HOMING_SERVER_PROGRAM"], "--http", "off", "--listen", self.address,
                 "--database", "sqlite:" + self.path("homing.db"), *self.flags],
                stdout=subprocess.PIPE, stderr=log, text=True)
        line = self.server.stdout.readline()
        self.assertIn("listening on ", line, pathlib.Path(self.path("log")).read_text())
        self.address = line.split()[-1]

    def stop(self, how=signal.SIGTERM):
        if self.server is not None:
            self.server.send_signal(how)
            self.server.wait()
            self.server.stdout.close()
            self.server = None

    def test_records_and_localises(self):
        self.start()
        with homing.Client(self.address) as client:
            recorded = list(client.record(JOURNEY, frames(40)))
            self.assertEqual([one.sequence for one in recorded], list(range(40)))
            self.assertGreater(sum(one.step is not None for one in recorded), 20)
            journey = client.get(JOURNEY)
            self.assertTrue(journey.finished)
            self.assertEqual([one.name for one in client.journeys()], [JOURNEY])
            answers = list(client.localize(JOURNEY, frames(20, start=10),
                                           travel=homing.Travel.SAME))
            self.assertEqual(len(answers), 20)
            self.assertIn(answers[-1].outcome, (homing.Outcome.MATCH, homing.Outcome.AMBIGUOUS))
            self.assertLess(abs(answers[-1].step - 29), 4)
            matches = client.match(JOURNEY, *frames(2, start=20), travel=homing.Travel.SAME)
            self.assertTrue(all(0 <= one.p_t <= 1 for one in matches))
            client.delete(JOURNEY)
            with self.assertRaises(homing.HomingError) as caught:
                client.get(JOURNEY)
            self.assertEqual(caught.exception.code, "NOT_FOUND")

    def test_names_the_trace_of_its_calls(self):
        self.flags = ["--log-format", "json"]
        self.start()
        trace = "0af7651916cd43dd8448eb211c80319c"
        server = homing.Server(address=self.address,
                               traceparent=f"00-{trace}-b7ad6b7169203331-01")
        with homing.Client(server) as client:
            list(client.record(JOURNEY, frames(5)))

        async def localise():
            async with homing.AsyncClient(server) as client:
                return [one async for one in client.localize(JOURNEY, frames(3))]

        asyncio.run(localise())
        self.stop()
        log = pathlib.Path(self.path("log")).read_text(encoding="utf-8")
        lines = [json.loads(line) for line in log.splitlines() if line.startswith("{")]
        calls = [line for line in lines
                 if line.get("trace_id") == trace and "call: " in line["message"]]
        for method in ("CreateJourney", "RecordJourney", "FinishJourney", "Localize"):
            self.assertTrue(any(method in line["message"] for line in calls), method)
        # Each call is a span.
        self.assertEqual(len({line["span_id"] for line in calls}), len(calls))

    def killing(self, at):
        """Frames, during which the server is killed and starts again."""
        for i, frame in enumerate(frames(40)):
            if i == at:
                self.stop(signal.SIGKILL)
                self.start()
            yield frame

    def expect_ascending(self, recorded):
        """What is durable and was not answered before the kill has no answer."""
        numbers = [one.sequence for one in recorded]
        self.assertEqual(numbers, sorted(set(numbers)))
        self.assertEqual((numbers[0], numbers[-1]), (0, 39))
        self.assertGreater(len(numbers), 30)

    def test_a_killed_server_loses_nothing(self):
        self.start()
        with homing.Client(self.address) as client:
            list(client.record("robots/r1/journeys/whole", frames(40)))
            recorded = list(client.record(JOURNEY, self.killing(at=17), window=4))
            self.expect_ascending(recorded)
            whole = client.get("robots/r1/journeys/whole")
            self.assertEqual(client.get(JOURNEY).fingerprints, whole.fingerprints)
            answers = list(client.localize(JOURNEY, self.killing(at=20), window=4,
                                           travel=homing.Travel.SAME))
            self.assertEqual([one.sequence for one in answers], list(range(40)))

    def test_a_program_that_runs_again_goes_on(self):
        self.start()
        with homing.Client(self.address) as client:
            for one in client.record(JOURNEY, frames(40), window=4):
                if one.sequence == 11:
                    break
            again = list(client.record(JOURNEY, frames(40)))
            self.assertGreaterEqual(again[0].sequence, 12)
            self.assertEqual(again[-1].sequence, 39)
            self.assertEqual(client.get(JOURNEY).next_sequence, 40)

    def test_errors_of_the_source_and_of_the_server_are_raised(self):
        self.start()

        def broken():
            yield from frames(3)
            raise OSError("no camera")

        with homing.Client(self.address) as client:
            with self.assertRaisesRegex(OSError, "no camera"):
                list(client.record(JOURNEY, broken()))
            self.assertEqual(client.get(JOURNEY).next_sequence, 3)
            with self.assertRaises(homing.HomingError) as caught:
                list(client.localize("robots/r1/journeys/none", frames(2)))
            self.assertEqual(caught.exception.code, "NOT_FOUND")
            with self.assertRaises(homing.HomingError):
                list(client.record("out", frames(2)))

    def test_asyncio_over_tls(self):
        program = os.environ["HOMING_SERVER_PROGRAM"]
        pki = self.path("pki")
        subprocess.run([program, "certs", "--out", pki, "--host", "localhost", "--host",
                        "127.0.0.1", "--robot", "r1"], check=True, stdout=subprocess.DEVNULL)
        self.flags = ["--tls-cert", pki + "/server.pem", "--tls-key", pki + "/server.key",
                      "--tls-client-ca", pki + "/ca.pem"]
        self.start()
        server = homing.Server(self.address, tls_ca=pki + "/ca.pem",
                               tls_cert=pki + "/robots/r1.pem", tls_key=pki + "/robots/r1.key")

        async def drive():
            async def live(images):
                for image in images:
                    await asyncio.sleep(0)
                    yield image

            async with homing.AsyncClient(server) as client:
                recorded = [one async for one in client.record(JOURNEY, live(frames(40)))]
                answers = [one async for one in client.localize(
                    JOURNEY, live(frames(20, start=10)), travel=homing.Travel.SAME)]
                names = [one.name async for one in client.journeys("robots/r1")]
                return recorded, answers, names

        recorded, answers, names = asyncio.run(drive())
        self.assertEqual(len(recorded), 40)
        self.assertEqual(len(answers), 20)
        self.assertEqual(names, [JOURNEY])

    def test_asyncio_survives_a_killed_server(self):
        self.start()

        async def drive():
            async with homing.AsyncClient(self.address) as client:
                recorded = [one async for one in client.record(JOURNEY, self.killing(at=17),
                                                               window=4)]
                answers = [one async for one in client.localize(
                    JOURNEY, self.killing(at=20), window=4, travel=homing.Travel.SAME)]
                return recorded, answers

        recorded, answers = asyncio.run(drive())
        self.expect_ascending(recorded)
        self.assertEqual([one.sequence for one in answers], list(range(40)))

    def test_asyncio_source_that_awaits_a_cancelled_task(self):
        self.start()

        async def camera(images):
            for image in images:
                yield image
            lost = asyncio.ensure_future(asyncio.sleep(60))
            lost.cancel()
            await lost

        async def run(method):
            async for _ in method(JOURNEY, camera(frames(12))):
                pass

        async def drive():
            async with homing.AsyncClient(self.address) as client:
                for method in (client.record, client.localize):
                    with self.assertRaises(asyncio.CancelledError):
                        await asyncio.wait_for(run(method), 20)
                return await client.get(JOURNEY)

        journey = asyncio.run(drive())
        self.assertEqual((journey.next_sequence, journey.finished), (12, False))

    def test_asyncio_takes_no_more_from_a_live_camera_than_its_window(self):
        self.start()

        async def drive():
            async with homing.AsyncClient(self.address) as client:
                async for _ in client.record(JOURNEY, frames(40), finish=False):
                    pass
                taken, answered, most = 0, 0, 0

                def camera():
                    nonlocal taken, most
                    for image in frames(40):
                        taken += 1
                        most = max(most, taken - answered)
                        yield image

                async for _ in client.record(JOURNEY, camera(), live=True, window=4):
                    answered += 1
                return answered, most

        answered, most = asyncio.run(drive())
        self.assertEqual(answered, 40)
        self.assertLessEqual(most, 6)

    def test_of_several_servers_one_that_answers_is_taken(self):
        self.start()
        for address in (f"127.0.0.1:9,{self.address}", f"{self.address},localhost:9",
                        f"dns:///{self.address}"):
            with homing.Client(address) as client:
                self.assertEqual(list(client.journeys()), [])

            async def count():
                async with homing.AsyncClient(address) as client:
                    return len([one async for one in client.journeys()])

            self.assertEqual(asyncio.run(count()), 0)
        with self.assertRaisesRegex(homing.HomingError, "no.such.host"):
            homing.Client(f"no.such.host.invalid:9,{self.address}")

    def test_no_server(self):
        with homing.Client(homing.Server("127.0.0.1:9", retry_for=0.2)) as client:
            begun = time.monotonic()
            with self.assertRaises(homing.HomingError) as caught:
                client.get(JOURNEY)
            self.assertEqual(caught.exception.code, "UNAVAILABLE")
            self.assertLess(time.monotonic() - begun, 10)


if __name__ == "__main__":
    unittest.main()
