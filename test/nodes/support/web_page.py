# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A browser's part of page_server, without a browser: HTTP, a web socket (RFC 6455), and the frames of live_message.h."""
import base64
import json
import os
import socket
import struct
import time

import numpy

PATIENCE_S = 30
TEXT, BYTES, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class Closed(Exception):
    """The server has closed the web socket."""


def ask(port, request):
    """Returns the status and the text of the answer to a request, given as bytes. Status 0: none."""
    with socket.create_connection(("127.0.0.1", port), PATIENCE_S) as connection:
        answer = b""
        try:
            connection.sendall(request)
            while True:
                part = connection.recv(1 << 16)
                if not part:
                    break
                answer += part
        except ConnectionError:
            pass
    return int(answer[9:12] or 0), answer.decode()


class WebSocket:
    """A connection to /live. Raises ConnectionRefusedError with the status where the server does not open it."""

    def __init__(self, port, origin=None, host=None):
        host = host or "127.0.0.1:%d" % port
        self.socket = socket.create_connection(("127.0.0.1", port), PATIENCE_S)
        key = base64.b64encode(os.urandom(16)).decode()
        head = "GET /live HTTP/1.1\r\nHost: %s\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: %s\r\nSec-WebSocket-Version: 13\r\n" % (host, key)
        self.socket.sendall((head + ("Origin: %s\r\n" % origin if origin else "") + "\r\n").encode())
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            part = self.socket.recv(1 << 16)
            if not part:
                break
            self.rest += part
        status = int(self.rest[9:12] or 0)
        if status != 101:
            self.socket.close()
            raise ConnectionRefusedError(status)
        self.rest = self.rest.split(b"\r\n\r\n", 1)[1]

    def close(self):
        self.socket.close()

    def send(self, data, kind=TEXT):
        data = data.encode() if isinstance(data, str) else data
        mask = b"\x11\x22\x33\x44"
        size = bytes([128 | len(data)]) if len(data) < 126 else struct.pack(">BH", 254, len(data)) if len(data) < 65536 else struct.pack(">BQ", 255, len(data))
        masked = bytes(b ^ mask[i % 4] for i, b in enumerate(data))
        self.socket.sendall(bytes([128 | kind]) + size + mask + masked)

    def take(self, count):
        while len(self.rest) < count:
            part = self.socket.recv(1 << 20)
            if not part:
                raise Closed("end of the stream")
            self.rest += part
        out, self.rest = self.rest[:count], self.rest[count:]
        return out

    def receive(self):
        """Returns the next message: a text as str, bytes as bytes. Raises Closed."""
        while True:
            head, size = self.take(2)
            if size == 126:
                size = struct.unpack(">H", self.take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self.take(8))[0]
            data = self.take(size)
            if head & 15 == CLOSE:
                raise Closed("%d %s" % (struct.unpack(">H", data[:2])[0] if data else 0, data[2:].decode()))
            if head & 15 == PING:
                self.send(data, PONG)
            elif head & 15 in (TEXT, BYTES):
                return data.decode() if head & 15 == TEXT else data


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def byte(self):
        self.at += 1
        return self.data[self.at - 1]

    def count(self):
        out = shift = 0
        while True:
            byte = self.byte()
            out |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return out

    def signed(self):
        bits = self.count()
        return -(bits + 1) // 2 if bits % 2 else bits // 2

    def floats(self, count):
        self.at += 4 * count
        return numpy.frombuffer(self.data, "<f4", count, self.at - 4 * count)


