# SPDX-License-Identifier: GPL-3.0-or-later
"""What can happen to a file of any format. Damaged files are pairs of a name and the content: bytes, or
what `put` makes in its place.
"""
import os
import random

FOLDER, PIPE, LOOP, MISSING = (object() for _ in range(4))

NOT_FILES = {"folder": FOLDER, "pipe": PIPE, "loop_of_links": LOOP, "missing": MISSING}

FOREIGN = {
    "empty": b"", "one_byte": b"x", "zeros": bytes(5000), "all_bytes": bytes(range(256)) * 8,
    "line_ends": b"\r\n" * 3000, "words": b"this is a letter to a friend\n" * 40,
    "picture": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(range(64)), "page": b"<!DOCTYPE html><html><body>404</body></html>\n",
    "one_line": b"a" * 3_000_000, "escapes": b"\x1b[31m\x1b]0;title\x07" * 50}


def put(path, content):
    if content is FOLDER:
        path.mkdir()
    elif content is PIPE:
        os.mkfifo(path)
    elif content is LOOP:
        path.symlink_to(path.name)
    elif content is not MISSING:
        path.write_bytes(content)


def replaced(whole, old, new):
    """`whole` with the first `old`, which is there, replaced."""
    old, new = (part if isinstance(part, bytes) else part.encode() for part in (old, new))
    assert old in whole, old
    return whole.replace(old, new, 1)


def cut_short(whole, parts=8):
    return {f"cut_at_{k}_of_{parts}": whole[:len(whole) * k // parts] for k in range(1, parts)}


def mutants(whole, count, seed):
    """`whole` with a few bytes changed, moved or lost, at places that `seed` fixes."""
    chance = random.Random(seed)
    for _ in range(count):
        text = bytearray(whole)
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(max(1, len(text)))
            size = chance.choice([1, 1, 2, 8, 40])
            way = chance.randrange(4)
            if way == 0:
                text[at:at + 1] = bytes([chance.randrange(256)])
            elif way == 1:
                del text[at:at + size]
            elif way == 2:
                text[at:at] = text[at:at + size]
            else:
                text[at:at] = chance.choice([b"-", b"9", b"\0", b"\xff", b"nan", b" ", b"\n", b"1e999", b"{", b"<", b"\""])
        yield bytes(text)
