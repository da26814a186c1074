#!/usr/bin/env python3
"""Reads an MCAP file by its specification and nothing else, checks it, and prints how many messages each topic has."""

import ctypes
import ctypes.util
import json
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"


class Cursor:
    def __init__(self, data, at=0, end=None):
        self.data, self.at, self.end = data, at, len(data) if end is None else end

    def take(self, count):
        assert self.at + count <= self.end, "cut off"
        self.at += count
        return self.data[self.at - count : self.at]

    def number(self, kind):
        return struct.unpack("<" + kind, self.take(struct.calcsize("<" + kind)))[0]

    def text(self):
        return self.take(self.number("I")).decode("utf-8")

    def pairs(self, first, second):
        part = Cursor(self.take(self.number("I")))
        found = []
        while part.at < part.end:
            found.append((part.number(first), part.number(second)))
        return found


def records(data, at, end):
    cursor = Cursor(data, at, end)
    while cursor.at < cursor.end:
        start = cursor.at
        opcode, length = cursor.number("B"), cursor.number("Q")
        yield start, opcode, cursor.take(length)
    assert cursor.at == end


def schema(content):
    c = Cursor(content)
    number, name, encoding = c.number("H"), c.text(), c.text()
    body = c.take(c.number("I"))
    assert encoding == "jsonschema" and json.loads(body)["type"] == "object"
    return number, name


def channel(content):
    c = Cursor(content)
    number, of, topic, encoding = c.number("H"), c.number("H"), c.text(), c.text()
    assert encoding == "json" and c.pairs("I", "I") == []
    return number, (of, topic)


def unpacked(packed, size):
    """A zstd frame by the system's own library, which the writer's sums know nothing of."""
    library = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    library.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
    out = ctypes.create_string_buffer(size)
    assert library.ZSTD_decompress(out, size, packed, len(packed)) == size, "a zstd frame"
    return out.raw


def read_chunk(content, offset, state):
    c = Cursor(content)
    start, end, size, crc = c.number("Q"), c.number("Q"), c.number("Q"), c.number("I")
    compression, inner = c.text(), c.take(c.number("Q"))
    assert c.at == c.end and compression in ("", "zstd"), compression
    stored = len(inner)
    if compression:
        inner = unpacked(inner, size)
    assert len(inner) == size and zlib.crc32(inner) == crc, "a chunk's sum"
    places = {}
    for at, opcode, body in records(inner, 0, size):
        if opcode == 3:
            state["schemas"].update([schema(body)])
        elif opcode == 4:
            state["channels"].update([channel(body)])
        else:
            assert opcode == 5
            m = Cursor(body)
            number, sequence, log, publish = m.number("H"), m.number("I"), m.number("Q"), m.number("Q")
            assert number in state["channels"], "a channel before its messages"
            assert start <= log <= end and log == publish
            state["messages"].setdefault(number, []).append((log, json.loads(m.data[m.at :])))
            assert sequence == len(state["messages"][number]) - 1
            places.setdefault(number, []).append((log, at))
    state["chunks"].append({"start": start, "end": end, "offset": offset, "length": 9 + len(content), "places": places, "indexes": {}, "size": size, "stored": stored, "compression": compression})


def read(path):
    data = open(path, "rb").read()
    assert data[:8] == MAGIC and data[-8:] == MAGIC, "magic"
    state = {"schemas": {}, "channels": {}, "messages": {}, "chunks": [], "summary": []}
    phase, index_end = "data", 0
    footer = None
    for offset, opcode, content in records(data, 8, len(data) - 8):
        if offset == 8:
            assert opcode == 1, "the header is first"
        elif phase == "data" and opcode == 6:
            read_chunk(content, offset, state)
        elif phase == "data" and opcode == 7:
            c = Cursor(content)
            number = c.number("H")
            assert c.pairs("Q", "Q") == state["chunks"][-1]["places"][number], "a message index"
            state["chunks"][-1]["indexes"][number] = offset
            state["chunks"][-1]["index_end"] = offset + 9 + len(content)
        elif phase == "data" and opcode == 15:
            phase = "summary"
            state["summary_start"] = offset + 9 + len(content)
        elif phase == "summary" and opcode == 2:
            footer = (offset, *struct.unpack("<QQI", content))
            phase = "end"
        else:
            assert phase == "summary", (phase, opcode)
            state["summary"].append((offset, opcode, content))
    offset, start, offsets, crc = footer
    assert start == state["summary_start"]
    assert zlib.crc32(data[start : offset + 9 + 16]) == crc, "the summary's sum"
    check_summary(state, offsets)
    return state


def check_summary(state, offsets):
    groups, found, chunks = {}, {}, []
    for offset, opcode, content in state["summary"]:
        if opcode == 14:
            assert offset >= offsets
            of, begin, length = struct.unpack("<BQQ", content)
            groups[of] = (begin, begin + length)
            continue
        begin, end = found.get(opcode, (offset, offset))
        found[opcode] = (begin, offset + 9 + len(content))
        if opcode == 3:
            assert dict([schema(content)]).items() <= state["schemas"].items()
        elif opcode == 4:
            assert dict([channel(content)]).items() <= state["channels"].items()
        elif opcode == 8:
            chunks.append(content)
        elif opcode == 11:
            c = Cursor(content)
            counts = [c.number(k) for k in "QHIIIIQQ"]
            total = {k: len(v) for k, v in state["messages"].items()}
            times = [m[0] for v in state["messages"].values() for m in v]
            assert counts == [sum(total.values()), len(state["schemas"]), len(state["channels"]), 0, 0, len(state["chunks"]), min(times, default=0), max(times, default=0)], counts
            assert dict(c.pairs("H", "Q")) == total
    assert groups == found, "the summary's offsets"
    assert len(chunks) == len(state["chunks"])
    for content, chunk in zip(chunks, state["chunks"]):
        c = Cursor(content)
        assert [c.number("Q") for _ in range(4)] == [chunk["start"], chunk["end"], chunk["offset"], chunk["length"]]
        assert dict(c.pairs("H", "Q")) == chunk["indexes"]
        assert c.number("Q") == chunk["index_end"] - chunk["offset"] - chunk["length"]
        assert c.text() == chunk["compression"] and c.number("Q") == chunk["stored"] and c.number("Q") == chunk["size"]


def main():
    state = read(sys.argv[1])
    for number, (of, topic) in sorted(state["channels"].items()):
        print(topic, state["schemas"][of], len(state["messages"][number]))
    if len(sys.argv) > 2:
        topic, index = sys.argv[2], int(sys.argv[3])
        number = next(n for n, (_, name) in state["channels"].items() if name == topic)
        print(json.dumps(state["messages"][number][index][1], separators=(",", ":")))


if __name__ == "__main__":
    main()