class Surface:
    """A surface mesh in steps of its grid, read after the text in surface_coder.h."""

    def __init__(self, reader, before=None):
        flags = reader.byte()
        self.triangles = before.triangles if before else []
        self.vertices = before.vertices if before else 0
        if flags & 1:
            self.read_triangles(reader)
        if flags & 2:
            self.colors = numpy.frombuffer(reader.data, "u1", 4 * self.vertices, reader.at).reshape(4, -1)
            reader.at += 4 * self.vertices
        self.neighbours = self.find_neighbours()
        self.steps = [self.read_axis(reader, before.steps[axis] if before else []) for axis in range(3)]

    def read_triangles(self, reader):
        self.vertices, removed, after = reader.count(), set(), 0
        for _ in range(reader.count()):
            index = after + reader.count()
            removed.add(index)
            after = index + 1
        self.triangles = [t for i, t in enumerate(self.triangles) if i not in removed]
        corner = 0
        for _ in range(reader.count()):
            kind, corners = reader.byte(), []
            for _ in range(3):
                corner += reader.signed()
                corners.append(corner)
            corner = corners[0]
            self.triangles.append((*corners, kind))

    def find_neighbours(self):
        out = [set() for _ in range(self.vertices)]
        for triangle in self.triangles:
            for v in triangle[:3]:
                out[v].update(other for other in triangle[:3] if other < v)
        return [(sorted(known)[-1], sorted(known)[-2] if len(known) > 1 else sorted(known)[-1]) if known else None for known in out]

    def read_axis(self, reader, then):
        pairs = reader.data[reader.at:reader.at + (self.vertices + 1) // 2]
        halves = [half for pair in pairs for half in (pair & 15, pair >> 4)]
        longs = halves.count(15)
        low = reader.at + len(pairs)
        reader.at = low + 2 * longs
        now, long = [], 0
        for v in range(self.vertices):
            bits = halves[v]
            if bits == 15:
                bits = reader.data[low + long] | reader.data[low + longs + long] << 8
                long += 1
            value = (bits >> 1) ^ -(bits & 1)
            known = v < len(then)
            if known:
                value += then[v]
            if self.neighbours[v]:
                a, b = self.neighbours[v]
                value += (now[a] + now[b] - (then[a] + then[b] if known else 0) + 1) >> 1
            now.append(value & 65535)
        return now


class Page:
    """The page's end of a web socket."""

    def __init__(self, port, **options):
        self.socket = WebSocket(port, **options)
        self.parts, self.state, self.answers = {}, None, []

    def close(self):
        self.socket.close()

    def call(self, service, **more):
        self.socket.send(json.dumps({"call": service, **more}))

    def read(self, end, shown=True):
        """Takes a message; returns (header, data) of a frame, None for others. Raises TimeoutError at the time `end`."""
        left_s = end - time.monotonic()
        if left_s <= 0:
            raise TimeoutError("no message of that kind in time")
        self.socket.socket.settimeout(left_s)
        message = self.socket.receive()
        if isinstance(message, str):
            told = json.loads(message)
            self.state = told.get("state", self.state)
            self.answers += [told["answer"]] if "answer" in told else []
            return None
        size = struct.unpack("<I", message[:4])[0]
        header, data = json.loads(message[4:4 + size]), message[4 + size:]
        if "frame" not in header:
            self.parts[header["part"]] = (header, data)
            return None
        self.parts = {number: self.parts[number] for number in header["needs"]}
        if shown:
            self.socket.send(json.dumps({"shown": header["frame"]}))
        return header, data

    def frame(self, shown=True, limit_s=PATIENCE_S):
        """Waits for the next frame and returns (header, data). Raises TimeoutError without one.

        shown: whether to say that it was drawn."""
        end = time.monotonic() + limit_s
        while True:
            frame = self.read(end, shown)
            if frame:
                return frame

    def until(self, condition):
        """Takes messages until condition() is true. Raises TimeoutError after PATIENCE_S."""
        end = time.monotonic() + PATIENCE_S
        while not condition():
            self.read(end)

    def decode(self, header, data):
        """Returns a frame: {positions [v, 3], triangles, tools: [(part, position)], forces, tips}."""
        base_header, base_data = self.parts[header["base"]]
        base = Surface(Reader(base_data))
        reader = Reader(data)
        surface = Surface(reader, base)
        positions = numpy.array(base_header["origin"]) + base_header["step"] * numpy.array(surface.steps).T
        return {"positions": positions, "triangles": surface.triangles, "step": base_header["step"], **things(reader)}


def things(reader):
    """Returns what a frame shows besides the surface."""
    for _ in range(reader.count()):
        reader.count()
        points = reader.count()
        reader.byte()
        for _ in range(3 * points):
            reader.signed()
    tools = []
    for _ in range(reader.count()):
        part = reader.count()
        tools.append((part, reader.floats(3)))
        reader.floats(4)
    count = reader.count()
    return {"tools": tools, "forces": reader.floats(3 * count).reshape(-1, 3), "tips": reader.floats(3 * count).reshape(-1, 3)}
