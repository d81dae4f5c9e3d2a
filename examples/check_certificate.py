"""Checks a certificate of `lindstedt certify` in whole numbers alone: python3 check_certificate.py FILE

A second program for the same theorem (docs/certificates.md), of forces that are polynomials or sin. A number is a pair (m, r) of
integers, all reals within r of m, in units of 2^-P; a series is a list of cosine coefficients and the norm of what is not in it.
Prints the radius that is proved, and omega from below and from above, or says which inequality does not hold."""
import json
import sys
from fractions import Fraction
from math import isqrt

P = 256                                     # binary digits behind the point
ONE = 1 << P


def demand(holds, what):
    if not holds:
        sys.exit(f"not proved: {what}")


def up(a, b):                               # a/b, rounded up
    return -(-a // b)


def number(x):                              # a fraction
    x = Fraction(x)
    m = x.numerator * ONE // x.denominator
    return m, 0 if m * x.denominator == x.numerator * ONE else 1


def add(a, b, sign=1):
    return a[0] + sign * b[0], a[1] + b[1]


def mul(a, b):
    m = a[0] * b[0] >> P
    r = abs(a[0]) * b[1] + abs(b[0]) * a[1] + a[1] * b[1]
    return m, up(r, ONE) + 1 if a != (0, 0) and b != (0, 0) else 0


def over(a, n):                             # by a positive integer
    return a[0] // n, up(a[1], n) + 1 if a != (0, 0) else 0


def size(a):
    return abs(a[0]) + a[1]


def at(u, k):
    return u[0][k] if k < len(u[0]) else (0, 0)


def norm(u):
    return sum(map(size, u[0])) + u[1]


def plus(u, v, sign=1):
    return [add(at(u, k), at(v, k), sign) for k in range(max(len(u[0]), len(v[0])))], u[1] + v[1]


def times(u, v):
    doubled = [(0, 0)] * (len(u[0]) + len(v[0]))
    for i, a in enumerate(u[0]):
        for j, b in enumerate(v[0]):
            if a != (0, 0) and b != (0, 0):
                c = mul(a, b)
                doubled[i + j] = add(doubled[i + j], c)
                doubled[abs(i - j)] = add(doubled[abs(i - j)], c)
    tail = up(u[1] * norm(v) + v[1] * norm(u), ONE)
    series = [over(c, 2) for c in doubled]
    while series and size(series[-1]) < ONE >> 120:
        tail += size(series.pop())
    return series, tail


def constant(x):
    return [number(x)], 0


def sine_and_cosine(u):
    halvings = 0
    while norm(u) << 1 > ONE << halvings:
        halvings += 1
    demand(halvings < 7, "the argument of sin is too large")
    y = [over(c, 1 << halvings) for c in u[0]], up(u[1], 1 << halvings)
    w, s, c = times(y, y), constant(1), constant(1)
    for k in range(14, 0, -1):
        part = times(w, s), times(w, c)
        shrink = [([over(a, n) for a in t[0]], up(t[1], n)) for t, n in zip(part, (2*k*(2*k + 1), 2*k*(2*k - 1)))]
        s, c = plus(constant(1), shrink[0], -1), plus(constant(1), shrink[1], -1)
    rest = ONE >> 128                       # what is left of either series is below 2 (1/2)^30/30!
    s = times(y, s)
    s, c = (s[0], s[1] + rest), (c[0], c[1] + rest)
    for _ in range(halvings):
        s, c = times(times(s, c), constant(2)), plus(constant(1), times(times(s, s), constant(2)), -1)
    return s, c


def force(f, u):                            # f, f' and f'' on a series
    if f == "sin":
        s, c = sine_and_cosine(u)
        return s, c, times(s, constant(-1))
    values = []
    for derivative in range(3):
        total = constant(0)
        for power in range(len(f) - 1, derivative - 1, -1):
            factor = Fraction(f[power])
            for k in range(derivative):
                factor *= power - k
            total = plus(times(total, u), constant(factor))
        values.append(total)
    return values


def check(text):
    z = json.loads(text)
    demand(z["schema"] == "lindstedt/certificate/1" and z["ode"] == "x''+f(x)=0" and z["nu"] == "1", "another schema")
    N, odd, f = z["K"], z["odd"], z["f"]
    demand(1 <= N <= 400 and 0 <= z["bits"] <= 224 and 0 <= z["Abits"] <= 224 and abs(z["sigma_log2"]) <= 64, "sizes")
    demand(isinstance(f, list) or f == "sin", "a force that this program does not know")
    demand(all(len(t) <= 200 for t in z["c"] + [z["mu"]] + [t for row in z["A_block"] for t in row]), "long numbers")
    step = 2 if odd else 1
    if odd:
        demand(f == "sin" or all(Fraction(a) == 0 for a in f[::2]), "the force is not odd")
        demand(N % 2 == 1 and all(int(c) == 0 for c in z["c"][::2]), "even harmonics")
    I = range(1 if odd else 0, N + 1, step)
    n = len(I) + 1
    B = [[(int(t) << P - z["Abits"], 0) for t in row] for row in z["A_block"]]
    demand(len(B) == n and all(len(row) == n for row in B), "the size of the inverse")
    mu = int(z["mu"]) << P - z["bits"], 0
    c = [(int(t) << P - z["bits"], 0) for t in z["c"]], 0
    sigma = Fraction(2) ** z["sigma_log2"]

    def weighed(v):                         # the norm of a vector on mu and the block
        return up(sigma.numerator * size(v[0]), sigma.denominator) + sum(map(size, v[1:]))

    def image(v):
        rows = []
        for row in B:
            total = 0, 0
            for a, b in zip(row, v):
                total = add(total, mul(a, b))
            rows.append(total)
        return rows

    def beyond(last):
        return range(N + step, last + 1, step)

    def unit(v, k):                         # less the unit vector
        return [add(a, (ONE, 0), -1) if i == k else a for i, a in enumerate(v)]

    F, G, _ = force(f, c)
    a = weighed([row[0] for row in B])
    alpha = max([weighed([row[k] for row in B]) for k in range(1, n)] + [up(ONE + a, (N + step) ** 2)])
    # Y0
    y = {k: add(at(c, k), over(mul(mu, at(F, k)), k * k), -1) for k in beyond(max(len(c[0]), len(F[0])))}
    start = add((sum(m for m, _ in c[0]), 0), number(z["A"]), -1)
    for value in y.values():
        start = add(start, value, -1)
    rows = [add(mul(mu, at(F, k)), (-k * k * at(c, k)[0], 0)) for k in I]
    Y0 = weighed(image([start] + rows)) + sum(map(size, y.values())) + up(alpha * up(size(mu) * F[1], ONE), ONE)
    # Z1
    s = [over(g, 2) if k else g for k, g in enumerate(G[0])]
    half = lambda m: s[m] if m < len(s) else (0, 0)
    M = lambda k, j: at(G, k) if j == 0 else half(j) if k == 0 else add(half(abs(k - j)), half(k + j))
    L = len(G[0])
    parts = {k: over(at(F, k), k * k) for k in beyond(len(F[0]))}
    start = 0, 0
    for value in parts.values():
        start = add(start, value)
    column = weighed(unit(image([start] + [at(F, k) for k in I]), 0)) + sum(map(size, parts.values()))
    worst = up((column + up(alpha * F[1], ONE)) * sigma.denominator, sigma.numerator)
    G_norm, j = sum(map(size, G[0])), I[0]
    while True:
        images = [over(mul(mu, M(k, j)), k * k) for k in beyond(j + L)]
        start = 0, 0
        for value in images:
            start = add(start, value)
        tail = sum(map(size, images))
        if j > N + L:
            worst = max(worst, tail + up(a * size(start), ONE))
        else:
            if j <= N:
                start = add(start, (ONE, 0))
            v = [start] + [add(mul(mu, M(k, j)), (-k * k * ONE if k == j else 0, 0)) for k in I]
            v = image(v)
            worst = max(worst, weighed(unit(v, I.index(j) + 1) if j <= N else v) + tail)
        far = j + step - L                  # all further columns together
        if far > 0 and j > N + L:
            rest = up(up(size(mu) * (ONE + a), ONE) * G_norm, ONE * far * far)
            if 5 * rest < ONE or rest < worst:
                worst = max(worst, rest)
                break
        j += step
    Z1 = worst + up(alpha * up(size(mu) * G[1], ONE), ONE)
    demand(Z1 < ONE, f"Z1 = {Z1 / ONE:.3g} is not below 1")
    # Z2, the radius
    R = up(105 * 2 * Y0 * ONE, 100 * (ONE - Z1))
    _, G_R, H_R = force(f, (c[0], R))
    per_sigma = lambda t: up(t * sigma.denominator, sigma.numerator)
    mu_R = size(mu) + per_sigma(R)
    Z2 = up(alpha * max(per_sigma(norm(G_R)), up(mu_R * norm(H_R), ONE)), ONE)
    D = (ONE - Z1) ** 2 - 2 * Y0 * Z2
    demand(D > 0, "D is not positive")
    r = up(2 * Y0 * ONE, ONE - Z1 + isqrt(D))
    demand(r <= R and Z1 + up(Z2 * r, ONE) < ONE and per_sigma(r) < mu[0] and r < size(at(c, 1)), "the radius is too large")
    # Rounding is another here than where the radius was claimed.
    demand(Fraction(r, ONE) <= Fraction(z["claim_r"]) * (1 + Fraction(1, 1000)) + Fraction(1, 2**120), "a smaller radius is claimed")
    ends = [mu[0] + per_sigma(r), mu[0] - per_sigma(r)]
    omega = [isqrt(ONE ** 3 // ends[0]), isqrt(up(ONE ** 3, ends[1])) + 1]
    return r, omega


def decimal(x, up_to=0):                    # thirty-six decimals, rounded down or up
    digits = str(x * 10 ** 36 // ONE + up_to).rjust(37, "0")
    return digits[:-36] + "." + digits[-36:]


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        radius, omega = check(file.read())
    print(json.dumps([f"{up(radius * 10 ** 40, ONE)}e-40", decimal(omega[0]), decimal(omega[1], 1)]))
