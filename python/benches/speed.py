"""How long things take in process: `python python/benches/speed.py` prints medians of processor time.

Each law is called beside the same formula, as the program writes it, in NumPy.
"""

import statistics
import time

import lindstedt as ls
import numpy as np


def median(function, count):
    """The processor time of a call in microseconds: the median of nine rounds of `count` calls."""
    rounds = []
    for _ in range(9):
        began = time.process_time()
        for _ in range(count):
            function()
        rounds.append((time.process_time() - began) / count * 1e6)
    return statistics.median(rounds)


def formula_of(law):
    """The formula of omega as the program writes it, in NumPy."""
    body = law.program("python").split("omega_squared =")[1].split("if not")[0].strip()
    space = {"sqrt": np.sqrt}
    exec(f"def formula({', '.join(law.symbols)}):\n    return sqrt({body})", space)
    return space["formula"]


def main():
    """Prints the figures."""
    equation = "x'' + x + eps*x^3 = 0"
    took = median(lambda: ls.Oscillator(equation).derive(order=8), 20)
    print(f"read and derive Duffing to order 8    {took / 1000:8.2f} ms")
    for order in (2, 8):
        law = ls.derive(equation, order=order)
        omega, formula = law.omega, formula_of(law)
        print(f"omega at order {order}, one number          {median(lambda: omega(1.2, 0.1), 20000):8.2f} us")
        for size in (1000, 100_000):
            amplitude = np.linspace(0.1, 1, size)
            ours = median(lambda: omega(amplitude, 0.1), 200_000 // size)
            theirs = median(lambda: formula(amplitude, 0.1), 200_000 // size)
            print(f"    {size:6} points {ours:8.1f} us, in NumPy {theirs:8.1f} us")


if __name__ == "__main__":
    main()
