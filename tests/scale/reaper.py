#!/usr/bin/python3
"""Runs a command and collects its orphans, as process 1 of a container does.

Patroni waits for the end of a database that it did not start itself. A killed database that nothing
collects never ends for it. Process 1 of a test machine may collect late or not at all.
usage: reaper.py COMMAND...
"""
import ctypes
import os
import subprocess
import sys

PR_SET_CHILD_SUBREAPER = 36

if ctypes.CDLL(None, use_errno=True).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) != 0:
    sys.exit("reaper: " + os.strerror(ctypes.get_errno()))
child = subprocess.Popen(sys.argv[1:])
try:
    while True:
        os.wait()
except ChildProcessError:
    pass
