"""Receives alerts of Alertmanager and writes a line each: webhook.py FILE. Prints its address."""
import http.server
import json
import sys


class Hook(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        with open(sys.argv[1], "a", encoding="utf-8") as file:
            for alert in body["alerts"]:
                file.write(f"{alert['status']} {alert['labels']['alertname']}: "
                           f"{alert['annotations']['summary']}\n")
        self.send_response(200)
        self.end_headers()

    def log_message(self, *_):
        pass


server = http.server.HTTPServer(("127.0.0.1", 0), Hook)
print(f"127.0.0.1:{server.server_port}", flush=True)
server.serve_forever()
