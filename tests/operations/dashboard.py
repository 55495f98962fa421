"""Evaluates the queries of all panels of the dashboard: dashboard.py PROMETHEUS. Each must have a finite value."""
import json
import math
import sys
import urllib.parse
import urllib.request

bad = 0
with open("deploy/grafana/homing.json", encoding="utf-8") as file:
    panels = json.load(file)["panels"]
for panel in panels:
    for target in panel["targets"]:
        url = f"http://{sys.argv[1]}/api/v1/query?query=" + urllib.parse.quote(target["expr"])
        with urllib.request.urlopen(url) as answer:
            values = [float(found["value"][1]) for found in json.load(answer)["data"]["result"]]
        good = any(math.isfinite(value) for value in values)
        print("ok" if good else "EMPTY", panel["title"], target["expr"], values[:4])
        bad += not good
sys.exit(bad != 0)
