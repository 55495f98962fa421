"""What is sent, and sent again."""

import unittest

from homing.outbox import Outbox
from homing.v1 import types_pb2


def add(outbox, count):
    for _ in range(count):
        outbox.add(types_pb2.Observation())


def sent(outbox):
    numbers = []
    while (kept := outbox.next_kept()) is not None:
        numbers.append((kept.sequence, kept.break_before))
    return numbers


class OutboxTest(unittest.TestCase):

    def test_after_a_break_the_reference_and_all_that_is_not_durable(self):
        outbox = Outbox()
        outbox.begin(0, 0)
        add(outbox, 5)
        self.assertEqual([number for number, _ in sent(outbox)], [0, 1, 2, 3, 4])
        outbox.acknowledge(3, 1)
        outbox.begin(3, 1)
        self.assertEqual(sent(outbox), [(1, False), (3, False), (4, False)])

    def test_without_the_reference_there_is_a_break(self):
        outbox = Outbox()
        outbox.begin(0, 0)
        add(outbox, 5)
        sent(outbox)
        outbox.acknowledge(3, 3)
        outbox.begin(3, 1)
        self.assertEqual(sent(outbox), [(3, True), (4, False)])

    def test_a_source_that_begins_again_leaves_out_what_is_durable(self):
        outbox = Outbox()
        outbox.begin(4, 2)
        add(outbox, 6)
        self.assertEqual(sent(outbox), [(2, False), (4, False), (5, False)])

    def test_a_live_source_goes_on_behind_a_break(self):
        outbox = Outbox(live=True)
        outbox.begin(4, 2)
        add(outbox, 2)
        self.assertEqual(sent(outbox), [(4, True), (5, False)])


if __name__ == "__main__":
    unittest.main()
