# SPDX-License-Identifier: BSD-3-Clause
"""Reads screenshots without additional packages: PNG with 8 bits per channel, RGB or RGBA."""
import struct
import zlib


def read_png(data: bytes) -> tuple[int, int, list[bytes]]:
    """Returns width, height, and the RGB pixels of each row (PNG specification, third edition, 9: filters)."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG"
    at, packed = 8, b""
    width = height = channels = 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and colour in (2, 6) and not interlaced, "another sort of PNG"
            channels = 3 if colour == 2 else 4
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    return width, height, [bytes_of_rgb(row, channels) for row in unfiltered(zlib.decompress(packed), width, channels)]


def unfiltered(raw: bytes, width: int, channels: int):
    stride = width * channels
    before = bytearray(stride)
    for start in range(0, len(raw), stride + 1):
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        if kind == 1:
            for i in range(channels, stride):
                row[i] = (row[i] + row[i - channels]) & 255
        elif kind == 2:
            for i in range(stride):
                row[i] = (row[i] + before[i]) & 255
        elif kind in (3, 4):
            for i in range(stride):
                left = row[i - channels] if i >= channels else 0
                up, corner = before[i], before[i - channels] if i >= channels else 0
                row[i] = (row[i] + ((left + up) // 2 if kind == 3 else paeth(left, up, corner))) & 255
        before = row
        yield bytes(row)


def paeth(left: int, up: int, corner: int) -> int:
    guess = left + up - corner
    return min((left, up, corner), key=lambda value: abs(guess - value))


def bytes_of_rgb(row: bytes, channels: int) -> bytes:
    if channels == 3:
        return row
    out = bytearray(3 * (len(row) // 4))
    for c in range(3):
        out[c::3] = row[c::4]
    return bytes(out)


class Picture:
    def __init__(self, png: bytes):
        self.width, self.height, self.rows = read_png(png)

    def pixels(self, left: float, top: float, right: float, bottom: float):
        """Yields the RGB pixels within a box, whose borders are shares of the picture's width and height."""
        for row in self.rows[int(top * self.height):int(bottom * self.height)]:
            for x in range(int(left * self.width), int(right * self.width)):
                yield row[3 * x], row[3 * x + 1], row[3 * x + 2]

    def colours(self, *box: float) -> int:
        return len(set(self.pixels(*box)))

    def share(self, wanted, *box: float) -> float:
        found = [wanted(*pixel) for pixel in self.pixels(*box)]
        return sum(found) / len(found)

    def difference(self, other: "Picture", *box: float) -> float:
        """Returns the share of pixels that differ by more than 24 of 255 in a channel."""
        pairs = [max(abs(a - b) for a, b in zip(mine, theirs))
                 for mine, theirs in zip(self.pixels(*box), other.pixels(*box))]
        return sum(step > 24 for step in pairs) / len(pairs)
