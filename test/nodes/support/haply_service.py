# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A simulated Haply Inverse Service: a web socket with an inventory, then one state for each message (versions 3.5 and
3.1, after docs.haply.co/inverseSDK). Its device has what a test sets, and keeps the forces that it is given."""
import base64
import hashlib
import json
import socket
import threading

from web_page import CLOSE, Closed, WebSocket

MAGIC = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # of RFC 6455


class Served(WebSocket):
    """The server's end of a web socket: it sends without a mask, and takes masks off."""

    def __init__(self, connection):
        self.socket, self.rest = connection, b""
        while b"\r\n\r\n" not in self.rest:
            part = connection.recv(1 << 16)
            if not part:
                raise Closed("no request")
            self.rest += part
        head, self.rest = self.rest.split(b"\r\n\r\n", 1)
        lines = dict(line.split(": ", 1) for line in head.decode().split("\r\n")[1:])
        key = base64.b64encode(hashlib.sha1(lines["Sec-WebSocket-Key"].encode() + MAGIC).digest()).decode()
        connection.sendall(("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            "Sec-WebSocket-Accept: %s\r\n\r\n" % key).encode())

    def send(self, data, kind=1):
        data = data.encode() if isinstance(data, str) else data
        assert len(data) < 65536
        size = bytes([len(data)]) if len(data) < 126 else b"\x7e" + len(data).to_bytes(2, "big")
        self.socket.sendall(bytes([128 | kind]) + size + data)

    def receive(self):
        head, size = self.take(2)
        size &= 127
        if size == 126:
            size = int.from_bytes(self.take(2), "big")
        mask = self.take(4)
        data = bytes(b ^ mask[i % 4] for i, b in enumerate(self.take(size)))
        if head & 15 == CLOSE:
            raise Closed("by the client")
        return data.decode()


class HaplyService:
    def __init__(self, port=0, version=3.5):
        self.version, self.port = version, port
        self.at, self.speed, self.grip = (0.0, -0.12, 0.15), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)  # x, y, z, w
        self.buttons = [False, False, False]
        self.force, self.messages, self.sessions = None, 0, []
        self.has_grip, self.calibrated, self.hand = True, True, "right"
        self.instead = []  # texts that are sent in place of the next states
        self.mute = False  # whether messages get no answer
        self.listener = self.connection = None
        self.start()

    def start(self):
        self.listener = socket.socket()
        self.listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.listener.bind(("127.0.0.1", self.port))
        self.listener.listen(4)
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.serve, args=(self.listener,), daemon=True).start()

    def stop(self):
        """Goes, as a service that is ended or a machine that fails."""
        for one in (self.listener, self.connection):
            try:
                one.shutdown(socket.SHUT_RDWR)
            except (OSError, AttributeError):
                pass
            if one:
                one.close()
        self.listener = self.connection = None

    def serve(self, listener):
        while True:
            try:
                self.connection = listener.accept()[0]
                self.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self.talk(Served(self.connection))
            except (Closed, ConnectionError):
                continue
            except (OSError, AttributeError):
                if listener is not self.listener:
                    return

    def talk(self, served):
        served.send(json.dumps(self.state(True)))
        while True:
            message = json.loads(served.receive())
            self.messages += 1
            if "session" in message:
                self.sessions.append(message["session"])
            command = message["inverse3"][0]["commands"]["set_cursor_force"]
            force = command["vector" if self.version >= 3.5 else "values"]
            assert message["inverse3"][0]["device_id"] == "049D"
            self.force = (force["x"], force["y"], force["z"])
            if not self.mute:
                served.send(self.instead.pop(0) if self.instead else json.dumps(self.state()))

    def state(self, first=False):
        def xyz(values):
            return dict(zip("xyzw", values))
        device = {"device_id": "049D", "state": {"cursor_position": xyz(self.at), "cursor_velocity": xyz(self.speed)},
                  "status": {"calibrated": self.calibrated}}
        grip = {"device_id": "61548", "state": {"orientation": xyz(self.grip), "buttons": dict(zip("abc", self.buttons))}}
        if first:
            device["config"] = {"type": "inverse3", "handedness": self.hand}
        out = {"session_id": 7} if self.version >= 3.5 else {}
        return dict(out, inverse3=[device], verse_grip=[], wireless_verse_grip=[grip] if self.has_grip else [])
