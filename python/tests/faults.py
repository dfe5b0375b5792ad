"""A proxy that stands between a program and an HTTP server, and breaks what it is told to break."""

import http.client
import random
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

SLOW_DOWN = b"<?xml version='1.0'?><Error><Code>SlowDown</Code><Message>Reduce your request rate.</Message></Error>"


class Handler(BaseHTTPRequestHandler):
    """Passes one request on, or fails in one of the ways that networks and servers do."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def handle_one_request(self):
        try:
            super().handle_one_request()
        except (BrokenPipeError, ConnectionResetError):
            self.close_connection = True

    def do(self):
        proxy = self.server.proxy
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        fault = proxy.draw()
        if fault == "cut before":
            self.close_connection = True
            return
        if fault == "refused":
            self.answer(503, {"Content-Type": "application/xml"}, SLOW_DOWN)
            return
        if fault == "slow":
            time.sleep(0.3)
        server = http.client.HTTPConnection(proxy.host, timeout=60)
        server.request(self.command, self.path, body, dict(self.headers))
        got = server.getresponse()
        answer = got.read()
        headers = {
            key: value for key, value in got.getheaders() if key.lower() not in ("transfer-encoding", "connection")
        }
        server.close()
        if fault == "cut after":
            self.close_connection = True
            return
        self.answer(got.status, headers, answer, torn=fault == "torn")

    do_GET = do_PUT = do_POST = do_DELETE = do_HEAD = do

    def answer(self, status, headers, body, torn=False):
        self.send_response(status)
        length = headers.pop("Content-Length", len(body)) if self.command == "HEAD" else len(body)
        for key, value in headers.items():
            if key.lower() not in ("content-length", "server", "date"):
                self.send_header(key, value)
        self.send_header("Content-Length", str(length))
        self.end_headers()
        if self.command == "HEAD":
            return
        if torn:
            body, self.close_connection = body[: len(body) // 2], True
        self.wfile.write(body)
        self.wfile.flush()

    def log_message(self, *_):
        pass


class Faults:
    """The proxy. Every request fails with a probability, in a way that a seed draws; `count` says how many did."""

    WAYS = ("cut before", "cut after", "refused", "slow", "torn")

    def __init__(self, host, probability, seed):
        self.host, self.probability = host, probability
        self.random, self.lock, self.count = random.Random(seed), threading.Lock(), dict.fromkeys(self.WAYS, 0)
        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.proxy = self
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.server.server_port}"

    def draw(self):
        with self.lock:
            if self.random.random() >= self.probability:
                return None
            fault = self.random.choice(self.WAYS)
            self.count[fault] += 1
            return fault

    def close(self):
        self.server.shutdown()
        self.server.server_close()


def host_of(address):
    return urlsplit(address).netloc
