# SPDX-License-Identifier: MIT
"""Writes a double pyramid over a polygon: two vertices with that many edges. usage: hub.py CORNERS FILE.obj"""
import math
import sys

n = int(sys.argv[1])
with open(sys.argv[2], "w", encoding="ascii") as file:
    file.write("v 0 0 1\nv 0 0 -1\n")
    for k in range(n):
        file.write(f"v {math.cos(2 * math.pi * k / n):.9f} {math.sin(2 * math.pi * k / n):.9f} 0\n")
    for k in range(n):
        a, b = 3 + k, 3 + (k + 1) % n
        file.write(f"f 1 {a} {b}\nf 2 {b} {a}\n")
