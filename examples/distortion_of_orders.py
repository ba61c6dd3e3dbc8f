# SPDX-License-Identifier: MIT
# What an order costs: one figure, the same cones, onto 22N, 2N2, N22 and NN for N = 2 .. 12; a table, and a plot: orders.svg.
# PYTHONPATH=build/python python3 examples/distortion_of_orders.py
import numpy as np
import orbitutte

ORDERS = range(2, 13)
COLOURS = {"N,2,2": "#d1495b", "2,N,2": "#edae49", "2,2,N": "#00798c", "N,N": "#30638e"}

V, F = orbitutte.sample_mesh("figure", 3000)
solver = orbitutte.Solver(V, F)  # keeps what the embeddings have in common
cones = orbitutte.choose_cones(V, F, "432")

median = {}
print("median area distortion\n    N" + "".join(f"{family:>9}" for family in COLOURS))
for order in ORDERS:
    row = []
    for family in COLOURS:
        symbol = family.replace("N", str(order))
        embedding = solver.embed(symbol, cones[: symbol.count(",") + 1])
        assert embedding.bijective, symbol
        median[family, order] = embedding.distortion["area"]["median"]
        row.append(f"{median[family, order]:9.2f}")
    print(f"{order:5}" + "".join(row), flush=True)

top = max(median.values())
x = {order: 60 + 45 * (order - 2) for order in ORDERS}
y = {value: 300 - 260 * np.log(value) / np.log(top) for value in [*median.values(), 1, 2, 5, 10, 20, 50]}
parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="600" height="350" font-family="sans-serif" font-size="13">',
         '<rect width="100%" height="100%" fill="white"/><text x="300" y="340" text-anchor="middle">order N</text>',
         '<text x="60" y="22">median area distortion, max(A, 1/A)</text>']
for value in (1, 2, 5, 10, 20, 50):
    if value <= top:
        parts.append(f'<path d="M60 {y[value]:.0f} H510" stroke="#ddd"/><text x="50" y="{y[value] + 4:.0f}" text-anchor="end">{value}</text>')
for order in ORDERS:
    parts.append(f'<text x="{x[order]}" y="320" text-anchor="middle">{order}</text>')
for family, colour in COLOURS.items():
    line = " ".join(f"{x[order]},{y[median[family, order]]:.1f}" for order in ORDERS)
    parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
    parts.append(f'<text x="520" y="{y[median[family, 12]] + 4:.1f}" fill="{colour}">{family.replace(",", "")}</text>')
with open("orders.svg", "w", encoding="utf-8") as file:
    file.write("\n".join(parts) + "\n</svg>\n")
